#include "geometry/head/blade_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::geometry {
namespace {

constexpr int k_azimuths = 720;
constexpr std::array<double, 4> k_radii{0.9, 0.93, 0.96, 0.99};  // of the contour's
constexpr int k_halvings = 14;

}  // namespace

std::vector<SteelInterval> steel_intervals(const SolidSearch& cutter, const Contour& head, double z, double sense) {
    const double radius = head.radius_at(z);
    // Azimuths are taken in the sense of rotation: steel is left through its leading face.
    const auto is_steel = [&](double turned) {
        const Vec3 direction(std::cos(sense * turned), std::sin(sense * turned), 0.0);
        return std::any_of(k_radii.begin(), k_radii.end(),
                           [&](double share) { return cutter.contains(share * radius * direction + Vec3(0.0, 0.0, z)); });
    };
    const double step = 2.0 * k_pi / k_azimuths;
    std::vector<bool> steel(k_azimuths);
    for (int i = 0; i < k_azimuths; ++i) steel[i] = is_steel(i * step);
    /// Where the steel's state changes between two samples.
    const auto edge = [&](int i) {
        double from = i * step, to = from + step;
        for (int n = 0; n < k_halvings; ++n) {
            const double middle = 0.5 * (from + to);
            (is_steel(middle) == steel[i] ? from : to) = middle;
        }
        return 0.5 * (from + to);
    };
    std::vector<double> entries, exits;
    for (int i = 0; i < k_azimuths; ++i) {
        const bool next = steel[(i + 1) % k_azimuths];
        if (steel[i] == next) continue;
        (next ? entries : exits).push_back(edge(i));
    }
    std::vector<SteelInterval> intervals;
    for (const double exit : exits) {
        const auto after = std::lower_bound(entries.begin(), entries.end(), exit);
        const double entry = after == entries.begin() ? entries.back() - 2.0 * k_pi : *(after - 1);
        double leading = std::fmod(sense * exit, 2.0 * k_pi);
        if (leading < 0.0) leading += 2.0 * k_pi;
        intervals.push_back({leading, exit - entry});
    }
    return intervals;
}

}  // namespace cutterflow::geometry
