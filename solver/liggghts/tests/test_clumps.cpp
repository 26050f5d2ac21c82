/// Clumps as rigid bodies: free turning, contacts of their spheres, ranks, checkpoints.
#include <algorithm>
#include <cmath>

#include "solver/liggghts/rigid_bodies.hpp"
#include "solver/liggghts/tests/engine_fixture.hpp"

namespace cutterflow::liggghts::tests {

namespace {

using coupling::Rock;
using coupling::Rocks;

/// Four balls without any symmetry.
coupling::ClumpShape lump() {
    return {"lump", geometry::unit_clump({{{Vec3(0, 0, 0), 0.010},
                                           {Vec3(0.008, 0.001, 0.0), 0.007},
                                           {Vec3(-0.006, 0.007, 0.002), 0.006},
                                           {Vec3(0.001, -0.008, 0.004), 0.0055}}})};
}

coupling::ClumpShape dumbbell() {
    return {"dumbbell", geometry::unit_clump({{{Vec3(-0.006, 0, 0), 0.01}, {Vec3(0.006, 0, 0), 0.01}}})};
}

coupling::ClumpShape ball() {
    return {"ball", geometry::unit_clump({{{Vec3(0.3, 0.1, -0.2), 0.004}}})};
}

coupling::DemSettings with(const std::vector<coupling::ClumpShape>& shapes) {
    coupling::DemSettings settings = still_water();
    settings.shapes = shapes;
    return settings;
}

/// No fluid, no weight.
coupling::DemSettings in_space(const std::vector<coupling::ClumpShape>& shapes) {
    coupling::DemSettings settings = with(shapes);
    settings.gravity.setZero();
    settings.fluid = {};
    settings.contact.wet_restitution = false;
    return settings;
}

Eigen::Quaterniond some_turn(double seed) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(1.3 * seed + 0.4, Vec3(std::sin(seed), 0.6, std::cos(2.0 * seed)).normalized()));
}

Rock clump_at(int id, const Vec3& position, int shape = 0, double diameter = 0.02) {
    Rock rock;
    rock.id = id;
    rock.position = position;
    rock.diameter = diameter;
    rock.density = k_rock_density;
    rock.shape = shape;
    rock.orientation = some_turn(id);
    return rock;
}

Rocks only(const Rock& rock) {
    Rocks rocks;
    rocks.append(rock);
    return rocks;
}

double mass_of(const Rock& rock) {
    return rock.density * volume(rock.diameter);
}

/// About the centre of mass, absolute frame.
Eigen::Matrix3d inertia_of(const Rock& rock, const coupling::ClumpShape& shape) {
    const Eigen::Matrix3d turn = rock.orientation.toRotationMatrix() * shape.clump.axes;
    return rock.density * std::pow(rock.diameter, 5) * turn * shape.clump.moments.asDiagonal() * turn.transpose();
}

double energy_of(const Rock& rock, const coupling::ClumpShape& shape) {
    return 0.5 * mass_of(rock) * rock.velocity.squaredNorm() +
           0.5 * rock.angular_velocity.dot(inertia_of(rock, shape) * rock.angular_velocity);
}

Vec3 momentum_about_origin(const Rock& rock, const coupling::ClumpShape& shape) {
    return inertia_of(rock, shape) * rock.angular_velocity + mass_of(rock) * rock.position.cross(rock.velocity);
}

double farthest(const Rocks& a, const Rocks& b) {
    EXPECT_EQ(a.id, b.id);
    double most = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        most = std::max(most, (a.position[k] - b.position[k]).norm());
        most = std::max(most, a.diameter[k] * a.orientation[k].angularDistance(b.orientation[k]));
    }
    return most;
}

double duration(int call) {
    return 2e-3 * (1.0 + 0.5 * std::sin(call));
}

Vec3 drag(std::size_t, const Vec3& velocity) {
    return Vec3(-0.1 * velocity);
}

/// A heap of 24 lumps and spheres that falls on the floor.
struct Heap {
    coupling::DemSettings settings = with({lump(), dumbbell()});
    Rocks rocks;

