#pragma once
/// \file Search among points that do not move.
#include <cstdint>
#include <memory>
#include <vector>

#include <gsl/span>

#include "geometry/base/vec3.hpp"

namespace cutterflow::coupling {

/// A point that a search found.
struct Neighbour {
    std::int32_t index;       ///< in the array that the tree was built from
    double squared_distance;  ///< [m2]
};

/// Points in the order of a k-d tree (nanoflann): neighbours in space are neighbours in memory. The tree finds the nearest points; for all
/// points within a radius, which may be thousands, runs of points are taken together.
class PointTree {
public:
    /// \param points   [m]
    /// \param indices  what a search returns for each point; empty: 0, 1, 2, ...
    explicit PointTree(std::vector<Vec3> points, std::vector<std::int32_t> indices = {});
    ~PointTree();
    PointTree(PointTree&&) noexcept;
    PointTree& operator=(PointTree&&) noexcept;

    std::size_t size() const;

    /// Appends every point nearer than `radius` [m] to `found`, in the order of memory.
    void within(const Vec3& centre, double radius, std::vector<Neighbour>& found) const;

    /// The `count` nearest points, nearest first; fewer when the tree holds fewer.
    void nearest(const Vec3& centre, std::size_t count, std::vector<Neighbour>& found) const;

private:
    struct Index;
    std::unique_ptr<Index> index_;
};

}  // namespace cutterflow::coupling
