#include "validation/corpus/damage.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::validation {
namespace {

std::uint32_t add_point(geometry::TriangleSurface& surface, const Vec3& point) {
    surface.points.push_back(point);
    return static_cast<std::uint32_t>(surface.points.size() - 1);
}

Vec3 point_on_side(const geometry::TriangleSurface& surface, const geometry::Triangle& t, double share) {
    return surface.points[t[0]] + share * (surface.points[t[1]] - surface.points[t[0]]);
}

/// `count` different triangles, no two of which share a point.
std::vector<std::size_t> scattered(const geometry::TriangleSurface& surface, std::size_t count, Dice& dice) {
    std::vector<bool> touched(surface.points.size(), false);
    std::vector<std::size_t> chosen;
    for (std::size_t attempt = 0; chosen.size() < count && attempt < 100 * count; ++attempt) {
        const std::size_t t = dice.below(surface.triangles.size());
        const geometry::Triangle& corners = surface.triangles[t];
        if (touched[corners[0]] || touched[corners[1]] || touched[corners[2]]) continue;
        for (const std::uint32_t corner : corners) touched[corner] = true;
        chosen.push_back(t);
    }
    return chosen;
}

void erase_triangles(geometry::TriangleSurface& surface, std::vector<std::size_t> triangles) {
    std::sort(triangles.rbegin(), triangles.rend());
    for (const std::size_t t : triangles) surface.triangles.erase(surface.triangles.begin() + static_cast<std::ptrdiff_t>(t));
}

void add_quad(geometry::TriangleSurface& surface, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    surface.triangles.push_back({a, b, c});
    surface.triangles.push_back({a, c, d});
}

/// A grid that closes on itself in both directions; `twisted`: with the second coordinate reversed where the first closes.
geometry::TriangleSurface closed_grid(int around, int across, bool twisted, Vec3 (*place)(double, double, double, double), double radius,
                                      double tube) {
    geometry::TriangleSurface surface;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) surface.points.push_back(place(2.0 * k_pi * i / around, 2.0 * k_pi * j / across, radius, tube));
    const auto at = [&](int i, int j) {
        if (i == around && twisted) j = across - j;
        return static_cast<std::uint32_t>((i % around) * across + ((j % across) + across) % across);
    };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) add_quad(surface, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    return surface;
}

}  // namespace

geometry::TriangleSurface with_missing_triangles(geometry::TriangleSurface surface, std::size_t count, Dice dice) {
    erase_triangles(surface, scattered(surface, count, dice));
    return surface;
}

geometry::TriangleSurface with_missing_disc(const geometry::TriangleSurface& surface, double radius, Dice dice) {
    const Vec3 middle = geometry::centroid_of(surface, surface.triangles[dice.below(surface.triangles.size())]);
    geometry::TriangleSurface result{surface.points, {}};
    for (const geometry::Triangle& t : surface.triangles)
        if ((geometry::centroid_of(surface, t) - middle).norm() > radius) result.triangles.push_back(t);
    return result;
}

geometry::TriangleSurface with_flipped_triangles(geometry::TriangleSurface surface, std::size_t count, Dice dice) {
    for (std::size_t i = 0; i < count; ++i) {
        geometry::Triangle& t = surface.triangles[dice.below(surface.triangles.size())];
        std::swap(t[1], t[2]);
    }
    return surface;
}

geometry::TriangleSurface inside_out(geometry::TriangleSurface surface) {
    for (geometry::Triangle& t : surface.triangles) std::swap(t[1], t[2]);
    return surface;
}

geometry::TriangleSurface with_duplicates(geometry::TriangleSurface surface, std::size_t count, bool flipped, Dice dice) {
    for (std::size_t i = 0; i < count; ++i) {
        geometry::Triangle t = surface.triangles[dice.below(surface.triangles.size())];
        if (flipped) std::swap(t[1], t[2]);
        surface.triangles.push_back(t);
    }
    return surface;
}

