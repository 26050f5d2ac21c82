#include <algorithm>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/liggghts/tests/engine_fixture.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::liggghts::tests {

namespace {

/// A paddle from the axis outwards, turning about z at `speed` in still water without gravity.
struct Paddle {
    coupling::DemSettings settings = still_water();
    coupling::ZoneMotion rotor;

    explicit Paddle(double speed) {
        settings.gravity.setZero();
        settings.walls = {
            {"paddle", write_stl(scratch_folder() / "paddle.stl", block(Vec3(0.05, -0.01, -0.05), Vec3(0.3, 0.01, 0.05), 3)), true}};
        rotor.speed = speed;
    }
};

/// Durations of calls that differ from one to the next, as the coupled run's do.
double uneven_duration(int call) {
    return 1e-3 * (1.0 + 0.6 * std::sin(1.7 * call));
}

}  // namespace

class RotorAngle : public ::testing::TestWithParam<double> {};

TEST_P(RotorAngle, is_speed_times_time_when_the_steps_differ) {
    Paddle paddle(GetParam());
    LiggghtsEngine engine(paddle.settings, {paddle.rotor}, MPI_COMM_WORLD);
    EXPECT_NEAR(engine.zone_angles().at(0), 0.0, 1e-15);
    engine.insert(one_rock(Vec3(-0.4, 0, 0.3)));  // gives the DEM its own step: 25 to 60 per call
    double time = 0.0;
    for (int call = 0; call < 150; ++call) {
        engine.advance(uneven_duration(call), no_force);
        time += uneven_duration(call);
        ASSERT_NEAR(engine.zone_angles().at(0), paddle.rotor.angle(time), 1e-9) << "call " << call;
    }
    // The paddle's face stands there: a rock beside it has room, one a nanometre closer has none.
    const auto has_room = [&](double distance) {
        const Vec3 place = rotate_about(paddle.rotor.axis, paddle.rotor.angle(time), Vec3(0.2, 0.02 + distance, 0.0));
        return bool(engine.room_for(one_rock(place)).at(0));
    };
    EXPECT_TRUE(has_room(1e-9));
    EXPECT_FALSE(has_room(-1e-9));
}

INSTANTIATE_TEST_SUITE_P(Speeds, RotorAngle, ::testing::Values(60.0, -60.0),
                         [](const auto& info) { return info.param > 0.0 ? "right_handed" : "left_handed"; });

TEST(Walls, a_rotating_wall_stands_when_the_rotor_does) {
    Paddle paddle(0.0);
    LiggghtsEngine engine(paddle.settings, {paddle.rotor}, MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0.2, 0.03, 0)));
    engine.advance(0.01, no_force);
    EXPECT_EQ(engine.zone_angles().at(0), 0.0);
    EXPECT_EQ(engine.rocks().velocity[0], Vec3(0, 0, 0));
}

// The angular momentum about the axis that the rock gains (added mass included) is what the steel loses.
TEST(Walls, the_torque_on_a_paddle_balances_what_it_gives_to_the_rocks) {
    Paddle paddle(2.0 * k_pi);
    LiggghtsEngine engine(paddle.settings, {paddle.rotor}, MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 1, Vec3(0.15, 0.06, 0.0));
    add_rock(rocks, 2, Vec3(0.2, 0.08, 0.02));
    add_rock(rocks, 3, Vec3(0.28, 0.05, -0.03));
    ASSERT_EQ(engine.insert(rocks).size(), 3u);
    const double mass = (k_rock_density + 0.5 * k_water_density) * volume(0.02);
    const double inertia = 0.4 * k_rock_density * volume(0.02) * 1e-4;
    const auto angular_momentum = [&] {
        double sum = 0.0;
        for (std::size_t k = 0; k < engine.rocks().size(); ++k)
            sum += (engine.rocks().position[k].cross(mass * engine.rocks().velocity[k]) + inertia * engine.rocks().angular_velocity[k]).z();
        return sum;
    };
    double given = 0.0;
    for (int call = 0; call < 80; ++call) given += engine.advance(1e-3, no_force).cutter_torque * 1e-3;
    EXPECT_GT(angular_momentum(), 0.0) << "the paddle turns right-handed and must drag the rocks along";
    EXPECT_LT(given, 0.0) << "the rocks resist the paddle";
    // Positions move within a step while force and torque are taken at its ends: second order in the step.
    EXPECT_NEAR(given, -angular_momentum(), 2e-3 * angular_momentum());
    for (const Vec3& velocity : engine.rocks().velocity) EXPECT_GT(velocity.norm(), 0.5);
}

