#include "postproc/analysis/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/statistics/sample.hpp"
#include "postproc/analysis/best_speed.hpp"
#include "postproc/analysis/choices.hpp"
#include "postproc/analysis/not_modelled.hpp"
#include "postproc/analysis/settings/distinct_runs.hpp"
#include "postproc/analysis/text.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;

constexpr const char* k_release = "seed or time of release";  // tells repeats apart

std::optional<double> half_width_of(const Sample& sample) {
    if (sample.count < k_fewest_repeats) return std::nullopt;
    return half_interval(sample);
}

Estimate of_average(const std::optional<TimeAverage>& average) {
    if (!average) return {};
    return {average->mean, std::nullopt, std::nullopt, average->half_interval};
}

Estimate plain(const std::optional<double>& value) {
    return {value, std::nullopt, std::nullopt, std::nullopt};
}

Estimate spillage_of(const SpillageRatios& ratios) {
    return {ratios.ratio, ratios.ratio_min, ratios.ratio_max, std::nullopt};
}

Estimate production_of(const Fates& fates) {
    if (!(fates.placed.mass > 0.0)) return {};
    const double produced = fates.sucked_up.mass / fates.placed.mass;
    return {produced, produced, 1.0 - fates.spilled.mass / fates.placed.mass, std::nullopt};
}

/// Energy of the drive over the volume of rock that it delivered [J/m3]; cutting is not in it.
Estimate energy_per_volume(const Results& results) {
    if (!results.spillage || !results.rotor.power || !(results.spillage->sucked_volume > 0.0)) return {};
    const double duration = results.spillage->fates.time - results.spillage->feed_start;
    return plain(results.rotor.power->mean * duration / results.spillage->sucked_volume);
}

std::optional<double> mixing(const ComparedRun& compared, double Mixing::*member) {
    return compared.results.mixing ? std::optional<double>((*compared.results.mixing).*member) : std::nullopt;
}

/// Of a head that is fed all the time; only bounds are known while its hold-up changes.
Estimate spillage_of(const Production& production) {
    if (!production.is_steady) return {std::nullopt, production.spillage_min, production.spillage_max, std::nullopt};
    Estimate estimate = plain(production.undelivered);
    if (production.share) estimate.half_width = production.share->half_interval;
    return estimate;
}

Estimate share_of(const Production& production) {
    Estimate estimate = plain(production.delivered / production.fed);
    if (production.share) estimate.half_width = production.share->half_interval;
    return estimate;
}

using Evaluate = std::function<Estimate(const ComparedRun&)>;

struct QuantityRule {
    std::string key, name, unit;
    bool of_rock;
    Evaluate evaluate;
};

std::optional<double> as_number(const std::optional<int>& value) {
    return value ? std::optional<double>(*value) : std::nullopt;
}

/// [m/min]; none of a head that does not swing.
std::optional<double> swing_speed(const ComparedRun& compared) {
    const double speed = compared.run.operating_point.swing_speed;
    return speed > 0.0 ? std::optional<double>(60.0 * speed) : std::nullopt;
}

std::vector<QuantityRule> operating_rules() {
    return {{"speed_rpm", "rotor speed", "rpm", false, [](const ComparedRun& r) { return plain(r.run.operating_point.speed_rpm); }},
            {"discharge_m3_s", "discharge of the mixture", "m³/s", false,
             [](const ComparedRun& r) { return plain(r.run.operating_point.discharge); }},
            {"swing_speed_m_min", "swing speed", "m/min", false, [](const ComparedRun& r) { return plain(swing_speed(r)); }},
            {"flow_number", "flow number Q / (ω R³)", "-", false, [](const ComparedRun& r) { return plain(r.results.scale.flow_number); }},
            {"cells", "cells", "-", false, [](const ComparedRun& r) { return plain(as_number(r.results.cost.cells)); }}};
}

/// Ratios when `since_feed` [s] have passed since the first rock.
std::vector<QuantityRule> equal_rules(const std::string& key, const std::string& when,
                                      const std::function<double(const ComparedRun&)>& since_feed) {
    const auto at = [=](const ComparedRun& r) { return ratios_after(r.run.rock->fates, r.results.spillage->feed_start, since_feed(r)); };
    return {
        {"ratio_at_" + key, "spillage " + when, "-", true, [=](const ComparedRun& r) { return spillage_of(at(r).ratios); }},
        {"spilled_at_" + key, "spilled / placed " + when, "-", true, [=](const ComparedRun& r) { return plain(at(r).ratios.ratio_min); }},
        {"sucked_up_at_" + key, "sucked up / placed " + when, "-", true,
         [=](const ComparedRun& r) { return plain(1.0 - at(r).ratios.ratio_max.value_or(1.0)); }},
        {"undecided_at_" + key, "undecided " + when, "-", false, [=](const ComparedRun& r) { return plain(at(r).ratios.undecided); }}};
}

