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

/// A circle of the surface in its meridional plane: (radius, z).
using Meridian = Eigen::Vector2d;

Meridian outside(const geometry::Contour& contour, double z, double offset) {
    return Meridian(contour.radius_at(z), z) + offset * outward_normal(contour, z);
}

/// Ends of a bin's bands, from above. \param from  where the bin above ends
std::vector<Meridian> band_ends(const geometry::Contour& contour, const geometry::AxialBin& bin, double offset, const Meridian& from) {
    std::vector<Meridian> ends{from};
    if (bin.z_min >= contour.z_ring()) {  // the gap: over the backplate's rim, then down
        const double radius = contour.ring_radius() + offset;
        for (int i = 0; i < k_circles; ++i)
            ends.emplace_back(radius, bin.z_max + (bin.z_min - bin.z_max) * static_cast<double>(i) / (k_circles - 1));
        return ends;
    }
    const bool below = !std::isfinite(bin.z_min);
    for (int i = 1; i <= k_circles; ++i) {
        const double share = static_cast<double>(i) / k_circles;
        ends.push_back(below ? Meridian(from + share * (Meridian(0.0, contour.z_hub() - offset) - from))
                             : outside(contour, bin.z_max + share * (bin.z_min - bin.z_max), offset));
    }
    return ends;
}

void add_band(WatchedPlaces& places, double shift, const Meridian& upper, const Meridian& lower) {
    const std::size_t first = places.points.size();
    const Meridian along = lower - upper, middle = 0.5 * (upper + lower);
    const double area_times_circles = k_circles * 2.0 * k_pi * middle[0];  // times the length of `along`, which is that of the normal below
    add_circle(places, shift, middle[0], middle[1]);
    for (std::size_t i = first; i < places.directions.size(); ++i) {
        Vec3& direction = places.directions[i];
        direction = area_times_circles * (-along[1] * direction + Vec3(0.0, 0.0, along[0]));
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
            const Meridian place = outside(contour, z, offset);
            add_circle(places, share, place[0], place[1]);
        }
    }
    return places;
}

WatchedPlaces flux_places(const geometry::Contour& contour, const std::vector<geometry::AxialBin>& bins, double offset) {
    WatchedPlaces places;
    places.groups = bins.size();
    Meridian from(contour.ring_radius(), bins.front().z_max);
    for (const geometry::AxialBin& bin : bins) {
        const std::vector<Meridian> ends = band_ends(contour, bin, offset, from);
        for (std::size_t i = 0; i + 1 < ends.size(); ++i)
            add_band(places, (static_cast<double>(i) + 0.5) / k_circles, ends[i], ends[i + 1]);
        from = ends.back();
    }
    return places;
}

WatchedPlaces velocity_and_flux_places(const geometry::Contour& contour, const std::vector<geometry::AxialBin>& bins, double offset) {
    WatchedPlaces places = outflow_places(contour, bins, offset);
    const WatchedPlaces flux = flux_places(contour, bins, offset);
    places.points.insert(places.points.end(), flux.points.begin(), flux.points.end());
    places.directions.insert(places.directions.end(), flux.directions.begin(), flux.directions.end());
    places.groups += flux.groups;
    return places;
}

}  // namespace cutterflow::coupling
