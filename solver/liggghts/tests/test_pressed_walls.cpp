#include <cmath>

#include "solver/liggghts/contacts/contact_law.hpp"
#include "solver/liggghts/tests/engine_fixture.hpp"

namespace cutterflow::liggghts::tests {

namespace {

constexpr double k_radius = 0.01, k_gap = 0.004, k_force = 5.0, k_speed = 0.05;  // [m], [m], [N], [m/s]
constexpr double k_weight = 9.81 * k_rock_density * 4.0 / 3.0 * k_pi * k_radius * k_radius * k_radius;
constexpr double k_call = 1e-3;

/// No water; a plate and a table of 0.1 x 0.1 x 0.01 m, k_gap from a sphere between them, the plate above it or below.
coupling::DemSettings between_plates(bool plate_above) {
    coupling::DemSettings settings = still_water();
    settings.fluid.density = 0.0;
    settings.added_mass = 0.0;
    settings.contact.wet_restitution = false;
    settings.contact.youngs_modulus = 1e7;
    settings.contact.rock_steel.restitution = 0.3;
    const std::filesystem::path folder = scratch_folder();
    const auto slab = [&](const char* name, bool above, double gap) {
        const double z = above ? k_radius + gap : -k_radius - 0.01 - gap;
        return coupling::WallSettings{
            name, write_stl(folder / (std::string(name) + ".stl"), block(Vec3(-0.05, -0.05, z), Vec3(0.05, 0.05, z + 0.01), 3))};
    };
    settings.walls = {slab("plate", plate_above, plate_above ? k_gap : 0.0), slab("table", !plate_above, plate_above ? 0.0 : k_gap)};
    settings.walls[0].press = coupling::WallPress{plate_above ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitZ()), k_force, k_speed};
    return settings;
}

coupling::Rocks sphere() {
    return one_rock(Vec3(0.003, -0.002, 0.0), Vec3::Zero(), 2.0 * k_radius);
}

double force_on(const coupling::DemStep& step, const std::string& wall) {
    for (const coupling::WallForce& one : step.wall_force)
        if (one.wall == wall) return one.force.z();
    return NAN;
}

/// Hertz' overlap [m] of the sphere with steel.
double overlap(const coupling::DemSettings& settings, double force) {
    const ElasticPair pair = elastic_pair(settings.contact.youngs_modulus, settings.contact.poisson_rock, settings.contact.poisson_steel);
    return std::pow(force / (4.0 / 3.0 * pair.youngs * std::sqrt(k_radius)), 2.0 / 3.0);
}

coupling::DemStep advanced(LiggghtsEngine& engine, int calls) {
    coupling::DemStep last;
    for (int call = 0; call < calls; ++call) last = engine.advance(k_call, no_force);
    return last;
}

}  // namespace

// What holds the sphere up bears F and the weight when F comes from above, F less the weight when it comes from below and the table is a
// ceiling; the plate goes through the gap and both overlaps of Hertz.
TEST(PressedWalls, rock_comes_to_bear_the_force) {
    for (const bool above : {true, false}) {
        const coupling::DemSettings settings = between_plates(above);
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        ASSERT_EQ(engine.insert(sphere()).size(), 1u);
        EXPECT_TRUE(std::isinf(engine.walls_change_until()));
        const coupling::DemStep last = advanced(engine, 600);
        const double sign = above ? 1.0 : -1.0, on_table = above ? k_force + k_weight : k_force - k_weight;
        EXPECT_NEAR(force_on(last, "plate"), sign * k_force, 1e-6 * k_force);
        EXPECT_NEAR(force_on(last, "table"), -sign * on_table, 1e-6 * k_force);
        const double overlaps = overlap(settings, k_force) + overlap(settings, on_table);
        EXPECT_NEAR(-sign * last.wall_force[0].pressed.z() - k_gap, overlaps, 1e-4 * overlaps);
        EXPECT_EQ(last.wall_force[1].pressed, Vec3(Vec3::Zero()));
        EXPECT_EQ(engine.walls_change_until(), 0.0);
    }
}

TEST(PressedWalls, nothing_that_bears_it_is_no_rest) {
    coupling::DemSettings settings = between_plates(true);
    settings.walls[0].press->direction = Vec3::UnitZ();
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    ASSERT_EQ(engine.insert(sphere()).size(), 1u);
    const coupling::DemStep last = advanced(engine, 100);
    EXPECT_NEAR(last.wall_force[0].pressed.z(), 100 * k_call * k_speed, 1e-12);
    EXPECT_TRUE(std::isinf(engine.walls_change_until()));
}