std::vector<QuantityRule> rock_rules(const Comparison& comparison) {
    std::vector<QuantityRule> rules{
        {"placed", "rocks placed", "-", false, [](const ComparedRun& r) { return plain(r.results.spillage->fates.placed.count); }},
        {"ratio", "spillage: spilled / (spilled + sucked up)", "-", true,
         [](const ComparedRun& r) { return spillage_of(r.results.spillage->ratios); }},
        {"production", "production: sucked up / placed", "-", true,
         [](const ComparedRun& r) { return production_of(r.results.spillage->fates); }},
        {"undecided", "undecided", "-", false, [](const ComparedRun& r) { return plain(r.results.spillage->ratios.undecided); }},
        {"revolutions_since_feed", "revolutions since the first rock", "-", false, [](const ComparedRun& r) {
             return plain((r.results.spillage->fates.time - r.results.spillage->feed_start) / r.run.operating_point.revolution_s());
         }}};
    const auto append = [&](std::vector<QuantityRule> more) { rules.insert(rules.end(), more.begin(), more.end()); };
    if (comparison.equal_time) {
        const double time = *comparison.equal_time;
        append(equal_rules("equal_time", fmt::format("after {:.3g} s", time), [=](const ComparedRun&) { return time; }));
    }
    if (comparison.equal_revolutions) {
        const double turns = *comparison.equal_revolutions;
        const std::string count = fmt::format("{:.3g}", turns);
        append(equal_rules("equal_revolutions", fmt::format("after {} {}", count, count == "1" ? "revolution" : "revolutions"),
                           [=](const ComparedRun& r) { return turns * r.run.operating_point.revolution_s(); }));
    }
    return rules;
}

/// Delivered volume of soil as it was in the bank [m3/h], at lengths `ratio` times the model's by Froude's law; its interval is that of the
/// share of what was fed.
Estimate in_situ_rate(const ComparedRun& compared, double ratio) {
    if (!compared.results.dredging || !compared.results.dredging->delivered_in_situ) return {};
    const Production& production = compared.results.fed->production;
    const double hourly = 3600.0 * std::pow(ratio, 2.5);
    Estimate estimate = share_of(production);
    estimate.value = hourly * *compared.results.dredging->delivered_in_situ;
    if (estimate.half_width)
        *estimate.half_width *= hourly * production.fed / (production.to - production.from) / compared.run.operating_point.in_situ_density;
    return estimate;
}

