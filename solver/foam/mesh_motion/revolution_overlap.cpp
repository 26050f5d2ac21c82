#include "solver/foam/mesh_motion/revolution_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace cutterflow::foam {

namespace {

constexpr double k_turn = 2.0 * k_pi;
constexpr double k_tolerance = 1e-3;    ///< of the shortest edge: points this near are one
constexpr double k_closed = 1e-9;       ///< of an area: what both sides may differ by
constexpr double k_small_part = 1e-12;  ///< of a face: parts as small as that are none
constexpr double k_fit = 1e-14;         ///< of a face's area: what its parts may lack
constexpr double k_flat = 1e-9;         ///< of the stiffness of a direction: it has none

/// Angle in [0, 2 pi).
double wrapped(double angle) {
    const double rest = std::fmod(angle, k_turn);
    return rest < 0.0 ? rest + k_turn : rest;
}

/// Number of the first value within `tolerance`, for values seen so far.
class Levels {
public:
    explicit Levels(double tolerance) : tolerance_(tolerance) {}
    int of(double value) {
        const auto near = values_.lower_bound(value - tolerance_);
        if (near != values_.end() && near->first <= value + tolerance_) return near->second;
        const int number = static_cast<int>(values_.size());
        values_.emplace(value, number);
        return number;
    }

private:
    double tolerance_;
    std::map<double, int> values_;
};

/// Radius and axial place of the two edges of a face that lie in planes through the axis, as numbers of Levels.
using RingName = std::array<std::pair<int, int>, 2>;

/// A face between two planes through the axis.
struct RingFace {
    RingName ring;
    double start = 0.0, span = 0.0;  ///< azimuth [rad]
    std::array<Vec3, 2> edge;        ///< at start, in the order of the ring's circles
};

double shortest_edge(const std::vector<RevolutionOverlap::Face>& faces) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const auto& face : faces) {
        for (std::size_t c = 0; c < face.size(); ++c) shortest = std::min(shortest, (face[(c + 1) % face.size()] - face[c]).norm());
    }
    return shortest;
}

/// What both sides are measured with.
struct Measure {
    RotationAxis axis;
    Vec3 e0, e1;  ///< normal to the axis
    double tolerance;
    Levels radii, heights;

    Measure(const RotationAxis& about, double length)
        : axis(about),
          e0(about.direction.unitOrthogonal()),
          e1(about.direction.cross(e0)),
          tolerance(length),
          radii(length),
          heights(length) {}

    Eigen::Vector2d in_plane(const Vec3& point) const { return {(point - axis.origin).dot(e0), (point - axis.origin).dot(e1)}; }
    double height(const Vec3& point) const { return (point - axis.origin).dot(axis.direction); }

    /// \return none when the face's corners do not lie on two planes through the axis, two on each and pairwise on common circles
    std::optional<RingFace> ring_face(const RevolutionOverlap::Face& face) {
        if (face.size() != 4) return std::nullopt;
        std::array<double, 4> azimuths{};
        std::array<std::pair<int, int>, 4> circles;
        for (std::size_t c = 0; c < 4; ++c) {
            const Eigen::Vector2d place = in_plane(face[c]);
            const double radius = place.norm();
            if (radius <= tolerance) return std::nullopt;
            azimuths[c] = std::atan2(place.y(), place.x());
            circles[c] = {radii.of(radius), heights.of(height(face[c]))};
        }
        for (const std::size_t first : {std::size_t(0), std::size_t(1)}) {  // the edges first, first + 1 and first + 2, first + 3
            const std::array<std::size_t, 4> corner{first, first + 1, first + 2, (first + 3) % 4};
            const auto apart = [&](std::size_t a, std::size_t b) { return std::remainder(azimuths[b] - azimuths[a], k_turn); };
            const double least = tolerance / in_plane(face[0]).norm();
            const bool along = std::abs(apart(corner[0], corner[1])) < least && std::abs(apart(corner[2], corner[3])) < least;
            if (!along || circles[corner[0]] != circles[corner[3]] || circles[corner[1]] != circles[corner[2]]) continue;
            const double span = apart(corner[0], corner[3]);
            const std::size_t one = corner[span > 0.0 ? 0 : 3], other = corner[span > 0.0 ? 1 : 2];
            RingFace ring_face{{circles[one], circles[other]}, wrapped(azimuths[one]), std::abs(span), {face[one], face[other]}};
            if (ring_face.ring[1] < ring_face.ring[0]) {
                std::swap(ring_face.ring[0], ring_face.ring[1]);
                std::swap(ring_face.edge[0], ring_face.edge[1]);
            }
            return ring_face;
        }
        return std::nullopt;
    }
};

