// Frozen rock, forces on walls, and rock that is taken over from another run's checkpoint.
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "solver/liggghts/tests/engine_fixture.hpp"

namespace cutterflow::liggghts::tests {

namespace {

/// Without water, in a box with a floor.
coupling::DemSettings dry_box() {
    coupling::DemSettings settings = still_water();
    settings.domain = {};
    settings.domain.lower = Vec3(-0.2, -0.2, 0.0);
    settings.domain.upper = Vec3(0.2, 0.2, 0.4);
    settings.domain.make_wall(coupling::DomainSide::z_min);
    settings.fluid = {0.0, 0.0};
    settings.added_mass = 0.0;
    settings.contact.wet_restitution = false;
    return settings;
}

Vec3 force_on(const coupling::DemStep& step, const std::string& wall) {
    for (const coupling::WallForce& force : step.wall_force)
        if (force.wall == wall) return force.force;
    ADD_FAILURE() << "no wall " << wall;
    return Vec3::Zero();
}

}  // namespace

// A rock hits a frozen one head on: it comes back with the restitution, as from a wall, and the frozen one has not moved by a bit.
TEST(Frozen, rock_is_hit_like_a_wall_and_stays) {
    for (const double restitution : {0.4, 0.9}) {
        coupling::DemSettings settings = dry_box();
        settings.gravity.setZero();
        settings.contact.rock_rock.restitution = restitution;
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        coupling::Rocks rocks;
        add_rock(rocks, 1, Vec3(0.0123, 0.001, 0.1));
        add_rock(rocks, 2, Vec3(0.0123, 0.001, 0.1205), Vec3(0, 0, -0.5));
        ASSERT_EQ(engine.insert(rocks).size(), 2u);
        engine.freeze(std::vector<int>{1});
        EXPECT_EQ(engine.frozen(), std::vector<int>{1});
        for (int call = 0; call < 30; ++call) engine.advance(1e-4, no_force);
        EXPECT_NEAR(engine.rocks().velocity[1].z(), restitution * 0.5, 0.01 * 0.5);
        EXPECT_EQ(engine.rocks().position[0], rocks.position[0]);
        EXPECT_EQ(engine.rocks().velocity[0], Vec3(Vec3::Zero()));
        EXPECT_EQ(engine.rocks().angular_velocity[0], Vec3(Vec3::Zero()));
        EXPECT_EQ(engine.rocks().density[0], k_rock_density);
    }
}

// The fluid's force counts in full, and what holds the rock takes it up with the weight.
TEST(Frozen, rock_is_dragged_and_held) {
    coupling::DemSettings settings = still_water();
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0.1, 0, 0), Vec3(0.3, 0, 0)));
    engine.freeze(std::vector<int>{1});
    const Vec3 drag(0.02, -0.01, 0.003);
    std::vector<Vec3> seen;
    const coupling::DemStep step = engine.advance(0.01, [&](std::size_t, const Vec3& velocity) {
        seen.push_back(velocity);
        return drag;
    });
    for (const Vec3& velocity : seen) EXPECT_EQ(velocity, Vec3(Vec3::Zero()));
    const Vec3 weight = (k_rock_density - k_water_density) * volume(0.02) * settings.gravity;
    EXPECT_NEAR((step.impulse[0] - 0.01 * drag).norm(), 0.0, 1e-12);
    EXPECT_NEAR((step.contact_impulse[0] + 0.01 * (drag + weight)).norm(), 0.0, 1e-10);
    engine.thaw(std::vector<int>{1});
    EXPECT_TRUE(engine.frozen().empty());
    engine.advance(0.01, no_force);
    EXPECT_LT(engine.rocks().velocity[0].z(), -0.01);
}

// Three rocks in a pile that touch each other: what is frozen is no contact any more, and comes back with the thaw.
TEST(Frozen, rocks_have_no_contact_with_each_other) {
    coupling::DemSettings settings = dry_box();
    settings.contact.rock_rock.restitution = settings.contact.rock_steel.restitution = 0.3;
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    for (const int k : {0, 1, 2}) add_rock(rocks, k + 1, Vec3(0.01, 0, 0.01 + 1e-6 + 0.020001 * k));
    ASSERT_EQ(engine.insert(rocks).size(), 3u);
    EXPECT_EQ(engine.advance(0.1, no_force).contacts, 3);  // one of them with the floor
    engine.freeze(std::vector<int>{1, 2});
    const coupling::DemStep held = engine.advance(0.01, no_force);
    EXPECT_EQ(held.contacts, 2) << "rock 3 on 2, and 1 on the floor";
    const double weight = k_rock_density * volume(0.02) * 9.81;
    EXPECT_NEAR(engine.rocks().velocity[2].norm(), 0.0, 1e-4);
    EXPECT_NEAR(held.contact_impulse[2].z() / 0.01, weight, 0.02 * weight);
    engine.thaw(std::vector<int>{1, 2});
    EXPECT_EQ(engine.advance(0.05, no_force).contacts, 3);
    EXPECT_NEAR(engine.rocks().position[2].z(), 0.05, 1e-4);
    engine.freeze(std::vector<int>{1});
    engine.remove(std::vector<int>{1});
    EXPECT_TRUE(engine.frozen().empty());
}

