/// Kernels, mapping, extrapolation and motion of particles.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "solver/free_surface/kernel.hpp"
#include "solver/free_surface/transfer.hpp"
#include "solver/free_surface/water_fraction.hpp"

namespace cutterflow::free_surface {
namespace {

double spline(double s) {
    const double a = std::abs(s);
    if (a < 0.5) return 0.75 - a * a;
    return a < 1.5 ? 0.5 * (1.5 - a) * (1.5 - a) : 0.0;
}

TEST(Kernel, is_the_quadratic_spline_with_exact_moments) {
    for (double s = -0.5; s < 7.0; s += 0.0137) {
        const KernelWeights w = quadratic_weights(s);
        double sum = 0.0, first = 0.0;
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(w.weight[i], spline(s - (w.first + i)), 1e-14);
            sum += w.weight[i];
            first += w.weight[i] * (w.first + i);
        }
        EXPECT_NEAR(sum, 1.0, 1e-14);
        EXPECT_NEAR(first, s, 1e-13);
    }
}

TEST(Kernel, weights_of_quarters_are_the_splines_means) {
    for (int part = 0; part < k_parts; ++part) {
        for (int n = 0; n < 3; ++n) {
            double mean = 0.0;
            for (int m = 0; m < 10000; ++m) mean += 1e-4 * spline(-0.5 + (part + (m + 0.5) * 1e-4) / k_parts - (n - 1));
            EXPECT_NEAR(part_weights(part).weight[n], mean, 1e-8) << part << ' ' << n;
        }
    }
}

class Transfer : public ::testing::TestWithParam<bool> {
protected:
    StaggeredGrid grid() const { return GetParam() ? StaggeredGrid::space(8, 6, 7, 0.1) : StaggeredGrid::plane(8, 7, 0.1, 0.4); }
    WaterParticles filled(double height) const {
        WaterParticles particles;
        fill_box(
            grid(), Vec3(-1, -1, -1), Vec3(9, 9, height), 0, [](const Vec3&) { return true; }, particles);
        return particles;
    }
};

TEST_P(Transfer, full_tank_has_fraction_one_up_to_its_walls) {
    const StaggeredGrid g = grid();
    CellField fraction;
    map_fraction(g, filled(9), fraction);
    g.for_each_cell([&](int cell, int, int, int) { EXPECT_NEAR(fraction[cell], 1.0, 1e-12); });
}

TEST_P(Transfer, conserves_mass_and_momentum_away_from_walls) {
    const StaggeredGrid g = grid();
    WaterParticles particles = filled(9);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> noise(-1, 1);
    Vec3 momentum = Vec3::Zero();
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 from_middle = particles.place(p) - Vec3(0.4, 0.5 * g.extent(1), 0.35);
        const bool inner = from_middle.cwiseAbs().maxCoeff() < 0.1;
        for (const int d : g.directions()) {
            particles.position[d][p] += 0.01 * noise(random);
            particles.velocity[d][p] = inner ? noise(random) : 0.0;
            momentum[d] += particles.velocity[d][p] * particles.volume;
        }
    }
    MappedWater mapped(g);
    map_to_grid(g, {}, particles, mapped);
    double volume = 0.0;
    g.for_each_cell([&](int cell, int, int, int) { volume += mapped.fraction[cell] * g.cell_volume(); });
    EXPECT_NEAR(volume, particles.volume * static_cast<double>(particles.size()), 1e-12);
    for (const int d : g.directions()) {
        double sum = 0.0;
        g.for_each_face(d, [&](int face, int, int, int) { sum += mapped.share[d][face] * mapped.velocity[d][face] * g.cell_volume(); });
        EXPECT_NEAR(sum, momentum[d], 1e-12) << d;
    }
}

