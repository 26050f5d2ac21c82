#pragma once
/// \file A small renderer for pictures of the head with its rock: parallel projection, depth buffer, shaded steel and spheres.
#include <vector>

#include "geometry/base/vec3.hpp"
#include "postproc/draw/image.hpp"
#include "postproc/draw/triangle_surface.hpp"

namespace cutterflow::postproc {

/// Parallel projection. `right`, `up` and `towards` (to the viewer) are orthonormal and right-handed.
struct View {
    Vec3 centre = Vec3::Zero();  ///< point in the picture's middle [m]
    Vec3 right = Vec3::UnitX();
    Vec3 up = Vec3::UnitY();
    Vec3 towards = Vec3::UnitZ();
    double height_m = 1.0;      ///< seen from bottom to top
    int width = 1, height = 1;  ///< pixels
    /// Pixel coordinates (x to the right, y down) and depth towards the viewer [m] of a point.
    Vec3 project(const Vec3& point) const;
};

struct Sphere {
    Vec3 centre = Vec3::Zero();
    double radius = 0.0;  ///< [m]
    Colour colour;
};

struct HeadScene {
    TriangleSurface steel;     ///< opaque
    double steel_angle = 0.0;  ///< by which the steel is turned about the z axis [rad]
    TriangleSurface ghosts;    ///< transparent: what would hide the rest
    TriangleSurface soil;      ///< half transparent
    std::vector<Sphere> rocks;
};

/// Picture of a scene on white.
Image render(const HeadScene& scene, const View& view);

}  // namespace cutterflow::postproc
