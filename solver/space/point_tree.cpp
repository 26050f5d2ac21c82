#include "solver/space/point_tree.hpp"

#include <limits>
#include <numeric>

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

/// Collects what lies within a radius without the sorting and the pairs of nanoflann's own set.
class RadiusSet {
public:
    RadiusSet(double squared_radius, const std::vector<std::int32_t>& indices, std::vector<Neighbour>& found)
        : squared_radius_(squared_radius), indices_(indices), found_(found) {}
    std::size_t size() const { return found_.size(); }
    bool full() const { return true; }
    bool addPoint(double squared_distance, std::uint32_t i) {
        if (squared_distance < squared_radius_) found_.push_back({indices_[i], squared_distance});
        return true;
    }
    double worstDist() const { return squared_radius_; }

private:
    double squared_radius_;
    const std::vector<std::int32_t>& indices_;
    std::vector<Neighbour>& found_;
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

    void build() {
        tree = std::make_unique<Tree>(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(k_leaf_size));
        tree->buildIndex();
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
}

PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

std::size_t PointTree::size() const {
    return index_->points.points.size();
}

void PointTree::within(const Vec3& centre, double radius, std::vector<Neighbour>& found) const {
    if (!index_->tree) return;
    RadiusSet set(radius * radius, index_->indices, found);
    index_->tree->findNeighbors(set, centre.data(), nanoflann::SearchParams(0, 0.0f, false));
}

void PointTree::nearest(const Vec3& centre, std::size_t count, std::vector<Neighbour>& found) const {
    found.clear();
    if (!index_->tree) return;
    NearestSet set(count, index_->indices, found);
    index_->tree->findNeighbors(set, centre.data(), nanoflann::SearchParams(0, 0.0f, false));
}

}  // namespace cutterflow::coupling
