#include "solver/ports/recording_summary.hpp"

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/json_document.hpp"

namespace cutterflow::coupling {
namespace {

/// Above it a flow is told as not developed. One that began from a frozen rotor changed by 0.21, 0.12, 0.05, 0.03 in its third to sixth
/// revolution (docs/design/013-replays.md).
constexpr double k_largest_change = 0.05;

}  // namespace

RecordingSummary read_recording_summary(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / k_recording_summary;
    const std::string schema = read_json_document(file, {{"schema", JsonKind::text, true}}, k_recording_remedy).at("schema");
    if (schema != k_recording_schema)
        throw UserError({{file.string(), fmt::format("its schema is {}", schema),
                          fmt::format("This version of the program reads {}", k_recording_schema), k_recording_remedy}});
    const nlohmann::json summary = read_json_document(
        file, {{"change", JsonKind::number_or_null, true}, {"start_s", JsonKind::number, true}, {"end_s", JsonKind::number, true}},
        k_recording_remedy);
    const nlohmann::json& change = summary.at("change");
    return {change.is_null() ? std::nullopt : std::optional<double>(change.get<double>()), summary.at("start_s"), summary.at("end_s")};
}

std::optional<std::string> warning_of_change(const std::optional<double>& change) {
    if (!change || *change <= k_largest_change) return {};
    return fmt::format(
        "the flow in the turning zone changed by {:.2g} % in the revolution that was recorded, more than {:g} %: it has not developed, "
        "and a replay sees it for ever as it is. Record a later revolution (run.flow_revolutions of a study, record.startTime of a case)",
        100.0 * *change, 100.0 * k_largest_change);
}

}  // namespace cutterflow::coupling
