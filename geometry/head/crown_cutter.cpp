#include "geometry/head/crown_cutter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/cgal/exact_solid.hpp"
#include "geometry/cgal/remesh.hpp"
#include "geometry/cgal/self_intersections.hpp"
#include "geometry/surface/revolve.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_feature_angle_deg = 35.0;
constexpr double k_most_triangles = 2e6;  // the parts are united exactly, at half the edge length
/// The parts are triangulated finer than the result, so that remeshing keeps the chords of the result only.
constexpr double k_part_refinement = 0.5;
/// Shortest edge along the lines where the parts meet, as a share of the result's edges, in the order in which they are tried.
constexpr std::array<double, 4> k_shortest_feature_edges{0.6, 0.4, 0.2, 0.05};
/// The blades' outer edge lies within the ring by this share of its width: no faces of ring and blade coincide.
constexpr double k_edge_inset = 0.08;
constexpr double k_pick_tip = 0.5;      // width of a pick's tip over that of its base
constexpr double k_pick_root = 0.8;     // depth of the pick inside the blade, over its width
constexpr double k_pick_spacing = 1.2;  // least distance of picks over their width

double edge_radius_in_ring(const CrownParameters& p) {
    return p.ring_radius - k_edge_inset * (p.ring_radius - p.ring_inner_radius);
}

/// The outer edge of a blade in the meridional half plane, by arc length from the ring end.
class EdgeCurve {
public:
    explicit EdgeCurve(const CrownParameters& p) {
        const double r_ring = edge_radius_in_ring(p);
        const double z_ring = -0.5 * p.ring_height;
        const double r_hub = 0.6 * p.hub_radius;
        const double z_hub = -p.hub_depth + 0.15 * p.hub_height;
        constexpr int k_samples = 2000;
        for (int i = 0; i <= k_samples; ++i) {
            const double t = 0.5 * k_pi * i / k_samples;
            const double power = 2.0 / p.contour_exponent;
            points_.emplace_back(r_hub + (r_ring - r_hub) * std::pow(std::max(0.0, std::cos(t)), power),
                                 z_ring - (z_ring - z_hub) * std::pow(std::sin(t), power));
            length_.push_back(i == 0 ? 0.0 : length_.back() + (points_[i] - points_[i - 1]).norm());
        }
    }

    double length() const { return length_.back(); }

    Eigen::Vector2d at(double s) const {
        const auto above = std::upper_bound(length_.begin(), length_.end(), s);
        const auto i = std::clamp<std::ptrdiff_t>(above - length_.begin(), 1, static_cast<std::ptrdiff_t>(length_.size()) - 1);
        return points_[i - 1] + (s - length_[i - 1]) / (length_[i] - length_[i - 1]) * (points_[i] - points_[i - 1]);
    }

private:
    std::vector<Eigen::Vector2d> points_;
    std::vector<double> length_;
};

/// The blade's sheet: u in [0, 1] from ring to hub along the edge, v in [0, 1] from the edge inwards.
class BladeSheet {
public:
    explicit BladeSheet(const CrownParameters& parameters) : p_(parameters), edge_(parameters) {}

    double edge_length() const { return edge_.length(); }

    double thickness(double u) const { return p_.blade_thickness + u * (p_.blade_thickness_at_hub - p_.blade_thickness); }

    /// Meridional direction in which the strip points outwards, as (radial, axial).
    static Eigen::Vector2d outwards(double u) { return {std::cos(0.5 * k_pi * u), -std::sin(0.5 * k_pi * u)}; }

    /// Azimuth per positive rotation in the sense in which the head carries: +1 or -1.
    double carrying_sense() const { return p_.blade_wrap < 0.0 ? -1.0 : 1.0; }

    Vec3 point(double u, double v) const {
        const double s = u * edge_.length();
        const Eigen::Vector2d edge = edge_.at(s);
        const double distance = v * (p_.blade_depth_at_ring + u * (p_.blade_depth_at_hub - p_.blade_depth_at_ring));
        const Eigen::Vector2d at = edge - distance * outwards(u);
        const double lag = carrying_sense() * std::tan(p_.blade_rake) * distance / std::max(edge.x(), p_.hub_radius);
        const double azimuth = p_.blade_wrap * u - lag;
        return {at.x() * std::cos(azimuth), at.x() * std::sin(azimuth), at.y()};
    }