TEST(WallForces, are_the_weight_that_rests_on_them) {
    coupling::DemSettings settings = dry_box();
    settings.contact.rock_steel.restitution = 0.3;
    settings.walls = {
        {"shelf", write_stl(scratch_folder() / "shelf.stl", sheet(Vec3(0.05, -0.1, 0.1), Vec3(0.1, 0, 0), Vec3(0, 0.2, 0), 3, 3))}};
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rocks;
    add_rock(rocks, 1, Vec3(-0.1, 0, 0.010001));
    add_rock(rocks, 2, Vec3(0.1, 0.001, 0.110001), Vec3::Zero(), 0.02, 5000.0);
    ASSERT_EQ(engine.insert(rocks).size(), 2u);
    engine.advance(0.3, no_force);
    const coupling::DemStep rest = engine.advance(0.01, no_force);
    EXPECT_NEAR(force_on(rest, "zMin").z(), -k_rock_density * volume(0.02) * 9.81, 1e-6);
    EXPECT_NEAR(force_on(rest, "shelf").z(), -5000.0 * volume(0.02) * 9.81, 1e-6);
}

/// Frozen rocks, rocks that roll and touch each other, a floor, sides, a shelf and a post.
struct BusyBox {
    coupling::DemSettings settings = dry_box();
    std::filesystem::path folder = scratch_folder();

    BusyBox() {
        settings.domain.side_is_wall = {true, true, true, true, true, false};
        settings.contact.rock_rock = {0.4, 0.5, 0.1};
        settings.contact.rock_steel = {0.3, 0.5, 0.05};
        settings.contact.rock_on_others["perspex"] = {0.2, 0.6, 0.05};
        settings.walls = {
            {"shelf", write_stl(folder / "shelf.stl", sheet(Vec3(-0.15, -0.1, 0.03), Vec3(0.1, 0, 0.01), Vec3(0, 0.2, 0), 3, 3))},
            {"post", write_stl(folder / "post.stl", block(Vec3(0.0, -0.08, 0.001), Vec3(0.08, 0.08, 0.05), 2))}};
        settings.walls[1].material = "perspex";
    }
    void fill(LiggghtsEngine& engine) const {
        coupling::Rocks rocks;
        for (int k = 0; k < 60; ++k)
            add_rock(rocks, k + 1, Vec3(-0.17 + 0.032 * (k % 10), -0.05 + 0.031 * (k / 10 % 3), 0.09 + 0.03 * (k / 30)),
                     0.3 * Vec3(std::sin(k), std::cos(k), -1.0));
        ASSERT_EQ(engine.insert(rocks).size(), 60u);
        engine.advance(0.3, no_force);
        engine.freeze(std::vector<int>{7, 31});
    }
};

void expect_same(const LiggghtsEngine& a, const LiggghtsEngine& b) {
    ASSERT_EQ(a.rocks().id, b.rocks().id);
    EXPECT_EQ(a.frozen(), b.frozen());
    for (std::size_t p = 0; p < a.rocks().size(); ++p) {
        EXPECT_NEAR((a.rocks().position[p] - b.rocks().position[p]).norm(), 0.0, 1e-12);
        EXPECT_NEAR((a.rocks().velocity[p] - b.rocks().velocity[p]).norm(), 0.0, 1e-12);
        EXPECT_NEAR(0.01 * (a.rocks().angular_velocity[p] - b.rocks().angular_velocity[p]).norm(), 0.0, 1e-12);
    }
}

// Goes on as if it had never stopped, from time 0 again, also where the walls stand in another order and a new one is there.
TEST(Start, from_another_run_goes_on_as_without_a_stop) {
    const BusyBox box;
    LiggghtsEngine through(box.settings, no_zones(), MPI_COMM_WORLD);
    box.fill(through);
    for (int call = 0; call < 20; ++call) through.advance(1e-3, no_force);
    through.write_checkpoint(box.folder);

    coupling::DemSettings other = box.settings;
    std::swap(other.walls[0], other.walls[1]);
    other.walls.push_back(
        {"lid", write_stl(box.folder / "lid.stl", sheet(Vec3(-0.2, -0.2, 0.39), Vec3(0.4, 0, 0), Vec3(0, 0.4, 0), 1, 1))});
    other.walls.back().travels = {{Vec3(0, 0, 0.001), 0.1, 0.2}};
    LiggghtsEngine again(other, no_zones(), MPI_COMM_WORLD);
    again.start_from(box.folder);
    EXPECT_EQ(again.frozen(), (std::vector<int>{7, 31}));
    EXPECT_EQ(again.walls_change_until(), 0.2);
    coupling::DemStep a, b;
    for (int call = 0; call < 20; ++call) {
        a = through.advance(1e-3, no_force);
        b = again.advance(1e-3, no_force);
        for (const char* wall : {"shelf", "post", "zMin", "xMax"})
            EXPECT_NEAR((force_on(a, wall) - force_on(b, wall)).norm(), 0.0, 1e-8) << wall << " in call " << call;
    }
    EXPECT_GT(a.contacts, 30);
    EXPECT_GT(force_on(a, "shelf").norm(), 0.1);
    EXPECT_GT(force_on(a, "post").norm(), 0.1);
    expect_same(through, again);
}

TEST(Start, is_refused_in_another_domain) {
    const BusyBox box;
    LiggghtsEngine engine(box.settings, no_zones(), MPI_COMM_WORLD);
    engine.write_checkpoint(box.folder);
    coupling::DemSettings larger = box.settings;
    larger.domain.upper.z() = 0.5;
    LiggghtsEngine other(larger, no_zones(), MPI_COMM_WORLD);
    EXPECT_THROW(other.start_from(box.folder), UserError);
}

}  // namespace cutterflow::liggghts::tests
