#include "cases/scenes/cutter/start_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "cases/scenes/cutter/flow_dictionaries.hpp"
#include "geometry/base/file_content.hpp"
#include "meshing/dictionary/foam_command.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 5> k_fields = {"U", "p", "k", "epsilon", "nut"};

void write_files(const fs::path& directory, const std::vector<FoamFile>& files) {
    for (const FoamFile& file : files) meshing::write_foam_file(directory / file.path, file.foam_class, file.contents);
}

/// The sub-case: fields and properties of the run (with what the user changed in them), its own system/, the rotor frozen.
void write_start_case(const fs::path& run_directory, const fs::path& start, const CaseInputs& inputs, int iterations) {
    fs::remove_all(start);
    fs::create_directories(start / "0");
    fs::create_directories(start / "constant");
    for (const char* field : k_fields) fs::copy_file(run_directory / "0" / field, start / "0" / field);
    for (const char* property : {"transportProperties", "turbulenceProperties"})
        fs::copy_file(run_directory / "constant" / property, start / "constant" / property);
    fs::create_directory_symlink("../../constant/polyMesh", start / "constant/polyMesh");
    write_files(start, start_system_files(inputs, iterations));
    write_files(start, {frozen_rotor_file(inputs), decompose_file(inputs.ranks)});
}

/// Column of a function object's table: numbers only, brackets around vectors dropped.
std::vector<double> read_column(const fs::path& path, std::size_t column) {
    if (!fs::exists(path)) return {};
    std::istringstream file(read_file(path));
    std::vector<double> values;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line.front() == '#') continue;
        std::replace_if(
            line.begin(), line.end(), [](char c) { return c == '(' || c == ')'; }, ' ');
        std::istringstream words(line);
        std::string word;
        for (std::size_t i = 0; i <= column; ++i) words >> word;
        values.push_back(words ? std::strtod(word.c_str(), nullptr) : std::nan(""));
    }
    return values;
}

std::vector<double> read_monitor(const fs::path& start, const std::string& name) {
    return read_column(start / "postProcessing" / name / "0/surfaceFieldValue.dat", 1);
}

/// Moment of the flow on the cutter about the axis, per iteration.
std::vector<double> read_torque(const fs::path& start, const Vec3& axis) {
    const fs::path table = start / "postProcessing/torque/0/moment.dat";
    std::vector<double> torque = read_column(table, 1);
    const std::vector<double> y = read_column(table, 2), z = read_column(table, 3);
    for (std::size_t i = 0; i < torque.size(); ++i) torque[i] = axis.dot(Vec3(torque[i], y[i], z[i]));
    return torque;
}

void require_converging(const fs::path& start, const std::vector<double>& history, int iterations) {
    const bool complete = history.size() == static_cast<std::size_t>(iterations);
    if (complete && std::all_of(history.begin(), history.end(), [](double value) { return std::isfinite(value); })) return;
    throw CheckFailure({"", fmt::format("The frozen-rotor start gave {} of {} finite monitor values", history.size(), iterations),
                        "Its flow must stay finite",
                        fmt::format("Look at {} and at the mesh report", (start / "log.simpleFoam").string())});
}

StartFlowReport read_report(const fs::path& start, const CaseInputs& inputs, int iterations) {
    const std::vector<double> pressure = read_monitor(start, "outletPressure");
    const std::vector<double> torque = read_torque(start, inputs.rotor.axis.direction);
    const std::vector<double> inflow = read_monitor(start, "inletFlow"), outflow = read_monitor(start, "outletFlow");
    for (const auto& history : {pressure, torque, inflow, outflow}) require_converging(start, history, iterations);

    StartFlowReport report;
    report.iterations = iterations;
    report.outlet_pressure = monitor_of(pressure);
    report.torque = monitor_of(torque);
    report.flow_imbalance = std::abs(inflow.back() + outflow.back()) / inputs.discharge;
    return report;
}

