#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/convex_hull.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/soil/bank.hpp"
#include "geometry/soil/convex_facet.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_smallest_angle = 5.0 * k_pi / 180.0;

/// A part of a polygon's side.
struct Segment {
    Eigen::Vector2d a, b;
    double length() const { return (b - a).norm(); }
    Eigen::Vector2d at(double share) const { return a + share * (b - a); }
};

/// From where to where along a segment, as shares of it.
struct Span {
    double from = 0.0, to = 1.0;
};

/// Where a segment is in a convex polygon that goes counter-clockwise; `to` not beyond `from` when it is not.
Span span_within(const Segment& segment, const PlanarLoop& convex) {
    Span span;
    for (std::size_t k = 0; k < convex.size(); ++k) {
        const Eigen::Vector2d side = convex[(k + 1) % convex.size()] - convex[k], inwards(-side.y(), side.x());
        const double first = (segment.a - convex[k]).dot(inwards), last = (segment.b - convex[k]).dot(inwards);
        if (first < 0.0 && last < 0.0) return {0.0, 0.0};
        if (first < 0.0) span.from = std::max(span.from, first / (first - last));
        if (last < 0.0) span.to = std::min(span.to, first / (first - last));
    }
    return span;
}

std::vector<Segment> within(const Segment& segment, const PlanarLoop& convex) {
    const Span span = span_within(segment, convex);
    if (!(span.to > span.from)) return {};
    return {{segment.at(span.from), segment.at(span.to)}};
}

std::vector<Segment> outside(const Segment& segment, const PlanarLoop& convex) {
    const Span span = span_within(segment, convex);
    if (!(span.to > span.from)) return {segment};
    std::vector<Segment> parts;
    if (span.from > 0.0) parts.push_back({segment.a, segment.at(span.from)});
    if (span.to < 1.0) parts.push_back({segment.at(span.to), segment.b});
    return parts;
}

std::vector<Segment> sides_of(const PlanarLoop& polygon) {
    std::vector<Segment> sides;
    for (std::size_t k = 0; k < polygon.size(); ++k) sides.push_back({polygon[k], polygon[(k + 1) % polygon.size()]});
    return sides;
}

/// The section with as few points as lie within `tolerance` [m] of it (Douglas and Peucker); ends stay.
std::vector<MeridianPoint> thinned(const std::vector<MeridianPoint>& section, double tolerance) {
    if (section.size() < 3) return section;
    const Eigen::Vector2d first(section.front().r, section.front().z), last(section.back().r, section.back().z);
    const Eigen::Vector2d along = (last - first).normalized();
    std::size_t farthest = 0;
    double most = tolerance;
    for (std::size_t i = 1; i + 1 < section.size(); ++i) {
        const Eigen::Vector2d arm = Eigen::Vector2d(section[i].r, section[i].z) - first;
        const double distance = std::abs(arm.x() * along.y() - arm.y() * along.x());
        if (distance <= most) continue;
        most = distance;
        farthest = i;
    }
    if (farthest == 0) return {section.front(), section.back()};
    const auto middle = section.begin() + static_cast<std::ptrdiff_t>(farthest);
    std::vector<MeridianPoint> kept = thinned({section.begin(), middle + 1}, tolerance);
    const std::vector<MeridianPoint> rest = thinned({middle, section.end()}, tolerance);
    kept.insert(kept.end(), rest.begin() + 1, rest.end());
    return kept;
}

/// Turned over, if need be, so that its corners go counter-clockwise about `normal`.
Facet facing(Facet facet, const Vec3& normal) {
    Vec3 area = Vec3::Zero();
    for (std::size_t k = 2; k < facet.size(); ++k) area += (facet[k - 1] - facet[0]).cross(facet[k] - facet[0]);
    if (area.dot(normal) < 0.0) std::reverse(facet.begin(), facet.end());
    return facet;
}

/// Points of the triangles no farther than about `spacing` [m] from each other, given to `use`.
template <class Use>
void for_points_on(const TriangleSurface& surface, double spacing, const Use& use) {
    for (const Triangle& triangle : surface.triangles) {
        // From the side a b, the longest, to the corner c.
        Vec3 a = surface.points[triangle[0]], b = surface.points[triangle[1]], c = surface.points[triangle[2]];
        for (int turn = 0; turn < 2; ++turn)
            if ((b - a).norm() < std::max((c - b).norm(), (a - c).norm())) {
                const Vec3 first = a;
                a = b;
                b = c;
                c = first;
            }
        const double length = (b - a).norm(), height = length > 0.0 ? (b - a).cross(c - a).norm() / length : 0.0;
        const int along = 1 + static_cast<int>(length / spacing), across = 1 + static_cast<int>(height / spacing);
        for (int j = 0; j <= across; ++j)
            for (int i = 0; i <= along; ++i) {
                const double up = static_cast<double>(j) / across, beside = static_cast<double>(i) / along;
                use(Vec3(up * c + (1.0 - up) * ((1.0 - beside) * a + beside * b)));
            }
    }
}

}  // namespace

