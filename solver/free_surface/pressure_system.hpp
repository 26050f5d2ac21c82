#pragma once
/// \file The pressure of water and bodies as one system: operator, incomplete Cholesky factor, conjugate gradients.
#include "solver/free_surface/block_correction.hpp"
#include "solver/free_surface/water_fraction.hpp"

namespace cutterflow::free_surface {

struct SolveReport {
    int iterations = 0;
    double residual = 0.0;  ///< largest over the largest of the right side [-]
    bool converged = true;
    int worst_cell = -1;  ///< of a solution that did not converge: where the residual is largest or no number
};

/// Symmetric system in q = dt p / rho [m2/s] of the water cells, over the face area A and divided by h:
///
///   sum over open faces of a_f/theta_f (q_c - q_neighbour) + sum_b m_h/m_b k_bc . sum_c' k_bc' q_c' = right side,   m_h = rho A h
///
/// with q = 0 in air, a_f the open share of the face, k_bc of cut_cells.hpp. The bodies' part is the transpose of their flux: water and
/// bodies exchange the same work. It is never assembled. [BattyBertailsBridson2007] [NgMinGibou2009]
class PressureSystem {
public:
    explicit PressureSystem(const StaggeredGrid& grid);

    /// \param cell_mass  m_h [kg]; without bodies it has no part
    void assemble(const WaterFraction& water, const CutCells& cells, gsl::span<const Body> bodies, double cell_mass);

    std::size_t unknowns() const { return cell_.size(); }
    int cell(std::size_t row) const { return cell_[row]; }
    int row(int cell) const { return row_[cell]; }  ///< -1 for cells that are not water

    /// y = operator q, both unknowns() long.
    void apply(gsl::span<const double> q, gsl::span<double> y) const;

    /// Preconditioned conjugate gradients from the given q on. Of water without a surface (and no body that gives way) only differences of
    /// pressure are known: the right side loses its mean there, and so does q.
    /// \param tolerance  of the largest residual over the largest of the right side
    SolveReport solve(gsl::span<const double> right_side, double tolerance, gsl::span<double> q) const;

    /// Number of waters that neither touch air nor a body that gives way, in the present assembly.
    int enclosed_waters() const { return static_cast<int>(enclosed_.size()); }

private:
    struct BodyRow {
        int row;
        Vec3 k;  // of cut_cells.hpp
    };
    struct BodyPart {
        double mass_ratio = 0.0;  // m_h / m_b
        std::vector<BodyRow> rows;
    };

    void number_cells(const WaterFraction& water);
    void set_coefficients(const WaterFraction& water, const CutCells& cells);
    void set_bodies(const CutCells& cells, gsl::span<const Body> bodies, double cell_mass);
    void find_enclosed(const WaterFraction& water, const CutCells& cells);
    void factorise();
    void set_blocks();
    std::vector<int> number_blocks(int& count) const;
    void add_body_to_blocks(const BodyPart& body, const std::vector<int>& block);
    void multiply(const Eigen::VectorXd& q, double* y) const;
    void precondition(const Eigen::VectorXd& residual, Eigen::VectorXd& z) const;
    int worst_cell() const;
    void set_residual(const Eigen::VectorXd& right_side, const Eigen::VectorXd& q) const;
    void remove_means(double* values) const;

    const StaggeredGrid& grid_;
    int directions_ = 0;
    std::vector<int> row_;   // of each cell
    std::vector<int> cell_;  // of each row
    std::vector<double> diagonal_;
    std::array<std::vector<double>, 3> upper_, lower_;  // coefficients to the neighbours above and below in each direction, 0: none; <= 0
    std::array<std::vector<int>, 3> above_, below_;     // rows of the neighbours; unknowns(): none
    std::vector<double> factor_;                        // 1/sqrt of the factor's diagonal
    std::array<std::vector<double>, 3> factor_below_, factor_above_;  // the factor's entries beside the diagonal, times factor_ of the row
    std::vector<BodyPart> bodies_;
    std::vector<std::vector<int>> enclosed_;  // rows of each
    BlockCorrection blocks_;
    mutable Eigen::VectorXd solution_, residual_, z_, direction_, product_;
};

}  // namespace cutterflow::free_surface
