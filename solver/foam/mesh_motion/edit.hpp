#pragma once
/// \file What OpenFOAM hands out for reading only. Only for .cpp files of this folder.

namespace cutterflow::foam {

/// For overlaps and mesh geometry that are known without OpenFOAM's search.
template <class Type>
Type& edit(const Type& value) {
    return const_cast<Type&>(value);
}

}  // namespace cutterflow::foam
