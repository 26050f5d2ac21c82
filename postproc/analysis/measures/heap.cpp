#include "postproc/analysis/measures/heap.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::postproc {

namespace {

constexpr std::size_t k_fewest_diameters = 4;  ///< of a slope's fitted part: fewer do not show whether it is straight

double degrees(double slope) {
    return std::atan(slope) * 180.0 / k_pi;
}

Grains above(const Grains& grains, double base) {
    return grains_in(grains, HalfSpaceRegion{Vec3(0.0, 0.0, base), Vec3::UnitZ()});
}

double height_at(const Profile& given, double place) {
    const auto after = std::lower_bound(given.place.begin(), given.place.end(), place);
    if (after == given.place.end() || (after == given.place.begin() && *after > place)) return 0.0;
    const auto n = static_cast<std::size_t>(after - given.place.begin());
    if (given.place[n] == place) return given.height[n];
    const double share = (place - given.place[n - 1]) / (given.place[n] - given.place[n - 1]);
    return given.height[n - 1] + share * (given.height[n] - given.height[n - 1]);
}

/// A silhouette with the axis at 0, columns of 1/10 diameter.
Profile silhouette(const Grains& grains, const Eigen::Vector2d& direction, const SlopeSearch& search, double reach, double diameter) {
    const int half = static_cast<int>(std::ceil(reach / diameter * static_cast<double>(k_columns_per_d))) + 1;
    const double width = diameter / static_cast<double>(k_columns_per_d), axis = direction.dot(search.axis);
    Profile profile = profile_of(grains, direction, {axis - half * width, axis + half * width, 2 * half}, search.base);
    for (double& place : profile.place) place -= axis;
    return profile;
}

/// Distance from the axis, outwards from `from`, at which a silhouette first comes down to `least`.
double foot(const Profile& side, double from, double least) {
    for (std::size_t i = 0; i < side.place.size(); ++i)
        if (side.place[i] >= from && side.height[i] < least) return side.place[i];
    return side.place.back();
}

/// Half of a silhouette: distance from the axis and height, from inside out.
Profile half_of(const Profile& silhouette, bool positive) {
    Profile side;
    const std::size_t n = silhouette.place.size();
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t at = positive ? i : n - 1 - i;
        const double distance = positive ? silhouette.place[at] : -silhouette.place[at];
        if (distance < 0.0) continue;
        side.place.push_back(distance);
        side.height.push_back(silhouette.height[at]);
    }
    return side;
}

/// Means of the columns of each whole diameter: without the roughness of single grains, which no line follows.
std::vector<double> means_over_diameters(const std::vector<double>& columns) {
    std::vector<double> means;
    for (std::size_t start = 0; start + k_columns_per_d <= columns.size(); start += k_columns_per_d) {
        double sum = 0.0;
        for (std::size_t n = start; n < start + k_columns_per_d; ++n) sum += columns[n];
        means.push_back(sum / static_cast<double>(k_columns_per_d));
    }
    return means;
}

std::optional<SlopeSide> fit_side(const Profile& side, const SlopeSearch& search, double diameter) {
    SlopeSide fitted;
    fitted.radius = search.radius.value_or(foot(side, search.inner_radius, diameter));
    const double length = fitted.radius - search.inner_radius;
    std::vector<double> x, y;
    for (std::size_t i = 0; i < side.place.size(); ++i) {
        const double share = (side.place[i] - search.inner_radius) / length;
        if (!(share >= search.window_from && share <= search.window_to)) continue;
        x.push_back(side.place[i]);
        y.push_back(side.height[i]);
    }
    if (x.size() < k_fewest_diameters * k_columns_per_d) return std::nullopt;
    fitted.line = fit_line(x, y);
    const LineFit smooth = fit_line(means_over_diameters(x), means_over_diameters(y));
    fitted.line.r2 = smooth.r2;
    fitted.line.residual = smooth.residual;
    fitted.angle_deg = degrees(-fitted.line.slope);
    const bool rises = std::abs(fitted.line.slope) * (x.back() - x.front()) >= k_least_rise * diameter;
    fitted.is_straight = smooth.r2 >= k_straight || (rises && smooth.residual <= diameter / std::sqrt(12.0));
    return fitted;
}

double lower_quartile(std::vector<double> values) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

void fit_cone(const Grains& grains, const SlopeSearch& search, double diameter, Slopes& slopes) {
    double radius = 0.0;
    for (const SlopeSide& side : slopes.sides) radius += side.radius / static_cast<double>(slopes.sides.size());
    const Eigen::Vector2d reach(radius, radius);
    const HeightMap map = height_map(grains, search.axis - reach, search.axis + reach, 0.25 * diameter, search.base);
    std::vector<double> r, h;
    for (int j = 0; j < map.rows; ++j) {
        for (int i = 0; i < map.columns; ++i) {
            const double distance = (Eigen::Vector2d(map.x(i), map.y(j)) - search.axis).norm();
            const double share = (distance - search.inner_radius) / (radius - search.inner_radius);
            if (share < search.window_from || share > search.window_to) continue;
            r.push_back(distance);
            h.push_back(map.at(i, j) - search.base);
        }
    }
    const LineFit line = fit_line(r, h);
    slopes.cone_angle_deg = std::abs(degrees(line.slope));
    slopes.cone_r2 = line.r2;
}

}  // namespace

