#include "geometry/base/at_work/usual_ranges.hpp"

#include <cmath>

#include <fmt/format.h>

namespace cutterflow {
namespace {

constexpr double k_rounding = 1e-9;  // a value on an end of its range lies within

}  // namespace

const std::vector<UsualRange>& usual_ranges() {
    // No published table of these is known to us: what dredgers of rock usually do. The ring's range is one of diameters: with it the
    // speeds of rotor and tips agree.
    static const char* const practice = "usual practice";
    static const std::vector<UsualRange> ranges{{at_work::k_ring_diameter, "ring diameter", "m", 1.5, 3.5, 1.0, practice},
                                                {at_work::k_rotor_speed, "rotor speed", "rpm", 20.0, 40.0, -0.5, practice},
                                                {at_work::k_tip_speed, "tip speed", "m/s", 2.5, 6.0, 0.5, practice},
                                                {at_work::k_swing_speed, "swing speed", "m/min", 10.0, 25.0, 0.5, practice},
                                                {at_work::k_step, "step", "m", 0.5, 2.0, 1.0, practice},
                                                {at_work::k_cut_height, "cut height", "ring diameters", 0.5, 1.2, 0.0, practice},
                                                {at_work::k_ladder, "ladder", "degrees", 25.0, 45.0, 0.0, practice},
                                                {at_work::k_mouth_speed, "speed in the suction mouth", "m/s", 4.0, 7.0, 0.5, practice},
                                                {at_work::k_mixture_density, "mixture density", "kg/m3", 1050.0, 1200.0, 0.0, practice},
                                                {at_work::k_spillage, "spillage", "%", 20.0, 50.0, 0.0, practice}};
    return ranges;
}

std::vector<std::string> outside_usual_ranges(const std::map<std::string, double>& of_model, double length_ratio) {
    std::vector<std::string> outside;
    for (const UsualRange& range : usual_ranges()) {
        const auto found = of_model.find(range.key);
        if (found == of_model.end()) continue;
        const double value = found->second * std::pow(length_ratio, range.exponent);
        if (value >= range.from * (1.0 - k_rounding) && value <= range.to * (1.0 + k_rounding)) continue;
        outside.push_back(fmt::format("{} {:.4g} {} ({:g} to {:g})", range.name, value, range.unit, range.from, range.to));
    }
    return outside;
}

}  // namespace cutterflow
