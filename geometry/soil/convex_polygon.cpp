#include "geometry/soil/convex_polygon.hpp"

namespace cutterflow::geometry {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

PlanarMoment moment_of(const PlanarLoop& polygon) {
    PlanarMoment moment;
    for (std::size_t k = 2; k < polygon.size(); ++k) {
        const double area = 0.5 * cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
        moment.area += area;
        moment.first += area / 3.0 * (polygon[0] + polygon[k - 1] + polygon[k]);
    }
    return moment;
}

PlanarLoop clipped(const PlanarLoop& convex, const Eigen::Vector2d& on, const Eigen::Vector2d& inwards) {
    PlanarLoop kept;
    for (std::size_t k = 0; k < convex.size(); ++k) {
        const Eigen::Vector2d &from = convex[k], &to = convex[(k + 1) % convex.size()];
        const double before = (from - on).dot(inwards), after = (to - on).dot(inwards);
        if (before >= 0.0) kept.push_back(from);
        if ((before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0)) kept.push_back(from + before / (before - after) * (to - from));
    }
    return kept;
}

PlanarLoop clipped(const PlanarLoop& convex, const PlanarLoop& by) {
    PlanarLoop kept = convex;
    for (std::size_t k = 0; k < by.size() && !kept.empty(); ++k) {
        const Eigen::Vector2d side = by[(k + 1) % by.size()] - by[k];
        kept = clipped(kept, by[k], Eigen::Vector2d(-side.y(), side.x()));
    }
    return kept;
}

PlanarLoop moved(PlanarLoop polygon, const Eigen::Vector2d& by) {
    for (Eigen::Vector2d& corner : polygon) corner += by;
    return polygon;
}

}  // namespace cutterflow::geometry
