#include "solver/space/point_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>

#include <nanoflann.hpp>

namespace cutterflow::coupling {
namespace {

struct Points {
    std::vector<Vec3> points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t dimension) const { return points[i][static_cast<Eigen::Index>(dimension)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, std::uint32_t>;
constexpr std::size_t k_leaf_size = 24;

/// Boxes around runs of points that follow each other in memory, and a binary tree of them. A run lies in one place in space because the
/// points are in the order of the k-d tree.
class Runs {
public:
    explicit Runs(const std::vector<Vec3>& points) : points_(points.size()) {
        for (int axis = 0; axis < 3; ++axis)
            for (const Vec3& p : points) coordinates_[static_cast<std::size_t>(axis)].push_back(p[axis]);
        const std::size_t runs = (points_ + k_length - 1) / k_length;
        while (leaves_ < runs) leaves_ *= 2;
        boxes_.resize(2 * leaves_);
        for (std::size_t i = 0; i < points_; ++i) boxes_[leaves_ + i / k_length].extend({points[i], points[i]});
        for (std::size_t node = leaves_ - 1; node > 0; --node) {
            boxes_[node].extend(boxes_[2 * node]);
            boxes_[node].extend(boxes_[2 * node + 1]);
        }
    }

    const Box& bounds() const { return boxes_[1]; }

    /// Calls `each(first, last)` for runs that may hold points of a shell about `centre`, in the order of memory, but for those in boxes
    /// that `leaves_out`, which is asked of several runs together.
    template <class LeavesOut, class Each>
    void near(const Vec3& centre, double squared_inner, double squared_outer, const LeavesOut& leaves_out, const Each& each) const {
        std::array<std::size_t, 64> open;  // nodes to look at, the next one on top; one per level and the root
        std::size_t count = 0;
        open[count++] = 1;
        while (count > 0) {
            const std::size_t node = open[--count];
            const Box& box = boxes_[node];
            if (box.squared_distance(centre) >= squared_outer || box.squared_reach(centre) < squared_inner) continue;
            if (node < leaves_ / 2 && leaves_out(box)) continue;
            if (node >= leaves_) {
                const std::size_t first = (node - leaves_) * k_length;
                each(first, std::min(first + k_length, points_));
            } else {
                open[count++] = 2 * node + 1;
                open[count++] = 2 * node;
            }
        }
    }

    double squared_distance(std::size_t i, const Vec3& centre) const {
        const double x = coordinates_[0][i] - centre[0], y = coordinates_[1][i] - centre[1], z = coordinates_[2][i] - centre[2];
        return x * x + y * y + z * z;
    }

    static constexpr std::size_t k_length = 16;

private:
    std::size_t points_;
    std::array<std::vector<double>, 3> coordinates_;  // x, y and z apart, so that a run's distances are computed together
    std::size_t leaves_ = 1;
    std::vector<Box> boxes_;  // children of node n: 2 n and 2 n + 1; the runs' own from leaves_ on
};

/// Keeps the nearest points, nearest first.
class NearestSet {
public:
    NearestSet(std::size_t count, const std::vector<std::int32_t>& indices, std::vector<Neighbour>& found)
        : count_(count), indices_(indices), found_(found) {}
    std::size_t size() const { return found_.size(); }
    bool full() const { return found_.size() == count_; }
    bool addPoint(double squared_distance, std::uint32_t i) {
        if (squared_distance >= worstDist()) return true;
        if (!full()) found_.emplace_back();
        std::size_t place = found_.size() - 1;
        for (; place > 0 && found_[place - 1].squared_distance > squared_distance; --place) found_[place] = found_[place - 1];
        found_[place] = {indices_[i], squared_distance};
        return true;
    }
    double worstDist() const { return full() ? found_.back().squared_distance : std::numeric_limits<double>::max(); }

private:
    std::size_t count_;
    const std::vector<std::int32_t>& indices_;
    std::vector<Neighbour>& found_;
};

}  // namespace

struct PointTree::Index {
    Points points;
    std::vector<std::int32_t> indices;
    std::unique_ptr<Tree> tree;
    std::optional<Runs> runs;

    void build() {
        tree = std::make_unique<Tree>(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(k_leaf_size));
        tree->buildIndex();
    }
    /// Appends the points of the runs from `inner` on and nearer than `outer`.
    template <class LeavesOut>
    void find(const Vec3& centre, double inner, double outer, const LeavesOut& leaves_out, std::vector<Neighbour>& found) const {
        const double squared_inner = inner > 0.0 ? inner * inner : 0.0, squared_outer = outer * outer;
        runs->near(centre, squared_inner, squared_outer, leaves_out, [&](std::size_t first, std::size_t last) {
            std::array<double, Runs::k_length> squared;
            for (std::size_t i = first; i < last; ++i) squared[i - first] = runs->squared_distance(i, centre);
            const std::size_t before = found.size();
            found.resize(before + last - first);
            Neighbour* next = found.data() + before;
            for (std::size_t i = first; i < last; ++i) {
                const double distance = squared[i - first];
                *next = {indices[i], distance};
                if (distance < squared_outer && distance >= squared_inner) ++next;
            }
            found.resize(static_cast<std::size_t>(next - found.data()));
        });
    }
    /// Puts the points into the order of the tree's leaves.
    void reorder() {
        Points ordered;
        std::vector<std::int32_t> ordered_indices;
        ordered.points.reserve(points.points.size());
        ordered_indices.reserve(indices.size());
        for (const std::uint32_t i : tree->vAcc) {
            ordered.points.push_back(points.points[i]);
            ordered_indices.push_back(indices[i]);
        }
        points = std::move(ordered);
        indices = std::move(ordered_indices);
    }
};

PointTree::PointTree(std::vector<Vec3> points, std::vector<std::int32_t> indices) : index_(std::make_unique<Index>()) {
    if (indices.empty()) {
        indices.resize(points.size());
        std::iota(indices.begin(), indices.end(), 0);
    }
    index_->points.points = std::move(points);
    index_->indices = std::move(indices);
    if (index_->points.points.empty()) return;
    index_->build();
    index_->reorder();
    index_->build();
    index_->runs.emplace(index_->points.points);
}

PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

std::size_t PointTree::size() const {
    return index_->points.points.size();
}

std::vector<std::int32_t> PointTree::number_by_memory(std::int32_t first) {
    std::vector<std::int32_t> before = std::move(index_->indices);
    index_->indices.resize(before.size());
    std::iota(index_->indices.begin(), index_->indices.end(), first);
    return before;
}

Box PointTree::bounds() const {
    return index_->runs ? index_->runs->bounds() : Box();
}

void PointTree::within(const Vec3& centre, double radius, std::vector<Neighbour>& found) const {
    if (!index_->tree) return;
    index_->find(
        centre, 0.0, radius, [](const Box&) { return false; }, found);
}

NearbyPoints PointTree::about(const Vec3& centre, double reach) const {
    std::vector<Neighbour> found;
    within(centre, reach, found);
    NearbyPoints nearby{centre, reach, {}};
    nearby.indices.reserve(found.size());
    for (const Neighbour& n : found) nearby.indices.push_back(n.index);
    return nearby;
}

void PointTree::between(const Vec3& centre, double inner, double outer, const std::function<bool(const Box&)>& leaves_out,
                        std::vector<Neighbour>& found) const {
    if (!index_->tree) return;
    const auto is_left_out = [&](const Box& box) { return (box.upper - box.lower).maxCoeff() <= 2.0 * outer && leaves_out(box); };
    index_->find(centre, inner, outer, is_left_out, found);
}

void PointTree::nearest(const Vec3& centre, std::size_t count, std::vector<Neighbour>& found) const {
    found.clear();
    if (!index_->tree) return;
    NearestSet set(count, index_->indices, found);
    index_->tree->findNeighbors(set, centre.data(), nanoflann::SearchParams(0, 0.0f, false));
}

}  // namespace cutterflow::coupling