/// Of heads that are fed all the time: no ratio without its hold-up.
std::vector<QuantityRule> fed_rules() {
    const auto of = [](const std::function<Estimate(const FedHead&)>& evaluate) -> Evaluate {
        return [=](const ComparedRun& r) { return r.results.fed ? evaluate(*r.results.fed) : Estimate{}; };
    };
    const auto rate = [&](double Production::*mass) {
        return of([=](const FedHead& head) { return plain(head.production.*mass / (head.production.to - head.production.from)); });
    };
    using Number = std::function<std::optional<double>(const Dredging&)>;
    const auto of_work = [](const Number& number) -> Evaluate {
        return [=](const ComparedRun& r) { return r.results.dredging ? plain(number(*r.results.dredging)) : Estimate{}; };
    };
    const auto of_scale = [](std::optional<double> ScaleNumbers::*member) -> Evaluate {
        return [=](const ComparedRun& r) { return plain(r.results.scale.*member); };
    };
    const auto of_point = [](double OperatingPoint::*member) -> Evaluate {
        return [=](const ComparedRun& r) {
            const double value = r.run.operating_point.*member;
            return value > 0.0 ? plain(value) : Estimate{};
        };
    };
    return {
        {"cut_height_m", "height of the bank", "m", false, of_point(&OperatingPoint::cut_height)},
        {"step_m", "step", "m", false, of_point(&OperatingPoint::step)},
        {"pipe_velocity_m_s", "speed in the suction mouth", "m/s", false,
         [](const ComparedRun& r) { return plain(r.results.delivery.pipe_velocity); }},
        {"froude", "Froude number ω² R / g", "-", false, [](const ComparedRun& r) { return plain(r.results.scale.froude); }},
        {"settling_ratio", "settling ratio u_t / (ω R)", "-", false, of_scale(&ScaleNumbers::settling_ratio)},
        {"size_ratio", "size ratio d / R", "-", false, of_scale(&ScaleNumbers::size_ratio)},
        {"settling_number", "settling number u_t / (Q / (π R²))", "-", false, of_scale(&ScaleNumbers::settling_number)},
        {"fall_through", "fall-through number F = u_t cos λ 2π / (z ω w)", "-", false, of_scale(&ScaleNumbers::fall_through)},
        {"swing_over_rotor_speed", "swing speed over the rotor's, v_h / (ω R)", "-", false, of_scale(&ScaleNumbers::swing_ratio)},
        {"bite_over_blade_depth", "bite of a blade over its depth, f_z / w", "-", false, of_scale(&ScaleNumbers::bite_ratio)},
        {"cut_over_discharge", "soil cut over discharge, Q_c / Q", "-", false, of_scale(&ScaleNumbers::cut_ratio)},
        {"blade_angle_less_ladder_deg", "blades' angle less the ladder's, β − λ", "°", false,
         of_scale(&ScaleNumbers::blade_angle_less_ladder)},
        {"friction_rock", "friction μ of rock on rock", "-", false, of_scale(&ScaleNumbers::friction_rock)},
        {"friction_steel", "friction μ of rock on steel", "-", false, of_scale(&ScaleNumbers::friction_steel)},
        {"friction_soil", "friction μ of rock on soil", "-", false, of_scale(&ScaleNumbers::friction_soil)},
        {"cut_in_situ_m3_h", "cut, soil in situ", "m³/h", true,
         of_work([](const Dredging& work) { return work.cut_in_situ ? std::optional<double>(3600.0 * *work.cut_in_situ) : std::nullopt; })},
        {"spilled_mixing_share", "spilled by mixing / fed", "-", true, of([](const FedHead& head) { return plain(head.losses.mixing); })},
        {"spilled_cutting_share", "spilled by cutting / fed", "-", true,
         of([](const FedHead& head) { return plain(head.losses.cutting); })},
        {"left_behind_share", "left behind / fed", "-", true, of([](const FedHead& head) { return plain(head.losses.left_behind); })},
        {"left_behind_cutting_share", "left behind, never taken in / fed", "-", true,
         of([](const FedHead& head) { return plain(head.losses.left_behind_cutting); })},
        {"concentration", "delivered soil in the mixture, by volume", "-", true,
         of_work([](const Dredging& work) { return work.concentration; })},
        {"mixture_density_kg_m3", "density of the mixture", "kg/m³", true,
         of_work([](const Dredging& work) { return work.mixture_density; })},
        {"spill_layer_m", "layer that the swings leave in the end, at most", "m", true,
         of_work([](const Dredging& work) { return work.spill_layer; })},
        {"next_layer_m", "layer for the next swing to meet", "m", true, of_work([](const Dredging& work) { return work.next_layer; })},
        {"cutting_power_w", "power of cutting, from the specific energy", "W", true,
         of_work([](const Dredging& work) { return work.cutting_power; })},
        {"cutting_torque_n_m", "torque of cutting, from the specific energy", "N m", true,
         [](const ComparedRun& r) {
             if (!r.results.dredging || !r.results.dredging->cutting_power) return Estimate{};
             return plain(*r.results.dredging->cutting_power / r.run.operating_point.angular_speed());
         }},
        {"energy_in_situ_j_m3", "energy for flow and rock per delivered m³ in situ", "J/m³", true,
         of_work([](const Dredging& work) { return work.energy; })},
        {"residence_time_s", "time of delivered rock from cut to mouth", "s", true,
         of_work([](const Dredging& work) { return work.residence_time; })},
        {"waiting_time_s", "of that, until it found a place, mean of all rock", "s", true,
         of_work([](const Dredging& work) { return work.waiting_time; })},
        {"largest_delivered_m", "largest rock delivered", "m", true, of_work([](const Dredging& work) { return work.largest_delivered; })},
        {"ratio", "spillage: 1 - delivered / fed", "-", true, of([](const FedHead& head) { return spillage_of(head.production); })},
        {"spillage_with_fines", "spillage of rock and fines, these as neutral rock", "-", true,
         of_work([](const Dredging& work) { return work.spillage_with_fines; })},
        {"production", "production: delivered / fed", "-", true, of([](const FedHead& head) { return share_of(head.production); })},
        {"hold_up_kg", "hold-up: owed or in the head", "kg", true, of([](const FedHead& head) { return plain(head.production.held); })},
        {"hold_up_change_share", "change of hold-up / fed", "-", true,
         of([](const FedHead& head) { return plain(head.production.held_change / head.production.fed); })},
        {"fed_kg_s", "fed, rock alone", "kg/s", true, rate(&Production::fed)},
        {"delivered_kg_s", "delivered, rock alone", "kg/s", true, rate(&Production::delivered)},
        {"delivered_in_situ_m3_h", "delivered, soil in situ", "m³/h", true, [](const ComparedRun& r) { return in_situ_rate(r, 1.0); }},
        {"prototype_delivered_in_situ_m3_h", "delivered, soil in situ, prototype", "m³/h", true,
         [](const ComparedRun& r) { return in_situ_rate(r, r.run.operating_point.length_ratio); }},
        {"head_is_full", "head is full (1: yes)", "-", true, of([](const FedHead& head) { return plain(head.is_full ? 1.0 : 0.0); })}};
}

/// \param of_batch  the runs have a batch of rock: heads that are fed all the time have an energy per volume of soil in their window
std::vector<QuantityRule> load_rules(bool with_rock, bool of_batch) {
    std::vector<QuantityRule> rules{{"torque_flow_mean_n_m", "mean torque of the flow", "N m", false,
                                     [](const ComparedRun& r) { return of_average(r.results.rotor.torque_flow); }}};
    if (with_rock)
        rules.push_back({"torque_rock_mean_n_m", "mean torque of the rock", "N m", true,
                         [](const ComparedRun& r) { return of_average(r.results.rotor.torque_rock); }});
    rules.push_back({"power_mean_w", "mean power of the drive", "W", with_rock,
                     [](const ComparedRun& r) { return of_average(r.results.rotor.power); }});
    if (of_batch)
        rules.push_back({"energy_per_volume_j_m3", "energy per delivered volume of rock (cutting excluded)", "J/m³", true,
                         [](const ComparedRun& r) { return energy_per_volume(r.results); }});
    return rules;
}

