#pragma once
/// \file Which patches of the mesh play which part. Only for .cpp files of solver/foam.
#include <optional>
#include <vector>

#include "solver/ports/settings.hpp"

#include "label.H"

namespace Foam {
class fvMesh;
}

namespace cutterflow::foam {

struct PatchRoles {
    std::optional<Foam::label> outlet;
    std::vector<Foam::label> steel;  ///< walls
};

/// \throws UserError  when a patch is not there, or steel is no wall
PatchRoles find_patch_roles(const Foam::fvMesh& mesh, const coupling::PatchSettings& settings);

}  // namespace cutterflow::foam
