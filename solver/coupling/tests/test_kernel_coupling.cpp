// Exchange between rock and fluid over a step: balances, insertion, departure, settling, travel limit.
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/coupling/tests/coupling_rig.hpp"
#include "solver/physics/lift.hpp"
#include "solver/physics/own_trace.hpp"
#include "solver/physics/testing/fall_from_rest.hpp"
#include "solver/ports/testing/threaded_ranks.hpp"

namespace cutterflow::coupling {
namespace {

using testing::box;
using testing::FakeDem;
using testing::FakeFluid;
using testing::k_water;
using testing::settings_with_rock;
using testing::settings_with_shell;
using testing::SyntheticMesh;

FeedRock rock(int id, const Vec3& x, double d, std::optional<Vec3> v = std::nullopt) {
    return {id, 0.0, x, d, 2650.0, v};
}

using Rig = testing::CouplingRig<>;

TEST(Exchange, balances_rock_fluid_and_carry_in_every_step) {
    Rig rig(box(0.15, 0.01), {}, 2e-3);
    rig.dem.gravity = Vec3(3.0, -1.0, -9.0);
    std::vector<FeedRock> due;
    for (int i = 0; i < 20; ++i)
        due.push_back(
            rock(i + 1, Vec3(0.022 * (i % 5) - 0.04, 0.03 * (i / 5) - 0.04, 0.01 * i - 0.1), 0.02, Vec3(0.3 * (i % 3), 0.1, -0.2)));
    rig.coupling.insert(due);
    double received_share = 1.0;
    for (int n = 0; n < 40; ++n) {
        const ExchangeBalance balance = rig.step();
        ASSERT_LE(rig.momentum_errors.error, 1e-10) << n;
        ASSERT_LE(balance.solid_volume_error, 1e-12) << n;
        double received = 0.0, target = 0.0;
        for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) {
            received += rig.fluid.received()[c].norm();
            target += rig.coupling.exchange().explicit_source[c].norm();
        }
        received_share = std::min(received_share, received / target);
    }
    // The fluid really received only a part at once; the rest was carried.
    EXPECT_LT(received_share, 0.99);
}

TEST(Exchange, hands_what_rock_loses_to_the_fluid) {
    // A rock shot into still water without weight: density times volume times loss of speed is what the cells got or have yet to get.
    Rig rig(box(0.15, 0.01), {}, 1e-3);
    rig.coupling.insert({rock(1, Vec3::Zero(), 0.02, Vec3(1.0, 0.0, 0.0))});
    double gained = 0.0, carried = 0.0;
    for (int n = 0; n < 60; ++n) {
        rig.step();
        carried = 0.0;
        for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) {
            const double mass = k_water.density * rig.fluid.mesh.volumes[c];
            gained += mass * rig.fluid.received()[c][0] * rig.fluid.time_step();
            carried += mass * rig.coupling.carry()[c][0];
        }
    }
    const double lost = 2650.0 * sphere_volume(0.02) * (1.0 - rig.dem.rocks().velocity[0][0]);
    EXPECT_GT(lost, 1e-3);
    EXPECT_NEAR(gained + carried, lost, 1e-10 * lost);
    EXPECT_LE(std::abs(carried), 0.1 * lost);
}

// Drag that would stop the fluid many times over in a step, as in a gas bed, and a viscous fluid, where it is linear: what the fluid could
// not take in one step must not come back as a swing. (Handed over whole it swings by 0.97 a step: half is left after twenty.)
TEST(Exchange, does_not_ring_where_drag_is_stiff) {
    Rig rig(box(0.06, 0.02), {}, 2e-4, settings_with_rock(), {k_water.density, 1.0});
    std::vector<FeedRock> due;
    for (int i = 0; i < 125; ++i) {
        due.push_back(rock(i + 1, 0.0215 * (Vec3(i % 5, i / 5 % 5, i / 25) - Vec3::Constant(2.0)), 0.02, Vec3::Zero()));
        due.back().density = 1e12;
    }
    rig.coupling.insert(due);
    rig.fluid.velocity.assign(rig.fluid.mesh.size(), Vec3(0.0, 0.0, 0.01));
    double stiffness = 0.0, speed = 0.0;
    for (int n = 0; n < 20; ++n) {
        rig.step();
        ASSERT_LE(rig.momentum_errors.error, 1e-10);
    }
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) {
        stiffness = std::max(stiffness, rig.coupling.exchange().drag_rate[c] * rig.fluid.time_step() / rig.fluid.void_fraction[c]);
        speed = std::max(speed, rig.fluid.velocity[c].norm());
    }
    EXPECT_GT(stiffness, 10.0);
    EXPECT_LT(speed, 0.02 * 0.01);
}

