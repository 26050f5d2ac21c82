#pragma once
/// \file The files of postProcessing/velocity (docs/design/001-contracts.md).
#include <filesystem>

#include "solver/observe/velocity/velocity_sets.hpp"

namespace cutterflow::coupling {

/// Writes `<set>.csv` of every set into a folder that exists, and `<set>_revolutions.csv` and `<set>_phases.csv` of the sets with phases.
/// Each file is replaced atomically.
/// \param time  up to which the averages go [s]
/// \throws NotWritten
void write_velocity_tables(const std::filesystem::path& folder, const VelocitySets& sets, double time);

}  // namespace cutterflow::coupling
