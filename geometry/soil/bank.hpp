#pragma once
/// \file The bank that a swinging, stepping head leaves standing, and the face at which it cuts.
#include <functional>
#include <vector>

#include "geometry/head/contour.hpp"
#include "geometry/soil/convex_polygon.hpp"
#include "geometry/soil/cut_face.hpp"
#include "geometry/surface/revolve.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// How a head works into its bank. Lengths in metres.
struct BankParameters {
    double inclination = 0.0;  ///< of the axis below horizontal [rad]
    double swing_sign = 1.0;   ///< the head swings along swing_sign y: 1 with the bank at azimuth 90 degrees, -1 with it at -90
    double cut_height = 0.0;   ///< of the bank's level top above the head's lowest point, vertical, > 0
    double step = 0.0;         ///< advance of the ship after a swing, horizontal, > 0
    double pick_length = 0.0;  ///< by which picks stand out of the contour, >= 0
    double clearance = 0.0;    ///< of the soil from contour and picks, >= 0
    int segments = 96;         ///< edges around the axis, a multiple of 4
};

/// Of a soil's surface for a DEM. Lengths in metres.
struct WallBounds {
    double reach = 0.0;        ///< as of the soil
    double tolerance = 0.0;    ///< by which the body's section may lie within the right one; what is narrower is left out
    double edge_length = 0.0;  ///< largest
};

/// Soil as the sweeps of a convex body leave it.
///
/// The body B is the convex hull of the contour, picks and clearance added (they end at the clearance above the ring plane), turned about
/// the axis. Seen along the swing it is the convex polygon K. Directions in the run's frame, with the axis inclined by l: up
/// k = (-cos l, 0, sin l), ahead f = (-sin l, 0, -cos l), swing e = (0, +-1, 0); B is at rest in it. This swing took
/// P0 = hull(B, B - L e); the swings before, each a step s behind, took prisms of K - j s f along e. The cut section is what P0 takes of
/// the bank per length of the swing: A_cut = area of K below the bank's top less that of K and K - s f together; K convex, earlier steps
/// take nothing more from K.
///
/// B is a polyhedron that holds the round body: circles are polygons about them, so that the clearance is kept. A_cut is therefore too
/// large, by a share of order (pi / segments)^2.
class Bank {
public:
    /// \throws std::invalid_argument  when a rule of BankParameters is broken
    Bank(const Contour& contour, const BankParameters& parameters);

    double lowest() const { return lowest_; }                        ///< height x . k of the lowest point of B [m]
    double head_height() const { return height_; }                   ///< vertical extent of B [m]
    double head_length() const { return length_; }                   ///< extent of B along f [m]
    double top() const { return lowest_ + parameters_.cut_height; }  ///< height x . k of the bank's top [m]

    /// Extent of K along f at the bank's top [m]; 0 above the head. Where it is less than a step the bank overhangs.
    double width_at_top() const;

    /// A_cut [m2].
    double cut_section() const;

    /// The cut face in patches no longer than `length` [m] along the contour and one segment wide. Their flux areas add up to cut_section()
    /// to rounding, because patches are seen along e as parts of K. Depths are kept between the ring plane and the head's lowest point.
    CutFace cut_face(double length) const;

    /// Loose rock that the last swing left lies `thickness` [m] deep on what it cut. What this swing takes of it per length [m2]: of K and
    /// K - s f together, the part no higher than that above the lower side of K - s f.
    double layer_section(double thickness) const;

    /// Where the head meets that layer, in patches as cut_face() has them; their flux areas add up to layer_section().
    CutFace layer_face(double thickness, double length) const;

    /// P0 with a swing of that length [m], and the sweep of the swing j steps before, from -length to length; closed, in the run's frame.
    TriangleSurface sweep(double length) const;
    TriangleSurface earlier_sweep(int steps, double length) const;

    /// What stands within `reach` [m] of the origin along f, e and downwards, up to the bank's top; closed, in the run's frame.
    /// \throws CheckFailure  when the bank overhangs so that parts of it meet at an edge only
    TriangleSurface soil(double reach) const;

    /// The surface of the soil that rock can reach, for a DEM: triangles of 5 degrees and more, cut from the sweeps' own facets, facing the
    /// water. It is open where the soil's box ends, triangles need not share corners, and slits narrower than the tolerance may be left.
    TriangleSurface wall(const WallBounds& bounds) const;

    /// Hausdorff distance of a wall to the surface of the soil it was made for, but for the soil's box [m]: largest distance from one to
    /// the other of points `spacing` [m] apart.
    double wall_error(const TriangleSurface& wall, const TriangleSurface& soil, double reach, double spacing) const;

private:
    class WallMaker;

    Vec3 seen(const Vec3& point) const;  ///< run's frame -> (along f, along k, along e)
    Eigen::Affine3d to_run_frame() const;
    Vec3 corner(const MeridianPoint& at, int k) const;  ///< of B on the k-th plane about the axis, as seen
    using Taken = std::function<PlanarMoment(const PlanarLoop&)>;
    CutFace front(double length, const Taken& taken) const;
    PlanarMoment layer_of(const PlanarLoop& part, double thickness) const;
    // As seen:
    std::vector<Vec3> body() const;                         ///< corners of B
    TriangleSurface swept(double length) const;             ///< P0
    TriangleSurface prism(int steps, double length) const;  ///< of K, `steps` steps back, from -length to length

    BankParameters parameters_;
    double head_depth_ = 0.0;
    std::vector<MeridianPoint> section_;  // of B, from the axis below to the axis above
    PlanarLoop outline_;                  // K
    double lowest_ = 0.0, height_ = 0.0, length_ = 0.0;
};

/// Meridional section of B from the axis below to the axis above, convex.
std::vector<MeridianPoint> section_of_body(const Contour& contour, double pick_length, double clearance);

}  // namespace cutterflow::geometry
