#pragma once
/// \file A study of kind "free_surface": water with a free surface and the solids that it carries, solved by cutterSurface.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// Every key of such a study.
const ParameterTable& surface_study_table();

/// A study that runs as it is: a small water dam with cylinders in it.
std::string surface_study_template(const std::string& name);

/// What a study asks for and what its run will take.
struct SurfaceCheck {
    nlohmann::json scene;  ///< name, width_m, height_m, cell_m, columns, layers, rows, bodies, spheres, diameter_m, pipe {bottom_m, ...} or
                           ///< null, gauges
    nlohmann::json prediction;       ///< cells, water_cells, particles, step_s, steps, core_s, memory_bytes, contact_step_s
    std::vector<std::string> close;  ///< what is closer than two cells
    std::vector<std::string> notes;  ///< rounded sizes, coarse bodies
};

/// \throws UserError  with every mistake of the file, or when the run needs more memory than the machine has
SurfaceCheck check_surface_study(const std::filesystem::path& file);

/// A study with the files that it names, as a run directory has them: side by side.
struct SurfaceInputs {
    std::string study;                                    ///< text that names the copies; that of the file when it names none
    std::map<std::string, std::filesystem::path> copies;  ///< name in the run directory, and the file to copy
};
SurfaceInputs surface_inputs(const std::filesystem::path& study);

/// Values of a study whose files are named by absolute paths.
ParameterValues read_placed_surface_study(const std::filesystem::path& study);

/// \throws UserError  with every mistake of a study given as text
void require_surface_study(const std::string& toml, const std::string& name);

std::string to_text(const SurfaceCheck& check);

}  // namespace cutterflow::cases