/// A rock at rest on a plate that travels upwards from 0.05 s to 0.15 s, in uneven calls that meet both times.
struct Lift {
    static constexpr double speed = 0.4, begin = 0.05, end = 0.15;
    std::filesystem::path folder = scratch_folder();
    coupling::DemSettings settings = still_water();

    Lift() {
        const auto file = write_stl(folder / "plate.stl", block(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.0), 2));
        settings.walls = {{"plate", file, false, {{Vec3(0, 0, speed), begin, end}}}};
        settings.contact.wet_restitution = false;
        settings.contact.rock_steel.restitution = 0.3;
    }
    /// Height of the rock's lowest point over the plate's first place.
    static double follow(LiggghtsEngine& engine, double from, double to) {
        double time = from;
        for (int call = 0; time < to; ++call) {
            double next = std::min(to, time + uneven_duration(call));
            for (const double event : {begin, end})
                if (time < event && next > event) next = event;
            engine.advance(next - time, no_force);
            time = next;
        }
        return engine.rocks().position[0].z() - 0.01;
    }
};

// The overlap under the own weight is 4.2 micrometres.
TEST(Walls, a_wall_that_travels_carries_rock_and_stops) {
    Lift lift;
    LiggghtsEngine engine(lift.settings, no_zones(), MPI_COMM_WORLD);
    ASSERT_EQ(engine.insert(one_rock(Vec3(0, 0, 0.01))).size(), 1u);
    const double rest = Lift::follow(engine, 0.0, 0.05);
    EXPECT_NEAR(rest, 0.0, 5e-6);
    EXPECT_GT(Lift::follow(engine, 0.05, 0.10), 0.4 * 0.05 - 5e-6);
    EXPECT_NEAR(Lift::follow(engine, 0.10, 1.0) - rest, 0.04, 1e-8);  // thrown up when the plate stops, back at rest
    EXPECT_NEAR(engine.rocks().velocity[0].norm(), 0.0, 1e-3);
    coupling::Rocks rocks;
    add_rock(rocks, 2, Vec3(0.05, 0.05, 0.01));   // where the plate is now
    add_rock(rocks, 3, Vec3(0.05, 0.05, -0.08));  // where it was
    EXPECT_EQ(engine.insert(rocks), (std::vector<int>{3}));
}

// Up from 0.05 s to 0.15 s, and down again from 0.40 s to 0.50 s at a fifth of the speed, which the rock follows without a jump.
TEST(Walls, a_wall_that_travels_twice_comes_to_the_sum_of_its_ways) {
    Lift lift;
    lift.settings.walls[0].travels.push_back({Vec3(0, 0, -0.2 * Lift::speed), 0.40, 0.50});
    LiggghtsEngine engine(lift.settings, no_zones(), MPI_COMM_WORLD);
    ASSERT_EQ(engine.insert(one_rock(Vec3(0, 0, 0.01))).size(), 1u);
    EXPECT_EQ(engine.walls_change_until(), 0.50);
    const double rest = Lift::follow(engine, 0.0, 0.05);
    EXPECT_NEAR(Lift::follow(engine, 0.05, 0.40) - rest, 0.04, 1e-6) << "it has stood since 0.15 s";
    Lift::follow(engine, 0.40, 0.47);
    EXPECT_NEAR(engine.rocks().velocity[0].z(), -0.2 * Lift::speed, 0.01 * Lift::speed) << "contacts feel the second velocity";
    EXPECT_NEAR(Lift::follow(engine, 0.47, 1.0) - rest, 0.04 - 0.008, 1e-7);
    EXPECT_NEAR(engine.rocks().velocity[0].norm(), 0.0, 1e-3);
}

