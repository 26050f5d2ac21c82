#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "solver/liggghts/tests/engine_fixture.hpp"

namespace cutterflow::liggghts::tests {

namespace {

constexpr double k_diameter = 0.02;

/// Of a rock, with its added mass [kg].
double moved_mass() {
    return (k_rock_density + 0.5 * k_water_density) * volume(k_diameter);
}

double total(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

std::size_t count_of_worked(const std::vector<double>& values) {
    return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double value) { return value != 0.0; }));
}

/// A block with 2 x 2 cells on its upper face, z = 0, without gravity and friction.
struct Anvil {
    std::filesystem::path folder = scratch_folder();
    coupling::DemSettings settings = still_water();

    Anvil() {
        settings.gravity.setZero();
        settings.contact.wet_restitution = false;
        settings.contact.rock_steel = {0.0, 0.6, 0.0};
        settings.walls = {{"anvil", write_stl(folder / "anvil.stl", block(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.0), 2)), false}};
    }
    coupling::WallWork after(const coupling::Rocks& rocks, double duration) const {
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        EXPECT_EQ(engine.insert(rocks).size(), rocks.size());
        for (double time = 0.0; time < duration; time += 1e-3) engine.advance(1e-3, no_force);
        return engine.wall_work().at(0);
    }
};

}  // namespace

// Rock, steel and water film share it in a way that nobody knows; so it does not depend on the restitution.
TEST(WallWork, of_an_impact_is_the_kinetic_energy_of_the_approach) {
    Anvil anvil;
    for (const double restitution : {0.2, 0.6, 0.97}) {
        anvil.settings.contact.rock_steel.restitution = restitution;
        for (const double speed : {0.2, 1.0, 4.0}) {
            for (const double gap : {1.0e-4, 1.3e-4, 1.6e-4}) {  // the touch falls on another part of a step
                const Vec3 above(0.03, 0.02, 0.5 * k_diameter + gap * speed);
                const coupling::WallWork work = anvil.after(one_rock(above, Vec3(0, 0, -speed)), 0.02);
                const double energy = 0.5 * moved_mass() * speed * speed;
                EXPECT_NEAR(total(work.impact), energy, 0.012 * energy) << restitution << ' ' << speed << ' ' << gap;
                EXPECT_EQ(total(work.sliding), 0.0);
                EXPECT_EQ(count_of_worked(work.impact), 1u);
            }
        }
    }
}

TEST(WallWork, lies_on_the_triangle_that_was_hit) {
    const coupling::WallWork work = Anvil().after(one_rock(Vec3(0.03, 0.06, 0.011), Vec3(0, 0, -1.0)), 0.02);
    EXPECT_EQ(work.wall, "anvil");
    ASSERT_EQ(work.impact.size(), work.triangles.size());
    for (std::size_t t = 0; t < work.triangles.size(); ++t) {
        const coupling::SteelTriangle& triangle = work.triangles[t];
        const Vec3 nearest = nearest_point({triangle.a, triangle.b, triangle.c}, Vec3(0.03, 0.06, 0.0));
        EXPECT_EQ(work.impact[t] > 0.0, (nearest - Vec3(0.03, 0.06, 0.0)).norm() < 1e-9) << t;
    }
}

// In the middle of the face six triangles meet, on its edge three or more.
TEST(WallWork, of_a_hit_where_triangles_meet_counts_once) {
    const double energy = 0.5 * moved_mass();
    for (const Vec3& place : {Vec3(0, 0, 0.011), Vec3(0.05, 0, 0.011), Vec3(0.02, 0.02, 0.011), Vec3(0.1, 0.0, 0.011)}) {
        const coupling::WallWork work = Anvil().after(one_rock(place, Vec3(0, 0, -1.0)), 0.02);
        EXPECT_NEAR(total(work.impact), energy, 0.015 * energy) << place.transpose();
    }
}

