#pragma once
/// \file The folders of a run that are called by a time: the fluid's, and the checkpoints.
#include <filesystem>
#include <vector>

namespace cutterflow {

/// Folders directly in `root` that are called by a time as OpenFOAM writes one, in the order of their times.
std::vector<std::filesystem::path> time_folders(const std::filesystem::path& root);

/// Folders of the ranks of a decomposed case, `processor0` and so on, in no order. \pre the case is a folder
std::vector<std::filesystem::path> processor_folders(const std::filesystem::path& case_folder);

/// Complete checkpoints of a case (`checkpoints/<time>`), the newest last.
std::vector<std::filesystem::path> checkpoint_folders(const std::filesystem::path& case_folder);

/// The newest complete checkpoint, or an empty path.
std::filesystem::path newest_checkpoint(const std::filesystem::path& case_folder);

/// The fluid's time folders (of the case and of its processor folders) that are later than the newest checkpoint: what a killed run wrote
/// after it. Empty without a checkpoint.
std::vector<std::filesystem::path> times_after_checkpoint(const std::filesystem::path& case_folder);

/// Removes times_after_checkpoint. Only for folders that the caller made itself: a run directory, a test's case.
void drop_times_after_checkpoint(const std::filesystem::path& case_folder);

}  // namespace cutterflow