template <typename Bins>
auto find_bin(const Bins& bins, const std::string& name) {
    return std::find_if(bins.begin(), bins.end(), [&](const auto& item) { return item.bin.name == name; });
}

/// Bins that `bins_of` finds in every run, in the order of the first one.
template <typename BinsOf>
std::vector<std::string> common_bins(const std::vector<ComparedRun>& runs, BinsOf bins_of) {
    std::vector<std::string> names;
    for (const auto& item : bins_of(runs.front())) {
        const std::string& name = item.bin.name;
        const bool in_all =
            std::all_of(runs.begin(), runs.end(), [&](const ComparedRun& r) { return find_bin(bins_of(r), name) != bins_of(r).end(); });
        if (in_all) names.push_back(name);
    }
    return names;
}

std::vector<QuantityRule> outflow_rules(const std::vector<ComparedRun>& runs) {
    std::vector<QuantityRule> rules;
    for (const std::string& name : common_bins(
             runs, [](const ComparedRun& r) -> const auto& { return r.results.outflow; })) {
        if (rules.empty())
            rules = {{"outflow_over_discharge", "outflow of the head over discharge, q", "-", false,
                      [](const ComparedRun& r) { return plain(mixing(r, &Mixing::outflow_over_discharge)); }},
                     {"well_mixed_spillage", "spillage of neutral, well-mixed rock, q / (1 + q)", "-", false,
                      [](const ComparedRun& r) { return plain(mixing(r, &Mixing::well_mixed_spillage)); }}};
        rules.push_back({bin_key("outflow", name, "m_s"), fmt::format("radial outflow, {}", text::bin_text(name)), "m/s", false,
                         [=](const ComparedRun& r) { return of_average(find_bin(r.results.outflow, name)->radial_velocity); }});
    }
    return rules;
}

/// By the bin of the last exit: of a batch over what was placed, of heads that are fed all the time over what was fed in the window.
std::vector<QuantityRule> spilled_rules(const std::vector<ComparedRun>& runs, bool fed) {
    std::vector<QuantityRule> rules;
    for (const std::string& name : common_bins(
             runs, [](const ComparedRun& r) -> const auto& { return r.results.exits->bins; })) {
        rules.push_back({bin_key("spilled", name, "share"), fmt::format("spilled / {}, {}", fed ? "fed" : "placed", text::bin_text(name)),
                         "-", true, [=](const ComparedRun& r) {
                             const LastExits& exits = *r.results.exits;
                             const bool has_window = !fed || r.results.fed;
                             if (!has_window || !(exits.supplied > 0.0)) return Estimate{};
                             return plain(find_bin(exits.bins, name)->spilled.mass / exits.supplied);
                         }});
    }
    return rules;
}

/// Of replays: whether the flow that their rock goes through had developed.
std::vector<QuantityRule> recorded_flow_rules() {
    const auto of = [](auto member) -> Evaluate {
        return [=](const ComparedRun& r) { return r.run.flow ? plain(member(r.run)) : Estimate{}; };
    };
    return {{"flow_revolutions", "revolutions until the recorded flow ended", "-", false,
             of([](const RunData& run) { return std::optional<double>(run.flow->end / run.operating_point.revolution_s()); })},
            {"flow_change", "change of the recorded flow in a revolution", "-", false,
             of([](const RunData& run) { return run.flow->change; })}};
}

std::vector<QuantityRule> cost_rules() {
    return {{"core_s_per_revolution", "core time per revolution", "s", false,
             [](const ComparedRun& r) { return plain(r.results.cost.core_s_per_revolution); }},
            {"flow_balance_max_error", "largest error of the water balance", "-", false,
             [](const ComparedRun& r) { return plain(r.results.conservation.flow_balance); }}};
}

std::vector<double> values_of(const std::vector<Estimate>& estimates, std::optional<double> Estimate::*member) {
    std::vector<double> values;
    for (const Estimate& estimate : estimates)
        if (estimate.*member) values.push_back(*(estimate.*member));
    return values;
}

std::optional<double> mean_when_all(const std::vector<Estimate>& estimates, std::optional<double> Estimate::*member) {
    const std::vector<double> values = values_of(estimates, member);
    if (values.size() != estimates.size()) return std::nullopt;
    return sample_of(values).mean;
}

std::vector<Estimate> of_repeats(const Comparison& comparison, const ComparedSetting& setting, const Evaluate& evaluate) {
    std::vector<Estimate> estimates;
    for (const std::size_t run : setting.runs) estimates.push_back(evaluate(comparison.runs[run]));
    return estimates;
}

