#pragma once
/// \file A batch of rock set into the head: where the spheres start.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "geometry/base/axial_cylinder.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/contour.hpp"

namespace cutterflow::geometry {

/// Part of an annulus about the rotor's axis, in the run's frame.
struct Wedge {
    double azimuth_centre = 0.0;  ///< [rad]
    double azimuth_span = 0.0;    ///< [rad] in (0, 2 pi]
    double z_min = 0.0;           ///< [m]
    double z_max = 0.0;           ///< [m]
    double radius_min = 0.0;      ///< [m]
    double radius_max = 0.0;      ///< [m]

    bool contains(const Cylindrical& at) const;
};

struct RockBatch {
    std::size_t count = 0;
    double diameter = 0.0;         ///< [m]
    double lattice_spacing = 0.0;  ///< [m], more than the diameter
    double clearance = 0.0;        ///< [m] between rock and steel, 0 or more
    Wedge region;
    std::uint64_t seed = 0;  ///< shifts the lattice: repeats of a run take other seeds
};

/// Why a place of the lattice cannot take a rock.
enum class Blocked { outside_water, outside_head, inside_steel, too_close_to_steel };

/// "outside the water", "outside the head's contour", ...
const char* reason_of(Blocked blocked);

struct RockPlacement {
    std::vector<Vec3> positions;  ///< [m], run's frame
    std::size_t requested = 0;
    std::size_t moved = 0;                   ///< of the placed: those whose place in the compact batch was blocked
    std::map<Blocked, std::size_t> blocked;  ///< places of the region's lattice that cannot take a rock
    std::size_t places = 0;                  ///< of the region's lattice, free or not

    std::size_t placed() const { return positions.size(); }
    std::size_t rejected() const { return requested - positions.size(); }
    /// "12 rocks rejected: ... ", empty when none was.
    std::string rejection_reason() const;
};

/// Sets a batch on a simple cubic lattice in a wedge of the head. The batch is the `count` places of the region nearest to its middle; a
/// place that lies outside the water, outside the head's contour (the rock as a whole must be inside), or inside or too near to steel is
/// replaced by the next nearest free one. Rocks left over when all free places are taken are rejected. \param steel  solids as they stand
/// at the release, the cutter turned to its angle then \throws UserError  when the batch contradicts itself, when its lattice is too fine
/// to be searched (nothing was searched then), or when its region has no free place at all
RockPlacement place_rocks(const RockBatch& batch, const Contour& head, const AxialCylinder& water,
                          const std::vector<const SolidSearch*>& steel);

}  // namespace cutterflow::geometry
