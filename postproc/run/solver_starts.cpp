#include "postproc/run/solver_starts.hpp"

#include <numeric>
#include <sstream>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/statistics/replaced_starts.hpp"
#include "postproc/run/run_table.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* k_rerun = "Repeat the run with this version of Cutterflow";
constexpr std::size_t k_most_warnings = 10;

/// cost.json of a start; empty when it did not come to its end.
json summary_of(const fs::path& start) {
    const fs::path file = start / "cost.json";
    if (!fs::exists(file)) return json::object();
    return read_json_document(file, {{"ranks", JsonKind::whole}, {"core_s", JsonKind::number}, {"warnings/*", JsonKind::text}}, k_rerun);
}

/// Wall time of the steps of a start [s].
double wall_seconds(const fs::path& start) {
    const fs::path file = start / "cost.csv";
    if (!fs::exists(file)) return 0.0;
    const std::vector<double> steps = read_table(file, {{"step_s"}, {}, {}, k_rerun}).number("step_s");
    return std::accumulate(steps.begin(), steps.end(), 0.0);
}

/// What the solver warned of in a start; earlier programs told it at its end.
std::vector<std::string> warnings_of(const fs::path& start) {
    const fs::path file = start / names::warnings;
    if (!fs::exists(file)) return summary_of(start).value("warnings", std::vector<std::string>());
    std::vector<std::string> warnings;
    std::istringstream text(read_file(file));
    for (std::string line; std::getline(text, line);) warnings.push_back(line);
    return warnings;
}

}  // namespace

std::vector<std::string> solver_warnings(const fs::path& run) {
    std::vector<std::string> warnings;
    for (const auto& [time, start] : start_folders(run, "cost"))
        for (std::string& warning : warnings_of(start)) warnings.push_back(std::move(warning));
    return warnings;
}

std::vector<std::string> first_warnings(std::vector<std::string> warnings) {
    if (warnings.size() <= k_most_warnings) return warnings;
    const std::size_t more = warnings.size() - k_most_warnings;
    warnings.resize(k_most_warnings);
    warnings.push_back(fmt::format("{} more are in postProcessing/cost/*/{}", more, names::warnings));
    return warnings;
}

std::optional<double> solver_core_seconds(const fs::path& run) {
    std::optional<int> ranks;  // of the last start that told them
    double told = 0.0, wall_of_others = 0.0;
    for (const auto& [time, start] : start_folders(run, "cost")) {
        const json summary = summary_of(start);
        if (summary.contains("ranks")) ranks = summary.at("ranks").get<int>();
        if (summary.contains("core_s"))
            told += summary.at("core_s").get<double>();
        else
            wall_of_others += wall_seconds(start);
    }
    if (!ranks) return std::nullopt;
    return told + wall_of_others * *ranks + replaced_core_seconds(run);
}

}  // namespace cutterflow::postproc
