/// Solid-body rotation through a sliding interface over 20 turns: nothing is made or lost.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

#include "geometry/base/axis_frame.hpp"
#include "validation/support/annulus_case.hpp"
#include "validation/support/box_case.hpp"
#include "validation/support/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_speed = 2.0 * k_pi;  // [rad/s]
constexpr int k_turns = 20;

struct Continuity {
    double cumulative = 0.0;     ///< sum over time of the room's surplus, over its volume [-]
    double largest_local = 0.0;  ///< of all steps: sum over cells of |surplus| in a step, over the room's volume [-]
};

/// What the solver's log says of continuity.
Continuity read_continuity(const std::filesystem::path& log) {
    std::ifstream stream(log);
    const std::string local = "sum local = ", cumulative = "cumulative = ";
    Continuity continuity;
    int lines = 0;
    for (std::string line; std::getline(stream, line);) {
        const std::size_t at = line.find(local), end = line.find(cumulative);
        if (at == std::string::npos || end == std::string::npos) continue;
        continuity.largest_local = std::max(continuity.largest_local, std::stod(line.substr(at + local.size())));
        continuity.cumulative = std::stod(line.substr(end + cumulative.size()));
        ++lines;
    }
    if (lines == 0) throw std::runtime_error(log.string() + " tells nothing of continuity");
    return continuity;
}

void run(Verification& verification) {
    AnnulusCase annulus;
    annulus.radial_cells = 6;
    annulus.rotor_cells_around = 12;
    annulus.stator_cells_around = 15;
    annulus.inner_speed = annulus.outer_speed = annulus.rotor_speed = k_speed;
    annulus.viscosity = 1e-4;
    annulus.time_step = 1.0 / 80.0;
    annulus.end_time = k_turns;
    annulus.start = [](double radius) { return k_speed * radius; };
    const auto folder = verification.folder("turns");
    write_annulus_case(folder, annulus);
    run_annulus_case(folder);

    const Continuity continuity = read_continuity(folder / "log.cutterFoam");
    verification.at_most("volume made or lost in 20 turns, over the room's", "-", std::abs(continuity.cumulative), 1e-6,
                         {"exact", "648 cells, 1600 steps; 60 faces of the stator on 48 of the rotor", {}});
    verification.at_most("largest sum over cells of |volume made or lost| in a step, over the room's", "-", continuity.largest_local, 1e-6,
                         {"exact", "", {}});
    const AnnulusCells cells = annulus_cells(annulus, annulus.end_time);
    const std::vector<Vec3> velocity = read_vector_field(folder / "20/U", annulus.cell_count());
    double square = 0.0, reference = 0.0;
    for (std::size_t i = 0; i < velocity.size(); ++i) {
        const Vec3 exact = k_speed * Vec3(-cells.centre[i].y(), cells.centre[i].x(), 0.0);
        square += (velocity[i] - exact).squaredNorm() * cells.volume[i];
        reference += exact.squaredNorm() * cells.volume[i];
    }
    verification.at_most("L2 error of velocity after 20 turns, over its L2 norm", "-", std::sqrt(square / reference), 0.01,
                         {"exact", "80 steps a turn", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
