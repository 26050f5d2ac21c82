#include "meshing/dictionary/foam_steps.hpp"

#include <algorithm>

#include "geometry/base/process/child_process.hpp"
#include "meshing/dictionary/foam_command.hpp"

namespace cutterflow::meshing {

namespace fs = std::filesystem;

void FoamSteps::run(const FoamStep& step) {
    const std::string name = step.program.filename().string();
    if (observer_) observer_(done_ / total_weight_, name);
    const ChildResult result = require_child(foam_command(directory_, step.program.string(), step.arguments, step.ranks));
    wall_s += result.wall_s;
    core_s += result.core_s;
    memory = std::max(memory, step.ranks * result.memory);  // the ranks' shares are alike
    program_core_s.emplace_back(name, result.core_s);
    done_ += step.weight;
}

void move_mesh(const fs::path& mesh_case, const fs::path& run_directory) {
    const fs::path from = mesh_case / "constant" / "polyMesh", target = run_directory / "constant" / "polyMesh";
    fs::remove_all(target);
    fs::create_directories(target);
    for (const char* file : {"boundary", "cellZones", "faces", "neighbour", "owner", "points"})
        if (fs::exists(from / file)) fs::rename(from / file, target / file);  // a mesh without zones has no cellZones
    fs::remove_all(from);
}

}  // namespace cutterflow::meshing
