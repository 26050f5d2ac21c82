#include "solver/coupling/kernel/shared_rocks.hpp"

#include <algorithm>

namespace cutterflow::coupling {
namespace {

// By more than rounding: a rank that is near to a rock in vain costs a message, one that is missed would cost a part of the rock.
constexpr double k_margin = 1.0 + 1e-9;

constexpr std::size_t k_corners = 6;  // numbers of a box

}  // namespace

RankBoxes::RankBoxes(const CellTrees& trees, Communicator& communicator) : boxes_(static_cast<std::size_t>(communicator.size())) {
    const std::size_t zones = trees.zones();
    std::vector<double> corners(k_corners * zones * boxes_.size(), 0.0);
    for (Zone zone = 0; zone < zones; ++zone) {
        const Box box = trees.of(zone).size() > 0 ? trees.of(zone).bounds() : Box();
        double* const mine = &corners[k_corners * (zones * static_cast<std::size_t>(communicator.rank()) + zone)];
        std::copy_n(box.lower.data(), 3, mine);
        std::copy_n(box.upper.data(), 3, mine + 3);
    }
    communicator.sum(corners);
    for (std::size_t rank = 0; rank < boxes_.size(); ++rank)
        for (Zone zone = 0; zone < zones; ++zone) {
            const double* const its = &corners[k_corners * (zones * rank + zone)];
            boxes_[rank].push_back({Vec3(its), Vec3(its + 3)});
        }
}

bool RankBoxes::may_reach(int rank, const ZoneFrames& frames, const Vec3& point, double reach) const {
    const std::vector<Box>& boxes = boxes_[static_cast<std::size_t>(rank)];
    for (Zone zone = 0; zone < boxes.size(); ++zone)
        if (boxes[zone].squared_distance(frames.from_absolute(zone, point)) <= k_margin * reach * reach) return true;
    return false;
}

SharedRocks::Share& SharedRocks::share_with(int rank) {
    const auto at = std::lower_bound(shares_.begin(), shares_.end(), rank, [](const Share& share, int r) { return share.rank < r; });
    return at != shares_.end() && at->rank == rank ? *at : *shares_.insert(at, {rank, {}});
}

void SharedRocks::add(std::size_t rock, const std::vector<int>& others) {
    near_.push_back(rock);
    if (others.empty() || others.front() > rank_) led_.push_back(rock);
    if (others.empty()) return;
    shared_.push_back(rock);
    for (const int rank : others) share_with(rank).rocks.push_back(rock);
}

void SharedRocks::sum(gsl::span<double> values, std::size_t columns, Communicator& communicator) const {
    const auto packed = [&](const std::vector<std::size_t>& rocks) {
        std::vector<double> numbers;
        numbers.reserve(columns * rocks.size());
        for (const std::size_t rock : rocks) numbers.insert(numbers.end(), &values[columns * rock], &values[columns * rock] + columns);
        return numbers;
    };
    const auto add = [&](const std::vector<std::size_t>& rocks, const std::vector<double>& numbers) {
        for (std::size_t i = 0; i < rocks.size(); ++i)
            for (std::size_t k = 0; k < columns; ++k) values[columns * rocks[i] + k] += numbers[columns * i + k];
    };
    std::vector<Parcel> parcels;
    for (const Share& share : shares_) parcels.push_back({share.rank, packed(share.rocks)});
    const std::vector<double> mine = packed(shared_);
    communicator.swap(parcels);

    // In the order of the ranks, so that all add up alike.
    for (const std::size_t rock : shared_) std::fill_n(&values[columns * rock], columns, 0.0);
    bool has_mine = false;
    for (std::size_t s = 0; s <= shares_.size(); ++s) {
        if (!has_mine && (s == shares_.size() || shares_[s].rank > rank_)) {
            add(shared_, mine);
            has_mine = true;
        }
        if (s < shares_.size()) add(shares_[s].rocks, parcels[s].values);
    }
}

}  // namespace cutterflow::coupling