/// A rock at rest on a plate whose surface runs along x, like a belt; it slides, with the pair's friction, until it has the belt's speed.
TEST(Walls, a_belt_drags_rock_along_and_its_end_face_pushes_none) {
    constexpr double speed = 0.2, friction = 0.4;
    Lift lift;
    lift.settings.walls[0].travels = {};
    lift.settings.walls[0].surface_velocity = Vec3(speed, 0.0, 0.0);
    lift.settings.contact.rock_steel.friction = friction;
    lift.settings.contact.rock_steel.rolling_friction = 10.0;  // it does not roll
    LiggghtsEngine engine(lift.settings, no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 1, Vec3(-0.05, 0.0, 0.01));
    add_rock(rocks, 2, Vec3(0.1101, 0.0, -0.05));  // beside the end face, through which the belt runs out
    rocks.velocity.back() = Vec3(-0.01, 0.0, 0.0);
    ASSERT_EQ(engine.insert(rocks).size(), 2u);
    // Added mass takes part, buoyancy lightens: a = mu (rho_s - rho_f) g / (rho_s + rho_f/2).
    const double acceleration = friction * (k_rock_density - k_water_density) * 9.81 / (k_rock_density + 0.5 * k_water_density);
    for (int call = 0; call < 20; ++call) engine.advance(1e-3, no_force);
    EXPECT_NEAR(engine.rocks().velocity[0].x(), 0.02 * acceleration, 0.02 * 0.02 * acceleration);
    for (int call = 0; call < 180; ++call) engine.advance(1e-3, no_force);
    EXPECT_NEAR(engine.rocks().velocity[0].x(), speed, 0.01 * speed);
    // It came at 10 mm/s and went: a face that moved would have thrown it at the belt's speed or more.
    EXPECT_GT(engine.rocks().velocity[1].x(), 0.0);
    EXPECT_LT(engine.rocks().velocity[1].x(), 0.01) << "the face stands still";
}

TEST(Walls, a_wall_that_travels_goes_on_after_a_checkpoint_where_it_stands) {
    Lift lift;
    for (const double stop : {0.03, 0.10, 0.18}) {
        LiggghtsEngine through(lift.settings, no_zones(), MPI_COMM_WORLD);
        through.insert(one_rock(Vec3(0, 0, 0.01)));
        Lift::follow(through, 0.0, stop);
        through.write_checkpoint(lift.folder);
        LiggghtsEngine resumed(lift.settings, no_zones(), MPI_COMM_WORLD);
        resumed.read_checkpoint(lift.folder);
        EXPECT_NEAR(Lift::follow(resumed, stop, 0.3), Lift::follow(through, stop, 0.3), 1e-12) << stop;
    }
}

TEST(Walls, contacts_and_overlap_are_reported) {
    coupling::DemSettings settings = still_water();
    settings.domain.lower.z() = 0.0;
    settings.domain.make_wall(coupling::DomainSide::z_min);
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 1, Vec3(0, 0, 0.0101));
    add_rock(rocks, 2, Vec3(0.001, 0, 0.0303));
    engine.insert(rocks);
    const auto drag = [](std::size_t, const Vec3& velocity) { return Vec3(-2.0 * velocity); };
    coupling::DemStep step;
    for (int call = 0; call < 50; ++call) step = engine.advance(2e-3, drag);
    EXPECT_EQ(step.contacts, 2);
    EXPECT_GT(step.max_overlap_ratio, 0.0);
    EXPECT_LT(step.max_overlap_ratio, 0.005);
}

