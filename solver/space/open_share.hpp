#pragma once
/// \file How much of a cell takes rock beside soil.
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

/// Shares of this rank's cells that take rock: 2 d/dx within [0, 1], with d the distance of the cell's centre outside the soil's surface
/// and dx its size: 0 where the centre lies in soil, 1 where the whole cell is out of it. Soil is at rest in the absolute frame. Cells that
/// turn through it take d from a grid about half as wide as they are, the same on all ranks.
class OpenShare {
public:
    /// Collective.
    OpenShare(gsl::span<const SteelTriangle> soil, const CellTrees& trees, gsl::span<const ZoneMotion> moving, const SizeField& sizes,
              const ZoneFrames& frames, Communicator& communicator);

    /// Sets the position of the mesh.
    void set_frames(const ZoneFrames& frames);

    /// [-] of the cell at a place of CellTrees.
    double at(std::int32_t place);

private:
    void make_grid(gsl::span<const ZoneMotion> moving, double spacing, double reach);
    double distance(Zone zone, const Vec3& centre, double size);

    const CellTrees& trees_;
    std::unique_ptr<SoilSurface> surface_;  // none: no soil
    std::unique_ptr<DistanceGrid> grid_;    // of the place through which cells turn
    ZoneFrames frames_;
    std::uint64_t stamp_ = 1;
    std::vector<double> shares_;              // by place
    std::vector<std::uint64_t> computed_at_;  // stamp, by place
};

}  // namespace cutterflow::coupling