Profile profile_of(const Grains& grains, const Eigen::Vector2d& direction, const Columns& columns, double base) {
    const Grains counted = above(grains, base);
    std::vector<double> u, z;
    for (const Vec3& place : counted.position) {
        u.push_back(direction.dot(place.head<2>()));
        z.push_back(place.z() - base);
    }
    Profile profile;
    profile.height = upper_envelope(u, z, counted.diameter, columns, 0.0);
    for (int c = 0; c < columns.count; ++c) profile.place.push_back(columns.middle(c));
    return profile;
}

ProfileError profile_error(const Profile& profile, const Profile& given, double least) {
    ProfileError result;
    for (std::size_t i = 0; i < profile.place.size(); ++i) {
        const double expected = height_at(given, profile.place[i]);
        if (expected < least || expected <= 0.0) {
            ++result.left_out;
            continue;
        }
        ++result.used;
        result.error += std::abs(profile.height[i] - expected) / expected;
    }
    if (result.used == 0)
        throw UserError(fmt::format("no point of the profile has a given height of {:.3g} m or more", least),
                        "Heights below 1 mean diameter are left out", "Check the places and the unit of the given profile");
    result.error /= static_cast<double>(result.used);
    return result;
}

Slopes slopes_of(const Grains& grains, const SlopeSearch& search) {
    Slopes slopes;
    const Grains counted = above(grains, search.base);
    if (counted.size() == 0) {
        slopes.reason = "no angle: no grains above the base";
        return slopes;
    }
    const double diameter = mean_diameter(counted);
    double reach = search.radius.value_or(0.0);
    for (std::size_t i = 0; i < counted.size(); ++i)
        reach = std::max(reach, (counted.position[i].head<2>() - search.axis).norm() + 0.5 * counted.diameter[i]);
    const double first_view = std::atan2(search.direction.y(), search.direction.x());
    for (int view = 0; view < (search.around ? k_views : 1); ++view) {
        const double turn = first_view + view * k_pi / k_views;
        slopes.silhouettes.push_back(silhouette(counted, {std::cos(turn), std::sin(turn)}, search, reach, diameter));
        for (const bool positive : {true, false}) {
            std::optional<SlopeSide> side = fit_side(half_of(slopes.silhouettes.back(), positive), search, diameter);
            if (!side) {
                slopes.reason = fmt::format("no angle: the part of a slope to fit is shorter than {} diameters", k_fewest_diameters);
                return slopes;
            }
            side->view_deg = turn * 180.0 / k_pi + (positive ? 0.0 : 180.0);
            slopes.sides.push_back(*side);
        }
    }
    const auto n = static_cast<double>(slopes.sides.size());
    double mean = 0.0, squares = 0.0;
    std::vector<double> r2;
    for (const SlopeSide& side : slopes.sides) {
        mean += side.angle_deg / n;
        r2.push_back(side.line.r2);
    }
    for (const SlopeSide& side : slopes.sides) squares += (side.angle_deg - mean) * (side.angle_deg - mean);
    slopes.spread_deg = std::sqrt(squares / (n - 1.0));
    slopes.r2 = lower_quartile(r2);
    slopes.rises_outwards = mean < 0.0;
    const auto crooked = std::count_if(slopes.sides.begin(), slopes.sides.end(), [](const SlopeSide& side) { return !side.is_straight; });
    if (static_cast<std::size_t>(crooked) > slopes.sides.size() / 4) {
        slopes.reason = fmt::format(
            "no angle: a quarter of the slopes is not straight, R2 {:.3f} below {}, and no line to the random height of a grain", slopes.r2,
            k_straight);
        return slopes;
    }
    const auto falls = std::count_if(slopes.sides.begin(), slopes.sides.end(),
                                     [](const SlopeSide& side) { return side.is_straight && side.angle_deg > 0.0; });
    const auto rises = std::count_if(slopes.sides.begin(), slopes.sides.end(),
                                     [](const SlopeSide& side) { return side.is_straight && side.angle_deg < 0.0; });
    if (falls > 0 && rises > 0) {
        slopes.reason = fmt::format(
            "no angle: {} of the slopes fall outwards and {} rise; on both sides of a heap or a hollow they do the same", falls, rises);
        return slopes;
    }
    slopes.angle_deg = std::abs(mean);
    if (search.around) fit_cone(counted, search, diameter, slopes);
    return slopes;
}

}  // namespace cutterflow::postproc
