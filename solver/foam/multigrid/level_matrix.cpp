#include "solver/foam/multigrid/level_matrix.hpp"

namespace cutterflow::foam {

RowLayout::RowLayout(const FaceGraph& graph)
    : start(graph.starts()), column(2 * graph.faces()), of_lower(graph.faces()), of_upper(graph.faces()) {
    upper.assign(start.begin(), start.end() - 1);
    for (std::size_t face = 0; face < graph.faces(); ++face) {
        of_upper[face] = upper[static_cast<std::size_t>(graph.upper[face])]++;
        column[static_cast<std::size_t>(of_upper[face])] = graph.lower[face];
    }
    std::vector<int> next(upper);
    for (std::size_t face = 0; face < graph.faces(); ++face) {
        of_lower[face] = next[static_cast<std::size_t>(graph.lower[face])]++;
        column[static_cast<std::size_t>(of_lower[face])] = graph.upper[face];
    }
}

LevelMatrix::LevelMatrix(const RowLayout& layout, const FaceMatrix& matrix)
    : layout_(&layout),
      value_(layout.column.size()),
      diagonal_(matrix.diagonal.begin(), matrix.diagonal.end()),
      inverse_diagonal_(layout.rows()) {
    for (std::size_t row = 0; row < layout.rows(); ++row) inverse_diagonal_[row] = static_cast<float>(1.0 / matrix.diagonal[row]);
    for (std::size_t face = 0; face < layout.of_lower.size(); ++face)
        value_[static_cast<std::size_t>(layout.of_lower[face])] = value_[static_cast<std::size_t>(layout.of_upper[face])] =
            static_cast<float>(matrix.coupling[face]);
}

void LevelMatrix::sweep_forward(const std::vector<float>& b, std::vector<float>& x, std::vector<float>& r) const {
    const auto &start = layout_->start, &upper = layout_->upper;
    const std::size_t rows = layout_->rows();
    const float* const value = value_.data();
    const int* const column = layout_->column.data();
    for (std::size_t row = 0; row < rows; ++row) {
        float rest = b[row];
        for (int k = start[row]; k < upper[row]; ++k) rest -= value[k] * x[static_cast<std::size_t>(column[k])];
        x[row] = rest * inverse_diagonal_[row];
    }
    for (std::size_t row = 0; row < rows; ++row) {
        float rest = 0.0F;
        for (int k = upper[row]; k < start[row + 1]; ++k) rest -= value[k] * x[static_cast<std::size_t>(column[k])];
        r[row] = rest;
    }
}

void LevelMatrix::sweep_backward(const std::vector<float>& b, std::vector<float>& x) const {
    const std::vector<int>& start = layout_->start;
    const float* const value = value_.data();
    const int* const column = layout_->column.data();
    for (std::size_t row = layout_->rows(); row-- > 0;) {
        float rest = b[row];
        for (int k = start[row]; k < start[row + 1]; ++k) rest -= value[k] * x[static_cast<std::size_t>(column[k])];
        x[row] = rest * inverse_diagonal_[row];
    }
}

void LevelMatrix::subtract(const std::vector<float>& x, std::vector<float>& r) const {
    const std::vector<int>& start = layout_->start;
    const float* const value = value_.data();
    const int* const column = layout_->column.data();
    for (std::size_t row = 0; row < layout_->rows(); ++row) {
        float product = diagonal_[row] * x[row];
        for (int k = start[row]; k < start[row + 1]; ++k) product += value[k] * x[static_cast<std::size_t>(column[k])];
        r[row] -= product;
    }
}

}  // namespace cutterflow::foam
