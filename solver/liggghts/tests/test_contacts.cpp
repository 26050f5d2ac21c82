#include <cmath>

#include "solver/liggghts/tests/engine_fixture.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::liggghts::tests {

namespace {

enum class WallKind { plane, sheet_of_triangles };

/// Settings with one wall at z = 0 and no gravity; the rock comes from above.
coupling::DemSettings above_wall(WallKind kind, const std::filesystem::path& folder) {
    coupling::DemSettings settings = still_water();
    settings.gravity.setZero();
    if (kind == WallKind::plane) {
        settings.domain.lower.z() = 0.0;
        settings.domain.make_wall(coupling::DomainSide::z_min);
    } else {
        // The rock lands on an inner corner, where six triangles meet.
        const auto file = write_stl(folder / "floor.stl", sheet(Vec3(-0.3, -0.3, 0), Vec3(0.6, 0, 0), Vec3(0, 0.6, 0), 6, 6));
        settings.walls = {{"floor", file, false}};
    }
    return settings;
}

/// Lets a rock hit the wall at z = 0 with `velocity` and returns its velocity when it has left.
Vec3 rebound_velocity(const coupling::DemSettings& settings, const Vec3& velocity, const Vec3& spin = Vec3::Zero(),
                      Vec3* spin_after = nullptr) {
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    coupling::Rocks rock = one_rock(Vec3(0, 0, 0.01 + 1e-5), velocity);
    rock.angular_velocity[0] = spin;
    engine.insert(rock);
    bool touched = false;
    for (int call = 0; call < 2000; ++call) {
        const coupling::DemStep step = engine.advance(1e-3, no_force);
        touched = touched || step.contacts > 0 || engine.rocks().velocity[0].z() > 0.0;
        if (touched && engine.rocks().position[0].z() > 0.01) break;
    }
    if (spin_after) *spin_after = engine.rocks().angular_velocity[0];
    return engine.rocks().velocity[0];
}

}  // namespace

class Bounce : public ::testing::TestWithParam<WallKind> {};

TEST_P(Bounce, returns_the_dry_restitution) {
    coupling::DemSettings settings = above_wall(GetParam(), scratch_folder());
    settings.contact.wet_restitution = false;
    for (const double restitution : {0.3, 0.5, 0.7, 0.9, 0.97}) {
        settings.contact.rock_steel.restitution = restitution;
        const Vec3 after = rebound_velocity(settings, Vec3(0, 0, -1.0));
        EXPECT_NEAR(after.z(), restitution, 0.01 * restitution) << "e = " << restitution;
    }
}

// Values of Legendre2006 for 20 mm, 2650 kg/m3 in water of 20 degrees, e_dry 0.97.
TEST_P(Bounce, returns_the_wet_restitution) {
    const coupling::DemSettings settings = above_wall(GetParam(), scratch_folder());
    const std::pair<double, double> speed_and_restitution[] = {{1.0, 0.965}, {0.1, 0.923}, {0.01, 0.588}};
    for (const auto& [speed, restitution] : speed_and_restitution) {
        const Vec3 after = rebound_velocity(settings, Vec3(0, 0, -speed));
        EXPECT_NEAR(after.z() / speed, restitution, 0.02 * restitution) << "u = " << speed;
    }
}

TEST_P(Bounce, restitution_does_not_depend_on_the_added_mass) {
    coupling::DemSettings settings = above_wall(GetParam(), scratch_folder());
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel.restitution = 0.5;
    for (const double added_mass : {0.0, 0.5, 2.0}) {
        settings.added_mass = added_mass;
        EXPECT_NEAR(rebound_velocity(settings, Vec3(0, 0, -1.0)).z(), 0.5, 0.005) << "C_AM = " << added_mass;
    }
}

