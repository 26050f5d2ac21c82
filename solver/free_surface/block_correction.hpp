#pragma once
/// \file What a preconditioner of near neighbours cannot see: the means over blocks of cells.
#include <vector>

#include <Eigen/SparseCholesky>

namespace cutterflow::free_surface {

/// Correction z += Z E^-1 Z^T (r - A z) of a symmetric positive system A, E = Z^T A Z; column I of Z is 1 in the rows of block I and 0
/// elsewhere. After it r - A z has no sum over any block. E is small and factorised. [TangNabbenVuikErlangga2009]
class BlockCorrection {
public:
    /// Begins a new system. \param block_of_row  0 to `blocks`, the last: in no block
    void begin(std::vector<int> block_of_row, int blocks);
    int block(int row) const { return block_of_row_[row]; }
    /// Adds the entry of A between a row of one block and a row of another; for each order of a pair once.
    void add(int block_a, int block_b, double entry);
    void factorise();

    /// \param image  A z as z comes in. Entries of z behind those of the residual stay.
    void correct(const Eigen::VectorXd& residual, const Eigen::VectorXd& image, Eigen::VectorXd& z) const;

private:
    int blocks_ = 0;
    std::vector<int> block_of_row_;
    std::vector<double> diagonal_;
    std::vector<Eigen::Triplet<double>> below_diagonal_;
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
    mutable Eigen::VectorXd values_;  // of each block and of no block
};

}  // namespace cutterflow::free_surface