/// Makes the wall, as seen.
class Bank::WallMaker {
public:
    WallMaker(const Bank& bank, const WallBounds& bounds)
        : bank_(bank), reach_(bounds.reach), tiles_{bounds.tolerance, bounds.edge_length, k_smallest_angle} {
        const std::vector<MeridianPoint> section = thinned(bank.section_, bounds.tolerance);
        const int half_turn = bank.parameters_.segments / 2;
        for (std::size_t i = 0; i + 1 < section.size(); ++i)
            for (int k = 0; k < half_turn; ++k)
                front_.push_back(
                    {corner(section[i], k), corner(section[i], k + 1), corner(section[i + 1], k + 1), corner(section[i + 1], k)});
        std::vector<Eigen::Vector2d> silhouette;
        for (const MeridianPoint& at : section)
            for (const int k : {0, half_turn}) silhouette.emplace_back(corner(at, k).head<2>());
        outline_ = convex_hull(silhouette);
        const PlanarMoment moment = moment_of(outline_);
        centre_ = moment.first / moment.area;
    }

    TriangleSurface make() {
        add_front();
        add_sides_of_this_swing();
        add_last_step();
        double farthest = -std::numeric_limits<double>::infinity();
        for (const Eigen::Vector2d& corner : outline_) farthest = std::max(farthest, corner.x());
        for (int j = 2; farthest - j * bank_.parameters_.step > -reach_; ++j) add_earlier_step(j);
        add_top();
        return std::move(wall_);
    }

private:
    /// Azimuths run from the plane of the axis and the direction ahead towards the bank.
    Vec3 corner(const MeridianPoint& at, int k) const { return bank_.corner(at, bank_.parameters_.swing_sign > 0.0 ? k : -k); }
    PlanarLoop outline(int steps) const { return moved(outline_, {-steps * bank_.parameters_.step, 0.0}); }
    Vec3 inwards(int steps, const Vec3& from) const {
        return Vec3(centre_.x() - steps * bank_.parameters_.step - from.x(), centre_.y() - from.y(), 0.0);
    }

    void add(Facet facet, const Vec3& normal) {
        if (facet.size() >= 3) add_tiles(facing(std::move(facet), normal), tiles_, wall_);
    }

    /// Front of the body, which this swing cuts.
    void add_front() {
        for (const Facet& facet : front_) {
            const Facet below = clipped(facet, {0.0, bank_.top()}, {0.0, -1.0});
            if (width_of(below) < tiles_.least_width) continue;
            for (const Facet& part : geometry::outside(below, outline(1), tiles_.least_width))
                add(part, Vec3(centre_.x(), centre_.y(), 0.0) - part.front());
        }
    }

    /// Along the swing over a part of an outline.
    void add_strip(const Segment& segment, double from, double to, int steps) {
        const auto at = [](const Eigen::Vector2d& p, double along) { return Vec3(p.x(), p.y(), along); };
        add({at(segment.a, from), at(segment.b, from), at(segment.b, to), at(segment.a, to)}, inwards(steps, at(segment.a, from)));
    }

    /// Sides of the outline that lie in the soil's box, and below its top.
    std::vector<Segment> sides(int steps) const {
        const PlanarLoop box{{-reach_, -reach_}, {reach_, -reach_}, {reach_, bank_.top()}, {-reach_, bank_.top()}};
        std::vector<Segment> kept;
        for (const Segment& side : sides_of(outline(steps)))
            for (const Segment& part : within(side, box)) kept.push_back(part);
        return kept;
    }

    /// This swing's, up to the front: the silhouette lies in the plane of the axis.
    void add_sides_of_this_swing() {
        for (const Segment& side : sides(0))
            for (const Segment& part : outside(side, outline(1))) add_strip(part, -reach_, 0.0, 0);
    }

    /// What the last step left: beyond this swing's outline on both sides, within it ahead of the front.
    void add_last_step() {
        for (const Segment& side : sides(1))
            for (const Segment& part : outside(side, outline(2))) {
                for (const Segment& beside : outside(part, outline_)) add_strip(beside, -reach_, reach_, 1);
                for (const Segment& ahead : within(part, outline_))
                    add_ahead_of_front(ahead, inwards(1, Vec3(ahead.a.x(), ahead.a.y(), 0.0)));
            }
    }

