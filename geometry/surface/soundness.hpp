#pragma once
/// \file Whether a surface is the boundary of a solid: its defects with number and place.
#include <string>
#include <vector>

#include "geometry/base/error.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// One kind of defect.
struct Defect {
    std::size_t count = 0;
    std::vector<std::size_t> triangles;  ///< every triangle concerned, sorted, each once
    std::vector<Vec3> places;            ///< the first few [m]
};

/// A part of the surface connected over edges.
struct SurfaceComponent {
    std::size_t triangles = 0;
    double area = 0.0;    ///< [m2]
    double volume = 0.0;  ///< [m3], signed
};

struct SoundnessReport {
    std::size_t points = 0;
    std::size_t triangles = 0;
    Bounds bounds;
    double area = 0.0;    ///< [m2]
    double volume = 0.0;  ///< [m3], signed; meaningful when closed
    std::vector<SurfaceComponent> components;

    Defect degenerate_triangles;  ///< without area: two points equal or all three on a line
    Defect duplicate_triangles;   ///< the same three points as an earlier one
    Defect border_edges;          ///< of one triangle only: the surface is open
    Defect non_manifold_edges;    ///< of three triangles or more
    Defect misoriented_edges;     ///< of two triangles that pass it in the same sense: one of them is flipped
    Defect non_manifold_points;   ///< where two fans of triangles meet in the point alone
    Defect self_intersections;    ///< pairs of triangles

    bool closed() const { return border_edges.count == 0 && non_manifold_edges.count == 0; }
    bool consistently_oriented() const { return misoriented_edges.count == 0; }
    /// Every component encloses a positive volume. A cavity does not.
    bool outward() const;
    bool sound() const;
};

SoundnessReport inspect_surface(const TriangleSurface& surface);

/// The defects in words, one Mistake each: what, how many, where, the rule, the remedy. Empty for a sound surface.
std::vector<Mistake> defects_of(const SoundnessReport& report, const std::string& name);

/// \throws UserError  with every defect of the surface called `name`, a file, and the command that may repair it
void require_sound(const SoundnessReport& report, const std::string& name);

}  // namespace cutterflow::geometry
