#pragma once
/// \file How much of a cell is soil, so that no rock is laid there.
#include <cstdint>
#include <memory>
#include <vector>

#include "solver/ports/communicator.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/space/distance_grid.hpp"
#include "solver/space/size_field.hpp"
#include "solver/space/soil_surface.hpp"
#include "solver/space/visibility.hpp"
#include "solver/space/zone_frames.hpp"

namespace cutterflow::coupling {

/// Shares of soil in this rank's cells: chi = 1/2 - d/dx within [0, 1], with d the distance of the cell's centre outside the soil's surface
/// and dx its size. Soil is at rest in the absolute frame. Cells that turn through it take d from a grid about half as wide as they are,
/// the same on all ranks.
class SoilShare {
public:
    /// Collective.
    SoilShare(gsl::span<const SteelTriangle> soil, const CellTrees& trees, gsl::span<const ZoneMotion> moving, const SizeField& sizes,
              const ZoneFrames& frames, Communicator& communicator);

    /// Sets the position of the mesh.
    void set_frames(const ZoneFrames& frames);

    /// 1 - chi [-] of the cell at a place of CellTrees.
    double open(std::int32_t place);

private:
    void make_grid(gsl::span<const ZoneMotion> moving, double spacing, double reach);
    double distance(Zone zone, const Vec3& centre, double size);

    const CellTrees& trees_;
    std::unique_ptr<SoilSurface> surface_;  // none: no soil
    std::unique_ptr<DistanceGrid> grid_;    // of the place through which cells turn
    ZoneFrames frames_;
    std::uint64_t stamp_ = 1;
    std::vector<double> open_;                // by place
    std::vector<std::uint64_t> computed_at_;  // stamp, by place
};

}  // namespace cutterflow::coupling