geometry::TriangleSurface with_t_junctions(geometry::TriangleSurface surface, std::size_t count, Dice dice) {
    for (const std::size_t chosen : scattered(surface, count, dice)) {
        const geometry::Triangle t = surface.triangles[chosen];
        const std::uint32_t middle = add_point(surface, point_on_side(surface, t, dice.between(0.3, 0.7)));
        surface.triangles[chosen] = {t[0], middle, t[2]};
        surface.triangles.push_back({middle, t[1], t[2]});
    }
    return surface;
}

geometry::TriangleSurface with_flat_triangles(geometry::TriangleSurface surface, std::size_t count, Dice dice) {
    for (const std::size_t chosen : scattered(surface, count, dice)) {
        const geometry::Triangle t = surface.triangles[chosen];
        const std::uint32_t middle = add_point(surface, point_on_side(surface, t, dice.between(0.3, 0.7)));
        surface.triangles[chosen] = {t[0], middle, t[2]};
        surface.triangles.push_back({middle, t[1], t[2]});
        surface.triangles.push_back({t[0], t[1], middle});
    }
    return surface;
}

geometry::TriangleSurface with_slivers(geometry::TriangleSurface surface, std::size_t count, Dice dice) {
    for (const std::size_t chosen : scattered(surface, count, dice)) {
        const geometry::Triangle t = surface.triangles[chosen];
        const Vec3 on_side = point_on_side(surface, t, dice.between(0.3, 0.7));
        const std::uint32_t inner = add_point(surface, on_side + 1e-4 * (surface.points[t[2]] - on_side));
        surface.triangles[chosen] = {t[0], t[1], inner};
        surface.triangles.push_back({t[1], t[2], inner});
        surface.triangles.push_back({t[2], t[0], inner});
    }
    return surface;
}

geometry::TriangleSurface torn_apart(const geometry::TriangleSurface& surface, double distance, Dice dice) {
    geometry::TriangleSurface torn;
    for (const geometry::Triangle& t : surface.triangles) {
        geometry::Triangle own{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto shift = [&] { return dice.between(-distance, distance); };
            const double x = shift(), y = shift(), z = shift();
            own.at(k) = add_point(torn, surface.points[t[k]] + Vec3(x, y, z));
        }
        torn.triangles.push_back(own);
    }
    return torn;
}

geometry::TriangleSurface with_folds(geometry::TriangleSurface surface, std::size_t count, Dice dice) {
    for (const std::size_t chosen : scattered(surface, count, dice)) {
        const geometry::Triangle& t = surface.triangles[chosen];
        surface.points[t[0]] = point_on_side(surface, t, 1.2);
    }
    return surface;
}

geometry::TriangleSurface with_fins(geometry::TriangleSurface surface, std::size_t count, Dice dice) {
    for (const std::size_t chosen : scattered(surface, count, dice)) {
        const geometry::Triangle t = surface.triangles[chosen];
        const Vec3 normal = geometry::area_vector(surface, t).normalized();
        const double length = (surface.points[t[1]] - surface.points[t[0]]).norm();
        const std::uint32_t tip = add_point(surface, point_on_side(surface, t, 0.5) + length * normal);
        surface.triangles.push_back({t[0], t[1], tip});
    }
    return surface;
}

geometry::TriangleSurface with_inner_wall(geometry::TriangleSurface surface, const std::vector<std::uint32_t>& ring) {
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t p : ring) middle += surface.points[p] / static_cast<double>(ring.size());
    const std::uint32_t centre = add_point(surface, middle);
    for (std::size_t k = 0; k < ring.size(); ++k) surface.triangles.push_back({ring[k], ring[(k + 1) % ring.size()], centre});
    return surface;
}

