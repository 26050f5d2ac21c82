#pragma once
/// \file Which rock the events of a run take, hold and let go, and when.
#include <optional>
#include <vector>

#include "solver/observe/rock_account.hpp"
#include "solver/observe/run_recorder.hpp"
#include "solver/ports/bed_operations.hpp"

namespace cutterflow::coupling {

/// State of the events of a run in a checkpoint, by their numbers.
struct OperationState {
    std::vector<bool> done;
    std::vector<double> extracted;  ///< [kg]
};

class BedOperations {
public:
    BedOperations() = default;
    explicit BedOperations(std::vector<OperationSettings> operations);

    /// Next time [s] at which a step must end; infinity when there is none.
    double next_time(double time, double tolerance) const;
    /// Numbers of the events that act at `time`, in the order of the settings.
    std::vector<std::size_t> due(double time, double tolerance) const;
    OperationKind kind_of(std::size_t number) const { return operations_[number].kind; }
    /// Ids of the rock that event `number` acts on now, sorted. An extraction counts it as extracted, and an event that is over as done.
    /// \pre it is due
    std::vector<int> take(std::size_t number, double time, double tolerance, const Rocks& rocks, const std::vector<int>& frozen,
                          const RockAccount& account);
    /// How the extractions stood at each call of take since this was called last.
    std::vector<ExtractionRow> take_rows();
    bool all_done() const;

    const OperationState& state() const { return state_; }
    /// \throws UserError  when it is of other events
    void restore(const OperationState& state);

private:
    std::vector<int> extract(std::size_t number, double time, const Rocks& rocks, std::vector<std::size_t> candidates,
                             const RockAccount& account);

    std::vector<OperationSettings> operations_;
    OperationState state_;
    std::vector<ExtractionRow> rows_;
};

}  // namespace cutterflow::coupling
