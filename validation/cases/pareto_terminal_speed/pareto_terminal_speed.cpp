/// \file Speed against error of one sinking rock: one option at a time, the others at their defaults.
#include <cmath>

#include <fmt/format.h>

#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/pareto.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_diameter = 0.010, k_density = 2650.0;
constexpr double k_width = 0.06, k_height = 0.24, k_below_top = 0.05, k_fall = 0.15;  // [m]

struct Options {
    double rock_over_cell = 2.0;
    double travel = 0.25;  ///< of a cell, per step
    double gamma = 1.0;
    double dem_step = 0.1;  ///< of the shortest contact time
    double youngs_modulus = 1e8;
    std::string convection = "linearUpwindV grad(U)";
};

double terminal_speed(const BoxCase& water) {
    double speed = 0.1;
    for (int i = 0; i < 200; ++i) {
        const double re = speed * k_diameter / water.viscosity;
        const double drag = 24.0 / re * (1.0 + 0.150 * std::pow(re, 0.681)) + 0.407 / (1.0 + 8710.0 / re);
        speed = std::sqrt(4.0 / 3.0 * (k_density / water.density - 1.0) * water.gravity.norm() * k_diameter / drag);
    }
    return speed;
}

Trial fall(const std::filesystem::path& folder, const Options& options) {
    BoxCase box;
    const int across = static_cast<int>(std::lround(k_width * options.rock_over_cell / k_diameter));
    const double dx = k_width / across;
    const int along = static_cast<int>(std::lround(k_height / dx));
    box.lower = Vec3(-0.5 * k_width, -0.5 * k_width, 0.0);
    box.upper = Vec3(0.5 * k_width, 0.5 * k_width, along * dx);
    box.cells = {across, across, along};
    box.convection = options.convection;
    box.kernel = fmt::format("gamma {}; minWidthInCells 1.5; maxSolidFraction 0.7;", options.gamma);
    box.contact = pareto_contact(options.youngs_modulus, options.dem_step);
    const double expected = terminal_speed(box);
    box.rocks = {{1, 0.0, Vec3(0.0013, -0.0021, box.upper.z() - k_below_top), k_diameter, k_density, Vec3(0, 0, -0.95 * expected)}};
    const double fall_time = k_fall / expected;
    box.time_step = fall_time / std::ceil(fall_time * expected / (options.travel * dx));
    box.end_time = fall_time;
    write_box_case(folder, box);
    const double core_s = require_child(meshing::foam_command(folder, cutter_foam())).core_s;
    return {core_s, 100.0 * std::abs(-last_rocks(folder).velocity.at(0).z() / expected - 1.0)};
}

void run(Verification& verification) {
    if (!verification.wants(Effort::longest)) return;
    const Trial standard =
        run_pareto<Options>(verification, one_rock_sweeps<Options>({0.5, 1.0, 3.0}), "error of the terminal speed, %", fall);
    verification.at_most("error of the terminal speed with the defaults", "%", standard.error, 1.4,
                         {"NieuwboerVanRheeKeetels2023", "10 mm, 2650 kg/m3, d/dx = 2", 0.5});
    verification.report("core seconds with the defaults", "-", standard.core_s, {}, {"exact", "whole run on one core", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
