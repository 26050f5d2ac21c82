#pragma once
/// \file The work of rock on walls in a checkpoint.
#include <filesystem>
#include <vector>

#include "solver/ports/dem_engine.hpp"

namespace cutterflow::liggghts {

/// wall_work.json of a checkpoint folder. \throws NotWritten
void write_wall_work(const std::filesystem::path& folder, const std::vector<coupling::WallWork>& works);

/// Takes what a checkpoint has for the walls of the same names and numbers of triangles. Others, and all in a checkpoint of before there
/// was the file, begin at 0 and count from `time` [s] on. \throws UserError  when the file is damaged
void read_wall_work(const std::filesystem::path& folder, double time, std::vector<coupling::WallWork>& works);

}  // namespace cutterflow::liggghts