    Vec3 normal(double u, double v) const {
        constexpr double h = 1e-4;
        return (point(u + h, v) - point(u - h, v)).cross(point(u, v + h) - point(u, v - h)).normalized();
    }

private:
    CrownParameters p_;
    EdgeCurve edge_;
};

/// Quadrilateral grid of (rows + 1) x (columns + 1) indices as triangles, split along the shorter diagonal.
void add_quad(TriangleSurface& surface, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const auto& x = surface.points;
    if ((x[a] - x[c]).squaredNorm() <= (x[b] - x[d]).squaredNorm()) {
        surface.triangles.push_back({a, b, c});
        surface.triangles.push_back({a, c, d});
    } else {
        surface.triangles.push_back({a, b, d});
        surface.triangles.push_back({b, c, d});
    }
}

struct Grid {
    int rows = 0;
    int columns = 0;
    std::uint32_t first = 0;
    std::uint32_t at(int i, int j) const { return first + static_cast<std::uint32_t>(i * (columns + 1) + j); }
};

/// Indices around a grid's rim, closed.
std::vector<std::uint32_t> rim_of(const Grid& grid) {
    std::vector<std::uint32_t> rim;
    for (int j = 0; j < grid.columns; ++j) rim.push_back(grid.at(0, j));
    for (int i = 0; i < grid.rows; ++i) rim.push_back(grid.at(i, grid.columns));
    for (int j = grid.columns; j > 0; --j) rim.push_back(grid.at(grid.rows, j));
    for (int i = grid.rows; i > 0; --i) rim.push_back(grid.at(i, 0));
    return rim;
}

/// The sheet moved along its normal by `side` thicknesses.
Grid add_offset_sheet(TriangleSurface& surface, const BladeSheet& sheet, int rows, int columns, double side) {
    const Grid grid{rows, columns, static_cast<std::uint32_t>(surface.points.size())};
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j <= columns; ++j) {
            const double u = static_cast<double>(i) / rows;
            const double v = static_cast<double>(j) / columns;
            surface.points.push_back(sheet.point(u, v) + side * sheet.thickness(u) * sheet.normal(u, v));
        }
    return grid;
}

TriangleSurface crown_ring(const CrownParameters& p, double edge) {
    const std::vector<MeridianPoint> section{
        {p.ring_inner_radius, -p.ring_height}, {p.ring_radius, -p.ring_height}, {p.ring_radius, 0.0}, {p.ring_inner_radius, 0.0}};
    return solid_of_revolution(section, circle_segments(p.ring_radius, edge), edge);
}

TriangleSurface crown_hub(const CrownParameters& p, double edge) {
    std::vector<MeridianPoint> section{{0.0, p.hub_height - p.hub_depth}, {p.hub_radius, p.hub_height - p.hub_depth}};
    const double sphere_radius = (p.hub_radius * p.hub_radius + p.hub_cap_height * p.hub_cap_height) / (2.0 * p.hub_cap_height);
    const double half_angle = std::asin(p.hub_radius / sphere_radius);
    const int arcs = std::max(4, static_cast<int>(std::ceil(half_angle * sphere_radius / edge)));
    const double z_centre = -p.hub_depth - p.hub_cap_height + sphere_radius;
    section.push_back({p.hub_radius, -p.hub_depth});
    for (int k = arcs - 1; k > 0; --k) {
        const double angle = half_angle * k / arcs;
        section.push_back({sphere_radius * std::sin(angle), z_centre - sphere_radius * std::cos(angle)});
    }
    section.push_back({0.0, -p.hub_depth - p.hub_cap_height});
    return solid_of_revolution(section, circle_segments(p.hub_radius, edge), edge);
}

/// From within the hub to the ring plane.
TriangleSurface crown_shaft(const CrownParameters& p, double edge) {
    const double foot = 0.5 * p.hub_height - p.hub_depth;
    const std::vector<MeridianPoint> section{{0.0, foot}, {p.shaft_radius_at_hub, foot}, {p.shaft_radius, 0.0}, {0.0, 0.0}};
    return solid_of_revolution(section, circle_segments(std::max(p.shaft_radius, p.shaft_radius_at_hub), edge), edge);
}

