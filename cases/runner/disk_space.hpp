#pragma once
/// \file Room on the disk for a run directory.
#include <filesystem>
#include <optional>

#include "geometry/base/error.hpp"

namespace cutterflow::cases {

/// Bytes that the disk of a folder, or of the nearest one above it that is there, still takes.
double free_bytes(const std::filesystem::path& folder);

/// What to tell when the disk does not have the bytes that a run is predicted to write.
std::optional<Mistake> missing_space(const std::filesystem::path& folder, double needed);

/// \param needed  bytes that a run is predicted to write \throws UserError  when the disk does not have them
void require_free_bytes(const std::filesystem::path& folder, double needed);

/// Does the disk take nothing more that is worth speaking of?
bool is_disk_full(const std::filesystem::path& folder);

/// Message when work in a run directory ended because its disk is full. \param needed  bytes that the whole run is predicted to write;
/// 0: not known
Mistake full_disk(const std::filesystem::path& folder, double needed);

/// Called where work in a run directory failed: whatever failed first on a full disk, what to do is the same.
/// \throws ToolError  when its disk is full
void refuse_full_disk(const std::filesystem::path& folder);

}  // namespace cutterflow::cases