/// Of two rows of water one meets a closed face where the other passes beside it: neither gives to the face of the other that it does not
/// read, and a face shows the water of those alone that give to it.
TEST_P(Transfer, a_jet_gives_nothing_to_the_wall_beside_it) {
    const StaggeredGrid g = grid();
    const int jet_row = 3, wall = 4;
    SlipWalls walls;
    for (auto& closed : walls.closed) closed.assign(g.size(), 0);
    walls.near.assign(g.size(), 1);
    for (int j = 0; j < g.cells(1); ++j) {
        for (int k = 0; k < g.cells(2); ++k) walls.closed[0][g.at(wall, j, k)] = k != jet_row;
    }
    WaterParticles particles = filled(9);
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const bool in_jet = static_cast<int>(particles.place(p).z() / 0.1) == jet_row;
        particles.velocity[0][p] = in_jet ? 5.0 : 0.0;
    }
    MappedWater mapped(g);
    map_to_grid(g, walls, particles, mapped);
    for (const int row : {jet_row - 1, jet_row + 1}) EXPECT_EQ(mapped.velocity[0][g.at(wall, g.cells(1) / 2, row)], 0.0) << row;
    const double jet = mapped.velocity[0][g.at(wall, g.cells(1) / 2, jet_row)];
    EXPECT_GT(jet, 0.75 * 5.0);                                                       // its own particles give all that they have
    EXPECT_LT(jet, 5.0);                                                              // those beside it read the face, and give to it
    EXPECT_GT(mapped.velocity[0][g.at(wall - 1, g.cells(1) / 2, jet_row + 1)], 0.0);  // no wall there: the kernels overlap
}

TEST_P(Transfer, half_a_space_has_half_a_fraction_on_its_surface) {
    const StaggeredGrid g = grid();
    CellField fraction;
    map_fraction(g, filled(0.4), fraction);
    const double below = fraction[g.at(3, 0, 3)], above = fraction[g.at(3, 0, 4)];
    EXPECT_NEAR(0.5 * (below + above), 0.5, 1e-12);
    EXPECT_NEAR(surface_distance(below, above), 0.5, 1e-12);
}

TEST_P(Transfer, solid_rotation_is_followed_to_third_order) {
    const StaggeredGrid g = grid();
    FaceField velocity = g.face_field();
    const FaceField none = g.face_field();
    for (const int d : {0, 2}) {
        g.for_each_face(d, [&](int face, int i, int j, int k) {
            const Vec3 place = g.centre(i, j, k);
            velocity[d][face] = d == 0 ? place.z() - 0.35 : 0.4 - place.x();
        });
    }
    double errors[2];
    for (const int twice : {0, 1}) {
        WaterParticles one;
        one.add(Vec3(0.5, 0.5 * g.extent(1), 0.35), 0);
        const int steps = twice ? 20 : 10;
        for (int n = 0; n < steps; ++n) move_particles(g, {}, {velocity, none, 1.0 / steps, 1.0}, one);
        errors[twice] = (one.place(0) - Vec3(0.4 + 0.1 * std::cos(1.0), 0.5 * g.extent(1), 0.35 - 0.1 * std::sin(1.0))).norm();
    }
    EXPECT_LT(errors[0], 1e-5);
    EXPECT_NEAR(errors[0] / errors[1], 8.0, 1.0);
}

INSTANTIATE_TEST_SUITE_P(plane_and_space, Transfer, ::testing::Bool());

TEST(Extrapolate, reaches_as_many_layers_as_it_is_told) {
    const StaggeredGrid g = StaggeredGrid::plane(9, 9, 1.0, 1.0);
    std::vector<FaceValue> values(g.size(), FaceValue::none);
    std::vector<double> field(g.size(), 0.0);
    const int middle = g.at(4, 0, 4), held = g.at(5, 0, 4);
    values[middle] = FaceValue::present;
    values[held] = FaceValue::held;
    field[middle] = 3.0;
    std::vector<int> front{middle};
    extrapolate(g, 2, values, front, {&field});
    EXPECT_EQ(field[g.at(2, 0, 4)], 3.0);
    EXPECT_EQ(field[g.at(3, 0, 3)], 3.0);
    EXPECT_EQ(field[held], 0.0);
    EXPECT_EQ(values[g.at(1, 0, 4)], FaceValue::none);
}

TEST(SortByCell, keeps_particles_whole) {
    const StaggeredGrid g = StaggeredGrid::plane(5, 5, 1.0, 1.0);
    WaterParticles particles;
    particles.add(Vec3(4.5, 0.5, 4.5), 3);
    particles.add(Vec3(0.5, 0.5, 0.5), 1);
    particles.velocity[0] = {7.0, 8.0};
    sort_by_cell(g, particles);
    EXPECT_EQ(particles.dye[0], 1);
    EXPECT_EQ(particles.velocity[0][0], 8.0);
    EXPECT_EQ(particles.position[2][1], 4.5);
}

}  // namespace
}  // namespace cutterflow::free_surface
