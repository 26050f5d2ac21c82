/// Flux balance of a closed box in which a rock falls, plane by plane.
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/study_numerics.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

namespace fs = std::filesystem;

constexpr double k_diameter = 0.010;

/// Upward flux of fluid through each level of faces between layers of cells [m3/s], from one written time.
std::vector<double> level_fluxes(const BoxCase& box, const fs::path& time) {
    const int nx = box.cells[0], ny = box.cells[1], nz = box.cells[2];
    const std::vector<double> alpha = read_scalar_field(time / "voidFraction", box.cell_count());
    const std::size_t faces = static_cast<std::size_t>((nx - 1) * ny * nz + nx * (ny - 1) * nz + nx * ny * (nz - 1));
    const std::vector<double> phi = read_scalar_field(time / "phi", faces);
    std::vector<double> flux(nz - 1, 0.0);
    std::size_t face = 0;  // OpenFOAM numbers inner faces by their lower cell, then by the other one: x, y, z
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                if (i + 1 < nx) ++face;
                if (j + 1 < ny) ++face;
                if (k + 1 == nz) continue;
                const std::size_t cell = static_cast<std::size_t>((k * ny + j) * nx + i);
                flux[k] += 0.5 * (alpha[cell] + alpha[cell + nx * ny]) * phi[face++];
            }
    return flux;
}

/// Solid volume below each level [m3].
std::vector<double> solid_below(const BoxCase& box, const fs::path& time) {
    const std::vector<double> alpha = read_scalar_field(time / "voidFraction", box.cell_count());
    const std::size_t layer = static_cast<std::size_t>(box.cells[0]) * box.cells[1];
    const double cell = std::pow(box.cell_size(), 3);
    std::vector<double> below;
    double sum = 0.0;
    for (int k = 0; k + 1 < box.cells[2]; ++k) {
        for (std::size_t c = 0; c < layer; ++c) sum += (1.0 - alpha[k * layer + c]) * cell;
        below.push_back(sum);
    }
    return below;
}

/// \param as_study  with the schemes, solvers and correctors of a study
void fall(Verification& verification, bool as_study) {
    BoxCase box;
    box.lower = Vec3(-0.04, -0.04, 0.0);
    box.upper = Vec3(0.04, 0.04, 0.18);
    box.cells = {16, 16, 36};
    box.time_step = 1e-3;
    box.end_time = 0.12;
    box.write_interval = box.time_step;
    box.rocks = {{1, 0.0, Vec3(0.0013, -0.0021, 0.13), k_diameter, 2650.0, Vec3(0.0, 0.0, -0.7)}};
    const auto folder = verification.folder(as_study ? "fall_study" : "fall");
    write_box_case(folder, box);
    if (as_study) use_study_numerics(folder);
    run_cutter_foam(folder);

    const double volume = k_pi / 6.0 * std::pow(k_diameter, 3);
    const int steps = static_cast<int>(std::lround(box.end_time / box.time_step));
    const int middle = box.cells[2] / 2 - 1;
    double worst = 0.0, passed = 0.0, largest = 0.0;
    std::vector<double> before, at_first;
    for (int step = 1; step <= steps; ++step) {
        const fs::path time = folder / fmt::format("{:g}", step * box.time_step);
        const std::vector<double> flux = level_fluxes(box, time), below = solid_below(box, time);
        if (step == 1) at_first = below;
        for (std::size_t level = 0; step > 1 && level < flux.size(); ++level) {
            worst = larger(worst, std::abs(flux[level] - (below[level] - before[level]) / box.time_step));
            largest = larger(largest, std::abs(flux[level]));
        }
        if (step > 1) passed += flux[middle] * box.time_step;
        before = below;
    }
    const std::string with = as_study ? ", numerics of a study" : "";
    verification.at_most("flux through any plane in any step, less the rate of solid volume below it, over the largest flux" + with, "-",
                         worst / largest, 1e-6, {"exact", "one rock, d/dx = 2, 119 steps, 35 planes", {}});
    verification.relative("solid volume that passed the middle plane" + with, "m3", before[middle] - at_first[middle], volume, 1e-6,
                          {"exact", "the kernel's reach is 30 mm: the rock begins 40 mm above the plane and ends as far below", {}});
    verification.relative("water that went up through the middle plane meanwhile" + with, "m3", passed, volume, 1e-6, {"exact", "", {}});
}

void run(Verification& verification) {
    fall(verification, false);
    if (verification.wants(Effort::standard)) fall(verification, true);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
