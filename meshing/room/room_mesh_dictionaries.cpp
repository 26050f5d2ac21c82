#include "meshing/room/room_mesh_dictionaries.hpp"

#include <fmt/format.h>

#include "meshing/dictionary/mesher_sections.hpp"

namespace cutterflow::meshing {
namespace {

/// Corners of the box's sides in the numbering of room_background, by k_room_sides, outward.
constexpr std::array<std::array<int, 4>, 6> k_side_corners{
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

std::string set_of(const RoomMeshPatch& patch) {
    return "faces_of_" + patch.name;
}

FoamDictionary action(const RoomMeshPatch& patch, const char* what, const char* source) {
    return FoamDictionary().add("name", set_of(patch)).add("type", "faceSet").add("action", what).add("source", source);
}

/// Keeps what lies in a part. Centres of faces of a side lie in its plane: the part reaches a little across it.
struct Subset {
    const RoomMeshPlan& plan;
    const RoomMeshPatch& patch;

    FoamDictionary operator()(const MeshBox& box) const {
        const Vec3 margin = margins();
        return action(patch, "subset", "boxToFace").add("min", Vec3(box.lower - margin)).add("max", Vec3(box.upper + margin));
    }
    FoamDictionary operator()(const MeshCylinder& cylinder) const {
        return action(patch, "subset", "cylinderToFace").add("p1", cylinder.from).add("p2", cylinder.to).add("radius", cylinder.radius);
    }

private:
    Vec3 margins() const {
        Vec3 margin = Vec3::Zero();
        for (const std::size_t side : patch.sides) {
            const auto axis = static_cast<Eigen::Index>(side / 2);
            margin[axis] = 0.25 * plan.cell_size[axis];
        }
        return margin;
    }
};

struct Region {
    FoamDictionary operator()(const MeshBox& box) const {
        return FoamDictionary().add("type", "searchableBox").add("min", box.lower).add("max", box.upper);
    }
    FoamDictionary operator()(const MeshCylinder& cylinder) const {
        return FoamDictionary()
            .add("type", "searchableCylinder")
            .add("point1", cylinder.from)
            .add("point2", cylinder.to)
            .add("radius", cylinder.radius);
    }
};

std::string region_name(std::size_t number) {
    return fmt::format("refined_part_{}", number + 1);
}

FoamDictionary castellation(const RoomMeshPlan& plan) {
    std::vector<FoamValue> features;
    FoamDictionary surfaces, regions;
    for (const RoomMeshSolid& solid : plan.input.solids) {
        features.emplace_back(FoamDictionary().add("file", FoamValue::quoted(solid.name + ".eMesh")).add("level", 0));
        surfaces.add(solid.name,
                     FoamDictionary().add("level", FoamValue::list({0, 0})).add("patchInfo", FoamDictionary().add("type", "wall")));
    }
    for (std::size_t i = 0; i < plan.levels.size(); ++i)
        regions.add(region_name(i),
                    FoamDictionary().add("mode", "inside").add("levels", FoamValue::list({FoamValue::list({1e15, plan.levels[i]})})));
    FoamDictionary d;
    d.add("maxLocalCells", 20000000).add("maxGlobalCells", 20000000).add("minRefinementCells", 0).add("maxLoadUnbalance", 0.1);
    d.add("nCellsBetweenLevels", 1).add("resolveFeatureAngle", 180).add("allowFreeStandingZoneFaces", true);
    d.add("features", FoamValue::list(features)).add("refinementSurfaces", surfaces).add("refinementRegions", regions);
    d.add("locationInMesh", plan.place);
    return d;
}

}  // namespace

FoamDictionary room_background(const RoomMeshPlan& plan) {
    const Vec3 &a = plan.input.lower, &b = plan.input.upper;
    std::vector<FoamValue> vertices;
    for (const double z : {a.z(), b.z()})
        for (const Vec3& corner : {Vec3(a.x(), a.y(), z), Vec3(b.x(), a.y(), z), Vec3(b.x(), b.y(), z), Vec3(a.x(), b.y(), z)})
            vertices.emplace_back(corner);
    std::vector<FoamValue> sides;
    for (std::size_t side = 0; side < k_room_sides.size(); ++side)
        sides.push_back(FoamValue::sequence(
            {k_room_sides[side],
             FoamDictionary().add("type", "wall").add("faces", FoamValue::list({FoamValue::list_of(k_side_corners[side])}))}));
    FoamDictionary d;
    d.add("scale", 1).add("vertices", FoamValue::list(vertices)).add("edges", FoamValue::list({}));
    d.add("blocks", FoamValue::list({FoamValue::sequence({"hex", FoamValue::list({0, 1, 2, 3, 4, 5, 6, 7}), FoamValue::list_of(plan.cells),
                                                          "simpleGrading", FoamValue::list({1, 1, 1})})}));
    d.add("boundary", FoamValue::list(sides)).add("mergePatchPairs", FoamValue::list({}));
    return d;
}

FoamDictionary room_cut(const RoomMeshPlan& plan) {
    FoamDictionary geometry;
    for (const RoomMeshSolid& solid : plan.input.solids)
        geometry.add(solid.name + ".stl", FoamDictionary().add("type", "triSurfaceMesh").add("name", solid.name));
    for (std::size_t i = 0; i < plan.levels.size(); ++i) geometry.add(region_name(i), std::visit(Region(), plan.input.refinements[i].part));
    FoamDictionary d;
    d.add("castellatedMesh", true).add("snap", !plan.input.solids.empty()).add("addLayers", false);
    d.add("geometry", geometry);
    d.add("castellatedMeshControls", castellation(plan));
    d.add("snapControls", snapping());
    d.add("addLayersControls", no_layers());
    d.add("meshQualityControls", mesh_quality(plan.smallest_cell()));
    d.add("mergeTolerance", 1e-6);
    return d;
}

FoamDictionary room_selection(const RoomMeshPlan& plan) {
    std::vector<FoamValue> actions;
    const std::vector<RoomMeshPatch>& patches = plan.input.patches;
    for (const RoomMeshPatch& patch : patches) {
        const char* what = "new";
        for (const std::size_t side : patch.sides) {
            actions.emplace_back(action(patch, what, "patchToFace").add("patch", k_room_sides[side]));
            what = "add";
        }
        if (patch.part) actions.emplace_back(std::visit(Subset{plan, patch}, *patch.part));
    }
    for (std::size_t i = 0; i < patches.size(); ++i)
        for (std::size_t later = i + 1; later < patches.size(); ++later)
            actions.emplace_back(action(patches[i], "subtract", "faceToFace").add("set", set_of(patches[later])));
    return FoamDictionary().add("actions", FoamValue::list(actions));
}

FoamDictionary room_patches(const RoomMeshPlan& plan) {
    std::vector<FoamValue> patches;
    for (const RoomMeshPatch& patch : plan.input.patches)
        patches.emplace_back(FoamDictionary()
                                 .add("name", patch.name)
                                 .add("patchInfo", FoamDictionary().add("type", patch.wall ? "wall" : "patch"))
                                 .add("constructFrom", "set")
                                 .add("set", set_of(patch)));
    return FoamDictionary().add("pointSync", false).add("patches", FoamValue::list(patches));
}

}  // namespace cutterflow::meshing
