#pragma once
/// \file The turning head as a series in time, and what stands still beside it, that ParaView and VTK open beside the fields and the rock.
#include <filesystem>

namespace cutterflow::postproc {

/// Writes `report/head/head.pvd` and one `head_<time>.vtp` (binary, at most k_most_triangles triangles) for every time at which the run
/// wrote fields or rock: the cutter turned to angle omega t, omega from the last row of loads.csv. A run that wrote neither gets none.
/// Beside them `bank.vtp`, the soil that stands beside the head, where there is some, and `feed.vtp`, the places at which rock came in
/// (points with `id`, `time` and `diameter`), once some has. Both are in the run's frame at all times.
/// \throws UserError  when a surface, the loads or the events cannot be read
void write_head_series(const std::filesystem::path& run_directory);

}  // namespace cutterflow::postproc
