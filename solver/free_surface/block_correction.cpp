#include "solver/free_surface/block_correction.hpp"

namespace cutterflow::free_surface {

void BlockCorrection::begin(std::vector<int> block_of_row, int blocks) {
    blocks_ = blocks;
    block_of_row_ = std::move(block_of_row);
    diagonal_.assign(blocks + 1, 0.0);
    below_diagonal_.clear();
}

void BlockCorrection::add(int block_a, int block_b, double entry) {
    if (block_a == block_b) diagonal_[block_a] += entry;
    if (block_a > block_b && block_a < blocks_) below_diagonal_.emplace_back(block_a, block_b, entry);
}

void BlockCorrection::factorise() {
    for (int block = 0; block < blocks_; ++block) below_diagonal_.emplace_back(block, block, diagonal_[block]);
    Eigen::SparseMatrix<double> matrix(blocks_, blocks_);
    matrix.setFromTriplets(below_diagonal_.begin(), below_diagonal_.end());
    factor_.compute(matrix);
    values_.resize(blocks_ + 1);
}

void BlockCorrection::correct(const Eigen::VectorXd& residual, const Eigen::VectorXd& image, Eigen::VectorXd& z) const {
    if (blocks_ == 0 || factor_.info() != Eigen::Success) return;  // numbers that are none: the solver finds them
    const int rows = static_cast<int>(block_of_row_.size());
    double* value = values_.data();
    values_.setZero();
    for (int r = 0; r < rows; ++r) value[block_of_row_[r]] += residual.data()[r] - image.data()[r];
    values_.head(blocks_) = factor_.solve(values_.head(blocks_)).eval();
    value[blocks_] = 0.0;
    for (int r = 0; r < rows; ++r) z.data()[r] += value[block_of_row_[r]];
}

}  // namespace cutterflow::free_surface
