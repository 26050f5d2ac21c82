/// What a step costs with 1e3, 1e4 and 1e5 rocks that settle in a still box, on 1, 2 and 4 ranks: processor seconds, memory, messages and
/// bytes; and from these counts a model of 16 to 1,000 ranks. Each run is a row of a file, so that a machine that is shared can be left
/// between them; the tables of docs/results/many_rocks.md are printed from the rows.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "geometry/base/error.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/studies/benchmarks/descendants.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr double k_diameter = 0.005, k_cell = 2.0 * k_diameter;  // [m]
constexpr int k_layers = 3;                                      // of rock, one rock per column of cells in each
constexpr int k_cells_high = 5;
constexpr double k_time_step = 3e-3;  // [s]
constexpr int k_settling_steps = 5;   // at the start, not counted
constexpr int k_steps = 15;           // in all
constexpr double k_mebibyte = 1024.0 * 1024.0;

/// Rock on a lattice above the floor, in a closed box as wide as it takes: when steps are counted the layers begin to lie on each other.
BoxCase still_box(int rocks) {
    const int columns = static_cast<int>(std::lround(std::sqrt(static_cast<double>(rocks) / k_layers)));
    BoxCase box;
    box.lower = Vec3::Zero();
    box.upper = k_cell * Vec3(columns, columns, k_cells_high);
    box.cells = {columns, columns, k_cells_high};
    box.time_step = k_time_step;
    box.pressure_solver = "solver PCG; preconditioner aggregationMultigrid;";  // a study's: GAMG takes twice the sweeps in the largest box
    box.pressure_tolerance = 1e-7;
    box.contact =
        std::string("youngsModulus 1e7; poissonRock 0.24; poissonSteel 0.27; wetRestitution true; timeStepFraction 0.1; maxSpeed 0.5; ") +
        k_paper_contact_pairs;
    for (int k = 0; k < k_layers; ++k)
        for (int j = 0; j < columns; ++j)
            for (int i = 0; i < columns; ++i)
                box.rocks.push_back({static_cast<int>(box.rocks.size()) + 1, 0.0,
                                     Vec3(k_cell * (i + 0.5), k_cell * (j + 0.5), k_diameter * (0.6 + 1.1 * k)), k_diameter});
    return box;
}

/// What one rank sent to others, by messages of its own (neighbours) and within collective calls.
struct Traffic {
    double messages = 0.0, bytes = 0.0, collective_messages = 0.0, collective_bytes = 0.0;
};
constexpr std::array<double Traffic::*, 4> k_traffic{&Traffic::messages, &Traffic::bytes, &Traffic::collective_messages,
                                                     &Traffic::collective_bytes};

struct Run {
    int rocks = 0, ranks = 0;
    double core_seconds = 0.0;                     // of all ranks, per counted step
    double peak_memory = 0.0;                      // of all ranks [bytes]
    double fluid = 0.0, mapping = 0.0, dem = 0.0;  // share of the steps
    Traffic traffic;                               // per counted step; of each number the largest of the ranks
};

/// Open MPI's own counts, by rank, of a whole run.
std::vector<Traffic> read_traffic(const fs::path& prefix, int ranks) {
    std::vector<Traffic> traffic(static_cast<std::size_t>(ranks));
    for (int rank = 0; rank < ranks; ++rank) {
        std::ifstream stream(fmt::format("{}.{}.prof", prefix.string(), rank));
        if (!stream) throw std::runtime_error("Open MPI did not write its counts; its component pml monitoring is needed");
        Traffic& sum = traffic[static_cast<std::size_t>(rank)];
        for (std::string line; std::getline(stream, line) && line != "# OSC";) {
            std::istringstream fields(line);
            std::string kind, word;
            int from = 0, to = 0;
            double bytes = 0.0, messages = 0.0;
            fields >> kind >> from >> to >> bytes >> word >> messages;
            if (!fields || from == to) continue;
            (kind == "E" ? sum.bytes : sum.collective_bytes) += bytes;
            (kind == "E" ? sum.messages : sum.collective_messages) += messages;
        }
    }
    return traffic;
}

fs::path prepare(const BoxCase& box, int ranks) {
    const fs::path folder = scratch_folder(fmt::format("many_rocks/{}_{}", box.rocks.size(), ranks));
    write_box_case(folder, box);
    if (ranks > 1) decompose(folder, {2, ranks / 2, 1});
    return folder;
}

