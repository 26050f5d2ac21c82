#include <algorithm>
#include <cfenv>
#include <random>

#include "solver/liggghts/tests/engine_fixture.hpp"
#include "solver/physics/catalogue.hpp"

namespace cutterflow::liggghts::tests {

namespace {

/// Linear drag -c v towards a fluid at rest.
coupling::HydrodynamicForce linear_drag(double coefficient) {
    return [coefficient](std::size_t, const Vec3& velocity) { return Vec3(-coefficient * velocity); };
}

/// Brown & Lawler's drag on a sphere in still water.
coupling::HydrodynamicForce sphere_drag(double diameter) {
    return [diameter](std::size_t, const Vec3& velocity) {
        const double speed = velocity.norm();
        if (speed == 0.0) return Vec3(0, 0, 0);
        const double area = k_pi / 4.0 * diameter * diameter;
        const double coefficient = physics::find_drag_law("brown_lawler")({speed * diameter / k_water_viscosity});
        return Vec3(-0.5 * coefficient * area * k_water_density * speed * velocity);
    };
}

double mass_with_added_mass(double diameter) {
    return (k_rock_density + 0.5 * k_water_density) * volume(diameter);
}

Vec3 submerged_weight(double diameter, const Vec3& gravity) {
    return (k_rock_density - k_water_density) * volume(diameter) * gravity;
}

}  // namespace

TEST(RockMotion, a_rock_at_rest_starts_with_the_added_mass_acceleration) {
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    ASSERT_EQ(engine.insert(one_rock(Vec3(0.1, 0.05, 0))), std::vector<int>{1});
    const double duration = 1e-4;
    engine.advance(duration, no_force);
    const double expected = -9.81 * (k_rock_density - k_water_density) / (k_rock_density + 0.5 * k_water_density);
    EXPECT_NEAR(engine.rocks().velocity[0].z() / duration, expected, 1e-6 * std::abs(expected));
}

TEST(RockMotion, fall_with_linear_drag_follows_the_exact_solution) {
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0.1, 0.05, 0.2), Vec3(0.3, 0, 0)));
    const double coefficient = 0.5;
    const double mass = mass_with_added_mass(0.02);
    const double weight = submerged_weight(0.02, Vec3(0, 0, -9.81)).z();
    for (int call = 0; call < 20; ++call) engine.advance(0.005, linear_drag(coefficient));
    const double time = 0.1;
    const double decay = std::exp(-coefficient / mass * time);
    EXPECT_NEAR(engine.rocks().velocity[0].x(), 0.3 * decay, 1e-7);
    EXPECT_NEAR(engine.rocks().velocity[0].z(), weight / coefficient * (1.0 - decay), 1e-7);
    const double fallen = weight / coefficient * (time - mass / coefficient * (1.0 - decay));
    EXPECT_NEAR(engine.rocks().position[0].z(), 0.2 + fallen, 1e-7);
}

// A stiff law at a coarse step: halving the step must quarter the error.
TEST(RockMotion, velocity_dependent_forces_are_of_second_order) {
    const double coefficient = 60.0;
    const double time = 0.004;
    const double exact = 0.3 * std::exp(-coefficient / mass_with_added_mass(0.02) * time);
    std::vector<double> error;
    for (const double fraction : {0.4, 0.2, 0.1}) {
        coupling::DemSettings settings = still_water();
        settings.gravity.setZero();
        settings.contact.youngs_modulus = 1.1e7;
        settings.contact.time_step_fraction = fraction;
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        engine.insert(one_rock(Vec3(0.1, 0.05, 0.2), Vec3(0.3, 0, 0)));
        engine.advance(time, linear_drag(coefficient));
        error.push_back(std::abs(engine.rocks().velocity[0].x() - exact));
    }
    EXPECT_GT(error[0] / error[1], 3.5);
    EXPECT_GT(error[1] / error[2], 3.5);
}