    Heap() {
        settings.domain.lower.z() = -0.1;
        settings.domain.make_wall(coupling::DomainSide::z_min);
        settings.contact.set_every_pair({0.5, 0.3, 0.1});
        for (int k = 0; k < 24; ++k) {
            Rock rock =
                clump_at(3 * k + 1, Vec3(-0.05 + 0.031 * (k % 4), -0.02 + 0.031 * (k / 4 % 3), -0.08 + 0.031 * (k / 12)), k % 3 - 1);
            if (rock.shape == coupling::k_sphere_shape) rock.orientation.setIdentity();
            rock.velocity = Vec3(0.1 * std::sin(k), 0.1 * std::cos(k), -0.3);
            rocks.append(rock);
        }
    }
};

}  // namespace

// A symmetric body's axis goes about L at the rate |L|/I_across.
TEST(FreeTurning, of_a_symmetric_body_is_its_precession) {
    const Vec3 moments(1.0, 2.5, 2.5), momentum(0.3, 0.4, 1.2);
    const Eigen::Quaterniond start = some_turn(1.0);
    Eigen::Quaterniond turn = start;
    const double step = 0.01;
    const int steps = 5000;
    for (int k = 0; k < steps; ++k) turn = turned_freely(turn, momentum, moments, step);
    const Vec3 expected = Eigen::AngleAxisd(steps * step * momentum.norm() / 2.5, momentum.normalized()) * (start * Vec3::UnitX());
    EXPECT_LT((turn * Vec3::UnitX() - expected).norm(), 1e-8);
}

TEST(FreeTurning, keeps_the_energy_over_a_hundred_turns) {
    const Vec3 moments(1.0, 1.6, 2.1), momentum(0.4, 1.1, 0.5);
    Eigen::Quaterniond turn = some_turn(2.0);
    const auto energy = [&] {
        const Vec3 inside = turn.conjugate() * momentum;
        return 0.5 * inside.dot(inside.cwiseQuotient(moments));
    };
    const double at_first = energy();
    double most = 0.0;
    const int steps_per_turn = 200;
    for (int k = 0; k < 100 * steps_per_turn; ++k) {
        turn = turned_freely(turn, momentum, moments, 2.0 * k_pi / (momentum.norm() / 1.6) / steps_per_turn);
        most = std::max(most, std::abs(energy() / at_first - 1.0));
    }
    EXPECT_LT(most, 1e-6);
    EXPECT_GT(most, 0.0);
}

TEST(Clumps, tumble_freely_with_constant_momentum_and_energy_and_flip_about_the_middle_axis) {
    const coupling::ClumpShape shape = lump();
    coupling::DemSettings settings = in_space({shape});
    settings.contact.youngs_modulus = 1e7;  // its step, 9e-5 s, is 1/700 of a turn
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    Rock rock = clump_at(1, Vec3(0.1, 0, 0));
    const Vec3 middle = rock.orientation * Vec3(shape.clump.axes.col(1));
    rock.angular_velocity = 100.0 * (middle + Vec3(1e-4, 2e-4, -1e-4));
    ASSERT_EQ(engine.insert(only(rock)), std::vector<int>{1});
    const double energy = energy_of(rock, shape);
    const Vec3 momentum = inertia_of(rock, shape) * rock.angular_velocity;
    const double turn = 2.0 * k_pi / 100.0;
    bool against = false, along_again = false;
    double energy_error = 0.0, momentum_error = 0.0;
    int contacts = 0;
    for (int call = 0; call < 1000; ++call) {
        contacts += engine.advance(0.1 * turn, no_force).contacts;
        const Rock now = engine.rocks().at(0);
        energy_error = std::max(energy_error, std::abs(energy_of(now, shape) / energy - 1.0));
        momentum_error = std::max(momentum_error, (inertia_of(now, shape) * now.angular_velocity - momentum).norm() / momentum.norm());
        const double along = (now.orientation * Vec3(shape.clump.axes.col(1))).dot(momentum.normalized());
        against = against || along < -0.99;
        along_again = along_again || (against && along > 0.99);
    }
    EXPECT_LT(energy_error, 1e-6);
    EXPECT_LT(momentum_error, 1e-10);
    EXPECT_TRUE(against);
    EXPECT_TRUE(along_again);
    EXPECT_EQ(contacts, 0) << "spheres of one clump overlap without touching";
    EXPECT_LT((engine.rocks().position[0] - rock.position).norm(), 1e-12);
}

