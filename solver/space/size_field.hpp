#pragma once
/// \file Cell size at any point of the moving mesh: smooth in space, across the rotor interface and the same on every rank.
#include <array>

#include "solver/ports/communicator.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/space/point_tree.hpp"
#include "solver/space/zone_frames.hpp"

namespace cutterflow::coupling {

/// Every rank has centres and sizes of all cells of the mesh (32 bytes per cell), so that no communication is needed.
class SizeField {
public:
    SizeField(const Cells& cells, Communicator& communicator);

    /// The mesh about a point.
    struct Surroundings {
        double size;          ///< cell size dx [m]: mean over the k = 24 nearest cells of both zones with weights (1 - (r/r_k)^2)^2, which
                              ///< vanish where a cell enters or leaves the k nearest
        Zone nearest_zone;    ///< of the cell whose centre is nearest
        Vec3 nearest_centre;  ///< [m], absolute
    };
    /// \param point  [m], absolute
    Surroundings around(const ZoneFrames& frames, const Vec3& point) const;

    double smallest() const { return smallest_; }

    /// Smallest size over speed [s] of rotor cells along the rotor interface: the time in which the interface turns by one cell; infinity
    /// when nothing turns.
    double interface_passage_time(const RotorMotion& motion) const;

    double cells() const { return static_cast<double>(sizes_[stator].size() + sizes_[rotor].size()); }

private:
    std::array<std::vector<Vec3>, 2> centres_;  // by zone
    std::array<std::vector<double>, 2> sizes_;
    std::array<PointTree, 2> trees_;
    double smallest_ = 0.0;
};

}  // namespace cutterflow::coupling