/// Runs a box to its end. \param traffic  of the whole run, by rank
Run run_box(const BoxCase& box, int ranks, std::vector<Traffic>& traffic) {
    const fs::path folder = prepare(box, ranks);
    ChildCommand command = meshing::foam_command(folder, cutter_foam(), {}, ranks);
    const fs::path counts = folder / "counts";
    command.environment["OMPI_MCA_pml_monitoring_enable"] = "2";
    command.environment["OMPI_MCA_pml_monitoring_enable_output"] = "3";
    command.environment["OMPI_MCA_pml_monitoring_filename"] = counts.string();
    std::vector<std::vector<Descendant>> begins;
    require_child(command, [&](const std::string& line) {
        if (line.rfind("Time = ", 0) == 0) begins.push_back(descendants());
    });
    Run run;
    run.rocks = static_cast<int>(box.rocks.size());
    run.ranks = ranks;
    if (ranks > 1) traffic = read_traffic(counts, ranks);
    if (begins.size() <= k_settling_steps) return run;
    const double steps = static_cast<double>(begins.size()) - 1.0 - k_settling_steps;
    run.core_seconds = (core_seconds(begins.back()) - core_seconds(begins[k_settling_steps])) / steps;
    for (const Descendant& process : begins.back())
        if (process.program == "cutterFoam") run.peak_memory += process.peak_memory;
    const auto cost = read_columns(folder / "postProcessing/cost/0/cost.csv");
    const auto sum = [&](const char* column) {
        double seconds = 0.0;
        for (std::size_t step = k_settling_steps; step < cost.at(column).size(); ++step) seconds += cost.at(column)[step];
        return seconds;
    };
    const double all = sum("step_s");
    run.fluid = sum("fluid_s") / all;
    run.mapping = sum("mapping_s") / all;
    run.dem = sum("dem_s") / all;
    return run;
}

/// Traffic per step is that of a long run less that of a short one.
Run measure(int rocks, int ranks) {
    std::cerr << fmt::format("{} rocks on {} rank(s)\n", rocks, ranks);
    BoxCase box = still_box(rocks);
    box.end_time = k_steps * k_time_step;
    std::vector<Traffic> whole, start;
    Run run = run_box(box, ranks, whole);
    if (ranks == 1) return run;
    box.end_time = k_settling_steps * k_time_step;
    run_box(box, ranks, start);
    for (std::size_t rank = 0; rank < whole.size(); ++rank)
        for (const auto number : k_traffic)
            run.traffic.*number = std::max(run.traffic.*number, (whole[rank].*number - start[rank].*number) / (k_steps - k_settling_steps));
    return run;
}

constexpr const char* k_rows = "many_rocks.csv";
constexpr const char* k_header =
    "rocks,ranks,core_s_per_step,peak_memory_bytes,fluid,mapping,dem,messages,bytes,collective_messages,collective_bytes";

void append_row(const Run& run) {
    const bool begins = !fs::exists(k_rows);
    std::ofstream stream(k_rows, std::ios::app);
    if (begins) stream << k_header << '\n';
    fmt::print(stream, "{},{},{:.6g},{:.6g},{:.4g},{:.4g},{:.4g}", run.rocks, run.ranks, run.core_seconds, run.peak_memory, run.fluid,
               run.mapping, run.dem);
    for (const auto number : k_traffic) fmt::print(stream, ",{:.6g}", run.traffic.*number);
    stream << '\n';
    if (!stream) throw std::runtime_error(std::string("cannot write ") + k_rows);
}

/// By ranks, then rocks; of equal ones the last.
std::vector<Run> read_rows() {
    const auto rows = read_columns(k_rows);
    std::map<std::pair<int, int>, Run> runs;
    for (std::size_t row = 0; row < rows.at("rocks").size(); ++row) {
        const auto at = [&](const char* column) { return rows.at(column)[row]; };
        const int rocks = static_cast<int>(at("rocks")), ranks = static_cast<int>(at("ranks"));
        runs[{ranks, rocks}] = {rocks,
                                ranks,
                                at("core_s_per_step"),
                                at("peak_memory_bytes"),
                                at("fluid"),
                                at("mapping"),
                                at("dem"),
                                {at("messages"), at("bytes"), at("collective_messages"), at("collective_bytes")}};
    }
    std::vector<Run> sorted;
    for (const auto& [key, run] : runs) sorted.push_back(run);
    return sorted;
}

void print_costs(const std::vector<Run>& runs) {
    fmt::print(
        "| rocks | ranks | core ms per step, all ranks | core us per rock and step | over 1e4 rocks | peak memory of all ranks, MiB | "
        "fluid / mapping / DEM, % of the steps |\n|---|---|---|---|---|---|---|\n");
    const auto per_rock = [](const Run& run) { return 1e6 * run.core_seconds / run.rocks; };
    for (const Run& run : runs) {
        const auto middle = std::find_if(runs.begin(), runs.end(),
                                         [&](const Run& other) { return other.ranks == run.ranks && std::abs(other.rocks - 1e4) < 1e3; });
        const std::string over = middle == runs.end() ? "-" : fmt::format("{:+.0f} %", 100.0 * (per_rock(run) / per_rock(*middle) - 1.0));
        fmt::print("| {} | {} | {:.1f} | {:.1f} | {} | {:.0f} | {:.0f} / {:.0f} / {:.0f} |\n", run.rocks, run.ranks, 1e3 * run.core_seconds,
                   per_rock(run), over, run.peak_memory / k_mebibyte, 100.0 * run.fluid, 100.0 * run.mapping, 100.0 * run.dem);
    }
}

