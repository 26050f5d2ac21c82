#include "solver/observe/rock_account.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"

namespace cutterflow::coupling {
namespace {

[[noreturn]] void fail(const std::string& what) {
    throw CheckFailure({"", what, "Every rock that came in is in the run, was taken out or left", "Report this as a defect"});
}

bool is_before(const AccountEntry& entry, int id) {
    return entry.id < id;
}

double mass_of(const Rocks& rocks, std::size_t p) {
    return sphere_mass(rocks.diameter[p], rocks.density[p]);
}

}  // namespace

void RockAccount::place(const Rocks& rocks, gsl::span<const std::size_t> which) {
    const auto before = static_cast<std::ptrdiff_t>(entries_.size());
    for (const std::size_t p : which)
        entries_.push_back({rocks.id[p], mass_of(rocks, p), static_cast<int>(entries_.size()), Whereabouts::in_run});
    const auto by_id = [](const AccountEntry& a, const AccountEntry& b) { return a.id < b.id; };
    std::sort(entries_.begin() + before, entries_.end(), by_id);
    std::inplace_merge(entries_.begin(), entries_.begin() + before, entries_.end(), by_id);
    const auto twice =
        std::adjacent_find(entries_.begin(), entries_.end(), [](const AccountEntry& a, const AccountEntry& b) { return a.id == b.id; });
    if (twice != entries_.end()) fail(fmt::format("a second rock with the id {} came in", twice->id));
}

void RockAccount::take_out(int id, Whereabouts to) {
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), id, is_before);
    if (at == entries_.end() || at->id != id || at->where != Whereabouts::in_run)
        fail(fmt::format("rock {} goes out, but is not in the run", id));
    at->where = to;
}

void RockAccount::require(const Rocks& present, double time) const {
    std::size_t p = 0;
    for (const AccountEntry& entry : entries_) {
        if (entry.where != Whereabouts::in_run) continue;
        if (p == present.size() || present.id[p] > entry.id)
            fail(fmt::format("rock {} of {:.6g} kg is missing at time {:.9g} s", entry.id, entry.mass, time));
        if (present.id[p] < entry.id) break;
        if (mass_of(present, p) != entry.mass)
            fail(fmt::format("rock {} has {:.17g} kg at time {:.9g} s, it came in with {:.17g} kg", entry.id, mass_of(present, p), time,
                             entry.mass));
        ++p;
    }
    if (p < present.size()) fail(fmt::format("rock {} is in the run at time {:.9g} s, but should not be", present.id[p], time));
}

int RockAccount::order_of(int id) const {
    return std::lower_bound(entries_.begin(), entries_.end(), id, is_before)->order;
}

AccountTotals RockAccount::totals() const {
    AccountTotals totals;
    for (const AccountEntry& entry : entries_) {
        ++totals.count[static_cast<std::size_t>(entry.where)];
        totals.mass[static_cast<std::size_t>(entry.where)] += entry.mass;
    }
    return totals;
}

}  // namespace cutterflow::coupling
