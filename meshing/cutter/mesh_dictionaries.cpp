#include "meshing/cutter/mesh_dictionaries.hpp"

#include <cmath>

#include "geometry/head/head_names.hpp"
#include "meshing/cutter/background_mesh.hpp"
#include "meshing/dictionary/mesher_sections.hpp"

namespace cutterflow::meshing {
namespace {

constexpr const char* k_outlet_set = "outlet_faces";

/// A point in the water of the rotor zone, between the interface and the head's lowest point, off every plane of the grid.
Vec3 point_in_rotor(const MeshPlan& plan) {
    const double h = plan.cell_size;
    return {0.137 * h, 0.171 * h, plan.rotor.z_bottom + 0.437 * plan.to_hub.distance};
}

/// A point in the water of the stator, beside the zone, below the backplate.
Vec3 point_in_stator(const MeshPlan& plan) {
    const double radius = plan.rotor.radius + 0.637 * (plan.input.tank.radius - plan.rotor.radius);
    return {radius * std::cos(0.537), radius * std::sin(0.537), plan.rotor.z_bottom + 0.437 * plan.to_hub.distance};
}

Vec3 mouth_centre(const MeshPlan& plan, double z) {
    const geometry::SuctionMouth& mouth = plan.input.steel.mouth;
    return {mouth.offset * std::cos(mouth.azimuth), mouth.offset * std::sin(mouth.azimuth), z};
}

FoamDictionary castellation(const MeshPlan& plan) {
    std::vector<FoamValue> features;
    FoamDictionary surfaces;
    for (const std::string& name : steel_surfaces()) {
        features.emplace_back(FoamDictionary().add("file", FoamValue::quoted(name + ".eMesh")).add("level", 0));
        // The cutter's cells are halved once; the stationary steel lies in cells that are small enough already.
        const int level = name == names::cutter_patch ? 1 : 0;
        surfaces.add(name,
                     FoamDictionary().add("level", FoamValue::list({level, level})).add("patchInfo", FoamDictionary().add("type", "wall")));
    }
    FoamDictionary d;
    d.add("maxLocalCells", 20000000).add("maxGlobalCells", 20000000).add("minRefinementCells", 0).add("maxLoadUnbalance", 0.1);
    d.add("nCellsBetweenLevels", 1).add("resolveFeatureAngle", 180).add("allowFreeStandingZoneFaces", true);
    d.add("features", FoamValue::list(features)).add("refinementSurfaces", surfaces).add("refinementRegions", FoamDictionary());
    d.add("locationsInMesh", FoamValue::list({FoamValue::list({point_in_rotor(plan), names::rotor_zone}),
                                              FoamValue::list({point_in_stator(plan), k_stator_zone})}));
    return d;
}

}  // namespace

const std::array<std::string, 3>& steel_surfaces() {
    static const std::array<std::string, 3> surfaces = {names::cutter_patch, names::backplate_patch, names::suction_pipe_patch};
    return surfaces;
}

FoamDictionary steel_cut(const MeshPlan& plan) {
    FoamDictionary geometry;
    for (const std::string& name : steel_surfaces())
        geometry.add(name + ".stl", FoamDictionary().add("type", "triSurfaceMesh").add("name", name));
    FoamDictionary d;
    d.add("castellatedMesh", true).add("snap", true).add("addLayers", false);
    d.add("geometry", geometry);
    d.add("castellatedMeshControls", castellation(plan));
    d.add("snapControls", snapping());
    d.add("addLayersControls", no_layers());
    d.add("meshQualityControls", mesh_quality(plan.cell_size));
    d.add("mergeTolerance", 1e-6);
    return d;
}

FoamDictionary outlet_selection(const MeshPlan& plan) {
    // Cells of the pipe's water at the tank's top; the radius ends within the pipe's wall.
    const double top = plan.input.tank.z_max;
    const double reach = top - plan.input.steel.gap - plan.input.steel.plate_thickness;
    FoamDictionary cells;
    cells.add("name", "outlet_cells").add("type", "cellSet").add("action", "new").add("source", "cylinderToCell");
    cells.add("p1", mouth_centre(plan, top - 0.5 * reach)).add("p2", mouth_centre(plan, top + reach));
    cells.add("radius", plan.input.steel.mouth.radius + 0.5 * plan.input.steel.pipe_wall);
    FoamDictionary faces;
    faces.add("name", k_outlet_set).add("type", "faceSet").add("action", "new");
    faces.add("source", "cellToFace").add("set", "outlet_cells").add("option", "all");
    FoamDictionary on_top;
    on_top.add("name", k_outlet_set)
        .add("type", "faceSet")
        .add("action", "subset")
        .add("source", "patchToFace")
        .add("patch", names::tank_top_patch);
    return FoamDictionary().add("actions", FoamValue::list({cells, faces, on_top}));
}

FoamDictionary final_patches() {
    const auto side = [](const char* name, const char* neighbour, const char* from) {
        FoamDictionary info;
        info.add("type", "cyclicAMI").add("neighbourPatch", neighbour).add("transform", "noOrdering").add("matchTolerance", 1e-4);
        FoamDictionary patch;
        patch.add("name", name).add("patchInfo", info).add("constructFrom", "patches").add("patches", FoamValue::list({from}));
        return patch;
    };
    FoamDictionary outlet;
    outlet.add("name", names::outlet_patch)
        .add("patchInfo", FoamDictionary().add("type", "patch"))
        .add("constructFrom", "set")
        .add("set", k_outlet_set);
    FoamDictionary d;
    d.add("pointSync", false);
    d.add("patches", FoamValue::list({outlet, side(names::rotor_interface_patch, names::stator_interface_patch, k_rotor_side_patch),
                                      side(names::stator_interface_patch, names::rotor_interface_patch, k_stator_side_patch)}));
    return d;
}

FoamDictionary decomposition(int ranks) {
    int across = 1;
    for (int divisor = 1; divisor * divisor <= ranks; ++divisor)
        if (ranks % divisor == 0) across = divisor;
    FoamDictionary boxes;
    boxes.add("n", FoamValue::list({ranks / across, across, 1})).add("delta", 0.001).add("order", "xyz");
    return FoamDictionary().add("numberOfSubdomains", ranks).add("method", "hierarchical").add("hierarchicalCoeffs", boxes);
}

}  // namespace cutterflow::meshing
