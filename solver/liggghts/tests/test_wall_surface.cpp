#include "solver/liggghts/wall_surface.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "solver/liggghts/steel_wall.hpp"
#include "solver/liggghts/tests/engine_fixture.hpp"

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

TEST(WallSurface, nearest_points_lie_on_face_edges_and_corners) {
    const auto distance = [](const Triangle& surface, const Vec3& point) { return (nearest_point(surface, point) - point).norm(); };
    const Triangle triangle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    EXPECT_NEAR(distance(triangle, Vec3(0.2, 0.3, 0.5)), 0.5, 1e-15);
    EXPECT_NEAR(distance(triangle, Vec3(0.2, 0.3, -0.5)), 0.5, 1e-15);
    EXPECT_NEAR(distance(triangle, Vec3(0.5, -0.3, 0.4)), 0.5, 1e-15);
    EXPECT_NEAR(distance(triangle, Vec3(-3, -4, 0)), 5.0, 1e-15);
    EXPECT_NEAR(distance(triangle, Vec3(1, 1, 0)), std::sqrt(0.5), 1e-15);
    const Triangle needle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, 0)};
    EXPECT_NEAR(distance(needle, Vec3(0.5, 2, 0)), 2.0, 1e-15);
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

TEST(WallSurface, triangles_near_a_point_are_those_that_a_test_of_each_finds) {
    const std::vector<Triangle> box = tests::block(Vec3(-0.1, -0.2, -0.3), Vec3(0.1, 0.2, 0.3), 9);
    const WallSurface surface(box);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-0.35, 0.35);
    std::size_t found = 0;
    for (int k = 0; k < 300; ++k) {
        const Vec3 point(coordinate(random), coordinate(random), coordinate(random));
        const auto is_near = [&](const Triangle& triangle) { return (nearest_point(triangle, point) - point).norm() < 0.05; };
        const auto expected = static_cast<std::size_t>(std::count_if(box.begin(), box.end(), is_near));
        const NearTriangles near = surface.near(point, 0.05);
        EXPECT_EQ(near.triangles.size(), expected);
        ASSERT_EQ(near.numbers.size(), expected);
        for (std::size_t n = 0; n < expected; ++n)
            for (int corner = 0; corner < 3; ++corner)
                EXPECT_NEAR((near.triangles[n][corner] - box[near.numbers[n]][corner]).norm(), 0.0, 1e-15);
        found += expected;
    }
    EXPECT_GT(found, 500u);
}

/// Places of `triangles` that a sphere of radius 0.01 reaches, coincident ones once.
std::vector<Vec3> places(const std::vector<Triangle>& triangles, const Vec3& centre) {
    std::vector<Vec3> found;
    for (const SteelPoint& point : reached_points(triangles, centre, 0.01)) {
        EXPECT_NEAR((point.place - centre).norm(), point.distance, 1e-15);
        const auto is_same = [&](const Vec3& other) { return (other - point.place).norm() < 1e-9; };
        if (std::none_of(found.begin(), found.end(), is_same)) found.push_back(point.place);
    }
    return found;
}

// At an overlap of 40 % some seventy of the plane's triangles lie within the sphere.
TEST(ReachedPoints, seams_of_a_plane_do_not_count_however_deep_the_sphere) {
    const std::vector<Triangle> plane = tests::sheet(Vec3(-0.02, -0.02, 0), Vec3(0.04, 0, 0), Vec3(0, 0.04, 0), 20, 20);
    for (const Vec3& foot : {Vec3(3e-4, 7e-4, 0), Vec3(0, 0, 0), Vec3(1e-3, 0, 0), Vec3(2e-3, 1e-12, 0)}) {
        const std::vector<Vec3> found = places(plane, foot + Vec3(0, 0, 0.006));
        ASSERT_EQ(found.size(), 1u) << foot.transpose();
        EXPECT_NEAR((found[0] - foot).norm(), 0.0, 1e-11);
    }
}

TEST(ReachedPoints, an_edge_counts_where_the_surface_is_nearest_there) {
    const std::vector<Triangle> block = tests::block(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1), 10);
    const Vec3 on_edge(0.1, 0.013, 0.1);
    const std::vector<Vec3> outside = places(block, on_edge + Vec3(0.005, 0, 0.005));
    ASSERT_EQ(outside.size(), 1u);
    EXPECT_NEAR((outside[0] - on_edge).norm(), 0.0, 1e-15);
    // In the block's corner from inside: three faces, no edge.
    EXPECT_EQ(places(block, Vec3(0.095, 0.094, 0.093)).size(), 3u);
    EXPECT_TRUE(places(block, Vec3(0.1, 0.0, 0.11001)).empty());
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
