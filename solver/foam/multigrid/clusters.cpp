#include "solver/foam/multigrid/clusters.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cutterflow::foam {
namespace {

constexpr double k_weak = 0.25;               // of a cell's strongest face
constexpr double k_same = 1.0 + 1e-6;         // strengths are equal up to this ratio
constexpr double k_enough = k_weak / k_same;  // a quarter, whatever the rounding

/// Faces of each cell: those of cell i are face[start[i]] to face[start[i + 1]].
struct CellFaces {
    std::vector<int> start, face;

    explicit CellFaces(const FaceGraph& graph) : start(graph.starts()), face(2 * graph.faces()) {
        std::vector<int> next(start.begin(), start.end() - 1);
        for (const std::vector<int>* cells : {&graph.upper, &graph.lower})
            for (std::size_t k = 0; k < cells->size(); ++k)
                face[static_cast<std::size_t>(next[static_cast<std::size_t>((*cells)[k])]++)] = static_cast<int>(k);
    }
};

/// One pass: number of each cell's pair and how many pairs there are.
std::pair<std::vector<int>, int> pair_up(const FaceGraph& graph, const std::vector<double>& strength) {
    const CellFaces faces(graph);
    std::vector<int> pair(static_cast<std::size_t>(graph.cells), -1);
    int pairs = 0;
    for (int cell = 0; cell < graph.cells; ++cell) {
        const auto own = static_cast<std::size_t>(cell);
        if (pair[own] >= 0) continue;
        double strongest_free = 0.0, strongest = 0.0;
        int partner = -1, neighbour = -1;
        for (int k = faces.start[own]; k < faces.start[own + 1]; ++k) {
            const auto face = static_cast<std::size_t>(faces.face[static_cast<std::size_t>(k)]);
            const int other = graph.lower[face] == cell ? graph.upper[face] : graph.lower[face];
            if (strength[face] > k_same * strongest) {
                strongest = strength[face];
                neighbour = other;
            }
            if (pair[static_cast<std::size_t>(other)] < 0 && strength[face] > k_same * strongest_free) {
                strongest_free = strength[face];
                partner = other;
            }
        }
        if (partner >= 0 && strongest_free > k_enough * strongest)
            pair[own] = pair[static_cast<std::size_t>(partner)] = pairs++;
        else if (neighbour >= 0 && pair[static_cast<std::size_t>(neighbour)] >= 0)
            pair[own] = pair[static_cast<std::size_t>(neighbour)];
        else
            pair[own] = pairs++;
    }
    return {std::move(pair), pairs};
}

/// The graph of clusters, from the cluster of each cell.
Clusters joined(const FaceGraph& cells, std::vector<int> cluster_of_cells, int count) {
    Clusters clusters;
    clusters.of_faces.assign(cells.faces(), -1);
    std::vector<std::pair<std::pair<int, int>, int>> between;  // clusters, face
    between.reserve(cells.faces());
    for (std::size_t face = 0; face < cells.faces(); ++face) {
        const auto [lower, upper] = std::minmax(cluster_of_cells[static_cast<std::size_t>(cells.lower[face])],
                                                cluster_of_cells[static_cast<std::size_t>(cells.upper[face])]);
        if (lower != upper) between.push_back({{lower, upper}, static_cast<int>(face)});
    }
    std::sort(between.begin(), between.end());
    clusters.graph.cells = count;
    for (std::size_t k = 0; k < between.size(); ++k) {
        if (k == 0 || between[k].first != between[k - 1].first) {
            clusters.graph.lower.push_back(between[k].first.first);
            clusters.graph.upper.push_back(between[k].first.second);
        }
        clusters.of_faces[static_cast<std::size_t>(between[k].second)] = static_cast<int>(clusters.graph.faces()) - 1;
    }
    clusters.of_cells = std::move(cluster_of_cells);
    return clusters;
}

}  // namespace

std::vector<int> FaceGraph::starts() const {
    std::vector<int> start(static_cast<std::size_t>(cells) + 1, 0);
    for (const std::vector<int>* side : {&lower, &upper})
        for (const int cell : *side) ++start[static_cast<std::size_t>(cell) + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    return start;
}

void Clusters::gather(const FaceGraph& cells, const FaceMatrix& of_cells_in, FaceMatrix& of_clusters) const {
    of_clusters.diagonal.assign(static_cast<std::size_t>(graph.cells), 0.0);
    of_clusters.coupling.assign(graph.faces(), 0.0);
    for (std::size_t cell = 0; cell < of_cells.size(); ++cell)
        of_clusters.diagonal[static_cast<std::size_t>(of_cells[cell])] += of_cells_in.diagonal[cell];
    for (std::size_t face = 0; face < of_faces.size(); ++face) {
        const double value = of_cells_in.coupling[face];
        if (of_faces[face] >= 0)
            of_clusters.coupling[static_cast<std::size_t>(of_faces[face])] += value;
        else
            of_clusters.diagonal[static_cast<std::size_t>(of_cells[static_cast<std::size_t>(cells.lower[face])])] += 2.0 * value;
    }
}

std::vector<double> gather_strength(const Clusters& clusters, const std::vector<double>& strength) {
    std::vector<double> sum(clusters.graph.faces(), 0.0);
    for (std::size_t face = 0; face < strength.size(); ++face)
        if (clusters.of_faces[face] >= 0) sum[static_cast<std::size_t>(clusters.of_faces[face])] += strength[face];
    return sum;
}

Clusters cluster(const FaceGraph& cells, const std::vector<double>& strength, int passes) {
    std::vector<int> of_cells(static_cast<std::size_t>(cells.cells));
    std::iota(of_cells.begin(), of_cells.end(), 0);
    Clusters clusters = joined(cells, of_cells, cells.cells);
    for (int pass = 0; pass < passes; ++pass) {
        const auto [pair, pairs] = pair_up(clusters.graph, gather_strength(clusters, strength));
        for (int& number : of_cells) number = pair[static_cast<std::size_t>(number)];
        clusters = joined(cells, of_cells, pairs);
    }
    return clusters;
}

}  // namespace cutterflow::foam
