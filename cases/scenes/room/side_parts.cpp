#include "cases/scenes/room/side_parts.hpp"

#include <algorithm>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::cases {

namespace {

Eigen::Index axis_of(coupling::DomainSide side) {
    return static_cast<Eigen::Index>(side) / 2;
}

/// The whole side.
BoxRegion side_box(coupling::DomainSide side, const RoomScene& scene) {
    BoxRegion box{scene.lower(), scene.upper()};
    const Eigen::Index axis = axis_of(side);
    const bool low = static_cast<std::size_t>(side) % 2 == 0;
    (low ? box.upper : box.lower)[axis] = (low ? box.lower : box.upper)[axis];
    return box;
}

/// Sets what a part says of a side's box.
struct Cut {
    BoxRegion side;
    Eigen::Index axis;

    BoxRegion operator()(const WholeSide&) const { return side; }
    BoxRegion operator()(const SideBand& band) const {
        BoxRegion box = side;
        box.lower.z() = std::max(box.lower.z(), band.from);
        box.upper.z() = std::min(box.upper.z(), band.to);
        return box;
    }
    BoxRegion operator()(const SideDisc& disc) const {
        return within({disc.centre - Vec3::Constant(disc.radius), disc.centre + Vec3::Constant(disc.radius)});
    }
    BoxRegion operator()(const SideRectangle& rectangle) const { return within({rectangle.lower, rectangle.upper}); }

private:
    BoxRegion within(BoxRegion box) const {
        box.lower[axis] = side.lower[axis];
        box.upper[axis] = side.upper[axis];
        return box;
    }
};

double face_of(const BoxRegion& box, Eigen::Index axis) {
    const Vec3 size = box.upper - box.lower;
    return size[(axis + 1) % 3] * size[(axis + 2) % 3];
}

}  // namespace

BoxRegion bounds_of(const SidePart& part, coupling::DomainSide side, const RoomScene& scene) {
    return std::visit(Cut{side_box(side, scene), axis_of(side)}, part);
}

double area_of(const RoomBoundary& boundary, const RoomScene& scene) {
    if (const auto* disc = std::get_if<SideDisc>(&boundary.part)) return k_pi * disc->radius * disc->radius;
    double area = 0.0;
    for (const coupling::DomainSide side : boundary.sides) area += face_of(bounds_of(boundary.part, side, scene), axis_of(side));
    return area;
}

bool overlap(const RoomBoundary& a, const RoomBoundary& b, const RoomScene& scene) {
    return std::any_of(a.sides.begin(), a.sides.end(), [&](coupling::DomainSide side) {
        if (std::find(b.sides.begin(), b.sides.end(), side) == b.sides.end()) return false;
        const BoxRegion of_a = bounds_of(a.part, side, scene), of_b = bounds_of(b.part, side, scene);
        const Vec3 common = of_a.upper.cwiseMin(of_b.upper) - of_a.lower.cwiseMax(of_b.lower);
        const Eigen::Index axis = axis_of(side);
        return common[(axis + 1) % 3] > 0.0 && common[(axis + 2) % 3] > 0.0;
    });
}

}  // namespace cutterflow::cases
