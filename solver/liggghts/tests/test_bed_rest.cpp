#include <random>

#include "geometry/base/sphere.hpp"
#include "solver/liggghts/tests/engine_fixture.hpp"

namespace cutterflow::liggghts::tests {

namespace {

constexpr double k_gravity = 9.81;
constexpr double k_diameter = 0.02;  // mean [m]

/// A dry box of rough grains that lose all they can in a contact.
coupling::DemSettings box_of_grains(double rolling_friction) {
    coupling::DemSettings settings;
    settings.contact.youngs_modulus = 5e6;
    settings.contact.max_speed = 2.0;
    settings.contact.wet_restitution = false;
    settings.contact.time_step_fraction = 0.15;
    settings.contact.set_every_pair({0.8, 0.14, rolling_friction});
    settings.domain.lower = Vec3(-0.1, -0.05, 0.0);
    settings.domain.upper = Vec3(0.1, 0.05, 1.0);
    for (const auto side : {coupling::DomainSide::x_min, coupling::DomainSide::x_max, coupling::DomainSide::y_min,
                            coupling::DomainSide::y_max, coupling::DomainSide::z_min})
        settings.domain.make_wall(side);
    settings.added_mass = 0.0;
    settings.gravity = Vec3(0, 0, -k_gravity);
    return settings;
}

coupling::Rocks loose_grains() {
    coupling::Rocks grains;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int k = 0; k < 160; ++k) {
        const Vec3 shift = 1e-3 * Vec3(share(random), share(random), 0.0);
        const Vec3 place(-0.084 + 0.0235 * (k % 8), -0.036 + 0.024 * (k / 8 % 4), 0.015 + 0.0235 * (k / 32));
        add_rock(grains, k + 1, place + shift, Vec3(0, 0, -0.3), k_diameter * (0.9 + 0.2 * share(random)));
    }
    return grains;
}

/// Kinetic energy over weight times diameter.
double energy_of(const coupling::Rocks& grains) {
    double energy = 0.0, mass = 0.0;
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const double m = sphere_mass(grains.diameter[k], grains.density[k]);
        energy += 0.5 * m * grains.velocity[k].squaredNorm();
        mass += m;
    }
    return energy / (mass * k_gravity * k_diameter);
}

class BedRest : public ::testing::TestWithParam<double> {};

}  // namespace

/// Dampers that the step does not resolve would keep such a bed in motion for ever: 5e-4 and 9e-6 without their limits.
TEST_P(BedRest, comes_though_every_contact_is_damped_as_much_as_it_may) {
    LiggghtsEngine engine(box_of_grains(GetParam()), {}, MPI_COMM_WORLD);
    ASSERT_EQ(engine.insert(loose_grains()).size(), 160u);
    for (int call = 0; call < 25; ++call) engine.advance(0.1, no_force);
    EXPECT_EQ(engine.rocks().size(), 160u);
    EXPECT_LT(energy_of(engine.rocks()), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(RollingFriction, BedRest, ::testing::Values(0.0, 0.3));

}  // namespace cutterflow::liggghts::tests
