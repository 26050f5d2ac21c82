/// What a step costs on the mesh of a run: flow with its rock, flow alone, and stock pimpleFoam, each on one and on two ranks, with the
/// same time step, schemes and solvers from the same start. Times are wall seconds between the steps' first lines of output; variants take
/// turns, and medians are compared.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/scenes/box_case.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr double k_time_step = 1e-3;  // [s]
constexpr int k_steps = 25;
constexpr int k_settling_steps = 5;  // at the start, not counted
constexpr int k_rounds = 3;

struct Variant {
    std::string name;
    std::string program;
    bool rock;
    int ranks;
};

void set_entry(const fs::path& folder, const std::string& key, const std::string& value) {
    require_child(meshing::foam_command(folder, "foamDictionary", {"-entry", key, "-set", value, "system/controlDict"}));
}

/// The run's rock, all of it at time 0.
void write_feed_at_start(const fs::path& from, const fs::path& to) {
    std::ifstream source(from);
    std::ofstream target(to);
    std::string line;
    std::getline(source, line);
    target << line << '\n';
    while (std::getline(source, line)) {
        const std::size_t id_end = line.find(',');
        target << line.substr(0, id_end) << ",0" << line.substr(line.find(',', id_end + 1)) << '\n';
    }
}

fs::path prepare(const fs::path& run, const Variant& variant) {
    const fs::path folder = scratch_folder(fmt::format("step_cost/{}_{}", variant.name, variant.ranks));
    fs::create_directories(folder);
    for (const char* part : {"0", "constant", "system"}) fs::copy(run / part, folder / part, fs::copy_options::recursive);
    if (variant.rock)
        write_feed_at_start(run / names::rock_feed, folder / names::rock_feed);
    else
        fs::remove(folder / names::coupling_properties);
    set_entry(folder, "adjustTimeStep", "no");
    set_entry(folder, "deltaT", fmt::format("{}", k_time_step));
    set_entry(folder, "endTime", fmt::format("{}", k_steps * k_time_step));
    set_entry(folder, "writeControl", "runTime");
    set_entry(folder, "writeInterval", "1000");
    if (variant.ranks > 1) {
        require_child(meshing::foam_command(
            folder, "foamDictionary", {"-entry", "numberOfSubdomains", "-set", std::to_string(variant.ranks), "system/decomposeParDict"}));
        require_child(meshing::foam_command(
            folder, "foamDictionary",
            {"-entry", "hierarchicalCoeffs/n", "-set", fmt::format("({} 1 1)", variant.ranks), "system/decomposeParDict"}));
        require_child(meshing::foam_command(folder, "decomposePar", {"-force"}));
    }
    return folder;
}

/// What a program leaves behind would be its next start.
void remove_results(const fs::path& folder, int ranks) {
    const std::string end = fmt::format("{:g}", k_steps * k_time_step);
    for (const char* left : {"postProcessing", "checkpoints"}) fs::remove_all(folder / left);
    fs::remove_all(folder / end);
    for (int rank = 0; rank < ranks; ++rank) fs::remove_all(folder / fmt::format("processor{}", rank) / end);
}

/// Wall seconds of the counted steps.
std::vector<double> time_steps(const fs::path& folder, const Variant& variant) {
    using Clock = std::chrono::steady_clock;
    std::vector<Clock::time_point> begins;
    require_child(meshing::foam_command(folder, variant.program, {}, variant.ranks), [&](const std::string& line) {
        if (line.rfind("Time = ", 0) == 0) begins.push_back(Clock::now());
    });
    std::vector<double> seconds;
    for (std::size_t i = k_settling_steps; i + 1 < begins.size(); ++i)
        seconds.push_back(std::chrono::duration<double>(begins[i + 1] - begins[i]).count());
    remove_results(folder, variant.ranks);
    if (seconds.size() + k_settling_steps + 1 != k_steps) throw std::runtime_error(folder.string() + " did not run all its steps");
    return seconds;
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

int measure(const fs::path& run) {
    const std::vector<Variant> variants = {{"rock", cutter_foam(), true, 1},       {"flow", cutter_foam(), false, 1},
                                           {"pimpleFoam", "pimpleFoam", false, 1}, {"rock", cutter_foam(), true, 2},
                                           {"flow", cutter_foam(), false, 2},      {"pimpleFoam", "pimpleFoam", false, 2}};
    std::vector<fs::path> folders;
    for (const Variant& variant : variants) folders.push_back(prepare(run, variant));
    std::vector<std::vector<double>> seconds(variants.size());
    for (int round = 0; round < k_rounds; ++round)
        for (std::size_t i = 0; i < variants.size(); ++i) {
            std::cerr << fmt::format("round {} of {}: {} on {} rank(s)\n", round + 1, k_rounds, variants[i].name, variants[i].ranks);
            const std::vector<double> more = time_steps(folders[i], variants[i]);
            seconds[i].insert(seconds[i].end(), more.begin(), more.end());
        }

    std::map<std::pair<std::string, int>, double> step;
    fmt::print("| program | ranks | wall s per step (median of {}) | fastest | slowest |\n|---|---|---|---|---|\n", seconds[0].size());
    for (std::size_t i = 0; i < variants.size(); ++i) {
        step[{variants[i].name, variants[i].ranks}] = median(seconds[i]);
        const auto [fastest, slowest] = std::minmax_element(seconds[i].begin(), seconds[i].end());
        fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.3f} |\n", variants[i].name, variants[i].ranks, median(seconds[i]), *fastest, *slowest);
    }
    fmt::print("\nrock / flow: {:.2f} on one rank, {:.2f} on two\n", step[{"rock", 1}] / step[{"flow", 1}],
               step[{"rock", 2}] / step[{"flow", 2}]);
    fmt::print("flow / pimpleFoam: {:.2f} on one rank, {:.2f} on two\n", step[{"flow", 1}] / step[{"pimpleFoam", 1}],
               step[{"flow", 2}] / step[{"pimpleFoam", 2}]);
    for (const char* name : {"rock", "flow", "pimpleFoam"})
        fmt::print("parallel efficiency on two ranks, {}: {:.2f}\n", name, step[{name, 1}] / (2.0 * step[{name, 2}]));
    return 0;
}

}  // namespace
}  // namespace cutterflow::validation

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: step_cost RUN_DIRECTORY\n\nRUN_DIRECTORY is of a run with rock (cutterflow run); it is not changed.\n";
        return 2;
    }
    try {
        return cutterflow::validation::measure(argv[1]);
    } catch (const cutterflow::ToolError& error) {
        std::cerr << "step_cost: " << error.what() << '\n';
        return 3;
    } catch (const std::exception& error) {
        std::cerr << "step_cost: " << error.what() << '\n';
        return 1;
    }
}
