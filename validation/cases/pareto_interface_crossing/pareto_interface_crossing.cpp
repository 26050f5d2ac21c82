/// \file Speed against error of a rock that falls through the turning interface: one option at a time, the others at their defaults.
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/pareto.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/crossing_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_diameter = FallingRock().diameter;
constexpr double k_rpm = 60.0;
// The kernel's reach is 30 mm: the rock begins and ends outside the interface's by as much, and as far from the rim.
constexpr double k_interface = 0.06, k_radius = 0.12, k_height = 0.08, k_start = 0.09, k_fall = 0.18;  // [m]
constexpr int k_pictures = 16;

struct Options {
    double rock_over_cell = 1.0;
    double travel = 0.25;  ///< of a cell, per step
    double gamma = 1.0;
    double dem_step = 0.1;  ///< of the shortest contact time
    double youngs_modulus = 1e8;
    std::string convection = "linearUpwindV grad(U)";
};

/// The tank with cells of about this size [m] at the interface; its two sides differ.
TankMesh tank(double dx) {
    const auto cells = [dx](double length) { return std::max(1, static_cast<int>(std::lround(length / dx))); };
    const double quarter = 0.5 * k_pi * k_interface;
    TankMesh mesh;
    mesh.radius_interface = k_interface;
    mesh.radius = k_radius;
    mesh.height = k_height;
    mesh.cells_around_quarter = cells(quarter);
    mesh.stator_cells_around_quarter = cells(1.2 * quarter);
    mesh.cells_in_rotor_ring = cells(0.5 * k_interface);
    mesh.cells_in_stator = cells(k_radius - k_interface);
    mesh.cells_high = cells(k_height);
    return mesh;
}

/// Time [s] in which the rock falls a length [m].
double time_to_fall(double length) {
    const double step = 1e-4;
    double time = 0.0, fallen = 0.0;
    for (; fallen < length; time += step) fallen += step * crossing_velocity(time).norm();
    return time;
}

Trial cross(const std::filesystem::path& folder, const Options& options) {
    const double dx = k_diameter / options.rock_over_cell;
    CrossingCase crossing;
    crossing.mesh = tank(dx);
    crossing.rpm = k_rpm;
    crossing.start = k_start;
    crossing.end_time = time_to_fall(k_fall);
    crossing.picture_interval = crossing.end_time / k_pictures;
    crossing.time_step = crossing.picture_interval / std::ceil(k_fall / k_pictures / (options.travel * dx));
    BoxCase box = crossing_box(crossing);
    box.convection = options.convection;
    box.kernel = fmt::format("gamma {}; minWidthInCells 1.5; maxSolidFraction 0.7;", options.gamma);
    box.contact = pareto_contact(options.youngs_modulus, options.dem_step);
    write_box_case(folder, box);
    const double core_s = require_child(meshing::foam_command(folder, cutter_foam())).core_s;
    return {core_s, rms_error_of_crossing(all_rocks(folder))};
}

void run(Verification& verification) {
    if (!verification.wants(Effort::longest)) return;
    verification.table({"Options without a chart",
                        {"option", "why"},
                        {{"coupling interval",
                          "The solver has no such option: fluid and rock exchange momentum in every fluid step, so that what "
                          "the fluid loses in a step is what the rock receives in it. The chart of the time step is that of "
                          "the coupling interval too."}}});
    const Trial standard =
        run_pareto<Options>(verification, one_rock_sweeps<Options>({0.5, 1.5, 2.0}), "RMS error of the velocity, m/s", cross);
    verification.at_most("RMS error of the velocity with the defaults", "m/s", standard.error, 0.01,
                         {"NieuwboerVanRheeKeetels2023", "against the rock's own force balance; 10 mm, 2650 kg/m3, d/dx = 1, 60 rpm", {}});
    verification.report("core seconds with the defaults", "-", standard.core_s, {}, {"exact", "whole run on one core", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
