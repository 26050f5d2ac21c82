#include "solver/space/size_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace cutterflow::coupling {
namespace {

constexpr std::size_t k_neighbours = 24;
// A vicinity reaches this much farther than the nearest cells.
constexpr double k_vicinity = 1.75;
// Cell sizes that differ by less are one: the rounding of a cube root of a volume.
constexpr double k_uniform = 1e-9;
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

/// A cell near a point.
struct SizeField::Near {
    double squared_distance;
    Zone zone;
    std::int32_t index;
    bool operator<(const Near& other) const {
        return std::tie(squared_distance, zone, index) < std::tie(other.squared_distance, other.zone, other.index);
    }
};

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
        std::vector<Vec3> centres;
        for (std::size_t i = 0; i < all.size(); i += 4) centres.emplace_back(all[i], all[i + 1], all[i + 2]);
        PointTree& tree = trees_.emplace_back(centres);
        for (const std::int32_t i : tree.number_by_memory(0)) {
            centres_[zone].push_back(centres[static_cast<std::size_t>(i)]);
            sizes_[zone].push_back(all[4 * static_cast<std::size_t>(i) + 3]);
            smallest_ = std::min(smallest_, sizes_[zone].back());
            largest_ = std::max(largest_, sizes_[zone].back());
        }
        count_ += centres.size();
    }
    is_uniform_ = largest_ <= (1.0 + k_uniform) * smallest_;
}

SizeField::Surroundings SizeField::around(const ZoneFrames& frames, const Vec3& point, Vicinity& vicinity) const {
    if (is_uniform_ && trees_.size() == 1) return {smallest_, k_still_zone};
    std::vector<Near> cells;
    if (!nearest_of(vicinity, frames, point, cells)) {
        renew(frames, point, vicinity);
        nearest_of(vicinity, frames, point, cells);
    }
    std::sort(cells.begin(), cells.end());
    const double reach2 = cells.back().squared_distance;
    double sum = 0.0, weights = 0.0;
    for (const Near& cell : cells) {
        const double t = 1.0 - cell.squared_distance / reach2;
        sum += t * t * sizes_[cell.zone][static_cast<std::size_t>(cell.index)];
        weights += t * t;
    }
    const Near& nearest = cells.front();
    return {weights > 0.0 ? sum / weights : sizes_[nearest.zone][static_cast<std::size_t>(nearest.index)], nearest.zone};
}

/// The nearest cells as far as the vicinity knows, in no order. \return whether they are the nearest of the mesh
bool SizeField::nearest_of(const Vicinity& vicinity, const ZoneFrames& frames, const Vec3& point, std::vector<Near>& cells) const {
    if (vicinity.zones.empty()) return false;
    cells.clear();
    double known = std::numeric_limits<double>::infinity();  // no cell nearer than this is missing [m]
    for (Zone zone = 0; zone < trees_.size(); ++zone) {
        const NearbyPoints& nearby = vicinity.zones[zone];
        const Vec3 here = frames.from_absolute(zone, point);
        known = std::min(known, nearby.known_about(here));
        for (const std::int32_t c : nearby.indices)
            cells.push_back({(centres_[zone][static_cast<std::size_t>(c)] - here).squaredNorm(), zone, c});
    }
    if (cells.size() < std::min(k_neighbours, count_)) return false;
    if (cells.size() > k_neighbours) {
        std::nth_element(cells.begin(), cells.begin() + (k_neighbours - 1), cells.end());
        cells.resize(k_neighbours);
    }
    const double farthest2 = std::max_element(cells.begin(), cells.end())->squared_distance;
    return known > 0.0 && farthest2 < known * known;
}

void SizeField::renew(const ZoneFrames& frames, const Vec3& point, Vicinity& vicinity) const {
    std::vector<Neighbour> found;
    std::vector<double> squared, first(trees_.size(), std::numeric_limits<double>::infinity());
    for (Zone zone = 0; zone < trees_.size(); ++zone) {
        trees_[zone].nearest(frames.from_absolute(zone, point), k_neighbours, found);
        for (const Neighbour& n : found) squared.push_back(n.squared_distance);
        if (!found.empty()) first[zone] = std::sqrt(found.front().squared_distance);
    }
    std::sort(squared.begin(), squared.end());
    const double reach = k_vicinity * std::sqrt(squared[std::min(k_neighbours, squared.size()) - 1]);
    vicinity.zones.clear();
    vicinity.zones.reserve(trees_.size());
    for (Zone zone = 0; zone < trees_.size(); ++zone) {
        const double known = count_ <= k_neighbours ? std::numeric_limits<double>::infinity() : std::max(reach, first[zone]);
        vicinity.zones.push_back(trees_[zone].about(frames.from_absolute(zone, point), known));
    }
}

Vec3 SizeField::nearest_centre(const ZoneFrames& frames, const Vec3& point) const {
    Neighbour nearest{0, std::numeric_limits<double>::infinity()};
    Zone its_zone = k_still_zone;
    std::vector<Neighbour> found;
    for (Zone zone = 0; zone < trees_.size(); ++zone) {
        trees_[zone].nearest(frames.from_absolute(zone, point), 1, found);
        if (found.empty() || found[0].squared_distance >= nearest.squared_distance) continue;
        nearest = found[0];
        its_zone = zone;
    }
    return frames.to_absolute(its_zone, centres_[its_zone][static_cast<std::size_t>(nearest.index)]);
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
