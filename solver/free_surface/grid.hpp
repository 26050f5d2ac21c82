#pragma once
/// \file The staggered grid of the free-surface flow: cubes from the origin on, velocities on faces, one layer of ghosts around.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gsl/span>

#include "geometry/base/vec3.hpp"

namespace cutterflow::free_surface {

using CellField = std::vector<double>;                 ///< one number a cell, StaggeredGrid::size() long
using FaceField = std::array<std::vector<double>, 3>;  ///< one number a face normal to x, y, z, each StaggeredGrid::size() long

/// Cells (i, j, k) of edge h fill the box from the origin. Face i of direction x is the lower one of cell i. Cells and faces of every
/// direction share one indexing, so that the face of a cell in direction d has the cell's own index, and its upper one the index plus
/// stride(d). A plane scene has one cell across, `depth` wide, and no faces normal to y.
class StaggeredGrid {
public:
    /// A plane scene in x and z. \param depth  length across [m]
    static StaggeredGrid plane(int cells_x, int cells_z, double spacing, double depth) {
        return {{cells_x, 1, cells_z}, spacing, depth, true};
    }
    static StaggeredGrid space(int cells_x, int cells_y, int cells_z, double spacing) {
        return {{cells_x, cells_y, cells_z}, spacing, spacing, false};
    }

    bool is_plane() const { return plane_; }
    double spacing() const { return spacing_; }  ///< h [m]
    int cells(int direction) const { return cells_[direction]; }
    /// Width of a cell [m]: h, across a plane scene its depth.
    double width(int direction) const { return direction == 1 ? depth_ : spacing_; }
    double extent(int direction) const { return cells_[direction] * width(direction); }
    double face_area() const { return spacing_ * depth_; }  ///< of x and z faces, and of y faces in space [m2]
    double cell_volume() const { return spacing_ * spacing_ * depth_; }
    /// Directions in which water moves: x and z, or x, y and z.
    gsl::span<const int> directions() const { return plane_ ? gsl::span<const int>(k_plane) : gsl::span<const int>(k_space); }

    std::size_t size() const { return size_; }
    int stride(int direction) const { return stride_[direction]; }
    /// Index of cell (i, j, k) and of its lower faces; -1 and cells() are ghosts.
    int at(int i, int j, int k) const { return origin_ + i + j * stride_[1] + k * stride_[2]; }
    /// Centre of cell (i, j, k) [m].
    Vec3 centre(int i, int j, int k) const { return {(i + 0.5) * spacing_, (j + 0.5) * depth_, (k + 0.5) * spacing_}; }
    /// (i, j, k) of an index.
    std::array<int, 3> place(int index) const {
        const int k = index / stride_[2], rest = index - k * stride_[2];
        const int j = plane_ ? 0 : rest / stride_[1];
        return {rest - j * (plane_ ? 0 : stride_[1]) - 1, plane_ ? 0 : j - 1, k - 1};
    }

    CellField cell_field(double value = 0.0) const { return CellField(size_, value); }
    FaceField face_field(double value = 0.0) const { return {CellField(size_, value), CellField(size_, value), CellField(size_, value)}; }

    /// Calls visit(index, i, j, k) for every cell in storage order.
    template <typename Visit>
    void for_each_cell(const Visit& visit) const {
        for (int k = 0; k < cells_[2]; ++k) {
            for (int j = 0; j < cells_[1]; ++j) {
                int index = at(0, j, k);
                for (int i = 0; i < cells_[0]; ++i, ++index) visit(index, i, j, k);
            }
        }
    }

    /// Calls visit(index, i, j, k) for every face of a direction, those on the tank's walls among them.
    template <typename Visit>
    void for_each_face(int direction, const Visit& visit) const {
        const std::array<int, 3> more{direction == 0, direction == 1, direction == 2};
        for (int k = 0; k < cells_[2] + more[2]; ++k) {
            for (int j = 0; j < cells_[1] + more[1]; ++j) {
                int index = at(0, j, k);
                for (int i = 0; i < cells_[0] + more[0]; ++i, ++index) visit(index, i, j, k);
            }
        }
    }

private:
    StaggeredGrid(std::array<int, 3> cells, double spacing, double depth, bool is_plane)
        : cells_(cells), spacing_(spacing), depth_(depth), plane_(is_plane) {
        const int row = cells[0] + 3, rows = is_plane ? 1 : cells[1] + 3;
        stride_ = {1, row, row * rows};
        size_ = static_cast<std::size_t>(row) * rows * (cells[2] + 3);
        origin_ = 1 + (is_plane ? 0 : row) + stride_[2];
    }

    static constexpr std::array<int, 2> k_plane{0, 2};
    static constexpr std::array<int, 3> k_space{0, 1, 2};

    std::array<int, 3> cells_;
    double spacing_, depth_;
    bool plane_;
    std::array<int, 3> stride_{};
    std::size_t size_ = 0;
    int origin_ = 0;
};

}  // namespace cutterflow::free_surface