// A resumed run goes on to the bit; a run that starts from the checkpoint has the wall where it was pressed to, and it stands.
TEST(PressedWalls, checkpoints_know_how_far_a_wall_was_pressed) {
    coupling::DemSettings settings = between_plates(true);
    const std::filesystem::path folder = settings.walls[0].file.parent_path() / "checkpoint";
    if (rank() == 0) std::filesystem::create_directories(folder);
    MPI_Barrier(MPI_COMM_WORLD);
    LiggghtsEngine whole(settings, no_zones(), MPI_COMM_WORLD);
    ASSERT_EQ(whole.insert(sphere()).size(), 1u);
    advanced(whole, 100);
    whole.write_checkpoint(folder);
    const coupling::DemStep at_end = advanced(whole, 30);

    LiggghtsEngine resumed(settings, no_zones(), MPI_COMM_WORLD);
    resumed.read_checkpoint(folder);
    EXPECT_EQ(advanced(resumed, 30).wall_force[0].pressed, at_end.wall_force[0].pressed);
    EXPECT_EQ(resumed.rocks().position[0], whole.rocks().position[0]);

    settings.walls[0].press.reset();
    LiggghtsEngine after(settings, no_zones(), MPI_COMM_WORLD);
    after.start_from(folder);
    EXPECT_EQ(after.walls_change_until(), 0.0);
    const Vec3 pressed = advanced(after, 1).wall_force[0].pressed;
    EXPECT_LT(pressed.z(), -0.9 * k_gap);
    const coupling::DemStep later = advanced(after, 300);
    EXPECT_EQ(later.wall_force[0].pressed, pressed);
    EXPECT_GT(force_on(later, "plate"), 0.5 * k_force);
}

// It turns about the axis that was pressed with it: a wall whose file stands there moves the rock alike.
TEST(PressedWalls, turns_as_a_wall_that_stands_where_it_was_pressed_to) {
    coupling::DemSettings settings = between_plates(true);
    const std::filesystem::path folder = settings.walls[0].file.parent_path() / "checkpoint";
    if (rank() == 0) std::filesystem::create_directories(folder);
    MPI_Barrier(MPI_COMM_WORLD);
    settings.gravity = Vec3::Zero();
    settings.contact.rock_steel.friction = 0.4;
    settings.walls.pop_back();
    settings.walls[0].press->direction = Vec3(0.6, 0.0, 0.8);  // away from the rock
    LiggghtsEngine before(settings, no_zones(), MPI_COMM_WORLD);
    ASSERT_EQ(before.insert(sphere()).size(), 1u);
    const Vec3 way = advanced(before, 200).wall_force[0].pressed;
    EXPECT_NEAR(way.norm(), 200 * k_call * k_speed, 1e-12);
    before.write_checkpoint(folder);

    settings.gravity = Vec3(0, 0, 9.81);  // the rock falls on the plate above it
    settings.walls[0].press.reset();
    settings.walls[0].turn = {{Vec3(0, 0, k_radius + k_gap), Vec3::UnitY()}, 2.0, 0.0, 1.0};
    coupling::DemSettings there = settings;
    const Vec3 low(-0.05, -0.05, k_radius + k_gap);
    there.walls[0].name = "there";
    there.walls[0].file =
        write_stl(settings.walls[0].file.parent_path() / "there.stl", block(low + way, low + way + Vec3(0.1, 0.1, 0.01), 3));
    there.walls[0].turn.axis.origin += way;
    LiggghtsEngine pressed(settings, no_zones(), MPI_COMM_WORLD), standing(there, no_zones(), MPI_COMM_WORLD);
    for (LiggghtsEngine* engine : {&pressed, &standing}) {
        engine->start_from(folder);
        advanced(*engine, 100);
    }
    EXPECT_NEAR((pressed.rocks().position[0] - standing.rocks().position[0]).norm(), 0.0, 1e-9);
    EXPECT_NEAR((pressed.rocks().velocity[0] - standing.rocks().velocity[0]).norm(), 0.0, 1e-7);
    EXPECT_GT(pressed.rocks().angular_velocity[0].norm(), 0.1) << "the plate took the rock along";
}

TEST(PressedWalls, refuses_all_mistakes_at_once) {
    coupling::DemSettings settings = between_plates(true);
    settings.walls[0].press = coupling::WallPress{Vec3(0, 0, 2), 0.0, -1.0};
    settings.walls[0].travels = {{Vec3::UnitZ(), 0.0, 1.0}};
    try {
        LiggghtsEngine(settings, no_zones(), MPI_COMM_WORLD);
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 4u) << error.what();
    }
}

}  // namespace cutterflow::liggghts::tests
