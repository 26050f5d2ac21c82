#include "geometry/repair/winding.hpp"

#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::geometry::repair {

double solid_angle_share(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& seen_from) {
    const Vec3 u = a - seen_from;
    const Vec3 v = b - seen_from;
    const Vec3 w = c - seen_from;
    const double lu = u.norm();
    const double lv = v.norm();
    const double lw = w.norm();
    const double numerator = u.dot(v.cross(w));
    if (numerator == 0.0) return 0.0;
    return std::atan2(numerator, lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv) / (2.0 * k_pi);
}

double winding_number(const TriangleSurface& surface, const Vec3& point) {
    double sum = 0.0;
    for (const Triangle& t : surface.triangles)
        sum += solid_angle_share(surface.points[t[0]], surface.points[t[1]], surface.points[t[2]], point);
    return sum;
}

}  // namespace cutterflow::geometry::repair
