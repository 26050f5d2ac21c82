#include "solver/liggghts/steel_wall.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "atom.h"

namespace cutterflow::liggghts {

namespace {

constexpr double k_skin_in_radii = 0.25;  // a rock's neighbourhood serves until it has moved by this in the wall's frame
constexpr double k_same_point_in_radii = 1e-6;

/// Whether a triangle's plane is farther from a point than `distance` [m]; never of one without area.
bool plane_is_beyond(const Triangle& triangle, const Vec3& point, double distance) {
    const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    const double height = normal.dot(point - triangle[0]);
    return height * height > distance * distance * normal.squaredNorm();
}

}  // namespace

std::vector<SteelPoint> reached_points(const std::vector<Triangle>& triangles, const Vec3& centre, double radius) {
    std::vector<SteelPoint> reached;
    for (std::size_t number = 0; number < triangles.size(); ++number) {
        const Triangle& triangle = triangles[number];
        if (plane_is_beyond(triangle, centre, radius)) continue;
        const Vec3 place = nearest_point(triangle, centre);
        const double distance = (centre - place).norm();
        if (distance >= radius) continue;
        reached.push_back({place, distance, number});
    }
    std::vector<SteelPoint> minima;
    for (const SteelPoint& point : reached) {
        bool is_minimum = true;
        for (std::size_t k = 0; k < reached.size() && is_minimum; ++k)
            is_minimum = reached[k].distance >= point.distance ||
                         (nearest_point(triangles[reached[k].triangle], point.place) - point.place).norm() > k_same_point_in_radii * radius;
        if (is_minimum) minima.push_back(point);
    }
    return minima;
}

SteelWall::SteelWall(const coupling::WallSettings& given, int body, const coupling::ZoneMotion& rotor)
    : surface_(read_stl(given.file)),
      body_(body),
      rotating_(given.rotating),
      is_soil_(given.material == coupling::k_soil),
      removed_at_(given.removed_at),
      travels_(given.travels),
      turn_(given.turn),
      press_(given.press),
      press_speed_(press_ ? press_->largest_speed : 0.0),
      surface_velocity_(given.surface_velocity),
      rotor_(rotor) {}

WallPose SteelWall::pose(double time) const {
    WallPose pose;
    pose.way = coupling::way_until(travels_, time) + pressed_;
    pose.travel = coupling::velocity_at(travels_, time);
    if (press_) pose.travel += press_speed_ * press_->direction;
    if (!rotating_ && turn_.speed == 0.0) return pose;
    const RotationAxis& axis = rotating_ ? rotor_.axis : turn_.axis;
    const double angle = rotating_ ? rotor_.angle(time) : turn_.angle(time);
    pose.turn = Eigen::AngleAxisd(angle, axis.direction).toRotationMatrix();
    pose.origin = axis.origin;
    pose.spin = rotating_ ? Vec3(rotor_.speed * axis.direction) : turn_.spin_at(time);
    return pose;
}

void SteelWall::press(const Vec3& force, double step) {
    press_speed_ = press_->speed(-force.dot(press_->direction));
    pressed_ += step * press_speed_ * press_->direction;
}

const NearTriangles& SteelWall::near(Neighbourhood& last, const Vec3& centre, double radius) const {
    const double allowed = last.reach - radius;
    if (allowed < 0.0 || (centre - last.centre).squaredNorm() > allowed * allowed) {
        const double reach = (1.0 + k_skin_in_radii) * radius;
        last = {centre, reach, surface_.near(centre, reach)};
    }
    return last.found;
}

void SteelWall::find_touches(const LAMMPS_NS::Atom& atom, double time, WallContacts& contacts) {
    if (is_removed(time)) return;
    const WallPose now = pose(time);
    const auto count = static_cast<std::size_t>(atom.nlocal);
    if (neighbourhoods_.size() < count) neighbourhoods_.resize(count);
    for (std::size_t rock = 0; rock < count; ++rock) {
        const Vec3 position(atom.x[rock]), centre = now.into_frame(position);
        const double radius = atom.radius[rock];
        const NearTriangles& found = near(neighbourhoods_[rock], centre, radius);
        for (const SteelPoint& point : reached_points(found.triangles, centre, radius)) {
            WallTouch touch;
            touch.rock = static_cast<int>(rock);
            touch.body = body_;
            touch.triangle = found.numbers[point.triangle];
            touch.rotating = rotating_;
            touch.wall_spin = now.spin;
            touch.normal = now.turn * (centre - point.place).normalized();
            touch.overlap = radius - point.distance;
            touch.wall_velocity = now.velocity_at(position - point.distance * touch.normal) + surface_velocity_ -
                                  touch.normal.dot(surface_velocity_) * touch.normal;
            contacts.add(touch);
        }
    }
}

}  // namespace cutterflow::liggghts
