#include "solver/observe/head/outflow_places.hpp"

#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::coupling {
namespace {

constexpr int k_azimuths = 360;
constexpr int k_circles = 4;

/// Outward normal (radial, axial) of the contour at z, from its slope over a thousandth of its height.
Eigen::Vector2d outward_normal(const geometry::Contour& contour, double z) {
    const double h = 1e-3 * (contour.z_ring() - contour.z_hub());
    const double slope = (contour.radius_at(z + h) - contour.radius_at(z - h)) / (2.0 * h);
    return Eigen::Vector2d(1.0, -slope).normalized();
}

/// \param shift  of the azimuths, in their distance: places that turn with the head stay at their distance from its blades
void add_circle(WatchedPlaces& places, double shift, double radius, double z) {
    for (int j = 0; j < k_azimuths; ++j) {
        const double azimuth = 2.0 * k_pi * (j + shift) / k_azimuths;
        places.directions.emplace_back(std::cos(azimuth), std::sin(azimuth), 0.0);
        places.points.push_back(radius * places.directions.back() + Vec3(0.0, 0.0, z));
    }
}

}  // namespace

WatchedPlaces outflow_places(const geometry::Contour& contour, const std::vector<geometry::AxialBin>& bins, double offset) {
    WatchedPlaces places;
    places.groups = bins.size();
    for (const geometry::AxialBin& bin : bins) {
        for (int i = 0; i < k_circles; ++i) {
            const double share = (i + 0.5) / k_circles;
            if (!std::isfinite(bin.z_min)) {
                add_circle(places, share, std::max(contour.radius_at(contour.z_hub()), offset) * std::sqrt(share),
                           contour.z_hub() - offset);
                continue;
            }
            const double z = bin.z_min + share * (bin.z_max - bin.z_min);
            if (bin.z_min >= contour.z_ring()) {
                add_circle(places, share, contour.ring_radius() + offset, z);
                continue;
            }
            const Eigen::Vector2d place = Eigen::Vector2d(contour.radius_at(z), z) + offset * outward_normal(contour, z);
            add_circle(places, share, place[0], place[1]);
        }
    }
    return places;
}

}  // namespace cutterflow::coupling
