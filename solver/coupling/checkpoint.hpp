#pragma once
/// \file The coupled algorithm's own state in a checkpoint folder, and the folders themselves.
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "solver/coupling/bed_operations.hpp"
#include "solver/coupling/feed/feed_queue.hpp"
#include "solver/coupling/rock_coupling.hpp"
#include "solver/coupling/stop_rules.hpp"
#include "solver/observe/head/fate_tracker.hpp"
#include "solver/observe/head/production_watch.hpp"
#include "solver/observe/velocity/velocity_sets.hpp"
#include "solver/ports/communicator.hpp"

namespace cutterflow::coupling {

/// State of a run besides fluid and DEM. Written and read back bit by bit.
struct RunState {
    double time = 0.0;
    double rotor_angle = 0.0;
    int ranks = 1;  ///< that wrote it
    FeedState feed;
    std::map<int, TrackedRock> rocks;
    BookedExchange booked;
    std::optional<std::vector<AccountEntry>> account;  ///< none in checkpoints of version 0.2.0
    OperationState operations;
    StopState stops;
};

/// state.json of a checkpoint folder. \throws NotWritten
void write_state(const std::filesystem::path& folder, const RunState& state);
/// \throws UserError  when it cannot be read
RunState read_state(const std::filesystem::path& folder);

/// carry.<rank>: the momentum that this rank's cells have yet to receive, with their numbers in the whole mesh.
void write_carry(const std::filesystem::path& folder, int rank, gsl::span<const std::int64_t> cell_ids, gsl::span<const Vec3> carry);
/// The same for the cells of this rank, from the files of all `written_by` ranks of the run that wrote them.
/// \throws UserError  when a file is missing or truncated, or has no entry for one of the cells
std::vector<Vec3> read_carry(const std::filesystem::path& folder, int written_by, gsl::span<const std::int64_t> cell_ids);

/// velocity.sums: what the velocity averages hold so far.
void write_velocity(const std::filesystem::path& folder, const VelocitySets& sets);
/// \throws UserError  when the file is missing or has sums of other points
void read_velocity(const std::filesystem::path& folder, VelocitySets& sets);

/// production.series: the ledger so far, of a run that ends by the interval of its production.
void write_production(const std::filesystem::path& folder, const ProductionWatch& production);
/// \throws UserError  when the file is missing or holds no series
void read_production(const std::filesystem::path& folder, ProductionWatch& production);

/// Removes all but the `keep` newest checkpoints, and what interrupted ones left. \pre no checkpoint is being written
void prune_checkpoints(const std::filesystem::path& case_folder, int keep);

}  // namespace cutterflow::coupling