    void add_earlier_step(int steps) {
        for (const Segment& side : sides(steps))
            for (const Segment& part : outside(side, outline(steps - 1)))
                for (const Segment& left : outside(part, outline(steps + 1))) add_strip(left, -reach_, reach_, steps);
    }

    void add_top() {
        const double top = bank_.top();
        const Segment level{{-2.0 * reach_ - bank_.length_, top}, {2.0 * reach_ + bank_.length_, top}};
        const std::vector<Segment> of_head = within(level, outline_), of_last_step = within(level, outline(1));
        if (of_head.empty() || of_last_step.empty()) return;
        const double head_ends = of_head.front().b.x();
        const Segment cut{{std::max(of_head.front().a.x(), of_last_step.front().b.x()), top}, {head_ends, top}};
        add_ahead_of_front(cut, Vec3::UnitY());
        add({{head_ends, top, -reach_}, {reach_, top, -reach_}, {reach_, top, reach_}, {head_ends, top, reach_}}, Vec3::UnitY());
    }

    /// The plane along the swing over a segment, from the front to the soil's end.
    void add_ahead_of_front(const Segment& segment, const Vec3& normal) {
        if (segment.length() < tiles_.least_width) return;
        const auto at = [&](double share, double along) {
            const Eigen::Vector2d p = segment.at(share);
            return Vec3(p.x(), p.y(), along);
        };
        const std::vector<Edge> edges = front_over(segment);
        double farthest = 0.0;
        for (const Edge& edge : edges) farthest = std::max({farthest, edge.begin, edge.end});
        for (const Edge& edge : edges)
            add({at(edge.span.from, edge.begin), at(edge.span.to, edge.end), at(edge.span.to, farthest), at(edge.span.from, farthest)},
                normal);
        add({at(0.0, farthest), at(1.0, farthest), at(1.0, reach_), at(0.0, reach_)}, normal);
    }

    /// The front over a part of a segment: a straight edge.
    struct Edge {
        Span span;
        double begin, end;  // along the swing [m]
    };
    std::vector<Edge> front_over(const Segment& segment) const {
        const Eigen::Vector2d along = segment.b - segment.a, beside(-along.y(), along.x());
        std::vector<Edge> edges;
        for (const Facet& facet : front_) {
            Edge edge{{2.0, -1.0}, 0.0, 0.0};
            for (std::size_t k = 0; k < facet.size(); ++k) {
                const Vec3 &from = facet[k], &to = facet[(k + 1) % facet.size()];
                const double before = (from.head<2>() - segment.a).dot(beside), after = (to.head<2>() - segment.a).dot(beside);
                if ((before >= 0.0) == (after >= 0.0)) continue;
                const Vec3 crossing = from + before / (before - after) * (to - from);
                const double share = (crossing.head<2>() - segment.a).dot(along) / along.squaredNorm();
                if (share < edge.span.from) {
                    edge.span.from = share;
                    edge.begin = crossing.z();
                }
                if (share > edge.span.to) {
                    edge.span.to = share;
                    edge.end = crossing.z();
                }
            }
            if (!(edge.span.to > edge.span.from) || edge.span.from >= 1.0 || edge.span.to <= 0.0) continue;
            const double slope = (edge.end - edge.begin) / (edge.span.to - edge.span.from);
            const Span kept{std::max(0.0, edge.span.from), std::min(1.0, edge.span.to)};
            edges.push_back({kept, edge.begin + slope * (kept.from - edge.span.from), edge.begin + slope * (kept.to - edge.span.from)});
        }
        return edges;
    }

    const Bank& bank_;
    double reach_;
    TileBounds tiles_;
    std::vector<Facet> front_;
    PlanarLoop outline_;
    Eigen::Vector2d centre_;
    TriangleSurface wall_;
};

TriangleSurface Bank::wall(const WallBounds& bounds) const {
    return transformed(WallMaker(*this, bounds).make(), to_run_frame());
}

double Bank::wall_error(const TriangleSurface& wall, const TriangleSurface& soil, double reach, double spacing) const {
    double farthest = 0.0;
    const SolidSearch in_soil(soil);
    for_points_on(wall, spacing, [&](const Vec3& point) { farthest = std::max(farthest, in_soil.nearest(point).distance); });
    const SolidSearch on_wall(wall);
    for_points_on(soil, spacing, [&](const Vec3& point) {
        const Vec3 at = seen(point);
        const bool on_box = std::max({std::abs(at.x()), -at.y(), std::abs(at.z())}) > reach - spacing;
        if (!on_box) farthest = std::max(farthest, on_wall.nearest(point).distance);
    });
    return farthest;
}

}  // namespace cutterflow::geometry