// A wave of the fluid that rock does not see or sees upside down, as it looks over its kernel's shell: drag must take its energy all the
// same.
TEST(Exchange, slows_down_waves_within_the_kernels_of_a_dense_bed) {
    const double dx = 0.02, spacing = 0.0215, wavelength = 0.08;
    Rig rig(box(0.12, dx), {}, 2e-3, settings_with_shell());
    std::vector<FeedRock> due;
    for (int i = 0; i < 1331; ++i) {
        due.push_back(rock(i + 1, spacing * (Vec3(i % 11, i / 11 % 11, i / 121) - Vec3::Constant(5.0)), 0.02, Vec3::Zero()));
        due.back().density = 1e12;
    }
    rig.coupling.insert(due);
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c)
        rig.fluid.velocity[c] = Vec3(0.0, 0.0, 0.1 + 0.02 * std::sin(2.0 * k_pi * rig.fluid.mesh.centres[c].x() / wavelength));
    const auto height = [&](const Vec3& position) { return std::sin(2.0 * k_pi * position.x() / wavelength); };
    const auto wave = [&] {
        double amplitude = 0.0;
        for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) amplitude += rig.fluid.velocity[c].z() * height(rig.fluid.mesh.centres[c]);
        return amplitude;
    };
    const double before = wave();
    double decay = 0.0;  // of a wave that each cell's own drag slows down
    for (int n = 0; n < 40; ++n) {
        rig.step();
        ASSERT_LE(rig.momentum_errors.error, 1e-10);
        double rate = 0.0, weight = 0.0;
        for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) {
            const double h = height(rig.fluid.mesh.centres[c]);
            rate += h * h * rig.coupling.exchange().drag_rate[c] / rig.fluid.void_fraction[c];
            weight += h * h;
        }
        decay += rate / weight * rig.fluid.time_step();
    }
    EXPECT_GT(decay, 0.1);
    EXPECT_NEAR(std::log(before / wave()), decay, 0.1 * decay);
}

TEST(Exchange, gives_back_to_the_fluid_what_lift_and_viscous_stress_do_to_rock) {
    CouplingSettings settings = settings_with_shell();
    settings.closures.lift = "mei";
    settings.closures.viscous_force = false;
    Rig rig(box(0.15, 0.01), {}, 1e-5, settings);
    rig.fluid.curl.assign(rig.fluid.mesh.size(), Vec3(0.0, 0.0, 4000.0));
    rig.fluid.stress.assign(rig.fluid.mesh.size(), Vec3(0.0, 0.0, 0.3));
    rig.coupling.insert({rock(1, Vec3::Zero(), 0.02, Vec3(-0.05, 0.0, 0.0))});
    const double volume = sphere_volume(0.02), inertia = (2650.0 + 0.5 * k_water.density) * volume;
    const physics::RockInFluid in_water{0.02, k_water.density, k_water.kinematic_viscosity};
    const Vec3 lift = physics::lift_force(in_water, Vec3(0.05, 0.0, 0.0), Vec3(0.0, 0.0, 4000.0), physics::mei_lift_coefficient);
    ASSERT_GT(lift.norm(), 1e-4);
    rig.step();
    EXPECT_LE(rig.momentum_errors.error, 1e-10);
    // Drag acts along x alone. In so short a step the slip stays what it was.
    const Vec3 gained = inertia * rig.dem.rocks().velocity[0] / 1e-5;
    EXPECT_NEAR(gained[1], lift[1], 1e-4 * lift.norm());
    EXPECT_NEAR(gained[2], -k_water.density * volume * 0.3, 1e-9);
    for (int n = 0; n < 20; ++n) {
        rig.step();
        EXPECT_LE(rig.momentum_errors.error, 1e-10);
    }
    // What the fluid got and has yet to get across the slip is what the rock got, but for the rock's own added mass.
    double got = 0.0;
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c)
        got += k_water.density * rig.fluid.mesh.volumes[c] *
               (rig.fluid.velocity[c][1] * rig.fluid.void_fraction[c] + rig.coupling.carry()[c][1]);
    EXPECT_NEAR(got, -2650.0 * volume * rig.dem.rocks().velocity[0][1], 0.02 * std::abs(got));
}