/// Range of the picks on the edge, as parameters u of the sheet: one width clear of ring and hub.
struct PickRange {
    double from = 1.0, to = 0.0;
};

PickRange range_for_picks(const CrownParameters& p) {
    const EdgeCurve edge(p);
    constexpr int k_samples = 1000;
    PickRange range;
    for (int i = 0; i <= k_samples; ++i) {
        const double u = static_cast<double>(i) / k_samples;
        const Eigen::Vector2d at = edge.at(u * edge.length());
        if (at.y() > -p.ring_height - p.pick_width || at.x() < p.hub_radius + p.pick_width) continue;
        range.from = std::min(range.from, u);
        range.to = std::max(range.to, u);
    }
    return range;
}

double length_for_picks(const CrownParameters& p) {
    const PickRange range = range_for_picks(p);
    return std::max(0.0, range.to - range.from) * EdgeCurve(p).length();
}

/// Frustum along `axis` through `foot` on the blade's edge; two of its sides are parallel to `along` as far as the axis lets them be.
TriangleSurface pick_at(const Vec3& foot, const Vec3& axis, const Vec3& along, const CrownParameters& p) {
    const Vec3 e0 = (along - along.dot(axis) * axis).normalized();
    const Vec3 e1 = axis.cross(e0);
    const double root = k_pick_root * p.pick_width;
    TriangleSurface pick;
    for (const auto& [height, half] : {std::pair(-root, 0.5 * p.pick_width), std::pair(p.pick_length, 0.5 * k_pick_tip * p.pick_width)})
        for (const auto& [a, b] : {std::pair(-1.0, -1.0), std::pair(1.0, -1.0), std::pair(1.0, 1.0), std::pair(-1.0, 1.0)})
            pick.points.push_back(foot + height * axis + half * (a * e0 + b * e1));
    pick.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
    for (std::uint32_t k = 0; k < 4; ++k) {
        const std::uint32_t next = (k + 1) % 4;
        pick.triangles.push_back({k, next, next + 4});
        pick.triangles.push_back({k, next + 4, k + 4});
    }
    return pick;
}