// A rock that bounces within one call; Hertz' largest overlap of an impact without damping.
TEST(Walls, overlap_of_a_blow_within_a_call_is_seen) {
    coupling::DemSettings settings = still_water();
    settings.gravity.setZero();
    settings.contact.wet_restitution = false;
    settings.contact.set_every_pair({0.0, 1.0, 0.0});
    settings.domain.lower.z() = 0.0;
    settings.domain.make_wall(coupling::DomainSide::z_min);
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0, 0, 0.02), Vec3(0, 0, -1.0), 0.02));
    const coupling::DemStep step = engine.advance(0.03, no_force);
    EXPECT_EQ(step.contacts, 0);
    EXPECT_NEAR(engine.rocks().velocity[0].z(), 1.0, 0.01);

    const auto square = [](double value) { return value * value; };
    const physics::Impact impact{
        sphere_volume(0.02) * (k_rock_density + 0.5 * k_water_density), 0.01,
        settings.contact.youngs_modulus / (2.0 - square(settings.contact.poisson_rock) - square(settings.contact.poisson_steel)), 1.0};
    const double overlap = physics::hertz_largest_overlap(impact) / 0.01;
    EXPECT_NEAR(step.max_overlap_ratio, overlap, 0.02 * overlap);
}

TEST(Insertion, keeps_what_it_is_given_to_the_bit) {
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 12, Vec3(0.1 / 3.0, -0.2 / 7.0, 0.3 / 11.0), Vec3(1.0 / 3.0, 2.0 / 7.0, -0.1), 0.017, 2345.6);
    add_rock(rocks, 40, Vec3(-0.1, 0.2, 0.3), Vec3::Zero(), 0.023, 2700.1);
    rocks.angular_velocity[1] = Vec3(1.0 / 3.0, -2.0, 0.7);
    EXPECT_EQ(engine.insert(rocks), (std::vector<int>{12, 40}));
    EXPECT_EQ(engine.rocks().id, rocks.id);
    EXPECT_EQ(engine.rocks().position, rocks.position);
    EXPECT_EQ(engine.rocks().velocity, rocks.velocity);
    EXPECT_EQ(engine.rocks().angular_velocity, rocks.angular_velocity);
    EXPECT_EQ(engine.rocks().diameter, rocks.diameter);
    EXPECT_EQ(engine.rocks().density, rocks.density);
    EXPECT_THROW(engine.insert(rocks), std::invalid_argument);
}

TEST(Insertion, refuses_overlaps_with_rocks_planes_and_the_outside) {
    coupling::DemSettings settings = still_water();
    settings.domain.make_wall(coupling::DomainSide::z_min);
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 1, Vec3(0, 0, 0));
    add_rock(rocks, 2, Vec3(0.0199, 0, 0));     // overlaps 1
    add_rock(rocks, 3, Vec3(0, 0.0201, 0));     // clear of 1
    add_rock(rocks, 4, Vec3(0.1, 0, -0.4901));  // overlaps the plane
    add_rock(rocks, 5, Vec3(0.1, 0, -0.4899));  // clear of it
    add_rock(rocks, 6, Vec3(0.51, 0, 0));       // outside
    add_rock(rocks, 7, Vec3(0.2, 0, 0.495));    // at the open end: inside
    EXPECT_EQ(engine.insert(rocks), (std::vector<int>{1, 3, 5, 7}));
    coupling::Rocks more;
    add_rock(more, 8, Vec3(0, 0, 0.0199));  // overlaps 1 of before
    EXPECT_TRUE(engine.insert(more).empty());
}

