#pragma once
/// \file Ways in which exported surfaces are damaged. All are repeatable: the same seed gives the same damage.
#include <cstdint>
#include <random>

#include "geometry/surface/surface.hpp"

namespace cutterflow::validation {

/// Whole numbers below a bound, the same with every standard library.
class Dice {
public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}
    std::size_t below(std::size_t bound) { return engine_() % bound; }
    double between(double low, double high) { return low + (high - low) * (static_cast<double>(engine_()) / 4294967295.0); }

private:
    std::mt19937 engine_;
};

/// `count` triangles anywhere are missing.
geometry::TriangleSurface with_missing_triangles(geometry::TriangleSurface surface, std::size_t count, Dice dice);

/// Every triangle is missing whose centroid lies within `radius` of that of some triangle.
geometry::TriangleSurface with_missing_disc(const geometry::TriangleSurface& surface, double radius, Dice dice);

geometry::TriangleSurface with_flipped_triangles(geometry::TriangleSurface surface, std::size_t count, Dice dice);
geometry::TriangleSurface inside_out(geometry::TriangleSurface surface);

/// `count` triangles are there twice, in the same sense or the other.
geometry::TriangleSurface with_duplicates(geometry::TriangleSurface surface, std::size_t count, bool flipped, Dice dice);

/// Edges of `count` triangles are divided on one side only, at a point on the edge.
geometry::TriangleSurface with_t_junctions(geometry::TriangleSurface surface, std::size_t count, Dice dice);

/// As with_t_junctions, but a triangle without area lies in each gap.
geometry::TriangleSurface with_flat_triangles(geometry::TriangleSurface surface, std::size_t count, Dice dice);

/// `count` triangles are divided at an inner point so near to one of their sides, a share of 1e-4 of their size, that a sliver arises.
geometry::TriangleSurface with_slivers(geometry::TriangleSurface surface, std::size_t count, Dice dice);

/// Every triangle has its own three points, each moved by up to `distance` along each axis.
geometry::TriangleSurface torn_apart(const geometry::TriangleSurface& surface, double distance, Dice dice);

/// `count` points are moved along the line to a neighbour, past it by a fifth of the edge: triangles fold over each other.
geometry::TriangleSurface with_folds(geometry::TriangleSurface surface, std::size_t count, Dice dice);

/// `count` triangles stand on edges of the surface, outwards.
geometry::TriangleSurface with_fins(geometry::TriangleSurface surface, std::size_t count, Dice dice);

/// Points closer to the plane through the middle across `axis` than `share` of the extent are joined by a wall inside: a fan over the
/// section of the surface is approximated by triangles between existing points. For surfaces with a ring of points in that plane.
geometry::TriangleSurface with_inner_wall(geometry::TriangleSurface surface, const std::vector<std::uint32_t>& ring);

// ---- solids ----

geometry::TriangleSurface ball(double radius, int subdivisions);
/// Faces of n x n squares. Points of one z = constant section at the middle exist when n is even.
geometry::TriangleSurface block(const Vec3& low, const Vec3& high, int n);
geometry::TriangleSurface ring_torus(double radius, double tube, int around, int across);
geometry::TriangleSurface moved(const geometry::TriangleSurface& surface, const Vec3& by);

/// Points of a block or ball with z = 0, in order of azimuth.
std::vector<std::uint32_t> equator(const geometry::TriangleSurface& surface);

/// Closed surfaces that bound nothing: a band with a half twist, and a bottle without inside.
geometry::TriangleSurface moebius_band(double radius, double width, int around);
geometry::TriangleSurface klein_bottle(double radius, double tube, int around, int across);

}  // namespace cutterflow::validation