void require_consistent(const CrownParameters& p) {
    std::vector<Mistake> mistakes;
    const auto require = [&mistakes](bool holds, std::string what, std::string rule, std::string remedy) {
        if (!holds) mistakes.push_back({"", std::move(what), std::move(rule), std::move(remedy)});
    };
    require(p.ring_inner_radius < p.ring_radius, fmt::format("ring.inner_radius_m = {}", p.ring_inner_radius),
            fmt::format("It must be smaller than ring.radius_m = {}", p.ring_radius), "Make the ring's bore smaller");
    require(p.hub_radius < p.ring_inner_radius, fmt::format("hub.radius_m = {}", p.hub_radius),
            fmt::format("It must be smaller than ring.inner_radius_m = {}", p.ring_inner_radius), "Make the hub smaller");
    require(p.hub_cap_height <= p.hub_radius, fmt::format("hub.cap_height_m = {}", p.hub_cap_height),
            fmt::format("A spherical cap is no higher than its radius, hub.radius_m = {}", p.hub_radius), "Make the cap flatter");
    require(p.hub_depth > p.ring_height, fmt::format("hub.depth_m = {}", p.hub_depth),
            fmt::format("The hub's rim must lie below the ring: more than ring.height_m = {}", p.ring_height),
            "Make the head deeper or the ring lower");
    require(p.hub_depth <= p.ring_height || p.hub_depth - p.hub_height > p.ring_height, fmt::format("hub.height_m = {}", p.hub_height),
            fmt::format("The hub must end below the ring: less than hub.depth_m - ring.height_m = {:.6g}", p.hub_depth - p.ring_height),
            "Make the hub's cylinder lower or the head deeper");
    const double width = edge_radius_in_ring(p) - p.shaft_radius;
    require(p.blade_depth_at_ring < width, fmt::format("blades.depth_at_ring_m = {}", p.blade_depth_at_ring),
            fmt::format("Blades must end outside shaft and axis, {:.4g} m from their outer edge", width), "Make the blades less deep");
    require(p.shaft_radius < p.ring_inner_radius, fmt::format("shaft.radius_m = {}", p.shaft_radius),
            fmt::format("The ring's bore must stay open: less than ring.inner_radius_m = {}", p.ring_inner_radius),
            "Make the shaft thinner");
    require(p.shaft_radius_at_hub < p.hub_radius || p.shaft_radius == 0.0, fmt::format("shaft.radius_at_hub_m = {}", p.shaft_radius_at_hub),
            fmt::format("It must stand on the hub: less than hub.radius_m = {}", p.hub_radius), "Make the shaft thinner or the hub wider");
    const double thickest = std::max(p.blade_thickness, p.blade_thickness_at_hub);
    require(p.blade_thickness < p.ring_height, fmt::format("blades.thickness_m = {}", p.blade_thickness),
            fmt::format("A blade must end within the ring, ring.height_m = {}", p.ring_height),
            p.blade_thickness < p.hub_depth - p.hub_height ? "Make the blade thinner or the ring higher"
                                                           : "Make the blade thinner: a ring that held it would reach down to the hub");
    const double pitch = 2.0 * k_pi * p.hub_radius / p.blade_count;
    require(thickest < 0.7 * pitch,
            fmt::format("blades.thickness_m = {}, blades.thickness_at_hub_m = {}", p.blade_thickness, p.blade_thickness_at_hub),
            fmt::format("The passages must stay open at the hub: less than 0.7 of the pitch there, {:.4g}", pitch),
            "Take fewer or thinner blades or a larger hub");
    if (p.picks_per_blade > 0) {
        const double room = length_for_picks(p);
        require(k_pick_spacing * p.pick_width * p.picks_per_blade <= room, fmt::format("picks.per_blade = {}", p.picks_per_blade),
                fmt::format("Picks of picks.width_m = {} need {} times their width each, and the edge has {:.4g} m between ring and hub",
                            p.pick_width, k_pick_spacing, room),
                "Take fewer or narrower picks");
        require(k_pick_root * p.pick_width < std::min(p.blade_depth_at_ring, p.blade_depth_at_hub),
                fmt::format("picks.width_m = {}", p.pick_width),
                fmt::format("A pick reaches {} of its width into the blade, which is {} deep", k_pick_root,
                            std::min(p.blade_depth_at_ring, p.blade_depth_at_hub)),
                "Make the picks narrower or the blades deeper");
    }
    require(p.edge_length <= p.hub_radius, fmt::format("surface.edge_length_m = {}", p.edge_length),
            fmt::format("Edges longer than hub.radius_m = {} leave less than a hexagon of the hub", p.hub_radius),
            "Make the edges shorter");
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

void require_simple(const TriangleSurface& blade) {
    if (!find_self_intersections(blade).empty())
        throw UserError("a blade crosses itself", "Its strip must not be bent more sharply than it is deep or thick",
                        "Reduce blades.wrap_deg, blades.thickness_m or the blades' depth");
}

void require_one_solid(const TriangleSurface& cutter) {
    const SoundnessReport report = inspect_surface(cutter);
    if (report.components.size() > 1)
        throw CheckFailure({"", fmt::format("the cutter consists of {} separate parts", report.components.size()),
                            "Ring, blades and hub must be connected",
                            "Make the blades deeper or thicker, so that they reach into ring and hub"});
    const std::vector<Mistake> defects = defects_of(report, "the generated cutter");
    if (!defects.empty())
        throw CheckFailure({defects.front().where, defects.front().what, defects.front().rule,
                            "Change the sizes a little: faces of ring, hub and blades nearly coincide"});
}

TriangleSurface remeshed_once(const TriangleSurface& united, double edge_length, double shortest_feature_edge) {
    const TriangleSurface thinned = with_thinned_features(united, shortest_feature_edge, k_feature_angle_deg);
    const TriangleSurface cutter = sorted(remeshed(thinned, edge_length, k_feature_angle_deg));
    require_one_solid(cutter);
    return cutter;
}

/// Where faces meet at a small angle a thinned feature line can pass through the face beside it: then it is thinned less.
TriangleSurface remeshed_cutter(const TriangleSurface& united, double edge_length) {
    for (const double shortest : k_shortest_feature_edges) {
        try {
            return remeshed_once(united, edge_length, shortest * edge_length);
        } catch (const CheckFailure&) {
            if (shortest == k_shortest_feature_edges.back()) throw;
        }
    }
    return {};
}

}  // namespace