TEST(RockMotion, a_ten_millimetre_rock_settles_at_the_speed_of_the_seeds) {
    coupling::DemSettings settings = still_water();
    settings.domain.lower.z() = -2.0;
    settings.contact.youngs_modulus = 1e6;  // no contact here: long steps
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0, 0.1, 0.4), Vec3::Zero(), 0.01));
    for (int call = 0; call < 150; ++call) engine.advance(0.01, sphere_drag(0.01));
    EXPECT_NEAR(-engine.rocks().velocity[0].z(), 0.7358, 0.0002);
}

// m_eff dv = impulse of the force law + submerged weight, whatever the law and the lengths of the calls.
TEST(RockMotion, impulse_and_weight_make_up_the_change_of_momentum) {
    coupling::DemSettings settings = still_water();
    settings.gravity = Vec3(4.0, -3.0, -8.0);
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 3, Vec3(0.0, 0.1, 0.3), Vec3(1.0, 0.2, -0.1), 0.02);
    add_rock(rocks, 7, Vec3(0.1, -0.1, 0.3), Vec3(-0.3, 0.7, 0.4), 0.013, 2100.0);
    ASSERT_EQ(engine.insert(rocks), (std::vector<int>{3, 7}));
    const std::vector<double> mass = {mass_with_added_mass(0.02), (2100.0 + 0.5 * k_water_density) * volume(0.013)};
    const std::vector<double> excess = {k_rock_density - k_water_density, 2100.0 - k_water_density};
    const std::vector<double> size = {volume(0.02), volume(0.013)};
    for (int call = 0; call < 30; ++call) {
        const double duration = 1e-3 * (1.0 + 0.7 * std::sin(call));
        const auto law = [&](std::size_t index, const Vec3& velocity) {
            return Vec3(-(0.4 + 0.1 * static_cast<double>(index)) * velocity * velocity.norm() + Vec3(0.01 * call, 0, 0.02));
        };
        const std::vector<Vec3> before = engine.rocks().velocity;
        const coupling::DemStep step = engine.advance(duration, law);
        ASSERT_EQ(step.impulse.size(), 2u);
        for (std::size_t k = 0; k < 2; ++k) {
            const Vec3 weight = excess[k] * size[k] * settings.gravity * duration;
            const Vec3 change = mass[k] * (engine.rocks().velocity[k] - before[k]);
            EXPECT_NEAR((change - step.impulse[k] - weight).norm(), 0.0, 1e-12 * mass[k]);
        }
    }
}

// The same with a collision: what is missing is the impulse of the contact, equal and opposite on both rocks.
TEST(RockMotion, contact_impulse_is_the_rest_of_the_change_of_momentum) {
    coupling::DemSettings settings = still_water();
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 1, Vec3(0.0, 0.1, 0.3), Vec3(0.5, 0.0, 0.0), 0.02);
    add_rock(rocks, 2, Vec3(0.0205, 0.104, 0.3), Vec3(-0.5, 0.0, 0.0), 0.02);
    ASSERT_EQ(engine.insert(rocks), (std::vector<int>{1, 2}));
    const Vec3 weight = (k_rock_density - k_water_density) * volume(0.02) * settings.gravity;
    double largest = 0.0;
    for (int call = 0; call < 20; ++call) {
        const std::vector<Vec3> before = engine.rocks().velocity;
        const coupling::DemStep step = engine.advance(2e-4, linear_drag(0.5));
        ASSERT_EQ(step.contact_impulse.size(), 2u);
        largest = std::max(largest, step.contact_impulse[0].norm());
        EXPECT_NEAR((step.contact_impulse[0] + step.contact_impulse[1]).norm(), 0.0, 1e-14);
        for (std::size_t k = 0; k < 2; ++k) {
            const Vec3 change = mass_with_added_mass(0.02) * (engine.rocks().velocity[k] - before[k]);
            EXPECT_NEAR((change - step.impulse[k] - step.contact_impulse[k] - 2e-4 * weight).norm(), 0.0, 1e-14);
        }
    }
    EXPECT_GT(largest, 1e-3);  // they met: 13 g at 0.5 m/s
}