TEST(Clumps, of_one_ball_move_as_spheres) {
    coupling::DemSettings settings = with({ball()});
    settings.domain.lower.z() = -0.05;
    settings.domain.make_wall(coupling::DomainSide::z_min);
    settings.contact.set_every_pair({0.5, 0.3, 0.1});
    const auto end = [&](int shape) {
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        Rocks rocks;
        for (int k = 0; k < 2; ++k) {
            Rock rock = clump_at(k + 1, Vec3(0.001 * k, 0.018 * k, -0.035), shape);
            rock.orientation.setIdentity();
            rock.velocity = Vec3(0.3, -0.4 * k, -0.2);
            rock.angular_velocity = Vec3(1.0, 20.0 * k, 5.0);
            rocks.append(rock);
        }
        rocks.position[1].y() = 0.0205;
        EXPECT_EQ(engine.insert(rocks).size(), 2u);
        int contacts = 0;
        for (int call = 0; call < 60; ++call) contacts += engine.advance(duration(call), drag).contacts;
        EXPECT_GT(contacts, 5);
        return engine.rocks();
    };
    const Rocks spheres = end(coupling::k_sphere_shape), clumps = end(0);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_LT((spheres.position[k] - clumps.position[k]).norm(), 1e-9);
        EXPECT_LT((spheres.velocity[k] - clumps.velocity[k]).norm(), 1e-7);
        EXPECT_LT((spheres.angular_velocity[k] - clumps.angular_velocity[k]).norm(), 1e-5);
    }
}

TEST(Clumps, keep_their_energy_in_a_frictionless_bounce_off_a_plane_and_a_wall) {
    for (const bool of_triangles : {false, true}) {
        coupling::DemSettings settings = in_space({lump()});
        settings.contact.set_every_pair({0.0, 1.0, 0.0});
        settings.domain.lower.z() = -0.1;
        if (of_triangles)
            settings.walls = {
                {"floor", write_stl(scratch_folder() / "floor.stl", block(Vec3(-0.2, -0.2, -0.15), Vec3(0.2, 0.2, -0.09), 2)), false}};
        else
            settings.domain.make_wall(coupling::DomainSide::z_min);
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        Rock rock = clump_at(4, Vec3(0, 0, -0.06));
        rock.velocity = Vec3(0.2, 0.1, -1.0);
        rock.angular_velocity = Vec3(20.0, -10.0, 5.0);
        engine.insert(only(rock));
        double contact_impulse = 0.0;
        for (int call = 0; call < 60; ++call) contact_impulse += engine.advance(1e-3, no_force).contact_impulse[0].z();
        const Rock after = engine.rocks().at(0);
        EXPECT_NEAR(energy_of(after, lump()) / energy_of(rock, lump()), 1.0, 1e-3);
        EXPECT_GT(contact_impulse, 0.5 * mass_of(rock));
        EXPECT_NEAR(contact_impulse, mass_of(rock) * (after.velocity.z() - rock.velocity.z()), 1e-9 * mass_of(rock));
        EXPECT_GT((after.angular_velocity - rock.angular_velocity).norm(), 5.0);
    }
}