geometry::TriangleSurface ball(double radius, int subdivisions) {
    // An octahedron, so that the sections through the middle are circles of points.
    geometry::TriangleSurface surface{{Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX(), -Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ()},
                                      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}}};
    for (int s = 0; s < subdivisions; ++s) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        geometry::TriangleSurface finer{surface.points, {}};
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto key = std::minmax(a, b);
            const auto found = middles.find(key);
            if (found != middles.end()) return found->second;
            const std::uint32_t index = add_point(finer, (surface.points[a] + surface.points[b]).normalized());
            middles.emplace(key, index);
            return index;
        };
        for (const geometry::Triangle& t : surface.triangles) {
            const std::uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
            for (const geometry::Triangle& part : {geometry::Triangle{t[0], ab, ca}, geometry::Triangle{ab, t[1], bc},
                                                   geometry::Triangle{ca, bc, t[2]}, geometry::Triangle{ab, bc, ca}})
                finer.triangles.push_back(part);
        }
        surface = finer;
    }
    for (Vec3& p : surface.points) p *= radius;
    return surface;
}

geometry::TriangleSurface block(const Vec3& low, const Vec3& high, int n) {
    geometry::TriangleSurface surface;
    // Sides that meet must have equal points.
    const auto between = [n](double from, double to, int i) { return i == n ? to : from + (to - from) * i / n; };
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const auto first = static_cast<std::uint32_t>(surface.points.size());
            for (int i = 0; i <= n; ++i)
                for (int j = 0; j <= n; ++j) {
                    Vec3 p;
                    p[axis] = upper ? high[axis] : low[axis];
                    p[u] = between(low[u], high[u], i);
                    p[v] = between(low[v], high[v], j);
                    surface.points.push_back(p);
                }
            const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(i * (n + 1) + j); };
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    if (upper) {
                        add_quad(surface, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                    } else {
                        add_quad(surface, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
                    }
                }
        }
    return geometry::welded(surface);
}

geometry::TriangleSurface ring_torus(double radius, double tube, int around, int across) {
    const auto place = [](double u, double v, double r, double a) {
        return Vec3((r + a * std::cos(v)) * std::cos(u), (r + a * std::cos(v)) * std::sin(u), a * std::sin(v));
    };
    return closed_grid(around, across, false, place, radius, tube);
}

geometry::TriangleSurface moved(const geometry::TriangleSurface& surface, const Vec3& by) {
    return geometry::transformed(surface, Eigen::Affine3d(Eigen::Translation3d(by)));
}

std::vector<std::uint32_t> equator(const geometry::TriangleSurface& surface) {
    std::vector<std::uint32_t> ring;
    for (std::uint32_t p = 0; p < surface.points.size(); ++p)
        if (std::abs(surface.points[p].z()) < 1e-9) ring.push_back(p);
    std::sort(ring.begin(), ring.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::atan2(surface.points[a].y(), surface.points[a].x()) < std::atan2(surface.points[b].y(), surface.points[b].x());
    });
    return ring;
}

geometry::TriangleSurface moebius_band(double radius, double width, int around) {
    geometry::TriangleSurface surface;
    for (int i = 0; i < around; ++i)
        for (const double side : {-0.5, 0.5}) {
            const double u = 2.0 * k_pi * i / around;
            const double r = radius + side * width * std::cos(0.5 * u);
            surface.points.emplace_back(r * std::cos(u), r * std::sin(u), side * width * std::sin(0.5 * u));
        }
    const auto at = [&](int i, int side) { return static_cast<std::uint32_t>(i < around ? 2 * i + side : 1 - side); };
    for (int i = 0; i < around; ++i) add_quad(surface, at(i, 0), at(i + 1, 0), at(i + 1, 1), at(i, 1));
    return surface;
}

geometry::TriangleSurface klein_bottle(double radius, double tube, int around, int across) {
    // The figure-8 immersion.
    const auto place = [](double u, double v, double r, double a) {
        const double w = r + a * (std::cos(0.5 * u) * std::sin(v) - std::sin(0.5 * u) * std::sin(2.0 * v));
        return Vec3(w * std::cos(u), w * std::sin(u), a * (std::sin(0.5 * u) * std::sin(v) + std::cos(0.5 * u) * std::sin(2.0 * v)));
    };
    return closed_grid(around, across, true, place, radius, tube);
}

}  // namespace cutterflow::validation
