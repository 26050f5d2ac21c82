/// Total momentum of rock and water in a closed room, from their states alone.
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/run_files.hpp"
#include "solver/coupling/checkpoint.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/momentum_carried.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/study_numerics.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr double k_diameter = 0.02, k_spacing = 0.026;                                 // of the rocks [m]
constexpr double k_mass = 2650.0 * k_pi / 6.0 * k_diameter * k_diameter * k_diameter;  // of a rock [kg]
constexpr double k_speed = 1.0;                                                        // [m/s]
constexpr double k_drift = 1e-5;                                                       // the requirement
constexpr double k_drift_before = 1e-7, k_error_before = 1e-9;                         // as good as they were
constexpr double k_no_boundary = 1e-9;                                                 // rounding, of a room without any
constexpr int k_side = 4;                                                              // rocks along an edge of the cloud
constexpr double k_interval = 0.01;                                                    // between states [s]
constexpr int k_states = 6;
constexpr double k_start = k_interval + 1e-6;  // what is owed of the sudden start has gone by halves [s]

enum class Turbulence { none, realizable };

/// Periodic along x; along y and z slip walls, or periodic too.
std::string mesh_of(const BoxCase& box, bool walls) {
    const Vec3 &a = box.lower, &b = box.upper;
    const auto pair = [](const std::string& axis, const char* low, const char* high) {
        return fmt::format(
            "    {0}_min {{ type cyclic; neighbourPatch {0}_max; faces ({1}); }}\n"
            "    {0}_max {{ type cyclic; neighbourPatch {0}_min; faces ({2}); }}\n",
            axis, low, high);
    };
    const std::string sides = walls ? "    sides { type wall; faces ((0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7)); }\n"
                                    : pair("y", "(0 1 5 4)", "(3 7 6 2)") + pair("z", "(0 3 2 1)", "(4 5 6 7)");
    return fmt::format(
        "scale 1;\nvertices (({0} {1} {2}) ({3} {1} {2}) ({3} {4} {2}) ({0} {4} {2}) ({0} {1} {5}) ({3} {1} {5}) ({3} {4} {5}) ({0} {4} "
        "{5}));\nblocks ( hex (0 1 2 3 4 5 6 7) ({6} {7} {8}) simpleGrading (1 1 1) );\nedges ();\nboundary\n(\n{9}{10});\n"
        "mergePatchPairs ();",
        a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), box.cells[0], box.cells[1], box.cells[2], pair("x", "(0 4 7 3)", "(1 2 6 5)"), sides);
}

/// A cloud of rock shot along x into water at rest, without weight.
BoxCase cloud(double time_step, bool walls) {
    BoxCase box;
    box.lower = Vec3(0.0, -0.1, -0.1);
    box.upper = Vec3(0.32, 0.1, 0.1);
    box.cells = {32, 20, 20};
    box.mesh = mesh_of(box, walls);
    box.gravity = Vec3::Zero();
    box.time_step = time_step;
    box.end_time = k_states * k_interval;
    box.write_interval = k_interval;
    box.extra = fmt::format("checkpoint {{ interval {}; keep {}; }}", k_interval, k_states);
    for (int i = 0; i < k_side * k_side * k_side; ++i) {
        const Vec3 place(i % k_side, i / k_side % k_side, i / (k_side * k_side));
        const Vec3 centre = Vec3(0.11, 0.0, 0.0) + k_spacing * (place - Vec3::Constant(0.5 * (k_side - 1)));
        box.rocks.push_back({i + 1, 0.0, centre, k_diameter, 2650.0, Vec3(k_speed, 0.0, 0.0)});
    }
    return box;
}

/// Momentum along x [N s].
struct Momentum {
    double rock = 0.0, water = 0.0, carried = 0.0;
    double total() const { return rock + water + carried; }
};

Momentum momentum_of(const BoxCase& box, const fs::path& folder, const RockSnapshot& snapshot) {
    Momentum momentum;
    for (const Vec3& velocity : snapshot.velocity) momentum.rock += k_mass * velocity.x();
    const std::string time = fmt::format("{:g}", snapshot.time);
    const std::vector<Vec3> velocity = read_vector_field(folder / time / "U", box.cell_count());
    const std::vector<double> alpha = read_scalar_field(folder / time / "voidFraction", box.cell_count());
    std::vector<std::int64_t> ids(box.cell_count());
    std::iota(ids.begin(), ids.end(), std::int64_t{0});
    const std::vector<Vec3> carry = coupling::read_carry(folder / names::checkpoints / time, 1, ids);
    const double cell_mass = box.density * std::pow(box.cell_size(), 3);
    for (std::size_t c = 0; c < box.cell_count(); ++c) {
        momentum.water += cell_mass * alpha[c] * velocity[c].x();
        momentum.carried += cell_mass * carry[c].x();
    }
    return momentum;
}