/// Where some repeats are known by bounds, those that are known better have their value as both: of three placements the hold-up of one may
/// still change.
std::vector<Estimate> with_bounds_where_some_have(std::vector<Estimate> repeats) {
    if (values_of(repeats, &Estimate::low).empty()) return repeats;
    for (Estimate& repeat : repeats)
        if (!repeat.low) repeat.low = repeat.high = repeat.value;
    return repeats;
}

Estimate of_setting(const std::vector<Estimate>& of_each, bool of_rock) {
    if (of_each.size() == 1) return of_each.front();
    const std::vector<Estimate> repeats = with_bounds_where_some_have(of_each);
    Estimate estimate{mean_when_all(repeats, &Estimate::value), mean_when_all(repeats, &Estimate::low),
                      mean_when_all(repeats, &Estimate::high), std::nullopt};
    if (!estimate.value) return estimate;
    estimate.half_width =
        of_rock ? half_width_of(sample_of(values_of(repeats, &Estimate::value))) : mean_when_all(repeats, &Estimate::half_width);
    return estimate;
}

std::vector<QuantityRule> rules_of(const Comparison& comparison) {
    const bool with_rock =
        std::all_of(comparison.runs.begin(), comparison.runs.end(), [](const ComparedRun& r) { return r.results.spillage.has_value(); });
    std::vector<QuantityRule> rules = operating_rules();
    const auto append = [&](std::vector<QuantityRule> more) { rules.insert(rules.end(), more.begin(), more.end()); };
    const bool fed = scope_of(comparison).fed_by_cutting;
    if (with_rock) append(fed ? fed_rules() : rock_rules(comparison));
    append(load_rules(with_rock, with_rock && !fed));
    append(outflow_rules(comparison.runs));
    if (with_rock) append(spilled_rules(comparison.runs, fed));
    if (scope_of(comparison).replays != Replays::none) append(recorded_flow_rules());
    append(cost_rules());
    return rules;
}

std::string label_of(const RunData& run) {
    return run.operating_point.study_name.empty() ? run.directory.filename().string() : run.operating_point.study_name;
}

/// Settings whose studies have one name are told apart by their first run's directory: by its name, or by its path when names are equal
/// too.
void make_labels_differ(std::vector<ComparedSetting>& settings, const std::vector<ComparedRun>& runs) {
    const auto directory = [&](const ComparedSetting& setting) { return runs[setting.runs.front()].run.directory.lexically_normal(); };
    const auto add = [&](const std::function<std::string(const ComparedSetting&)>& distinction) {
        std::map<std::string, int> count;
        for (const ComparedSetting& setting : settings) ++count[setting.label];
        for (ComparedSetting& setting : settings)
            if (count[setting.label] > 1) setting.label += fmt::format(" ({})", distinction(setting));
    };
    add([&](const ComparedSetting& setting) { return directory(setting).filename().string(); });
    add([&](const ComparedSetting& setting) { return directory(setting).string(); });
}

std::vector<ComparedSetting> group(const std::vector<ComparedRun>& runs) {
    std::vector<ComparedSetting> settings;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const auto same = std::find_if(settings.begin(), settings.end(),
                                       [&](const ComparedSetting& s) { return runs[s.runs.front()].run.setting == runs[i].run.setting; });
        if (same == settings.end())
            settings.push_back({label_of(runs[i].run), {i}});
        else
            same->runs.push_back(i);
    }
    make_labels_differ(settings, runs);
    for (ComparedSetting& setting : settings)
        std::sort(setting.runs.begin(), setting.runs.end(),
                  [&](std::size_t a, std::size_t b) { return runs[a].run.seed < runs[b].run.seed; });
    return settings;
}

/// The batch of a setting in words: sizes, densities and requested numbers.
std::string batch_text(const RunData& run) {
    if (!run.feed) return "no rock";
    std::vector<std::string> classes;
    for (const RockClass& rock : run.feed->classes)
        classes.push_back(fmt::format("{:.3g} mm, {:.0f} kg/m³", 1e3 * rock.diameter, rock.density));
    return fmt::format("{} rocks asked for: {}", run.feed->requested, fmt::join(classes, "; "));
}

/// What all runs have reached since their first rock; nothing when one of them has yet to release it.
void find_equal_points(Comparison& comparison) {
    for (const ComparedRun& compared : comparison.runs) {
        if (!compared.results.spillage) return;
        const double duration = compared.results.spillage->fates.time - compared.results.spillage->feed_start;
        if (!(duration > 0.0)) {
            comparison.equal_time = comparison.equal_revolutions = std::nullopt;
            return;
        }
        const double turns = duration / compared.run.operating_point.revolution_s();
        comparison.equal_time = std::min(comparison.equal_time.value_or(duration), duration);
        comparison.equal_revolutions = std::min(comparison.equal_revolutions.value_or(turns), turns);
    }
}

std::vector<int> seeds_of(const Comparison& comparison, const ComparedSetting& setting) {
    std::vector<int> seeds;
    for (const std::size_t run : setting.runs) seeds.push_back(comparison.runs[run].run.seed);
    return seeds;
}

