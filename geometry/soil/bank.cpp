#include "geometry/soil/bank.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/convex_hull.hpp"
#include "geometry/cgal/exact_solid.hpp"

namespace cutterflow::geometry {
namespace {

/// Of the polygon about a disc by which the section grows.
constexpr int k_disc_sides = 24;
/// Of the head seen along the swing; smaller patches are rounding.
constexpr double k_least_share = 1e-13;

void require(bool kept, const char* rule) {
    if (!kept) throw std::invalid_argument(rule);
}

/// Of a corner of a circle. Mirrored corners are corners, so that both swings have mirrored bodies.
double corner_azimuth(int k, int segments) {
    return 2.0 * k_pi * k / segments;
}

Vec3 on_circle(const MeridianPoint& at, double azimuth, double stretch) {
    return {at.r * stretch * std::cos(azimuth), at.r * stretch * std::sin(azimuth), at.z};
}

/// By which corners of a polygon about a circle are farther out than the circle.
double corner_stretch(int segments) {
    return 1.0 / std::cos(k_pi / segments);
}

/// The side between two corners in parts no longer than `length`, without its end.
void add_divided(std::vector<MeridianPoint>& points, const MeridianPoint& a, const MeridianPoint& b, double length) {
    const int parts = std::max(1, static_cast<int>(std::ceil(std::hypot(b.r - a.r, b.z - a.z) / length - 1e-9)));
    for (int k = 0; k < parts; ++k) points.push_back({a.r + (b.r - a.r) * k / parts, a.z + (b.z - a.z) * k / parts});
}

TriangleSurface block(const Vec3& low, const Vec3& high) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(), (i & 4) != 0 ? high.z() : low.z());
    return convex_hull(corners);
}

}  // namespace

std::vector<MeridianPoint> section_of_body(const Contour& contour, double pick_length, double clearance) {
    const double growth = (pick_length + clearance) * corner_stretch(k_disc_sides);
    std::vector<Eigen::Vector2d> points;
    const auto add = [&](double r, double z) {
        for (int k = 0; k < k_disc_sides; ++k) {
            const double angle = corner_azimuth(k, k_disc_sides);
            points.emplace_back(std::max(0.0, r + growth * std::cos(angle)),
                                std::min(contour.z_ring() + clearance, z + growth * std::sin(angle)));
        }
    };
    for (std::size_t i = 0; i < contour.z().size(); ++i) add(contour.radius()[i], contour.z()[i]);
    add(contour.ring_radius(), contour.z_ring());
    const auto [low, high] = std::minmax_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
    const double z_low = low->y(), z_high = high->y();
    points.emplace_back(0.0, z_low);
    points.emplace_back(0.0, z_high);
    // Counter-clockwise from a point on the axis: the one below comes first, the one above last.
    PlanarLoop hull = convex_hull(points);
    const auto start = std::find_if(hull.begin(), hull.end(), [&](const Eigen::Vector2d& p) { return p.x() == 0.0 && p.y() == z_low; });
    std::rotate(hull.begin(), start, hull.end());
    std::vector<MeridianPoint> section;
    for (const Eigen::Vector2d& p : hull) section.push_back({p.x(), p.y()});
    return section;
}

Bank::Bank(const Contour& contour, const BankParameters& parameters)
    : parameters_(parameters), head_depth_(contour.z_ring() - contour.z_hub()) {
    require(std::abs(parameters.swing_sign) == 1.0, "a swing goes along y or against it");
    require(parameters.cut_height > 0.0 && parameters.step > 0.0, "cut height and step must be positive");
    require(parameters.pick_length >= 0.0 && parameters.clearance >= 0.0, "pick length and clearance must not be negative");
    require(parameters.segments >= 8 && parameters.segments % 4 == 0, "a circle needs a multiple of four edges, eight or more");
    section_ = section_of_body(contour, parameters.pick_length, parameters.clearance);
    std::vector<Eigen::Vector2d> silhouette;
    for (const Vec3& point : body()) silhouette.emplace_back(point.x(), point.y());
    outline_ = convex_hull(silhouette);
    double highest = outline_.front().y(), behind = outline_.front().x(), ahead = behind;
    lowest_ = highest;
    for (const Eigen::Vector2d& corner : outline_) {
        lowest_ = std::min(lowest_, corner.y());
        highest = std::max(highest, corner.y());
        behind = std::min(behind, corner.x());
        ahead = std::max(ahead, corner.x());
    }
    height_ = highest - lowest_;
    length_ = ahead - behind;
}

Vec3 Bank::seen(const Vec3& point) const {
    const double c = std::cos(parameters_.inclination), s = std::sin(parameters_.inclination);
    return {-s * point.x() - c * point.z(), -c * point.x() + s * point.z(), parameters_.swing_sign * point.y()};
}

Eigen::Affine3d Bank::to_run_frame() const {
    Eigen::Matrix3d rows;
    for (int k = 0; k < 3; ++k) rows.col(k) = seen(Vec3::Unit(k));
    return Eigen::Affine3d(Eigen::Matrix3d(rows.transpose()));  // orthonormal
}

Vec3 Bank::corner(const MeridianPoint& at, int k) const {
    return seen(on_circle(at, corner_azimuth(k, parameters_.segments), corner_stretch(parameters_.segments)));
}

std::vector<Vec3> Bank::body() const {
    std::vector<Vec3> points;
    for (const MeridianPoint& at : section_)
        for (int k = 0; k < parameters_.segments; ++k) {
            if (at.r == 0.0 && k > 0) break;
            points.push_back(corner(at, k));
        }
    return points;
}