TEST(Insertion, makes_no_source) {
    Rig rig(box(0.15, 0.01), {}, 1e-3);
    rig.step();
    EXPECT_TRUE(rig.coupling.insert({rock(1, Vec3(0.01, 0.02, 0.003), 0.02), rock(2, Vec3(-0.05, 0, 0), 0.02)}).empty());
    const std::vector<double> at_insertion = rig.fluid.void_fraction;
    rig.step();
    // Rock at rest in still water: old and new void fraction are the same and what was set at insertion.
    for (std::size_t c = 0; c < at_insertion.size(); ++c) {
        ASSERT_NEAR(rig.fluid.void_fraction_old[c], at_insertion[c], 1e-14);
        ASSERT_NEAR(rig.fluid.void_fraction[c], at_insertion[c], 1e-14);
    }
    EXPECT_NEAR(rig.coupling.booked().volume, 2.0 * sphere_volume(0.02), 1e-18);
}

TEST(Insertion, gives_rock_the_velocity_of_the_fluid_around_it) {
    Rig rig(box(0.15, 0.01), {}, 1e-3);
    rig.fluid.velocity.assign(rig.fluid.mesh.size(), Vec3(0.5, -0.2, 0.1));
    rig.coupling.insert({rock(4, Vec3(0.01, 0, 0), 0.02), rock(2, Vec3(0.05, 0, 0), 0.02, Vec3(0, 0, 1))});
    ASSERT_EQ(rig.dem.rocks().id, (std::vector<int>{2, 4}));
    EXPECT_LE((rig.dem.rocks().velocity[0] - Vec3(0, 0, 1)).norm(), 1e-15);
    EXPECT_LE((rig.dem.rocks().velocity[1] - Vec3(0.5, -0.2, 0.1)).norm(), 1e-12);
    const double fluid_momentum = 998.2 * sphere_volume(0.02) * 2.0;
    EXPECT_LE((rig.coupling.booked().momentum - fluid_momentum * Vec3(0.5, -0.2, 0.1)).norm(), 1e-12);
}

TEST(Insertion, names_rock_that_finds_no_place) {
    Rig rig(box(0.15, 0.01), {}, 1e-3);
    rig.dem.refuses = [](int id) { return id == 3; };
    EXPECT_EQ(rig.coupling.insert({rock(3, Vec3(0.01, 0, 0), 0.02), rock(2, Vec3(0.05, 0, 0), 0.02)}), std::vector<int>{3});
    EXPECT_NEAR(rig.coupling.booked().volume, sphere_volume(0.02), 1e-18);
}

TEST(Insertion, of_more_rock_than_there_is_room_for_is_refused) {
    Rig rig(box(0.03, 0.01), {}, 1e-3);
    std::vector<FeedRock> due;
    for (int i = 0; i < 80; ++i) due.push_back(rock(i + 1, Vec3(0.001 * (i % 7), 0.001 * (i % 5), 0.0), 0.018));
    EXPECT_THROW(rig.coupling.insert(due), CheckFailure);
}

