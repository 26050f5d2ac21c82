#include "meshing/cutter/background_mesh.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <regex>
#include <set>

#include "geometry/head/head_names.hpp"
#include "meshing/cutter/mesh_dictionaries.hpp"
#include "meshing/tests/model_mesh.hpp"

namespace cutterflow::meshing {
namespace {

struct Block {
    std::array<std::size_t, 8> corners;
    std::string zone;
    std::array<int, 3> cells;
};

/// blockMeshDict read back.
struct BlockMesh {
    std::vector<Vec3> vertices;
    std::vector<Block> blocks;
    std::map<std::string, std::vector<std::array<std::size_t, 4>>> patches;
};

std::string section(const std::string& text, const std::string& key) {
    const auto begin = text.find("\n" + key + " ");
    return text.substr(begin, text.find("\n)", begin) - begin);
}

BlockMesh read_blocks(const FoamDictionary& dictionary) {
    const std::string text = "\n" + dictionary.text();
    const std::string number = "([-+0-9.e]+)";
    BlockMesh mesh;
    const auto each = [](const std::string& where, const std::string& pattern, auto&& use) {
        const std::regex regex(pattern);
        for (std::sregex_iterator i(where.begin(), where.end(), regex), end; i != end; ++i) use(*i);
    };
    each(section(text, "vertices"), "\\(" + number + " " + number + " " + number + "\\)",
         [&](const std::smatch& m) { mesh.vertices.emplace_back(std::stod(m[1]), std::stod(m[2]), std::stod(m[3])); });
    each(section(text, "blocks"), "hex \\(([0-9 ]+)\\) (\\w+) \\((\\d+) (\\d+) (\\d+)\\) simpleGrading", [&](const std::smatch& m) {
        Block block{{}, m[2], {std::stoi(m[3]), std::stoi(m[4]), std::stoi(m[5])}};
        std::istringstream corners(m[1].str());
        for (std::size_t& corner : block.corners) corners >> corner;
        mesh.blocks.push_back(block);
    });
    each(section(text, "boundary"), "(\\w+)\\s*\\{\\s*type\\s+\\w+;\\s*faces\\s+\\(([^{}]*)\\);", [&](const std::smatch& patch) {
        each(patch[2], "\\((\\d+) (\\d+) (\\d+) (\\d+)\\)", [&](const std::smatch& m) {
            mesh.patches[patch[1]].push_back({std::stoul(m[1]), std::stoul(m[2]), std::stoul(m[3]), std::stoul(m[4])});
        });
    });
    return mesh;
}

class BackgroundMesh : public testing::TestWithParam<const char*> {
protected:
    MeshPlan plan = plan_mesh(model_mesh_input(GetParam()));
    BlockMesh mesh = read_blocks(background_mesh(plan));
};

TEST_P(BackgroundMesh, has_the_cells_that_the_plan_counts) {
    std::map<std::string, std::size_t> cells;
    for (const Block& block : mesh.blocks) cells[block.zone] += static_cast<std::size_t>(block.cells[0] * block.cells[1] * block.cells[2]);
    EXPECT_EQ(cells.size(), 2u);
    EXPECT_EQ(cells[names::rotor_zone], plan.background_rotor_cells());
    EXPECT_EQ(cells[names::rotor_zone] + cells[k_stator_zone], plan.background_cells());
}

TEST_P(BackgroundMesh, is_made_of_right_handed_blocks) {
    for (const Block& block : mesh.blocks) {
        const auto edge = [&](int to) { return Vec3(mesh.vertices[block.corners[to]] - mesh.vertices[block.corners[0]]); };
        EXPECT_GT(edge(1).cross(edge(3)).dot(edge(4)), 0.0);
    }
}

TEST_P(BackgroundMesh, keeps_rotor_and_stator_apart) {
    std::map<std::string, std::set<std::size_t>> corners;
    for (const Block& block : mesh.blocks) corners[block.zone].insert(block.corners.begin(), block.corners.end());
    for (const std::size_t corner : corners[names::rotor_zone]) EXPECT_EQ(corners[k_stator_zone].count(corner), 0u);
}

TEST_P(BackgroundMesh, has_two_like_sides_of_the_interface) {
    const auto outline = [&](const char* patch) {
        std::set<std::array<long, 3>> points;
        for (const auto& face : mesh.patches[patch])
            for (const std::size_t corner : face) {
                const Vec3& p = mesh.vertices[corner];
                points.insert({std::lround(1e9 * p.x()), std::lround(1e9 * p.y()), std::lround(1e9 * p.z())});
            }
        return points;
    };
    EXPECT_FALSE(outline(k_rotor_side_patch).empty());
    EXPECT_EQ(outline(k_rotor_side_patch), outline(k_stator_side_patch));
    EXPECT_EQ(mesh.patches[k_rotor_side_patch].size(), mesh.patches[k_stator_side_patch].size());
}

TEST_P(BackgroundMesh, gives_every_outer_face_of_its_blocks_to_one_patch) {
    constexpr int k_faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 4, 7, 3}, {1, 2, 6, 5}};
    std::map<std::array<std::size_t, 4>, int> open;
    const auto sorted = [](std::array<std::size_t, 4> face) {
        std::sort(face.begin(), face.end());
        return face;
    };
    for (const Block& block : mesh.blocks)
        for (const auto& face : k_faces)
            ++open[sorted({block.corners[face[0]], block.corners[face[1]], block.corners[face[2]], block.corners[face[3]]})];
    std::size_t outer = 0;
    for (const auto& [face, blocks] : open) outer += blocks == 1;
    std::set<std::array<std::size_t, 4>> patched;
    for (const auto& [name, faces] : mesh.patches)
        for (const auto& face : faces) {
            EXPECT_EQ(open[sorted(face)], 1) << name;
            EXPECT_TRUE(patched.insert(sorted(face)).second) << name;
        }
    EXPECT_EQ(patched.size(), outer);
}

