#include "solver/free_surface/pressure_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cutterflow::free_surface {

namespace {

constexpr int k_most_iterations = 2000;
constexpr int k_block_cells = 4;  // side of the blocks of cells whose means are solved for directly

using Vector = Eigen::VectorXd;
using VectorView = Eigen::Map<Vector>;
using ConstVectorView = Eigen::Map<const Vector>;

}  // namespace

PressureSystem::PressureSystem(const StaggeredGrid& grid)
    : grid_(grid), directions_(static_cast<int>(grid.directions().size())), row_(grid.size(), -1) {}

void PressureSystem::assemble(const WaterFraction& water, const CutCells& cells, gsl::span<const Body> bodies, double cell_mass) {
    number_cells(water);
    set_coefficients(water, cells);
    set_bodies(cells, bodies, cell_mass);
    find_enclosed(water, cells);
    factorise();
    set_blocks();
}

void PressureSystem::number_cells(const WaterFraction& water) {
    std::fill(row_.begin(), row_.end(), -1);
    cell_ = water.water;
    for (std::size_t r = 0; r < cell_.size(); ++r) row_[cell_[r]] = static_cast<int>(r);
}

void PressureSystem::set_coefficients(const WaterFraction& water, const CutCells& cells) {
    const std::size_t count = cell_.size();
    const int none = static_cast<int>(count);
    diagonal_.assign(count, 0.0);
    for (int n = 0; n < directions_; ++n) {
        const int d = grid_.directions()[n], stride = grid_.stride(d);
        upper_[n].assign(count + 1, 0.0);
        lower_[n].assign(count + 1, 0.0);
        above_[n].assign(count + 1, none);
        below_[n].assign(count + 1, none);
        for (std::size_t r = 0; r < count; ++r) {
            const int cell = cell_[r];
            for (const int side : {-1, 1}) {
                const int neighbour = cell + side * stride;
                const double open = cells.open[d][side > 0 ? neighbour : cell];
                if (open <= 0.0) continue;
                if (water.kind[neighbour] == CellKind::air) {
                    diagonal_[r] += open / surface_distance(water.fraction[cell], water.fraction[neighbour]);
                } else if (water.kind[neighbour] == CellKind::water) {
                    diagonal_[r] += open;
                    (side > 0 ? above_ : below_)[n][r] = row_[neighbour];
                    (side > 0 ? upper_ : lower_)[n][r] = -open;
                }
            }
        }
    }
}

void PressureSystem::set_bodies(const CutCells& cells, gsl::span<const Body> bodies, double cell_mass) {
    bodies_.resize(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        bodies_[b].rows.clear();
        if (bodies[b].held) continue;
        bodies_[b].mass_ratio = cell_mass / bodies[b].mass;
        for (const BodyCell& entry : cells.bodies[b]) {
            if (row_[entry.cell] >= 0) bodies_[b].rows.push_back({row_[entry.cell], entry.k});
        }
    }
}

/// Waters that no air bounds: their sum of k over any free body must be 0 too, else the body gives way.
void PressureSystem::find_enclosed(const WaterFraction& water, const CutCells& cells) {
    enclosed_.clear();
    std::vector<std::uint8_t> seen(cell_.size() + 1, 0);
    std::vector<int> rows;
    for (std::size_t start = 0; start < cell_.size(); ++start) {
        if (seen[start]) continue;
        rows.assign(1, static_cast<int>(start));
        seen[start] = 1;
        bool open_to_air = false;
        for (std::size_t n = 0; n < rows.size(); ++n) {
            const int r = rows[n];
            open_to_air = open_to_air || is_beside_air(grid_, cells, water, cell_[r]);
            for (int d = 0; d < directions_; ++d) {
                for (const int neighbour : {below_[d][r], above_[d][r]}) {
                    if (neighbour == static_cast<int>(cell_.size()) || seen[neighbour]) continue;
                    seen[neighbour] = 1;
                    rows.push_back(neighbour);
                }
            }
        }
        if (open_to_air) continue;
        std::sort(rows.begin(), rows.end());
        const auto gives_way = [&](const BodyPart& body) {
            Vec3 sum = Vec3::Zero();
            for (const BodyRow& entry : body.rows) {
                if (std::binary_search(rows.begin(), rows.end(), entry.row)) sum += entry.k;
            }
            return sum.norm() > 1e-9;
        };
        if (std::none_of(bodies_.begin(), bodies_.end(), gives_way)) enclosed_.push_back(rows);
    }
}

