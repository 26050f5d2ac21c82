/// \file propeller_study: forces on the propeller of OpenFOAM's tutorial incompressible/pimpleFoam/RAS/propeller (526,000 cells), by
/// cutterFoam and by pimpleFoam. Prints the last row of the function object `forces` of both.
///
///     propeller_study <tutorials> <folder> [<steps>]
///
/// The mesh is made once in <folder>/mesh; a program whose run is complete is not run again.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/scenes/box_case.hpp"

namespace {

using namespace cutterflow;
namespace fs = std::filesystem;

constexpr double k_time_step = 1e-5;  // [s], as the tutorial begins with

void replace_in(const fs::path& file, const std::string& pattern, const std::string& text) {
    const std::string content = std::regex_replace(read_file(file), std::regex(pattern), text);
    std::ofstream(file, std::ios::binary) << content;
}

/// The tutorial's Allrun.pre. Its cell zone is called as cutterFoam's rotor; both programs run on the same mesh.
void make_mesh(const fs::path& tutorials, const fs::path& mesh) {
    if (fs::exists(mesh / "done")) return;
    if (fs::exists(mesh)) throw UserError(mesh.string() + " is not complete", "The mesh is made in one go", "Move the folder away");
    fs::create_directories(mesh.parent_path());
    fs::copy(tutorials / "incompressible/pimpleFoam/RAS/propeller", mesh, fs::copy_options::recursive);
    fs::copy(tutorials / "resources/geometry/propellerTip.obj.gz", mesh / "constant/triSurface");
    const std::vector<std::vector<std::string>> stages = {{"blockMesh"},
                                                          {"surfaceFeatureExtract"},
                                                          {"snappyHexMesh", "-overwrite"},
                                                          {"renumberMesh", "-overwrite"},
                                                          {"topoSet", "-dict", "system/createInletOutletSets.topoSetDict"},
                                                          {"createPatch", "-overwrite"}};
    for (const auto& stage : stages) {
        fmt::print("{}\n", stage.front());
        std::fflush(stdout);
        validation::run_in_case(mesh, stage);
        if (stage.front() == "renumberMesh") fs::remove_all(mesh / "0");
    }
    replace_in(mesh / "constant/polyMesh/cellZones", "innerCylinderSmall", "rotor");
    replace_in(mesh / "constant/dynamicMeshDict", "innerCylinderSmall", "rotor");
    std::ofstream(mesh / "done") << '\n';
}

/// Fixed steps, and loops that converge, so that both programs solve the same equations; of the function objects, `forces` alone.
void prepare(const fs::path& mesh, const fs::path& folder, int steps) {
    fs::create_directories(folder);
    for (const char* part : {"system", "constant"}) fs::copy(mesh / part, folder / part, fs::copy_options::recursive);
    fs::copy(mesh / "0.orig", folder / "0", fs::copy_options::recursive);
    replace_in(folder / "system/controlDict", " *#include(Func Q| \"surfaces\"| \"AMIWeights\")\n", "");
    std::ofstream(folder / "system/controlDict", std::ios::app)
        << fmt::format("endTime {}; deltaT {}; adjustTimeStep no; writeControl timeStep; writeInterval 1000000; runTimeModifiable no;\n",
                       steps * k_time_step, k_time_step);
    std::ofstream(folder / "system/fvSolution", std::ios::app) << "PIMPLE { nOuterCorrectors 6; nCorrectors 2; }\n";
}

/// Time, total, pressure and viscous force of the last step; empty when there is none.
std::vector<double> last_forces(const fs::path& folder) {
    std::ifstream stream(folder / "postProcessing/forces/0/force.dat");
    std::string last;
    for (std::string line; std::getline(stream, line);) last = line;
    for (char& c : last)
        if (c == '(' || c == ')') c = ' ';
    std::istringstream numbers(last);
    std::vector<double> row;
    for (double value; numbers >> value;) row.push_back(value);
    return row;
}

std::vector<double> forces_of(const std::string& program, const fs::path& mesh, const fs::path& folder, int steps) {
    const auto complete = [&](const std::vector<double>& row) {
        return row.size() == 10 && std::abs(row[0] - steps * k_time_step) < 0.1 * k_time_step;
    };
    std::vector<double> row = last_forces(folder);
    if (complete(row)) return row;
    if (fs::exists(folder)) throw UserError(folder.string() + " holds another run", "A run has a folder of its own", "Move it away");
    prepare(mesh, folder, steps);
    fmt::print("{}\n", program);
    std::fflush(stdout);
    const ChildResult result = require_child(meshing::foam_command(folder, program));
    fmt::print("    {:.0f} core seconds for each of {} steps\n", result.core_s / steps, steps);
    row = last_forces(folder);
    if (!complete(row))
        throw ToolError({folder.string(), "no forces of the last step", "Each step writes its forces", "Read the log there"});
    return row;
}

void print_table(const std::vector<double>& ours, const std::vector<double>& theirs) {
    fmt::print("\n| force per density [m4/s2] at {:g} s | pimpleFoam | cutterFoam | apart |\n|---|---|---|---|\n", theirs[0]);
    const char* const parts[] = {"total", "pressure", "viscous"};
    for (int part = 0; part < 3; ++part) {
        const std::size_t along_shaft = 1 + 3 * static_cast<std::size_t>(part) + 1;  // y
        const double expected = theirs[along_shaft], value = ours[along_shaft];
        fmt::print("| {}, along the shaft | {:.6g} | {:.6g} | {:.2g} % |\n", parts[part], expected, value,
                   100.0 * std::abs(value / expected - 1.0));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3 || argc > 4) {
        fmt::print(stderr, "usage: propeller_study <OpenFOAM's tutorials> <folder> [<steps>, 5]\n");
        return static_cast<int>(ExitCode::user_input);
    }
    try {
        const fs::path folder = fs::absolute(argv[2]);
        const int steps = argc == 4 ? std::stoi(argv[3]) : 5;
        make_mesh(fs::absolute(argv[1]), folder / "mesh");
        const auto ours = forces_of(validation::cutter_foam(), folder / "mesh", folder / "cutterFoam", steps);
        print_table(ours, forces_of("pimpleFoam", folder / "mesh", folder / "pimpleFoam", steps));
    } catch (const Failure& failure) {
        fmt::print(stderr, "propeller_study: {}\n", failure.what());
        return static_cast<int>(failure.code());
    }
    return 0;
}
