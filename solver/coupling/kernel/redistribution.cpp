#include "solver/coupling/kernel/redistribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cutterflow::coupling {
namespace {

// Overfull cells are brought this much below the limit, so that the passes, which approach it from above, end below it.
constexpr double k_below_limit = 1e-3;
constexpr int k_most_passes = 200;

/// A rock whose weights add up to 1 within this is left alone.
constexpr double k_rounding = 4.0 * std::numeric_limits<double>::epsilon();

/// The rock of one set of stencils in the cells, kept up to date from pass to pass. A pass changes only rock that reaches overfull cells.
class RockInCells {
public:
    RockInCells(Stencils& stencils, gsl::span<const double> rock_volume, gsl::span<const double> cell_volume)
        : stencils_(stencils), rock_volume_(rock_volume), cell_volume_(cell_volume), fraction_(cell_volume.size(), 0.0) {
        deposit(stencils, rock_volume, fraction_);
    }

    double largest() const { return fraction_.empty() ? 0.0 : *std::max_element(fraction_.begin(), fraction_.end()); }
    std::vector<double> take_fraction() { return std::move(fraction_); }

    /// Empties cells down to `target` and lays what they lose over all cells of the same rocks. Collective
    void pass(double target, Communicator& communicator) {
        if (here_.empty()) add_up();
        shrink_overfull(target);
        std::vector<double> sums = here_;
        stencils_.shared.sum(sums, 1, communicator);
        for (const std::size_t p : stencils_.shared.near())
            if (sums[p] > 0.0 && std::abs(sums[p] - 1.0) > k_rounding) enlarge(p, 1.0 / sums[p]);  // 0: rock without cells
    }

private:
    void add_up() {
        here_.assign(stencils_.size(), 0.0);
        for (const std::size_t p : stencils_.shared.near()) here_[p] = sum_of(p);
    }

    /// Sum of w V over a rock's cells on this rank.
    double sum_of(std::size_t rock) const {
        double sum = 0.0;
        for (std::size_t i = stencils_.first[rock]; i < stencils_.first[rock + 1]; ++i)
            sum += stencils_.deposit[i] * cell_volume_[cell_of(i)];
        return sum;
    }

    std::size_t cell_of(std::size_t entry) const { return static_cast<std::size_t>(stencils_.cell[entry]); }

    void shrink_overfull(double target) {
        shrink_.resize(fraction_.size());
        is_overfull_.resize(fraction_.size());
        for (std::size_t c = 0; c < fraction_.size(); ++c) {
            is_overfull_[c] = fraction_[c] > target ? 1 : 0;
            if (is_overfull_[c] == 0) continue;
            shrink_[c] = target / fraction_[c];
            fraction_[c] = target;
        }
        for (const std::size_t p : stencils_.shared.near()) {
            bool changes = false;
            for (std::size_t i = stencils_.first[p]; i < stencils_.first[p + 1]; ++i) {
                const std::size_t c = cell_of(i);
                if (is_overfull_[c] == 0) continue;
                stencils_.deposit[i] *= shrink_[c];
                changes = true;
            }
            if (changes) here_[p] = sum_of(p);
        }
    }

    void enlarge(std::size_t rock, double factor) {
        const double gain_of_rock = (factor - 1.0) * rock_volume_[rock];
        for (std::size_t i = stencils_.first[rock]; i < stencils_.first[rock + 1]; ++i) {
            fraction_[cell_of(i)] += gain_of_rock * stencils_.deposit[i];
            stencils_.deposit[i] *= factor;
        }
        here_[rock] *= factor;
    }

    Stencils& stencils_;
    gsl::span<const double> rock_volume_, cell_volume_;
    std::vector<double> fraction_;  // solid, per cell
    std::vector<double> here_;      // sum of w V over this rank's cells, per rock; empty before the first pass
    // Buffers, per cell. Bytes, as they are read for every entry.
    std::vector<unsigned char> is_overfull_;
    std::vector<double> shrink_;
};

}  // namespace

std::vector<std::vector<double>> redistribute(gsl::span<Stencils* const> stencils, gsl::span<const double> rock_volume,
                                              gsl::span<const double> cell_volume, double limit, Communicator& communicator) {
    std::vector<RockInCells> rock;
    for (Stencils* const s : stencils) rock.emplace_back(*s, rock_volume, cell_volume);
    const auto largest = [&] {
        double value = 0.0;
        for (const RockInCells& r : rock) value = std::max(value, r.largest());
        communicator.max(gsl::span<double>(&value, 1));
        return value;
    };
    const double target = (1.0 - k_below_limit) * limit;
    for (int pass = 0; pass < k_most_passes && largest() > limit; ++pass)
        for (RockInCells& r : rock) r.pass(target, communicator);
    std::vector<std::vector<double>> fractions;
    for (RockInCells& r : rock) fractions.push_back(r.take_fraction());
    return fractions;
}

}  // namespace cutterflow::coupling
