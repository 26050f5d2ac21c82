#include "solver/coupling/kernel/cell_groups.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gsl/assert>

#include "geometry/base/mistakes.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::coupling {
namespace {

constexpr double k_none = -std::numeric_limits<double>::infinity();

/// Cells that can be equally near to a point: those about a corner of hexahedra.
constexpr std::size_t k_equally_near = 8;

/// A cluster may be this share of a cell shorter than the cell: rounding of the cube root of a volume.
constexpr double k_rounding = 1e-9;

std::vector<std::int64_t> number_cells(const Cells& cells, const KernelSettings&, Communicator&) {
    return {cells.ids.begin(), cells.ids.end()};
}

/// Numbers of the cubes in which the cells' centres lie.
std::vector<std::int64_t> number_cubes(const Cells& cells, const KernelSettings& kernel, Communicator& communicator) {
    std::array<double, 6> reach;  // of the mesh against and along each axis [m]
    reach.fill(k_none);
    for (std::size_t c = 0; c < cells.centres.size(); ++c)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double centre = cells.centres[c][static_cast<Eigen::Index>(axis)], half = 0.5 * cells.sizes[c];
            reach[axis] = std::max(reach[axis], half - centre);
            reach[axis + 3] = std::max(reach[axis + 3], half + centre);
        }
    communicator.max(reach);
    const Vec3 lower(-reach[0], -reach[1], -reach[2]), upper(reach[3], reach[4], reach[5]);
    const auto cube_of = [&](const Vec3& point) -> Eigen::Matrix<std::int64_t, 3, 1> {
        return ((point - lower) / kernel.cluster_size).array().floor().cast<std::int64_t>();
    };
    const Eigen::Matrix<std::int64_t, 3, 1> most = cube_of(upper);
    std::vector<std::int64_t> numbers;
    for (const Vec3& centre : cells.centres) {
        const auto cube = cube_of(centre);
        numbers.push_back(cube[0] + (most[0] + 1) * (cube[1] + (most[1] + 1) * cube[2]));
    }
    return numbers;
}

struct GroupedMap {
    const char* name;
    std::vector<std::int64_t> (*number)(const Cells&, const KernelSettings&, Communicator&);  ///< of each cell's group
};

constexpr std::array<GroupedMap, 2> k_grouped_maps{{{k_centroid_map, number_cells}, {k_cluster_map, number_cubes}}};

std::vector<std::int64_t> group_numbers(const Cells& cells, const KernelSettings& kernel, Communicator& communicator) {
    const auto map = std::find_if(k_grouped_maps.begin(), k_grouped_maps.end(), [&](const auto& row) { return kernel.map == row.name; });
    Expects(map != k_grouped_maps.end());
    return map->number(cells, kernel, communicator);
}

}  // namespace

CellGroups::CellGroups(const CellTrees& trees, const KernelSettings& kernel, Communicator& communicator)
    : trees_(trees), communicator_(communicator), group_(group_numbers(trees.cells(), kernel, communicator)) {
    for (std::size_t c = 0; c < group_.size(); ++c) members_.push_back({group_[c], static_cast<std::int32_t>(c)});
    std::stable_sort(members_.begin(), members_.end(), [](const Member& a, const Member& b) { return a.group < b.group; });
}

std::vector<CellGroups::Nearest> CellGroups::at(const std::vector<Point>& points) const {
    // The ranks know of maxima alone: what is wanted least has a minus.
    std::vector<double> nearness(points.size(), k_none), group(points.size(), k_none);
    std::vector<std::vector<Neighbour>> found(points.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
        trees_.of(points[p].zone).nearest(points[p].position, k_equally_near, found[p]);
        if (!found[p].empty()) nearness[p] = -found[p].front().squared_distance;
    }
    communicator_.max(nearness);
    for (std::size_t p = 0; p < points.size(); ++p)
        for (const Neighbour& n : found[p])
            if (-n.squared_distance == nearness[p])
                group[p] = std::max(group[p], -static_cast<double>(group_[static_cast<std::size_t>(trees_.number(n.index))]));
    communicator_.max(group);

    std::vector<Nearest> nearest;
    for (std::size_t p = 0; p < points.size(); ++p) nearest.push_back({static_cast<std::int64_t>(-group[p]), std::sqrt(-nearness[p])});
    return nearest;
}

gsl::span<const CellGroups::Member> CellGroups::members(std::int64_t group) const {
    const auto first =
        std::lower_bound(members_.begin(), members_.end(), group, [](const Member& m, std::int64_t g) { return m.group < g; });
    const auto last = std::upper_bound(first, members_.end(), group, [](std::int64_t g, const Member& m) { return g < m.group; });
    return {members_.data() + (first - members_.begin()), static_cast<std::size_t>(last - first)};
}

std::vector<Mistake> map_mistakes(const KernelSettings& kernel, const FluidEngine& fluid, Communicator& communicator) {
    if (kernel.map != k_cluster_map) return {};
    Mistakes mistakes(names::coupling_properties);
    for (const ZoneMotion& zone : fluid.moving_zones())
        mistakes.add(fmt::format("kernel.map = {} with the turning cell zone {}", kernel.map, zone.name),
                     "Clusters of cells do not turn, and reach through steel", "Set: map gaussian;");
    double largest = 0.0;
    for (const double size : fluid.cells().sizes) largest = std::max(largest, size);
    communicator.max(gsl::span<double>(&largest, 1));
    mistakes.require(kernel.cluster_size >= (1.0 - k_rounding) * largest, "kernel.clusterSize", kernel.cluster_size,
                     fmt::format("A cluster is at least as long as a cell; the largest one measures {:.4g} m", largest),
                     "Make it longer, or the cells smaller");
    return mistakes.take();
}

}  // namespace cutterflow::coupling