TEST(Insertion, refuses_steel_where_it_stands_now_and_inside_it) {
    Paddle paddle(k_pi / 2.0 / 0.01);  // a quarter turn in 10 ms
    paddle.settings.walls.push_back(
        {"column", write_stl(scratch_folder() / "column.stl", block(Vec3(-0.4, -0.05, -0.3), Vec3(-0.3, 0.05, 0.3), 2)), false});
    paddle.settings.walls[0].file =
        write_stl(paddle.settings.walls[1].file.parent_path() / "paddle.stl", block(Vec3(0.05, -0.01, -0.05), Vec3(0.3, 0.01, 0.05), 3));
    // Open, and far from all rock but for the box around it.
    paddle.settings.walls.push_back({"strip",
                                     write_stl(paddle.settings.walls[1].file.parent_path() / "strip.stl",
                                               {Triangle{Vec3(-0.6, -0.3, -0.5), Vec3(-0.5, -0.3, -0.5), Vec3(-0.5, -0.2, -0.5)},
                                                Triangle{Vec3(-0.2, 0.3, 0.5), Vec3(-0.1, 0.3, 0.5), Vec3(-0.1, 0.4, 0.5)}}),
                                     false});
    LiggghtsEngine engine(paddle.settings, {paddle.rotor}, MPI_COMM_WORLD);
    engine.advance(0.01, no_force);
    EXPECT_NEAR(engine.zone_angles().at(0), k_pi / 2.0, 1e-12);
    coupling::Rocks rocks;
    add_rock(rocks, 1, Vec3(0.2, 0, 0));         // where the paddle stood
    add_rock(rocks, 2, Vec3(0.0199, 0.2, 0));    // touches it where it stands now
    add_rock(rocks, 3, Vec3(-0.0201, 0.2, 0));   // beside it
    add_rock(rocks, 4, Vec3(-0.35, 0, 0.1));     // deep inside the column: no face within reach
    add_rock(rocks, 5, Vec3(-0.2899, 0.03, 0));  // beside the column
    add_rock(rocks, 6, Vec3(0, 0.3101, 0));      // beyond its tip
    EXPECT_EQ(engine.insert(rocks), (std::vector<int>{1, 3, 5, 6}));
}

// Rock that comes between rocks in contact must not change their forces: the heap's energy goes on falling.
TEST(Insertion, leaves_the_contacts_of_others_alone) {
    coupling::DemSettings settings = still_water();
    settings.domain.lower.z() = 0.0;
    settings.domain.make_wall(coupling::DomainSide::z_min);
    const auto run = [&](bool with_insertions) {
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        coupling::Rocks rocks;
        for (int k = 0; k < 8; ++k) add_rock(rocks, k + 1, Vec3(0.003 * (k % 2), 0.002 * (k % 3), 0.0105 + 0.0205 * k));
        EXPECT_EQ(engine.insert(rocks).size(), 8u);
        for (int call = 0; call < 60; ++call) {
            if (with_insertions && call % 7 == 3) {
                coupling::Rocks extra;
                add_rock(extra, 100 + call, Vec3(-0.4 + 0.012 * call, -0.25, 0.3));
                EXPECT_EQ(engine.insert(extra).size(), 1u);
            }
            engine.advance(1e-3, no_force);
        }
        return engine.rocks();
    };
    const coupling::Rocks undisturbed = run(false);
    const coupling::Rocks disturbed = run(true);
    for (std::size_t k = 0; k < 8; ++k) {
        ASSERT_EQ(undisturbed.id[k], disturbed.id[k]);
        EXPECT_NEAR((undisturbed.position[k] - disturbed.position[k]).norm(), 0.0, 1e-12);
    }
}

