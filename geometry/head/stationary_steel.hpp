#pragma once
/// \file The steel that does not turn: backplate behind the ring, with the suction mouth, and suction pipe.
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// The circular suction mouth in the backplate. Its pipe leaves parallel to the axis.
struct SuctionMouth {
    double radius = 0.0;   ///< [m] of the opening, the pipe's inner radius
    double offset = 0.0;   ///< [m] of its centre from the rotor's axis
    double azimuth = 0.0;  ///< [rad] of its centre
};

/// Sizes in the run's frame, metres.
struct StationarySteelParameters {
    double plate_radius = 0.0;  ///< usually the ring's radius
    double gap = 0.0;           ///< between the ring plane and the backplate's face towards the head, which lies at z = gap
    double plate_thickness = 0.0;
    SuctionMouth mouth;
    double pipe_wall = 0.0;    ///< wall thickness of the pipe
    double pipe_top = 0.0;     ///< z of the pipe's end; above the tank's top, which then cuts it
    double edge_length = 0.0;  ///< of the surface's triangles
};

/// Backplate and suction pipe are one watertight solid; the two parts of its surface become two patches. They share the points of their
/// seams, which lie on the solid's own edges: the mouth's lip (the mouth's wall belongs to the pipe) and where the pipe leaves
/// the plate. Neither part is closed by itself.
struct StationarySteel {
    TriangleSurface backplate;
    TriangleSurface suction_pipe;

    /// Both parts, points joined: closed.
    TriangleSurface solid() const;
};

/// \throws UserError  when the sizes contradict each other (each contradiction is named)
StationarySteel generate_stationary_steel(const StationarySteelParameters& parameters);

/// Whether a point lies in that steel, by its exact cylinders. \pre the sizes do not contradict each other
bool is_in_stationary_steel(const StationarySteelParameters& parameters, const Vec3& point);

}  // namespace cutterflow::geometry
