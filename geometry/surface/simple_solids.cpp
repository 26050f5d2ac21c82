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
    for (const MeridianPoint& point : section) radius = std::max(radius, point.r);
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

}  // namespace cutterflow::geometry
