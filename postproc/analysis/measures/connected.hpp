#pragma once
/// \file Cells of a grid that are connected to one of them.
#include <cstddef>
#include <utility>
#include <vector>

namespace cutterflow::postproc {

/// Marks the cells (row by row) that `inside` marks and that are connected to `seed` through sides of such cells.
/// \return as long as `inside`; nothing is marked when the seed is not inside
inline std::vector<bool> connected_to(const std::vector<bool>& inside, int columns, int rows, std::size_t seed) {
    std::vector<bool> marked(inside.size(), false);
    std::vector<std::size_t> open;
    const auto visit = [&](std::size_t cell) {
        if (!inside[cell] || marked[cell]) return;
        marked[cell] = true;
        open.push_back(cell);
    };
    visit(seed);
    while (!open.empty()) {
        const std::size_t cell = open.back();
        open.pop_back();
        const int i = static_cast<int>(cell % columns), j = static_cast<int>(cell / columns);
        if (i > 0) visit(cell - 1);
        if (i + 1 < columns) visit(cell + 1);
        if (j > 0) visit(cell - columns);
        if (j + 1 < rows) visit(cell + columns);
    }
    return marked;
}

}  // namespace cutterflow::postproc
