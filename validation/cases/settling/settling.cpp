/// One rock settling in still water reaches the terminal speed of its own force balance, whatever the ratio of rock to cell: the kernels
/// must sample the undisturbed flow. [NieuwboerVanRheeKeetels2023]
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/falling_rock.hpp"
#include "validation/harness/scenes/study_numerics.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

struct Room {
    double diameter;  ///< of the rock [m]
    double ratio;     ///< rock diameter over cell size
    double half;      ///< half width [diameters]
    double height;    ///< [diameters]
    Effort effort;
    bool as_study = false;  ///< schemes, solvers and correctors of a study
    bool shell = false;     ///< samples from a shell, kernel.sampling quadratic
};

constexpr double k_fall = 14.0;            // distance until the speed is read [diameters]
constexpr double k_long_tolerance = 1e-6;  // of the pressure in the largest rooms: as exact, to nine digits of the speed, as 1e-9
constexpr double k_start_share = 0.95;     // of the terminal speed

/// Three times the largest error of the speed that rooms of this ratio and sampling had when the bound was set.
double regression_bound(const Room& room) {
    if (room.ratio <= 1.0) return room.shell ? 2e-4 : 0.0027;
    if (room.ratio <= 2.0) return room.shell ? 0.0042 : 0.007;
    return 0.009;
}

void settle(Verification& verification, const Room& room) {
    FallingRock rock;
    rock.diameter = room.diameter;
    const double expected = terminal_slip(rock);
    BoxCase box;
    const double half = room.half * room.diameter;
    const int across = static_cast<int>(std::lround(2.0 * room.half * room.ratio));
    const double dx = 2.0 * half / across;
    const int along = static_cast<int>(std::lround(room.height * room.diameter / dx));
    box.lower = Vec3(-half, -half, 0.0);
    box.upper = Vec3(half, half, along * dx);
    box.cells = {across, across, along};

    // Released off every symmetry of the mesh and 5 % slow. What is left of the 5 % when the speed is read is in the reference.
    const Vec3 place(0.13 * room.diameter, -0.21 * room.diameter, box.upper.z() - 0.5 * (room.height - k_fall) * room.diameter);
    box.rocks = {{1, 0.0, place, room.diameter, rock.density, k_start_share * expected * Vec3(0.0, 0.0, -1.0)}};
    const double step = std::min(2.5e-3, std::max(0.2 * dx, 0.05 * room.diameter) / expected);
    const double steps = std::ceil(k_fall * room.diameter / expected / step);
    box.time_step = std::round(1e7 * k_fall * room.diameter / expected / steps) * 1e-7;
    box.end_time = steps * box.time_step;
    if (room.effort == Effort::longest) box.pressure_tolerance = k_long_tolerance;
    if (room.shell) box.kernel += " sampling quadratic;";
    const auto folder = verification.folder(
        fmt::format("{:g}mm_ratio_{:g}{}{}", 1e3 * room.diameter, room.ratio, room.as_study ? "_study" : "", room.shell ? "_shell" : ""));
    write_box_case(folder, box);
    if (room.as_study) use_study_numerics(folder);
    run_cutter_foam(folder);
    const std::string quantity = fmt::format("speed of {:g} mm rock at d/dx = {:g}{}{}", 1e3 * room.diameter, room.ratio,
                                             room.as_study ? ", numerics of a study" : "", room.shell ? ", kernel.sampling quadratic" : "");
    const double speed = -last_rocks(folder).velocity.at(0).z();
    const double reference = fall_speed(rock, k_start_share * expected, box.end_time);
    verification.relative(quantity, "m/s", speed, reference, 0.014,
                          {"NieuwboerVanRheeKeetels2023",
                           fmt::format("after {:g} diameters; terminal {:.4f} m/s; {} cells", k_fall, expected, box.cell_count()), 0.005});
    verification.relative(quantity + ", as good as it was", "m/s", speed, reference, regression_bound(room),
                          {"exact", "bound: three times the largest error of this ratio in 2026-11", {}});
    Room shell = room;
    shell.shell = true;
    if (regression_bound(shell) < regression_bound(room) && verification.wants(Effort::standard))
        verification.relative(quantity + ", within the bound of kernel.sampling quadratic", "m/s", speed, reference,
                              regression_bound(shell), {"exact", "what was asked while the shell was the default", {}});
}

void run(Verification& verification) {
    for (const Room& room : {Room{0.01, 0.2, 30.0, 60.0, Effort::fast},
                             Room{0.01, 0.5, 16.0, 44.0, Effort::fast},
                             Room{0.01, 1.0, 10.0, 32.0, Effort::fast},
                             Room{0.01, 2.0, 6.0, 26.0, Effort::standard},
                             Room{0.01, 2.0, 6.0, 26.0, Effort::standard, true},
                             Room{0.01, 3.5, 4.0, 22.0, Effort::standard},
                             Room{0.01, 0.5, 16.0, 44.0, Effort::standard, false, true},
                             Room{0.01, 1.0, 10.0, 32.0, Effort::standard, false, true},
                             Room{0.01, 2.0, 6.0, 26.0, Effort::standard, false, true},
                             Room{0.01, 2.0, 6.0, 26.0, Effort::standard, true, true},
                             Room{0.01, 3.5, 4.0, 22.0, Effort::standard, false, true},
                             Room{0.01, 5.0, 4.0, 22.0, Effort::longest},
                             Room{0.01, 8.0, 4.0, 22.0, Effort::longest},
                             Room{0.02, 0.2, 30.0, 60.0, Effort::standard},
                             Room{0.02, 0.5, 16.0, 44.0, Effort::standard},
                             Room{0.02, 1.0, 10.0, 32.0, Effort::standard},
                             Room{0.02, 2.0, 6.0, 26.0, Effort::standard},
                             Room{0.02, 3.5, 4.0, 22.0, Effort::longest},
                             Room{0.02, 5.0, 4.0, 22.0, Effort::longest},
                             Room{0.02, 8.0, 4.0, 22.0, Effort::longest}})
        if (verification.wants(room.effort)) settle(verification, room);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