double Bank::width_at_top() const {
    const double height = top();
    double least = 0.0, most = 0.0;
    bool found = false;
    for (std::size_t k = 0; k < outline_.size(); ++k) {
        const Eigen::Vector2d &a = outline_[k], &b = outline_[(k + 1) % outline_.size()];
        if (a.y() == b.y() || std::min(a.y(), b.y()) > height || std::max(a.y(), b.y()) < height) continue;
        const double at = a.x() + (height - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        least = found ? std::min(least, at) : at;
        most = found ? std::max(most, at) : at;
        found = true;
    }
    return most - least;
}

double Bank::cut_section() const {
    const PlanarLoop below = clipped(outline_, {0.0, top()}, {0.0, -1.0});
    return (moment_of(below) - moment_of(clipped(below, moved(outline_, {-parameters_.step, 0.0})))).area;
}

CutFace Bank::cut_face(double length) const {
    const PlanarLoop cut_before = moved(outline_, {-parameters_.step, 0.0});
    return front(length, [&](const PlanarLoop& facet) {
        const PlanarLoop below = clipped(facet, {0.0, top()}, {0.0, -1.0});
        return moment_of(below) - moment_of(clipped(below, cut_before));
    });
}

/// What of a convex part of K lies in the layer that the last swing left.
PlanarMoment Bank::layer_of(const PlanarLoop& part, double thickness) const {
    const PlanarLoop before = moved(outline_, {-parameters_.step, 0.0});
    const PlanarLoop taken = clipped(part, before);
    return moment_of(taken) - moment_of(clipped(taken, moved(before, {0.0, thickness})));
}

double Bank::layer_section(double thickness) const {
    return layer_of(outline_, thickness).area;
}

CutFace Bank::layer_face(double thickness, double length) const {
    return front(length, [&](const PlanarLoop& facet) { return layer_of(facet, thickness); });
}

/// The facets of the body's front in patches, with what is taken there. \param taken  of a facet, as seen
CutFace Bank::front(double length, const Taken& taken) const {
    const int segments = parameters_.segments;
    const double least_area = k_least_share * moment_of(outline_).area;
    const Eigen::Affine3d back = to_run_frame();
    std::vector<MeridianPoint> points;
    for (std::size_t i = 0; i + 1 < section_.size(); ++i) add_divided(points, section_[i], section_[i + 1], length);
    points.push_back(section_.back());
    CutFace face;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        for (int k = 0; k < segments; ++k) {
            const std::array<Vec3, 4> corners{corner(points[i], k), corner(points[i], k + 1), corner(points[i + 1], k + 1),
                                              corner(points[i + 1], k)};
            // Seen against the swing a facet of the front goes counter-clockwise; the mirrored frame of the other swing turns it round.
            const Vec3 normal = parameters_.swing_sign * (corners[2] - corners[0]).cross(corners[3] - corners[1]);
            if (!(normal.z() > 0.0)) continue;
            PlanarLoop facet;
            for (const Vec3& corner : corners) facet.emplace_back(corner.x(), corner.y());
            if (parameters_.swing_sign < 0.0) std::reverse(facet.begin(), facet.end());
            const PlanarMoment cut = taken(facet);
            if (!(cut.area > least_area)) continue;
            const Eigen::Vector2d centre = cut.first / cut.area;
            // On the facet's plane.
            const double along =
                corners[0].z() - (normal.x() * (centre.x() - corners[0].x()) + normal.y() * (centre.y() - corners[0].y())) / normal.z();
            const Vec3 at = back * Vec3(centre.x(), centre.y(), along);
            const double azimuth = std::atan2(at.y(), at.x());
            face.patches.push_back({std::clamp(-at.z(), 0.0, head_depth_), azimuth < 0.0 ? azimuth + 2.0 * k_pi : azimuth,
                                    std::hypot(at.x(), at.y()), cut.area});
        }
    return face;
}

TriangleSurface Bank::swept(double length) const {
    std::vector<Vec3> points = body();
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) points.push_back(points[i] - length * Vec3::UnitZ());
    return convex_hull(points);
}

TriangleSurface Bank::sweep(double length) const {
    return transformed(swept(length), to_run_frame());
}

TriangleSurface Bank::earlier_sweep(int steps, double length) const {
    std::vector<Vec3> points;
    for (const Vec3& point : body())
        for (const double side : {-length, length}) points.push_back(point + Vec3(-steps * parameters_.step, 0.0, side));
    return transformed(convex_hull(points), to_run_frame());
}

TriangleSurface Bank::prism(int steps, double length) const {
    std::vector<Vec3> points;
    for (const Eigen::Vector2d& corner : moved(outline_, {-steps * parameters_.step, 0.0}))
        for (const double side : {-length, length}) points.emplace_back(corner.x(), corner.y(), side);
    return convex_hull(points);
}

TriangleSurface Bank::soil(double reach) const {
    double farthest = outline_.front().x();
    for (const Eigen::Vector2d& corner : outline_) farthest = std::max(farthest, corner.x());
    ExactSolid left(block({-reach, -reach, -reach}, {reach, top(), reach}));
    for (int j = 1; farthest - j * parameters_.step > -reach; ++j) left.subtract(ExactSolid(prism(j, 1.25 * reach)));
    left.subtract(ExactSolid(swept(2.5 * reach)));
    return transformed(left.surface(), to_run_frame());
}

}  // namespace cutterflow::geometry