/// Area of a polygon whose corners go round counter-clockwise [m2].
double area_of(const std::vector<Eigen::Vector2d>& corners) {
    double twice = 0.0;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const Eigen::Vector2d &a = corners[c], &b = corners[(c + 1) % corners.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * twice;
}

/// Area vector of a face [m2].
Vec3 area_of(const RevolutionOverlap::Face& face) {
    Vec3 twice = Vec3::Zero();
    for (std::size_t c = 1; c + 1 < face.size(); ++c) twice += (face[c] - face[0]).cross(face[c + 1] - face[0]);
    return 0.5 * twice;
}

/// Parts that two faces share, scaled by little so that those of every face add up to a given area.
class AreaFit {
public:
    /// \param whole  areas of all faces; the sums of both sides are equal
    explicit AreaFit(std::vector<double> whole) : whole_(std::move(whole)), lack_(whole_), used_(whole_.size(), false) {
        parts_.reserve(whole_.size());
    }

    void add(std::size_t one, std::size_t other, double area) {
        parts_.push_back({one, other, area});
        for (const std::size_t face : {one, other}) {
            lack_[face] -= area;
            used_[face] = true;
        }
    }

    std::vector<double> solve() {
        const std::vector<double> scale = scales();
        std::vector<double> areas;
        areas.reserve(parts_.size());
        for (const Part& part : parts_) areas.push_back(part.area * (1.0 + (fits(part) ? scale[part.one] + scale[part.other] : 0.0)));
        return areas;
    }

private:
    struct Part {
        std::size_t one, other;
        double area;
    };

    bool lacks(std::size_t face) const { return used_[face] && std::abs(lack_[face]) > k_small_part * whole_[face]; }
    bool fits(const Part& part) const { return lacks(part.one) && lacks(part.other); }

    /// x with sum over parts of a face of area (x_one + x_other) = lack, by conjugate gradients. Only faces that lack something take part,
    /// those along the rim of a plane, with the parts between them.
    std::vector<double> scales() const {
        std::vector<Part> parts;
        for (const Part& part : parts_)
            if (fits(part)) parts.push_back(part);
        std::vector<double> x(whole_.size(), 0.0), diagonal(x), direction(x), product(x), lack(x);
        std::vector<std::size_t> faces;
        for (const Part& part : parts) {
            for (const std::size_t face : {part.one, part.other}) {
                if (diagonal[face] == 0.0) faces.push_back(face);
                diagonal[face] += part.area;
                lack[face] = lack_[face];
            }
        }
        double before = 1.0;
        for (std::size_t iteration = 0; iteration < 2 * faces.size(); ++iteration) {
            double worst = 0.0, weighed = 0.0;
            for (const std::size_t i : faces) {
                worst = std::max(worst, std::abs(lack[i]) / whole_[i]);
                weighed += lack[i] * lack[i] / diagonal[i];
            }
            if (worst <= k_fit) break;
            for (const std::size_t i : faces) {
                direction[i] = lack[i] / diagonal[i] + weighed / before * direction[i];
                product[i] = diagonal[i] * direction[i];
            }
            for (const Part& part : parts) {
                product[part.one] += part.area * direction[part.other];
                product[part.other] += part.area * direction[part.one];
            }
            double curvature = 0.0, stiffness = 0.0;
            for (const std::size_t i : faces) {
                curvature += direction[i] * product[i];
                stiffness += direction[i] * direction[i] * diagonal[i];
            }
            if (curvature <= k_flat * stiffness) break;  // rounding is left: what one side has more than the other
            for (const std::size_t i : faces) {
                x[i] += weighed / curvature * direction[i];
                lack[i] -= weighed / curvature * product[i];
            }
            before = weighed;
        }
        return x;
    }

    std::vector<double> whole_, lack_;
    std::vector<bool> used_;
    std::vector<Part> parts_;
};

/// Area of the part of a polygon inside a convex one [m2], by Sutherland and Hodgman's clipping [SutherlandHodgman1974].
double shared_area(std::vector<Eigen::Vector2d> polygon, const std::vector<Eigen::Vector2d>& convex) {
    std::vector<Eigen::Vector2d> inside;
    inside.reserve(polygon.size() + convex.size());
    for (std::size_t c = 0; c < convex.size() && !polygon.empty(); ++c) {
        const Eigen::Vector2d from = convex[c], along = convex[(c + 1) % convex.size()] - from;
        const auto left = [&](const Eigen::Vector2d& p) { return along.x() * (p.y() - from.y()) - along.y() * (p.x() - from.x()); };
        inside.clear();
        for (std::size_t p = 0; p < polygon.size(); ++p) {
            const Eigen::Vector2d &a = polygon[p], &b = polygon[(p + 1) % polygon.size()];
            const double of_a = left(a), of_b = left(b);
            if (of_a >= 0.0) inside.push_back(a);
            if ((of_a > 0.0 && of_b < 0.0) || (of_a < 0.0 && of_b > 0.0)) inside.push_back(a + (b - a) * (of_a / (of_a - of_b)));
        }
        polygon.swap(inside);
    }
    return polygon.size() < 3 ? 0.0 : area_of(polygon);
}

/// Shares of every face that add up to 1.
template <class Face, class Share>
void make_whole(std::vector<FaceOverlap>& overlaps, std::size_t faces, Face face, Share share) {
    std::vector<double> sums(faces, 0.0);
    for (const FaceOverlap& overlap : overlaps) sums[overlap.*face] += overlap.*share;
    for (FaceOverlap& overlap : overlaps) overlap.*share /= sums[overlap.*face];
}

}  // namespace