/// Rock thrown out of the mesh through its side, and back: outside it falls with (rho_s - rho_f) / (rho_s + C_AM rho_f) g and the fluid has
/// nothing of it, inside it is as any other.
TEST(RockWithoutCells, moves_by_its_weight_and_is_told) {
    constexpr double gravity = 9.81, dt = 2e-3;
    Rig rig(box(0.1, 0.01), {}, dt);
    rig.dem.gravity = Vec3(-gravity, 0.0, 0.0);
    rig.coupling.insert({rock(1, Vec3(-0.05, 0, 0), 0.02), rock(2, Vec3(0.09, 0, 0), 0.02, Vec3(1.2, 0.0, 0.0))});
    rig.dem.freeze(std::vector<int>{1});
    const double fall = (2650.0 - k_water.density) / (2650.0 + 0.5 * k_water.density) * gravity;
    const auto speed = [&] { return rig.dem.rocks().velocity[1].x(); };
    int steps_outside = 0, steps_back = 0;
    std::vector<std::string> warnings;
    for (int n = 0; n < 400 && steps_back < 3; ++n) {
        const double before = speed();
        const ExchangeBalance balance = rig.step();
        const bool had_cells = rig.coupling.flow()[1].has_cells;
        for (const std::string& warning : rig.coupling.take_warnings()) warnings.push_back(warning);
        if (!had_cells) {
            ++steps_outside;
            EXPECT_NEAR(speed() - before, -fall * rig.fluid.time_step(), 1e-12);
        } else if (steps_outside > 0) {
            ++steps_back;
            EXPECT_GT(std::abs(speed() - before + fall * rig.fluid.time_step()), 1e-6);
            EXPECT_LE(balance.solid_volume_error, 1e-12);
        }
        if (steps_outside > 1 && rig.dem.rocks().position[1].x() > 0.16) {
            EXPECT_NEAR(balance.solid_volume_error, 0.5, 1e-12) << "one of two rocks of a size";
        }
        for (const double alpha : rig.fluid.void_fraction) ASSERT_TRUE(alpha > 0.0 && alpha <= 1.0) << alpha;
        for (const Vec3& u : rig.fluid.velocity) ASSERT_TRUE(u.allFinite());
        double source = 0.0;  // of fluid, while rock gains or loses its cells
        for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c)
            source += (rig.fluid.void_fraction[c] - rig.fluid.void_fraction_old[c]) * rig.fluid.mesh.volumes[c];
        ASSERT_NEAR(source, 0.0, 1e-15) << n;
    }
    EXPECT_GT(steps_outside, 20);
    EXPECT_EQ(steps_back, 3);
    const auto tells = [](const std::string& w) { return w.find("1 rock(s) so far had no cell of the mesh in reach, rock 2 at") == 0; };
    EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(), tells), 1);
}

TEST(RockWithoutCells, is_refused_when_it_comes_in) {
    Rig rig(box(0.1, 0.01), {}, 1e-3);
    EXPECT_THROW(rig.coupling.insert({rock(1, Vec3(0.3, 0, 0), 0.02)}), CheckFailure);
    EXPECT_TRUE(rig.dem.rocks().id.empty());
}

TEST(Departure, returns_impulse_and_makes_no_source) {
    Rig rig(box(0.15, 0.01), {}, 2e-3);
    rig.dem.gravity = Vec3(0, 0, -9.81);
    rig.dem.leaves = [](const Vec3& x) { return x[0] > 0.1; };
    rig.coupling.insert({rock(1, Vec3(0.09, 0, 0), 0.02, Vec3(1.5, 0, 0)), rock(2, Vec3(-0.05, 0, 0), 0.02)});
    bool left = false;
    for (int n = 0; n < 12; ++n) {
        const std::size_t before = rig.dem.rocks().size();
        const ExchangeBalance balance = rig.step();
        ASSERT_LE(rig.momentum_errors.error, 1e-10);
        ASSERT_LE(balance.solid_volume_error, 1e-12);
        if (rig.dem.rocks().size() == before) continue;
        left = true;
        // Old and new void fraction hold the rock that is still here, and no other.
        double old_volume = 0.0;
        for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c)
            old_volume += (1.0 - rig.fluid.void_fraction_old[c]) * rig.fluid.mesh.volumes[c];
        EXPECT_NEAR(old_volume, sphere_volume(0.02), 1e-15);
    }
    EXPECT_TRUE(left);
    EXPECT_NEAR(rig.coupling.booked().volume, sphere_volume(0.02), 1e-18);
}

TEST(Settling, of_one_rock_in_a_fluid_that_stays_still_follows_the_equation_of_motion) {
    Rig rig(box(0.12, 0.02), {}, 1e-3, settings_with_shell());
    rig.fluid.flow = [](const Vec3&, double) -> Vec3 { return Vec3::Zero(); };
    rig.dem.gravity = Vec3(0, 0, -9.81);
    rig.coupling.insert({rock(1, Vec3(0, 0, 0.11), 0.01)});
    physics::SettlingRock reference{{0.01, k_water.density, k_water.kinematic_viscosity, 1.0}, 2650.0, 9.81};
    for (int n = 0; n < 200; ++n) rig.step();
    const double time = rig.fluid.time();
    // The rock's own solid thins the fluid around it a little, which the void fraction at the rock shows.
    reference.rock.void_fraction = rig.coupling.flow()[0].void_fraction;
    const auto states = physics::testing::fall_from_rest(reference, 0.5, time, time / 1000.0);
    EXPECT_NEAR(-rig.dem.rocks().velocity[0][2], states[1000].speed, 2e-3 * states[1000].speed);
    EXPECT_GT(reference.rock.void_fraction, 0.99);
}

