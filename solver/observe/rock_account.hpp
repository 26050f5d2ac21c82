#pragma once
/// \file Account of all rock that came into a run, by id: where each is, and that none is lost, doubled or changed.
#include <array>
#include <string>
#include <vector>

#include <gsl/span>

#include "solver/ports/dem_engine.hpp"

namespace cutterflow::coupling {

/// Where a rock is that came into the run.
enum class Whereabouts { in_run, removed, extracted, left_domain, decided };
inline constexpr std::array<const char*, 5> k_whereabouts{"in_run", "removed", "extracted", "left_domain", "decided"};

struct AccountEntry {
    int id = 0;
    double mass = 0.0;  ///< [kg]
    int order = 0;      ///< in which it came in
    Whereabouts where = Whereabouts::in_run;
};

struct AccountTotals {
    std::array<int, k_whereabouts.size()> count{};    ///< by Whereabouts
    std::array<double, k_whereabouts.size()> mass{};  ///< [kg]
};

/// placed = in the run + removed + extracted + left through the domain's boundary + taken out after its fate was decided, by id.
class RockAccount {
public:
    /// These rocks of the DEM came in, in this order. \throws CheckFailure  when there was one of that id
    void place(const Rocks& rocks, gsl::span<const std::size_t> which);
    /// \throws CheckFailure  when it is not in the run
    void take_out(int id, Whereabouts to);
    /// Compares with the rocks of the DEM. \throws CheckFailure  that names the first rock that is missing, is there although it was never
    /// placed or is gone, or whose mass is another than when it was placed
    void require(const Rocks& present, double time) const;

    /// The number of rocks that came in before it. \pre it is known
    int order_of(int id) const;
    AccountTotals totals() const;
    const std::vector<AccountEntry>& entries() const { return entries_; }  ///< sorted by id
    void restore(std::vector<AccountEntry> entries) { entries_ = std::move(entries); }

private:
    std::vector<AccountEntry> entries_;
};

}  // namespace cutterflow::coupling
