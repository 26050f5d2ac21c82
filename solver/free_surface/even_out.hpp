#pragma once
/// \file Keeps the particles evenly spread: a projection of their density that moves positions alone.
#include "solver/free_surface/pressure_system.hpp"

namespace cutterflow::free_surface {

/// Displacement of the faces [m] by which particles spread,
///
///   L psi = kappa e phi h^2,   e = alpha - 1 inside, max(0, alpha - 1) beside air, |e| <= 1/2,   d = -grad psi,   kappa = 1/2
///
/// with L of the pressure at unit time step and density, solids at rest. Particles keep their velocities: as a source of the pressure the
/// same correction feeds energy. [Kugelstadt2019]
class EvenOut {
public:
    /// \param tolerance  of the largest residual over the largest of the right side
    EvenOut(const StaggeredGrid& grid, double tolerance);

    /// Moves particles, each component at most a tenth of a cell.
    SolveReport apply(const CutCells& cells, const SlipWalls& walls, const WaterFraction& water, WaterParticles& particles);

    /// psi of the last step, where the next one begins.
    const CellField& potential() const { return potential_; }
    void begin_with(CellField potential) { potential_ = std::move(potential); }

private:
    void set_right_side(const CutCells& cells, const WaterFraction& water);
    void set_displacement(const CutCells& cells, const WaterFraction& water);

    const StaggeredGrid& grid_;
    double tolerance_;
    PressureSystem system_;
    CellField potential_;
    std::vector<double> right_side_, psi_;
    FaceField displacement_;
    std::vector<FaceValue> values_;
};

/// The change of a cell field across a face between water cells or from water to air (where the field is 0 on the surface), over its
/// distance [1/m]. Calls visit(face, change) for the open faces of water cells of one direction, each once.
template <typename Visit>
void for_each_gradient(const StaggeredGrid& grid, const CutCells& cells, const WaterFraction& water, const CellField& field, int d,
                       const Visit& visit) {
    const int stride = grid.stride(d);
    const double inverse = 1.0 / grid.spacing();
    for (const int cell : water.water) {
        const int below = cell - stride, above = cell + stride;
        if (cells.open[d][cell] > 0.0) {
            if (water.kind[below] == CellKind::water) {
                visit(cell, (field[cell] - field[below]) * inverse);
            } else if (water.kind[below] == CellKind::air) {
                visit(cell, field[cell] * inverse / surface_distance(water.fraction[cell], water.fraction[below]));
            }
        }
        if (cells.open[d][above] > 0.0 && water.kind[above] == CellKind::air) {
            visit(above, -field[cell] * inverse / surface_distance(water.fraction[cell], water.fraction[above]));
        }
    }
}

/// Marks the faces of a direction that hold a wall's or a body's velocity (no open part) and those beyond the tank; the others are `none`.
void mark_held_faces(const StaggeredGrid& grid, const CutCells& cells, int direction, std::vector<FaceValue>& values);

}  // namespace cutterflow::free_surface
