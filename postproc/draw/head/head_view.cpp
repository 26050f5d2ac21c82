#include "postproc/draw/head/head_view.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "postproc/draw/html.hpp"
#include "postproc/draw/indexed_surface.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;

/// Numbers in little-endian order.
template <typename Triples>
std::string packed(const Triples& triples) {
    std::string bytes;
    for (const auto& triple : triples) {
        for (const auto value : triple) {
            for (std::size_t byte = 0; byte < sizeof value; ++byte) bytes += static_cast<char>((value >> (8 * byte)) & 0xff);
        }
    }
    return base64(bytes);
}

double rounded(double metres) {
    return std::round(metres * 1e5) / 1e5;
}

std::string hex_of(const Colour& colour) {
    const auto byte = [](double share) { return std::lround(255.0 * share); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.red), byte(colour.green), byte(colour.blue));
}

json triple(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

json surface_json(const TriangleSurface& surface) {
    const IndexedSurface indexed = index_surface(surface);
    return {
        {"low", triple(indexed.low)}, {"step", indexed.step}, {"points", packed(indexed.points)}, {"triangles", packed(indexed.triangles)}};
}

}  // namespace

std::size_t ViewSurfaces::number_of(const TriangleSurface& surface) {
    const json added = surface_json(surface);
    const auto found = std::find(surfaces_.begin(), surfaces_.end(), added);
    const auto number = static_cast<std::size_t>(found - surfaces_.begin());
    if (found == surfaces_.end()) surfaces_.push_back(added);
    return number;
}

std::string ViewSurfaces::markup() const {
    return surfaces_.empty() ? "" : html::data("surfaces", surfaces_);
}

json head_view(const HeadScene& scene, const View& view, ViewSurfaces& surfaces) {
    std::map<std::string, json> rocks;
    for (const Sphere& rock : scene.rocks) {
        rocks[hex_of(rock.colour)].push_back({rounded(rock.centre.x()), rounded(rock.centre.y()), rounded(rock.centre.z()), rock.radius});
    }
    json groups = json::array();
    for (const auto& [colour, spheres] : rocks) groups.push_back({{"colour", colour}, {"spheres", spheres}});
    const auto numbers = [&](const TriangleSurface& surface) {
        return surface.empty() ? json::array() : json::array({surfaces.number_of(surface)});
    };
    return {{"steel", surfaces.number_of(scene.steel)},
            {"steel_angle", scene.steel_angle},
            {"ghosts", numbers(scene.ghosts)},
            {"soil", numbers(scene.soil)},
            {"rocks", groups},
            {"centre", triple(view.centre)},
            {"up", triple(view.up)},
            {"towards", triple(view.towards)},
            {"height_m", view.height_m},
            {"aspect", static_cast<double>(view.width) / view.height}};
}

}  // namespace cutterflow::postproc