/// Incomplete Cholesky factor of level 0 of the water's part and of the bodies' diagonal.
void PressureSystem::factorise() {
    const std::size_t count = cell_.size();
    std::vector<double> pivot = diagonal_;
    for (const auto& body : bodies_) {
        for (const BodyRow& entry : body.rows) pivot[entry.row] += body.mass_ratio * entry.k.squaredNorm();
    }
    factor_.assign(count + 1, 0.0);
    for (std::size_t r = 0; r < count; ++r) {
        double value = pivot[r];
        for (int d = 0; d < directions_; ++d) {
            const int b = below_[d][r];
            const double coefficient = upper_[d][b] * factor_[b];
            value -= coefficient * coefficient;
        }
        factor_[r] = value > 0.0 ? 1.0 / std::sqrt(value) : 0.0;
    }
    for (int d = 0; d < directions_; ++d) {
        factor_below_[d].resize(count);
        factor_above_[d].resize(count);
        for (std::size_t r = 0; r < count; ++r) {
            const int b = below_[d][r];
            factor_below_[d][r] = upper_[d][b] * factor_[b] * factor_[r];
            factor_above_[d][r] = upper_[d][r] * factor_[r] * factor_[r];
        }
    }
}

void PressureSystem::set_blocks() {
    int count = 0;
    const std::vector<int> block = number_blocks(count);
    blocks_.begin(block, count);
    for (std::size_t r = 0; r < block.size(); ++r) {
        blocks_.add(block[r], block[r], diagonal_[r]);
        for (int d = 0; d < directions_; ++d) {
            if (upper_[d][r] == 0.0) continue;
            const int above = block[above_[d][r]];
            blocks_.add(block[r], above, upper_[d][r]);
            blocks_.add(above, block[r], upper_[d][r]);
        }
    }
    for (const BodyPart& body : bodies_) add_body_to_blocks(body, block);
    blocks_.factorise();
}

/// The block of each row; of every enclosed water one block is left out, for only differences are known there.
std::vector<int> PressureSystem::number_blocks(int& count) const {
    const auto blocks_along = [&](int d) { return (grid_.cells(d) + k_block_cells - 1) / k_block_cells; };
    const auto place_of = [&](int row) {
        const std::array<int, 3> place = grid_.place(cell_[row]);
        return (place[2] / k_block_cells * blocks_along(1) + place[1] / k_block_cells) * blocks_along(0) + place[0] / k_block_cells;
    };
    constexpr int unseen = -1, left_out = -2;
    std::vector<int> number(blocks_along(0) * blocks_along(1) * blocks_along(2), unseen), block(cell_.size());
    for (const auto& rows : enclosed_) number[place_of(rows.front())] = left_out;
    for (std::size_t r = 0; r < block.size(); ++r) {
        int& here = number[place_of(static_cast<int>(r))];
        if (here == unseen) here = count++;
        block[r] = here;
    }
    std::replace(block.begin(), block.end(), left_out, count);
    return block;
}

void PressureSystem::add_body_to_blocks(const BodyPart& body, const std::vector<int>& block) {
    std::vector<BodyRow> sums;  // of k in each block
    for (const BodyRow& entry : body.rows) {
        const int here = block[entry.row];
        const auto same = std::find_if(sums.begin(), sums.end(), [&](const BodyRow& sum) { return sum.row == here; });
        if (same == sums.end()) {
            sums.push_back({here, entry.k});
        } else {
            same->k += entry.k;
        }
    }
    for (const BodyRow& a : sums) {
        for (const BodyRow& b : sums) blocks_.add(a.row, b.row, body.mass_ratio * a.k.dot(b.k));
    }
}

void PressureSystem::apply(gsl::span<const double> q, gsl::span<double> y) const {
    Vector padded(static_cast<Eigen::Index>(q.size()) + 1);
    padded << ConstVectorView(q.data(), static_cast<Eigen::Index>(q.size())), 0.0;
    multiply(padded, y.data());
}

