#pragma once
/// \file Search among points that do not move.
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <gsl/span>

#include "geometry/base/vec3.hpp"
#include "solver/space/box.hpp"

namespace cutterflow::coupling {

/// A point that a search found.
struct Neighbour {
    std::int32_t index;       ///< in the array that the tree was built from
    double squared_distance;  ///< [m2]
};

/// Points of a tree about a place that travels: they are looked for anew when it has come too far.
struct NearbyPoints {
    Vec3 centre = Vec3::Zero();         ///< [m]
    double reach = -1.0;                ///< [m]; `indices` are all points of the tree nearer than this to the centre
    std::vector<std::int32_t> indices;  ///< in the order of memory
    /// Every point nearer than this [m] to a place is among them.
    double known_about(const Vec3& place) const { return reach - (place - centre).norm(); }
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

    /// Lets searches return `first`, `first` + 1, ... in the order of memory. \return the indices that they returned before, in that order
    std::vector<std::int32_t> number_by_memory(std::int32_t first);

    /// The box around all points.
    Box bounds() const;

    /// Appends every point nearer than `radius` [m] to `found`, in the order of memory.
    void within(const Vec3& centre, double radius, std::vector<Neighbour>& found) const;

    /// Every point nearer than `reach` [m], which may be infinite.
    NearbyPoints about(const Vec3& centre, double reach) const;

    /// Appends every point at a distance [m] of `inner` or more and less than `outer`, in the order of memory, but for boxes of points of
    /// which `leaves_out` says that none is wanted. It is asked of boxes no larger than the ball.
    void between(const Vec3& centre, double inner, double outer, const std::function<bool(const Box&)>& leaves_out,
                 std::vector<Neighbour>& found) const;

    /// The `count` nearest points, nearest first; fewer when the tree holds fewer.
    void nearest(const Vec3& centre, std::size_t count, std::vector<Neighbour>& found) const;

private:
    struct Index;
    std::unique_ptr<Index> index_;
};

}  // namespace cutterflow::coupling
