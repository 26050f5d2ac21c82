#include <cmath>

#include "geometry/base/sphere.hpp"
#include "solver/liggghts/tests/engine_fixture.hpp"

namespace cutterflow::liggghts::tests {

namespace {

/// Rough rocks that fall on a floor, on a turning paddle and on each other.
struct RoughHeap {
    std::filesystem::path folder = scratch_folder();
    coupling::DemSettings settings = still_water();
    coupling::ZoneMotion rotor;

    explicit RoughHeap(const std::string& law) {
        settings.contact.rock_rock = {0.5, 0.9, 0.3};
        settings.contact.rock_steel = {0.35, 0.9, 0.2};
        settings.contact.rolling_law = law;
        settings.domain.lower.z() = -0.1;
        settings.domain.make_wall(coupling::DomainSide::z_min);
        settings.walls = {{"paddle", write_stl(folder / "paddle.stl", block(Vec3(0.05, -0.01, -0.08), Vec3(0.3, 0.01, 0.05), 3)), true}};
        rotor.speed = 6.0;
    }
    coupling::Rocks rocks() const {
        coupling::Rocks heap;
        for (int k = 0; k < 60; ++k)
            add_rock(heap, k + 1, Vec3(-0.05 + 0.0205 * (k % 5), -0.04 + 0.0205 * (k / 5 % 4), -0.085 + 0.0205 * (k / 20)),
                     Vec3(0.1 * std::sin(k), 0.1 * std::cos(k), -0.2));
        add_rock(heap, 100, Vec3(0.15, 0.05, -0.05));
        return heap;
    }
};

Vec3 drag(std::size_t, const Vec3& velocity) {
    return Vec3(-0.1 * velocity);
}

/// Largest difference of places and of spins times the radius.
double apart(const coupling::Rocks& a, const coupling::Rocks& b) {
    EXPECT_EQ(a.id, b.id);
    double most = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        most = std::max(most, (a.position[k] - b.position[k]).norm());
        most = std::max(most, 0.5 * a.diameter[k] * (a.angular_velocity[k] - b.angular_velocity[k]).norm());
    }
    return most;
}

class Rolling : public ::testing::TestWithParam<const char*> {};

}  // namespace

TEST_P(Rolling, is_the_same_on_one_and_on_all_ranks) {
    const RoughHeap heap(GetParam());
    LiggghtsEngine all(heap.settings, {heap.rotor}, MPI_COMM_WORLD), alone(heap.settings, {heap.rotor}, MPI_COMM_SELF);
    ASSERT_EQ(all.insert(heap.rocks()).size(), 61u);
    alone.insert(heap.rocks());
    int contacts = 0;
    for (int call = 0; call < 20; ++call) {
        contacts = std::max(contacts, all.advance(2e-3, drag).contacts);
        alone.advance(2e-3, drag);
    }
    EXPECT_GT(contacts, 15);
    EXPECT_LT(apart(all.rocks(), alone.rocks()), 1e-10);
}

TEST_P(Rolling, goes_on_from_a_checkpoint_as_if_never_stopped) {
    const RoughHeap heap(GetParam());
    LiggghtsEngine through(heap.settings, {heap.rotor}, MPI_COMM_WORLD);
    through.insert(heap.rocks());
    for (int call = 0; call < 12; ++call) through.advance(2e-3, drag);
    through.write_checkpoint(heap.folder);
    LiggghtsEngine resumed(heap.settings, {heap.rotor}, MPI_COMM_WORLD);
    resumed.read_checkpoint(heap.folder);
    for (int call = 0; call < 5; ++call) {
        through.advance(2e-3, drag);
        resumed.advance(2e-3, drag);
    }
    EXPECT_LT(apart(through.rocks(), resumed.rocks()), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Laws, Rolling, ::testing::Values("spring", "constant"));

// A rock that rolls freely on steel comes to rest on soil that resists.
TEST(RollingOnSoil, is_resisted_by_the_soils_own_coefficient) {
    coupling::DemSettings settings = still_water();
    settings.fluid = {0.0, 0.0};
    settings.added_mass = 0.0;
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel = {0.5, 0.5, 0.0};
    settings.contact.rock_soil = {0.5, 0.5, 0.1};
    settings.walls = {
        {"floor", write_stl(scratch_folder() / "floor.stl", sheet(Vec3(-0.2, -0.2, 0), Vec3(0.4, 0, 0), Vec3(0, 0.4, 0), 4, 4)), false}};
    const auto speed_after = [&](const char* material) {
        settings.walls.front().material = material;
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        coupling::Rocks rolling;
        add_rock(rolling, 1, Vec3(-0.1, 0, 0.01), Vec3(0.1, 0, 0));
        rolling.angular_velocity = {Vec3(0, 10.0, 0)};
        engine.insert(rolling);
        for (int call = 0; call < 100; ++call) engine.advance(1e-3, no_force);
        return engine.rocks().velocity[0].x();
    };
    EXPECT_NEAR(speed_after(coupling::k_steel), 0.1, 0.002);
    // 5/7 g mu_r for 0.1 s would take 0.07 m/s.
    EXPECT_NEAR(speed_after(coupling::k_soil), 0.1 - 5.0 / 7.0 * 9.81 * 0.1 * 0.1, 0.01);
}

// What contacts remember differs: LIGGGHTS would read one as the other.
TEST(RollingCheckpoint, is_refused_where_rolling_friction_came_or_went) {
    const RoughHeap heap("spring");
    coupling::DemSettings smooth = heap.settings;
    smooth.contact.rock_rock.rolling_friction = 0.0;
    LiggghtsEngine engine(heap.settings, {heap.rotor}, MPI_COMM_WORLD);
    engine.write_checkpoint(heap.folder);
    LiggghtsEngine other(smooth, {heap.rotor}, MPI_COMM_WORLD);
    try {
        other.read_checkpoint(heap.folder);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("written with rolling friction"), std::string::npos) << error.what();
    }
}

