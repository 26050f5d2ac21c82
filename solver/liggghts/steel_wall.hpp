#pragma once
/// \file Walls of triangles. Each stands still in a frame of its own, in which the rocks that touch it are sought.
#include <cmath>
#include <optional>
#include <vector>

#include "geometry/base/axis_frame.hpp"
#include "solver/liggghts/contacts/wall_contacts.hpp"
#include "solver/liggghts/wall_surface.hpp"
#include "solver/ports/dem_settings.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace LAMMPS_NS {
class Atom;
}  // namespace LAMMPS_NS

namespace cutterflow::liggghts {

/// Where a wall is at one time, and how it moves.
struct WallPose {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< since time 0
    Vec3 origin = Vec3::Zero();                          ///< of the turn, before the wall went its way [m]
    Vec3 way = Vec3::Zero();                             ///< travelled since time 0 [m]
    Vec3 spin = Vec3::Zero();                            ///< [rad/s]
    Vec3 travel = Vec3::Zero();                          ///< [m/s]

    Vec3 into_frame(const Vec3& point) const { return origin + turn.transpose() * (point - way - origin); }
    Vec3 velocity_at(const Vec3& point) const { return travel + spin.cross(point - way - origin); }
};

/// A place of steel that a sphere reaches.
struct SteelPoint {
    Vec3 place = Vec3::Zero();  ///< [m]
    double distance = 0.0;      ///< from the sphere's centre [m]
    std::size_t triangle = 0;   ///< its place among the triangles that were searched
};

/// Where triangles are nearest to a sphere's centre and within its radius: of each triangle its nearest point, unless another triangle has
/// that point too and comes nearer. So the distance to the surface has a minimum there, and no seam of a plane counts.
std::vector<SteelPoint> reached_points(const std::vector<Triangle>& triangles, const Vec3& centre, double radius);

/// A wall given as STL. It turns with the rotor or by itself, travels or stands; the rocks are taken into its frame, so that its
/// triangles are never moved and are sorted once.
class SteelWall {
public:
    /// \param body  its number among the bodies of steel
    /// \param rotor  with which a rotating wall turns
    /// \throws UserError  when its file cannot be read
    SteelWall(const coupling::WallSettings& given, int body, const coupling::ZoneMotion& rotor);

    bool rotating() const { return rotating_; }
    bool is_soil() const { return is_soil_; }
    /// Whether it was taken out before or at `time` [s].
    bool is_removed(double time) const { return time >= removed_at_ * (1.0 - k_rounding); }
    const WallSurface& surface() const { return surface_; }
    WallPose pose(double time) const;

    /// Moves a wall that presses for one step of `step` [s]. \param force  of all rock on it [N]
    void press(const Vec3& force, double step);
    bool presses() const { return press_.has_value(); }
    /// Whether rock bears all but 1 % of what presses on it.
    bool is_borne() const { return !press_ || std::abs(press_speed_) <= k_borne * press_->largest_speed; }
    /// Way that it was pressed from where its file has it [m].
    const Vec3& pressed() const { return pressed_; }
    void set_pressed(const Vec3& way) { pressed_ = way; }

    /// Hands the touches of this rank's rocks at `time` [s] to `contacts`.
    void find_touches(const LAMMPS_NS::Atom& atom, double time, WallContacts& contacts);

private:
    static constexpr double k_rounding = 1e-12;  // of times that are sums of steps
    static constexpr double k_borne = 0.01;      // share of the force that may be missing

    /// All triangles nearer to `centre` than `reach`, in the wall's frame.
    struct Neighbourhood {
        Vec3 centre = Vec3::Zero();
        double reach = 0.0;
        NearTriangles found;
    };

    const NearTriangles& near(Neighbourhood& last, const Vec3& centre, double radius) const;

    WallSurface surface_;
    int body_;
    bool rotating_;
    bool is_soil_;
    double removed_at_;
    std::vector<coupling::WallTravel> travels_;
    coupling::WallTurn turn_;
    std::optional<coupling::WallPress> press_;
    double press_speed_ = 0.0;  // along the press [m/s]
    Vec3 pressed_ = Vec3::Zero();
    Vec3 surface_velocity_;
    coupling::ZoneMotion rotor_;
    std::vector<Neighbourhood> neighbourhoods_;  // of the rocks, in LIGGGHTS' order
};

}  // namespace cutterflow::liggghts