bool same_file(const fs::path& a, const fs::path& b) {
    return fs::is_regular_file(a) && fs::is_regular_file(b) && fs::file_size(a) == fs::file_size(b) && read_file(a) == read_file(b);
}

/// Do two folders hold the same files, byte by byte? Links to folders do not count.
bool same_files(const fs::path& a, const fs::path& b) {
    if (!fs::is_directory(a) || !fs::is_directory(b)) return false;
    std::set<std::string> files;
    for (const fs::path& folder : {a, b})
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            if (!entry.is_directory()) files.insert(entry.path().filename().string());
    return std::all_of(files.begin(), files.end(), [&](const std::string& file) { return same_file(a / file, b / file); });
}

double percent(const Monitor& monitor) {
    return 100.0 * monitor.drift / std::abs(monitor.last);
}

}  // namespace

Monitor monitor_of(const std::vector<double>& history) {
    const std::size_t window = std::min<std::size_t>(history.size(), k_convergence_window);
    const auto [low, high] = std::minmax_element(history.end() - static_cast<std::ptrdiff_t>(window), history.end());
    return {history.back(), *high - *low};
}

std::string StartFlowReport::text() const {
    return fmt::format(
        "{} iterations; over the last {} the outlet pressure moved by {:.2g} % ({:.4g} m2/s2) and the torque by {:.2g} % ({:.4g} N m); "
        "flow imbalance {:.1e} of the discharge",
        iterations, std::min(iterations, k_convergence_window), percent(outlet_pressure), outlet_pressure.last, percent(torque),
        torque.last, flow_imbalance);
}

std::optional<StartFlowReport> take_start_flow(const fs::path& run_directory, const fs::path& donor, const CaseInputs& inputs,
                                               int iterations) {
    const fs::path start = run_directory / "start";
    write_start_case(run_directory, start, inputs, iterations);
    for (const char* folder : {"start/0", "start/system", "start/constant", "constant/polyMesh"})
        if (!same_files(run_directory / folder, donor / folder)) return std::nullopt;
    const fs::path results = donor / "start" / std::to_string(iterations);
    for (const char* field : k_fields)
        if (!fs::is_regular_file(results / field)) return std::nullopt;
    StartFlowReport report = read_report(donor / "start", inputs, iterations);
    for (const char* field : k_fields) fs::copy_file(results / field, run_directory / "0" / field, fs::copy_options::overwrite_existing);
    return report;
}

StartFlowReport run_start_flow(const fs::path& run_directory, const CaseInputs& inputs, int iterations, const StartProgress& progress) {
    const fs::path start = run_directory / "start";
    write_start_case(run_directory, start, inputs, iterations);

    double wall_s = 0.0, core_s = 0.0;
    const auto run = [&](const ChildCommand& command, const std::function<void(const std::string&)>& each_line = {}) {
        const ChildResult result = require_child(command, each_line);
        wall_s += result.wall_s;
        core_s += result.core_s;
    };
    const auto show_iteration = [&](const std::string& line) {
        if (progress && line.rfind("Time = ", 0) == 0) progress(std::atoi(line.c_str() + 7), iterations);
    };
    const bool parallel = inputs.ranks > 1;
    if (parallel) run(meshing::foam_command(start, "decomposePar"));
    run(meshing::foam_command(start, "simpleFoam", {}, inputs.ranks), show_iteration);
    if (parallel) run(meshing::foam_command(start, "reconstructPar", {"-latestTime"}));

    StartFlowReport report = read_report(start, inputs, iterations);
    report.wall_s = wall_s;
    report.core_s = core_s;
    for (const char* field : k_fields)
        fs::copy_file(start / std::to_string(iterations) / field, run_directory / "0" / field, fs::copy_options::overwrite_existing);
    for (int rank = 0; parallel && rank < inputs.ranks; ++rank) fs::remove_all(start / fmt::format("processor{}", rank));
    return report;
}

}  // namespace cutterflow::cases
