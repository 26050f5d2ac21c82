#include "solver/free_surface/pressure_system.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::free_surface {

namespace {

constexpr double k_modified = 0.97;        // share of the dropped fill that goes onto the diagonal [Bridson2015]
constexpr double k_smallest_pivot = 0.25;  // of the diagonal, else the diagonal itself
constexpr int k_most_iterations = 2000;

double largest(gsl::span<const double> values) {
    double size = 0.0;
    for (const double value : values) size = std::max(size, std::abs(value));
    return size;
}

double dot(gsl::span<const double> a, gsl::span<const double> b) {
    double sum = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) sum += a[n] * b[n];
    return sum;
}

}  // namespace

PressureSystem::PressureSystem(const StaggeredGrid& grid)
    : grid_(grid), directions_(static_cast<int>(grid.directions().size())), row_(grid.size(), -1) {}

void PressureSystem::assemble(const WaterFraction& water, const CutCells& cells, gsl::span<const Body> bodies, double cell_mass) {
    number_cells(water);
    set_coefficients(water, cells);
    set_bodies(cells, bodies, cell_mass);
    find_enclosed(water, cells);
    factorise();
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
                    if (side > 0) upper_[n][r] = -open;
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

/// Modified incomplete Cholesky factor of level 0 of the water's part and of the bodies' diagonal.
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
            double others = 0.0;
            for (int e = 0; e < directions_; ++e) {
                if (e != d) others += upper_[e][b];
            }
            value -= k_modified * upper_[d][b] * others * factor_[b] * factor_[b];
        }
        if (value < k_smallest_pivot * pivot[r]) value = pivot[r];
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

void PressureSystem::apply(gsl::span<const double> q, gsl::span<double> y) const {
    std::vector<double> padded(q.begin(), q.end());
    padded.push_back(0.0);
    multiply(padded.data(), y);
}

/// \param q  unknowns() long and a 0 behind: the neighbour that is none
void PressureSystem::multiply(const double* q, gsl::span<double> y) const {
    const int count = static_cast<int>(cell_.size());
    for (int r = 0; r < count; ++r) y[r] = diagonal_[r] * q[r];
    for (int d = 0; d < directions_; ++d) {
        const double* upper = upper_[d].data();
        const int *above = above_[d].data(), *below = below_[d].data();
        for (int r = 0; r < count; ++r) y[r] += upper[r] * q[above[r]] + upper[below[r]] * q[below[r]];
    }
    for (const auto& body : bodies_) {
        Vec3 push = Vec3::Zero();
        for (const BodyRow& entry : body.rows) push += entry.k * q[entry.row];
        push *= body.mass_ratio;
        for (const BodyRow& entry : body.rows) y[entry.row] += entry.k.dot(push);
    }
}

void PressureSystem::precondition(gsl::span<const double> residual, gsl::span<double> z) const {
    const int count = static_cast<int>(cell_.size());
    work_.resize(count + 1);
    work_[count] = 0.0;
    double* work = work_.data();
    for (int r = 0; r < count; ++r) {
        double value = residual[r] * factor_[r];
        for (int d = directions_ - 1; d >= 0; --d) value -= factor_below_[d][r] * work[below_[d][r]];
        work[r] = value;
    }
    for (int r = count - 1; r >= 0; --r) {
        double value = work[r] * factor_[r];
        for (int d = directions_ - 1; d >= 0; --d) value -= factor_above_[d][r] * work[above_[d][r]];
        work[r] = value;
    }
    std::copy_n(work, count, z.begin());
}

void PressureSystem::remove_means(gsl::span<double> values) const {
    for (const auto& rows : enclosed_) {
        double sum = 0.0;
        for (const int r : rows) sum += values[r];
        for (const int r : rows) values[r] -= sum / static_cast<double>(rows.size());
    }
}

SolveReport PressureSystem::solve(gsl::span<const double> right_side, double tolerance, gsl::span<double> q) const {
    const std::size_t count = cell_.size();
    residual_.assign(right_side.begin(), right_side.end());
    remove_means(residual_);
    const double scale = largest(residual_);
    SolveReport report;
    if (scale == 0.0) {
        std::fill(q.begin(), q.end(), 0.0);
        return report;
    }
    product_.resize(count);
    direction_.resize(count + 1);
    direction_[count] = 0.0;
    std::vector<double> z(count);
    apply(q, product_);
    for (std::size_t n = 0; n < count; ++n) residual_[n] -= product_[n];
    precondition(residual_, z);
    std::copy(z.begin(), z.end(), direction_.begin());
    double sigma = dot(residual_, z);
    report.residual = largest(residual_) / scale;
    while (report.residual > tolerance && report.iterations < k_most_iterations) {
        multiply(direction_.data(), product_);
        const double step = sigma / dot(product_, direction_);
        for (std::size_t n = 0; n < count; ++n) {
            q[n] += step * direction_[n];
            residual_[n] -= step * product_[n];
        }
        ++report.iterations;
        report.residual = largest(residual_) / scale;
        if (report.residual <= tolerance) break;
        precondition(residual_, z);
        const double next = dot(residual_, z);
        const double share = next / sigma;
        for (std::size_t n = 0; n < count; ++n) direction_[n] = z[n] + share * direction_[n];
        sigma = next;
    }
    remove_means(q);
    report.converged = report.residual <= tolerance;  // false for a residual that is no number, too
    return report;
}

}  // namespace cutterflow::free_surface
