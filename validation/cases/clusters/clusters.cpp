/// One rock that falls past clusters of cells: how much its speed fluctuates, by the map between rock and cells.
/// [WasserfallCoetzeeMeyer2024]
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/sphere.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_diameter = 0.032, k_sphericity = 0.65, k_rock_density = 2650.0;  // [m], [-], [kg/m3]
constexpr double k_cell = 0.03;                                                     // [m]
constexpr double k_start = 1.38, k_from = 1.08, k_to = 0.36;                        // heights [m]
constexpr double k_gate_spacing = 1e-3;                                             // [m]
constexpr double k_off_corner = 0.395 - 0.45;                                       // of the fall, from the middle of the box [m]
constexpr double k_end = 2.1;                                                       // [s]
constexpr const char* k_paper = "WasserfallCoetzeeMeyer2024";

/// Speed [m/s] at which the drag of Haider and Levenspiel carries the rock's weight in water. [HaiderLevenspiel1989]
double terminal_speed(const BoxCase& water) {
    const double psi = k_sphericity, a = 8.1716 * std::exp(-4.0655 * psi), b = 0.0964 + 0.5565 * psi, c = 73.69 * std::exp(-5.0748 * psi),
                 d = 5.378 * std::exp(6.2122 * psi);
    double speed = 0.1;
    for (int i = 0; i < 200; ++i) {
        const double re = speed * k_diameter / water.viscosity;
        const double drag = 24.0 / re * (1.0 + a * std::pow(re, b)) + c / (1.0 + d / re);
        speed = std::sqrt(4.0 / 3.0 * (k_rock_density / water.density - 1.0) * water.gravity.norm() * k_diameter / drag);
    }
    return speed;
}

/// Speed over time while the rock falls from `k_from` to `k_to` [m/s].
struct Fall {
    double mean = 0.0, rms = 0.0;  ///< rms of the difference from the mean
    double least = std::numeric_limits<double>::infinity(), largest = 0.0;
    double volume_error = 0.0;  ///< largest of the run [-]
};

std::string gates() {
    std::string text = "gates (";
    const int count = static_cast<int>(std::lround((k_from - k_to) / k_gate_spacing));
    for (int i = 0; i <= count; ++i) {
        const double z = k_to + i * k_gate_spacing;
        text += fmt::format(" {{ name z{}; lower (-0.45 -0.45 {:g}); upper (0.45 0.45 {:g}); normal (0 0 -1); }}", i, z, z);
    }
    return text + " );";
}

BoxCase still_water(const std::string& kernel, double step) {
    BoxCase box;
    box.lower = Vec3(-0.45, -0.45, 0.0);
    box.upper = Vec3(0.45, 0.45, 1.5);
    box.cells = {30, 30, 50};
    box.kernel = kernel;
    box.closures = fmt::format("drag haider_levenspiel; hindrance none; sphericity {:g};", k_sphericity);
    box.time_step = step;
    box.end_time = k_end;
    box.pressure_tolerance = 1e-7;
    box.rock_leaves_at_bottom = true;
    box.extra = gates();
    box.rocks = {{1, 0.0, Vec3(k_off_corner, k_off_corner, k_start), k_diameter, k_rock_density, Vec3(0, 0, -terminal_speed(box))}};
    return box;
}

/// Moments over time of what the gates saw, by trapezoids between them.
Fall read_fall(const std::filesystem::path& folder) {
    const auto gates = read_columns(folder / "postProcessing/rock/0/gates.csv");
    std::vector<std::pair<double, double>> rows;  // time, speed
    for (std::size_t k = 0; k < gates.at("time_s").size(); ++k) rows.emplace_back(gates.at("time_s")[k], -gates.at("vz_m_s")[k]);
    std::sort(rows.begin(), rows.end());
    Fall fall;
    double time = 0.0, first = 0.0, second = 0.0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const double before = k == 0 ? rows[k].first : rows[k - 1].first, after = k + 1 == rows.size() ? rows[k].first : rows[k + 1].first;
        const double weight = 0.5 * (after - before), speed = rows[k].second;
        time += weight, first += weight * speed, second += weight * speed * speed;
        fall.least = std::min(fall.least, speed);
        fall.largest = larger(fall.largest, speed);
    }
    fall.mean = first / time;
    fall.rms = std::sqrt(larger(0.0, second / time - fall.mean * fall.mean));
    const auto balance = read_columns(folder / "postProcessing/balance/0/balance.csv");
    fall.volume_error = largest(balance.at("solid_volume_error"));
    return fall;
}

