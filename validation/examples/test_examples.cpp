/// The hand-written cases of cases/examples run as a user runs them, and obey their own force balances.
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/falling_rock.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

fs::path copy_example(const std::string& name) {
    const fs::path folder = scratch_folder("example_" + name);
    fs::copy(fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples" / name, folder, fs::copy_options::recursive);
    return folder;
}

/// A copy of an example, meshed and run.
fs::path run_example(const std::string& name) {
    const fs::path folder = copy_example(name);
    run_in_case(folder, {"blockMesh"});
    run_cutter_foam(folder);
    return folder;
}

TEST(RockInABox, falls_as_its_force_balance_says) {
    const fs::path folder = run_example("rock_in_a_box");
    const RockSnapshot last = last_rocks(folder);
    EXPECT_NEAR(last.time, 0.3, 1e-9);
    const double expected = fall_speed(FallingRock(), 0.0, last.time);
    EXPECT_NEAR(-last.velocity.at(0).z(), expected, 0.014 * expected);
    EXPECT_NEAR(last.velocity.at(0).head<2>().norm(), 0.0, 0.01 * expected);
    const auto balance = read_columns(folder / "postProcessing/balance/0/balance.csv");
    EXPECT_LE(largest(balance.at("solid_volume_error")), 1e-10);
    EXPECT_LE(largest(balance.at("momentum_error")), 1e-5);
    EXPECT_FALSE(fs::exists(folder / "postProcessing/rock/0/fates.csv"));
}

constexpr double k_fall_height = 0.2, k_restitution = 0.8, k_gravity = 9.81;  // of bouncing_rock [m], [-], [m/s2]

/// Height [m] above the floor and upward velocity [m/s], after the first bounce.
std::pair<double, double> bounce(double time) {
    const double fall = std::sqrt(2.0 * k_fall_height / k_gravity), rise = time - fall;
    const double start = k_restitution * k_gravity * fall;
    return {start * rise - 0.5 * k_gravity * rise * rise, start - k_gravity * rise};
}

void expect_bounced(const RockSnapshot& rock) {
    EXPECT_NEAR(rock.time, 0.4, 1e-9);
    const auto [height, velocity] = bounce(rock.time);
    EXPECT_NEAR(rock.position.at(0).z() - 0.005, height, 0.01 * k_fall_height);
    EXPECT_NEAR(rock.velocity.at(0).z(), velocity, 0.01 * k_gravity * 0.2);
    EXPECT_LT(rock.position.at(0).head<2>().norm(), 1e-12);
}

TEST(BouncingRock, without_a_medium_keeps_its_restitution_also_when_it_is_resumed) {
    const fs::path folder = copy_example("bouncing_rock");
    run_cutter_foam(folder);
    expect_bounced(last_rocks(folder));
    EXPECT_FALSE(fs::exists(folder / "constant/polyMesh"));

    const RockSnapshot whole = last_rocks(folder);
    for (const char* time : {"0.3", "0.4"}) fs::remove_all(folder / "checkpoints" / time);
    fs::remove_all(folder / "postProcessing");
    run_cutter_foam(folder);
    const RockSnapshot resumed = last_rocks(folder);
    EXPECT_LT((resumed.position.at(0) - whole.position.at(0)).norm(), 1e-9);
    EXPECT_LT((resumed.velocity.at(0) - whole.velocity.at(0)).norm(), 1e-7);
}

/// Force on the bed from the pressure under it, at the end of each step [N].
std::map<double, double> pressure_forces(const fs::path& folder, double density, double area) {
    std::map<double, double> forces;
    for (const std::vector<double>& row : read_function_object(folder, "bed")) forces[row[0]] = density * row[1] * area;
    return forces;
}

// The air's pressure drop is the force that the air has on the grains: the air's own momentum and its friction at the walls are below 2 %.
// Its mean is the grains' weight less buoyancy, N (pi/6) d^3 (rho_s - rho_f) g, but for what the floor carries of grains that fall on it.
TEST(FluidisedBed, is_carried_by_the_air) {
    const fs::path folder = run_example("fluidised_bed");
    const auto feed = read_columns(folder / "constant/rockFeed.csv");
    const double rho = 1.2, area = 0.015 * 0.03;
    const std::map<double, double> forces = pressure_forces(folder, rho, area);

    int snapshots = 0;
    for (const RockSnapshot& rocks : all_rocks(folder)) {
        if (rocks.time < 0.1 - 1e-9) continue;
        double on_grains = 0.0;
        for (const Vec3& force : rocks.hydrodynamic_force) on_grains += force.z();
        EXPECT_NEAR(std::prev(forces.upper_bound(rocks.time + 1e-9))->second, on_grains, 0.02 * on_grains) << rocks.time << " s";
        ++snapshots;
    }
    EXPECT_EQ(snapshots, 5);

    const double volume = k_pi / 6.0 * std::pow(feed.at("diameter_m")[0], 3) * static_cast<double>(feed.at("id").size());
    const double weight = volume * (feed.at("density_kg_m3")[0] - rho) * 9.81;
    double sum = 0.0, duration = 0.0, before = 0.0;
    for (const auto& [time, force] : forces) {
        if (time > 0.1) {
            sum += force * (time - before);
            duration += time - before;
        }
        before = time;
    }
    ASSERT_GT(duration, 0.19);
    EXPECT_NEAR(sum / duration, weight, 0.1 * weight);

    const auto balance = read_columns(folder / "postProcessing/balance/0/balance.csv");
    EXPECT_EQ(balance.at("rocks").back(), static_cast<double>(feed.at("id").size()));
    EXPECT_LE(largest(balance.at("momentum_error")), 1e-5);
    EXPECT_NEAR(balance.at("outlet_flow_m3_s").back(), 2.5 * area, 0.02 * 2.5 * area);
}

}  // namespace
}  // namespace cutterflow::validation