TEST(Clumps, that_collide_keep_momentum_and_angular_momentum) {
    const coupling::ClumpShape shape = lump();
    coupling::DemSettings settings = in_space({shape});
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    Rocks rocks;
    for (int k = 0; k < 2; ++k) {
        Rock rock = clump_at(k + 7, Vec3(0.03 * k - 0.015, 0.004 * k, 0.0));
        rock.velocity = Vec3(k == 0 ? 0.8 : -0.5, 0.1, 0.0);
        rock.angular_velocity = Vec3(10.0, 5.0 * k, -4.0);
        rocks.append(rock);
    }
    ASSERT_EQ(engine.insert(rocks).size(), 2u);
    const auto sums = [&](const Rocks& all) {
        Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
        for (std::size_t k = 0; k < 2; ++k) {
            linear += mass_of(all.at(k)) * all.velocity[k];
            angular += momentum_about_origin(all.at(k), shape);
        }
        return std::pair(linear, angular);
    };
    const auto before = sums(rocks);
    int contacts = 0;
    for (int call = 0; call < 300; ++call) contacts += engine.advance(1e-4, no_force).contacts;
    const auto after = sums(engine.rocks());
    EXPECT_GT(contacts, 0);
    EXPECT_GT((engine.rocks().velocity[0] - rocks.velocity[0]).norm(), 0.1);
    EXPECT_LT((after.first - before.first).norm(), 1e-12 * before.first.norm());
    EXPECT_LT((after.second - before.second).norm(), 1e-5 * before.second.norm());
}

TEST(Clumps, lie_still_on_two_spheres_under_their_submerged_weight) {
    coupling::DemSettings settings = with({dumbbell()});
    settings.domain.lower.z() = 0.0;
    settings.domain.make_wall(coupling::DomainSide::z_min);
    coupling::use_preset(settings.contact, coupling::k_gravel_pairs);
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    Rock rock = clump_at(1, Vec3::Zero());
    rock.orientation.setIdentity();
    rock.position.z() = 1.0001 * rock.diameter * dumbbell().clump.balls[0].radius;
    ASSERT_EQ(engine.insert(only(rock)).size(), 1u);
    for (int call = 0; call < 200; ++call) engine.advance(2e-3, drag);
    const coupling::DemStep step = engine.advance(1e-3, no_force);
    EXPECT_EQ(step.contacts, 2);
    const double weight = 9.81 * (k_rock_density - k_water_density) * volume(rock.diameter);
    EXPECT_NEAR(step.contact_impulse[0].z() / 1e-3, weight, 1e-3 * weight);
    EXPECT_LT(engine.rocks().velocity[0].norm(), 1e-5);
    EXPECT_LT(engine.rocks().orientation[0].angularDistance(Eigen::Quaterniond::Identity()), 1e-4);
}

TEST(Clumps, fall_in_water_with_their_added_mass) {
    LiggghtsEngine engine(with({lump()}), no_zones(), MPI_COMM_WORLD);
    engine.insert(only(clump_at(1, Vec3(0, 0, 0.3))));
    const coupling::DemStep step = engine.advance(0.02, [](std::size_t, const Vec3&) { return Vec3(0.01, 0, 0); });
    const double m = k_rock_density * volume(0.02), displaced = k_water_density * volume(0.02);
    EXPECT_NEAR(engine.rocks().velocity[0].z(), -9.81 * 0.02 * (m - displaced) / (m + 0.5 * displaced), 1e-12);
    EXPECT_NEAR(engine.rocks().velocity[0].x(), 0.01 * 0.02 / (m + 0.5 * displaced), 1e-12);
    EXPECT_NEAR(step.impulse[0].x(), 0.01 * 0.02, 1e-15);
}

TEST(Clumps, are_placed_where_all_their_spheres_have_room) {
    coupling::DemSettings settings = with({dumbbell()});
    settings.domain.make_wall(coupling::DomainSide::z_min);
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    const auto& balls = dumbbell().clump.balls;
    const double d = 0.02, end = d * std::abs(balls[0].centre.x()), radius = d * balls[0].radius;
    Rock first = clump_at(1, Vec3::Zero());
    first.orientation.setIdentity();
    ASSERT_EQ(engine.insert(only(first)).size(), 1u);
    const auto fits = [&](const Vec3& position, bool upright) -> bool {
        Rock rock = clump_at(2, position);
        rock.orientation = upright ? Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * k_pi, Vec3::UnitY())) : Eigen::Quaterniond::Identity();
        return engine.room_for(only(rock)).front();
    };
    EXPECT_TRUE(fits(Vec3(2.01 * (end + radius), 0, 0), false));
    EXPECT_FALSE(fits(Vec3(1.99 * (end + radius), 0, 0), false));
    EXPECT_TRUE(fits(Vec3(0, 2.01 * radius, 0), false)) << "beside it, nearer than its reach";
    EXPECT_TRUE(fits(Vec3(0, 0.1, -0.5 + 1.01 * radius), false));
    EXPECT_FALSE(fits(Vec3(0, 0.1, -0.5 + 1.01 * radius), true)) << "through the floor";
    EXPECT_FALSE(fits(Vec3(0, 0, 0.51), false)) << "its centre outside the domain";
}