/// A map and what it did.
struct Trial {
    std::string label;
    std::string kernel;
    double spread;  ///< side of the cube of equal spread [m]
    bool standard = false;
    Fall fall{};
};

void run_trial(Verification& verification, Trial& trial, double step) {
    const auto folder = verification.folder(fmt::format("{}_{:g}_ms", trial.label, 1e3 * step));
    write_box_case(folder, still_water(trial.kernel, step));
    run_cutter_foam(folder);
    trial.fall = read_fall(folder);
}

/// Speed [m/s] that a cluster of side `length` gains while the rock passes it at its terminal speed.
double gained_speed(const BoxCase& water, double length) {
    return (k_rock_density / water.density - 1.0) * water.gravity.norm() * sphere_volume(k_diameter) /
           (terminal_speed(water) * length * length);
}

void show(Verification& verification, const std::vector<Trial>& trials) {
    ExhibitTable table{"Speed of the rock, m/s", {"map", "mean", "rms", "least", "largest"}, {}};
    Chart chart{"Map between rock and cells", "side of the cube of equal spread, mm", "rms of the speed, m/s", {}};
    for (const Trial& trial : trials) {
        const Fall& fall = trial.fall;
        table.rows.push_back({trial.label, fmt::format("{:.3f}", fall.mean), fmt::format("{:.4f}", fall.rms),
                              fmt::format("{:.3f}", fall.least), fmt::format("{:.3f}", fall.largest)});
        chart.points.push_back({trial.label, 1e3 * trial.spread, fall.rms, trial.standard});
    }
    verification.table(table);
    verification.chart(chart);
}

void run(Verification& verification) {
    if (!verification.wants(Effort::standard)) return;
    constexpr double step = 7.5e-3;
    const BoxCase water;
    const double terminal = terminal_speed(water);
    std::vector<Trial> trials;
    for (const int length : {60, 90, 120})
        trials.push_back({fmt::format("cluster_{}", length), fmt::format("map cluster; clusterSize {:g};", 1e-3 * length), 1e-3 * length});
    trials.push_back({"gaussian", "map gaussian;", 2.0 * std::sqrt(k_pi) * 1.5 * k_cell, true});
    double volume_error = 0.0;
    for (Trial& trial : trials) {
        run_trial(verification, trial, step);
        const std::string rms = "rms of the speed, " + trial.label, mean = "mean speed, " + trial.label;
        if (trial.standard) {
            verification.at_most(rms, "m/s", trial.fall.rms, 0.01, {k_paper, "the map of a study", {}});
            verification.relative(mean, "m/s", trial.fall.mean, terminal, 0.014,
                                  {"HaiderLevenspiel1989", "against the terminal speed of the drag law; the map of a study", {}});
        } else {
            verification.report(
                rms, "m/s", trial.fall.rms, {},
                {k_paper, fmt::format("a cluster gains {:.3f} m/s while it is passed", gained_speed(water, trial.spread)), {}});
            verification.report(mean, "m/s", trial.fall.mean, terminal, {k_paper, "against the terminal speed of the drag law", {}});
        }
        volume_error = larger(volume_error, trial.fall.volume_error);
    }
    const auto ratio = [&](std::size_t longer, std::size_t shorter) { return trials[longer].fall.rms / trials[shorter].fall.rms; };
    verification.at_most("rms of the speed at clusters of 120 mm over that at 60 mm", "-", ratio(2, 0), 0.5,
                         {k_paper, "32 mm, sphericity 0.65; expected about a quarter", {}});
    verification.at_most("rms of the speed at clusters of 90 mm over that at 60 mm", "-", ratio(1, 0), 1.0,
                         {k_paper, "the longer the clusters the less", {}});
    verification.at_most("rms of the speed at clusters of 120 mm over that at 90 mm", "-", ratio(2, 1), 1.0,
                         {k_paper, "the longer the clusters the less", {}});
    verification.at_most("largest error of the solid volume", "-", volume_error, 1e-12, {"exact", "over all steps and maps", {}});
    show(verification, trials);
    if (!verification.wants(Effort::longest)) return;
    for (Trial trial : {trials.front(), trials.back()}) {
        const double coarse = trial.fall.rms;
        run_trial(verification, trial, 0.5 * step);
        verification.report(fmt::format("rms of the speed at half the step, {}", trial.label), "m/s", trial.fall.rms, coarse,
                            {k_paper, "against that at the full step", {}});
    }
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
