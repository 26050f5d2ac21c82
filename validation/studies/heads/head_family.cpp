#include "validation/studies/heads/head_family.hpp"

#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::validation {
namespace {

constexpr int k_dimensions = 16;

/// The root above 1 of x^(n + 1) = x + 1.
double generalised_golden_ratio(int n) {
    double x = 2.0;
    for (int i = 0; i < 60; ++i) x = std::pow(1.0 + x, 1.0 / (n + 1));
    return x;
}

}  // namespace

double family_share(int index, int k) {
    static const double ratio = generalised_golden_ratio(k_dimensions);
    return std::fmod(0.5 + (index + 1) * std::pow(ratio, -(k + 1)), 1.0);
}

geometry::CrownParameters family_head(int index) {
    const auto between = [index](int k, double low, double high) { return low + (high - low) * family_share(index, k); };
    const double degree = k_pi / 180.0;
    geometry::CrownParameters p;
    const double r = 0.1 * std::pow(16.0, family_share(index, 0));
    p.ring_radius = r;
    p.ring_inner_radius = 0.83 * r;
    p.ring_height = 0.14 * r;
    p.hub_radius = between(1, 0.28, 0.36) * r;
    p.hub_depth = between(2, 0.9, 1.35) * r;
    p.hub_height = 0.35 * r;
    p.hub_cap_height = 0.11 * r;
    p.blade_count = 4 + index % 5;
    p.blade_wrap = between(3, 20.0, 90.0) * degree * (index % 2 == 0 ? 1.0 : -1.0);
    p.blade_rake = between(4, 0.0, 25.0) * degree;
    p.blade_thickness = between(5, 0.055, 0.09) * r;
    p.blade_thickness_at_hub = between(6, 0.8, 1.2) * p.blade_thickness;
    p.blade_depth_at_ring = between(7, 0.12, 0.15) * r;
    p.blade_depth_at_hub = between(8, 0.16, 0.22) * r;
    p.contour_exponent = between(9, 1.6, 2.6);
    if (index / 2 % 2 == 1) {
        p.picks_per_blade = 4 + static_cast<int>(5.0 * family_share(index, 10));
        p.pick_length = between(11, 0.06, 0.1) * r;
        p.pick_width = 0.07 * r;
        p.pick_lean = between(12, 0.0, 40.0) * degree;
    }
    p.edge_length = 0.055 * r;
    return p;
}

}  // namespace cutterflow::validation
