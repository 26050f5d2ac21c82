#include "geometry/surface/simple_solids.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/surface/revolve.hpp"

namespace cutterflow::geometry {
namespace {

constexpr std::size_t k_least_segments = 64;
constexpr double k_undivided = 1e6;       // [m]: sides stay whole
constexpr double k_most_triangles = 1e7;  // what an STL file that is read may have

struct NamedSize {
    const char* name;
    double value;
    bool may_be_zero = false;
};

void require_sizes(const std::vector<NamedSize>& sizes) {
    std::vector<Mistake> mistakes;
    for (const NamedSize& size : sizes) {
        const bool kept = std::isfinite(size.value) && (size.value > 0.0 || (size.may_be_zero && size.value == 0.0));
        if (!kept)
            mistakes.push_back({"", fmt::format("{} = {} m", size.name, size.value),
                                size.may_be_zero ? "It must be 0 or more" : "It must be above 0", "Correct it"});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

TriangleSurface revolved(const std::vector<MeridianPoint>& section, double edge_length) {
    double radius = 0.0;
    double way = 0.0;
    for (std::size_t i = 0; i < section.size(); ++i) {
        const MeridianPoint &point = section[i], &next = section[(i + 1) % section.size()];
        radius = std::max(radius, point.r);
        way += std::hypot(next.r - point.r, next.z - point.z);
    }
    require_few_triangles(2.0 * k_pi * radius * way, edge_length, k_most_triangles);
    return solid_of_revolution(section, std::max(k_least_segments, circle_segments(radius, edge_length)), edge_length);
}

/// One side of a box: the rectangle at `origin` between two edge vectors, whose cross product points outwards, in m x n cells.
void add_side(TriangleSurface& surface, const Vec3& origin, const Vec3& a, const Vec3& b, double edge_length) {
    const auto parts = [&](const Vec3& edge) { return std::max(1, static_cast<int>(std::ceil(edge.norm() / edge_length - 1e-9))); };
    const int m = parts(a), n = parts(b);
    const auto first = static_cast<std::uint32_t>(surface.points.size());
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j) surface.points.push_back(origin + a * (static_cast<double>(i) / m) + b * (static_cast<double>(j) / n));
    const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(i * (n + 1) + j); };
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < n; ++j) {
            surface.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
}

}  // namespace

double PipeParameters::volume() const {
    return k_pi * wall * (2.0 * inner_radius + wall) * length;
}

double FunnelParameters::volume() const {
    return k_pi * wall * ((inlet_radius + outlet_radius + wall) * cone_height + (2.0 * outlet_radius + wall) * spout_length);
}

TriangleSurface generate_pipe(const PipeParameters& p) {
    require_sizes({{"inner radius", p.inner_radius, true}, {"wall", p.wall}, {"length", p.length}, {"edge length", p.edge_length}});
    const double outer = p.inner_radius + p.wall;
    return revolved({{p.inner_radius, 0.0}, {outer, 0.0}, {outer, p.length}, {p.inner_radius, p.length}}, p.edge_length);
}

TriangleSurface generate_funnel(const FunnelParameters& p) {
    require_sizes({{"inlet radius", p.inlet_radius},
                   {"outlet radius", p.outlet_radius},
                   {"cone height", p.cone_height},
                   {"spout length", p.spout_length, true},
                   {"wall", p.wall},
                   {"edge length", p.edge_length}});
    if (p.inlet_radius < p.outlet_radius)
        throw UserError(fmt::format("inlet radius = {} m", p.inlet_radius),
                        fmt::format("It must not be below the outlet radius {} m: a funnel narrows downwards", p.outlet_radius),
                        "Exchange them");
    const double top = p.spout_length + p.cone_height;
    std::vector<MeridianPoint> section = {{p.outlet_radius, 0.0}, {p.outlet_radius + p.wall, 0.0}};
    if (p.spout_length > 0.0) section.push_back({p.outlet_radius + p.wall, p.spout_length});
    section.push_back({p.inlet_radius + p.wall, top});
    section.push_back({p.inlet_radius, top});
    if (p.spout_length > 0.0) section.push_back({p.outlet_radius, p.spout_length});
    return revolved(section, p.edge_length);
}

TriangleSurface generate_box(const Vec3& size, double edge_length) {
    require_sizes({{"length along x", size.x()}, {"length along y", size.y()}, {"length along z", size.z()}, {"edge length", edge_length}});
    require_few_triangles(2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x()), edge_length, k_most_triangles);
    TriangleSurface box;
    const Vec3 x(size.x(), 0.0, 0.0), y(0.0, size.y(), 0.0), z(0.0, 0.0, size.z());
    add_side(box, Vec3::Zero(), y, x, edge_length);
    add_side(box, Vec3::Zero(), x, z, edge_length);
    add_side(box, Vec3::Zero(), z, y, edge_length);
    add_side(box, z, x, y, edge_length);
    add_side(box, y, z, x, edge_length);
    add_side(box, x, y, z, edge_length);
    const Eigen::Affine3d centred(Eigen::Translation3d(-0.5 * size.x(), -0.5 * size.y(), 0.0));
    return transformed(welded(box), centred);
}

