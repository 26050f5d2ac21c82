// Fluxes out of a head whose contour is a bowl, in flows that are known.
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/observe/head/outflow_places.hpp"

namespace cutterflow::coupling {
namespace {

constexpr double k_ring = 0.4, k_backplate = 0.03, k_offset = 0.015;

geometry::Contour bowl() {
    std::vector<double> z, radius;
    for (int i = 0; i <= 40; ++i) {
        z.push_back(-0.45 + 0.45 * i / 40.0);
        radius.push_back(k_ring * std::sqrt(1.0 - std::pow(z.back() / 0.451, 2)));
    }
    return geometry::Contour(z, radius, k_ring, k_backplate);
}

template <typename Flow>
std::vector<double> means(const WatchedPlaces& places, const Flow& flow) {
    std::vector<double> sums(places.groups, 0.0);
    const std::size_t per_group = places.points.size() / places.groups;
    for (std::size_t i = 0; i < places.points.size(); ++i)
        sums[i / per_group] += flow(places.points[i]).dot(places.directions[i]) / static_cast<double>(per_group);
    return sums;
}

template <typename Flow>
double total_flux(double bin_width, const Flow& flow) {
    const std::vector<double> fluxes = means(flux_places(bowl(), geometry::axial_bins(bowl(), bin_width), k_offset), flow);
    return std::accumulate(fluxes.begin(), fluxes.end(), 0.0);
}

TEST(FluxPlaces, close_the_head_but_for_the_backplate) {
    const auto stream = [](const Vec3&) { return Vec3(0.3, -0.2, 0.7); };
    for (const double width : {0.03, 0.1}) EXPECT_NEAR(total_flux(width, stream), -0.7 * k_pi * k_ring * k_ring, 1e-12) << width;
    EXPECT_NEAR(total_flux(0.03, [](const Vec3& x) { return Vec3(Vec3::UnitZ().cross(x)); }), 0.0, 1e-12) << "what turns flows nowhere";
}

// Of a source on the axis all leaves but what goes through the backplate, by its solid angle.
TEST(FluxPlaces, have_the_flux_of_a_source) {
    const double deep = 0.1, to_backplate = deep + k_backplate;
    const double through = 0.5 * (1.0 - to_backplate / std::hypot(to_backplate, k_ring));
    const auto source = [&](const Vec3& x) {
        const Vec3 arm = x + deep * Vec3::UnitZ();
        return Vec3(arm / (4.0 * k_pi * std::pow(arm.norm(), 3)));
    };
    EXPECT_NEAR(total_flux(0.03, source), 1.0 - through, 1e-3);
}

// Radial velocities alone miss what goes along the axis through a contour that tapers.
TEST(FluxPlaces, count_what_crosses_a_tapering_contour_along_the_axis) {
    const std::vector<geometry::AxialBin> bins = geometry::axial_bins(bowl(), 0.1);
    const auto upwards = [](const Vec3&) { return Vec3(0.0, 0.0, 1.0); };
    const std::vector<double> both = means(velocity_and_flux_places(bowl(), bins, k_offset), upwards);
    ASSERT_EQ(both.size(), 2 * bins.size());
    for (std::size_t bin = 0; bin < bins.size(); ++bin) {
        EXPECT_NEAR(both[bin], 0.0, 1e-12) << bins[bin].name;
        if (bin > 1) {
            EXPECT_LT(both[bins.size() + bin], -0.003) << bins[bin].name;
        }
    }
}

}  // namespace
}  // namespace cutterflow::coupling
