#include "geometry/base/region.hpp"

namespace cutterflow {
namespace {

bool holds(const EverywhereRegion&, const Vec3&) {
    return true;
}
bool holds(const BoxRegion& box, const Vec3& point) {
    return (point.array() >= box.lower.array()).all() && (point.array() <= box.upper.array()).all();
}
bool holds(const SphereRegion& sphere, const Vec3& point) {
    return (point - sphere.centre).norm() <= sphere.radius;
}
bool holds(const CylinderRegion& cylinder, const Vec3& point) {
    const Vec3 axis = cylinder.to - cylinder.from, from = point - cylinder.from;
    const double along = axis.dot(from) / axis.squaredNorm();
    return along >= 0.0 && along <= 1.0 && (from - along * axis).norm() <= cylinder.radius;
}
bool holds(const HalfSpaceRegion& half, const Vec3& point) {
    return half.normal.dot(point - half.point) >= 0.0;
}

}  // namespace

bool is_within(const Region& region, const Vec3& point) {
    return std::visit([&](const auto& part) { return holds(part, point); }, region);
}

}  // namespace cutterflow