TEST(Clumps, leave_as_a_whole_when_their_centre_leaves_the_domain) {
    LiggghtsEngine engine(with({lump()}), no_zones(), MPI_COMM_WORLD);
    Rock rock = clump_at(1, Vec3(0.49, 0, 0));
    rock.velocity = Vec3(1.0, 0, 0);
    Rocks rocks = only(rock);
    rocks.append(clump_at(2, Vec3(0, 0, 0)));
    ASSERT_EQ(engine.insert(rocks).size(), 2u);
    EXPECT_EQ(engine.advance(5e-3, no_force).left.size(), 0u);
    const coupling::DemStep step = engine.advance(1e-2, no_force);
    EXPECT_EQ(step.left.id, std::vector<int>{1});
    EXPECT_EQ(engine.rocks().id, std::vector<int>{2});
    engine.remove(std::vector<int>{2});
    EXPECT_EQ(engine.rocks().size(), 0u);
    EXPECT_EQ(engine.insert(only(clump_at(2, Vec3(0, 0, 0)))), std::vector<int>{2}) << "its spheres went with it";
}

TEST(Clumps, that_vanish_end_the_run_with_their_cause) {
    LiggghtsEngine engine(with({lump()}), no_zones(), MPI_COMM_WORLD);
    Rock rock = clump_at(1, Vec3(0.45, 0, 0));
    rock.velocity = Vec3(100.0, 0, 0);
    Rocks rocks = only(rock);
    rocks.append(clump_at(2, Vec3(0, 0, 0)));
    ASSERT_EQ(engine.insert(rocks).size(), 2u);
    try {
        engine.advance(0.01, no_force);
        FAIL();
    } catch (const CheckFailure& failure) {
        EXPECT_NE(std::string(failure.what()).find("of 8 spheres of clumps vanished from the DEM by 0.01 s"), std::string::npos)
            << failure.what();
    }
}

TEST(Clumps, move_alike_on_any_number_of_ranks) {
    const Heap heap;
    LiggghtsEngine all(heap.settings, no_zones(), MPI_COMM_WORLD), alone(heap.settings, no_zones(), MPI_COMM_SELF);
    ASSERT_EQ(all.insert(heap.rocks).size(), 24u);
    alone.insert(heap.rocks);
    coupling::DemStep last;
    for (int call = 0; call < 120; ++call) {
        last = all.advance(1e-3, drag);
        const coupling::DemStep other = alone.advance(1e-3, drag);
        for (std::size_t k = 0; k < 24; ++k) {
            ASSERT_LT((last.impulse[k] - other.impulse[k]).norm(), 1e-9);
            ASSERT_LT((last.contact_impulse[k] - other.contact_impulse[k]).norm(), 1e-8);
        }
    }
    EXPECT_GT(last.contacts, 10);
    EXPECT_LT(farthest(all.rocks(), alone.rocks()), 1e-8);
}