// A rock that slides through the whole contact: the tangential impulse is mu times the normal one, and it spins the rock up.
TEST_P(Bounce, a_sliding_contact_obeys_coulomb) {
    coupling::DemSettings settings = above_wall(GetParam(), scratch_folder());
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel.restitution = 1.0;
    Vec3 spin;
    const Vec3 after = rebound_velocity(settings, Vec3(3.0, 0, -1.0), Vec3::Zero(), &spin);
    const double friction = settings.contact.rock_steel.friction;
    EXPECT_NEAR(after.x(), 3.0 - friction * 2.0, 0.01 * friction * 2.0);
    const double inertia_ratio = (k_rock_density + 0.5 * k_water_density) / (0.4 * k_rock_density);  // m_eff / (2/5 m)
    EXPECT_NEAR(spin.y() * 0.01, inertia_ratio * friction * 2.0, 0.02 * inertia_ratio * friction * 2.0);
}

// The same on other materials, with the coefficients of their own pairs: friction, restitution, and the others' do not matter.
TEST(Contacts, with_a_wall_follow_the_pair_of_its_material) {
    coupling::DemSettings settings = above_wall(WallKind::sheet_of_triangles, scratch_folder());
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel = {0.1, 0.9, 0.0};
    settings.contact.rock_soil = {0.25, 0.6, 0.0};
    settings.contact.rock_on_others["perspex"] = {0.15, 0.75, 0.0};
    const auto impact = [&](const char* material) {
        settings.walls.front().material = material;
        return rebound_velocity(settings, Vec3(3.0, 0, -1.0));
    };
    for (const auto& [material, pair] :
         {std::pair(coupling::k_steel, settings.contact.rock_steel), std::pair(coupling::k_soil, settings.contact.rock_soil),
          std::pair("perspex", settings.contact.rock_on_others["perspex"])}) {
        const Vec3 after = impact(material);
        EXPECT_NEAR(after.z(), pair.restitution, 0.01 * pair.restitution);
        const double slowed = pair.friction * (1.0 + pair.restitution);
        EXPECT_NEAR(3.0 - after.x(), slowed, 0.02 * slowed);
    }
}

INSTANTIATE_TEST_SUITE_P(Walls, Bounce, ::testing::Values(WallKind::plane, WallKind::sheet_of_triangles),
                         [](const auto& info) { return info.param == WallKind::plane ? "plane" : "sheet_of_triangles"; });

// Two equal rocks head on: relative speed and Legendre's restitution at it; momentum is kept.
TEST(Contacts, two_rocks_return_the_wet_restitution_and_keep_their_momentum) {
    coupling::DemSettings settings = still_water();
    settings.gravity.setZero();
    for (const double speed : {1.0, 0.1, 0.01}) {
        LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
        coupling::Rocks rocks;
        add_rock(rocks, 1, Vec3(-0.01001, 0, 0), Vec3(0.75 * speed, 0, 0));
        add_rock(rocks, 2, Vec3(0.01001, 0, 0), Vec3(-0.25 * speed, 0, 0));
        ASSERT_EQ(engine.insert(rocks).size(), 2u);
        for (int call = 0; call < 400 && engine.rocks().velocity[1].x() <= engine.rocks().velocity[0].x(); ++call)
            engine.advance(1e-4, no_force);
        for (int call = 0; call < 100; ++call) engine.advance(1e-4, no_force);
        const double stokes = physics::impact_stokes(k_rock_density / k_water_density, 0.5, speed, 0.02, k_water_viscosity);
        const double expected = physics::wet_restitution(0.97, stokes);
        const auto& velocity = engine.rocks().velocity;
        EXPECT_NEAR((velocity[1].x() - velocity[0].x()) / speed, expected, 0.02 * expected) << "u = " << speed;
        EXPECT_NEAR(velocity[1].x() + velocity[0].x(), 0.5 * speed, 1e-12);
    }
}