void print_traffic(const std::vector<Run>& runs) {
    fmt::print(
        "\nSent per step by the rank that sends most:\n\n| rocks | ranks | messages to neighbours | KiB | messages in collective "
        "calls | KiB | bytes per rock in collective calls |\n|---|---|---|---|---|---|---|\n");
    for (const Run& run : runs)
        if (run.ranks > 1)
            fmt::print("| {} | {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} |\n", run.rocks, run.ranks, run.traffic.messages,
                       run.traffic.bytes / 1024.0, run.traffic.collective_messages, run.traffic.collective_bytes / 1024.0,
                       run.traffic.collective_bytes / run.rocks);
}

// The machine of the model: a node's share per rank of a common network.
constexpr double k_bandwidth = 1e9;  // [bytes/s]
constexpr double k_latency = 2e-6;   // per message [s]

/// What every rank does for itself, as a share of the work of one rank: by a profile of one rank with 1e4 rocks.
constexpr double k_repeated_share = 0.02;

/// Time of a step on R ranks: a / R + b + collective calls + neighbours, a + b that on one rank. A rank takes part in a collective call by
/// sending and receiving its bytes once, in log2 R stages; what it has for neighbours goes with the surface of its part, (R / 4)^(-2/3).
/// b is at least the profile's, and at most what makes up the core seconds of four ranks, a + 4 b, in which waiting counts as work.
void print_model(const Run& one, const Run& four) {
    const double least = k_repeated_share * one.core_seconds;
    const double most = std::max(least, (four.core_seconds - one.core_seconds) / (four.ranks - one.ranks));
    const double calls = four.traffic.collective_messages / 2.0;
    fmt::print(
        "\nModel, {} rocks: of {:.2f} core s per step every rank does {:.3f} s for itself at least, {:.3f} s at most.\n\n"
        "| ranks | collective calls, ms | neighbours, ms | step at least, ms | of it divided, % | step at most, ms |\n"
        "|---|---|---|---|---|---|\n",
        one.rocks, one.core_seconds, least, most);
    for (const int ranks : {1, 4, 16, 64, 256, 1000}) {
        const double stages = std::ceil(std::log2(static_cast<double>(ranks)));
        const double together = ranks == 1 ? 0.0 : 2.0 * four.traffic.collective_bytes / k_bandwidth + calls * stages * k_latency;
        const double beside =
            ranks == 1 ? 0.0 : four.traffic.bytes / k_bandwidth * std::pow(4.0 / ranks, 2.0 / 3.0) + four.traffic.messages * k_latency;
        const auto step = [&](double own) { return (one.core_seconds - own) / ranks + own + together + beside; };
        fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.1f} |\n", ranks, 1e3 * together, 1e3 * beside, 1e3 * step(least),
                   100.0 * (one.core_seconds - least) / ranks / step(least), 1e3 * step(most));
    }
}

void print_tables() {
    const std::vector<Run> runs = read_rows();
    print_costs(runs);
    print_traffic(runs);
    const auto find = [&](int rocks, int ranks) {
        return std::find_if(runs.begin(), runs.end(), [&](const Run& run) { return run.rocks == rocks && run.ranks == ranks; });
    };
    for (auto four = runs.rbegin(); four != runs.rend(); ++four)
        if (const auto one = find(four->rocks, 1); four->ranks == 4 && one != runs.end()) return print_model(*one, *four);
}

}  // namespace
}  // namespace cutterflow::validation

int main(int argc, char** argv) {
    using namespace cutterflow;
    const int rocks = argc == 3 ? std::atoi(argv[1]) : 0, ranks = argc == 3 ? std::atoi(argv[2]) : 0;
    if (argc != 1 && (rocks < 1000 || (ranks != 1 && ranks != 2 && ranks != 4))) {
        std::cerr << "usage: many_rocks ROCKS RANKS   measures 1000 or more rocks on 1, 2 or 4 ranks: a row of many_rocks.csv\n"
                     "       many_rocks               prints the tables of these rows\n";
        return 2;
    }
    try {
        if (argc == 1)
            validation::print_tables();
        else
            validation::append_row(validation::measure(rocks, ranks));
    } catch (const ToolError& error) {
        std::cerr << "many_rocks: " << error.what() << '\n';
        return 3;
    } catch (const std::exception& error) {
        std::cerr << "many_rocks: " << error.what() << '\n';
        return 1;
    }
}
