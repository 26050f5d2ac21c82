#pragma once
/// \file The stages of a run directory, each done once: finished ones are skipped, changed inputs redo what follows from them, and neither
/// results nor files that the user changed are ever overwritten.
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cases/runner/manifest.hpp"
#include "cases/runner/run_directory.hpp"

namespace cutterflow::cases {

/// What a stage's work comes back with.
struct StageOutcome {
    std::vector<std::string> outputs;  ///< files that it wrote and that must not be changed by hand, relative to the run directory
    double core_s = 0.0;
};

struct Stage {
    std::string name;
    std::map<std::string, std::string> inputs;  ///< what it depends on besides the stages before it
    /// Files (or folders, with a final '/') of earlier stages that it changes.
    std::vector<std::string> rewrites;
    /// Can be resumed after an interruption, on request; its results are never overwritten.
    bool resumable = false;
    std::function<StageOutcome(bool resume)> work;
    /// Files that it makes again when one of them is gone or empty.
    std::vector<std::string> made_again{};
};

/// What happens to a stage, for the lines that a user reads.
enum class StageEvent { skipped, begins, ends };
using StageObserver = std::function<void(const Stage&, StageEvent, double wall_s)>;

/// Goes through `stages` (all of a run, in order) up to and including `until`. All rules are checked before the first of them begins.
/// \param resume  whether an interrupted resumable stage may continue
/// \throws UserError  when inputs changed and results of a resumable stage exist; when a file that a stage wrote was changed or removed;
/// when
///                    a resumable stage was interrupted and `resume` is false
void run_stages(const RunDirectory& directory, Manifest& manifest, const std::vector<Stage>& stages, const std::string& until, bool resume,
                const StageObserver& observer);

/// Why what stages wrote in another run directory cannot be taken for the stages of this one: one is not finished, has other inputs, or
/// its files are not as it wrote them. Empty when it can.
std::string why_not_shared(const std::filesystem::path& from, const std::vector<Stage>& wanted);

/// Whether all of these stages are finished in a run directory; a folder without a manifest has none.
bool stages_are_done(const std::filesystem::path& run, const std::vector<std::string>& stages);

/// Copies what stages wrote in one run directory into another in which none began yet; nothing while one of them is not finished. Whether
/// they fit is judged there, by their inputs, as for every finished stage.
void share_stages(const std::filesystem::path& from, const std::filesystem::path& to, const std::vector<std::string>& stages);

}  // namespace cutterflow::cases
