#include "solver/liggghts/tests/engine_fixture.hpp"

namespace cutterflow::liggghts::tests {

namespace {

constexpr double k_radius = 0.01;
constexpr double k_mass = k_rock_density * k_pi / 6.0 * 8.0 * k_radius * k_radius * k_radius;

/// No water; a wall that turns about z.
coupling::DemSettings dry(const std::vector<Triangle>& wall, double friction, double gravity) {
    coupling::DemSettings settings = still_water();
    settings.fluid.density = 0.0;
    settings.added_mass = 0.0;
    settings.gravity = Vec3(0, 0, -gravity);
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel.friction = friction;
    settings.contact.rock_steel.restitution = 0.3;
    settings.walls = {{"wall", write_stl(scratch_folder() / "wall.stl", wall), true}};
    return settings;
}

coupling::ZoneMotion turning(double speed) {
    coupling::ZoneMotion rotor;
    rotor.speed = speed;
    return rotor;
}

}  // namespace

// A sphere that rolls on a turntable runs in a circle, at 2/7 of the table's angular velocity: m dv/dt = F, 2/5 m R^2 domega/dt = -R n x F,
// v - R omega x n = Omega x r. The way crosses 25 mm seams of the table in all directions. Its only error is the overlap on the lever,
// 1e-4.
TEST(TurningWalls, a_turntable_leads_a_rolling_rock_in_its_circle) {
    const double speed = 8.0;
    const Vec3 spin(0, 0, speed);
    const auto settings = dry(sheet(Vec3(-0.25, -0.25, 0), Vec3(0.5, 0, 0), Vec3(0, 0.5, 0), 20, 20), 0.8, 9.81);
    LiggghtsEngine engine(settings, {turning(speed)}, MPI_COMM_WORLD);
    const Vec3 start(0.05, 0.02, k_radius + 1e-9), velocity(0.1, -0.15, 0);
    coupling::Rocks rock = one_rock(start, velocity, 2.0 * k_radius);
    rock.angular_velocity[0] = Vec3::UnitZ().cross(velocity - spin.cross(start)) / k_radius;
    ASSERT_EQ(engine.insert(rock).size(), 1u);
    const int calls = 800;
    const double rate = 2.0 / 7.0 * speed, call = 1e-3;
    double lowest = 1.0, highest = 0.0;
    for (int k = 1; k <= calls; ++k) {
        engine.advance(call, no_force);
        const Vec3 now = engine.rocks().position[0];
        const double angle = rate * k * call;
        const Vec3 way = (std::sin(angle) * velocity + (1.0 - std::cos(angle)) * Vec3::UnitZ().cross(velocity)) / rate;
        ASSERT_NEAR((now - start - way).head<2>().norm(), 0.0, 1e-3 * velocity.norm() / rate) << "at " << k * call << " s";
        if (k < 100) continue;  // the fall onto the table has died down
        lowest = std::min(lowest, now.z());
        highest = std::max(highest, now.z());
    }
    EXPECT_NEAR(engine.rocks().velocity[0].head<2>().norm(), velocity.norm(), 1e-3 * velocity.norm());
    RecordProperty("height_range_m", fmt::format("{:.3g}", highest - lowest));
    EXPECT_LT(highest - lowest, 1e-8) << "a seam lifts the rock";
}

// A wall that turns by itself is met as one that turns with a rotor, until it stops.
TEST(TurningWalls, a_wall_of_its_own_turns_as_the_rotor_and_stops) {
    const double speed = 8.0;
    const Vec3 centre(0.03, -0.02, 0.0);
    coupling::ZoneMotion rotor = turning(speed);
    rotor.axis.origin = centre;
    coupling::DemSettings of_rotor = dry(sheet(Vec3(-0.25, -0.25, 0), Vec3(0.5, 0, 0), Vec3(0, 0.5, 0), 20, 20), 0.8, 9.81);
    of_rotor.contact.rock_steel.rolling_friction = 0.2;
    coupling::DemSettings by_itself = of_rotor;
    by_itself.walls[0].rotating = false;
    by_itself.walls[0].turn = {{centre, Vec3::UnitZ()}, speed, 0.0, 0.2};
    LiggghtsEngine with_rotor(of_rotor, {rotor}, MPI_COMM_WORLD), alone(by_itself, no_zones(), MPI_COMM_WORLD);
    EXPECT_EQ(alone.walls_change_until(), 0.2);
    for (LiggghtsEngine* engine : {&with_rotor, &alone}) {
        ASSERT_EQ(engine->insert(one_rock(Vec3(0.05, 0.02, k_radius + 1e-9), Vec3::Zero(), 2.0 * k_radius)).size(), 1u);
        for (int call = 0; call < 100; ++call) engine->advance(2e-3, no_force);
    }
    EXPECT_EQ(with_rotor.rocks().position[0], alone.rocks().position[0]);
    EXPECT_EQ(with_rotor.rocks().angular_velocity[0], alone.rocks().angular_velocity[0]);
    EXPECT_GT(alone.rocks().velocity[0].norm(), 0.1);
    for (int call = 0; call < 400; ++call) alone.advance(2e-3, no_force);
    EXPECT_LT(alone.rocks().velocity[0].norm(), 1e-6) << "rolling friction of the table that stands";
}

// Without friction a radial blade pushes a rock outwards as x = x0 cosh(omega t); its torque pays for the rock's energy.
TEST(TurningWalls, a_blade_throws_a_rock_outwards_and_pays_for_it) {
    const double speed = 6.0, r0 = 0.08;
    const auto settings = dry(block(Vec3(0.02, -0.03, -0.05), Vec3(0.45, -k_radius, 0.05), 16), 0.0, 0.0);
    LiggghtsEngine engine(settings, {turning(speed)}, MPI_COMM_WORLD);
    // The centre runs in a plane through the axis.
    ASSERT_EQ(engine.insert(one_rock(Vec3(r0, 1e-9, 0.003), Vec3(0, speed * r0, 0), 2.0 * k_radius)).size(), 1u);
    const auto energy = [&] { return 0.5 * k_mass * engine.rocks().velocity[0].squaredNorm(); };
    const double at_start = energy(), call = 5e-4;
    double work = 0.0, time = 0.0;
    while (time < 0.35) {
        work -= engine.advance(call, no_force).cutter_torque * speed * call;
        time += call;
    }
    const Vec3 in_rotor = rotate_about(RotationAxis{}, -speed * time, engine.rocks().position[0]);
    EXPECT_NEAR(in_rotor.x(), r0 * std::cosh(speed * time), 1e-3 * in_rotor.x());
    EXPECT_NEAR(in_rotor.y(), 0.0, 5e-5);
    EXPECT_NEAR(in_rotor.z(), 0.003, 1e-12);
    EXPECT_NEAR(work, energy() - at_start, 2e-3 * work);
}

// Seen from the wall both are the same motion.
TEST(TurningWalls, the_same_rock_on_a_resting_wall_and_on_one_that_travels_with_it) {
    const auto fall = [](const Vec3& travel) {
        coupling::DemSettings settings = dry(block(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.0), 7), 0.3, 9.81);
        settings.walls[0].rotating = false;
        settings.walls[0].travels = {{travel, 0.0, 1.0}};
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        EXPECT_EQ(engine.insert(one_rock(Vec3(0.01, 0.02, k_radius + 1e-4), Vec3(0.3, -0.1, -0.5) + travel, 2.0 * k_radius)).size(), 1u);
        for (int k = 0; k < 60; ++k) engine.advance(1e-3, no_force);
        return Vec3(engine.rocks().position[0] - 0.06 * travel);
    };
    EXPECT_NEAR((fall(Vec3(0.7, 0.4, 0.2)) - fall(Vec3::Zero())).norm(), 0.0, 1e-9);
}

}  // namespace cutterflow::liggghts::tests