/// Repeats of two settings belong together one by one when both have the same seeds, each once.
bool are_paired(const std::vector<int>& a, const std::vector<int>& b) {
    return a == b && std::set<int>(a.begin(), a.end()).size() == a.size();
}

/// Half the width of the interval of b - a over repeats.
std::optional<double> half_width_of_difference(const std::vector<double>& a, const std::vector<double>& b, bool paired) {
    if (paired) {
        std::vector<double> differences;
        for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(b[i] - a[i]);
        return half_width_of(sample_of(differences));
    }
    const Sample first = sample_of(a), second = sample_of(b);
    if (first.count < k_fewest_repeats || second.count < k_fewest_repeats) return std::nullopt;
    return half_interval_of_two(first, second);
}

ComparisonVerdict verdict_of(const Estimate& difference, bool of_rock) {
    if (difference.low && *difference.low <= 0.0 && *difference.high >= 0.0) return ComparisonVerdict::undecided;
    if (!difference.half_width) return of_rock ? ComparisonVerdict::no_replicate : ComparisonVerdict::no_interval;
    return std::abs(*difference.value) > *difference.half_width ? ComparisonVerdict::differs : ComparisonVerdict::equal;
}

constexpr double k_same_operating_point = 0.005;

bool is_near(double value, double wanted) {
    return std::abs(value - wanted) <= k_same_operating_point * wanted;
}

bool is_at(const OperatingPoint& run, const MeasuredPoint& test) {
    return is_near(run.speed_rpm, test.speed_rpm) && has_discharge_of(run, test);
}

/// Setting less test.
Difference difference_from(const Estimate& model, const MeasuredShare& test) {
    Difference difference;
    Estimate& estimate = difference.estimate;
    if (model.value) estimate.value = *model.value - test.value;
    if (model.low) estimate.low = *model.low - test.value;
    if (model.high) estimate.high = *model.high - test.value;
    if (model.half_width && test.error) estimate.half_width = std::hypot(*model.half_width, *test.error);
    difference.verdict = verdict_of(estimate, true);
    return difference;
}

json or_null(const std::optional<double>& value) {
    return value ? json(*value) : json(nullptr);
}

json estimate_json(const Estimate& estimate) {
    json object{{"value", or_null(estimate.value)}};
    if (estimate.low) object["bounds"] = {*estimate.low, *estimate.high};
    if (estimate.half_width) object["interval_95_half_width"] = *estimate.half_width;
    return object;
}

std::string estimate_text(const Estimate& estimate) {
    const std::string bounds = estimate.low ? fmt::format("[{:.3f}, {:.3f}]", *estimate.low, *estimate.high) : "";
    if (!estimate.value) return bounds.empty() ? "-" : bounds;
    std::string text = is_count(*estimate.value) ? fmt::format("{:.0f}", *estimate.value) : fmt::format("{:.4g}", *estimate.value);
    if (estimate.half_width) text += fmt::format(" ± {:.2g}", *estimate.half_width);
    return bounds.empty() ? text : text + " " + bounds;
}

/// A batch is decided once for all, a head that is fed all the time has a rate: they have no spillage in common.
void require_one_kind_of_feed(const std::vector<ComparedRun>& runs) {
    const auto kind = [](bool fed_by_cutting) {
        return [=](const ComparedRun& r) { return r.results.spillage && r.run.operating_point.fed_by_cutting == fed_by_cutting; };
    };
    const auto batch = std::find_if(runs.begin(), runs.end(), kind(false)), cut_face = std::find_if(runs.begin(), runs.end(), kind(true));
    if (batch == runs.end() || cut_face == runs.end()) return;
    throw UserError(
        fmt::format("{} has a batch of rock, {} rock from a cut face", batch->run.directory.string(), cut_face->run.directory.string()),
        "Spillage of a batch and of a steady feed are not the same quantity", "Compare runs of one feed.kind");
}

void require_different(const std::vector<ComparedRun>& runs) {
    std::vector<std::filesystem::path> directories;
    for (const ComparedRun& compared : runs) directories.push_back(compared.run.directory);
    const auto have_one_release = [&](std::size_t a, std::size_t b) {
        const RunData &first = runs[a].run, &second = runs[b].run;
        return !second.release.empty() && first.setting == second.setting && first.release == second.release;
    };
    require_distinct(directories, have_one_release, k_release);
}

}  // namespace

bool is_count(double value) {
    return std::abs(value) < 1e9 && value == std::floor(value);
}

