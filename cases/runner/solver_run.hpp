#pragma once
/// \file cutterFoam on the ranks of a run: decomposition of its case, at its start and when it resumes on another number of them.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "geometry/base/process/child_process.hpp"

namespace cutterflow::cases {

/// Writes system/decomposeParDict and decomposes the present case. \return core seconds
double decompose(const std::filesystem::path& run_directory, int ranks);

/// Brings a case to where cutterFoam starts: its newest checkpoint, without what a killed run wrote after it, or its beginning, without
/// what is left of an earlier run; on `ranks` ranks. \param ranks  none: the case has no fields \param say  is told of a checkpoint
/// \return core seconds \throws as move_checkpoint_to_ranks
double bring_to_start(const std::filesystem::path& run_directory, const std::optional<int>& ranks,
                      const std::function<void(const std::string&)>& say);

struct RankChange {
    int from = 0;         ///< ranks on which the checkpoint's fields were found
    double core_s = 0.0;  ///< 0 when nothing had to be done
};

/// Brings the fields of the newest checkpoint to `ranks` ranks, by way of the undecomposed case (reconstructPar, decomposePar), which then
/// has all times of the processor folders. It can be repeated after any interruption: processor folders are removed only when the
/// whole case holds what they did.
/// \pre there is a checkpoint
/// \throws UserError  when the fields of the checkpoint are nowhere \throws ToolError  when a program failed
RankChange move_checkpoint_to_ranks(const std::filesystem::path& run_directory, int ranks);

/// Runs one of the project's solvers to its end.
/// \param each_line  gets each line of its log \return core seconds
/// \throws CheckFailure  when one of its checks failed \throws UserError  when it refused a file \throws ToolError  when it failed
/// otherwise \throws Interrupted  when it, or this program, was asked to stop
double run_own_solver(const ChildCommand& command, const std::function<void(const std::string&)>& each_line = {});

/// Runs cutterFoam to its end; older logs are kept as `<log>.<n>`. When the user stops the command it writes a checkpoint and ends.
/// \param each_line  gets each line of its log \return core seconds
/// \throws as run_own_solver
double run_solver(const std::filesystem::path& run_directory, const std::filesystem::path& solver, int ranks,
                  const std::function<void(const std::string&)>& each_line);

}  // namespace cutterflow::cases
