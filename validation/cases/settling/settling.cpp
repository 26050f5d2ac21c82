/// One rock settling in still water reaches the terminal speed of its own force balance, whatever the ratio of rock to cell: the kernels
/// must hand it the flow that it does not disturb itself. (seeds T0-02: 10 mm, 2650 kg/m3, 0.736 m/s)
#include <cmath>

#include <fmt/format.h>

#include "validation/support/box_case.hpp"
#include "validation/support/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

/// Terminal speed [m/s] of a sphere in still water by the drag of Brown and Lawler (2003), solved here anew, apart from the solver's closures.
double terminal_speed(double diameter, double density, const BoxCase& water) {
    double speed = 0.1;
    for (int i = 0; i < 200; ++i) {
        const double re = speed * diameter / water.viscosity;
        const double drag = 24.0 / re * (1.0 + 0.150 * std::pow(re, 0.681)) + 0.407 / (1.0 + 8710.0 / re);
        speed = std::sqrt(4.0 / 3.0 * (density / water.density - 1.0) * water.gravity.norm() * diameter / drag);
    }
    return speed;
}

struct Room {
    double ratio;   ///< rock diameter over cell size
    double half;    ///< half width [m]
    double height;  ///< [m]
    double fall;    ///< distance until the speed is read [m]
    int ranks;
    Effort effort;
};

void settle(Verification& verification, const Room& room) {
    const double diameter = 0.010;
    BoxCase box;
    const int across = static_cast<int>(std::lround(2.0 * room.half * room.ratio / diameter));
    const double dx = 2.0 * room.half / across;
    const int along = static_cast<int>(std::lround(room.height / dx));
    box.lower = Vec3(-room.half, -room.half, 0.0);
    box.upper = Vec3(room.half, room.half, along * dx);
    box.cells = {across, across, along};
    const double expected = terminal_speed(diameter, 2650.0, box);

    // Released off every symmetry of the mesh and 5 % slow: differences decay within about 0.07 s, so after the shortest fall (0.19 s) less
    // than 0.4 % of the speed is left of it, while nine tenths of what a wrong balance of forces does have shown.
    const double below_top = 0.06;
    box.rocks = {{1, 0.0, Vec3(0.0013, -0.0021, box.upper.z() - below_top), diameter, 2650.0, 0.95 * expected * Vec3(0.0, 0.0, -1.0)}};
    box.time_step = 1e-3;
    box.end_time = std::round(room.fall / expected / box.time_step) * box.time_step;
    const auto folder = verification.folder(fmt::format("ratio_{}", room.ratio));
    write_box_case(folder, box);
    run_cutter_foam(folder, room.ranks);
    verification.relative(fmt::format("terminal speed at d/dx = {}", room.ratio), "m/s", -last_rocks(folder).velocity.at(0).z(), expected,
                          0.014, {"NieuwboerVanRheeKeetels2023", "10 mm, 2650 kg/m3 in water of 20 C; the reference is Brown and Lawler's drag, solved", 0.005});
}

void run(Verification& verification) {
    for (const Room& room : {Room{0.7, 0.14, 0.45, 0.30, 1, Effort::fast}, Room{1.0, 0.12, 0.40, 0.26, 1, Effort::standard},
                             Room{2.0, 0.06, 0.32, 0.22, 1, Effort::standard}, Room{5.0, 0.04, 0.22, 0.14, 2, Effort::standard}})
        if (verification.wants(room.effort)) settle(verification, room);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
