#pragma once
/// \file Repair of users' surfaces: from exported triangles to the boundary of one solid, or a refusal with the
/// place.
#include <map>
#include <string>
#include <vector>

#include "geometry/repair/traced_surface.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::geometry::repair {

/// Limits of a repair. A surface that needs more is refused.
struct RepairLimits {
    double weld_distance = 0.0;    ///< [m] points nearer than this are one; borders nearer than this are a seam
    double hole_size = 0.0;        ///< [m] longest side of a hole's bounding box
    double volume_change = 0.005;  ///< of the volume: by resolving self-intersections, cavities, tidying, and what patches leave uncertain
    double area_change = 0.02;     ///< of the area: patches, and what resolving self-intersections takes away
    double overlap = 0.5;          ///< of the sum of the shells' volumes that may lie in several of them
};

inline constexpr double k_weld_distance_per_extent = 1e-5;
inline constexpr double k_hole_size_per_extent = 0.05;

/// Limits whose lengths follow the largest extent [m] of the surface. The weld distance is never below what single precision can tell
/// apart.
RepairLimits default_limits(const TriangleSurface& surface);

struct RepairStep {
    std::string name;
    std::string counted;  ///< what `count` counts
    std::size_t count = 0;
    double volume_change = 0.0;  ///< [m3], signed; holes closed by a cone to their middle; meaningful once all faces are oriented
    double area_change = 0.0;    ///< [m2], signed
    std::string remark;          ///< more numbers, with their limits
};

/// The faces for which a surface was refused.
struct BadFaces {
    TracedSurface faces;
    std::map<std::string, std::vector<std::int64_t>> defects;  ///< by kind: one per face, 1 where the face has it
};

struct RepairOutcome {
    RepairLimits limits;
    SoundnessReport before;
    std::vector<RepairStep> steps;  ///< as far as the repair came
    TracedSurface result;           ///< of the last step. When nothing was refused: sound, in coordinates that a binary STL keeps
    SoundnessReport after;          ///< of `result`; empty when a step refused
    std::vector<Mistake> refusals;  ///< why the surface cannot be repaired; empty when it was
    BadFaces bad_faces;

    bool repaired() const { return refusals.empty(); }
};

/// Repairs a surface [m]: points are welded, flat and duplicate triangles dropped, seams joined, hanging sheets dropped, triangles
/// oriented, holes filled, self-intersections resolved shell by shell, shells united, cavities filled, coordinates rounded to single
/// precision. \param name  of the surface, in front of refusals
RepairOutcome repair_surface(const TriangleSurface& surface, const RepairLimits& limits, const std::string& name);

}  // namespace cutterflow::geometry::repair
