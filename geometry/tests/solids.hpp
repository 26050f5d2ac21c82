#pragma once
/// \file Hand-made solids and the shipped head for the tests of geometry.
#include <string>

#include "geometry/head/crown_cutter.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry::testing {

/// Axis-parallel box, 12 triangles: two each on -x, +x, -y, +y, -z, +z, in this order.
inline TriangleSurface box(const Vec3& low, const Vec3& high) {
    TriangleSurface surface;
    for (int i = 0; i < 8; ++i)
        surface.points.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                                    (i & 4) != 0 ? high.z() : low.z());
    surface.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                         {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return surface;
}

inline TriangleSurface unit_cube() {
    return box(Vec3::Zero(), Vec3::Ones());
}

/// Corner of the unit cube, volume 1/6.
inline TriangleSurface tetrahedron() {
    return {{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

inline CrownParameters model_crown() {
    return read_crown_parameters(std::string(CUTTERFLOW_SOURCE_DIR) + "/cases/examples/model_cutter/crown.toml");
}

}  // namespace cutterflow::geometry::testing