/// Of one run, over what rock has handed over since the start.
struct Drift {
    double total = 0.0;       ///< largest change of rock, water and carry
    double owed = 0.0;        ///< change of rock and water alone, at the end
    double of_the_run = 0.0;  ///< largest momentum_error of balance.csv: of one step, over the step's turnover
    double carried = 0.0;     ///< largest momentum_carried after k_start, likewise
    double carried_at_start = 0.0;
    double boundary = 0.0;     ///< largest momentum_boundary, likewise
    double handed_over = 0.0;  ///< share of the rock's momentum, at the end
};

Drift drift_of(const BoxCase& box, const fs::path& folder) {
    const double start = k_mass * static_cast<double>(box.rocks.size()) * k_speed;
    Drift drift;
    for (const RockSnapshot& snapshot : all_rocks(folder)) {
        const Momentum now = momentum_of(box, folder, snapshot);
        const double exchanged = start - now.rock;
        drift.total = larger(drift.total, std::abs(now.total() - start) / exchanged);
        drift.owed = std::abs(now.rock + now.water - start) / exchanged;
        drift.handed_over = exchanged / start;
    }
    const auto balance = read_columns(folder / "postProcessing/balance/0/balance.csv");
    drift.of_the_run = largest(balance.at("momentum_error"));
    const std::vector<double>&time = balance.at("time_s"), &carried = balance.at("momentum_carried");
    drift.carried_at_start = largest(carried);
    for (std::size_t i = 0; i < time.size(); ++i)
        if (time[i] > k_start) drift.carried = larger(drift.carried, carried[i]);
    drift.boundary = largest(balance.at("momentum_boundary"));
    return drift;
}

Drift drift_at(Verification& verification, double time_step, Turbulence turbulence) {
    const bool turbulent = turbulence == Turbulence::realizable;
    const BoxCase box = cloud(time_step, !turbulent);
    const fs::path folder = verification.folder(fmt::format("step_{:g}{}", time_step, turbulent ? "_turbulent" : ""));
    write_box_case(folder, box);
    use_study_numerics(folder);
    if (turbulent) use_study_turbulence(folder, k_speed, k_diameter);
    run_cutter_foam(folder);
    const Drift drift = drift_of(box, folder);
    const std::string with = fmt::format(", time step {:g} ms{}", 1e3 * time_step, turbulent ? ", turbulent" : "");
    const std::string total = "drift of the momentum of rock, water and carry, over what was exchanged" + with;
    const std::string of_the_run = "largest momentum_error of balance.csv" + with;
    verification.at_most(total, "-", drift.total, k_drift, {"exact", "64 rocks of 20 mm, d/dx = 2, 60 ms, from the written states", {}});
    verification.at_most(total + ", as good as it was", "-", drift.total, k_drift_before,
                         {"exact", "bound: nine times the largest value in 2026-11", {}});
    verification.at_most(of_the_run, "-", drift.of_the_run, k_drift, {"exact", "", {}});
    verification.at_most(of_the_run + ", as good as it was", "-", drift.of_the_run, k_error_before,
                         {"exact", "bound: some 80 times the largest value in 2026-11", {}});
    verification.at_most("largest momentum_carried of balance.csv after 10 ms" + with, "-", drift.carried, k_most_carried,
                         {"exact", "less than a step's exchange is owed where the water takes two thirds of it", {}});
    verification.report("largest momentum_carried of balance.csv, at the start" + with, "-", drift.carried_at_start, {},
                        {"exact", "rock that sets off at once pushes the water aside in one step, however short", {}});
    if (turbulent)
        verification.at_most("largest momentum_boundary of balance.csv, in a room without boundaries" + with, "-", drift.boundary,
                             k_no_boundary, {"exact", "0; a water that blames a boundary for what it did not take has some 0.8", {}});
    return drift;
}

void run(Verification& verification) {
    std::vector<Drift> drifts;
    for (const double time_step : {2e-3, 1e-3, 5e-4}) drifts.push_back(drift_at(verification, time_step, Turbulence::none));
    drift_at(verification, 1e-3, Turbulence::realizable);
    for (std::size_t i = 0; i < drifts.size(); ++i)
        verification.report(fmt::format("owed to the water at the end, over what was exchanged, time step {:g} ms", 2.0 / (1 << i)), "-",
                            drifts[i].owed, {},
                            {"exact", fmt::format("rock has handed over {:.6f} of its momentum", drifts[i].handed_over), {}});
    verification.at_least("order in the time step of what is owed", "-", std::log2(drifts[1].owed / drifts[2].owed), 1.8,
                          {"exact", "1 and 0.5 ms; the error of a step is of second order, and carry holds that of about two steps", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
