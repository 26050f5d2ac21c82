#pragma once
/// \file Which rocks' kernels reach cells of which ranks, and sums over the ranks that share a rock.
#include <vector>

#include "solver/ports/communicator.hpp"
#include "solver/space/box.hpp"
#include "solver/space/visibility.hpp"

namespace cutterflow::coupling {

/// The boxes around each rank's cells, by zone and in the zone's frame, in which they do not move: the same on every rank.
class RankBoxes {
public:
    /// Collective.
    RankBoxes(const CellTrees& trees, Communicator& communicator);

    int size() const { return static_cast<int>(boxes_.size()); }
    /// Whether a rank may have cells within `reach` [m] of a point [m, absolute]; the same answer on every rank.
    bool may_reach(int rank, const ZoneFrames& frames, const Vec3& point, double reach) const;

private:
    std::vector<std::vector<Box>> boxes_;  // by rank and zone
};

/// The rocks near this rank's cells and the other ranks that are near to them too. What a rock's kernel adds up to over its cells is
/// known after messages between those ranks alone.
class SharedRocks {
public:
    SharedRocks() = default;
    explicit SharedRocks(int rank) : rank_(rank) {}

    /// A rock is near this rank's cells. \param rock  its number, larger than the last one's \param others  ascending
    void add(std::size_t rock, const std::vector<int>& others);

    const std::vector<std::size_t>& near() const { return near_; }  ///< ascending
    /// Those for which this rank speaks: the first of the ranks near to it. Every rock has one.
    const std::vector<std::size_t>& led() const { return led_; }

    /// Sums `columns` values per rock over the ranks near to it, in place, the same bits on each of them. \param values  rock by rock;
    /// those of rock that is not near stay as they are. Collective
    void sum(gsl::span<double> values, std::size_t columns, Communicator& communicator) const;

private:
    struct Share {
        int rank;
        std::vector<std::size_t> rocks;
    };
    Share& share_with(int rank);

    int rank_ = 0;
    std::vector<std::size_t> near_, led_;
    std::vector<std::size_t> shared_;  // near to other ranks too
    std::vector<Share> shares_;        // by rank
};

}  // namespace cutterflow::coupling