INSTANTIATE_TEST_SUITE_P(presets, BackgroundMesh, testing::Values("draft", "standard", "paper"));

Vec3 location(const std::string& text, const std::string& zone) {
    std::smatch m;
    EXPECT_TRUE(std::regex_search(text, m, std::regex("\\(\\(([-+0-9.e]+) ([-+0-9.e]+) ([-+0-9.e]+)\\) " + zone + "\\)"))) << text;
    return {std::stod(m[1]), std::stod(m[2]), std::stod(m[3])};
}

TEST(SteelCut, starts_in_the_water_of_both_zones) {
    const MeshPlan plan = plan_mesh(model_mesh_input());
    const std::string text = steel_cut(plan).text();
    const Vec3 rotor = location(text, "rotor"), stator = location(text, "stator");
    EXPECT_LT(rotor.head<2>().norm(), plan.rotor.radius);
    EXPECT_GT(rotor.z(), plan.rotor.z_bottom);
    EXPECT_LT(rotor.z(), plan.input.cutter.z_min);
    EXPECT_GT(stator.head<2>().norm(), plan.rotor.radius);
    EXPECT_LT(stator.head<2>().norm(), plan.input.tank.radius);
    EXPECT_LT(stator.z(), plan.input.steel.gap);
}

TEST(OutletSelection, ends_within_the_wall_of_the_pipe) {
    MeshInput input = model_mesh_input();
    input.steel.mouth.azimuth = 0.5;
    const std::string text = outlet_selection(plan_mesh(input)).text();
    std::smatch m;
    ASSERT_TRUE(std::regex_search(text, m, std::regex("p1\\s+\\(([-+0-9.e]+) ([-+0-9.e]+) ([-+0-9.e]+)\\)")));
    EXPECT_NEAR(std::stod(m[1]), 0.22 * std::cos(0.5), 1e-9);
    EXPECT_NEAR(std::stod(m[2]), 0.22 * std::sin(0.5), 1e-9);
    ASSERT_TRUE(std::regex_search(text, m, std::regex("radius\\s+([0-9.]+);")));
    EXPECT_GT(std::stod(m[1]), input.steel.mouth.radius);
    EXPECT_LT(std::stod(m[1]), input.steel.mouth.radius + input.steel.pipe_wall);
}

}  // namespace
}  // namespace cutterflow::meshing
