/// Meshes of rooms: plan, dictionaries and gates.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/surface/simple_solids.hpp"
#include "meshing/room/build_room_mesh.hpp"
#include "meshing/room/room_mesh_dictionaries.hpp"

namespace cutterflow::meshing {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

RoomMeshInput box_of(double x, double y, double z, double cell) {
    RoomMeshInput input;
    input.lower = Vec3(-0.5 * x, -0.5 * y, 0.0);
    input.upper = Vec3(0.5 * x, 0.5 * y, z);
    input.cell = cell;
    return input;
}

RoomMeshSolid block(const Vec3& size, const Vec3& centre) {
    Eigen::Affine3d place(Eigen::Translation3d(centre.x(), centre.y(), centre.z() - 0.5 * size.z()));
    return {"block", geometry::transformed(geometry::generate_box(size, size.maxCoeff()), place), size.minCoeff()};
}

TEST(RoomMeshPlan, divides_the_box_into_whole_cells_near_the_wanted_size) {
    const RoomMeshPlan plan = plan_room_mesh(box_of(1.0, 0.15, 0.52, 0.05));
    EXPECT_EQ(plan.cells, (std::array<int, 3>{20, 3, 10}));
    EXPECT_NEAR(plan.cell_size.z(), 0.052, 1e-12);
    EXPECT_EQ(plan.predicted_cells, 600.0);
    EXPECT_NEAR(plan.medium_volume, 0.078, 1e-12);
    EXPECT_FALSE(plan.is_cut());
    EXPECT_EQ(plan_room_mesh(box_of(1.0, 0.01, 0.5, 0.05)).cells[1], 1);
}

/// Cells are halved until none is larger than wanted, but not for a twentieth of a halving.
TEST(RoomMeshPlan, halves_cells_in_refined_parts) {
    RoomMeshInput input = box_of(0.8, 0.8, 0.8, 0.04);
    input.refinements = {{MeshBox{Vec3(-0.4, -0.4, 0.0), Vec3(0.0, 0.4, 0.8)}, 0.01},
                         {MeshCylinder{Vec3(0.2, 0.0, 0.0), Vec3(0.2, 0.0, 0.8), 0.1}, 0.0198}};
    const RoomMeshPlan plan = plan_room_mesh(input);
    EXPECT_EQ(plan.levels, (std::vector<int>{2, 1}));
    EXPECT_NEAR(plan.smallest_cell(), 0.01, 1e-12);
    EXPECT_NEAR(plan.cell_at(Vec3(0.2, 0.05, 0.3)), 0.02, 1e-12);
    EXPECT_NEAR(plan.cell_at(Vec3(0.35, 0.3, 0.3)), 0.04, 1e-12);
    // Half the box in cells an eighth of an eighth, the cylinder in eighths.
    const double cylinder = M_PI * 0.01 / 0.64;
    EXPECT_NEAR(plan.predicted_cells, 8000.0 * (0.5 * 64.0 + cylinder * 8.0 + 0.5 - cylinder), 0.01 * 8000.0 * 32.0);
    input.refinements[1].cell = 0.015;
    EXPECT_EQ(plan_room_mesh(input).levels[1], 2);
}

TEST(RoomMeshPlan, finds_a_place_in_the_medium) {
    RoomMeshInput input = box_of(0.4, 0.4, 0.4, 0.02);
    input.solids = {block(Vec3(0.4, 0.4, 0.3), Vec3(0.0, 0.0, 0.15))};
    const RoomMeshPlan plan = plan_room_mesh(input);
    EXPECT_TRUE(plan.is_cut());
    EXPECT_GT(plan.place.z(), 0.32);
    EXPECT_LT(plan.place.z(), 0.38);
    EXPECT_NEAR(plan.medium_volume, 0.016, 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
        const double in_cells = (plan.place - plan.input.lower)[axis] / plan.cell_size[axis];
        EXPECT_GT(std::abs(in_cells - std::round(in_cells)), 1e-3);
    }
}

template <class Work>
std::string refusal(Work work) {
    try {
        work();
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

TEST(RoomMeshPlan, refuses_too_many_cells_and_a_room_without_medium) {
    EXPECT_THAT(refusal([] { plan_room_mesh(box_of(1.0, 1.0, 1.0, 1e-3)); }), HasSubstr("the mesh has 1e+09 cells"));
    EXPECT_THAT(refusal([] {
                    RoomMeshInput input = box_of(1.0, 1.0, 1.0, 0.01);
                    input.refinements = {{MeshBox{input.lower, input.upper}, 0.005}};
                    plan_room_mesh(input);
                }),
                HasSubstr("the mesh has 8e+06 cells"));
    EXPECT_THAT(refusal([] {
                    RoomMeshInput input = box_of(0.4, 0.4, 0.4, 0.02);
                    input.solids = {block(Vec3(0.4, 0.4, 0.4), Vec3(0.0, 0.0, 0.2))};
                    plan_room_mesh(input);
                }),
                HasSubstr("leave no place for its medium"));
}

TEST(RoomMeshPlan, refuses_a_single_cell_and_boundaries_without_a_face) {
    EXPECT_THAT(refusal([] { plan_room_mesh(box_of(0.4, 0.4, 0.4, 40.0)); }), HasSubstr("the mesh is one cell"));
    RoomMeshInput input = box_of(0.4, 0.4, 0.4, 0.02);  // corners of faces at 0, centres at 0.01
    const auto with_disc = [&](double x, double radius) {
        input.patches = {{"hole", false, {5}, MeshCylinder{Vec3(x, 0.01, 0.399), Vec3(x, 0.01, 0.401), radius}}};
        return refusal([&] { plan_room_mesh(input); });
    };
    EXPECT_THAT(with_disc(0.0, 0.008), HasSubstr("hole is too small for the cells"));
    EXPECT_EQ(with_disc(0.01, 0.008), "");
    EXPECT_EQ(with_disc(0.0, 0.012), "");
    input.refinements = {{MeshBox{Vec3(-0.1, -0.1, 0.3), Vec3(0.1, 0.1, 0.4)}, 0.01}};  // centres at 0.005 and 0.015
    EXPECT_EQ(with_disc(0.0, 0.008), "");
    input.patches = {{"band", false, {0, 1}, MeshBox{Vec3(-0.2, -0.2, 0.1), Vec3(0.2, 0.2, 0.105)}}};
    EXPECT_THAT(refusal([&] { plan_room_mesh(input); }), HasSubstr("band is too small"));
}

TEST(RoomMeshPlan, warns_of_solids_thinner_than_cells) {
    RoomMeshInput input = box_of(0.4, 0.4, 0.4, 0.02);
    input.solids = {block(Vec3(0.2, 0.2, 0.012), Vec3(0.0, 0.0, 0.2))};
    const std::vector<Mistake> warnings = room_mesh_warnings(plan_room_mesh(input));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(warnings[0].text(), HasSubstr("block is 0.012 m thin in cells of 0.02 m"));
    input.refinements = {{MeshBox{Vec3(-0.15, -0.15, 0.1), Vec3(0.15, 0.15, 0.3)}, 0.01}};
    EXPECT_TRUE(room_mesh_warnings(plan_room_mesh(input)).empty());
}

TEST(RoomMeshDictionaries, name_every_side_and_cut_the_solids) {
    RoomMeshInput input = box_of(0.4, 0.4, 0.4, 0.02);
    input.solids = {block(Vec3(0.2, 0.2, 0.1), Vec3(0.0, 0.0, 0.2))};
    input.refinements = {{MeshCylinder{Vec3(0.0, 0.0, 0.1), Vec3(0.0, 0.0, 0.3), 0.15}, 0.01}};
    const RoomMeshPlan plan = plan_room_mesh(input);
    const std::string background = room_background(plan).text(), cut = room_cut(plan).text();
    for (const char* side : k_room_sides) EXPECT_THAT(background, HasSubstr(side));
    EXPECT_THAT(background, HasSubstr("(20 20 20)"));
    EXPECT_THAT(cut, HasSubstr("block.stl"));
    EXPECT_THAT(cut, HasSubstr("searchableCylinder"));
    EXPECT_THAT(cut, ContainsRegex("levels +\\(\\(1000000000000000 1\\)\\)"));
    EXPECT_THAT(cut, ContainsRegex("snap +true"));
    input.solids.clear();
    EXPECT_THAT(room_cut(plan_room_mesh(input)).text(), ContainsRegex("snap +false"));
}

/// Later boundaries cover earlier ones: no face is in two sets.
TEST(RoomMeshDictionaries, take_faces_of_later_boundaries_from_earlier_ones) {
    RoomMeshInput input = box_of(0.5, 0.5, 0.5, 0.0625);
    input.patches = {{"walls", true, {0, 1, 2, 3}, MeshBox{Vec3(-0.25, -0.25, 0.125), Vec3(0.25, 0.25, 0.5)}},
                     {"hole", false, {1}, MeshCylinder{Vec3(0.249, 0.0, 0.2), Vec3(0.251, 0.0, 0.2), 0.05}}};
    const RoomMeshPlan plan = plan_room_mesh(input);
    const std::string selection = room_selection(plan).text(), patches = room_patches(plan).text();
    EXPECT_THAT(selection, ContainsRegex("subtract;[^}]*faceToFace;[^}]*faces_of_hole"));
    EXPECT_THAT(selection, HasSubstr("cylinderToFace"));
    // The band reaches a quarter of a cell across its sides, and not beyond its level.
    EXPECT_THAT(selection, HasSubstr("(-0.265625 -0.265625 0.125)"));
    EXPECT_THAT(selection, HasSubstr("(0.265625 0.265625 0.5)"));
    EXPECT_THAT(patches, ContainsRegex("type +wall;"));
    EXPECT_THAT(patches, ContainsRegex("type +patch;"));
}

const std::string k_log = R"(Mesh stats
    points:           5000
    cells:            4321
    boundary patches: 3

Checking topology...
    Boundary definition OK.
    Number of regions: 1 (OK).

Checking patch topology for multiply connected surfaces...
    Patch               Faces    Points   Surface topology                  
    x_min               120      143      ok (non-closed singly connected)  
    hole                0        0        ok (empty)                        
    block               64       81       ok (closed singly connected)      

Checking geometry...
    Max aspect ratio = 1.5 OK.
    Min volume = 1.25e-07. Max volume = 8e-06.  Total volume = 0.0595.  Cell volumes OK.
    Mesh non-orthogonality Max: 31.5 average: 3.25
    Max skewness = 1.25 OK.

Mesh OK.
)";

TEST(RoomMeshReport, reads_size_and_patches_with_faces) {
    const CheckMeshSize size = parse_check_mesh_size(k_log, "log");
    EXPECT_EQ(size.cells, 4321u);
    EXPECT_EQ(size.volume, 0.0595);
    EXPECT_EQ(size.volume_min, 1.25e-7);
    EXPECT_EQ(size.regions, 1u);
    EXPECT_EQ(size.patches, (std::vector<std::string>{"x_min", "block"}));
    EXPECT_THROW(parse_check_mesh_size("Mesh stats\n", "log"), ToolError);
}

TEST(RoomMeshReport, gates_each_see_their_own_fault) {
    RoomMeshInput input = box_of(0.4, 0.4, 0.4, 0.02);
    input.solids = {block(Vec3(0.2, 0.2, 0.1), Vec3(0.0, 0.0, 0.2))};
    const RoomMeshPlan plan = plan_room_mesh(input);  // 0.06 m3 of medium, 0.004 of the solid
    const CheckMeshFigures good = parse_check_mesh(k_log, "log");
    const auto failed = [&](const RoomMeshPlan& of, const CheckMeshFigures& quality, const CheckMeshSize& size) {
        std::vector<std::string> names;
        for (const MeshGate& gate : check_room_mesh(of, quality, size))
            if (!gate.passed()) names.push_back(gate.name);
        return names;
    };
    const CheckMeshSize size = parse_check_mesh_size(k_log, "log");
    EXPECT_TRUE(failed(plan, good, size).empty());
    CheckMeshSize lost = size;
    lost.volume = 0.055;  // 8 %: the solid's error is 2 % at most, and a hundredth is allowed besides
    EXPECT_EQ(failed(plan, good, lost), (std::vector<std::string>{"relative error of the medium's volume"}));
    RoomMeshPlan full = plan;  // a room that is solid but for two pipes of equal volume, one of which is closed
    full.medium_volume = 0.008;
    full.solid_volume = 0.056;
    CheckMeshSize closed = size;
    closed.volume = 0.004;
    EXPECT_EQ(failed(full, good, closed), (std::vector<std::string>{"relative error of the medium's volume"}));
    CheckMeshSize split = size;
    split.regions = 2;
    EXPECT_EQ(failed(plan, good, split), (std::vector<std::string>{"number of parts that no face connects"}));
    CheckMeshFigures skew = good;
    skew.skewness_max = 5.0;
    EXPECT_EQ(failed(plan, skew, size), (std::vector<std::string>{"skewness"}));
    input.patches = {{"hole", false, {5}, std::nullopt}};
    EXPECT_EQ(failed(plan_room_mesh(input), good, size), (std::vector<std::string>{"missing patches"}));
    try {
        require_gates(check_room_mesh(plan_room_mesh(input), good, size));
        FAIL() << "passed";
    } catch (const CheckFailure& failure) {
        EXPECT_THAT(failure.what(), HasSubstr("No face belongs to hole"));
    }
    EXPECT_THROW(require_gates(check_room_mesh(plan, good, lost)), CheckFailure);
}

}  // namespace
}  // namespace cutterflow::meshing
