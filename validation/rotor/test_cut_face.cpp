/// Rock from the cut face of a bank ahead of the blades of a turning rotor, in small, over one revolution: it comes at the rate of the
/// swing, starts ahead of a blade and outside steel, and the ledger closes in every step.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cases/scenes/cutter/cut_face_feed.hpp"
#include "cases/scenes/cutter/feed.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/soil/bank.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/rotor_case.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr double k_period = 1.0, k_speed = 2.0 * k_pi / k_period;                          // 60 rpm
constexpr double k_swing_speed = 0.008, k_grain_density = 2650.0, k_porosity = 0.15;       // [m/s], [kg/m3], -
constexpr double k_begin = 0.1, k_end_of_feed = k_begin + k_period, k_end_of_run = 1.15;   // [s]
constexpr double k_inner_radius = 0.1, k_outer_radius = cases::test::k_tiny_rotor_radius;  // of the steel [m]
constexpr double k_lump = k_pi / 4.0, k_pitch = k_pi, k_reach = k_pi / 6.0;                // [rad]

/// The rotor's steel at angle 0: a cylinder with two lumps, one from azimuth 0 to 45 degrees, the other opposite.
geometry::TriangleSurface steel() {
    constexpr std::uint32_t corners = 64;
    geometry::TriangleSurface surface;
    std::vector<Eigen::Vector2d> outline;
    for (std::uint32_t i = 0; i < corners; ++i) {
        const double azimuth = 2.0 * k_pi * i / corners;
        const double in_pitch = std::fmod(azimuth + 1e-9, k_pitch);
        const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
        const bool trailing = in_pitch < 1e-6, leading = std::abs(in_pitch - k_lump) < 1e-6, lump = in_pitch < k_lump + 1e-6;
        if (trailing) outline.emplace_back(k_inner_radius * direction);
        outline.emplace_back((lump ? k_outer_radius : k_inner_radius) * direction);
        if (leading) outline.emplace_back(k_inner_radius * direction);
    }
    const auto count = static_cast<std::uint32_t>(outline.size());
    for (const double z : {cases::test::k_tiny_z_min, cases::test::k_tiny_z_max}) {
        for (const Eigen::Vector2d& corner : outline) surface.points.emplace_back(corner.x(), corner.y(), z);
        surface.points.emplace_back(0.0, 0.0, z);
    }
    const std::uint32_t top = count + 1;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        surface.triangles.push_back({i, next, top + next});
        surface.triangles.push_back({i, top + next, top + i});
        surface.triangles.push_back({count, next, i});
        surface.triangles.push_back({top + count, top + i, top + next});
    }
    return surface;
}

geometry::Bank bank(const geometry::Contour& head) {
    geometry::BankParameters parameters;
    parameters.inclination = k_pi / 6.0;
    parameters.cut_height = 0.12;
    parameters.step = 0.06;
    parameters.pick_length = 0.01;
    parameters.clearance = 0.005;
    return {head, parameters};
}

cases::PlacedFeed feed_from(const geometry::Bank& bank, const geometry::Contour& head, const geometry::TriangleSurface& cutter) {
    cases::CutRequest cut;
    cut.face = bank.cut_face(0.01);
    cut.mass_rate = cases::cut_mass_rate(cut.face, k_swing_speed, k_grain_density, k_porosity);
    cut.begin = k_begin;
    cut.end = k_end_of_feed;
    cut.seed = 1;
    cut.classes = {{0.008, k_grain_density, 1.0}};
    cases::PlacedFeed feed;
    feed.request.kind = cases::FeedKind::cut_face;
    feed.request.classes = cut.classes;
    for (const cases::CutRock& rock : cut_face_schedule(cut, {head, cutter, k_speed}).rocks)
        feed.rocks.push_back(cases::placed_rock(rock, 0.5 * k_speed));
    return feed;
}

/// A rock that came in.
struct Start {
    Vec3 position;          ///< [m]
    double angle = 0.0;     ///< of the rotor [rad]
    double diameter = 0.0;  ///< [m]
};