// The search by cells finds what a search of all pairs finds.
TEST(Room, is_where_no_rock_wall_or_earlier_rock_overlaps) {
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.12, 0.12), size(0.006, 0.03);
    const auto draw = [&](int first, int count) {
        coupling::Rocks rocks;
        for (int k = 0; k < count; ++k)
            add_rock(rocks, first + k, Vec3(place(random), place(random), place(random)), Vec3::Zero(), size(random));
        return rocks;
    };
    coupling::Rocks there, asked = draw(501, 400);
    const coupling::Rocks wanted = draw(1, 200);
    const std::vector<int> inserted = engine.insert(wanted);
    for (std::size_t k = 0; k < wanted.size(); ++k)
        if (std::binary_search(inserted.begin(), inserted.end(), wanted.id[k])) there.append(wanted, k);
    ASSERT_GT(there.size(), 50u);
    ASSERT_LT(there.size(), 200u);

    const std::vector<bool> room = engine.room_for(asked);
    std::size_t rooms = 0;
    for (std::size_t k = 0; k < asked.size(); ++k) {
        bool free = true;
        for (std::size_t j = 0; j < there.size(); ++j)
            free = free && (there.position[j] - asked.position[k]).norm() >= 0.5 * (there.diameter[j] + asked.diameter[k]);
        EXPECT_EQ(room[k], free) << k;
        if (!free) continue;
        ++rooms;
        there.append(asked, k);
    }
    EXPECT_GT(rooms, 10u);
}

// The first half kick of a call uses the law of that call: with a law that is 0 in every second call, the velocity does not change in it.
TEST(RockMotion, no_half_kick_uses_the_law_of_the_call_before) {
    coupling::DemSettings settings = still_water();
    settings.gravity.setZero();
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0, 0, 0)));
    const auto push = [](std::size_t, const Vec3&) { return Vec3(0, 0, 1.0); };
    for (int call = 0; call < 4; ++call) {
        engine.advance(1e-4, push);
        const Vec3 velocity = engine.rocks().velocity[0];
        EXPECT_NEAR(velocity.z(), 1e-4 * (call + 1) / mass_with_added_mass(0.02), 1e-15);
        engine.advance(1e-4, no_force);
        EXPECT_EQ(engine.rocks().velocity[0], velocity);
    }
}

TEST(RockMotion, contact_free_rocks_move_the_same_on_one_rank_and_on_all) {
    const auto run = [](MPI_Comm communicator) {
        LiggghtsEngine engine(still_water(), no_zones(), communicator);
        coupling::Rocks rocks;
        for (int k = 0; k < 27; ++k)
            add_rock(rocks, k + 1, Vec3(-0.1 + 0.1 * (k % 3), -0.1 + 0.1 * (k / 3 % 3), -0.1 + 0.1 * (k / 9)),
                     Vec3(0.9 - 0.05 * (k % 5), 0, 0));
        EXPECT_EQ(engine.insert(rocks).size(), 27u);
        for (int call = 0; call < 20; ++call) engine.advance(0.005, sphere_drag(0.02));
        return engine.rocks();
    };
    const coupling::Rocks alone = run(MPI_COMM_SELF);
    const coupling::Rocks together = run(MPI_COMM_WORLD);
    ASSERT_EQ(alone.id, together.id);
    for (std::size_t k = 0; k < alone.size(); ++k) EXPECT_NEAR((alone.position[k] - together.position[k]).norm(), 0.0, 1e-12);
}

