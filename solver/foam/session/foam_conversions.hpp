#pragma once
/// \file OpenFOAM's values as the project's, and back. Only for .cpp files of this folder.
#include <filesystem>

#include <gsl/span>

#include "geometry/base/vec3.hpp"

#include "fileName.H"
#include "vectorField.H"

namespace cutterflow::foam {

static_assert(sizeof(Foam::vector) == sizeof(Vec3), "arrays of OpenFOAM's vectors must be arrays of Vec3");

inline std::filesystem::path to_path(const Foam::fileName& name) {
    return std::filesystem::path(std::string(name));
}

inline Vec3 to_vec3(const Foam::vector& v) {
    return {v.x(), v.y(), v.z()};
}
inline Foam::vector to_foam(const Vec3& v) {
    return Foam::vector(v.x(), v.y(), v.z());
}

/// Views of OpenFOAM's arrays, without a copy.
inline gsl::span<const Vec3> view(const Foam::UList<Foam::vector>& field) {
    return {reinterpret_cast<const Vec3*>(field.cdata()), static_cast<std::size_t>(field.size())};
}
inline gsl::span<const double> view(const Foam::UList<Foam::scalar>& field) {
    return {field.cdata(), static_cast<std::size_t>(field.size())};
}

}  // namespace cutterflow::foam
