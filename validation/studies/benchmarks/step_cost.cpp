/// What a step costs on the mesh of a run: flow with its rock, flow alone, and stock pimpleFoam, each on one and on two ranks, with the
/// same time step, schemes and tolerances from the same start. Linear solvers are the case's; pimpleFoam takes OpenFOAM's where cutterFoam
/// takes its own. The unit is the processor second, user and system, of all ranks between the steps' first lines of output. Variants take
/// turns; the least of the rounds counts.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/studies/benchmarks/descendants.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr double k_time_step = 1e-3;  // [s]
constexpr int k_steps = 25;
constexpr int k_settling_steps = 5;  // at the start, not counted
constexpr int k_least_rounds = 3;

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

/// Core seconds of all ranks per counted step, mean of one run.
double time_steps(const fs::path& folder, const Variant& variant) {
    std::vector<double> begins;
    require_child(meshing::foam_command(folder, variant.program, {}, variant.ranks), [&](const std::string& line) {
        if (line.rfind("Time = ", 0) == 0) begins.push_back(core_seconds(descendants()));
    });
    remove_results(folder, variant.ranks);
    if (begins.size() != k_steps) throw std::runtime_error(folder.string() + " did not run all its steps");
    return (begins.back() - begins[k_settling_steps]) / (k_steps - 1 - k_settling_steps);
}

/// Least of the rounds, and by how much the largest lies above it.
std::string least_and_spread(const std::vector<double>& rounds) {
    const auto [least, most] = std::minmax_element(rounds.begin(), rounds.end());
    return fmt::format("{:.3f} (+{:.1f} %)", *least, 100.0 * (*most / *least - 1.0));
}

/// Ratio of the least of all rounds, and the least and largest ratio within a round.
std::string ratio(const std::vector<double>& of, const std::vector<double>& to) {
    std::vector<double> each;
    for (std::size_t round = 0; round < of.size(); ++round) each.push_back(of[round] / to[round]);
    const auto [least, most] = std::minmax_element(each.begin(), each.end());
    return fmt::format("{:.3f} [{:.3f}, {:.3f}]", *std::min_element(of.begin(), of.end()) / *std::min_element(to.begin(), to.end()), *least,
                       *most);
}

int measure(const fs::path& run, int rounds) {
    const std::vector<Variant> variants = {{"rock", cutter_foam(), true, 1},       {"flow", cutter_foam(), false, 1},
                                           {"pimpleFoam", "pimpleFoam", false, 1}, {"rock", cutter_foam(), true, 2},
                                           {"flow", cutter_foam(), false, 2},      {"pimpleFoam", "pimpleFoam", false, 2}};
    std::vector<fs::path> folders;
    for (const Variant& variant : variants) folders.push_back(prepare(run, variant));
    std::map<std::pair<std::string, int>, std::vector<double>> seconds;
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < variants.size(); ++i) {
            const Variant& variant = variants[i];
            std::cerr << fmt::format("round {} of {}: {} on {} rank(s)\n", round + 1, rounds, variant.name, variant.ranks);
            seconds[{variant.name, variant.ranks}].push_back(time_steps(folders[i], variant));
        }

    fmt::print("{} rounds of {} steps of {:g} s each; core seconds of all ranks, user and system.\n\n", rounds,
               k_steps - 1 - k_settling_steps, k_time_step);
    fmt::print("| program | ranks | core s per step, least of the rounds (largest above it) |\n|---|---|---|\n");
    for (const Variant& variant : variants)
        fmt::print("| {} | {} | {} |\n", variant.name, variant.ranks, least_and_spread(seconds[{variant.name, variant.ranks}]));
    fmt::print("\n| ratio of core seconds | one rank [range of the rounds] | two ranks |\n|---|---|---|\n");
    for (const auto& [of, to] : {std::pair("flow", "pimpleFoam"), std::pair("rock", "pimpleFoam"), std::pair("rock", "flow")})
        fmt::print("| {} / {} | {} | {} |\n", of, to, ratio(seconds[{of, 1}], seconds[{to, 1}]), ratio(seconds[{of, 2}], seconds[{to, 2}]));
    return 0;
}

}  // namespace
}  // namespace cutterflow::validation

int main(int argc, char** argv) {
    using namespace cutterflow;
    const int rounds = argc == 3 ? std::atoi(argv[2]) : validation::k_least_rounds;
    if (argc < 2 || argc > 3 || rounds < validation::k_least_rounds) {
        std::cerr << fmt::format(
            "usage: step_cost RUN_DIRECTORY [ROUNDS]\n\nRUN_DIRECTORY is of a run with rock (cutterflow run); it is not changed. "
            "ROUNDS is {} or more.\n",
            validation::k_least_rounds);
        return 2;
    }
    try {
        return validation::measure(argv[1], rounds);
    } catch (const ToolError& error) {
        std::cerr << "step_cost: " << error.what() << '\n';
        return 3;
    } catch (const std::exception& error) {
        std::cerr << "step_cost: " << error.what() << '\n';
        return 1;
    }
}
