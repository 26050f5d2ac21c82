#pragma once
/// \file The turning head as a series in time that ParaView and VTK open beside the fields and the rock.
#include <filesystem>

namespace cutterflow::postproc {

/// Writes `report/head/head.pvd` and one `head_<time>.vtp` (binary, at most k_most_triangles triangles) for every time at which the run
/// wrote fields or rock: the cutter turned to angle omega t, omega from the last row of loads.csv. A run that wrote neither gets none.
/// \throws UserError  when the cutter's surface or the loads cannot be read
void write_head_series(const std::filesystem::path& run_directory);

}  // namespace cutterflow::postproc