TEST(Clumps, go_on_from_a_checkpoint_as_if_never_stopped) {
    const auto folder = scratch_folder();
    const Heap heap;
    LiggghtsEngine through(heap.settings, no_zones(), MPI_COMM_WORLD), first(heap.settings, no_zones(), MPI_COMM_WORLD);
    through.insert(heap.rocks);
    first.insert(heap.rocks);
    for (int call = 0; call < 120; ++call) {
        through.advance(1e-3, drag);
        first.advance(1e-3, drag);
    }
    first.write_checkpoint(folder);
    LiggghtsEngine second(heap.settings, no_zones(), MPI_COMM_WORLD);
    second.read_checkpoint(folder);
    EXPECT_LT(farthest(second.rocks(), first.rocks()), 1e-17);
    coupling::DemStep last;
    for (int call = 0; call < 5; ++call) {
        last = through.advance(1e-3, drag);
        first.advance(1e-3, drag);
        second.advance(1e-3, drag);
    }
    EXPECT_GT(last.contacts, 10);
    EXPECT_LT(farthest(second.rocks(), through.rocks()), 1e-12);
    EXPECT_LT(farthest(first.rocks(), through.rocks()), 1e-12) << "writing a checkpoint must not disturb the run";
}

TEST(Clumps, of_other_shapes_do_not_go_on_from_a_checkpoint) {
    const auto folder = scratch_folder();
    const Heap heap;
    LiggghtsEngine first(heap.settings, no_zones(), MPI_COMM_WORLD);
    first.insert(heap.rocks);
    first.write_checkpoint(folder);
    coupling::DemSettings other = heap.settings;
    other.shapes = {lump()};
    LiggghtsEngine second(other, no_zones(), MPI_COMM_WORLD);
    EXPECT_THROW(second.read_checkpoint(folder), UserError);
    LiggghtsEngine spheres(still_water(), no_zones(), MPI_COMM_WORLD);
    EXPECT_THROW(spheres.read_checkpoint(folder), UserError);
}

TEST(Clumps, that_are_frozen_stay_where_they_are_and_hold_others) {
    coupling::DemSettings settings = with({dumbbell()});
    settings.contact.set_every_pair({0.5, 0.3, 0.1});
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    Rock below = clump_at(1, Vec3(0, 0, 0)), above = clump_at(2, Vec3(0, 0, 0.021));
    below.orientation.setIdentity();
    above.orientation.setIdentity();
    below.angular_velocity = Vec3(1.0, 2.0, 3.0);
    Rocks rocks = only(below);
    rocks.append(above);
    ASSERT_EQ(engine.insert(rocks).size(), 2u);
    engine.freeze(std::vector<int>{1});
    EXPECT_EQ(engine.frozen(), std::vector<int>{1});
    int contacts = 0;
    for (int call = 0; call < 40; ++call) contacts += engine.advance(2e-3, drag).contacts;
    EXPECT_EQ(engine.rocks().position[0], below.position);
    EXPECT_EQ(engine.rocks().orientation[0].coeffs(), below.orientation.coeffs());
    EXPECT_EQ(engine.rocks().velocity[0], Vec3(Vec3::Zero()));
    EXPECT_EQ(engine.rocks().angular_velocity[0], Vec3(Vec3::Zero()));
    EXPECT_GT(contacts, 0) << "the one above has fallen on it";
    EXPECT_GT(engine.rocks().position[1].z(), 0.015);
    engine.thaw(std::vector<int>{1});
    engine.advance(2e-3, drag);
    EXPECT_LT(engine.rocks().velocity[0].z(), 0.0);
    EXPECT_TRUE(engine.frozen().empty());
}

// The forces of contacts on a long body turn it more easily than they push it; the rule allows for that.
TEST(Clumps, have_a_time_step_of_their_spheres_and_their_lightest_push) {
    const auto step_of = [](const coupling::ClumpShape& shape, int number) {
        LiggghtsEngine engine(with({shape}), no_zones(), MPI_COMM_WORLD);
        engine.insert(only(clump_at(1, Vec3::Zero(), number)));
        return engine.largest_time_step();
    };
    const double sphere = step_of(ball(), coupling::k_sphere_shape);
    EXPECT_NEAR(step_of(ball(), 0), sphere, 1e-9 * sphere);
    EXPECT_LT(step_of(dumbbell(), 0), 0.999 * sphere);
    EXPECT_GT(step_of(dumbbell(), 0), 0.5 * sphere);
}

}  // namespace cutterflow::liggghts::tests
