#pragma once
/// \file Maps without a kernel: rock is laid evenly over one cell, or over the cells of one cube.
#include <cstdint>
#include <vector>

#include "geometry/base/error.hpp"
#include "solver/ports/communicator.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/ports/settings.hpp"
#include "solver/space/visibility.hpp"

namespace cutterflow::coupling {

/// The cells in groups that have none in common. A rock belongs to the group of the cell whose centre is nearest to its own, is laid evenly
/// over that group, and sees the mean of it: with V_g [m3] the volume of all its cells, on all ranks,
///   w_c = psi_c = 1 / V_g   [1/m3]
/// for each of them. Map centroid: every cell is a group. Map cluster: the cells whose centres lie in one cube of the side
/// KernelSettings::cluster_size; the cubes begin at the lower corner of the mesh. [WasserfallCoetzeeMeyer2024]
class CellGroups {
public:
    /// Collective. \pre `kernel.map` is one of the two
    CellGroups(const CellTrees& trees, const KernelSettings& kernel, Communicator& communicator);

    /// A point, in the frame of the zone that holds the nearest cell.
    struct Point {
        Zone zone;
        Vec3 position;  ///< [m]
    };
    struct Nearest {
        std::int64_t group;
        double distance;  ///< to the centre of the nearest cell [m]
    };
    /// The group at each point; of those of equally near cells the one of lowest number. The same on every rank, whatever their number.
    /// Collective.
    std::vector<Nearest> at(const std::vector<Point>& points) const;

    struct Member {
        std::int64_t group;
        std::int32_t cell;  ///< its number among this rank's cells
    };
    /// This rank's cells of a group.
    gsl::span<const Member> members(std::int64_t group) const;

private:
    const CellTrees& trees_;
    Communicator& communicator_;
    std::vector<std::int64_t> group_;  // by cell
    std::vector<Member> members_;      // sorted by group
};

/// What of a mesh the map of `kernel` cannot do: clusters that turn, or that are smaller than a cell. Collective.
std::vector<Mistake> map_mistakes(const KernelSettings& kernel, const FluidEngine& fluid, Communicator& communicator);

}  // namespace cutterflow::coupling
