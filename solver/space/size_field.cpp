#include "solver/space/size_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cutterflow::coupling {
namespace {

constexpr std::size_t k_neighbours = 24;
// A moving cell lies at the interface when a still cell's centre is this many sizes away at most.
constexpr double k_interface_reach = 1.5;

/// The values of all ranks, rank by rank, on every rank.
std::vector<double> gather(Communicator& communicator, const std::vector<double>& mine) {
    std::vector<double> counts(static_cast<std::size_t>(communicator.size()), 0.0);
    counts[static_cast<std::size_t>(communicator.rank())] = static_cast<double>(mine.size());
    communicator.sum(counts);
    double offset = 0.0, total = 0.0;
    for (std::size_t rank = 0; rank < counts.size(); ++rank) {
        if (static_cast<int>(rank) < communicator.rank()) offset += counts[rank];
        total += counts[rank];
    }
    std::vector<double> all(static_cast<std::size_t>(total), 0.0);
    std::copy(mine.begin(), mine.end(), all.begin() + static_cast<std::ptrdiff_t>(offset));
    communicator.sum(all);
    return all;
}

}  // namespace

SizeField::SizeField(const Cells& cells, std::size_t zones, Communicator& communicator) : centres_(zones), sizes_(zones) {
    smallest_ = std::numeric_limits<double>::infinity();
    for (Zone zone = 0; zone < zones; ++zone) {
        std::vector<double> mine;
        for (std::size_t c = 0; c < cells.centres.size(); ++c) {
            if (cells.zone[c] != zone) continue;
            mine.insert(mine.end(), cells.centres[c].data(), cells.centres[c].data() + 3);
            mine.push_back(cells.sizes[c]);
        }
        const std::vector<double> all = gather(communicator, mine);
        for (std::size_t i = 0; i < all.size(); i += 4) {
            centres_[zone].emplace_back(all[i], all[i + 1], all[i + 2]);
            sizes_[zone].push_back(all[i + 3]);
            smallest_ = std::min(smallest_, all[i + 3]);
        }
        trees_.emplace_back(centres_[zone]);
    }
}

SizeField::Surroundings SizeField::around(const ZoneFrames& frames, const Vec3& point) const {
    struct Cell {
        double squared_distance;
        Zone zone;
        std::size_t index;
    };
    std::array<Cell, 2 * k_neighbours> cells;  // nearest first
    std::size_t count = 0;
    std::vector<Neighbour> found;
    for (Zone zone = 0; zone < trees_.size(); ++zone) {
        const std::size_t before = count;
        trees_[zone].nearest(frames.from_absolute(zone, point), k_neighbours, found);
        for (const Neighbour& n : found) cells[count++] = {n.squared_distance, zone, static_cast<std::size_t>(n.index)};
        std::inplace_merge(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(before),
                           cells.begin() + static_cast<std::ptrdiff_t>(count),
                           [](const Cell& a, const Cell& b) { return a.squared_distance < b.squared_distance; });
        count = std::min(k_neighbours, count);
    }
    const double reach2 = cells[count - 1].squared_distance;
    double sum = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double t = 1.0 - cells[i].squared_distance / reach2;
        sum += t * t * sizes_[cells[i].zone][cells[i].index];
        weights += t * t;
    }
    const Cell& nearest = cells[0];
    return {weights > 0.0 ? sum / weights : sizes_[nearest.zone][nearest.index], nearest.zone,
            frames.to_absolute(nearest.zone, centres_[nearest.zone][nearest.index])};
}

double SizeField::interface_speed(gsl::span<const ZoneMotion> moving) const {
    double fastest = 0.0;
    std::vector<Neighbour> found;
    for (Zone zone = 1; zone < trees_.size(); ++zone) {
        const ZoneMotion& motion = moving[zone - 1];
        if (motion.speed == 0.0) continue;
        for (std::size_t c = 0; c < centres_[zone].size(); ++c) {
            const Vec3& centre = centres_[zone][c];
            trees_[k_still_zone].nearest(centre, 1, found);
            if (found.empty() || found[0].squared_distance > std::pow(k_interface_reach * sizes_[zone][c], 2)) continue;
            fastest = std::max(fastest, std::abs(motion.speed) * motion.axis.direction.cross(centre - motion.axis.origin).norm());
        }
    }
    return fastest;
}

}  // namespace cutterflow::coupling