TEST(Removal, takes_rocks_out_and_keeps_the_contacts_of_the_rest) {
    coupling::DemSettings settings = still_water();
    settings.domain.lower.z() = 0.0;
    settings.domain.make_wall(coupling::DomainSide::z_min);
    const auto run = [&](bool with_removal) {
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        coupling::Rocks rocks;
        for (int k = 0; k < 6; ++k) add_rock(rocks, k + 10, Vec3(0.003 * (k % 2), 0.002 * (k % 3), 0.0105 + 0.0205 * k));
        add_rock(rocks, 1, Vec3(0.3, 0.2, 0.3));
        add_rock(rocks, 20, Vec3(-0.3, 0.2, 0.3));
        engine.insert(rocks);
        for (int call = 0; call < 60; ++call) {
            if (with_removal && call == 20) {
                engine.remove(std::vector<int>{20});
                coupling::Rocks passing;
                add_rock(passing, 33, Vec3(0.3, -0.3, 0.3));
                engine.insert(passing);
                engine.remove(std::vector<int>{1, 33});
            }
            engine.advance(1e-3, no_force);
        }
        return engine.rocks();
    };
    const coupling::Rocks all = run(false);
    const coupling::Rocks rest = run(true);
    ASSERT_EQ(rest.id, (std::vector<int>{10, 11, 12, 13, 14, 15}));
    for (std::size_t k = 0; k < rest.size(); ++k) {
        const auto same = std::find(all.id.begin(), all.id.end(), rest.id[k]) - all.id.begin();
        EXPECT_NEAR((rest.position[k] - all.position[same]).norm(), 0.0, 1e-12);
    }
}

// A rock flies at each side of a box in turn. Walls throw it back with the restitution; it leaves through the open one.
TEST(Walls, any_side_of_a_box_can_be_a_wall) {
    coupling::DemSettings settings = still_water();
    settings.domain = {};
    settings.domain.lower = Vec3(-0.10, -0.15, -0.20);
    settings.domain.upper = Vec3(0.25, 0.30, 0.35);
    settings.domain.side_is_wall = {true, true, true, true, true, false};
    settings.fluid.density = 0.0;
    settings.gravity = Vec3::Zero();
    settings.added_mass = 0.0;
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel.restitution = 0.8;
    const Vec3 middle(0.05, 0.05, 0.05);
    for (std::size_t side = 0; side < coupling::k_domain_sides.size(); ++side) {
        const auto axis = static_cast<Eigen::Index>(side / 2);
        const double outward = side % 2 == 0 ? -1.0 : 1.0;
        const double position = settings.domain.position_of(side);
        Vec3 start = middle;
        start[axis] = position - outward * 0.015;
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        ASSERT_EQ(engine.insert(one_rock(start, outward * Vec3::Unit(axis))).size(), 1u);
        std::size_t left = 0;
        for (int step = 0; step < 30; ++step) left += engine.advance(1e-3, no_force).left.size();
        if (settings.domain.side_is_wall[side]) {
            ASSERT_EQ(engine.rocks().size(), 1u) << coupling::k_domain_sides[side];
            EXPECT_NEAR((engine.rocks().velocity[0] + 0.8 * outward * Vec3::Unit(axis)).norm(), 0.0, 2e-3)
                << coupling::k_domain_sides[side];
        } else {
            EXPECT_EQ(left, 1u) << coupling::k_domain_sides[side];
        }
        Vec3 inside_wall = middle;
        inside_wall[axis] = position - outward * 0.005;
        coupling::Rocks another;
        add_rock(another, 2, inside_wall);
        EXPECT_EQ(engine.insert(another).size(), settings.domain.side_is_wall[side] ? 0u : 1u);
    }
}

