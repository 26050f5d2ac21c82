#pragma once
/// \file Gauss-Seidel sweeps over the cells of a level.
#include <vector>

#include "solver/foam/multigrid/clusters.hpp"

namespace cutterflow::foam {

/// Where the elements of a matrix on a graph stand, row by row.
struct RowLayout {
    std::vector<int> start, upper;  ///< of each row: its first element, its first one right of the diagonal; start has one more
    std::vector<int> column;
    std::vector<int> of_lower, of_upper;  ///< of each face: its element in the row of its lower and of its upper cell

    explicit RowLayout(const FaceGraph& graph);
    std::size_t rows() const { return upper.size(); }
};

/// A symmetric matrix A by rows, in single precision: half as much to read, and a preconditioner needs no more.
class LevelMatrix {
public:
    /// \param layout  must outlive it
    LevelMatrix(const RowLayout& layout, const FaceMatrix& matrix);

    /// x = (L + D)^-1 b, a sweep in the order of the cells from x = 0, and r = b - A x = -U x. A = L + D + U.
    void sweep_forward(const std::vector<float>& b, std::vector<float>& x, std::vector<float>& r) const;

    /// x <- (D + U)^-1 (b - L x), a sweep against the order of the cells.
    void sweep_backward(const std::vector<float>& b, std::vector<float>& x) const;

    /// r <- r - A x.
    void subtract(const std::vector<float>& x, std::vector<float>& r) const;

private:
    const RowLayout* layout_;
    std::vector<float> value_, diagonal_, inverse_diagonal_;
};

}  // namespace cutterflow::foam
