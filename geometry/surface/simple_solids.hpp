#pragma once
/// \file Simple solids of known volume, as verification cases and rooms need them: pipe, box, funnel, bin, dish, slotted box.
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// A pipe about the z axis from z = 0 to z = length [m]; a rod when the inner radius is 0.
struct PipeParameters {
    double inner_radius = 0.0;
    double wall = 0.0;
    double length = 0.0;
    double edge_length = 0.0;  ///< of the surface's triangles, at most

    double volume() const;  ///< exact [m3]: pi wall (2 inner_radius + wall) length
};

/// A cone about the z axis that narrows from the inlet, its upper end, to a cylindrical spout below it, which ends at z = 0 and may have
/// zero length [m]. Equal radii make a tube.
struct FunnelParameters {
    double inlet_radius = 0.0;   ///< inside, at the upper end
    double outlet_radius = 0.0;  ///< inside, of the spout
    double cone_height = 0.0;
    double spout_length = 0.0;
    double wall = 0.0;  ///< measured along the radius
    double edge_length = 0.0;

    double volume()
        const;  ///< exact [m3]: pi wall ((inlet_radius + outlet_radius + wall) cone_height + (2 outlet_radius + wall) spout_length)
};

/// The surfaces are closed and outward oriented. Circles get 64 edges or more and are inscribed, so that volumes are up to 0.16 % smaller
/// than the exact ones. \throws UserError  with every size that is not positive (inner radius and spout may be 0), and for a funnel
/// that widens downwards
TriangleSurface generate_pipe(const PipeParameters& parameters);
TriangleSurface generate_funnel(const FunnelParameters& parameters);

/// The box of `size` [m] centred on the z axis, from z = 0 up. Its volume is exact.
/// \throws UserError  with every size that is not positive
TriangleSurface generate_box(const Vec3& size, double edge_length);

/// The block between two opposite corners [m], of twelve triangles. \throws UserError  unless every coordinate of `upper` is above that of
/// `lower`
TriangleSurface generate_block(const Vec3& lower, const Vec3& upper);

/// A flat-bottomed cylindrical bin about the z axis, open at its top, with a round orifice in its floor (none: 0). Its floor's upper face
/// is at z = 0 [m].
struct BinParameters {
    double inner_radius = 0.0;
    double height = 0.0;  ///< inside
    double wall = 0.0;    ///< of the cylinder and of the floor
    double orifice_radius = 0.0;

    double volume() const;  ///< exact [m3]
};
TriangleSurface generate_bin(const BinParameters& parameters);

/// A round plate about the z axis, whose upper face is at z = 0, with a rim around it; no rim: height 0 [m].
struct DishParameters {
    double radius = 0.0;  ///< inside the rim
    double thickness = 0.0;
    double rim_height = 0.0;
    double rim_wall = 0.0;

    double volume() const;  ///< exact [m3]
};
TriangleSurface generate_dish(const DishParameters& parameters);

/// A box without lid and without ends along y, whose floor has a slot along y in its middle: two walls, two floor plates. The floor's upper
/// face is at z = 0 [m].
struct SlottedBoxParameters {
    Vec3 inner = Vec3::Zero();  ///< width, length along y, height
    double wall = 0.0;          ///< of walls and floor
    double slot = 0.0;          ///< width along x, less than that of the box

    double volume() const;  ///< exact [m3]
};
TriangleSurface generate_slotted_box(const SlottedBoxParameters& parameters);

}  // namespace cutterflow::geometry
