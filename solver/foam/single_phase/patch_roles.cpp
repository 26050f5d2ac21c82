#include "solver/foam/single_phase/patch_roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"

#include "fvMesh.H"
#include "processorPolyPatch.H"
#include "wallFvPatch.H"

namespace cutterflow::foam {
namespace {

/// Of the whole mesh, on every rank.
std::vector<std::string> patch_names(const Foam::fvMesh& mesh) {
    std::vector<std::string> names;
    for (const Foam::polyPatch& patch : mesh.boundaryMesh())
        if (!Foam::isA<Foam::processorPolyPatch>(patch)) names.push_back(patch.name());
    return names;
}

}  // namespace

PatchRoles find_patch_roles(const Foam::fvMesh& mesh, const coupling::PatchSettings& settings) {
    PatchRoles roles;
    std::vector<Mistake> mistakes;
    const auto find = [&](const std::string& key, const std::string& name) -> std::optional<Foam::label> {
        const Foam::label patch = mesh.boundaryMesh().findPatchID(name);
        if (patch >= 0) return patch;
        mistakes.push_back({names::coupling_properties, fmt::format("{} = {}: the mesh has no such patch", key, name),
                            fmt::format("Patches are {}", fmt::join(patch_names(mesh), ", ")), "Name one of them"});
        return std::nullopt;
    };
    if (!settings.outlet.empty()) roles.outlet = find("patches.outlet", settings.outlet);
    for (const std::string& name : settings.steel) {
        const std::optional<Foam::label> patch = find("patches.steel", name);
        if (!patch) continue;
        if (!Foam::isA<Foam::wallFvPatch>(mesh.boundary()[*patch]))
            mistakes.push_back({names::coupling_properties, fmt::format("patches.steel = {}: the patch is no wall", name),
                                "Steel is made of patches of type wall",
                                "Remove it, or give it the type wall in constant/polyMesh/boundary"});
        roles.steel.push_back(*patch);
    }
    if (!mistakes.empty()) throw UserError(mistakes);
    if (!settings.steel.empty()) return roles;
    forAll(mesh.boundary(), patch) if (Foam::isA<Foam::wallFvPatch>(mesh.boundary()[patch])) roles.steel.push_back(patch);
    return roles;
}

}  // namespace cutterflow::foam
