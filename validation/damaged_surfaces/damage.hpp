#pragma once
/// \file Ways in which exported surfaces are damaged. All are repeatable: the same seed gives the same damage.
#include <cstdint>
#include <random>

#include "geometry/surface.hpp"

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
TriangleSurface with_missing_triangles(TriangleSurface surface, std::size_t count, Dice dice);

/// Every triangle is missing whose centroid lies within `radius` of that of some triangle.
TriangleSurface with_missing_disc(const TriangleSurface& surface, double radius, Dice dice);

TriangleSurface with_flipped_triangles(TriangleSurface surface, std::size_t count, Dice dice);
TriangleSurface inside_out(TriangleSurface surface);

/// `count` triangles are there twice, in the same sense or the other.
TriangleSurface with_duplicates(TriangleSurface surface, std::size_t count, bool flipped, Dice dice);

/// Edges of `count` triangles are divided on one side only, at a point on the edge.
TriangleSurface with_t_junctions(TriangleSurface surface, std::size_t count, Dice dice);

/// As with_t_junctions, but a triangle without area lies in each gap.
TriangleSurface with_flat_triangles(TriangleSurface surface, std::size_t count, Dice dice);

/// `count` triangles are divided at an inner point so near to one of their sides, a share of 1e-4 of their size, that a sliver arises.
TriangleSurface with_slivers(TriangleSurface surface, std::size_t count, Dice dice);

/// Every triangle has its own three points, each moved by up to `distance` along each axis.
TriangleSurface torn_apart(const TriangleSurface& surface, double distance, Dice dice);

/// `count` points are moved along the line to a neighbour, past it by a fifth of the edge: triangles fold over each other.
TriangleSurface with_folds(TriangleSurface surface, std::size_t count, Dice dice);

/// `count` triangles stand on edges of the surface, outwards.
TriangleSurface with_fins(TriangleSurface surface, std::size_t count, Dice dice);

/// Points closer to the plane through the middle across `axis` than `share` of the extent are joined by a wall inside: a fan over the
/// section of the surface is approximated by triangles between existing points. For surfaces with a ring of points in that plane.
TriangleSurface with_inner_wall(TriangleSurface surface, const std::vector<std::uint32_t>& ring);

// ---- solids ----

TriangleSurface ball(double radius, int subdivisions);
/// Faces of n x n squares. Points of one z = constant section at the middle exist when n is even.
TriangleSurface block(const Vec3& low, const Vec3& high, int n);
TriangleSurface ring_torus(double radius, double tube, int around, int across);
TriangleSurface moved(const TriangleSurface& surface, const Vec3& by);

/// Points of a block or ball with z = 0, in order of azimuth.
std::vector<std::uint32_t> equator(const TriangleSurface& surface);

/// Closed surfaces that bound nothing: a band with a half twist, and a bottle without inside.
TriangleSurface moebius_band(double radius, double width, int around);
TriangleSurface klein_bottle(double radius, double tube, int around, int across);

}  // namespace cutterflow::validation
