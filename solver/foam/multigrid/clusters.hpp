#pragma once
/// \file Clusters of cells, which are the cells of a multigrid's next level.
#include <vector>

namespace cutterflow::foam {

/// Cells that share faces, OpenFOAM's ldu addressing: the faces of a cell follow each other by their other cell.
struct FaceGraph {
    int cells = 0;
    std::vector<int> lower, upper;  ///< the two cells of each face, lower < upper

    std::size_t faces() const { return lower.size(); }
    /// Number of the first of each cell's faces when all cells list theirs in turn, and how many they list in all.
    std::vector<int> starts() const;
};

/// A symmetric matrix on such a graph.
struct FaceMatrix {
    std::vector<double> diagonal;  ///< of each cell
    std::vector<double> coupling;  ///< of each face, both off-diagonal elements
};

/// From the cells of one level to those of the next.
struct Clusters {
    std::vector<int> of_cells;  ///< number of each cell's cluster
    FaceGraph graph;            ///< of the clusters
    std::vector<int> of_faces;  ///< number of each face between clusters in `graph`; -1 within a cluster

    /// Galerkin's product P^T A P with P = 1 for the cells of a cluster: what the clusters' matrix is when all cells of one change alike.
    void gather(const FaceGraph& cells, const FaceMatrix& of_cells_in, FaceMatrix& of_clusters) const;
};

/// Joins cells in pairs, `passes` times, so that a cluster has some 2^passes of them. A cell takes the free neighbour behind its strongest
/// face; without a free one of at least a quarter of its strongest face's strength it joins its strongest neighbour's pair. Strengths that
/// differ by less than a millionth are equal, so that rounding in them decides nothing. A cell without faces stays alone.
/// \param strength  of each face, >= 0
Clusters cluster(const FaceGraph& cells, const std::vector<double>& strength, int passes);

/// Strength of the faces between clusters: the sum over the faces of the cells.
std::vector<double> gather_strength(const Clusters& clusters, const std::vector<double>& strength);

}  // namespace cutterflow::foam