/// One side, sorted into rings and planes.
struct RevolutionOverlap::Side {
    std::map<RingName, Ring> rings;  ///< that are closed
    std::map<int, Plane> planes;     ///< by number of their height
    bool has_others = false;

    /// \param open  names of rings that are not closed on the other side
    Side(const std::vector<Face>& faces, Measure& measure, const std::vector<RingName>& open) {
        std::map<RingName, std::vector<std::pair<RingFace, std::size_t>>> found;
        std::vector<std::size_t> others;
        for (std::size_t f = 0; f < faces.size(); ++f) {
            const std::optional<RingFace> ring_face = measure.ring_face(faces[f]);
            if (ring_face && std::find(open.begin(), open.end(), ring_face->ring) == open.end())
                found[ring_face->ring].emplace_back(*ring_face, f);
            else
                others.push_back(f);
        }
        for (auto& [name, members] : found) {
            if (is_closed(members)) {
                for (const auto& [ring_face, f] : members) {
                    rings[name].starts.push_back(ring_face.start);
                    rings[name].faces.push_back(f);
                    rings[name].edges.push_back(ring_face.edge);
                }
            } else {
                for (const auto& member : members) others.push_back(member.second);
            }
        }
        for (const std::size_t f : others) add_polygon(f, faces[f], measure);
    }

private:
    static bool is_closed(std::vector<std::pair<RingFace, std::size_t>>& members) {
        std::sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.first.start < b.first.start; });
        double whole = 0.0;
        for (std::size_t m = 0; m < members.size(); ++m) {
            const RingFace& face = members[m].first;
            const double next = members[(m + 1) % members.size()].first.start;
            if (std::abs(std::remainder(face.start + face.span - next, k_turn)) > k_tolerance * face.span) return false;
            whole += face.span;
        }
        return std::abs(whole - k_turn) < k_tolerance;
    }

    void add_polygon(std::size_t f, const Face& face, Measure& measure) {
        const int height = measure.heights.of(measure.height(face.front()));
        Polygon polygon;
        polygon.face = f;
        for (const Vec3& corner : face) {
            if (measure.heights.of(measure.height(corner)) != height) has_others = true;
            polygon.corners.push_back(measure.in_plane(corner));
            polygon.centre += polygon.corners.back() / static_cast<double>(face.size());
        }
        if (area_of(polygon.corners) < 0.0) std::reverse(polygon.corners.begin(), polygon.corners.end());
        for (const Eigen::Vector2d& corner : polygon.corners) polygon.reach = std::max(polygon.reach, (corner - polygon.centre).norm());
        planes[height].push_back(std::move(polygon));
    }
};

