#include "meshing/cutter/build_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/crown_cutter.hpp"
#include "geometry/head/head_names.hpp"
#include "geometry/io/write_stl.hpp"

namespace cutterflow::meshing {
namespace {

namespace fs = std::filesystem;

/// A head of four stout blades, ring radius 0.10 m.
geometry::CrownParameters small_parameters() {
    geometry::CrownParameters p;
    p.ring_radius = 0.10;
    p.ring_inner_radius = 0.07;
    p.ring_height = 0.03;
    p.hub_radius = 0.035;
    p.hub_depth = 0.11;
    p.hub_height = 0.04;
    p.hub_cap_height = 0.01;
    p.blade_count = 4;
    p.blade_wrap = 30.0 * k_pi / 180.0;
    p.blade_thickness = p.blade_thickness_at_hub = 0.02;
    p.blade_depth_at_ring = 0.028;
    p.blade_depth_at_hub = 0.03;
    p.contour_exponent = 2.0;
    p.edge_length = 0.01;
    return p;
}

MeshInput small_input(const geometry::TriangleSurface& cutter) {
    MeshInput input;
    input.ring_radius = 0.10;
    input.cutter = extent_of_cutter(cutter);
    input.steel.plate_radius = 0.10;
    input.steel.gap = 0.03;
    input.steel.plate_thickness = 0.02;
    input.steel.mouth = {0.06, 0.02, 0.3};
    input.steel.pipe_wall = 0.012;
    input.steel.pipe_top = 0.16;
    input.steel.edge_length = 0.01;
    input.tank = {0.4, -0.25, 0.12};
    input.resolution = {"tiny", 0.3, 1.15, 1.7};
    input.rotation_speed = 2.0 * k_pi;
    input.discharge = 0.002;
    input.max_courant = 0.9;
    return input;
}

std::vector<std::string> failed_gates(const MeshReport& report) {
    std::vector<std::string> names;
    for (const MeshGate& gate : report.gates)
        if (!gate.passed()) names.push_back(gate.name);
    return names;
}

/// A run directory with the surfaces of the small head.
class BuildMesh : public testing::Test {
protected:
    void SetUp() override {
        fs::remove_all(run);
        fs::create_directories(run / "geometry");
        const geometry::StationarySteel steel = geometry::generate_stationary_steel(input.steel);
        geometry::write_stl(cutter, run / names::cutter_surface);
        geometry::write_stl(steel.backplate, run / names::backplate_surface);
        geometry::write_stl(steel.suction_pipe, run / names::suction_pipe_surface);
    }

    MeshReport build(int ranks = 1) {
        write_mesh_case(run, plan, ranks);
        return build_mesh(run, plan, fs::path(CUTTERFLOW_BUILD_DIR) / "bin", ranks);
    }

    const fs::path run =
        fs::path(testing::TempDir()) / ("build_mesh_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    geometry::TriangleSurface cutter = geometry::generate_crown_cutter(small_parameters());
    MeshInput input = small_input(cutter);
    MeshPlan plan = plan_mesh(input);
};

TEST_F(BuildMesh, passes_every_gate) {
    const MeshReport report = build();
    EXPECT_NO_THROW(require_mesh_gates(report));
    EXPECT_NEAR(static_cast<double>(report.figures.cells), report.prediction.cells, 0.25 * report.prediction.cells);
    EXPECT_EQ(report.figures.rotor_side.faces, plan.interface_faces());
    EXPECT_GT(report.figures.rotor_side.drift, 0.0);
    // The steel's cells are half as large as those of the background.
    EXPECT_NEAR(report.cell_size_at_cutter(), 0.5 * plan.cell_size, 0.3 * plan.cell_size);

    for (const char* file : {"boundary", "cellZones", "faces", "neighbour", "owner", "points"})
        EXPECT_TRUE(fs::exists(run / "constant" / "polyMesh" / file)) << file;
    const nlohmann::json json = nlohmann::json::parse(std::ifstream(run / names::mesh_report));
    EXPECT_EQ(json["cells"], report.figures.cells);
    EXPECT_EQ(json["gates"].size(), 11u);
}

TEST_F(BuildMesh, is_the_same_and_whole_on_two_ranks) {
    const MeshReport one = build();
    const MeshReport two = build(2);
    EXPECT_NO_THROW(require_mesh_gates(two));
    EXPECT_EQ(two.figures.cells, one.figures.cells);
    EXPECT_EQ(two.figures.rotor_cells, one.figures.rotor_cells);
    EXPECT_NEAR(two.figures.rotor_volume, one.figures.rotor_volume, 1e-4 * one.figures.rotor_volume);
    EXPECT_NEAR(two.figures.weight_min, one.figures.weight_min, 1e-6);
    EXPECT_NEAR(two.figures.weight_max, one.figures.weight_max, 1e-6);
    // Where ranks meet, single points are snapped elsewhere on the steel: up to 0.3 % of an area was seen.
    ASSERT_EQ(two.figures.patches.size(), one.figures.patches.size());
    for (std::size_t k = 0; k < one.figures.patches.size(); ++k) {
        EXPECT_EQ(two.figures.patches[k].name, one.figures.patches[k].name);
        EXPECT_NEAR(two.figures.patches[k].area, one.figures.patches[k].area, 1e-2 * one.figures.patches[k].area);
    }
    EXPECT_TRUE(fs::exists(run / k_mesh_case / "log.decomposePar"));
    EXPECT_TRUE(fs::exists(run / k_mesh_case / "log.reconstructParMesh"));
    EXPECT_FALSE(fs::exists(run / k_mesh_case / "processor0"));
}

TEST_F(BuildMesh, shares_only_meshes_that_are_large_enough) {
    EXPECT_EQ(ranks_that_pay(plan, 2), 1);
    plan.prediction.cells = 1e6;
    EXPECT_EQ(ranks_that_pay(plan, 2), 2);
}

TEST_F(BuildMesh, sees_that_steel_got_lost) {
    geometry::CrownParameters p = small_parameters();
    p.blade_count = 3;
    geometry::write_stl(geometry::generate_crown_cutter(p), run / names::cutter_surface);
    EXPECT_EQ(failed_gates(build()), std::vector<std::string>{"relative error of the steel's volume in the rotor zone"});
}

TEST_F(BuildMesh, sees_that_refinement_reached_the_interface) {
    const Eigen::Affine3d wider(Eigen::Scaling(1.35, 1.35, 1.0));
    geometry::write_stl(geometry::transformed(cutter, wider), run / names::cutter_surface);
    const std::vector<std::string> failed = failed_gates(build());
    EXPECT_NE(std::find(failed.begin(), failed.end(), "interface faces that refinement split"), failed.end());
}

}  // namespace
}  // namespace cutterflow::meshing
