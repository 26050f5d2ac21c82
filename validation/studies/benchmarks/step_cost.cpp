/// What a step costs on the mesh of a run: flow with its rock, flow alone, and stock pimpleFoam, each on one and on two ranks, with the
/// same time step, schemes and tolerances from the same start. Linear solvers are the case's, and pimpleFoam takes OpenFOAM's where
/// cutterFoam takes its own; cutterFoam's variants "gamg" take OpenFOAM's as well. The unit is the processor second, user and system,
/// of all ranks between the steps' first lines of output. Variants take turns; the least of the rounds counts. Memory is the sum of the
/// processes' largest resident sets.
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

constexpr double k_megabyte = 1048576.0;

struct Variant {
    std::string name;
    std::string program;
    bool rock;
    bool own_multigrid;
    int ranks;
};

/// What one variant used, a value per round.
struct Usage {
    std::vector<double> core_s;  ///< per step, of all ranks [s]
    std::vector<double> memory;  ///< of all processes at once [bytes]
};

std::string label(const Variant& variant) {
    return fmt::format("{}_{}", variant.name, variant.ranks);
}

void set_entry(const fs::path& folder, const std::string& key, const std::string& value) {
    require_child(meshing::foam_command(folder, "foamDictionary", {"-entry", key, "-set", value, "system/controlDict"}));
}

/// OpenFOAM's multigrid for the pressure, as stock programs take it from the same dictionary.
void use_stock_multigrid(const fs::path& folder) {
    for (const char* equation : {"p", "pFinal"})
        require_child(meshing::foam_command(
            folder, "foamDictionary",
            {"-entry", fmt::format("solvers/{}/cutterFoamPreconditioner", equation), "-remove", "system/fvSolution"}));
}