TEST(OwnTrace, of_a_rock_alone_is_not_in_what_it_samples) {
    CouplingSettings settings = testing::settings_with_rock();
    settings.kernel.sampling = k_gaussian_sampling;
    Rig rig(box(0.15, 0.01), {}, 1e-3, settings);
    rig.fluid.flow = [](const Vec3&, double) -> Vec3 { return Vec3::Zero(); };
    rig.coupling.insert({rock(1, Vec3(0.002, 0.001, 0.0), 0.02, Vec3(0, 0, -0.5))});
    rig.step();
    const FlowAtRock& flow = rig.coupling.flow()[0];
    EXPECT_DOUBLE_EQ(flow.void_fraction, 1.0);
    // This fluid stays still whatever is done to it: all of the correction is seen. Wake less making way, of the slip 0.5 m/s.
    const double drag = physics::drag_coefficient_per_slip({0.02, testing::k_water.density, testing::k_water.kinematic_viscosity}, 0.5,
                                                           physics::find_drag_law(settings.closures.drag), physics::no_hindrance);
    const double wake = physics::k_near_response.wake * drag / (testing::k_water.density * 0.02 * 0.02),
                 own = k_pi / 6.0 * physics::k_near_response.overlap;
    EXPECT_NEAR(flow.velocity.z(), wake - 0.5 * own / 3.0, 0.05 * wake);
    EXPECT_GT(flow.acceleration.z(), 0.0);
}

TEST(OwnTrace, of_slow_rock_is_limited_and_counted) {
    // Stokes' drag 3 pi nu d over nu sigma / 0.0424 is a wake of 0.40 of the slip, where 1/3 is the most that is taken out.
    for (const bool slow : {true, false}) {
        Rig rig(box(0.15, 0.01), {}, 1e-3, settings_with_rock(), {k_water.density, slow ? 1e-2 : k_water.kinematic_viscosity});
        rig.fluid.flow = [](const Vec3&, double) -> Vec3 { return Vec3::Zero(); };
        rig.coupling.insert({rock(1, Vec3(0.002, 0.001, 0.0), 0.02, Vec3(0, 0, -0.01))});
        EXPECT_EQ(rig.step().limited.wake_rocks, slow ? 1 : 0);
    }
}

TEST(OwnTrace, of_a_rock_alone_stays_in_what_the_shell_samples) {
    Rig rig(box(0.15, 0.01), {}, 1e-3, settings_with_shell());
    rig.fluid.flow = [](const Vec3&, double) -> Vec3 { return Vec3::Zero(); };
    rig.coupling.insert({rock(1, Vec3(0.002, 0.001, 0.0), 0.02, Vec3(0, 0, -0.5))});
    rig.step();
    EXPECT_EQ(rig.coupling.flow()[0].velocity, Vec3(Vec3::Zero()));
}

/// Of rock on a lattice under water, seen with either weight.
class DenseRock : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Sampled, DenseRock, ::testing::Values(k_quadratic_sampling, k_gaussian_sampling));

