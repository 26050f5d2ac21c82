/// A rock let go from rest: weight, buoyancy and added mass set its first acceleration.
#include <fmt/format.h>

#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/falling_rock.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

void let_go(Verification& verification, double cells_per_diameter) {
    FallingRock rock;
    rock.diameter = 0.02;
    BoxCase box;
    const int across = 2 * static_cast<int>(6.0 * cells_per_diameter);
    box.lower = Vec3(-0.12, -0.12, -0.12);
    box.upper = Vec3(0.12, 0.12, 0.12);
    box.cells = {across, across, across};
    box.rocks = {{1, 0.0, Vec3(0.0013, -0.0021, 0.0007), rock.diameter, rock.density, Vec3::Zero()}};
    box.time_step = 1e-3;
    box.end_time = 0.02;
    const auto folder = verification.folder(fmt::format("ratio_{}", cells_per_diameter));
    write_box_case(folder, box);
    run_cutter_foam(folder);
    const double speed = -last_rocks(folder).velocity.at(0).z();
    verification.relative(
        fmt::format("speed after 0.02 s at d/dx = {}", cells_per_diameter), "m/s", speed, fall_speed(rock, 0.0, box.end_time), 0.001,
        {"NieuwboerVanRheeKeetels2023", fmt::format("without drag {:.4f} m/s", fall_acceleration(rock, 0.0) * box.end_time)});
}

void run(Verification& verification) {
    let_go(verification, 1.0);
    let_go(verification, 2.0);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
