#include "postproc/run/solver_starts.hpp"

#include <fmt/format.h>

#include "geometry/base/json_document.hpp"
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
    return read_json_document(file, {{"warnings/*", JsonKind::text}}, k_rerun);
}

}  // namespace

std::vector<std::string> solver_warnings(const fs::path& run) {
    std::vector<std::string> warnings;
    for (const auto& [time, start] : start_folders(run, "cost"))
        for (const json& warning : summary_of(start).value("warnings", json::array())) warnings.push_back(warning.get<std::string>());
    return warnings;
}

std::vector<std::string> first_warnings(std::vector<std::string> warnings) {
    if (warnings.size() <= k_most_warnings) return warnings;
    const std::size_t more = warnings.size() - k_most_warnings;
    warnings.resize(k_most_warnings);
    warnings.push_back(fmt::format("{} more are in cost.json of postProcessing/cost", more));
    return warnings;
}

}  // namespace cutterflow::postproc
