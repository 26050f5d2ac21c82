// The bounding volume hierarchy against tests of every triangle.
#include <random>

#include <gtest/gtest.h>

#include "solver/ports/testing/synthetic_mesh.hpp"
#include "solver/space/shadow_map.hpp"
#include "solver/space/steel_tree.hpp"

namespace cutterflow::coupling {
namespace {

std::vector<SteelTriangle> random_triangles(int count, std::mt19937& random) {
    std::uniform_real_distribution<double> place(-1.0, 1.0), size(-0.1, 0.1);
    const auto point = [&](auto& distribution) { return Vec3(distribution(random), distribution(random), distribution(random)); };
    std::vector<SteelTriangle> triangles;
    for (int i = 0; i < count; ++i) {
        const Vec3 a = point(place);
        triangles.push_back({a, a + point(size), a + point(size)});
    }
    return triangles;
}

/// Signed volumes: the segment passes through the triangle when its ends lie on both sides of the plane and the edges turn alike around it.
bool passes_through(const SteelTriangle& t, const Vec3& a, const Vec3& b) {
    const auto volume = [](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) { return (q - p).cross(r - p).dot(s - p); };
    if ((volume(a, t.a, t.b, t.c) > 0) == (volume(b, t.a, t.b, t.c) > 0)) return false;
    const bool ab = volume(a, b, t.a, t.b) > 0, bc = volume(a, b, t.b, t.c) > 0, ca = volume(a, b, t.c, t.a) > 0;
    return ab == bc && bc == ca;
}

/// Triangles of a sphere about a centre.
void add_sphere(const Vec3& centre, double radius, int n, std::vector<SteelTriangle>& triangles) {
    const auto point = [&](int i, int j) -> Vec3 {
        const double polar = k_pi * i / n, azimuth = k_pi * j / n;
        return centre + radius * Vec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < 2 * n; ++j) {
            if (i > 0) triangles.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
            if (i + 1 < n) triangles.push_back({point(i, j + 1), point(i + 1, j), point(i + 1, j + 1)});
        }
}

/// What a shadow map says of random places around random points: it may ask for a test in vain, but never leave one out.
TEST(ShadowMap, clears_only_what_no_triangle_hides) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-0.9, 0.9);
    const auto point = [&] { return Vec3(place(random), place(random), place(random)); };
    constexpr double reach = 1.0;
    int clear = 0, visible = 0;
    for (const int count : {3, 40, 400}) {
        const std::vector<SteelTriangle> triangles = random_triangles(count, random);
        const SteelTree tree(triangles);
        for (int i = 0; i < 40; ++i) {
            // Every fourth point lies on a corner of a triangle or beside it.
            const SteelTriangle& nearest = triangles[static_cast<std::size_t>(i) % triangles.size()];
            const Vec3 from = i % 4 == 0 ? nearest.a : i % 4 == 1 ? Vec3(nearest.b + Vec3::Constant(1e-6)) : point();
            const ShadowMap shadows(tree, from, reach);
            for (int j = 0; j < 500; ++j) {
                const Vec3 to = from + (point() - from) * 0.5;
                if ((to - from).norm() >= reach) continue;
                const bool blocked = tree.blocks(from, to);
                if (shadows.is_clear(to - from)) {
                    EXPECT_FALSE(blocked);
                    ++clear;
                }
                if (!blocked) ++visible;
            }
        }
    }
    EXPECT_GT(clear, visible / 2);
}

/// The triangles of one bin tell what all triangles tell, from anywhere: in the open, in the plane of a triangle, on a corner, beside one.
TEST(ShadowMap, blocks_the_lines_that_the_tree_blocks) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-0.9, 0.9);
    const auto point = [&] { return Vec3(place(random), place(random), place(random)); };
    constexpr double reach = 1.0;
    int blocked = 0, lines = 0;
    for (const int count : {1, 30, 600}) {
        const std::vector<SteelTriangle> triangles = random_triangles(count, random);
        const SteelTree tree(triangles);
        for (int i = 0; i < 60; ++i) {
            const SteelTriangle& t = triangles[static_cast<std::size_t>(i) % triangles.size()];
            const Vec3 in_plane = 3.0 * t.a - 1.2 * t.b - 0.8 * t.c, beside = t.b + Vec3::Constant(1e-6);
            const Vec3 from = i % 4 == 0 ? t.a : i % 4 == 1 ? beside : i % 4 == 2 ? in_plane : point();
            const ShadowMap shadows(tree, from, reach);
            for (int j = 0; j < 300; ++j) {
                const Vec3 to = from + 0.5 * point();
                if ((to - from).norm() >= reach) continue;
                const bool expected = tree.blocks(from, to);
                ASSERT_EQ(shadows.blocks(to - from), expected) << count << ' ' << i << ' ' << j;
                blocked += expected ? 1 : 0;
                ++lines;
            }
        }
    }
    EXPECT_GT(blocked, lines / 20);
    EXPECT_LT(blocked, lines - lines / 20);
}

TEST(SteelTree, overlooks_no_triangle_that_meets_a_box) {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> place(-1.0, 1.0), share(0.0, 1.0);
    const auto triangles = random_triangles(300, random);
    const SteelTree tree(triangles);
    int without = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 a(place(random), place(random), place(random)), b = a + 0.15 * Vec3(place(random), place(random), place(random));
        const Box box{a.cwiseMin(b), a.cwiseMax(b)};
        if (tree.may_meet(box)) continue;
        ++without;
        for (const SteelTriangle& t : triangles)
            for (int k = 0; k < 5; ++k) {
                const double u = share(random), v = (1.0 - u) * share(random);
                const Vec3 x = t.a + u * (t.b - t.a) + v * (t.c - t.a);
                ASSERT_FALSE((x.array() >= box.lower.array()).all() && (x.array() <= box.upper.array()).all());
            }
    }
    EXPECT_GT(without, 300);
    // A box that holds a corner, and nothing else, meets its triangle.
    for (const SteelTriangle& t : triangles) EXPECT_TRUE(tree.may_meet({t.a, t.a}));
}

