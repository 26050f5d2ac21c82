#pragma once
/// \file Programs of a mesh stage, one after the other in one folder.
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace cutterflow::meshing {

/// Called before each program with the share of the stage that is done and the program's name.
using MeshObserver = std::function<void(double fraction, const std::string& program)>;

/// One program of a stage.
struct FoamStep {
    std::filesystem::path program;
    std::vector<std::string> arguments;
    double weight;  ///< its usual share of the time, any unit
    int ranks = 1;
};

/// Runs programs, sums their cost and notifies the observer.
class FoamSteps {
public:
    /// \param total_weight  of all steps that will come \param observer  must outlive the object
    FoamSteps(std::filesystem::path directory, double total_weight, const MeshObserver& observer)
        : directory_(std::move(directory)), total_weight_(total_weight), observer_(observer) {}

    /// \throws ToolError  when the program is missing or fails
    void run(const FoamStep& step);

    double wall_s = 0.0, core_s = 0.0;
    double memory = 0.0;  ///< largest resident set of a program [bytes]
    std::vector<std::pair<std::string, double>> program_core_s;

private:
    std::filesystem::path directory_;
    double total_weight_;
    const MeshObserver& observer_;
    double done_ = 0.0;
};

/// Moves the mesh alone, without the other files of snappyHexMesh and topoSet, from constant/polyMesh of one case to that of another.
void move_mesh(const std::filesystem::path& mesh_case, const std::filesystem::path& run_directory);

}  // namespace cutterflow::meshing