Comparison compare_runs(const std::vector<std::filesystem::path>& directories) {
    Comparison comparison;
    Mistakes mistakes;
    mistakes.require(directories.size() >= 2, fmt::format("{} run given", directories.size()), "A comparison needs two or more",
                     "Name more run directories");
    mistakes.gather([&] { require_distinct(directories, {}, k_release); });
    for (const auto& directory : directories)
        mistakes.gather([&] {
            RunData run = read_run(directory);
            Results results = compute_results(run);
            comparison.runs.push_back({std::move(run), std::move(results)});
        });
    mistakes.refuse();
    require_different(comparison.runs);
    require_one_kind_of_feed(comparison.runs);
    comparison.settings = group(comparison.runs);
    call_by_choice(comparison);
    for (ComparedSetting& setting : comparison.settings)
        if (setting.runs.size() > 1) setting.label += fmt::format(" ({} repeats)", setting.runs.size());
    find_equal_points(comparison);
    for (const QuantityRule& rule : rules_of(comparison)) {
        Quantity quantity{rule.key, rule.name, rule.unit, rule.of_rock, {}, {}};
        for (const ComparedSetting& setting : comparison.settings) {
            quantity.repeats.push_back(of_repeats(comparison, setting, rule.evaluate));
            quantity.settings.push_back(of_setting(quantity.repeats.back(), rule.of_rock));
        }
        comparison.quantities.push_back(std::move(quantity));
    }
    return comparison;
}

Difference difference_of(const Comparison& comparison, const Quantity& quantity, std::size_t index) {
    const Estimate &a = quantity.settings.front(), &b = quantity.settings[index];
    Difference difference;
    if (!a.value || !b.value) return difference;
    difference.estimate.value = *b.value - *a.value;
    if (a.low && b.low) {
        difference.estimate.low = *b.low - *a.high;
        difference.estimate.high = *b.high - *a.low;
    }
    if (quantity.of_rock) {
        const bool paired = are_paired(seeds_of(comparison, comparison.settings[0]), seeds_of(comparison, comparison.settings[index]));
        difference.estimate.half_width = half_width_of_difference(values_of(quantity.repeats.front(), &Estimate::value),
                                                                  values_of(quantity.repeats[index], &Estimate::value), paired);
    }
    if (!difference.estimate.half_width && a.half_width && b.half_width)
        difference.estimate.half_width = std::hypot(*a.half_width, *b.half_width);
    difference.verdict = verdict_of(difference.estimate, quantity.of_rock);
    return difference;
}

const Quantity* find_quantity(const Comparison& comparison, const std::string& key) {
    const auto found =
        std::find_if(comparison.quantities.begin(), comparison.quantities.end(), [&](const Quantity& q) { return q.key == key; });
    return found == comparison.quantities.end() ? nullptr : &*found;
}

const Estimate& quantity_of(const Comparison& comparison, const std::string& key, std::size_t setting) {
    return find_quantity(comparison, key)->settings[setting];
}

void add_measured(Comparison& comparison, const std::vector<std::filesystem::path>& files) {
    Mistakes mistakes;
    for (const auto& file : files) mistakes.gather([&] { comparison.measured.push_back(read_measured_points(file)); });
    if (!files.empty() && !comparison.runs.empty() && !find_quantity(comparison, "ratio"))
        mistakes.add({"", "measured points beside runs without rock", "They are spillage and production", "Compare runs with rock"});
    mistakes.refuse();
}

bool has_discharge_of(const OperatingPoint& run, const MeasuredPoint& test) {
    return !test.discharge || is_near(run.discharge, *test.discharge);
}

std::vector<MeasuredDifference> measured_differences(const Comparison& comparison) {
    std::vector<MeasuredDifference> differences;
    for (const MeasuredSeries& series : comparison.measured)
        for (const MeasuredPoint& point : series.points)
            for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
                if (!is_at(comparison.runs[comparison.settings[i].runs.front()].run.operating_point, point)) continue;
                const auto add = [&](const char* key, const std::optional<MeasuredShare>& share) {
                    if (share)
                        differences.push_back(
                            {series.name, key, i, *share, difference_from(find_quantity(comparison, key)->settings[i], *share)});
                };
                add("ratio", point.spillage);
                add("production", point.production);
            }
    return differences;
}

std::string bin_key(const std::string& what, const std::string& bin, const std::string& unit) {
    return fmt::format("{}_{}_{}", what, bin, unit);
}

const char* verdict_text(ComparisonVerdict verdict) {
    switch (verdict) {
        case ComparisonVerdict::differs:
            return "differs";
        case ComparisonVerdict::equal:
            return "not significant";
        case ComparisonVerdict::undecided:
            return "within the bounds";
        case ComparisonVerdict::no_interval:
            return "no interval";
        case ComparisonVerdict::no_replicate:
            break;
    }
    return "no replicate";
}

std::vector<std::string> differing_batches(const Comparison& comparison) {
    if (scope_of(comparison).fed_by_cutting) return {};
    std::vector<std::string> texts;
    std::set<std::string> feeds;
    std::set<std::vector<int>> seeds;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        const ComparedSetting& setting = comparison.settings[i];
        feeds.insert(batch_text(comparison.runs[setting.runs.front()].run));
        seeds.insert(seeds_of(comparison, setting));
        texts.push_back(fmt::format("{}; seed {}", batch_text(comparison.runs[setting.runs.front()].run),
                                    fmt::join(seeds_of(comparison, setting), ", ")));
    }
    return feeds.size() > 1 || seeds.size() > 1 ? texts : std::vector<std::string>{};
}

