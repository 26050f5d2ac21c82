#include "cases/replay/replayed_settings.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace cutterflow::cases {

namespace fs = std::filesystem;

ReplayedSettings replay_each(const std::map<std::string, std::vector<fs::path>>& runs,
                             const std::function<ReplayResults(const std::string& name, const std::vector<fs::path>& runs)>& replay) {
    ReplayedSettings all;
    for (const auto& [name, folders] : runs) {
        try {
            all.settings.push_back({name, replay(name, folders)});
            require_weak_coupling(all.settings.back().results.estimate, "");
        } catch (const Failure& failure) {
            all.failures.push_back({failure.code(), fmt::format("replays of {}: {}", name, failure.what())});
        }
    }
    return all;
}

void require_no_failures(const std::vector<SweepFailure>& failures) {
    if (failures.empty()) return;
    std::vector<Mistake> causes;
    for (const SweepFailure& failure : failures) causes.push_back({"", failure.text, "", ""});
    const auto all_are = [&](ExitCode code) {
        return std::all_of(failures.begin(), failures.end(), [code](const SweepFailure& failure) { return failure.code == code; });
    };
    if (all_are(ExitCode::user_input)) throw UserError(std::move(causes));
    if (!all_are(ExitCode::check_failed)) throw ToolError(causes);
    std::string text;
    for (const SweepFailure& failure : failures) text += (text.empty() ? "" : "\n") + failure.text;
    throw CheckFailure({"", text, "", ""});
}

std::string replays_csv(const std::vector<ReplayedSetting>& settings) {
    std::string csv =
        "setting,placements,spillage,half_interval_95,own_half_interval_95,spillage_min,fed_kg_s,hold_up_kg,settled,head_is_full,spilled_"
        "mixing,spilled_cutting,"
        "left_behind,left_behind_cutting,core_s,weakly_coupled\n";
    const auto cell = [](const std::optional<double>& value) { return value ? fmt::format("{:.6g}", *value) : std::string(); };
    for (const ReplayedSetting& setting : settings) {
        const ReplayResults& results = setting.results;
        const postproc::ReplayEstimate& estimate = results.estimate;
        csv += fmt::format("{},{},{:.6g},{},", setting.name, estimate.replays.count, estimate.spillage,
                           cell(estimate.corrections.count == 0 ? estimate.replay_interval : estimate.interval));
        if (const auto& fed = results.fed)
            csv += fmt::format("{},{:.6g},{:.6g},{:.6g},{},{},{}", cell(fed->own_interval), fed->spillage_min, fed->fed, fed->held,
                               fed->steady, fed->full, loss_columns(fed->losses));
        else
            csv += ",,,,,,,,,";
        const char* weakly_coupled = estimate.corrections.count == 0 ? "" : is_weakly_coupled(estimate) ? "1" : "0";
        csv += fmt::format(",{:.6g},{}\n", cost_of(results.replays), weakly_coupled);
    }
    return csv;
}

}  // namespace cutterflow::cases
