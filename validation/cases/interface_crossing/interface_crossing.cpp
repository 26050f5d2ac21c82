/// One rock settles through the sliding interface into the turning zone and out again.
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/support/box_case.hpp"
#include "validation/support/falling_rock.hpp"
#include "validation/support/tank_mesh.hpp"
#include "validation/support/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

const FallingRock k_rock;
constexpr double k_start_share = 0.9;  // of the terminal speed, so that its approach is seen too

BoxCase tank(std::optional<double> rpm) {
    TankMesh mesh;
    mesh.radius = 0.18;
    mesh.cells_in_stator = 11;
    mesh.height = 0.12;
    mesh.cells_high = 13;
    mesh.interface = rpm.has_value();
    BoxCase room;
    room.mesh = block_mesh(mesh);
    if (rpm) room.motion = turning(rpm_to_rad_s(*rpm));
    room.lower = Vec3(-mesh.radius, 0.0, -0.5 * mesh.height);
    room.upper = Vec3(mesh.radius, 0.0, 0.5 * mesh.height);
    room.gravity = Vec3(-k_rock.gravity, 0.0, 0.0);
    room.rocks = {{1, 0.0, Vec3(0.13, 0.0043, 0.0017), k_rock.diameter, k_rock.density,
                   Vec3(-k_start_share * terminal_slip(k_rock), 0.0, 0.0)}};
    room.time_step = 1e-3;
    room.end_time = 0.35;
    room.write_interval = 0.005;
    return room;
}

std::vector<RockPicture> fall(const Verification& verification, std::optional<double> rpm, int ranks) {
    const auto folder = verification.folder(rpm ? fmt::format("rpm_{}_ranks_{}", *rpm, ranks) : "one_mesh");
    write_box_case(folder, tank(rpm));
    run_cutter_foam(folder, ranks);
    return all_rocks(folder);
}

/// Root mean square over the pictures of |velocity - reference(picture)| [m/s].
template <class Reference>
double rms(const std::vector<RockPicture>& pictures, const Reference& reference) {
    double square = 0.0;
    for (std::size_t i = 0; i < pictures.size(); ++i) square += (pictures[i].velocity.at(0) - reference(i)).squaredNorm();
    return std::sqrt(square / static_cast<double>(pictures.size()));
}

void run(Verification& verification) {
    const std::vector<RockPicture> single = fall(verification, std::nullopt, 1);
    const double start = k_start_share * terminal_slip(k_rock);
    const auto balance = [&](const std::vector<RockPicture>& pictures) {
        return rms(pictures, [&](std::size_t i) { return Vec3(-fall_speed(k_rock, start, pictures[i].time), 0.0, 0.0); });
    };
    verification.at_most("RMS error of velocity, one mesh", "m/s", balance(single), 0.01,
                         {"NieuwboerVanRheeKeetels2023", "against the rock's force balance, from x = 0.13 to -0.12 m"});
    for (const auto& [rpm, ranks] : {std::pair(0.0, 1), std::pair(20.0, 1), std::pair(60.0, 1), std::pair(90.0, 1), std::pair(60.0, 2)}) {
        const std::vector<RockPicture> pictures = fall(verification, rpm, ranks);
        const std::string where = fmt::format("{:g} rpm, {} rank{}", rpm, ranks, ranks > 1 ? "s" : "");
        verification.at_most("RMS error of velocity, " + where, "m/s", balance(pictures), 0.01,
                             {"NieuwboerVanRheeKeetels2023", "through the interface twice, against the rock's force balance"});
        verification.at_most("RMS distance from one mesh, " + where, "m/s",
                             rms(pictures, [&](std::size_t i) { return single.at(i).velocity.at(0); }), 0.0015,
                             {"exact", "against the same fall without an interface"});
    }
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