std::optional<RevolutionOverlap> RevolutionOverlap::between(const std::vector<Face>& still, const std::vector<Face>& turning,
                                                            const RotationAxis& axis) {
    if (still.empty() || turning.empty()) return std::nullopt;
    Measure measure(axis, k_tolerance * std::min(shortest_edge(still), shortest_edge(turning)));
    std::vector<RingName> open;
    Side first(still, measure, open), second(turning, measure, open);
    for (const auto& [name, ring] : first.rings) {
        if (second.rings.count(name) == 0) open.push_back(name);
    }
    for (const auto& [name, ring] : second.rings) {
        if (first.rings.count(name) == 0) open.push_back(name);
    }
    if (!open.empty()) {
        first = Side(still, measure, open);
        second = Side(turning, measure, open);
    }
    if (first.has_others || second.has_others || first.planes.size() != second.planes.size()) return std::nullopt;

    RevolutionOverlap overlap;
    overlap.axis_ = axis;
    for (const Face& face : still) overlap.still_areas_.push_back(area_of(face));
    for (const Face& face : turning) overlap.turning_areas_.push_back(area_of(face));
    for (auto& [name, ring] : first.rings) {
        const bool level = name[0].second == name[1].second, straight = name[0].first == name[1].first;
        overlap.rings_.push_back({{std::move(ring), std::move(second.rings.at(name))},
                                  level      ? Shape::plane
                                  : straight ? Shape::cylinder
                                             : Shape::cone});
    }
    for (auto& [height, plane] : first.planes) {
        const auto other = second.planes.find(height);
        if (other == second.planes.end()) return std::nullopt;
        std::sort(plane.begin(), plane.end(), [](const Polygon& a, const Polygon& b) { return a.centre.x() < b.centre.x(); });
        overlap.planes_.push_back({std::move(plane), std::move(other->second)});
    }
    overlap.pairs_areas_ = overlap.have_equal_areas();
    return overlap;
}

/// In every ring in a plane and every plane, both sides together.
bool RevolutionOverlap::have_equal_areas() const {
    const auto equal = [](double a, double b) { return std::abs(a - b) <= k_closed * a; };
    for (const RingSides& ring : rings_) {
        if (ring.shape == Shape::cylinder) continue;
        double of_still = 0.0, of_turning = 0.0;
        for (const std::size_t face : ring.still.faces) of_still += still_areas_[face].norm();
        for (const std::size_t face : ring.turning.faces) of_turning += turning_areas_[face].norm();
        if (ring.shape == Shape::cone || !equal(of_still, of_turning)) return false;
    }
    for (const Sides<Plane>& plane : planes_) {
        double of_still = 0.0, of_turning = 0.0;
        for (const Polygon& polygon : plane.still) of_still += still_areas_[polygon.face].norm();
        for (const Polygon& polygon : plane.turning) of_turning += turning_areas_[polygon.face].norm();
        if (!equal(of_still, of_turning)) return false;
    }
    return true;
}

std::vector<FaceOverlap> RevolutionOverlap::at(double angle) const {
    std::vector<FaceOverlap> overlaps;
    overlaps.reserve(3 * (still_areas_.size() + turning_areas_.size()) / 2);
    for (const RingSides& ring : rings_) {
        if (ring.shape == Shape::cylinder) add_shared_azimuths(ring, angle, overlaps);
    }
    const std::size_t in_planes = overlaps.size();
    for (const RingSides& ring : rings_) {
        if (ring.shape != Shape::cylinder) add_shared_azimuths(ring, angle, overlaps);
    }
    for (const Sides<Plane>& plane : planes_) add_shared_areas(plane, angle, overlaps);
    if (pairs_areas_) add_plane_areas(overlaps, in_planes);
    make_whole(overlaps, still_areas_.size(), &FaceOverlap::still, &FaceOverlap::of_still);
    make_whole(overlaps, turning_areas_.size(), &FaceOverlap::turned, &FaceOverlap::of_turned);
    return overlaps;
}

