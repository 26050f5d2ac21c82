#include "solver/liggghts/wall_surface.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"

namespace cutterflow::liggghts {
namespace {

const std::vector<Triangle> k_tetrahedron = {{Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0)},
                                             {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)},
                                             {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(0, 1, 0)},
                                             {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}};

std::filesystem::path scratch(const std::string& name) {
    const auto folder = std::filesystem::path(CUTTERFLOW_BUILD_DIR) / "tests" / "wall_surface";
    std::filesystem::create_directories(folder);
    return folder / name;
}

TEST(WallSurface, distance_reaches_face_edges_and_corners) {
    const Triangle triangle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    EXPECT_NEAR(distance_to(triangle, Vec3(0.2, 0.3, 0.5)), 0.5, 1e-15);
    EXPECT_NEAR(distance_to(triangle, Vec3(0.2, 0.3, -0.5)), 0.5, 1e-15);
    EXPECT_NEAR(distance_to(triangle, Vec3(0.5, -0.3, 0.4)), 0.5, 1e-15);
    EXPECT_NEAR(distance_to(triangle, Vec3(-3, -4, 0)), 5.0, 1e-15);
    EXPECT_NEAR(distance_to(triangle, Vec3(1, 1, 0)), std::sqrt(0.5), 1e-15);
    const Triangle needle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, 0)};
    EXPECT_NEAR(distance_to(needle, Vec3(0.5, 2, 0)), 2.0, 1e-15);
}

TEST(WallSurface, the_inside_of_a_closed_surface_is_known_whatever_its_orientation) {
    std::vector<Triangle> inside_out = k_tetrahedron;
    for (Triangle& triangle : inside_out) std::swap(triangle[0], triangle[1]);
    for (const auto& surface : {k_tetrahedron, inside_out}) {
        EXPECT_TRUE(is_inside(WallSurface(surface).winding_number(Vec3(0.1, 0.1, 0.1))));
        EXPECT_FALSE(is_inside(WallSurface(surface).winding_number(Vec3(0.4, 0.4, 0.4))));
        EXPECT_FALSE(is_inside(WallSurface(surface).winding_number(Vec3(-2, 0.1, 0.1))));
    }
}

TEST(WallSurface, an_open_surface_has_no_inside) {
    const std::vector<Triangle> open(k_tetrahedron.begin(), k_tetrahedron.end() - 1);
    EXPECT_FALSE(is_inside(WallSurface(open).winding_number(Vec3(0.05, 0.05, 0.05))));
}

TEST(WallSurface, nearness_is_that_of_the_nearest_triangle) {
    const WallSurface surface(k_tetrahedron);
    EXPECT_TRUE(surface.is_within(Vec3(0.2, 0.2, -0.0999), 0.1));
    EXPECT_FALSE(surface.is_within(Vec3(0.2, 0.2, -0.1001), 0.1));
    const Vec3 outwards = Vec3(1, 1, 1).normalized();
    EXPECT_TRUE(surface.is_within(Vec3(1, 1, 1) / 3.0 + 0.0999 * outwards, 0.1));
    EXPECT_FALSE(surface.is_within(Vec3(1, 1, 1) / 3.0 + 0.1001 * outwards, 0.1));
}

TEST(WallSurface, ascii_and_binary_files_give_the_same_triangles) {
    const auto ascii = scratch("ascii.stl");
    const auto binary = scratch("binary.stl");
    {
        std::ofstream text(ascii);
        text << "solid\n";
        std::ofstream bytes(binary, std::ios::binary);
        const std::string header(80, 's');
        const std::uint32_t count = static_cast<std::uint32_t>(k_tetrahedron.size());
        bytes.write(header.data(), 80).write(reinterpret_cast<const char*>(&count), 4);
        for (const Triangle& triangle : k_tetrahedron) {
            const char blank[12] = {};
            bytes.write(blank, 12);
            text << "facet normal 0 0 0\nouter loop\n";
            for (const Vec3& corner : triangle) {
                text << "vertex " << corner.transpose() << '\n';
                const Eigen::Vector3f single = corner.cast<float>();
                bytes.write(reinterpret_cast<const char*>(single.data()), 12);
            }
            text << "endloop\nendfacet\n";
            bytes.write(blank, 2);
        }
        text << "endsolid\n";
    }
    EXPECT_EQ(read_stl(ascii), k_tetrahedron);
    EXPECT_EQ(read_stl(binary), k_tetrahedron);
}

TEST(WallSurface, files_that_hold_no_wall_are_refused) {
    EXPECT_THROW(read_stl(scratch("missing.stl")), UserError);
    std::ofstream(scratch("empty.stl")) << "solid nothing\nendsolid\n";
    EXPECT_THROW(read_stl(scratch("empty.stl")), UserError);
    std::ofstream(scratch("short.stl")) << "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0\n";
    EXPECT_THROW(read_stl(scratch("short.stl")), UserError);
}

}  // namespace
}  // namespace cutterflow::liggghts
