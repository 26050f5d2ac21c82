#include <algorithm>
#include <cmath>

#include "solver/liggghts/contacts/contact_law.hpp"
#include "solver/liggghts/tests/engine_fixture.hpp"

namespace cutterflow::liggghts::tests {

namespace {

constexpr double k_radius = 0.01;
constexpr double k_gravity = 9.81;

/// Nothing takes energy out: restitution 1, no drag; friction only where the rock slides.
coupling::DemSettings without_losses(const std::vector<Triangle>& wall, double friction) {
    coupling::DemSettings settings = still_water();
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel.restitution = 1.0;
    settings.contact.rock_steel.friction = friction;
    settings.walls = {{"wall", write_stl(scratch_folder() / "wall.stl", wall), false}};
    return settings;
}

/// Of the one rock: motion with added mass, spin, weight less buoyancy, and the Hertz contact's.
double energy(const coupling::DemSettings& settings, const coupling::Rocks& rocks, double overlap_ratio) {
    const double mass = (k_rock_density + 0.5 * k_water_density) * volume(2.0 * k_radius);
    const double inertia = 0.4 * k_rock_density * volume(2.0 * k_radius) * k_radius * k_radius;
    const double weight = (k_rock_density - k_water_density) * volume(2.0 * k_radius) * k_gravity;
    const ElasticPair pair = elastic_pair(settings.contact.youngs_modulus, settings.contact.poisson_rock, settings.contact.poisson_steel);
    const double elastic = 8.0 / 15.0 * pair.youngs * std::pow(k_radius, 3) * std::pow(overlap_ratio, 2.5);
    return 0.5 * mass * rocks.velocity[0].squaredNorm() + 0.5 * inertia * rocks.angular_velocity[0].squaredNorm() +
           weight * rocks.position[0].z() + elastic;
}

/// A strip along y whose section in the plane of x and z is the line through the given points.
std::vector<Triangle> folded_strip(const std::vector<Vec3>& section, double half_width, int cells) {
    std::vector<Triangle> surface;
    for (std::size_t k = 0; k + 1 < section.size(); ++k)
        for (const Triangle& t :
             sheet(section[k] - Vec3(0, half_width, 0), section[k + 1] - section[k], Vec3(0, 2.0 * half_width, 0), 1, cells))
            surface.push_back(t);
    return surface;
}

/// Section of a drum about the y axis, its top at the origin: facets that meet at `fold_deg`, one fold on top.
std::vector<Vec3> drum_section(double radius, double fold_deg, int folds_each_side) {
    std::vector<Vec3> section;
    for (int k = -folds_each_side; k <= folds_each_side; ++k) {
        const double angle = k * fold_deg * k_pi / 180.0;
        section.emplace_back(radius * std::sin(angle), 0.0, radius * (std::cos(angle) - 1.0));
    }
    return section;
}

/// Two planes that meet on the y axis at `fold_deg`, convex when it is positive.
std::vector<Vec3> roof_section(double fold_deg) {
    const double drop = 0.2 * std::tan(0.5 * fold_deg * k_pi / 180.0);
    return {Vec3(-0.2, 0, -drop), Vec3(0, 0, 0), Vec3(0.2, 0, -drop)};
}

/// A rock on a plane of `normal` through `foot` that rolls with `velocity` and does not slip.
coupling::Rocks rolling_rock(const Vec3& foot, const Vec3& normal, const Vec3& velocity) {
    coupling::Rocks rocks = one_rock(foot + (k_radius + 1e-6) * normal, velocity, 2.0 * k_radius);
    rocks.angular_velocity[0] = normal.cross(velocity) / k_radius;
    return rocks;
}

struct Ride {
    double worst_energy_error = 0.0;  ///< over the kinetic energy at the start
    coupling::Rocks end;
    bool touched = false;
};

/// \param beyond  ends the ride where the rock passes this x
Ride ride(const coupling::DemSettings& settings, const coupling::Rocks& start, double duration, double beyond = 1.0) {
    LiggghtsEngine engine(settings, no_zones(), MPI_COMM_WORLD);
    EXPECT_EQ(engine.insert(start).size(), 1u);
    const double at_start = energy(settings, engine.rocks(), 0.0);
    const double kinetic = at_start - energy(settings, one_rock(start.position[0], Vec3::Zero(), 2.0 * k_radius), 0.0);
    Ride result;
    const double call = 1e-5;  // one step of the contacts, whose overlap is then that of the rock's place
    for (int k = 0; k * call < duration && engine.rocks().position[0].x() < beyond; ++k) {
        const coupling::DemStep step = engine.advance(call, no_force);
        EXPECT_EQ(step.substeps, 1);
        if (engine.rocks().size() == 0) {
            ADD_FAILURE() << "the rock fell out of the domain";
            return result;
        }
        const double error = (energy(settings, engine.rocks(), step.max_overlap_ratio) - at_start) / kinetic;
        result.worst_energy_error = std::max(result.worst_energy_error, std::fabs(error));
        result.touched = result.touched || step.contacts > 0;
        result.end = engine.rocks();
    }
    return result;
}

}  // namespace

class SeamsOfAPlate : public ::testing::TestWithParam<int> {};

// Seams parallel to the way, across it and aslant, and points where six triangles meet.
TEST_P(SeamsOfAPlate, do_not_brake_or_turn_a_rolling_rock) {
    const auto settings = without_losses(sheet(Vec3(-0.06, -0.06, 0), Vec3(0.12, 0, 0), Vec3(0, 0.12, 0), GetParam(), GetParam()), 0.5);
    for (const Vec3& velocity : {Vec3(0.3, 0, 0), Vec3(0.2, 0.2, 0), Vec3(0.25, -0.11, 0)}) {
        const Ride way = ride(settings, rolling_rock(Vec3(-0.04, 0, 0), Vec3::UnitZ(), velocity), 0.2);
        EXPECT_TRUE(way.touched);
        EXPECT_LT(way.worst_energy_error, 0.01);
        // The rock was set down from 1 um above the plate and goes on bouncing a little.
        EXPECT_LT((way.end.velocity[0] - velocity).head<2>().norm(), 1e-3 * velocity.norm());
        EXPECT_LT((way.end.angular_velocity[0] - Vec3::UnitZ().cross(velocity) / k_radius).norm(), 1e-3 * velocity.norm() / k_radius);
    }
}

INSTANTIATE_TEST_SUITE_P(Cells, SeamsOfAPlate, ::testing::Values(6, 24),
                         [](const auto& info) { return "of_" + std::to_string(120 / info.param) + "_mm"; });

class Folds : public ::testing::TestWithParam<double> {};

struct Drum {
    std::vector<Triangle> surface;
    Vec3 foot, normal, uphill;  ///< of the facet's middle on the left where a ride starts
};

Drum drum_of(double fold_deg) {
    const double radius = 0.05, fold = fold_deg * k_pi / 180.0;
    const double facet = (std::floor(18.0 / fold_deg) + 0.5) * fold;
    Drum drum;
    drum.surface = folded_strip(drum_section(radius, fold_deg, static_cast<int>(std::ceil(40.0 / fold_deg))), 0.03, 3);
    drum.normal = Vec3(-std::sin(facet), 0, std::cos(facet));
    drum.uphill = Vec3(std::cos(facet), 0, std::sin(facet));
    drum.foot = radius * std::cos(0.5 * fold) * drum.normal - Vec3(0, 0, radius);
    return drum;
}

// Uphill to the top of a drum and down to the same height, at a speed at which no fold throws the rock off. Restitution keeps the rock from
// bouncing all the way: a rock that bounces and spins loses energy to friction. Rolling itself loses none.
TEST_P(Folds, do_not_brake_a_rock_that_rolls_over_a_convex_prism) {
    const Drum drum = drum_of(GetParam());
    auto settings = without_losses(drum.surface, 1.0);
    settings.contact.rock_steel.restitution = 0.5;
    const coupling::Rocks rock = rolling_rock(drum.foot, drum.normal, 0.2 * drum.uphill);
    const double mirrored = -rock.position[0].x();
    const Ride way = ride(settings, rock, 1.0, mirrored);
    EXPECT_TRUE(way.touched);
    EXPECT_GT(way.end.position[0].x(), mirrored) << "the rock did not get over the top";
    EXPECT_LT(way.worst_energy_error, 0.01);
    EXPECT_NEAR(way.end.velocity[0].norm(), 0.2, 0.004);
}

// Faster, the folds throw the rock off and it comes down on the next facets. Without friction nothing is lost in these impacts.
TEST_P(Folds, do_not_brake_a_rock_that_slides_and_hops_over_a_convex_prism) {
    const Drum drum = drum_of(GetParam());
    const auto settings = without_losses(drum.surface, 0.0);
    coupling::Rocks rock = rolling_rock(drum.foot, drum.normal, 0.35 * drum.uphill);
    rock.angular_velocity[0].setZero();
    const double mirrored = -rock.position[0].x();
    const Ride way = ride(settings, rock, 0.5, mirrored);
    EXPECT_TRUE(way.touched);
    EXPECT_GT(way.end.position[0].x(), mirrored);
    EXPECT_LT(way.worst_energy_error, 0.01);
}

// Straight above the fold no facet faces the rock: the edge itself must carry it.
TEST_P(Folds, return_a_rock_that_falls_on_the_edge) {
    for (const double sense : {1.0, -1.0}) {
        const auto settings = without_losses(folded_strip(roof_section(sense * GetParam()), 0.03, 3), 0.0);
        const Ride fall = ride(settings, one_rock(Vec3(0, 0.003, k_radius + 2e-4), Vec3(0, 0, -0.5), 2.0 * k_radius), 0.05);
        EXPECT_TRUE(fall.touched);
        EXPECT_LT(fall.worst_energy_error, 0.01) << (sense > 0.0 ? "convex" : "concave");
        EXPECT_GT(fall.end.velocity[0].z(), 0.1);
        EXPECT_GT(fall.end.position[0].z(), k_radius);
    }
}

// Beside a fold and askew to it, without friction: the touch moves over the edge during the impact.
TEST_P(Folds, return_a_rock_that_falls_beside_the_edge) {
    for (const double sense : {1.0, -1.0}) {
        const auto settings = without_losses(folded_strip(roof_section(sense * GetParam()), 0.03, 3), 0.0);
        for (const double x : {-4e-4, -1e-4, -2e-5, 2e-5, 1e-4}) {
            const Ride fall = ride(settings, one_rock(Vec3(x, 0.003, k_radius + 2e-4), Vec3(0.4, 0.1, -0.5), 2.0 * k_radius), 0.01);
            EXPECT_TRUE(fall.touched);
            EXPECT_LT(fall.worst_energy_error, 0.01) << (sense > 0.0 ? "convex" : "concave") << " x = " << x;
            EXPECT_GT(fall.end.velocity[0].z(), 0.0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Angles, Folds, ::testing::Values(0.2, 1.0, 5.0, 10.0), [](const auto& info) {
    return "of_" + std::to_string(static_cast<int>(10.0 * info.param)) + "_tenths_of_a_degree";
});

}  // namespace cutterflow::liggghts::tests