TEST(RockMotion, a_rock_that_leaves_the_domain_is_reported_once) {
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 4, Vec3(0.45, 0, 0), Vec3(2.0, 0, 0));
    add_rock(rocks, 5, Vec3(0, 0, 0), Vec3::Zero());
    add_rock(rocks, 9, Vec3(0, 0.1, -0.45), Vec3(0, 0, -2.0));
    ASSERT_EQ(engine.insert(rocks).size(), 3u);
    std::vector<int> left;
    for (int call = 0; call < 30; ++call) {
        const coupling::DemStep step = engine.advance(2e-3, linear_drag(0.01));
        ASSERT_EQ(step.impulse.size(), engine.rocks().size());
        ASSERT_EQ(step.left_impulse.size(), step.left.size());
        for (std::size_t k = 0; k < step.left.size(); ++k) {
            left.push_back(step.left.id[k]);
            const Vec3& position = step.left.position[k];
            EXPECT_TRUE(position.head<2>().norm() > 0.5 || position.z() < -0.5);
            EXPECT_LT(position.head<2>().norm(), 0.5 + 2e-3 * 2.0);
            EXPECT_NEAR(step.left.velocity[k].norm(), 2.0, 0.2);
            EXPECT_LT(step.left_impulse[k].dot(step.left.velocity[k]), 0.0);
        }
    }
    std::sort(left.begin(), left.end());
    EXPECT_EQ(left, (std::vector<int>{4, 9}));
    EXPECT_EQ(engine.rocks().id, std::vector<int>{5});
}

// LIGGGHTS drops a rock beyond its box. That takes a call in which a rock crosses a quarter of the domain: too long to be right.
TEST(RockMotion, a_rock_that_vanishes_ends_the_run_with_its_cause) {
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 1, Vec3(0.45, 0, 0), Vec3(100.0, 0, 0));
    add_rock(rocks, 2, Vec3(-0.1, 0.05, 0), Vec3(3.0, 0, 0));
    engine.insert(rocks);
    try {
        engine.advance(0.01, no_force);
        FAIL();
    } catch (const CheckFailure& failure) {
        EXPECT_NE(
            std::string(failure.what()).find("1 of 2 rocks vanished from the DEM near 0.01 s; the fastest of the others moves at 3 m/s"),
            std::string::npos)
            << failure.what();
    }
}

TEST(RockMotion, a_force_that_is_no_number_is_a_defect_and_not_a_rock_that_left) {
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0, 0, 0)));
    const auto broken = [](std::size_t, const Vec3&) { return Vec3(std::nan(""), 0, 0); };
    EXPECT_THROW(engine.advance(1e-3, broken), std::logic_error);
}

// OpenFOAM runs in the same process with these traps on.
TEST(RockMotion, no_floating_point_exception_is_raised) {
    coupling::DemSettings settings = still_water();
    settings.domain.lower.z() = -0.1;
    settings.domain.make_wall(coupling::DomainSide::z_min);
    const auto folder = scratch_folder();
    settings.walls = {{"paddle", write_stl(folder / "paddle.stl", block(Vec3(0.05, -0.01, -0.08), Vec3(0.3, 0.01, 0.05), 3)), true},
                      {"plate", write_stl(folder / "plate.stl", block(Vec3(-0.4, -0.1, -0.08), Vec3(-0.38, 0.1, 0.05), 2)), false}};
    coupling::ZoneMotion rotor;
    rotor.speed = 6.0;
    feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    {
        LiggghtsEngine engine(settings, {rotor}, MPI_COMM_WORLD);
        engine.advance(1e-2, no_force);  // without rock
        coupling::Rocks rocks;
        for (int k = 0; k < 64; ++k) add_rock(rocks, k + 1, Vec3(-0.2 + 0.05 * (k % 8), -0.2 + 0.05 * (k / 8), -0.08));
        EXPECT_GT(engine.insert(rocks).size(), 50u);
        int contacts = 0;
        for (int call = 0; call < 40; ++call) contacts += engine.advance(5e-3, sphere_drag(0.02)).contacts;
        EXPECT_GT(contacts, 10);
        engine.write_checkpoint(folder);
        engine.read_checkpoint(folder);
        engine.advance(5e-3, sphere_drag(0.02));
    }
    fedisableexcept(FE_ALL_EXCEPT);
}

}  // namespace cutterflow::liggghts::tests