TriangleSurface crown_blade(const CrownParameters& p) {
    const BladeSheet sheet(p);
    const double edge = k_part_refinement * p.edge_length;
    // The strip's length exceeds its edge's by the wrap; a shared upper bound keeps the quadrilaterals below the edge length.
    const double strip_length = std::hypot(sheet.edge_length(), p.blade_wrap * p.ring_radius);
    const int rows = static_cast<int>(std::ceil(strip_length / edge));
    const int columns = static_cast<int>(std::ceil(std::max(p.blade_depth_at_ring, p.blade_depth_at_hub) / edge));
    TriangleSurface blade;
    const Grid top = add_offset_sheet(blade, sheet, rows, columns, 0.5);
    const Grid bottom = add_offset_sheet(blade, sheet, rows, columns, -0.5);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            add_quad(blade, top.at(i, j), top.at(i + 1, j), top.at(i + 1, j + 1), top.at(i, j + 1));
            add_quad(blade, bottom.at(i, j), bottom.at(i, j + 1), bottom.at(i + 1, j + 1), bottom.at(i + 1, j));
        }
    const std::vector<std::uint32_t> top_rim = rim_of(top);
    const std::vector<std::uint32_t> bottom_rim = rim_of(bottom);
    for (std::size_t k = 0; k < top_rim.size(); ++k) {
        const std::size_t next = (k + 1) % top_rim.size();
        add_quad(blade, top_rim[k], top_rim[next], bottom_rim[next], bottom_rim[k]);
    }
    if (volume_of(blade) < 0.0)
        for (Triangle& triangle : blade.triangles) std::swap(triangle[1], triangle[2]);
    return blade;
}

std::vector<TriangleSurface> crown_picks(const CrownParameters& p) {
    const BladeSheet sheet(p);
    const PickRange range = range_for_picks(p);
    std::vector<TriangleSurface> picks;
    for (int k = 0; k < p.picks_per_blade; ++k) {
        const double u = range.from + (range.to - range.from) * (k + 0.5) / p.picks_per_blade;
        const Vec3 foot = sheet.point(u, 0.0);
        const double azimuth = std::atan2(foot.y(), foot.x());
        const Eigen::Vector2d out = BladeSheet::outwards(u);
        const Vec3 outwards(out.x() * std::cos(azimuth), out.x() * std::sin(azimuth), out.y());
        const Vec3 ahead = sheet.carrying_sense() * Vec3(-std::sin(azimuth), std::cos(azimuth), 0.0);
        const Vec3 axis = std::cos(p.pick_lean) * outwards + std::sin(p.pick_lean) * ahead;
        constexpr double h = 1e-4;
        picks.push_back(pick_at(foot, axis, sheet.point(u + h, 0.0) - sheet.point(u - h, 0.0), p));
    }
    return picks;
}

TriangleSurface united_crown_parts(const CrownParameters& p) {
    require_consistent(p);
    const double part_edge = k_part_refinement * p.edge_length;
    require_few_triangles(4.0 * k_pi * p.ring_radius * p.ring_radius, p.edge_length, k_most_triangles);
    ExactSolid head(crown_hub(p, part_edge));
    if (p.shaft_radius > 0.0) head.unite(ExactSolid(crown_shaft(p, part_edge)));
    const TriangleSurface blade = crown_blade(p);
    require_simple(blade);
    const TriangleSurface picks = joined(crown_picks(p));
    std::vector<TriangleSurface> all_picks;
    for (int i = 0; i < p.blade_count; ++i) {
        const Eigen::Affine3d turn(Eigen::AngleAxisd(2.0 * k_pi * i / p.blade_count, Vec3::UnitZ()));
        head.unite(ExactSolid(transformed(blade, turn)));
        all_picks.push_back(transformed(picks, turn));
    }
    head.unite(ExactSolid(crown_ring(p, part_edge)));
    if (p.picks_per_blade > 0) head.unite(ExactSolid(joined(all_picks)));
    return head.surface();
}

TriangleSurface generate_crown_cutter(const CrownParameters& p) {
    return remeshed_cutter(united_crown_parts(p), p.edge_length);
}

}  // namespace cutterflow::geometry