std::size_t rocks_of(const fs::path& feed) {
    std::ifstream file(feed);
    const auto lines = std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n');
    return static_cast<std::size_t>(lines) - 1;  // below the line of names
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
    const fs::path folder = scratch_folder("step_cost/" + label(variant));
    fs::create_directories(folder);
    for (const char* part : {"0", "constant", "system"}) fs::copy(run / part, folder / part, fs::copy_options::recursive);
    if (variant.rock)
        write_feed_at_start(run / names::rock_feed, folder / names::rock_feed);
    else
        fs::remove(folder / names::coupling_properties);
    if (variant.program == cutter_foam() && !variant.own_multigrid) use_stock_multigrid(folder);
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

/// One run: core seconds are the mean of the counted steps, memory is that at the begin of the last one.
void run_once(const fs::path& folder, const Variant& variant, Usage& usage) {
    std::vector<double> begins;
    double memory = 0.0;
    require_child(meshing::foam_command(folder, variant.program, {}, variant.ranks), [&](const std::string& line) {
        if (line.rfind("Time = ", 0) != 0) return;
        const std::vector<Descendant> processes = descendants();
        begins.push_back(core_seconds(processes));
        memory = 0.0;
        for (const Descendant& process : processes) memory += process.peak_memory;
    });
    remove_results(folder, variant.ranks);
    if (begins.size() != k_steps) throw std::runtime_error(folder.string() + " did not run all its steps");
    usage.core_s.push_back((begins.back() - begins[k_settling_steps]) / (k_steps - 1 - k_settling_steps));
    usage.memory.push_back(memory);
}

double least(const std::vector<double>& rounds) {
    return *std::min_element(rounds.begin(), rounds.end());
}

/// Least of the rounds, and by how much the largest lies above it.
std::string least_and_spread(const std::vector<double>& rounds) {
    const double most = *std::max_element(rounds.begin(), rounds.end());
    return fmt::format("{:.3f} (+{:.1f} %)", least(rounds), 100.0 * (most / least(rounds) - 1.0));
}

/// Ratio of the least of all rounds, and the least and largest ratio within a round.
std::string ratio(const std::vector<double>& of, const std::vector<double>& to) {
    std::vector<double> each;
    for (std::size_t round = 0; round < of.size(); ++round) each.push_back(of[round] / to[round]);
    return fmt::format("{:.3f} [{:.3f}, {:.3f}]", least(of) / least(to), least(each), *std::max_element(each.begin(), each.end()));
}

void print_costs(const std::vector<Variant>& variants, const std::map<std::string, Usage>& usage, int rounds) {
    fmt::print("{} rounds of {} steps of {:g} s each; core seconds of all ranks, user and system.\n\n", rounds,
               k_steps - 1 - k_settling_steps, k_time_step);
    fmt::print(
        "| program | ranks | core s per step, least of the rounds (largest above it) | memory of all ranks, MB |\n|---|---|---|---|\n");
    for (const Variant& variant : variants) {
        const Usage& used = usage.at(label(variant));
        fmt::print("| {} | {} | {} | {:.0f} |\n", variant.name, variant.ranks, least_and_spread(used.core_s),
                   least(used.memory) / k_megabyte);
    }
}

void print_ratios(const std::map<std::string, Usage>& usage) {
    fmt::print("\n| ratio of core seconds | one rank [range of the rounds] | two ranks |\n|---|---|---|\n");
    for (const auto& [of, to] : {std::pair("flow", "pimpleFoam"), std::pair("rock", "pimpleFoam"), std::pair("flow_gamg", "pimpleFoam"),
                                 std::pair("rock_gamg", "pimpleFoam"), std::pair("rock", "flow")}) {
        const auto on = [&, of = of, to = to](const char* ranks) {
            return ratio(usage.at(std::string(of) + ranks).core_s, usage.at(std::string(to) + ranks).core_s);
        };
        fmt::print("| {} / {} | {} | {} |\n", of, to, on("_1"), on("_2"));
    }
    fmt::print("\n| program | efficiency on two ranks |\n|---|---|\n");
    for (const std::string name : {"rock", "flow", "rock_gamg", "flow_gamg", "pimpleFoam"})
        fmt::print("| {} | {:.2f} |\n", name, least(usage.at(name + "_1").core_s) / least(usage.at(name + "_2").core_s));
}

/// Memory with rock beside stock's, on one rank. Asked for: 1.15 times stock's and 2 kB a rock.
void print_memory(const std::map<std::string, Usage>& usage, std::size_t rocks) {
    const double rock = least(usage.at("rock_1").memory), flow = least(usage.at("flow_1").memory),
                 stock = least(usage.at("pimpleFoam_1").memory), count = static_cast<double>(rocks);
    fmt::print(
        "\nMemory on one rank: rock / pimpleFoam {:.3f}, flow / pimpleFoam {:.3f}; {} rocks take {:.1f} kB each beside the flow. "
        "1.15 pimpleFoam + 2 kB a rock is {:.0f} MB, rock has {:.0f} MB.\n",
        rock / stock, flow / stock, rocks, (rock - flow) / count / 1000.0, (1.15 * stock + 2000.0 * count) / k_megabyte, rock / k_megabyte);
}

int measure(const fs::path& run, int rounds) {
    std::vector<Variant> variants;
    for (const int ranks : {1, 2})
        for (const Variant& variant :
             {Variant{"rock", cutter_foam(), true, true, ranks}, Variant{"flow", cutter_foam(), false, true, ranks},
              Variant{"rock_gamg", cutter_foam(), true, false, ranks}, Variant{"flow_gamg", cutter_foam(), false, false, ranks},
              Variant{"pimpleFoam", "pimpleFoam", false, false, ranks}})
            variants.push_back(variant);
    std::map<std::string, fs::path> folders;
    for (const Variant& variant : variants) folders[label(variant)] = prepare(run, variant);
    std::map<std::string, Usage> usage;
    for (int round = 0; round < rounds; ++round)
        for (const Variant& variant : variants) {
            std::cerr << fmt::format("round {} of {}: {} on {} rank(s)\n", round + 1, rounds, variant.name, variant.ranks);
            run_once(folders[label(variant)], variant, usage[label(variant)]);
        }
    print_costs(variants, usage, rounds);
    print_ratios(usage);
    print_memory(usage, rocks_of(run / names::rock_feed));
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