// Two of different size press on each other and turn: what one loses the other gains, orbit included.
TEST(RollingPair, keeps_its_angular_momentum_and_loses_energy) {
    coupling::DemSettings settings = still_water();
    settings.gravity.setZero();
    settings.fluid = {0.0, 0.0};
    settings.added_mass = 0.0;
    settings.contact.wet_restitution = false;
    settings.contact.rock_rock = {0.5, 0.5, 0.3};
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    coupling::Rocks pair;
    add_rock(pair, 1, Vec3(-0.0101, 0, 0), Vec3(1.0, 0, 0), 0.02);
    add_rock(pair, 2, Vec3(0.0151, 0, 0), Vec3(-0.3, 0, 0), 0.03);
    pair.angular_velocity = {Vec3(0, 100, 20), Vec3(0, -20, 50)};
    engine.insert(pair);
    const auto moments = [&] {
        const coupling::Rocks& rocks = engine.rocks();
        Vec3 momentum = Vec3::Zero();
        double energy = 0.0;
        for (const std::size_t k : {0, 1}) {
            const double mass = sphere_mass(rocks.diameter[k], rocks.density[k]), inertia = sphere_inertia(rocks.diameter[k], mass);
            momentum += mass * rocks.position[k].cross(rocks.velocity[k]) + inertia * rocks.angular_velocity[k];
            energy += 0.5 * mass * rocks.velocity[k].squaredNorm() + 0.5 * inertia * rocks.angular_velocity[k].squaredNorm();
        }
        return std::pair(momentum, energy);
    };
    const auto before = moments();
    for (int call = 0; call < 20; ++call) engine.advance(1e-3, no_force);
    const auto after = moments();
    EXPECT_GT(engine.rocks().velocity[1].x(), engine.rocks().velocity[0].x()) << "they have not parted";
    EXPECT_LT((after.first - before.first).norm(), 1e-3 * before.first.norm());
    EXPECT_LT(after.second, before.second);
    EXPECT_GT((engine.rocks().angular_velocity[0] - pair.angular_velocity[0]).norm(), 1.0);
}

// A rock that turns with a plate does not roll on it.
TEST(RollingWall, feels_the_spin_relative_to_turning_steel) {
    const auto folder = scratch_folder();
    const double turn_rate = 5.0;
    const auto spin_after = [&](const Vec3& spin) {
        coupling::DemSettings settings = still_water();
        settings.gravity.setZero();
        settings.contact.rock_steel = {0.0, 0.9, 0.3};
        settings.walls = {
            {"plate", write_stl(folder / "plate.stl", sheet(Vec3(-0.1, -0.1, 0), Vec3(0.2, 0, 0), Vec3(0, 0.2, 0), 1, 1)), true}};
        coupling::ZoneMotion rotor;
        rotor.axis.direction = Vec3::UnitX();
        rotor.speed = turn_rate;
        LiggghtsEngine engine(settings, {rotor}, MPI_COMM_WORLD);
        coupling::Rocks rock = one_rock(Vec3(0, 0, 0.01 + 1e-6), Vec3(0, -0.05, -0.5));
        rock.angular_velocity[0] = spin;
        engine.insert(rock);
        for (int call = 0; call < 20; ++call) engine.advance(1e-4, no_force);
        return engine.rocks().angular_velocity[0];
    };
    EXPECT_NEAR(spin_after(turn_rate * Vec3::UnitX()).x(), turn_rate, 1e-9);
    EXPECT_GT(spin_after(Vec3::Zero()).x(), 0.1) << "the plate takes along what does not turn with it";
}

}  // namespace cutterflow::liggghts::tests
