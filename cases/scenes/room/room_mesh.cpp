#include "cases/scenes/room/room_mesh.hpp"

#include "cases/scenes/room/side_parts.hpp"

namespace cutterflow::cases {

namespace {

/// A disc on a side reaches this share of the room's size across it.
constexpr double k_reach = 1e-3;

meshing::MeshPart part_of(const Region& region) {
    if (const auto* box = std::get_if<BoxRegion>(&region)) return meshing::MeshBox{box->lower, box->upper};
    const auto& cylinder = std::get<CylinderRegion>(region);
    return meshing::MeshCylinder{cylinder.from, cylinder.to, cylinder.radius};
}

meshing::MeshCylinder cylinder_of(const SideDisc& disc, coupling::DomainSide side, const RoomScene& scene) {
    const Vec3 reach = k_reach * scene.size.maxCoeff() * Vec3::Unit(static_cast<Eigen::Index>(side) / 2);
    return {disc.centre - reach, disc.centre + reach, disc.radius};
}

/// \pre the part is not a whole side
meshing::MeshPart part_of(const RoomBoundary& boundary, const RoomScene& scene) {
    if (const auto* disc = std::get_if<SideDisc>(&boundary.part)) return cylinder_of(*disc, boundary.sides.front(), scene);
    BoxRegion all = bounds_of(boundary.part, boundary.sides.front(), scene);
    for (const coupling::DomainSide side : boundary.sides) {
        const BoxRegion one = bounds_of(boundary.part, side, scene);
        all = {all.lower.cwiseMin(one.lower), all.upper.cwiseMax(one.upper)};
    }
    return meshing::MeshBox{all.lower, all.upper};
}

/// Water sticks to patches of type wall.
bool is_wall(const SideFlow& flow) {
    return std::holds_alternative<NoSlip>(flow) || std::holds_alternative<RoughWall>(flow);
}

meshing::RoomMeshPatch patch_of(const RoomBoundary& boundary, const RoomScene& scene) {
    meshing::RoomMeshPatch patch;
    patch.name = boundary.name;
    patch.wall = is_wall(boundary.flow);
    for (const coupling::DomainSide side : boundary.sides) patch.sides.push_back(static_cast<std::size_t>(side));
    if (!std::holds_alternative<WholeSide>(boundary.part)) patch.part = part_of(boundary, scene);
    return patch;
}

}  // namespace

meshing::RoomMeshInput mesh_input_of(const RoomScene& scene) {
    meshing::RoomMeshInput input;
    input.lower = scene.lower();
    input.upper = scene.upper();
    input.cell = scene.cell;
    for (const RoomRefinement& refinement : scene.refinements) input.refinements.push_back({part_of(refinement.region), refinement.cell});
    for (const RoomSolid& solid : scene.solids)
        if (solid.felt_by_fluid) input.solids.push_back({solid.name, solid.surface, solid.thinnest});
    for (const RoomBoundary& boundary : scene.boundaries) input.patches.push_back(patch_of(boundary, scene));
    return input;
}

}  // namespace cutterflow::cases