TriangleSurface generate_block(const Vec3& lower, const Vec3& upper) {
    const Vec3 size = upper - lower;
    const TriangleSurface box = generate_box(size, size.maxCoeff());
    return transformed(box, Eigen::Affine3d(Eigen::Translation3d(lower + Vec3(0.5 * size.x(), 0.5 * size.y(), 0.0))));
}

double BinParameters::volume() const {
    const double outer = inner_radius + wall;
    return k_pi * (wall * (2.0 * inner_radius + wall) * height + (outer * outer - orifice_radius * orifice_radius) * wall);
}

TriangleSurface generate_bin(const BinParameters& p) {
    require_sizes({{"inner radius", p.inner_radius}, {"height", p.height}, {"wall", p.wall}, {"orifice radius", p.orifice_radius, true}});
    if (p.orifice_radius >= p.inner_radius)
        throw UserError(fmt::format("orifice radius = {} m", p.orifice_radius),
                        fmt::format("It must be below the inner radius {} m", p.inner_radius), "Correct one of them");
    const double outer = p.inner_radius + p.wall;
    return revolved({{p.orifice_radius, -p.wall},
                     {outer, -p.wall},
                     {outer, p.height},
                     {p.inner_radius, p.height},
                     {p.inner_radius, 0.0},
                     {p.orifice_radius, 0.0}},
                    k_undivided);
}

double DishParameters::volume() const {
    const double outer = radius + (rim_height > 0.0 ? rim_wall : 0.0);
    return k_pi * (outer * outer * thickness + (outer * outer - radius * radius) * rim_height);
}

TriangleSurface generate_dish(const DishParameters& p) {
    require_sizes({{"radius", p.radius},
                   {"thickness", p.thickness},
                   {"rim height", p.rim_height, true},
                   {"rim wall", p.rim_wall, p.rim_height == 0.0}});
    if (p.rim_height == 0.0) return revolved({{0.0, -p.thickness}, {p.radius, -p.thickness}, {p.radius, 0.0}, {0.0, 0.0}}, k_undivided);
    const double outer = p.radius + p.rim_wall;
    return revolved(
        {{0.0, -p.thickness}, {outer, -p.thickness}, {outer, p.rim_height}, {p.radius, p.rim_height}, {p.radius, 0.0}, {0.0, 0.0}},
        k_undivided);
}

double SlottedBoxParameters::volume() const {
    return inner.y() * wall * (2.0 * inner.z() + inner.x() + 2.0 * wall - slot);
}

TriangleSurface generate_slotted_box(const SlottedBoxParameters& p) {
    require_sizes({{"width", p.inner.x()}, {"length", p.inner.y()}, {"height", p.inner.z()}, {"wall", p.wall}, {"slot", p.slot}});
    if (p.slot >= p.inner.x())
        throw UserError(fmt::format("slot = {} m", p.slot), fmt::format("It must be narrower than the box, {} m", p.inner.x()),
                        "Correct one of them");
    // One L each side: its wall stands on the outer end of its floor plate.
    const double in = 0.5 * p.slot, wall = 0.5 * p.inner.x(), out = wall + p.wall, half = 0.5 * p.inner.y();
    const std::vector<Eigen::Vector2d> corners{{in, -p.wall},      {wall, -p.wall},     {out, -p.wall}, {out, 0.0},
                                               {out, p.inner.z()}, {wall, p.inner.z()}, {wall, 0.0},    {in, 0.0}};
    const std::vector<Triangle> cap{{0, 1, 6}, {0, 6, 7}, {1, 2, 3}, {1, 3, 6}, {6, 3, 4}, {6, 4, 5}};  // counter-clockwise in (x, z)
    TriangleSurface right;
    const auto count = static_cast<std::uint32_t>(corners.size());
    for (const double y : {-half, half})
        for (const Eigen::Vector2d& corner : corners) right.points.emplace_back(corner.x(), y, corner.y());
    for (const Triangle& t : cap) {
        right.triangles.push_back(t);  // seen from -y: outward
        right.triangles.push_back({t[0] + count, t[2] + count, t[1] + count});
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        right.triangles.push_back({i, i + count, next + count});
        right.triangles.push_back({i, next + count, next});
    }
    return joined({right, transformed(right, Eigen::Affine3d(Eigen::Scaling(-1.0, 1.0, 1.0)))});
}

}  // namespace cutterflow::geometry
