/// Exact covered lengths, areas and volumes against midpoint sums that know nothing of arcs.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/free_surface/cut_cells/covered_area.hpp"
#include "solver/free_surface/cut_cells/cut_cells.hpp"
#include "solver/free_surface/cut_cells/still_solids.hpp"
#include "solver/free_surface/transfer.hpp"

namespace cutterflow::free_surface {
namespace {

double summed_disc(double radius, const Interval& a, const Interval& b, int strips) {
    double area = 0.0;
    const double width = a.length() / strips;
    for (int n = 0; n < strips; ++n) {
        const double x = a.from + (n + 0.5) * width;
        if (std::abs(x) < radius) area += width * common(chord(x, 0.0, radius), b).length();
    }
    return area;
}

TEST(DiscInRectangle, agrees_with_strips_for_random_rectangles) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-1.4, 1.4), size(0.01, 1.5);
    for (int n = 0; n < 200; ++n) {
        const double x = place(random), y = place(random);
        const Interval a{x, x + size(random)}, b{y, y + size(random)};
        EXPECT_NEAR(disc_in_rectangle(1.0, a, b), summed_disc(1.0, a, b, 20000), 2e-5) << x << " " << y;
    }
}

TEST(DiscInRectangle, is_the_whole_disc_and_nothing) {
    EXPECT_NEAR(disc_in_rectangle(0.7, {-2, 2}, {-3, 1}), k_pi * 0.49, 1e-12);
    EXPECT_NEAR(disc_in_rectangle(0.7, {0, 2}, {0, 2}), k_pi * 0.49 / 4, 1e-12);
    EXPECT_EQ(disc_in_rectangle(0.7, {0.6, 2}, {0.6, 2}), 0.0);
    EXPECT_EQ(disc_in_rectangle(0.7, {0.8, 2}, {-1, 1}), 0.0);
}

TEST(SphereInBox, agrees_with_strips_of_exact_discs) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> place(-1.2, 1.0), size(0.05, 1.0);
    for (int n = 0; n < 40; ++n) {
        const double x = place(random), y = place(random), z = place(random);
        const Interval a{x, x + size(random)}, b{y, y + size(random)}, c{z, z + size(random)};
        double sum = 0.0;
        const int strips = 4000;
        for (int s = 0; s < strips; ++s) {
            const double at = c.from + (s + 0.5) / strips * c.length();
            if (std::abs(at) < 1.0) sum += c.length() / strips * disc_in_rectangle(std::sqrt(1.0 - at * at), a, b);
        }
        EXPECT_NEAR(sphere_in_box(1.0, a, b, c), sum, 2e-5);
    }
    EXPECT_NEAR(sphere_in_box(0.5, {-1, 1}, {-1, 1}, {-1, 1}), k_pi / 6, 1e-8);
}

TEST(UnionLength, counts_overlaps_once) {
    EXPECT_DOUBLE_EQ(union_length({{0, 2}, {1, 3}, {5, 6}, {5.2, 5.4}}), 4.0);
    EXPECT_DOUBLE_EQ(union_length({}), 0.0);
}

TEST(Plate, covers_an_oblique_chord) {
    const SolidPrism oblique = plate({0, 0}, {1, 1}, 0.1);
    const auto parts = covered_parts(oblique, {0, Vec3(0, 0, 0.5)});
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_NEAR(parts[0].length(), 0.1 * std::sqrt(2.0), 1e-7);
    EXPECT_NEAR(parts[0].to, 0.5, 1e-7);
    EXPECT_TRUE(covered_parts(oblique, {0, Vec3(0, 0, 1.2)}).empty());
}

TEST(WayOut, leads_to_the_nearest_side) {
    const StillSolid box = SolidBox{Vec3(0, -9, 0), Vec3(1, 9, 2)};
    EXPECT_TRUE(way_out(box, Vec3(0.9, 0, 1))->isApprox(Vec3(1, 0, 1)));
    EXPECT_FALSE(way_out(box, Vec3(1.1, 0, 1)));
    const StillSolid cavity = SolidCavity{Vec3(0, 0, 0), 1.0, false};
    EXPECT_TRUE(way_out(cavity, Vec3(0, 5, 2))->isApprox(Vec3(0, 5, 1)));
    EXPECT_FALSE(way_out(cavity, Vec3(0.5, 5, 0.5)));
}

class BodyIncidence : public ::testing::TestWithParam<bool> {};