TEST_P(DenseRock, is_hindered_as_the_closures_say) {
    // Rock at rest on a lattice in a uniform upflow of its hindered terminal slip: drag carries its weight.
    const double d = 0.02, spacing = 0.03, solid = k_pi / 6.0 * std::pow(d / spacing, 3);
    // Where rock sees itself, rock that lies at random would see so much of it too much; on a lattice it is missing.
    const double own = k_pi / 6.0 * std::pow(d / (1.5 * 0.015), 3) * physics::k_near_response.overlap;
    const double left_out = GetParam() == std::string(k_gaussian_sampling) ? own * physics::own_trace_share(solid) : 0.0;
    physics::SettlingRock reference{{d, k_water.density, k_water.kinematic_viscosity, 1.0 - solid}, 2650.0, 9.81};
    const double slip = physics::terminal_slip_speed(reference);
    EXPECT_NEAR(slip, 0.8015, 2e-4);
    CouplingSettings settings = testing::settings_with_rock();
    settings.kernel.sampling = GetParam();
    Rig rig(box(0.15, 0.015), {}, 1e-3, settings);
    rig.fluid.flow = [slip](const Vec3&, double) -> Vec3 { return Vec3(0, 0, slip); };
    rig.fluid.velocity.assign(rig.fluid.mesh.size(), Vec3(0, 0, slip));
    rig.dem.gravity = Vec3(0, 0, -9.81);
    std::vector<FeedRock> due;
    int id = 0;
    for (int i = 0; i < 10; ++i)
        for (int j = 0; j < 10; ++j)
            for (int k = 0; k < 10; ++k) due.push_back(rock(++id, spacing * Vec3(i, j, k) + Vec3::Constant(-0.135), d, Vec3(0, 0, 0)));
    rig.coupling.insert(due);
    for (int n = 0; n < 20; ++n) rig.step();
    const Rocks& rocks = rig.dem.rocks();
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        if (rocks.position[p].cwiseAbs().maxCoeff() > 0.05) continue;  // the middle, away from walls
        EXPECT_NEAR(rig.coupling.flow()[p].void_fraction, 1.0 - solid + left_out, 3e-3);
        EXPECT_NEAR(rocks.velocity[p][2], 0.0, 5e-3 * slip);
    }
}

TEST(TravelLimit, is_a_quarter_of_the_kernel_over_speed) {
    for (const double dx : {0.01, 0.005, 0.02}) {
        Rig rig(box(0.08, dx), {}, 1e-3);
        EXPECT_EQ(rig.coupling.travel_limit(), std::numeric_limits<double>::infinity());
        rig.coupling.insert({rock(1, Vec3(0.01, 0, 0), 0.02, Vec3(0.3, 0.4, 0.0)), rock(2, Vec3(-0.05, 0, 0), 0.02, Vec3(0.1, 0, 0))});
        EXPECT_NEAR(rig.coupling.travel_limit(), 0.25 * std::max(0.02, 1.5 * dx) / 0.5, 1e-9) << dx;  // kernels are at least 1.5 cells wide
    }
}

TEST(TravelLimit, sees_the_turning_interface_and_the_turning_cells) {
    SyntheticMesh mesh;
    mesh.add_annulus(0.05, 0.2, 15, 90, -0.1, 0.1, 20, true);
    mesh.add_annulus(0.2, 0.35, 15, 90, -0.1, 0.1, 20, false);
    const ZoneMotion motion{{}, 6.0};
    Rig rig(std::move(mesh), motion, 1e-3);
    // Rock at rest in the stator: the interface counts. The turning cells beside it have their centres at 0.195 m.
    rig.coupling.insert({rock(1, Vec3(0.25, 0, 0), 0.03, Vec3::Zero())});
    EXPECT_NEAR(rig.coupling.travel_limit(), 0.25 * 0.03 / (6.0 * 0.195), 1e-5);
    // Rock that moves against the rotor passes its cells faster.
    rig.coupling.insert({rock(2, Vec3(0.15, 0, 0), 0.02, Vec3(0, -6.0 * 0.15, 0))});
    EXPECT_NEAR(rig.coupling.travel_limit(), 0.25 * 0.02 / (2.0 * 6.0 * 0.15), 1e-5);
}

TEST(Rotor, leaves_rock_at_rest_alone) {
    // Rock rests in the turning zone: on the moved mesh old and new void fraction are the same, so nothing is displaced.
    SyntheticMesh mesh;
    mesh.add_annulus(0.05, 0.2, 15, 90, -0.1, 0.1, 20, true);
    mesh.add_annulus(0.2, 0.35, 15, 90, -0.1, 0.1, 20, false);
    Rig rig(std::move(mesh), {{}, 6.0}, 1e-3);
    rig.coupling.insert({rock(1, Vec3(0.19, 0.01, 0), 0.02, Vec3::Zero())});
    for (int n = 0; n < 5; ++n) {
        rig.step();
        double change = 0.0;
        for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c)
            change = std::max(change, std::abs(rig.fluid.void_fraction[c] - rig.fluid.void_fraction_old[c]));
        EXPECT_LE(change, 1e-14);
    }
}

