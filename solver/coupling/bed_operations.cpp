#include "solver/coupling/bed_operations.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/sphere.hpp"

namespace cutterflow::coupling {

BedOperations::BedOperations(std::vector<OperationSettings> operations) : operations_(std::move(operations)) {
    state_.done.assign(operations_.size(), false);
    state_.extracted.assign(operations_.size(), 0.0);
}

double BedOperations::next_time(double time, double tolerance) const {
    double next = std::numeric_limits<double>::infinity();
    for (const OperationSettings& operation : operations_)
        for (const double at : {operation.begin, operation.kind == OperationKind::extract ? operation.end : operation.begin})
            if (at > time + tolerance) next = std::min(next, at);
    return next;
}

std::vector<std::size_t> BedOperations::due(double time, double tolerance) const {
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < operations_.size(); ++k)
        if (!state_.done[k] && operations_[k].begin <= time + tolerance) numbers.push_back(k);
    return numbers;
}

std::vector<int> BedOperations::take(std::size_t number, double time, double tolerance, const Rocks& rocks, const std::vector<int>& frozen,
                                     const RockAccount& account) {
    const OperationSettings& operation = operations_[number];
    const bool extracts = operation.kind == OperationKind::extract;
    if (!extracts || time + tolerance >= operation.end) state_.done[number] = true;
    std::vector<std::size_t> candidates;
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        if (!is_within(operation.region, rocks.position[p])) continue;
        if (extracts && std::binary_search(frozen.begin(), frozen.end(), rocks.id[p])) continue;
        candidates.push_back(p);
    }
    if (extracts) return extract(number, time, rocks, std::move(candidates), account);
    std::vector<int> ids;
    for (const std::size_t p : candidates) ids.push_back(rocks.id[p]);
    return ids;
}

/// \param candidates  numbers of the rocks that may be taken
std::vector<int> BedOperations::extract(std::size_t number, double time, const Rocks& rocks, std::vector<std::size_t> candidates,
                                        const RockAccount& account) {
    const OperationSettings& operation = operations_[number];
    std::sort(candidates.begin(), candidates.end(),
              [&](std::size_t a, std::size_t b) { return account.order_of(rocks.id[a]) < account.order_of(rocks.id[b]); });
    const double due = operation.rate * (std::min(time, operation.end) - operation.begin);
    double& extracted = state_.extracted[number];
    std::vector<int> ids;
    for (const std::size_t p : candidates) {
        const double mass = sphere_mass(rocks.diameter[p], rocks.density[p]);
        if (extracted + mass > due) break;
        extracted += mass;
        ids.push_back(rocks.id[p]);
    }
    const bool starved = ids.size() == candidates.size() && extracted < due;
    rows_.push_back({time, static_cast<int>(number), due, extracted, static_cast<int>(candidates.size()), starved});
    std::sort(ids.begin(), ids.end());
    return ids;
}

std::vector<ExtractionRow> BedOperations::take_rows() {
    return std::exchange(rows_, {});
}

bool BedOperations::all_done() const {
    return std::all_of(state_.done.begin(), state_.done.end(), [](bool done) { return done; });
}

void BedOperations::restore(const OperationState& state) {
    if (state.done.size() != operations_.size() || state.extracted.size() != operations_.size())
        throw UserError({{names::coupling_properties,
                          fmt::format("there are {} events, the checkpoint is of {}", operations_.size(), state.done.size()),
                          "A resumed run has the events that it began with", "Give the same events, or start anew"}});
    state_ = state;
}

}  // namespace cutterflow::coupling