// The restitution of a second impact follows from its own speed: the first one's record ends when the rocks separate.
TEST(Contacts, each_impact_of_a_pair_has_its_own_restitution) {
    coupling::DemSettings settings = still_water();
    LiggghtsEngine engine(
        [&] {
            settings.domain.lower.z() = 0.0;
            settings.domain.make_wall(coupling::DomainSide::z_min);
            return settings;
        }(),
        no_zones(), MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0, 0, 0.01 + 1e-4), Vec3(0, 0, -0.2)));
    const double gravity = 9.81 * (k_rock_density - k_water_density) / (k_rock_density + 0.5 * k_water_density);
    double speed = std::sqrt(0.04 + 2.0 * gravity * 1e-4);
    double before = -0.2;
    int impacts = 0;
    for (int call = 0; call < 20000 && impacts < 4; ++call) {
        engine.advance(1e-4, no_force);
        const double now = engine.rocks().velocity[0].z();
        const double height = engine.rocks().position[0].z() - 0.01;
        if (now > 0.0 && height > 0.0 && before >= 0.0) {
            const double left_with = std::sqrt(now * now + 2.0 * gravity * height);
            const double stokes = physics::impact_stokes(k_rock_density / k_water_density, 0.5, speed, 0.02, k_water_viscosity);
            const double expected = physics::wet_restitution(0.97, stokes);
            EXPECT_NEAR(left_with / speed, expected, 0.02 * expected) << "impact " << impacts;
            speed = left_with;
            ++impacts;
            before = -1.0;
        } else if (now < 0.0) {
            before = 0.0;
        }
    }
    EXPECT_EQ(impacts, 4);
}

// A drum of narrow facets turns below a rock that hits it: a facet is under the rock for a fraction of the contact only. If the impact
// speed were kept per triangle, the rock would rebound on a facet that it "hits" at no speed, and stick.
TEST(Contacts, the_impact_speed_stays_while_facets_pass_under_the_rock) {
    const double drum_radius = 0.143;
    const int facets = 900;
    std::vector<Triangle> drum;
    const auto corner = [&](int k, double z) {
        const double azimuth = 2.0 * k_pi * (k % facets) / facets;
        return Vec3(drum_radius * std::cos(azimuth), drum_radius * std::sin(azimuth), z);
    };
    for (int k = 0; k < facets; ++k) {
        drum.push_back({corner(k, -0.03), corner(k + 1, -0.03), corner(k + 1, 0.03)});
        drum.push_back({corner(k, -0.03), corner(k + 1, 0.03), corner(k, 0.03)});
    }
    coupling::DemSettings settings = still_water();
    settings.gravity.setZero();
    settings.contact.rock_steel.friction = 0.0;
    settings.contact.max_speed = 1.0;
    settings.walls = {{"drum", write_stl(scratch_folder() / "drum.stl", drum), true}};
    coupling::ZoneMotion rotor;
    rotor.speed = 5.0 / drum_radius;  // 5 m/s at the surface, 3 mm while a rock at 1 m/s is in contact
    LiggghtsEngine engine(settings, {rotor}, MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(drum_radius + 0.01 + 1e-4, 0, 0), Vec3(-1.0, 0, 0)));
    for (int call = 0; call < 100; ++call) engine.advance(1e-4, no_force);
    const double stokes = physics::impact_stokes(k_rock_density / k_water_density, 0.5, 1.0, 0.02, k_water_viscosity);
    const double expected = physics::wet_restitution(0.97, stokes);
    EXPECT_NEAR(engine.rocks().velocity[0].x(), expected, 0.02 * expected);
}

// Soft and stiff steel beyond the bounds that LIGGGHTS puts on Young's modulus.
TEST(Contacts, youngs_modulus_may_be_that_of_rock_or_far_below) {
    coupling::DemSettings settings = above_wall(WallKind::plane, scratch_folder());
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel.restitution = 0.9;
    for (const double modulus : {1e6, 6e10}) {
        settings.contact.youngs_modulus = modulus;
        EXPECT_NEAR(rebound_velocity(settings, Vec3(0, 0, -0.5)).z(), 0.45, 0.0045) << "E = " << modulus;
    }
}

}  // namespace cutterflow::liggghts::tests
