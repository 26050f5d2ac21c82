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
        double size;        ///< cell size dx [m]: mean over the k = 24 nearest cells of all zones with weights (1 - (r/r_k)^2)^2, which
                            ///< vanish where a cell enters or leaves the k nearest
        Zone nearest_zone;  ///< of the cell whose centre is nearest
    };
    /// Cells about a point that travels: those that can be the nearest ones until it leaves their reach.
    struct Vicinity {
        std::vector<NearbyPoints> zones;  ///< centres of cells, in each zone's frame; none: not known yet
    };
    /// \param point     [m], absolute
    /// \param vicinity  of the point where it was before; made anew when it does not hold any more. The result does not depend on it
    Surroundings around(const ZoneFrames& frames, const Vec3& point, Vicinity& vicinity) const;

    /// Centre [m, absolute] of the cell that is nearest to a point.
    Vec3 nearest_centre(const ZoneFrames& frames, const Vec3& point) const;

    double smallest() const { return smallest_; }
    double largest() const { return largest_; }

    /// Largest speed [m/s] at which a moving zone's cells pass the still ones along their interface; 0 when nothing turns.
    double interface_speed(gsl::span<const ZoneMotion> moving) const;

private:
    struct Near;
    void renew(const ZoneFrames& frames, const Vec3& point, Vicinity& vicinity) const;
    bool nearest_of(const Vicinity& vicinity, const ZoneFrames& frames, const Vec3& point, std::vector<Near>& cells) const;

    std::vector<std::vector<Vec3>> centres_;  // by zone, in the order of its tree
    std::vector<std::vector<double>> sizes_;
    std::vector<PointTree> trees_;
    std::size_t count_ = 0;
    double smallest_ = 0.0, largest_ = 0.0;
    bool is_uniform_ = false;
};

}  // namespace cutterflow::coupling