// Two faces that meet at 60 degrees take half of it each: the kinetic energies of the two approaches would add up to 3/2 of it.
TEST(WallWork, of_a_hit_on_two_faces_at_once_is_their_share_of_the_energy) {
    Anvil anvil;
    anvil.settings.contact.rock_steel.restitution = 0.97;
    const double half = k_pi / 6.0;  // between each face's normal and the vertical
    const Vec3 left(-std::cos(half), 0, std::sin(half)), right(std::cos(half), 0, std::sin(half));
    std::vector<Triangle> groove = sheet(Vec3(0, -0.1, 0), 0.2 * right, Vec3(0, 0.2, 0), 1, 1);
    for (const Triangle& triangle : sheet(Vec3(0, -0.1, 0), Vec3(0, 0.2, 0), 0.2 * left, 1, 1)) groove.push_back(triangle);
    anvil.settings.walls[0].file = write_stl(anvil.folder / "groove.stl", groove);
    const double height = 0.5 * k_diameter / std::cos(half);
    const coupling::WallWork work = anvil.after(one_rock(Vec3(0, 0.03, height + 2e-4), Vec3(0, 0, -1.0)), 0.02);
    const double energy = 0.5 * moved_mass();
    EXPECT_NEAR(total(work.impact), energy, 0.02 * energy);
    EXPECT_NEAR(work.impact[0] + work.impact[1], 0.5 * energy, 0.01 * energy);
}

TEST(WallWork, of_a_wall_that_comes_is_that_of_a_rock_that_comes) {
    Anvil anvil;
    anvil.settings.walls[0].travels = {{Vec3(0, 0, 1.5), 0.0, 0.01}};
    const coupling::WallWork work = anvil.after(one_rock(Vec3(0.03, 0.02, 0.0101)), 0.008);
    const double energy = 0.5 * moved_mass() * 1.5 * 1.5;
    EXPECT_NEAR(total(work.impact), energy, 0.015 * energy);
}

TEST(WallWork, of_a_turning_wall_follows_its_triangles) {
    Anvil anvil;
    anvil.settings.walls = {
        {"paddle", write_stl(anvil.folder / "paddle.stl", block(Vec3(0.05, -0.01, -0.05), Vec3(0.3, 0.01, 0.05), 5)), true}};
    coupling::ZoneMotion rotor;
    rotor.speed = 5.0;
    LiggghtsEngine engine(anvil.settings, {rotor}, MPI_COMM_WORLD);
    // 30 degrees ahead of the paddle's face, which comes to it at 5 rad/s times 0.2 m.
    const Vec3 on_face(0.2, 0.01, 0.02), ahead(0.0, 0.5 * k_diameter, 0.0);
    ASSERT_EQ(engine.insert(one_rock(rotate_about(rotor.axis, k_pi / 6.0, on_face + ahead))).size(), 1u);
    for (int call = 0; call < 150; ++call) engine.advance(1e-3, no_force);
    const coupling::WallWork work = engine.wall_work().at(0);
    const double energy = 0.5 * moved_mass();
    EXPECT_NEAR(total(work.impact), energy, 0.02 * energy);
    const auto hit = static_cast<std::size_t>(std::max_element(work.impact.begin(), work.impact.end()) - work.impact.begin());
    const coupling::SteelTriangle& triangle = work.triangles[hit];
    EXPECT_LT((nearest_point({triangle.a, triangle.b, triangle.c}, on_face) - on_face).norm(), 2e-3);
}

// Friction slows the rock down and sets it spinning, until it rolls: the impulse J with v - J/m = J R^2/I takes 1/2 v J.
TEST(WallWork, of_sliding_is_what_friction_takes_until_the_rock_rolls) {
    Anvil anvil;
    anvil.settings.gravity = Vec3(0, 0, -9.81);
    anvil.settings.contact.rock_steel = {0.4, 0.3, 0.0};
    constexpr double speed = 0.5;
    const double radius = 0.5 * k_diameter, inertia = 0.4 * k_rock_density * volume(k_diameter) * radius * radius;
    const double energy = 0.5 * speed * speed / (1.0 / moved_mass() + radius * radius / inertia);
    const coupling::WallWork work = anvil.after(one_rock(Vec3(-0.096, 0.013, radius), Vec3(speed, 0, 0)), 0.15);
    EXPECT_NEAR(total(work.sliding), energy, 0.01 * energy);
    EXPECT_GT(count_of_worked(work.sliding), 1u);
    EXPECT_LT(total(work.impact), 0.01 * energy);
}