std::map<std::string, std::vector<std::string>> differing_keys(const Comparison& comparison) {
    std::map<std::string, std::vector<std::string>> values;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i)
        for (const auto& [key, value] : comparison.runs[comparison.settings[i].runs.front()].run.setting) {
            values[key].resize(comparison.settings.size());
            values[key][i] = value;
        }
    for (auto item = values.begin(); item != values.end();) {
        const std::vector<std::string>& all = item->second;
        const bool differ = std::adjacent_find(all.begin(), all.end(), std::not_equal_to<>()) != all.end();
        item = differ ? std::next(item) : values.erase(item);
    }
    return values;
}

Scope scope_of(const Comparison& comparison) {
    Scope scope{false, true, true, true, true};
    std::size_t replays = 0;
    for (const ComparedRun& compared : comparison.runs) {
        const Scope run = scope_of(compared.run);
        scope = {scope.with_rock || run.with_rock, scope.fed_by_cutting && run.fed_by_cutting, scope.feels_bank && run.feels_bank,
                 scope.hauls && run.hauls, scope.fed_by_layer && run.fed_by_layer};
        replays += run.replays == Replays::all ? 1 : 0;
    }
    if (replays > 0) scope.replays = replays == comparison.runs.size() ? Replays::all : Replays::some;
    scope.of_one_run = comparison.runs.size() == 1;
    return scope;
}

json comparison_json(const Comparison& comparison) {
    json document{{"schema", k_comparison_schema}, {"settings", json::array()}, {"quantities", json::array()}};
    for (const ComparedSetting& setting : comparison.settings) {
        json runs = json::array();
        for (const std::size_t run : setting.runs) runs.push_back(comparison.runs[run].run.directory.string());
        document["settings"].push_back({{"label", setting.label},
                                        {"runs", runs},
                                        {"finished", std::all_of(setting.runs.begin(), setting.runs.end(),
                                                                 [&](std::size_t run) { return comparison.runs[run].results.finished; })}});
    }
    for (const Quantity& quantity : comparison.quantities) {
        json item{{"key", quantity.key}, {"unit", quantity.unit}, {"settings", json::array()}, {"differences", json::array()}};
        for (std::size_t i = 0; i < quantity.settings.size(); ++i) {
            item["settings"].push_back(estimate_json(quantity.settings[i]));
            if (i == 0) continue;
            const Difference difference = difference_of(comparison, quantity, i);
            json entry = estimate_json(difference.estimate);
            entry["verdict"] = verdict_text(difference.verdict);
            item["differences"].push_back(entry);
        }
        document["quantities"].push_back(item);
    }
    document["differing_keys"] = differing_keys(comparison);
    document["differing_batches"] = differing_batches(comparison);
    document["equal_time_s"] = or_null(comparison.equal_time);
    document["equal_revolutions"] = or_null(comparison.equal_revolutions);
    document["best_speed"] = best_speed_text(comparison);
    document["measured"] = json::array();
    for (const MeasuredDifference& beside : measured_differences(comparison)) {
        json entry{{"series", beside.series},
                   {"quantity", beside.key},
                   {"setting", beside.setting},
                   {"measured", {{"value", beside.measured.value}, {"error", or_null(beside.measured.error)}}},
                   {"difference", estimate_json(beside.difference.estimate)}};
        entry["difference"]["verdict"] = verdict_text(beside.difference.verdict);
        document["measured"].push_back(entry);
    }
    document["not_modelled"] = json::array();
    for (const NotModelled& item : not_modelled(scope_of(comparison))) document["not_modelled"].push_back(item.name);
    return document;
}

std::string comparison_text(const Comparison& comparison) {
    std::vector<std::vector<std::string>> rows{{"quantity"}};
    for (const ComparedSetting& setting : comparison.settings) rows[0].push_back(setting.label);
    for (const Quantity& quantity : comparison.quantities) {
        rows.push_back({quantity.unit == "-" ? quantity.name : fmt::format("{} [{}]", quantity.name, quantity.unit)});
        for (const Estimate& estimate : quantity.settings) rows.back().push_back(estimate_text(estimate));
    }
    std::string text;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        text += fmt::format("| {} |\n", fmt::join(rows[r], " | "));
        if (r == 0) {
            text += "|";
            for (std::size_t i = 0; i < rows[0].size(); ++i) text += "---|";
            text += "\n";
        }
    }
    for (const std::string& sentence : best_speed_text(comparison)) text += sentence + "\n";
    for (const MeasuredDifference& beside : measured_differences(comparison))
        text += fmt::format("{} less {} of {}: {}, {}\n", comparison.settings[beside.setting].label, beside.key, beside.series,
                            estimate_text(beside.difference.estimate), verdict_text(beside.difference.verdict));
    return text +
           "value ± half the 95 % interval (batch means in time; Student's t over three or more repeats) [bounds: whatever the undecided "
           "rock does]\n";
}

}  // namespace cutterflow::postproc
