#pragma once
/// \file A parametric crown cutter: ring, hub, shaft and helical blades.
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/base/parameters/parameter.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Sizes of a crown cutter in its own frame: ring plane (the ring's top face) z = 0, head at z < 0. Lengths in metres, angles in radians.
///
/// A blade is a strip about a sheet, its thickness linear along the edge from ring to hub. Its outer edge follows the meridional curve
/// (super-ellipse of exponent p)
///
///     r(t) = r_h + (r_r - r_h) cos(t)^(2/p),   z(t) = z_r - (z_r - z_h) sin(t)^(2/p),   0 <= t <= pi/2
///
/// from within the ring (r_r, z_r) to within the hub (r_h, z_h) and turns about the axis in proportion to its arc length; the strip goes
/// inwards from there by the blade's depth, in a direction that turns from radial at the ring to axial at the hub. A blade deeper than
/// the ring is wide reaches into the ring's bore.
///
/// Sense of rotation. A blade that moves with +azimuth pushes with the face whose outward normal n has n_azimuth > 0, along n. It carries
/// rock towards the suction side (+z) when n_z > 0 there, that is when the blade's ring end trails its hub end: `wrap` > 0 is the
/// azimuth by which the hub end leads, and such a head carries for positive rotation. wrap < 0 is its mirror image.
///
/// A pick is a square frustum, half as wide at its tip, on the blade's outer edge. Picks have equal distances along the edge, clear of
/// ring and hub; their axes lean from the meridional direction in which the strip points outwards towards the carrying sense of rotation.
struct CrownParameters {
    double ring_radius = 0.0;  ///< outer radius of the ring
    double ring_inner_radius = 0.0;
    double ring_height = 0.0;  ///< along the axis, from z = 0 down
    double hub_radius = 0.0;
    double hub_depth = 0.0;       ///< distance of the hub's lower rim from the ring plane
    double hub_height = 0.0;      ///< of the hub's cylinder
    double hub_cap_height = 0.0;  ///< of the spherical cap below the rim; the head's height is hub_depth + hub_cap_height
    double shaft_radius = 0.0;    ///< in the ring plane, where the shaft ends; 0: no shaft
    double shaft_radius_at_hub = 0.0;
    int blade_count = 0;
    double blade_wrap = 0.0;  ///< see above
    double blade_rake = 0.0;  ///< between strip and radius in a section normal to the axis; positive: the outer edge leads when carrying
    double blade_thickness = 0.0;  ///< at the ring
    double blade_thickness_at_hub = 0.0;
    double blade_depth_at_ring = 0.0;
    double blade_depth_at_hub = 0.0;  ///< linear in between along the edge
    double contour_exponent = 0.0;    ///< p above: 2 is an ellipse, larger is fuller
    int picks_per_blade = 0;          ///< 0: none, and the other sizes of picks do not matter
    double pick_length = 0.0;         ///< beyond the blade's edge
    double pick_width = 0.0;          ///< of the square base
    double pick_lean = 0.0;
    double edge_length = 0.0;  ///< of the surface's triangles
};

/// The keys of a crown cutter's TOML file.
const ParameterTable& crown_parameter_table();

/// docs/user/crown_file.md.
std::string crown_manual_page();

/// \throws UserError  with every mistake of the file
CrownParameters read_crown_parameters(const std::filesystem::path& file);

/// Watertight surface of the united ring, hub and blades: one component, outward oriented.
/// \throws UserError     when the sizes contradict each other (each contradiction is named)
/// \throws CheckFailure  when blades, ring and hub do not unite into one sound solid
TriangleSurface generate_crown_cutter(const CrownParameters& parameters);

/// Ring, hub, shaft, blades and picks united in exact arithmetic, with the small and thin triangles that this leaves: the solid of which
/// generate_crown_cutter makes the surface.
/// \throws as generate_crown_cutter
TriangleSurface united_crown_parts(const CrownParameters& parameters);

/// The strip of one blade, before it is united: closed surface around the sheet at azimuth 0 of its ring end.
TriangleSurface crown_blade(const CrownParameters& parameters);

/// The picks of the blade of crown_blade, one closed surface each, from the ring on.
std::vector<TriangleSurface> crown_picks(const CrownParameters& parameters);

}  // namespace cutterflow::geometry