TEST(WallWork, is_the_same_on_one_rank_and_on_all) {
    Anvil anvil;
    anvil.settings.contact.rock_steel.friction = 0.3;
    coupling::Rocks rocks;
    for (int k = 0; k < 12; ++k)
        add_rock(rocks, k + 1, Vec3(-0.09 + 0.03 * (k % 6), -0.04 + 0.08 * (k / 6), 0.0105 + 1e-4 * k), Vec3(0.3, -0.2, -1.0));
    const auto work_on = [&](MPI_Comm communicator) {
        LiggghtsEngine engine(anvil.settings, no_zones(), communicator);
        EXPECT_EQ(engine.insert(rocks).size(), rocks.size());
        for (int call = 0; call < 10; ++call) engine.advance(1e-3, no_force);
        return engine.wall_work().at(0);
    };
    const coupling::WallWork alone = work_on(MPI_COMM_SELF), all = work_on(MPI_COMM_WORLD);
    EXPECT_GT(count_of_worked(alone.impact), 3u);
    for (std::size_t t = 0; t < alone.impact.size(); ++t) {
        EXPECT_NEAR(all.impact[t], alone.impact[t], 1e-12) << t;
        EXPECT_NEAR(all.sliding[t], alone.sliding[t], 1e-12) << t;
    }
}

TEST(WallWork, is_not_told_of_soil_and_sides) {
    Anvil anvil;
    anvil.settings.domain.make_wall(coupling::DomainSide::z_min);
    anvil.settings.walls.insert(anvil.settings.walls.begin(), anvil.settings.walls[0]);
    anvil.settings.walls[0].name = "bank";
    anvil.settings.walls[0].material = coupling::k_soil;
    const coupling::WallWork work = anvil.after(one_rock(Vec3(0.3, 0.0, -0.489), Vec3(0, 0, -0.5)), 0.01);
    EXPECT_EQ(work.wall, "anvil");
    EXPECT_EQ(total(work.impact), 0.0);
}

TEST(WallWork, goes_on_from_a_checkpoint) {
    Anvil anvil;
    anvil.settings.contact.rock_steel.friction = 0.3;
    const coupling::Rocks rocks = one_rock(Vec3(0.03, 0.02, 0.0102), Vec3(0.3, 0, -1.0));
    const coupling::WallWork through = anvil.after(rocks, 0.01);
    LiggghtsEngine first(anvil.settings, no_zones(), MPI_COMM_WORLD);
    first.insert(rocks);
    first.advance(1e-3, no_force);  // ends within the impact
    ASSERT_GT(total(first.wall_work().at(0).impact), 0.0);
    first.write_checkpoint(anvil.folder);
    LiggghtsEngine second(anvil.settings, no_zones(), MPI_COMM_WORLD);
    second.read_checkpoint(anvil.folder);
    EXPECT_EQ(second.wall_work().at(0).impact, first.wall_work().at(0).impact);
    for (int call = 1; call < 10; ++call) second.advance(1e-3, no_force);
    const coupling::WallWork resumed = second.wall_work().at(0);
    EXPECT_EQ(resumed.since, 0.0);
    for (std::size_t t = 0; t < through.impact.size(); ++t) {
        EXPECT_NEAR(resumed.impact[t], through.impact[t], 1e-12);
        EXPECT_NEAR(resumed.sliding[t], through.sliding[t], 1e-12);
    }
}

TEST(WallWork, counts_from_a_checkpoint_that_has_none) {
    const Anvil anvil;
    LiggghtsEngine first(anvil.settings, no_zones(), MPI_COMM_WORLD);
    first.insert(one_rock(Vec3(0.03, 0.02, 0.0102), Vec3(0, 0, -1.0)));
    for (int call = 0; call < 5; ++call) first.advance(1e-3, no_force);
    first.write_checkpoint(anvil.folder);
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank() == 0) std::filesystem::remove(anvil.folder / "wall_work.json");
    MPI_Barrier(MPI_COMM_WORLD);
    LiggghtsEngine second(anvil.settings, no_zones(), MPI_COMM_WORLD);
    second.read_checkpoint(anvil.folder);
    EXPECT_EQ(total(second.wall_work().at(0).impact), 0.0);
    EXPECT_NEAR(second.wall_work().at(0).since, 5e-3, 1e-12);
}

}  // namespace cutterflow::liggghts::tests
