/// One rock settles through the sliding interface into the turning zone and out again.
#include <optional>

#include <fmt/format.h>

#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/crossing_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

CrossingCase tank(std::optional<double> rpm) {
    CrossingCase crossing;
    crossing.mesh.radius = 0.18;
    crossing.mesh.cells_in_stator = 11;
    crossing.mesh.height = 0.12;
    crossing.mesh.cells_high = 13;
    crossing.rpm = rpm;
    return crossing;
}

std::vector<RockSnapshot> fall(const Verification& verification, std::optional<double> rpm, int ranks) {
    const auto folder = verification.folder(rpm ? fmt::format("rpm_{}_ranks_{}", *rpm, ranks) : "one_mesh");
    write_box_case(folder, crossing_box(tank(rpm)));
    run_cutter_foam(folder, ranks);
    return all_rocks(folder);
}

// Three times the largest value when the bounds were set [m/s].
constexpr double k_error_bound = 1.1e-3, k_distance_bound = 1.3e-4;

/// Against the paper's tolerance, and against what the program reached before.
void check(Verification& verification, const std::string& quantity, double value, double tolerance, double bound, const About& about) {
    verification.at_most(quantity, "m/s", value, tolerance, about);
    verification.at_most(quantity + ", as good as it was", "m/s", value, bound,
                         {"exact", "bound: three times the largest value in 2026-11", {}});
}

void run(Verification& verification) {
    const std::vector<RockSnapshot> single = fall(verification, std::nullopt, 1);
    check(verification, "RMS error of velocity, one mesh", rms_error_of_crossing(single), 0.01, k_error_bound,
          {"NieuwboerVanRheeKeetels2023", "against the rock's force balance, from x = 0.13 to -0.12 m", {}});
    for (const auto& [rpm, ranks] :
         {std::pair(0.0, 1), std::pair(20.0, 1), std::pair(60.0, 1), std::pair(90.0, 1), std::pair(60.0, 2), std::pair(60.0, 4)}) {
        const std::vector<RockSnapshot> pictures = fall(verification, rpm, ranks);
        const std::string where = fmt::format("{:g} rpm, {} rank{}", rpm, ranks, ranks > 1 ? "s" : "");
        check(verification, "RMS error of velocity, " + where, rms_error_of_crossing(pictures), 0.01, k_error_bound,
              {"NieuwboerVanRheeKeetels2023", "through the interface twice, against the rock's force balance", {}});
        check(verification, "RMS distance from one mesh, " + where,
              rms_velocity_error(pictures, [&](std::size_t i) { return single.at(i).velocity.at(0); }), 0.0015, k_distance_bound,
              {"exact", "against the same fall without an interface", {}});
    }
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