std::vector<Start> starts_of(const fs::path& folder) {
    std::ifstream table(folder / "postProcessing/rock/0/events.csv");
    std::vector<Start> starts;
    std::string line;
    std::getline(table, line);
    while (std::getline(table, line)) {
        std::vector<std::string> fields;
        std::istringstream row(line);
        for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
        if (fields.at(2) != "feed") continue;
        starts.push_back({Vec3(std::stod(fields.at(4)), std::stod(fields.at(5)), std::stod(fields.at(6))), std::stod(fields.at(10)),
                          std::stod(fields.at(13))});
    }
    return starts;
}

/// Ahead of a lump by no more than what rock takes that finds its place taken, and outside steel.
void expect_ahead_of_a_blade(const Start& start, const geometry::SolidSearch& cutter, const geometry::Contour& head) {
    const Vec3 in_rotor = Eigen::AngleAxisd(-start.angle, Vec3::UnitZ()) * start.position;
    const double radius = in_rotor.head<2>().norm(), azimuth = std::atan2(in_rotor.y(), in_rotor.x());
    EXPECT_FALSE(cutter.contains(in_rotor));
    EXPECT_GE(cutter.nearest(in_rotor).distance, 0.5 * start.diameter);
    EXPECT_LE(head.signed_distance(radius, in_rotor.z()), -0.5 * start.diameter);
    const double ahead = std::fmod(azimuth - k_lump + 2.0 * k_pitch, k_pitch);
    EXPECT_LE(ahead, k_reach + (0.55 * start.diameter + 0.005) / radius) << "azimuth " << azimuth;
}

TEST(CutFace, feeds_a_turning_rotor_at_the_rate_of_the_swing) {
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    const geometry::Contour head({-0.25, 0.0}, {k_outer_radius, k_outer_radius}, k_outer_radius, 0.02);
    inputs.times.end = k_end_of_run;
    inputs.times.write_interval = k_end_of_run;
    inputs.checkpoint.interval = 0.5;
    inputs.rock.emplace();
    inputs.rock->density = k_grain_density;
    inputs.queue = coupling::QueueSettings{0.005, 0.5 * k_period, k_reach};
    inputs.fates.cutting = coupling::CuttingSettings{0.75 * k_outer_radius, Vec3(0.0, -1.0, 0.0), 1.5 * k_outer_radius};
    const geometry::Bank soil = bank(head);
    const geometry::TriangleSurface cutter = steel();
    const cases::PlacedFeed feed = feed_from(soil, head, cutter);
    const fs::path folder = scratch_folder("cut_face");
    write_rotor_case(folder, inputs, cases::rock_feed_csv({feed}));
    run_cutter_foam(folder, 1);

    const auto ledger = read_columns(folder / "postProcessing/rock/0/ledger.csv");
    ASSERT_NEAR(ledger.at("time_s").back(), k_end_of_run, 1e-9);
    EXPECT_LE(*std::max_element(ledger.at("error").begin(), ledger.at("error").end()), 1e-9);
    const double expected = k_swing_speed * soil.cut_section() * k_grain_density * (1.0 - k_porosity) * k_period;
    EXPECT_NEAR(ledger.at("fed_kg").back(), expected, 0.01 * expected);

    const std::vector<Start> starts = starts_of(folder);
    double placed = 0.0;
    const geometry::SolidSearch search(cutter);
    for (const Start& start : starts) {
        placed += sphere_mass(start.diameter, k_grain_density);
        expect_ahead_of_a_blade(start, search, head);
    }
    EXPECT_NEAR(placed + ledger.at("owed_kg").back(), ledger.at("fed_kg").back(), 1e-6 * expected);
    // A blade takes a layer of v_h T / 2 = 4 mm, half a rock: it finds room in one layer of rock ahead of the blade.
    EXPECT_GT(starts.size(), feed.rocks.size() / 2);
    fmt::print("{} of {} rocks placed; fed {:.4f} kg, v_h A_cut rho (1 - n) t = {:.4f} kg, off by {:+.2f} %; owed {:.4f} kg\n",
               starts.size(), feed.rocks.size(), ledger.at("fed_kg").back(), expected,
               100.0 * (ledger.at("fed_kg").back() / expected - 1.0), ledger.at("owed_kg").back());
}

}  // namespace
}  // namespace cutterflow::validation