TEST(Rotor, takes_the_rock_of_the_space_its_blades_sweep_from_the_old_void_fraction) {
    // Steel moves through the layer of cells at the box's lower side. Fluid that it displaces with the void fraction beside it, and the
    // void fraction's change, must add up to nothing: sum V (alpha - alpha_old) / dt + sum alpha v.S = 0 for a closed body.
    Rig rig(box(0.05, 0.01), {}, 2e-3);
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) {
        const Vec3& x = rig.fluid.mesh.centres[c];
        if (x[2] < -0.04) rig.fluid.retreat[c] = x[0] < 0.0 ? -3e-5 : 3e-5;
    }
    rig.coupling.insert(
        {rock(1, Vec3(-0.012, 0.003, -0.038), 0.02, Vec3(0.3, 0.0, 0.1)), rock(2, Vec3(0.03, -0.02, -0.03), 0.012, Vec3::Zero())});
    for (int n = 0; n < 5; ++n) {
        EXPECT_LE(rig.step().solid_volume_error, 1e-12);
        double change = 0.0, displaced = 0.0, net_displaced = 0.0;
        for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) {
            change += rig.fluid.mesh.volumes[c] * (rig.fluid.void_fraction[c] - rig.fluid.void_fraction_old[c]) / rig.fluid.time_step();
            displaced += std::abs((1.0 - rig.fluid.void_fraction[c]) * rig.fluid.retreat[c]);
            net_displaced += rig.fluid.void_fraction[c] * rig.fluid.retreat[c];
        }
        EXPECT_GT(std::abs(net_displaced), 1e-2 * displaced);
        EXPECT_NEAR(change + net_displaced, 0.0, 1e-9 * displaced);
    }
}

TEST(Rotor, takes_the_swept_rock_from_the_cells_that_the_blades_sweep) {
    // Rock at rest: beside the steel the fluid that is displaced with the void fraction there and the void fraction's change add up to what
    // the steel would displace of water alone, in each cell. Elsewhere nothing changes.
    Rig rig(box(0.05, 0.01), {}, 2e-3);
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) {
        const Vec3& x = rig.fluid.mesh.centres[c];
        if (x[2] < -0.04) rig.fluid.retreat[c] = x[0] < 0.0 ? -3e-5 : 2e-5;
    }
    rig.coupling.insert({rock(1, Vec3(-0.012, 0.003, -0.036), 0.02, Vec3::Zero())});
    EXPECT_EQ(rig.step().limited.swept_cells, 0) << "0.06 of a cell";
    const double dt = rig.fluid.time_step();
    double beside = 0.0;
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) {
        const double solid = 1.0 - rig.fluid.void_fraction[c];
        const double change = rig.fluid.mesh.volumes[c] * (rig.fluid.void_fraction[c] - rig.fluid.void_fraction_old[c]) / dt;
        EXPECT_NEAR(change, solid * rig.fluid.retreat[c], 1e-9 * 3e-5) << c;
        beside = std::max(beside, std::abs(solid * rig.fluid.retreat[c]));
    }
    EXPECT_GT(beside, 1e-2 * 3e-5);
}

TEST(Rotor, leaves_fluid_in_a_full_cell_that_its_blades_sweep) {
    Rig rig(box(0.02, 0.01), {}, 1e-4);
    std::vector<FeedRock> due;
    for (int i = 0; i < 13; ++i)
        due.push_back(rock(i + 1, Vec3(i % 2 - 0.5, i / 2 % 2 - 0.5, 0.5 * (i / 4) - 0.5) * 0.02, 0.02, Vec3::Zero()));
    rig.coupling.insert(due);
    rig.fluid.retreat[0] = 1e-2;  // all of the cell in a step
    EXPECT_EQ(rig.step().limited.swept_cells, 1);
    EXPECT_LT(rig.fluid.void_fraction[0], 0.2);
    const double least = *std::min_element(rig.fluid.void_fraction_old.begin(), rig.fluid.void_fraction_old.end());
    EXPECT_GT(least, 0.02);
    double taken = 0.0;
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c)
        taken += rig.fluid.mesh.volumes[c] * (rig.fluid.void_fraction[c] - rig.fluid.void_fraction_old[c]);
    EXPECT_NEAR(taken, (1.0 - rig.fluid.void_fraction[0]) * 1e-2 * rig.fluid.time_step(), 1e-15) << "all swept rock was there before";
}

