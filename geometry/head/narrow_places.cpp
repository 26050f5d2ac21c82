#include "geometry/head/narrow_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/solid_search.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_innermost = 0.5;  // scale of the contour that lies within the blades of any crown
constexpr int k_surfaces = 26;
constexpr int k_along = 64;          // places along the contour
constexpr int k_around = 32;         // in one pitch
constexpr int k_halvings = 9;        // of the step with which a place is improved
constexpr double k_opposite = -0.5;  // cosine of 120 degrees
constexpr double k_least_share = 0.02;
constexpr double k_touching = 1e-3;  // of the ball's radius
constexpr int k_shrinkings = 30;

/// The contour by its arc length, from 0 to 1.
class Meridian {
public:
    explicit Meridian(const RevolutionContour& contour) : contour_(contour), length_{0.0} {
        for (std::size_t i = 1; i < contour.z.size(); ++i)
            length_.push_back(length_.back() + std::hypot(contour.z[i] - contour.z[i - 1], contour.radius[i] - contour.radius[i - 1]));
    }

    double length() const { return length_.back(); }

    Vec3 point(double share, double azimuth, double scale) const {
        const double s = std::clamp(share, 0.0, 1.0) * length_.back();
        const auto above = std::upper_bound(length_.begin(), length_.end(), s);
        const auto i = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(above - length_.begin(), 1, static_cast<std::ptrdiff_t>(length_.size()) - 1));
        const double t = (s - length_[i - 1]) / std::max(length_[i] - length_[i - 1], std::numeric_limits<double>::min());
        const double r = scale * (contour_.radius[i - 1] + t * (contour_.radius[i] - contour_.radius[i - 1]));
        return {r * std::cos(azimuth), r * std::sin(azimuth), scale * (contour_.z[i - 1] + t * (contour_.z[i] - contour_.z[i - 1]))};
    }

private:
    const RevolutionContour& contour_;
    std::vector<double> length_;
};

struct Place {
    double share = 0.0;    // along the contour
    double azimuth = 0.0;  // [rad]
    double clearance = 0.0;
};

class PassageFinder {
public:
    PassageFinder(const TriangleSurface& head, const RevolutionContour& contour, int blades)
        : steel_(head), meridian_(contour), pitch_(2.0 * k_pi / blades) {}

    double find() const {
        double passage = std::numeric_limits<double>::infinity();
        for (int i = 0; i < k_surfaces; ++i)
            passage = std::min(passage, 2.0 * largest_clearance(k_innermost + (1.0 - k_innermost) * i / (k_surfaces - 1)));
        return passage;
    }

private:
    double clearance(const Place& place, double scale) const {
        return steel_.nearest(meridian_.point(place.share, place.azimuth, scale)).distance;
    }

    /// Radius of the largest sphere around a point of the scaled contour that touches no steel.
    double largest_clearance(double scale) const {
        std::vector<Place> places;
        for (int i = 0; i < k_along; ++i)
            for (int j = 0; j < k_around; ++j) {
                Place place{(i + 0.5) / k_along, pitch_ * j / k_around, 0.0};
                place.clearance = clearance(place, scale);
                places.push_back(place);
            }
        std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.clearance > b.clearance; });
        for (const Place& place : places)
            if (!steel_.contains(meridian_.point(place.share, place.azimuth, scale))) return improved(place, scale).clearance;
        return 0.0;
    }

    Place improved(Place best, double scale) const {
        double along = 1.0 / k_along;
        double around = pitch_ / k_around;
        for (int halving = 0; halving < k_halvings;) {
            const Place from = best;
            for (const auto& [i, j] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1), std::pair(1, 1),
                                       std::pair(-1, -1), std::pair(1, -1), std::pair(-1, 1)}) {
                Place place{std::clamp(from.share + i * along, 0.0, 1.0), from.azimuth + j * around, 0.0};
                place.clearance = clearance(place, scale);
                if (place.clearance > best.clearance) best = place;
            }
            if (best.clearance > from.clearance) continue;
            along *= 0.5;
            around *= 0.5;
            ++halving;
        }
        return best;
    }

    SolidSearch steel_;
    Meridian meridian_;
    double pitch_;
};

/// The largest ball inside that touches the surface at a point, and the cosine of the angle between the points that hold it.
struct InnerBall {
    double radius = 0.0;
    double opposite = 1.0;
};

/// Shrinks a ball that is too large until no part of the surface lies in it (Ma, Bae and Choi 2012).
InnerBall inner_ball(const SolidSearch& search, const Vec3& point, const Vec3& outward, double largest) {
    InnerBall ball{largest, 1.0};
    for (int i = 0; i < k_shrinkings; ++i) {
        const Vec3 centre = point - ball.radius * outward;
        const NearestPoint nearest = search.nearest(centre);
        if (nearest.distance >= (1.0 - k_touching) * ball.radius) break;
        const Vec3 chord = nearest.point - point;
        const double depth = -outward.dot(chord);
        if (depth <= 0.0) return {};
        ball.radius = 0.5 * chord.squaredNorm() / depth;
        ball.opposite = outward.dot((nearest.point - (point - ball.radius * outward)).normalized());
    }
    return ball;
}

}  // namespace

double passage_between_blades(const TriangleSurface& head, const RevolutionContour& contour, int blades) {
    return PassageFinder(head, contour, blades).find();
}

double smallest_thickness(const TriangleSurface& solid) {
    const SolidSearch search(solid);
    const double largest = 0.5 * bounds_of(solid).extent().norm();
    std::vector<std::pair<double, double>> thickness_and_area;
    double total = 0.0;
    for (const Triangle& triangle : solid.triangles) {
        const Vec3 area = area_vector(solid, triangle);
        if (area.norm() == 0.0) continue;
        const InnerBall ball = inner_ball(search, centroid_of(solid, triangle), area.normalized(), largest);
        if (ball.opposite > k_opposite) continue;
        thickness_and_area.emplace_back(2.0 * ball.radius, area.norm());
        total += area.norm();
    }
    std::sort(thickness_and_area.begin(), thickness_and_area.end());
    double below = 0.0;
    for (const auto& [thickness, area] : thickness_and_area)
        if ((below += area) >= k_least_share * total) return thickness;
    return 0.0;
}

}  // namespace cutterflow::geometry
