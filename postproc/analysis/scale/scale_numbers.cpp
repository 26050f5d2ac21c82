#include "postproc/analysis/scale/scale_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::postproc {
namespace {

constexpr double k_gravity = 9.81;  // [m/s2]

/// A number of the run's study; none that earlier programs did not write.
std::optional<double> of_study(const RunData& run, const std::string& key) {
    const auto found = run.setting.find(key);
    if (found == run.setting.end()) return std::nullopt;
    const std::string& text = found->second;
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional<double>(value) : std::nullopt;
}

/// Of a feed, by mass.
struct MeanRock {
    double diameter = 0.0;           // [m]
    std::optional<double> settling;  // [m/s]
};

std::optional<MeanRock> mean_rock(const RunData& run) {
    if (!run.feed) return std::nullopt;
    double mass = 0.0, diameter = 0.0, settling = 0.0;
    bool every_speed_known = true;
    for (const RockClass& rock : run.feed->classes) {
        const double share = rock.count * rock.density * rock.diameter * rock.diameter * rock.diameter;
        mass += share;
        diameter += share * rock.diameter;
        settling += share * rock.settling_velocity.value_or(0.0);
        every_speed_known = every_speed_known && rock.settling_velocity.has_value();
    }
    if (!(mass > 0.0)) return std::nullopt;
    MeanRock mean{diameter / mass, std::nullopt};
    if (every_speed_known) mean.settling = settling / mass;
    return mean;
}

/// Values of the slices of a head in which there are blades and not a closed ring or hub; empty in runs that did not write them.
std::vector<double> of_blade_slices(const RunData& run, const char* key) {
    std::vector<double> values;
    const nlohmann::json head = run.geometry.value("head", nlohmann::json::object());
    for (const nlohmann::json& slice : head.value("blade_slices", nlohmann::json::array()))
        if (slice.value("coverage", 1.0) < 1.0 && slice.contains(key)) values.push_back(slice.at(key).get<double>());
    return values;
}

/// w [m], mean over the height.
std::optional<double> blade_depth(const RunData& run) {
    const std::vector<double> depths = of_blade_slices(run, "depth_m");
    if (depths.empty()) return std::nullopt;
    double sum = 0.0;
    for (const double depth : depths) sum += depth;
    return sum / static_cast<double>(depths.size());
}

/// beta [deg]: half of the slices are steeper.
std::optional<double> blade_angle(const RunData& run) {
    std::vector<double> angles = of_blade_slices(run, "angle_deg");
    if (angles.empty()) return std::nullopt;
    const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
    std::nth_element(angles.begin(), middle, angles.end());
    return *middle;
}

}  // namespace

ScaleNumbers scale_numbers_of(const RunData& run, const std::optional<double>& cut_in_situ) {
    const OperatingPoint& point = run.operating_point;
    const double radius = run.contour.ring_radius(), omega = point.angular_speed(), passing = 2.0 * k_pi / (run.blades * omega);
    const std::optional<double> depth = blade_depth(run), angle = blade_angle(run);
    ScaleNumbers scale;
    scale.flow_number = point.discharge / (omega * radius * radius * radius);
    scale.froude = omega * omega * radius / k_gravity;
    scale.friction_rock = of_study(run, "rock.friction_rock");
    scale.friction_steel = of_study(run, "rock.friction_steel");
    scale.friction_soil = of_study(run, "rock.friction_soil");
    if (angle) scale.blade_angle_less_ladder = *angle - point.inclination_deg;
    if (cut_in_situ) scale.cut_ratio = *cut_in_situ / point.discharge;
    if (point.swing_speed > 0.0) {
        scale.swing_ratio = point.swing_speed / (omega * radius);
        if (depth) scale.bite_ratio = point.swing_speed * passing / *depth;
    }
    const std::optional<MeanRock> rock = mean_rock(run);
    if (!rock) return scale;
    scale.size_ratio = rock->diameter / radius;
    if (!rock->settling) return scale;
    scale.settling_ratio = *rock->settling / (omega * radius);
    scale.settling_number = *rock->settling * k_pi * radius * radius / point.discharge;
    if (depth) scale.fall_through = *rock->settling * std::cos(point.inclination_deg * k_pi / 180.0) * passing / *depth;
    return scale;
}

}  // namespace cutterflow::postproc
