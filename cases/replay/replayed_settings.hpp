#pragma once
/// \file Replays of every setting of a sweep.
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cases/replay/replay.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::cases {

/// One setting of a sweep and its replays.
struct ReplayedSetting {
    std::string name;
    ReplayResults results;
};

/// Why a part of a sweep has no answer, or one that is refused.
struct SweepFailure {
    ExitCode code;
    std::string text;
};

struct ReplayedSettings {
    std::vector<ReplayedSetting> settings;  ///< that have an answer, also one that is refused
    std::vector<SweepFailure> failures;
};

/// Replays settings one after the other. One that fails does not stop the others, nor does one whose rock changes the flow too much.
/// \param runs  of each setting, by its name
ReplayedSettings replay_each(
    const std::map<std::string, std::vector<std::filesystem::path>>& runs,
    const std::function<ReplayResults(const std::string& name, const std::vector<std::filesystem::path>& runs)>& replay);

/// \throws UserError, CheckFailure  when all failures are of that kind, else ToolError; nothing without a failure
void require_no_failures(const std::vector<SweepFailure>& failures);

/// One line per setting: spillage with half its 95 % interval, and of a head that is fed all the time the rate of the feed, hold-up, in how
/// many placements it has settled and in how many the head is full, and what was lost. Cost [core s]. Whether coupled runs bear the
/// replays out: 0 when rock changes the flow too much. Empty cells: of a batch, or not known.
std::string replays_csv(const std::vector<ReplayedSetting>& settings);

}  // namespace cutterflow::cases
