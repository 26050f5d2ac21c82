#include "solver/free_surface/even_out.hpp"

#include <algorithm>

namespace cutterflow::free_surface {

namespace {

constexpr double k_strength = 0.5;        // kappa: from 0.1 to 1 volumes differ by 0.15 %
constexpr double k_largest_excess = 0.5;  // |e|
constexpr double k_largest_way = 0.1;     // of a cell

}  // namespace

EvenOut::EvenOut(const StaggeredGrid& grid, double tolerance)
    : grid_(grid),
      tolerance_(tolerance),
      system_(grid),
      potential_(grid.cell_field()),
      displacement_(grid.face_field()),
      values_(grid.size()) {}

SolveReport EvenOut::apply(const CutCells& cells, const SlipWalls& walls, const WaterFraction& water, WaterParticles& particles) {
    system_.assemble(water, cells, {}, 0.0);
    set_right_side(cells, water);
    psi_.resize(system_.unknowns());
    for (std::size_t r = 0; r < psi_.size(); ++r) psi_[r] = potential_[system_.cell(r)];
    const SolveReport report = system_.solve(right_side_, tolerance_, psi_);
    std::fill(potential_.begin(), potential_.end(), 0.0);
    for (std::size_t r = 0; r < psi_.size(); ++r) potential_[system_.cell(r)] = psi_[r];
    set_displacement(cells, water);
    displace_particles(grid_, walls, displacement_, k_largest_way * grid_.spacing(), particles);
    return report;
}

void EvenOut::set_right_side(const CutCells& cells, const WaterFraction& water) {
    const double scale = k_strength * grid_.spacing() * grid_.spacing();
    right_side_.resize(system_.unknowns());
    for (std::size_t r = 0; r < right_side_.size(); ++r) {
        const int cell = system_.cell(r);
        double excess = std::clamp(water.fraction[cell] - 1.0, -k_largest_excess, k_largest_excess);
        if (excess < 0.0 && is_beside_air(grid_, cells, water, cell)) excess = 0.0;
        right_side_[r] = scale * excess * cells.open_volume[cell];
    }
}

void EvenOut::set_displacement(const CutCells& cells, const WaterFraction& water) {
    std::vector<int> front;
    for (const int d : grid_.directions()) {
        std::fill(displacement_[d].begin(), displacement_[d].end(), 0.0);
        mark_held_faces(grid_, cells, d, values_);
        front.clear();
        for_each_gradient(grid_, cells, water, potential_, d, [&](int face, double change) {
            displacement_[d][face] = -change;
            values_[face] = FaceValue::present;
            front.push_back(face);
        });
        extrapolate(grid_, 1, values_, front, {&displacement_[d]});
    }
    mirror_faces(grid_, displacement_);
}

void mark_held_faces(const StaggeredGrid& grid, const CutCells& cells, int direction, std::vector<FaceValue>& values) {
    std::fill(values.begin(), values.end(), FaceValue::held);
    grid.for_each_face(direction, [&](int face, int, int, int) {
        if (cells.open[direction][face] > 0.0) values[face] = FaceValue::none;
    });
}

}  // namespace cutterflow::free_surface