TEST_P(BodyIncidence, is_a_closed_body_of_exact_volume) {
    const bool sphere = GetParam();
    const StaggeredGrid grid = sphere ? StaggeredGrid::space(12, 12, 12, 0.1) : StaggeredGrid::plane(12, 12, 0.1, 0.3);
    CellCutter cutter(grid, {});
    CutCells cells;
    Body body;
    body.sphere = sphere;
    body.radius = 0.33;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0.4, 0.8);
    for (int n = 0; n < 10; ++n) {
        body.position = Vec3(place(random), sphere ? place(random) : 0.15, place(random));
        cutter.cut(gsl::span<const Body>(&body, 1), cells);
        Vec3 sum = Vec3::Zero(), first = Vec3::Zero();
        for (const BodyCell& entry : cells.bodies[0]) {
            const auto [i, j, k] = grid.place(entry.cell);
            sum += entry.k;
            first += entry.k.cwiseProduct(grid.centre(i, j, k));
        }
        EXPECT_LE(sum.norm(), 1e-13);
        const double volume = k_pi * body.radius * body.radius * (sphere ? 4.0 / 3.0 * body.radius : 0.3);
        double closed = 0.0;
        grid.for_each_cell([&](int cell, int, int, int) { closed += (1.0 - cells.open_volume[cell]) * grid.cell_volume(); });
        EXPECT_NEAR(closed, volume, 1e-6 * volume);
        // The remainders below 1e-4 of a face that are given to the body are all that may be missing.
        for (const int d : grid.directions()) EXPECT_NEAR(-first[d] * grid.face_area(), volume, 1e-4 * volume) << d;
    }
}

INSTANTIATE_TEST_SUITE_P(cylinder_and_sphere, BodyIncidence, ::testing::Bool());

TEST_P(BodyIncidence, leaves_kernels_the_room_that_dense_particles_fill) {
    const bool sphere = GetParam();
    const StaggeredGrid grid = sphere ? StaggeredGrid::space(12, 12, 12, 0.1) : StaggeredGrid::plane(12, 12, 0.1, 0.3);
    Body body;
    body.sphere = sphere;
    body.radius = 0.33;
    body.position = Vec3(0.41, sphere ? 0.52 : 0.15, 0.36);  // its kernels reach the tank's walls
    const SolidBox box{Vec3(0.83, -1, 0.2), Vec3(1.07, 2, 0.55)};
    CellCutter cutter(grid, {box});
    CutCells cells;
    cutter.cut(gsl::span<const Body>(&body, 1), cells);
    WaterParticles particles;
    const int fine = sphere ? 10 : 20;
    const double step = grid.spacing() / fine;
    const int rows = sphere ? 12 * fine : 1;
    for (int k = 0; k < 12 * fine; ++k) {
        for (int j = 0; j < rows; ++j) {
            for (int i = 0; i < 12 * fine; ++i) {
                const Vec3 place((i + 0.5) * step, sphere ? (j + 0.5) * step : 0.15, (k + 0.5) * step);
                if ((place - body.position).norm() > body.radius && !is_inside(box, place)) particles.add(place, 0);
            }
        }
    }
    particles.volume = grid.cell_volume() / std::pow(fine, sphere ? 3 : 2);
    CellField filled;
    map_fraction(grid, particles, filled);
    grid.for_each_cell([&](int cell, int, int, int) { EXPECT_NEAR(cells.room[cell], filled[cell], sphere ? 0.015 : 0.012); });
}

TEST(SlipWalls, let_particles_pass_a_hole_of_one_cell_at_the_speed_of_its_faces) {
    const StaggeredGrid grid = StaggeredGrid::plane(10, 10, 0.1, 1.0);
    const CellCutter cutter(grid, {SolidBox{Vec3(0.4, -1, 0.0), Vec3(0.6, 2, 0.5)}, SolidBox{Vec3(0.4, -1, 0.6), Vec3(0.6, 2, 1.0)}});
    FaceField velocity = grid.face_field();
    grid.for_each_face(0, [&](int face, int, int, int) { velocity[0][face] = cutter.still().open[0][face] > 0.0 ? 2.0 : 0.0; });
    mirror_faces(grid, velocity);
    for (const double z : {0.501, 0.55, 0.599})
        EXPECT_NEAR(value_at(grid, cutter.slip_walls(), velocity, Vec3(0.5, 0.5, z)).x(), 2.0, 1e-12) << z;
    EXPECT_LT(value_at(grid, cutter.slip_walls(), velocity, Vec3(0.399, 0.5, 0.25)).x(), 0.3);  // a wall stays in the way
    EXPECT_NEAR(value_at(grid, {}, velocity, Vec3(0.5, 0.5, 0.55)).x(), 1.5, 1e-12);            // without the rule: three quarters
}

TEST(CellCutter, gives_a_wall_on_the_grid_no_open_face_and_no_room) {
    const StaggeredGrid grid = StaggeredGrid::plane(10, 10, 0.1, 1.0);
    const CellCutter cutter(grid, {SolidBox{Vec3(0.4, -1, 0.0), Vec3(0.6, 2, 0.5)}});
    for (int k = 0; k < 5; ++k) {
        for (int i : {4, 5, 6}) EXPECT_EQ(cutter.still().open[0][grid.at(i, 0, k)], 0.0);
        EXPECT_EQ(cutter.still().open[0][grid.at(3, 0, k)], 1.0);
        EXPECT_EQ(cutter.still().open_volume[grid.at(4, 0, k)], 0.0);
    }
    EXPECT_EQ(cutter.still().open[2][grid.at(4, 0, 5)], 0.0);
    EXPECT_EQ(cutter.still().open[0][grid.at(5, 0, 5)], 1.0);
}

}  // namespace
}  // namespace cutterflow::free_surface