// A rock slides along a side with friction and along one without, of a material of its own.
TEST(Walls, a_frictionless_side_takes_no_speed_along_it) {
    coupling::DemSettings settings = still_water();
    settings.domain = {};
    settings.domain.lower = Vec3(-0.5, -0.5, 0.0);
    settings.domain.upper = Vec3(0.5, 0.5, 1.0);
    settings.domain.make_wall(coupling::DomainSide::z_min);
    settings.domain.material = "glass";
    settings.contact.rock_on_others["glass"] = {0.2, 0.5, 0.1};
    settings.fluid = {0.0, 0.0};
    settings.added_mass = 0.0;
    settings.contact.wet_restitution = false;
    const auto after = [&] {
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        engine.insert(one_rock(Vec3(0, 0, 0.01), Vec3(1.0, 0, 0)));
        for (int call = 0; call < 50; ++call) engine.advance(1e-3, no_force);
        return std::pair(engine.rocks().velocity[0], engine.rocks().angular_velocity[0]);
    };
    const auto [rough, rough_spin] = after();
    EXPECT_NEAR(rough.x(), 1.0 - 0.2 * 9.81 * 0.05, 2e-3);
    EXPECT_GT(rough_spin.norm(), 1.0);
    settings.domain.side_is_frictionless[static_cast<std::size_t>(coupling::DomainSide::z_min)] = true;
    const auto [smooth, smooth_spin] = after();
    EXPECT_EQ(smooth.x(), 1.0);
    EXPECT_EQ(smooth_spin, Vec3(Vec3::Zero()));
}

// A rock rests on a plate that is taken out at 0.1 s, in the middle of a call, and falls freely from then on; nothing else is in its way.
TEST(Walls, a_wall_that_was_removed_exerts_nothing) {
    coupling::DemSettings settings = still_water();
    settings.fluid = {0.0, 0.0};
    settings.added_mass = 0.0;
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel.restitution = 0.3;
    settings.walls = {
        {"gate", write_stl(scratch_folder() / "gate.stl", sheet(Vec3(-0.2, -0.2, 0), Vec3(0.4, 0, 0), Vec3(0, 0.4, 0), 4, 4))}};
    settings.walls[0].removed_at = 0.1;
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0.01, 0, 0.01)));
    coupling::Rocks in_the_gate;
    add_rock(in_the_gate, 2, Vec3(0.1, 0, 0.005));
    EXPECT_FALSE(engine.room_for(in_the_gate)[0]);
    for (int call = 0; call < 3; ++call) engine.advance(0.03, no_force);
    const Vec3 rest = engine.rocks().position[0];
    EXPECT_NEAR(rest.z(), 0.01, 1e-5);
    engine.advance(0.03, no_force);
    EXPECT_NEAR(engine.rocks().velocity[0].z(), -9.81 * 0.02, 1e-3);
    engine.advance(0.08, no_force);
    EXPECT_NEAR(rest.z() - engine.rocks().position[0].z(), 0.5 * 9.81 * 0.1 * 0.1, 2e-4);
    EXPECT_TRUE(engine.room_for(in_the_gate)[0]);
}

TEST(Settings, every_mistake_is_named) {
    coupling::DemSettings settings = still_water();
    settings.contact.youngs_modulus = 0.0;
    settings.contact.rock_steel.restitution = 1.2;
    settings.domain.radius = -1.0;
    settings.domain.make_wall(coupling::DomainSide::x_max);
    try {
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        FAIL() << "wrong settings were taken";
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 4u);
        EXPECT_NE(std::string(error.what()).find("youngsModulus = 0"), std::string::npos);
    }
}

// Before anything is worked out from it.
TEST(Settings, a_restitution_that_no_damping_gives_is_refused) {
    for (const double restitution : {-1.0, 0.0, 0.13}) {
        coupling::DemSettings settings = still_water();
        settings.contact.rock_steel.restitution = restitution;
        EXPECT_THROW(LiggghtsEngine(settings, no_zones(), MPI_COMM_WORLD), UserError) << restitution;
    }
}

TEST(Settings, a_wall_without_its_file_is_refused) {
    coupling::DemSettings settings = still_water();
    settings.walls = {{"cutter", "no/such/file.stl", true}};
    EXPECT_THROW(LiggghtsEngine(settings, no_zones(), MPI_COMM_WORLD), UserError);
}

}  // namespace cutterflow::liggghts::tests
