#include "postproc/analysis/replays/replay_estimate.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gsl/assert>

#include "postproc/analysis/spillage.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {
namespace {

constexpr double k_largest_correction = 0.05;
constexpr double k_correction_per_share = 0.25;

std::optional<double> interval_of(const Sample& sample) {
    if (sample.count < 2) return std::nullopt;
    return half_interval(sample);
}

std::string percent(double share, const std::optional<double>& interval) {
    return interval ? fmt::format("{:.1f} % +- {:.1f} (95 %)", 100.0 * share, 100.0 * *interval)
                    : fmt::format("{:.1f} %, no interval", 100.0 * share);
}

std::string fed_text(const FedReplays& fed) {
    std::string text =
        fmt::format("fed         {:.3g} kg/s; hold-up {:.3g} kg, settled in {} of {} replays\n", fed.fed, fed.held, fed.steady, fed.count);
    if (fed.steady < fed.count)
        text += fmt::format("bounds      {:.1f} to {:.1f} %, spilled/fed and 1 - delivered/fed: hold-up has not settled{}\n",
                            100.0 * fed.spillage_min, 100.0 * fed.spillage_max,
                            fed.spillage_max > 1.0 ? " (above 100 %: it falls, more is spilled than fed)" : "");
    if (fed.own_interval)
        text += fmt::format("each        +- {:.1f} points (95 %) at most, by batches of a replay's own revolutions\n",
                            100.0 * *fed.own_interval);
    const std::optional<double>& never_in = fed.losses.left_behind_cutting;
    text += fmt::format("lost        {:.1f} % after mixing, {:.1f} % where it was cut, {:.1f} % left behind{}\n", 100.0 * fed.losses.mixing,
                        100.0 * fed.losses.cutting, 100.0 * fed.losses.left_behind,
                        never_in ? fmt::format(" ({:.1f} % never taken in)", 100.0 * *never_in) : "");
    if (fed.full > 0) text += fmt::format("full        the head cannot take what it cuts in {} of {} replays\n", fed.full, fed.count);
    return text;
}

/// What a fed head found that is too short to tell a production.
std::string no_window_text(const Table& ledger) {
    if (ledger.empty()) return "no rock was fed";
    const auto last = [&](const char* column) { return ledger.number(column).back(); };
    return fmt::format("no whole revolution is left after the start-up: of {:.3g} kg {:.3g} kg are delivered and {:.3g} kg in the head",
                       last("fed_kg"), last("delivered_kg"), last("in_head_kg"));
}

}  // namespace

RockAnswer rock_answer(const std::filesystem::path& folder, bool is_fed_by_cutting, double revolution, int blades) {
    const Table fates = read_fates(folder);
    RockAnswer answer;
    if (fates.empty()) {
        answer.reason = "no rock has come in yet";
        return answer;
    }
    const SpillageRatios ratios = ratios_of(fates_at(fates, fates.rows() - 1));
    answer.undecided = ratios.undecided.value_or(1.0);
    if (!is_fed_by_cutting) {
        answer.spillage = ratios.ratio;
        answer.reason = ratios.reason;
        return answer;
    }
    const Table ledger = read_ledger(folder);
    answer.fed = fed_head_of(ledger, revolution, revolution / blades);
    if (answer.fed)
        answer.spillage = answer.fed->production.undelivered;
    else
        answer.reason = no_window_text(ledger);
    return answer;
}

FedReplays fed_replays_of(const std::vector<FedHead>& heads) {
    Expects(!heads.empty());
    FedReplays fed;
    fed.count = heads.size();
    const double share = 1.0 / static_cast<double>(heads.size());
    std::optional<double>& never_in = fed.losses.left_behind_cutting;
    never_in = 0.0;
    for (const FedHead& head : heads) {
        fed.steady += head.production.is_steady ? 1 : 0;
        fed.full += head.is_full ? 1 : 0;
        fed.spillage_min += share * head.production.spillage_min;
        fed.spillage_max += share * head.production.spillage_max;
        fed.fed += share * head.production.fed / (head.production.to - head.production.from);
        fed.held += share * head.production.held;
        if (const auto& own = head.production.share) fed.own_interval = std::max(fed.own_interval.value_or(0.0), own->half_interval);
        fed.losses.mixing += share * head.losses.mixing;
        fed.losses.cutting += share * head.losses.cutting;
        fed.losses.left_behind += share * head.losses.left_behind;
        if (never_in && head.losses.left_behind_cutting)
            *never_in += share * *head.losses.left_behind_cutting;
        else
            never_in.reset();
    }
    return fed;
}

ReplayEstimate estimate_spillage(const std::vector<double>& replays, const std::vector<ReplayPair>& pairs) {
    Expects(!replays.empty());
    std::vector<double> corrections;
    for (const ReplayPair& pair : pairs) corrections.push_back(pair.coupled - pair.replayed);
    ReplayEstimate estimate;
    estimate.replays = sample_of(replays);
    estimate.corrections = sample_of(corrections);
    estimate.spillage = estimate.replays.mean + estimate.corrections.mean;
    estimate.replay_interval = interval_of(estimate.replays);
    estimate.correction_interval = interval_of(estimate.corrections);
    if (estimate.replay_interval && estimate.correction_interval)
        estimate.interval = std::hypot(*estimate.replay_interval, *estimate.correction_interval);
    return estimate;
}

double largest_correction(const ReplayEstimate& estimate) {
    const double spilled = std::clamp(estimate.replays.mean, 0.0, 1.0);
    return std::min(k_largest_correction, k_correction_per_share * std::min(spilled, 1.0 - spilled));
}

std::string replay_text(const ReplayEstimate& estimate, const std::optional<FedReplays>& fed) {
    std::string text = fmt::format("replayed    {}, {} placement{}; rock does not change this flow\n",
                                   percent(estimate.replays.mean, estimate.replay_interval), estimate.replays.count,
                                   estimate.replays.count == 1 ? "" : "s");
    if (fed) text += fed_text(*fed);
    if (estimate.corrections.count == 0) return text + "coupled     no run: what the recorded flow leaves out is not known\n";
    text += fmt::format(
        "coupled     {:+.1f} points{}, {} run{} with the same placement{} as in replays\n", 100.0 * estimate.corrections.mean,
        estimate.correction_interval ? fmt::format(" +- {:.1f} (95 %)", 100.0 * *estimate.correction_interval) : ", no interval",
        estimate.corrections.count, estimate.corrections.count == 1 ? "" : "s", estimate.corrections.count == 1 ? "" : "s");
    text += fmt::format("spillage    {}\n", percent(estimate.spillage, estimate.interval));
    if (!estimate.interval)
        text += "            two coupled runs or more, with other placements, give an interval: cutterflow sweep --repeats\n";
    return text;
}

}  // namespace cutterflow::postproc
