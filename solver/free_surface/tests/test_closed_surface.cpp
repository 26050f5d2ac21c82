/// A closed surface as a still solid: lines, inside, nearest place, and what it covers of cells.
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/surface/surface.hpp"
#include "solver/free_surface/cut_cells/cut_cells.hpp"
#include "solver/free_surface/surface_run.hpp"

namespace cutterflow::free_surface {
namespace {

geometry::TriangleSurface box(const Vec3& from, const Vec3& to) {
    geometry::TriangleSurface surface;
    for (int n = 0; n < 8; ++n)
        surface.points.emplace_back((n & 1) != 0 ? to.x() : from.x(), (n & 2) != 0 ? to.y() : from.y(), (n & 4) != 0 ? to.z() : from.z());
    surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                         {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return surface;
}

/// A ball of facets between parallels and meridians, its points on the sphere.
geometry::TriangleSurface ball(const Vec3& centre, double radius, std::uint32_t parallels, std::uint32_t meridians) {
    geometry::TriangleSurface surface;
    const auto at = [&](std::uint32_t parallel, std::uint32_t meridian) { return 1 + parallel * meridians + meridian % meridians; };
    surface.points.emplace_back(centre + Vec3(0, 0, -radius));
    for (std::uint32_t p = 0; p < parallels; ++p) {
        const double height = -std::cos(k_pi * (p + 1) / (parallels + 1)), round = std::sqrt(1.0 - height * height);
        for (std::uint32_t m = 0; m < meridians; ++m) {
            const double angle = 2.0 * k_pi * m / meridians;
            surface.points.emplace_back(centre + radius * Vec3(round * std::cos(angle), round * std::sin(angle), height));
        }
    }
    const auto top = static_cast<std::uint32_t>(surface.points.size());
    surface.points.emplace_back(centre + Vec3(0, 0, radius));
    for (std::uint32_t m = 0; m < meridians; ++m) {
        surface.triangles.push_back({0, at(0, m + 1), at(0, m)});
        surface.triangles.push_back({top, at(parallels - 1, m), at(parallels - 1, m + 1)});
        for (std::uint32_t p = 0; p + 1 < parallels; ++p) {
            surface.triangles.push_back({at(p, m), at(p, m + 1), at(p + 1, m)});
            surface.triangles.push_back({at(p, m + 1), at(p + 1, m + 1), at(p + 1, m)});
        }
    }
    return surface;
}

StillSolid solid(geometry::TriangleSurface surface) {
    return SolidSurface{std::make_shared<const ClosedSurface>(std::move(surface))};
}

/// Lines through its faces' diagonals, edges and corners: each is cut like a line beside it.
TEST(ClosedSurface, cuts_every_line_in_pairs) {
    const Vec3 from(0.1, 0.2, 0.3), to(0.4, 0.6, 0.8);
    const ClosedSurface surface(box(from, to));
    for (int d = 0; d < 3; ++d) {
        const int a = (d + 1) % 3, b = (d + 2) % 3;
        for (int m = -1; m <= 9; ++m) {
            for (int n = -1; n <= 9; ++n) {
                Vec3 through = Vec3::Zero();
                through[a] = from[a] + 0.125 * m * (to[a] - from[a]);
                through[b] = from[b] + 0.125 * n * (to[b] - from[b]);
                const auto parts = surface.parts(d, through);
                if (m > 0 && m < 8 && n > 0 && n < 8) {
                    ASSERT_EQ(parts.size(), 1u);
                    EXPECT_NEAR(parts[0].from, from[d], 1e-15);
                    EXPECT_NEAR(parts[0].to, to[d], 1e-15);
                } else if (m < 0 || m > 8 || n < 0 || n > 8) {
                    EXPECT_TRUE(parts.empty());
                }
            }
        }
    }
}

TEST(ClosedSurface, tells_inside_and_the_nearest_place) {
    const StillSolid shape = solid(ball(Vec3(0.5, 0.5, 0.5), 0.3, 63, 128));
    const Vec3 inside(0.55, 0.45, 0.7);
    ASSERT_TRUE(way_out(shape, inside).has_value());
    const Vec3 outward = (inside - Vec3::Constant(0.5)).normalized();
    EXPECT_NEAR((*way_out(shape, inside) - (Vec3::Constant(0.5) + 0.3 * outward)).norm(), 0.0, 0.02 * 0.3);
    EXPECT_FALSE(way_out(shape, Vec3(0.5, 0.5, 0.81)).has_value());
    EXPECT_FALSE(way_out(shape, Vec3(0.1, 0.1, 0.1)).has_value());
}

/// A box of triangles covers what the box itself does, cell by cell and face by face.
TEST(ClosedSurface, of_a_box_covers_what_the_box_covers) {
    const StaggeredGrid grid = StaggeredGrid::space(10, 8, 9, 0.01);
    const Vec3 from(0.0212, 0.0171, 0.0238), to(0.0733, 0.0549, 0.0601);
    const CellCutter exact(grid, {SolidBox{from, to}}), facets(grid, {solid(box(from, to))});
    for (const int d : grid.directions()) {
        grid.for_each_face(
            d, [&](int face, int, int, int) { EXPECT_NEAR(facets.still().open[d][face], exact.still().open[d][face], 1e-12) << d; });
    }
    grid.for_each_cell(
        [&](int cell, int, int, int) { EXPECT_NEAR(facets.still().open_volume[cell], exact.still().open_volume[cell], 1e-12); });
}

/// Sixteen by sixteen lines a cell: the volume that a ball of eight cells covers is that of its facets within 2e-4.
TEST(ClosedSurface, of_a_ball_covers_its_volume) {
    const StaggeredGrid grid = StaggeredGrid::space(12, 12, 12, 0.01);
    const geometry::TriangleSurface surface = ball(Vec3(0.0613, 0.0587, 0.0602), 0.04, 31, 64);
    const CellCutter cutter(grid, {solid(surface)});
    double covered = 0.0;
    grid.for_each_cell([&](int cell, int, int, int) { covered += (1.0 - cutter.still().open_volume[cell]) * grid.cell_volume(); });
    EXPECT_NEAR(covered / geometry::volume_of(surface), 1.0, 2e-4);
}

/// Water at rest around a drowned ball stays at rest, and every particle stays out of it.
TEST(ClosedSurface, water_rests_around_it) {
    SceneSettings scene;
    scene.tank.plane = false;
    scene.tank.cells = {16, 16, 20};
    scene.tank.cell = 0.01;
    scene.water.filled = {{Vec3::Constant(-1), Vec3(1, 1, 0.16)}};
    scene.solids = {solid(ball(Vec3(0.0813, 0.0787, 0.0702), 0.04, 31, 64))};
    SurfaceRun run(scene, nullptr);
    double fastest = 0.0;
    for (int n = 0; n < 20; ++n) {
        run.step(5e-3);
        fastest = std::max(fastest, largest_speed(run.particles()));
    }
    EXPECT_LT(fastest, 0.02 * std::sqrt(9.81 * 0.16));
    EXPECT_NEAR(run.last().occupied_volume / run.initial_volume(), 1.0, 0.01);
    for (std::size_t p = 0; p < run.particles().size(); ++p) ASSERT_FALSE(is_inside(scene.solids[0], run.particles().place(p)));
}

}  // namespace
}  // namespace cutterflow::free_surface