/// \param q  unknowns() long and a 0 behind: the neighbour that is none. Neighbours in x are the rows before and after.
void PressureSystem::multiply(const Vector& q, double* y) const {
    const int count = static_cast<int>(cell_.size());
    const double *diagonal = diagonal_.data(), *along = upper_[0].data();
    for (int r = 0; r < count; ++r) y[r] = diagonal[r] * q.data()[r] + along[r] * q.data()[r + 1];
    for (int r = 1; r < count; ++r) y[r] += along[r - 1] * q.data()[r - 1];
    for (int d = 1; d < directions_; ++d) {
        const double *upper = upper_[d].data(), *lower = lower_[d].data();
        const int *above = above_[d].data(), *below = below_[d].data();
        for (int r = 0; r < count; ++r) y[r] += upper[r] * q.data()[above[r]] + lower[r] * q.data()[below[r]];
    }
    for (const auto& body : bodies_) {
        Vec3 push = Vec3::Zero();
        for (const BodyRow& entry : body.rows) push += entry.k * q.data()[entry.row];
        push *= body.mass_ratio;
        for (const BodyRow& entry : body.rows) y[entry.row] += entry.k.dot(push);
    }
}

/// \param z  unknowns() long and a 0 behind
void PressureSystem::precondition(const Vector& residual, Vector& z) const {
    const int count = static_cast<int>(cell_.size());
    double* value = z.data();
    double last = 0.0;  // of the row before
    for (int r = 0; r < count; ++r) {
        double sum = residual.data()[r] * factor_[r];
        for (int d = directions_ - 1; d > 0; --d) sum -= factor_below_[d][r] * value[below_[d][r]];
        last = sum - factor_below_[0][r] * last;
        value[r] = last;
    }
    last = 0.0;
    for (int r = count - 1; r >= 0; --r) {
        double sum = value[r] * factor_[r];
        for (int d = directions_ - 1; d > 0; --d) sum -= factor_above_[d][r] * value[above_[d][r]];
        last = sum - factor_above_[0][r] * last;
        value[r] = last;
    }
    multiply(z, product_.data());
    blocks_.correct(residual, product_, z);
}

void PressureSystem::remove_means(double* values) const {
    for (const auto& rows : enclosed_) {
        double sum = 0.0;
        for (const int r : rows) sum += values[r];
        for (const int r : rows) values[r] -= sum / static_cast<double>(rows.size());
    }
}

/// Right side less operator times q; the right side without its mean in enclosed waters.
void PressureSystem::set_residual(const Vector& right_side, const Vector& q) const {
    multiply(q, product_.data());
    residual_ = right_side - product_;
}

int PressureSystem::worst_cell() const {
    Eigen::Index worst = 0;
    for (Eigen::Index r = 0; r < residual_.size(); ++r) {
        if (!std::isfinite(residual_[r])) return cell_[r];
        if (std::abs(residual_[r]) > std::abs(residual_[worst])) worst = r;
    }
    return cell_[worst];
}

SolveReport PressureSystem::solve(gsl::span<const double> right_side, double tolerance, gsl::span<double> q) const {
    const auto count = static_cast<Eigen::Index>(cell_.size());
    SolveReport report;
    Vector right = ConstVectorView(right_side.data(), count);
    remove_means(right.data());
    const double scale = count > 0 ? right.lpNorm<Eigen::Infinity>() : 0.0;
    VectorView found(q.data(), count);
    if (scale == 0.0) {
        found.setZero();
        return report;
    }
    product_.resize(count);
    for (Vector* padded : {&solution_, &z_, &direction_}) padded->setZero(count + 1);
    solution_.head(count) = found;
    set_residual(right, solution_);
    product_.setZero();
    blocks_.correct(residual_, product_, solution_);
    set_residual(right, solution_);
    report.residual = residual_.lpNorm<Eigen::Infinity>() / scale;
    double sigma = 1.0;
    bool broken_down = false;  // at the limit of the machine's numbers
    while (report.residual > tolerance && report.iterations < k_most_iterations) {
        precondition(residual_, z_);
        const double next = residual_.dot(z_.head(count));
        direction_ = z_ + (report.iterations > 0 ? next / sigma : 0.0) * direction_;
        sigma = next;
        multiply(direction_, product_.data());
        const double step = sigma / product_.dot(direction_.head(count));
        broken_down = !std::isfinite(step);
        if (broken_down) break;
        solution_ += step * direction_;
        residual_ -= step * product_;
        ++report.iterations;
        report.residual = residual_.lpNorm<Eigen::Infinity>() / scale;
    }
    found = solution_.head(count);
    remove_means(q.data());
    if (!found.allFinite()) report.residual = std::numeric_limits<double>::quiet_NaN();
    report.converged = !broken_down && report.residual <= tolerance;  // false for a residual that is no number, too
    if (!report.converged) report.worst_cell = worst_cell();
    return report;
}

}  // namespace cutterflow::free_surface