/// Of the parts from `first` on. Each is a (1 + x_f + y_g) with a the area found and x, y of its two faces such that a face's parts add up
/// to its area.
void RevolutionOverlap::add_plane_areas(std::vector<FaceOverlap>& overlaps, std::size_t first) const {
    std::vector<double> whole;
    for (const std::vector<Vec3>* side : {&still_areas_, &turning_areas_})
        for (const Vec3& area : *side) whole.push_back(area.norm());
    AreaFit fit(whole);
    for (std::size_t k = first; k < overlaps.size(); ++k) {
        const FaceOverlap& part = overlaps[k];
        fit.add(part.still, still_areas_.size() + part.turned, part.of_still * whole[part.still]);
    }
    const std::vector<double> areas = fit.solve();
    for (std::size_t k = first; k < overlaps.size(); ++k) {
        const double sign = still_areas_[overlaps[k].still].dot(axis_.direction) > 0.0 ? 1.0 : -1.0;
        overlaps[k].area = sign * areas[k - first] * axis_.direction;
    }
}

void RevolutionOverlap::add_shared_azimuths(const RingSides& ring, double angle, std::vector<FaceOverlap>& overlaps) const {
    const bool flat_parts = pairs_areas_ && ring.shape == Shape::cylinder;
    const auto turned_edge = [&](std::size_t face) {
        const Edge& edge = ring.turning.edges[face];
        return Edge{rotate_about(axis_, angle, edge[0]), rotate_about(axis_, angle, edge[1])};
    };
    const Ring &still = ring.still, &turning = ring.turning;
    const std::size_t still_count = still.faces.size(), turning_count = turning.faces.size();
    const double begin = still.starts.front();
    // The turning face in which the first still face begins, in the turning side's own frame.
    const double own = turning.starts.front() + wrapped(begin - angle - turning.starts.front());
    std::size_t turned =
        static_cast<std::size_t>(std::upper_bound(turning.starts.begin(), turning.starts.end(), own) - turning.starts.begin()) - 1;
    double turned_end = begin + (turning.end(turned) - own);
    std::size_t face = 0;
    double at = begin;
    Edge edge = still.edges.front();
    while (face < still_count) {
        const double still_end = still.end(face);
        const double end = std::min(still_end, turned_end);
        const double still_span = still_end - still.starts[face], turned_span = turning.end(turned) - turning.starts[turned];
        const std::size_t next_face = (face + 1) % still_count, next_turned = (turned + 1) % turning_count;
        const Edge next = !flat_parts ? edge : still_end <= turned_end ? still.edges[next_face] : turned_edge(next_turned);
        if (end - at > k_small_part * std::min(still_span, turned_span)) {
            FaceOverlap part{still.faces[face], turning.faces[turned], (end - at) / still_span, (end - at) / turned_span};
            part.area = 0.5 * (next[1] - edge[0]).cross(next[0] - edge[1]);
            if (part.area.dot(still_areas_[part.still]) < 0.0) part.area = -part.area;
            overlaps.push_back(part);
        }
        at = end;
        edge = next;
        if (still_end <= turned_end) {
            ++face;
        } else {
            turned = next_turned;
            turned_end += turning.end(turned) - turning.starts[turned];
        }
    }
}

void RevolutionOverlap::add_shared_areas(const Sides<Plane>& plane, double angle, std::vector<FaceOverlap>& overlaps) {
    double reach = 0.0;
    for (const Polygon& polygon : plane.still) reach = std::max(reach, polygon.reach);

    const Eigen::Rotation2Dd rotation(angle);
    for (const Polygon& turning : plane.turning) {
        const Eigen::Vector2d centre = rotation * turning.centre;
        std::vector<Eigen::Vector2d> corners;
        corners.reserve(turning.corners.size());
        for (const Eigen::Vector2d& corner : turning.corners) corners.push_back(rotation * corner);
        const double whole = area_of(corners);
        const auto is_left = [](const Polygon& polygon, double x) { return polygon.centre.x() < x; };
        const double first = centre.x() - turning.reach - reach, last = centre.x() + turning.reach + reach;
        for (auto still = std::lower_bound(plane.still.begin(), plane.still.end(), first, is_left);
             still != plane.still.end() && still->centre.x() <= last; ++still) {
            if ((still->centre - centre).squaredNorm() > std::pow(still->reach + turning.reach, 2)) continue;
            const double area = shared_area(corners, still->corners), of_still = area_of(still->corners);
            if (area > k_small_part * std::min(whole, of_still))
                overlaps.push_back({still->face, turning.face, area / of_still, area / whole});
        }
    }
}

}  // namespace cutterflow::foam
