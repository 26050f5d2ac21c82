// Averages of the velocity at points: analytic fields that turn with the head, steel that passes, what a checkpoint keeps.
#include <fstream>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "solver/observe/velocity/velocity_sets.hpp"
#include "solver/observe/velocity/velocity_tables.hpp"
#include "solver/ports/testing/fake_engines.hpp"
#include "solver/ports/testing/temporary_folder.hpp"

namespace cutterflow::coupling {
namespace {

using testing::FakeFluid;
using ::testing::HasSubstr;
using testing::SyntheticMesh;
using testing::TemporaryFolder;

constexpr double k_turn = 2.0 * k_pi;
constexpr int k_blades = 6;

/// What passes a point with six blades, and with each revolution: components (radial, tangential, axial).
Vec3 passing(double angle, double azimuth) {
    const double blade = k_blades * (azimuth - angle);
    return {0.3 + 0.2 * std::cos(blade) + 0.05 * std::sin(angle), 1.0 + 0.4 * std::sin(blade), -0.1 + 0.03 * std::cos(2.0 * blade)};
}

/// Steps of the rotor [rad] that differ as those of a run do: 0.3 to 1 degree.
double step_after(int n) {
    return (0.65 + 0.35 * std::sin(0.7 * n)) * k_pi / 180.0;
}

ZoneMotion turning(double speed) {
    ZoneMotion motion;
    motion.speed = speed;
    return motion;
}

/// Triangles of a box with its faces outward.
std::vector<SteelTriangle> box(const Vec3& a, const Vec3& b) {
    const auto corner = [&](int i) { return Vec3((i & 1) != 0 ? b[0] : a[0], (i & 2) != 0 ? b[1] : a[1], (i & 4) != 0 ? b[2] : a[2]); };
    std::vector<SteelTriangle> triangles;
    for (const auto& face :
         std::vector<std::array<int, 4>>{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
        triangles.push_back({corner(face[0]), corner(face[1]), corner(face[2])});
        triangles.push_back({corner(face[0]), corner(face[2]), corner(face[3])});
    }
    return triangles;
}

/// A fluid whose velocity turns with the head, at points of the absolute frame.
FakeFluid rotating_flow(double speed, SyntheticMesh mesh = {}) {
    FakeFluid fluid(std::move(mesh), turning(speed), 1.0);
    fluid.flow = [speed](const Vec3& x, double time) -> Vec3 {
        const double azimuth = std::atan2(x[1], x[0]);
        const Vec3 u = passing(speed * time, azimuth);
        const Vec3 radial(std::cos(azimuth), std::sin(azimuth), 0.0), tangential(-std::sin(azimuth), std::cos(azimuth), 0.0);
        return u[0] * radial + u[1] * tangential + u[2] * Vec3::UnitZ();
    };
    return fluid;
}

class VelocitySetsTest : public ::testing::Test {
protected:
    VelocitySettings settings(const std::string& points, int phases, double start = 0.0) {
        VelocitySettings s;
        s.start_time = start;
        s.blades = k_blades;
        s.sets = {{"adv", folder.write("points.csv", "x_m,y_m,z_m,rotating\n" + points), phases}};
        return s;
    }
    /// Lets the rotor turn up to `angle` and samples as a run does.
    void turn_to(double angle, VelocitySets& sets, FakeFluid& fluid) {
        double now = std::abs(fluid.moving[0].angle(fluid.time()));
        while (now < angle - 1e-9) {
            now = std::min(now + step_after(step_++), angle);
            fluid.restart_at(now / std::abs(fluid.moving[0].speed));
            sets.sample_if_due(fluid);
        }
    }
    TemporaryFolder folder;
    int step_ = 0;
};

}  // namespace

TEST_F(VelocitySetsTest, means_of_a_field_that_turns_with_the_head_are_its_own) {
    FakeFluid fluid = rotating_flow(-6.0);
    // Averaging begins in the middle of a revolution and ends in the middle of one.
    VelocitySets sets(settings("0.1,0.2,-0.1,0\n0.1,0.2,-0.1,1\n", 0, 0.5 * k_turn / 6.0), fluid);
    turn_to(3.9 * k_turn, sets, fluid);
    const VelocityStatistics& statistics = sets.sets()[0].statistics;
    EXPECT_EQ(statistics.whole_revolutions(), 3);
    const Vec3 still = statistics.average(0).mean();
    EXPECT_NEAR(still[0], 0.3, 1e-3);
    EXPECT_NEAR(still[1], 1.0, 1e-3);
    EXPECT_NEAR(still[2], -0.1, 1e-3);
    // The turning point sees one blade's phase for ever; what changes with the revolution averages out.
    const Vec3 turned = statistics.average(1).mean();
    const Vec3 own = passing(0.0, std::atan2(0.2, 0.1));
    EXPECT_NEAR(turned[0], own[0], 1e-3);
    EXPECT_NEAR(turned[1], own[1], 1e-12);
    EXPECT_NEAR(turned[2], own[2], 1e-12);
    // The field repeats with the revolution: so do the batches.
    ASSERT_TRUE(statistics.standard_error(0));
    EXPECT_LT(statistics.standard_error(0)->maxCoeff(), 1e-3);
}

TEST_F(VelocitySetsTest, phases_follow_the_rotors_angle) {
    FakeFluid fluid = rotating_flow(6.0);
    constexpr int phases = 12;
    VelocitySets sets(settings("0.2,0,0,0\n0,0.2,0,1\n", phases, 0.3), fluid);  // begins at 1.8 rad
    turn_to(1.8 + 10.0 * k_turn, sets, fluid);
    const VelocityStatistics& statistics = sets.sets()[0].statistics;
    for (int n = 0; n < phases; ++n) {
        // Mean of the field over the bin: blades by their sixth of a turn, the slow part averages out over the six passings.
        const double half = 0.5 * k_turn / k_blades / phases, middle = (2 * n + 1) * half;
        const double expected = 1.0 - 0.4 * std::sin(k_blades * middle) * std::sin(k_blades * half) / (k_blades * half);
        EXPECT_NEAR(statistics.phase(n, 0).mean()[1], expected, 0.02) << n;
        // A point that turns: by the angle in the revolution, which the slow part follows.
        const double slow_half = 0.5 * k_turn / phases;
        const double slow = 0.05 * std::sin((2 * n + 1) * slow_half) * std::sin(slow_half) / slow_half;
        EXPECT_NEAR(statistics.phase(n, 1).mean()[0] - passing(0.0, 0.5 * k_pi)[0], slow, 2e-4) << n;
    }
}

TEST_F(VelocitySetsTest, error_of_the_mean_is_that_of_the_batches) {
    VelocityStatistics statistics({k_turn}, 0, 0.0);
    const std::vector<double> batches{1.0, 1.4, 0.8, 1.2};
    for (int n = 1; n <= 4 * 120; ++n) {
        const double angle = n * k_turn / 120;
        // The value belongs to the revolution in which the sample's middle lies; the last sample of one is shared by both.
        const double before = batches[static_cast<std::size_t>(std::min((n - 1) / 120, 3))],
                     after = batches[static_cast<std::size_t>(std::min(n / 120, 3))];
        statistics.add(angle, std::vector<Vec3>{Vec3::Constant(0.5 * (before + after))}, std::vector<std::uint8_t>{1});
    }
    EXPECT_EQ(statistics.whole_revolutions(), 4);
    EXPECT_NEAR(statistics.average(0).mean()[0], 1.1, 2e-3);
    // sqrt(sum of squares 0.2 / (4 * 3))
    EXPECT_NEAR((*statistics.standard_error(0))[0], std::sqrt(0.2 / 12.0), 2e-3);
}

TEST_F(VelocitySetsTest, samples_in_passing_steel_are_counted_and_left_out) {
    SyntheticMesh mesh;
    // A blade that covers azimuths -30 to 30 degrees at the point's radius, about.
    mesh.rotor_steel = box(Vec3(0.1, -0.1, -0.05), Vec3(0.3, 0.1, 0.05));
    mesh.stator_steel = box(Vec3(-1, -1, 0.2), Vec3(1, 1, 0.3));
    FakeFluid fluid = rotating_flow(6.0, std::move(mesh));
    const double r = 0.2;
    fluid.flow = [r](const Vec3& x, double time) -> Vec3 {
        const double apart = std::remainder(std::atan2(x[1], x[0]) - 6.0 * time, k_turn);
        return std::abs(apart) < std::asin(0.1 / r) - 0.04 ? Vec3(1e9, 0, 0) : Vec3(0, 0, 2.0);  // nonsense in the steel
    };
    VelocitySets sets(settings("0,0.2,0,0\n0.2,0,0,1\n0,0.2,0.25,0\n0,0.2,0.1,0\n", 0), fluid);
    turn_to(2.0 * k_turn, sets, fluid);
    const VelocityStatistics& statistics = sets.sets()[0].statistics;
    const double share = static_cast<double>(statistics.dry_samples(0)) / static_cast<double>(statistics.samples());
    EXPECT_NEAR(share, 2.0 * std::asin(0.1 / r) / k_turn, 0.01);
    EXPECT_NEAR(statistics.average(0).mean()[2], 2.0, 1e-12);
    EXPECT_NEAR(statistics.average(0).mean()[0], 0.0, 1e-12);
    EXPECT_EQ(statistics.average(1).weight, 0.0);  // turns within the blade
    EXPECT_EQ(statistics.dry_samples(2), statistics.samples());
    EXPECT_EQ(statistics.dry_samples(3), 0u);
}

TEST_F(VelocitySetsTest, go_on_after_a_checkpoint_as_if_there_was_none) {
    const VelocitySettings how = settings("0.1,0.2,-0.1,0\n0.1,0.2,-0.1,1\n", 8);
    FakeFluid fluid = rotating_flow(6.0);
    VelocitySets whole(how, fluid);
    turn_to(1.3 * k_turn, whole, fluid);
    std::stringstream saved;
    whole.write(saved);
    VelocitySets resumed(how, fluid);
    ASSERT_TRUE(resumed.restore(saved));
    const int step = step_;
    FakeFluid again = rotating_flow(6.0);
    again.restart_at(fluid.time());
    turn_to(2.6 * k_turn, whole, fluid);
    step_ = step;
    turn_to(2.6 * k_turn, resumed, again);
    std::stringstream a, b;
    whole.write(a);
    resumed.write(b);
    EXPECT_EQ(a.str(), b.str());
    VelocitySets other(settings("0,0,0,0\n", 8), fluid);
    EXPECT_FALSE(other.restore(a));
    // As many points, one of them elsewhere, or turning.
    for (const char* points : {"0.1,0.2,-0.1,0\n0.1,0.21,-0.1,1\n", "0.1,0.2,-0.1,0\n0.1,0.2,-0.1,0\n"}) {
        std::istringstream of_others(b.str());
        VelocitySets moved(settings(points, 8), fluid);
        EXPECT_FALSE(moved.restore(of_others)) << points;
    }
}

/// Sums begin with the times and the points that they are of.
std::size_t identity_bytes(std::size_t points) {
    return (2 + 5 * points) * sizeof(double);
}

TEST_F(VelocitySetsTest, sums_that_announce_more_revolutions_than_they_hold_are_refused) {
    const VelocitySettings how = settings("0.1,0.2,-0.1,0\n", 8);
    FakeFluid fluid = rotating_flow(6.0);
    VelocitySets sets(how, fluid);
    turn_to(0.3 * k_turn, sets, fluid);
    std::ostringstream saved;
    sets.write(saved);
    for (const std::uint64_t revolutions : {std::uint64_t{1000}, std::uint64_t{1} << 59, ~std::uint64_t{0}}) {
        std::string bytes = saved.str();
        bytes.replace(identity_bytes(1) + sizeof(double) + 2 * sizeof revolutions, sizeof revolutions,
                      reinterpret_cast<const char*>(&revolutions), sizeof revolutions);
        std::istringstream stream(bytes);
        VelocitySets resumed(how, fluid);
        EXPECT_FALSE(resumed.restore(stream)) << revolutions;
    }
}

/// The angle counts the whole revolutions, by which the tables index the sums.
TEST_F(VelocitySetsTest, sums_of_an_angle_that_they_cannot_have_reached_are_refused) {
    for (const char* points : {"0.1,0.2,-0.1,0\n", ""}) {
        const VelocitySettings how = settings(points, 8);
        FakeFluid fluid = rotating_flow(6.0);
        VelocitySets sets(how, fluid);
        turn_to(2.3 * k_turn, sets, fluid);
        std::ostringstream saved;
        sets.write(saved);
        const std::size_t next_at = identity_bytes(*points == '\0' ? 0 : 1),
                          angle_at = next_at + sizeof(double) + 4 * sizeof(std::uint64_t);
        for (const double angle : {1e3, -1.0, 1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
            for (const std::size_t at : {next_at, angle_at}) {
                if (at == next_at && std::isfinite(angle)) continue;  // the next sample's angle may be any
                std::string bytes = saved.str();
                bytes.replace(at, sizeof angle, reinterpret_cast<const char*>(&angle), sizeof angle);
                std::istringstream stream(bytes);
                VelocitySets resumed(how, fluid);
                EXPECT_FALSE(resumed.restore(stream)) << angle << " at byte " << at;
            }
    }
}

TEST_F(VelocitySetsTest, tables_hold_means_revolutions_and_phases) {
    FakeFluid fluid = rotating_flow(6.0);
    VelocitySets sets(settings("0,0.2,-0.1,0\n0.1,0,0,1\n", 4), fluid);
    turn_to(2.0 * k_turn, sets, fluid);
    write_velocity_tables(folder.path(), sets, 2.0);
    const auto text_of = [&](const char* name) {
        std::ifstream stream(folder.path() / name);
        std::stringstream text;
        text << stream.rdbuf();
        return text.str();
    };
    const std::string mean = text_of("adv.csv");
    EXPECT_THAT(mean, HasSubstr("point,x_m,y_m,z_m,rotating,u_radial_m_s,u_tangential_m_s,u_axial_m_s,se_radial_m_s,se_tangential_m_s,"
                                "se_axial_m_s,samples,dry_samples,revolutions,from_s,to_s\n1,0,0.2,-0.1,0,0.29999"));
    EXPECT_EQ(std::count(mean.begin(), mean.end(), '\n'), 3);
    const std::string revolutions = text_of("adv_revolutions.csv"), phases = text_of("adv_phases.csv");
    EXPECT_EQ(std::count(revolutions.begin(), revolutions.end(), '\n'), 1 + 2 * 2);
    EXPECT_THAT(revolutions, HasSubstr("\n2,1,0."));
    EXPECT_EQ(std::count(phases.begin(), phases.end(), '\n'), 1 + 4 * 2);
    EXPECT_THAT(phases, HasSubstr("\n7.5,1,"));  // still: a quarter of 60 degrees, in the middle
    EXPECT_THAT(phases, HasSubstr("\n45,2,"));
}

TEST_F(VelocitySetsTest, refuses_bad_points_and_a_rotor_at_rest_at_once) {
    FakeFluid still = rotating_flow(0.0);
    try {
        VelocitySets(settings("0,0,0,2\n", 0), still);
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("rotating = 2"));
        EXPECT_THAT(error.what(), HasSubstr("rotor at rest"));
    }
}

}  // namespace cutterflow::coupling
