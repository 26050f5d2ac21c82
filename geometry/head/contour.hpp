#pragma once
/// \file The contour of revolution of a cutter head: outer radius against the axial coordinate.
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::geometry {

/// Outer radius r(z) of a head in its own frame (origin at the ring plane, z towards the suction side, z < 0 inside the head),
/// piecewise linear between nodes.
///
/// The head's volume, for fates and bins, is r < radius_at(z) for z_hub() <= z <= z_ring(), closed by the ring's cylinder
/// (radius ring_radius) from the ring plane up to the backplate at z_backplate, and by the plane z_hub() below.
class Contour {
public:
    /// \param z       axial coordinates [m], strictly increasing, two or more
    /// \param radius  outer radius [m] at each z, same length, >= 0
    /// \param ring_radius  [m] > 0
    /// \param z_backplate  axial coordinate [m] of the backplate's face towards the head, >= 0
    /// \throws std::invalid_argument  when a rule above is broken
    Contour(std::vector<double> z, std::vector<double> radius, double ring_radius, double z_backplate);

    const std::vector<double>& z() const { return z_; }
    const std::vector<double>& radius() const { return radius_; }
    double ring_radius() const { return ring_radius_; }
    double z_hub() const { return z_.front(); }
    double z_ring() const { return 0.0; }
    double z_backplate() const { return z_backplate_; }

    /// Radius [m] of the head's volume at axial coordinate z [m]: interpolated within the head, the ring's radius between the ring
    /// plane and the backplate; the end values outside.
    double radius_at(double z) const;

    /// Signed distance [m] of a point (radius r >= 0, axial z) to the boundary of the head's volume in the meridional half plane:
    /// negative inside, positive outside.
    double signed_distance(double r, double z) const;

private:
    std::vector<double> z_;
    std::vector<double> radius_;
    double ring_radius_;
    double z_backplate_;
    std::vector<Eigen::Vector2d> outline_;  // closed polygon (r, z), starting and ending on the axis
};

}  // namespace cutterflow::geometry