/// Towards the corners of triangles, where bins and caps are closest to their rounding.
TEST(ShadowMap, does_not_clear_a_triangles_edge) {
    std::mt19937 random(9);
    const std::vector<SteelTriangle> triangles = random_triangles(200, random);
    const SteelTree tree(triangles);
    const ShadowMap shadows(tree, Vec3::Zero(), 3.0);
    for (const SteelTriangle& triangle : triangles)
        for (const Vec3& corner : {triangle.a, triangle.b, triangle.c, Vec3(0.5 * (triangle.a + triangle.b))}) {
            EXPECT_FALSE(shadows.is_clear(corner));
            EXPECT_FALSE(shadows.is_clear(1.5 * corner));
        }
}

TEST(ShadowMap, of_no_steel_clears_everything) {
    const ShadowMap shadows(SteelTree({}), Vec3::Zero(), 1.0);
    EXPECT_TRUE(shadows.is_clear(Vec3(0.3, -0.2, 0.9)));
}

TEST(SteelTree, tells_inside_from_outside_of_solids_above_a_tanks_floor) {
    std::vector<SteelTriangle> triangles;
    const Vec3 first(0.2, 0.0, 0.0), second(-0.5, 0.4, 0.1);
    add_sphere(first, 0.3, 40, triangles);
    add_sphere(second, 0.2, 40, triangles);
    for (const double z : {-1.0, 1.0}) {  // floor and cover
        triangles.push_back({Vec3(-2, -2, z), Vec3(2, -2, z), Vec3(2, 2, z)});
        triangles.push_back({Vec3(-2, -2, z), Vec3(2, 2, z), Vec3(-2, 2, z)});
    }
    const SteelTree tree(triangles);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.9, 0.9);
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 x(place(random), place(random), place(random));
        const double depth = std::max(0.3 - (x - first).norm(), 0.2 - (x - second).norm());
        if (std::abs(depth) < 1e-3) continue;  // between the sphere and its triangles
        EXPECT_EQ(tree.contains(x), depth > 0.0) << x.transpose();
        inside += depth > 0.0 ? 1 : 0;
    }
    EXPECT_GT(inside, 300);
    EXPECT_FALSE(tree.contains(Vec3(0, 0, 5)));
    EXPECT_FALSE(SteelTree({}).contains(Vec3::Zero()));
}

TEST(SteelTree, finds_what_a_test_of_every_triangle_finds) {
    std::mt19937 random(3);
    const auto triangles = random_triangles(2000, random);
    const SteelTree tree(triangles);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    int blocked = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 a(place(random), place(random), place(random)), b(place(random), place(random), place(random));
        const bool expected =
            std::any_of(triangles.begin(), triangles.end(), [&](const SteelTriangle& t) { return passes_through(t, a, b); });
        ASSERT_EQ(tree.blocks(a, b), expected) << i;
        blocked += expected ? 1 : 0;
    }
    EXPECT_GT(blocked, 300);
    EXPECT_LT(blocked, 2900);
}

TEST(SteelTree, measures_the_distance_that_sampling_finds) {
    std::mt19937 random(5);
    const auto triangles = random_triangles(200, random);
    const SteelTree tree(triangles);
    std::uniform_real_distribution<double> place(-1.2, 1.2);
    for (int i = 0; i < 50; ++i) {
        const Vec3 p(place(random), place(random), place(random));
        double nearest = 10.0;
        constexpr int n = 60;
        for (const SteelTriangle& t : triangles)
            for (int u = 0; u <= n; ++u)
                for (int v = 0; u + v <= n; ++v) nearest = std::min(nearest, (t.a + (t.b - t.a) * u / n + (t.c - t.a) * v / n - p).norm());
        const double found = tree.distance(p, 10.0);
        EXPECT_LE(found, nearest + 1e-12);
        EXPECT_GT(found, nearest - 0.2 / n);
        EXPECT_EQ(tree.distance(p, 0.5 * found), 0.5 * found);
    }
}

TEST(SteelTree, lets_nothing_slip_through_shared_edges_and_corners) {
    testing::SyntheticMesh mesh;
    mesh.add_sheet(Vec3(0, -1, -1), Vec3(0, 2, 0), Vec3(0, 0, 2), 20, 20, true);
    const SteelTree tree(mesh.rotor_steel);
    for (int i = -9; i <= 9; ++i)
        for (int j = -9; j <= 9; ++j) {
            const Vec3 corner(0, 0.1 * i, 0.1 * j);
            for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(1, 0.3, 0.3), Vec3(0.2, 0.7, -0.1)}) {
                EXPECT_TRUE(tree.blocks(corner - 0.1 * direction, corner + 0.1 * direction));
                const Vec3 on_edge = corner + Vec3(0, 0.05, 0.05);
                EXPECT_TRUE(tree.blocks(on_edge - 0.04 * direction, on_edge + 0.04 * direction));
            }
        }
}

TEST(SteelTree, sees_no_steel_where_there_is_none) {
    const SteelTree tree({});
    EXPECT_FALSE(tree.blocks(Vec3(0, 0, 0), Vec3(1, 1, 1)));
    EXPECT_EQ(tree.distance(Vec3(0, 0, 0), 0.3), 0.3);
}

}  // namespace
}  // namespace cutterflow::coupling
