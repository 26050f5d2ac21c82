#pragma once
/// \file Cell size at any point of the moving mesh: smooth in space, across the rotor interface and the same on every rank.
#include <vector>

#include "solver/ports/communicator.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/space/point_tree.hpp"
#include "solver/space/zone_frames.hpp"

namespace cutterflow::coupling {

/// Every rank has centres and sizes of all cells of the mesh (32 bytes per cell), so that no communication is needed.
class SizeField {
public:
    /// \param zones  number of zones of the mesh
    SizeField(const Cells& cells, std::size_t zones, Communicator& communicator);

    /// The mesh about a point.
    struct Surroundings {
        double size;          ///< cell size dx [m]: mean over the k = 24 nearest cells of all zones with weights (1 - (r/r_k)^2)^2, which
                              ///< vanish where a cell enters or leaves the k nearest
        Zone nearest_zone;    ///< of the cell whose centre is nearest
        Vec3 nearest_centre;  ///< [m], absolute
    };
    /// \param point  [m], absolute
    Surroundings around(const ZoneFrames& frames, const Vec3& point) const;

    double smallest() const { return smallest_; }

    /// Largest speed [m/s] at which a moving zone's cells pass the still ones along their interface; 0 when nothing turns.
    double interface_speed(gsl::span<const ZoneMotion> moving) const;

private:
    std::vector<std::vector<Vec3>> centres_;  // by zone
    std::vector<std::vector<double>> sizes_;
    std::vector<PointTree> trees_;
    double smallest_ = 0.0;
};

}  // namespace cutterflow::coupling