TEST(Exchange, counts_cells_that_hold_more_rock_than_is_allowed) {
    Rig rig(box(0.02, 0.01), {}, 1e-4);
    std::vector<FeedRock> due;
    for (int i = 0; i < 12; ++i) due.push_back(rock(i + 1, Vec3(i % 2 - 0.5, i / 2 % 2 - 0.5, i / 4 - 1.0) * 0.02, 0.02, Vec3::Zero()));
    for (FeedRock& each : due) each.position.z() *= 0.5;
    rig.coupling.insert(due);
    const ExchangeBalance balance = rig.step();
    EXPECT_NEAR(balance.solid_fraction_max, 12 * sphere_volume(0.02) / std::pow(0.04, 3), 0.02);  // no cell has room for its neighbours'
    EXPECT_EQ(balance.overfull_cells, 64);
    const std::vector<std::string> warnings = rig.coupling.take_warnings();
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& text) { return text.rfind("64 cells hold", 0) == 0; }));
    rig.step();
    EXPECT_TRUE(rig.coupling.take_warnings().empty()) << "told once";
    Rig with_room(box(0.05, 0.01), {}, 1e-4);
    with_room.coupling.insert(due);
    EXPECT_EQ(with_room.step().overfull_cells, 0);
}

class Ranks : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Sampled, Ranks, ::testing::Values(k_quadratic_sampling, k_gaussian_sampling));

TEST_P(Ranks, exchange_the_same_as_one) {
    const auto due = [] {
        std::vector<FeedRock> rocks;
        for (int i = 0; i < 8; ++i) rocks.push_back(rock(i + 1, Vec3(0.02 * i - 0.07, 0.004 * i - 0.01, 0.0), 0.02, Vec3(0.2, 0.1 * i, 0)));
        return rocks;
    }();
    const SyntheticMesh whole = box(0.12, 0.01);
    const auto run = [&](FakeFluid& fluid, FakeDem& dem, Communicator& communicator) {
        CouplingSettings settings = settings_with_rock();
        settings.kernel.sampling = GetParam();
        KernelCoupling coupling(settings, k_water, fluid, dem, communicator);
        dem.gravity = Vec3(0, 0, -9.81);
        coupling.insert(due);
        double worst = 0.0;
        for (int n = 0; n < 10; ++n) {
            coupling.sample();
            fluid.begin_step(coupling.travel_limit(), std::numeric_limits<double>::infinity());
            coupling.move();
            coupling.map();
            fluid.end_step(coupling.void_fraction_old(), coupling.void_fraction_new(), coupling.exchange());
            const ExchangeBalance balance = coupling.book();
            worst = std::max({worst, balance.deposit_error, balance.solid_volume_error * 100.0});
        }
        EXPECT_LE(worst, 1e-10);
    };
    SerialCommunicator serial;
    FakeFluid fluid(whole, {}, 1e-3);
    FakeDem dem({}, 0.5, k_water.density);
    run(fluid, dem, serial);
    std::vector<Vec3> velocity(whole.size());
    testing::ThreadedRanks(3).run([&](Communicator& communicator) {
        const auto mine = [&](std::size_t c) { return static_cast<int>(c % 3) == communicator.rank(); };
        FakeFluid part(whole.part(mine), {}, 1e-3);
        FakeDem my_dem({}, 0.5, k_water.density);
        run(part, my_dem, communicator);
        std::size_t next = 0;
        for (std::size_t c = 0; c < whole.size(); ++c)
            if (mine(c)) velocity[c] = part.velocity[next++];
        for (std::size_t p = 0; p < due.size(); ++p) EXPECT_LE((my_dem.rocks().velocity[p] - dem.rocks().velocity[p]).norm(), 1e-12);
    });
    for (std::size_t c = 0; c < whole.size(); ++c) ASSERT_LE((velocity[c] - fluid.velocity[c]).norm(), 1e-12);
}

}  // namespace
}  // namespace cutterflow::coupling
