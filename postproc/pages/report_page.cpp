#include "postproc/pages/report_page.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/statistics/developed_flow.hpp"
#include "postproc/analysis/dredging.hpp"
#include "postproc/analysis/not_modelled.hpp"
#include "postproc/analysis/text.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/palette.hpp"

namespace cutterflow::postproc {
namespace {

using html::answer;
using html::escape;
using nlohmann::json;
using namespace text;

/// Value of a JSON file as markup.
std::string json_text(const json& value) {
    if (value.is_string()) return escape(value.get<std::string>());
    if (value.is_number_float()) return digits_of(value.get<double>(), 5);
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    return escape(value.dump());
}

/// A word of the study as people write it: "over_cut" as "over-cut".
std::string spaced(std::string word) {
    std::replace(word.begin(), word.end(), '_', '-');
    return escape(word);
}

/// "cell_size_min_m" as "cell size min [m]": units are at the end of a key.
std::string key_text(const std::string& key) {
    static const std::map<std::string, std::string> phrases{{"core_s", "core time [s]"},
                                                            {"wall_s", "wall time [s]"},
                                                            {"passage_m", "largest sphere that passes between the blades [m]"},
                                                            {"thickness_m", "thickness of its thin parts, such as blades [m]"},
                                                            {"memory_bytes", "memory of the mesher [MB]"},
                                                            {"predicted_memory_bytes", "predicted memory of the mesher [MB]"}};
    const auto phrase = phrases.find(key);
    if (phrase != phrases.end()) return phrase->second;
    static const std::vector<std::pair<std::string, std::string>> units{
        {"_kg_m3", "kg/m³"}, {"_m3_s", "m³/s"}, {"_m_s", "m/s"}, {"_deg", "°"}, {"_rad", "rad"}, {"_rpm", "rpm"},
        {"_m3", "m³"},       {"_m2", "m²"},     {"_mm", "mm"},   {"_kg", "kg"}, {"_m", "m"},     {"_s", "s"}};
    std::string words = key, unit;
    for (const auto& [suffix, text] : units) {
        if (words.size() <= suffix.size() || words.compare(words.size() - suffix.size(), suffix.size(), suffix) != 0) continue;
        words.resize(words.size() - suffix.size());
        unit = " [" + text + "]";
        break;
    }
    std::replace(words.begin(), words.end(), '_', ' ');
    return escape(words) + unit;
}

/// The single values of a JSON file as rows.
std::vector<std::vector<std::string>> value_rows(const json& object) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& [key, value] : object.items()) {
        if (value.is_structured() || value.is_null()) continue;
        const bool bytes = key.find("_bytes") != std::string::npos && value.is_number();
        rows.push_back({key_text(key), bytes ? fmt::format("{:.0f}", value.get<double>() / 1e6) : json_text(value)});
    }
    return rows;
}

std::string fate_detail(const RockAmount& amount) {
    return fmt::format("{} rocks, {:.4g} kg", amount.count, amount.mass);
}

std::string over_revolutions(const RotorLoads& rotor) {
    if (rotor.averaged_revolutions == 0.0) return "no blade has passed yet since the start of the averaging window";
    return fmt::format("mean over {:.3g} revolution{}", rotor.averaged_revolutions, rotor.averaged_revolutions == 1.0 ? "" : "s");
}

std::string plots_at(const PageFigures& figures, Place place) {
    const auto found = figures.plots.find(place);
    return found == figures.plots.end() ? "" : found->second;
}

const char* kind_of_run(const Results& results, const RunData& run) {
    if (results.spillage) return "Flow-induced spillage";
    return run.feed ? "Flow in the turning head (rock has not come in yet)" : "Flow in the turning head (no rock)";
}

std::string header(const Results& results, const RunData& run) {
    const OperatingPoint& point = run.operating_point;
    const std::string name = point.study_name.empty() ? std::string("Cutter head") : escape(point.study_name);
    const std::string swing = point.swing_direction.empty() ? "" : ", " + spaced(point.swing_direction);
    return fmt::format(
        "<header><h1>{}</h1><p class=\"operating\">{}: {:g} rpm{}, discharge {:g} m³/s, axis {:g}° below horizontal, "
        "ring radius {:.3g} m{}</p></header>\n",
        name, kind_of_run(results, run), point.speed_rpm, swing, point.discharge, point.inclination_deg, run.contour.ring_radius(),
        point.mesh_preset.empty() ? "" : fmt::format(", mesh “{}”", escape(point.mesh_preset)));
}

std::string unfinished_notice(const Results& results, bool is_replay) {
    if (results.finished) return "";
    if (is_replay)
        return fmt::format(
            "<p class=\"notice\"><b>The replay is not finished.</b> These are the numbers up to t = {:.4g} s. Repeat the command "
            "<code>cutterflow replay</code> that made it with <code>--resume</code>.</p>\n",
            results.end_time);
    return fmt::format(
        "<p class=\"notice\"><b>The run is not finished.</b> These are the numbers up to t = {:.4g} s ({:.2f} revolutions). "
        "Continue it with <code>cutterflow run --resume</code>.</p>\n",
        results.end_time, results.rotor.revolutions);
}

std::string rock_answers(const Results& results, double revolution) {
    const Spillage& spillage = *results.spillage;
    const SpillageRatios& ratios = spillage.ratios;
    const double placed = spillage.fates.placed.mass;
    const double since_feed = (spillage.fates.time - spillage.feed_start) / revolution;
    std::string bounds = ratios.ratio_min ? fmt::format("between {} and {} whatever the undecided rock does", percent(*ratios.ratio_min),
                                                        percent(*ratios.ratio_max))
                                          : ratios.reason;
    if (!ratios.ratio && ratios.ratio_min) bounds = ratios.reason + "; " + bounds;
    std::string blocks = answer(palette::spilled, "Spillage: spilled / (spilled + sucked up), by mass", percent(ratios.ratio), bounds);
    blocks += answer(palette::sucked_up, "Production: sucked up / placed, by mass",
                     placed > 0.0 ? percent(spillage.fates.sucked_up.mass / placed) : "undefined", fate_detail(spillage.fates.sucked_up));
    blocks += answer(palette::in_cutter, "Undecided: still in the cutter or never entered", percent(ratios.undecided),
                     fmt::format("{} in the cutter, {} never entered", spillage.fates.in_cutter.count, spillage.fates.never_entered.count));
    blocks += answer(palette::ink, "Evaluated after", fmt::format("{:.2f} rev", since_feed),
                     fmt::format("since the first rock ({:.3g} s); {} of {} rocks placed, {:.4g} kg",
                                 spillage.fates.time - spillage.feed_start, spillage.fates.placed.count, results.rock_requested, placed));
    return blocks;
}

/// Of a head that is fed all the time: production and spillage, never without the hold-up.
std::string fed_answers(const FedHead& head) {
    const Production& production = head.production;
    const std::string interval = production.share ? fmt::format(" ± {}", percent(production.share->half_interval)) : "";
    const std::string sure = production.share ? fmt::format("95 % interval from {} batches in time", production.share->batches)
                                              : "too short for an interval: it takes 8 batches of a revolution or more";
    std::string blocks =
        answer(palette::sucked_up, "Production: delivered / fed, by mass", percent(production.delivered / production.fed) + interval, sure);
    blocks += answer(palette::spilled, "Spillage: 1 − delivered / fed, by mass",
                     production.is_steady ? percent(production.undelivered) + interval
                                          : fmt::format("{} to {}", percent(production.spillage_min), percent(production.spillage_max)),
                     production.is_steady ? "what the head holds changed by less than 5 % of what was fed"
                                          : "bounds: what the head holds still changes, and may yet be delivered or spilled; the lower one "
                                            "is not strict, for rock within reach counts as spilled and may come back");
    blocks += answer(palette::in_cutter, "Hold-up: owed or in the head", fmt::format("{} kg", number(production.held)),
                     fmt::format("changed by {} of what was fed", percent(production.held_change / production.fed)));
    return blocks + answer(palette::ink, "Head", head.is_full ? "full" : "not full",
                           head.is_full
                               ? fmt::format("for a revolution more rock waited for a place than 5 % of what a blade cuts in passing; "
                                             "in the mean {} of what a revolution cuts waited",
                                             percent(head.owed_share))
                               : "rock that was cut found its place");
}

/// Masses so far, and no ratio: the hold-up of a window is not known.
std::string early_answers(const Fates& fates) {
    const auto mass = [](const RockAmount& amount) { return fmt::format("{} kg", number(amount.mass)); };
    std::string blocks = answer(palette::ink, "Production and spillage", "not known yet",
                                "they take a whole revolution after the start-up of 3 s and two revolutions or more");
    blocks += answer(palette::sucked_up, "Delivered so far", mass(fates.sucked_up), fate_detail(fates.sucked_up));
    blocks += answer(palette::spilled, "Spilled so far", mass(fates.spilled), fate_detail(fates.spilled));
    return blocks + answer(palette::in_cutter, "In the cutter", mass(fates.in_cutter), fate_detail(fates.in_cutter));
}

/// N m as kN m, W as kW.
std::optional<double> scaled_down(const std::optional<double>& value) {
    return value ? std::optional<double>(1e-3 * *value) : std::nullopt;
}

/// A quantity of the model and how it grows with the length ratio under Froude's law.
struct ScaledValue {
    const char* name;
    const char* unit;
    std::optional<double> model;
    double exponent;
};

/// What a head that is fed all the time does, in the model and, where there is one, in the prototype: rates with lengths to the power 2.5,
/// speeds 0.5, torque 4, power 3.5.
std::string production_table(const Results& results, const RunData& run) {
    const Production& production = results.fed->production;
    const OperatingPoint& point = run.operating_point;
    const double duration = production.to - production.from;
    const auto tonnes = [&](double mass) { return 3.6 * mass / duration; };
    const auto mean = [](const std::optional<TimeAverage>& average) {
        return average ? std::optional<double>(average->mean) : std::nullopt;
    };
    const Dredging& dredging = *results.dredging;
    const auto times = [](double factor, const std::optional<double>& value) {
        return value ? std::optional<double>(factor * *value) : std::nullopt;
    };
    const auto with_fines = [&](double mass, const std::optional<double>& fines) {
        return fines ? std::optional<double>(tonnes(mass + *fines)) : std::nullopt;
    };
    const std::optional<double> spilled_fines =
        dredging.delivered_fines ? std::optional<double>(dredging.fines - *dredging.delivered_fines) : std::nullopt;
    const auto given = [](double value) { return value > 0.0 ? std::optional<double>(value) : std::nullopt; };
    const std::optional<double> cutting_torque = times(1.0 / point.angular_speed(), dredging.cutting_power);
    const std::vector<ScaledValue> values{
        {"rotor speed", "rpm", point.speed_rpm, -0.5},
        {"swing speed", "m/min", times(60.0, given(point.swing_speed)), 0.5},
        {"cut: height of the bank", "m", given(point.cut_height), 1.0},
        {"cut: step", "m", given(point.step), 1.0},
        {"discharge of the mixture", "m³/h", 3600.0 * point.discharge, 2.5},
        {"speed in the suction mouth", "m/s", results.delivery.pipe_velocity, 0.5},
        {"cut, soil in situ", "m³/h", times(3600.0, dredging.cut_in_situ), 2.5},
        {"fed, dry", "t/h", tonnes(production.fed + dredging.fines), 2.5},
        {"fed, soil in situ", "m³/h", times(3600.0, dredging.fed_in_situ), 2.5},
        {"delivered, dry", "t/h", with_fines(production.delivered, dredging.delivered_fines), 2.5},
        {"delivered, soil in situ", "m³/h", times(3600.0, dredging.delivered_in_situ), 2.5},
        {"spilled, dry", "t/h", with_fines(production.spilled, spilled_fines), 2.5},
        {"hold-up grows by", "t/h", tonnes(production.held_change), 2.5},
        {"hold-up", "kg", production.held, 3.0},
        {"density of the mixture", "kg/m³", dredging.mixture_density, 0.0},
        {"delivered soil in the mixture, by volume", "%", times(100.0, dredging.concentration), 0.0},
        {"layer that the swings leave in the end, at most: all that is spilled, on one step’s width", "m", dredging.spill_layer, 1.0},
        {"layer for the next swing to meet (bed.spill_layer_m), on all that the head passed", "m", dredging.next_layer, 1.0},
        {"torque of the flow", "kN m", scaled_down(mean(results.rotor.torque_flow)), 4.0},
        {"torque of the rock", "kN m", scaled_down(mean(results.rotor.torque_rock)), 4.0},
        {"torque of cutting, from soil.specific_energy_mj_m3", "kN m", scaled_down(cutting_torque), 3.0},
        {"power of the drive for flow and rock", "kW", scaled_down(mean(results.rotor.power)), 3.5},
        {"power of cutting, from soil.specific_energy_mj_m3", "kW", scaled_down(dredging.cutting_power), 2.5},
        {"energy for flow and rock, per delivered m³ in situ", "MJ/m³", times(1e-6, dredging.energy), 1.0},
        {"energy of cutting, per delivered m³ in situ", "MJ/m³", times(1e-6, dredging.cutting_energy), 0.0},
        {"time of delivered rock from cut to mouth, mean", "s", dredging.residence_time, 0.5},
        {"of that, until it found a place before a blade, mean of all rock", "s", dredging.waiting_time, 0.5},
        {"largest rock delivered", "mm", times(1e3, dredging.largest_delivered), 1.0}};
    const bool has_prototype = point.length_ratio != 1.0;
    std::vector<std::vector<std::string>> rows;
    for (const ScaledValue& value : values) {
        if (!value.model) continue;
        rows.push_back({value.name, number(value.model, value.unit)});
        if (has_prototype) rows.back().push_back(number(*value.model * std::pow(point.length_ratio, value.exponent), value.unit));
    }
    std::vector<std::string> header{"steady production", "model"};
    if (has_prototype) header.push_back(fmt::format("prototype, {:g} times as long", point.length_ratio));
    const std::string cutting_note =
        dredging.cutting_power ? " The energy of cutting a volume of soil is the user’s; it is the same in the prototype."
                               : " Power of cutting: not known without soil.specific_energy_mj_m3; forces on picks are not computed.";
    return fmt::format("<p>Means over {:.0f} revolutions, {:.3f} to {:.3f} s{}.{}{}</p>\n", duration / point.revolution_s(),
                       production.from, production.to, production.start ? "" : "; start-up never ended",
                       has_prototype ? " The prototype’s by Froude’s law in the same water." : "", cutting_note) +
           html::table(header, rows, true);
}

/// Shares of what was fed, in the window of the production.
std::string losses_table(const Results& results, const RunData& run) {
    const Dredging& dredging = *results.dredging;
    const Losses& losses = results.fed->losses;
    std::vector<std::vector<std::string>> rows{
        {"outside, within reach: spilled by mixing, had been in the head’s flow", percent(losses.mixing)},
        {"outside, within reach: spilled by cutting, never taken in", percent(losses.cutting)},
        {"left behind: outside and far off, taken out of the run, lost for good", percent(losses.left_behind)},
        {"of that: lost where it was cut, never taken in",
         losses.left_behind_cutting ? percent(*losses.left_behind_cutting) : "not known: the ledger is an earlier program’s"}};
    if (dredging.layer_share > 0.0)
        rows.push_back({"of what was fed, loose rock that the swing before left", percent(dredging.layer_share)});
    if (run.operating_point.rock_share < 1.0) {
        rows.push_back({"fines, of what was cut (not followed)", percent(1.0 - run.operating_point.rock_share)});
        rows.push_back({"spillage of rock and fines, these as neutral rock", percent(dredging.spillage_with_fines)});
    }
    return html::table({"lost on its way", "share of what was fed"}, rows, true);
}

/// The mean of an average and, in small print, its error.
std::string error_detail(const TimeAverage& average, const char* unit) {
    return average.standard_error ? fmt::format("± {} standard error; ", number(average.standard_error, unit, 2)) : "";
}

std::string flow_answers(const Results& results) {
    const BinOutflow* strongest = nullptr;
    for (const BinOutflow& bin : results.outflow) {
        if (bin.radial_velocity && (!strongest || bin.radial_velocity->mean > strongest->radial_velocity->mean)) strongest = &bin;
    }
    std::string blocks;
    if (strongest) {
        blocks +=
            answer(palette::outflow, "Strongest mean radial velocity outside the contour", number(strongest->radial_velocity->mean, "m/s"),
                   error_detail(*strongest->radial_velocity, "m/s") + "bin: " + bin_text(strongest->bin.name));
    }
    const RotorLoads& rotor = results.rotor;
    blocks += answer(palette::flow_load, "Mean torque of the flow on the cutter", number(mean_of(rotor.torque_flow), "N m"),
                     rotor.torque_flow ? error_detail(*rotor.torque_flow, "N m") + over_revolutions(rotor) : over_revolutions(rotor));
    blocks += answer(palette::ink, "Revolutions computed", fmt::format("{:.2f}", rotor.revolutions),
                     fmt::format("up to t = {:.4g} s", results.end_time));
    return blocks;
}

/// Which limits acted, and in how many cells or on how many rocks of a step at most.
std::string limits_text(const Conservation& conservation) {
    struct Limit {
        std::optional<double> Conservation::*count;
        const char* told;
    };
    constexpr Limit limits[] = {
        {&Conservation::clipped_cells, "the turbulence model raised a field to its least value in up to {} cells of a step"},
        {&Conservation::overfull_cells, "up to {} cells of a step held more rock than they may, as none in reach had room"},
        {&Conservation::swept_limited_cells, "from up to {} cells of a step walls swept more rock than may be taken from a cell itself"},
        {&Conservation::wake_limited_rocks, "up to {} rocks of a step have a larger wake than is taken out of what they see"},
        {&Conservation::hidden_rocks, "up to {} rocks of a step lay in steel of the mesh and were mapped from the nearest cell"},
        {&Conservation::cramped_rocks, "up to {} rocks of a step in nooks of the mesh also lay in cells behind the steel"}};
    std::string text;
    for (const Limit& limit : limits) {
        const std::optional<double>& count = conservation.*limit.count;
        if (count.value_or(0.0) > 0.0) text += "; " + fmt::format(fmt::runtime(limit.told), number(count, "", 3));
    }
    return text;
}

std::string conservation_text(const Conservation& conservation) {
    std::string text;
    if (conservation.solid_volume) text += fmt::format("rock volume on the mesh {}, ", number(conservation.solid_volume, "", 2));
    if (conservation.momentum)
        text += fmt::format("momentum of rock and water {} of what rock exchanged, and {} lost or gained at the rotor interface, ",
                            number(conservation.momentum, "", 2), number(conservation.momentum_interface, "", 2));
    if (conservation.momentum_carried)
        text += fmt::format("momentum still owed to the water {} of what rock exchanged in the step (median of the steps with rock {}), ",
                            number(conservation.momentum_carried, "", 2), number(conservation.momentum_carried_median, "", 2));
    text += fmt::format(
        "water balance {} of the discharge, rotor interface {} of the flow through it in sum and {} face by face: largest "
        "relative error of all steps",
        number(conservation.flow_balance, "", 2), number(conservation.interface_imbalance, "", 2),
        number(conservation.interface_mismatch, "", 2));
    return text + limits_text(conservation);
}

std::string cost_text(const Cost& cost) {
    std::string text = fmt::format("{} wall time", duration(cost.wall_s));
    if (cost.ranks) text += fmt::format(" on {} rank{}", *cost.ranks, *cost.ranks == 1 ? "" : "s");
    if (cost.core_s) text += fmt::format(", {} of core time", duration(*cost.core_s));
    if (cost.core_s_per_revolution) text += fmt::format(" ({} per revolution)", duration(*cost.core_s_per_revolution));
    text += fmt::format("; {} time steps", cost.steps);
    if (cost.cells) text += fmt::format(" on {} cells", *cost.cells);
    return text;
}

std::string age_of_recording(const RecordedFlow& flow, double revolution) {
    std::string text = fmt::format("rock goes through the revolution up to number {} of {}", number(flow.end / revolution, "", 3),
                                   escape(flow.run.filename().string()));
    if (flow.change) text += fmt::format("; in it the flow in the turning zone changed by {}", percent(*flow.change));
    return text + ".";
}

/// \param revolutions  of the flow before the first rock
std::string age_of_flow(double revolutions) {
    const bool is_young = revolutions < k_developed_revolutions * (1.0 - 1e-6);  // but for rounding
    return fmt::format("rock comes at revolution {}; a flow forgets the frozen rotor from which it starts in some {:g} of them{}.",
                       number(revolutions, "", 3), k_developed_revolutions,
                       is_young ? ": in this one rock may go another way than at work" : "");
}

/// Of the rock.
std::string statistical_error(const RunData& run) {
    if (run.operating_point.fed_by_cutting)
        return fmt::format(
            "the interval is of one {0}'s time: it holds neither another placement of the rock nor the mesh. Three {0}s with "
            "other seeds ({1}) give that of placement.",
            run.flow ? "replay" : "run", run.flow ? "cutterflow replay -n 3" : "cutterflow sweep --repeats");
    return fmt::format(
        "no replicate: one batch, one placement. An interval needs three or more {} that vary placement and release angle; "
        "the bounds above are not an interval but the range of outcomes of the undecided rock.",
        run.flow ? "replays" : "repeats");
}

std::string trust_list(const Results& results, const RunData& run) {
    std::string items;
    const auto item = [&](const char* label, const std::string& text) {
        items += fmt::format("<li><b>{}</b><span>{}</span></li>", label, text);
    };
    if (results.spillage) item("Statistical error", statistical_error(run));
    if (run.flow)
        item("Age of the flow", age_of_recording(*run.flow, run.operating_point.revolution_s()));
    else if (results.spillage)
        item("Age of the flow", age_of_flow(results.spillage->feed_start / run.operating_point.revolution_s()));
    item("Mesh error", "not in this report: compare with the same study on a finer mesh preset before using a number as an absolute one.");
    item("Balances", conservation_text(results.conservation));
    item("Cost", cost_text(results.cost));
    return fmt::format("<ul class=\"trust\">{}</ul>\n", items);
}

std::string answers(const Results& results, const RunData& run) {
    const double revolution = run.operating_point.revolution_s();
    const auto blocks = [](const std::string& content) { return fmt::format("<div class=\"answers\">\n{}</div>\n", content); };
    if (!results.spillage) return blocks(flow_answers(results));
    if (!run.operating_point.fed_by_cutting) return blocks(rock_answers(results, revolution));
    if (!results.fed) return blocks(early_answers(results.spillage->fates));
    return blocks(fed_answers(*results.fed)) + fmt::format("<p>{}</p>\n", escape(limits_text(results))) + production_table(results, run) +
           losses_table(results, run);
}

/// What an engineer would find unusual about a head at work; nothing where there is nothing.
std::string practice_text(const Results& results, const RunData& run) {
    const std::vector<std::string>& outside = results.outside_usual_practice;
    if (outside.empty()) return "";
    return fmt::format(
        "<p>Outside of usual practice, in the prototype {:g} times as long, with the usual range in brackets: {}. The numbers hold for "
        "what "
        "was computed all the same.</p>\n",
        run.operating_point.length_ratio, escape(fmt::format("{}", fmt::join(outside, ", "))));
}

std::string answer_section(const Results& results, const RunData& run, const PageFigures& figures) {
    return answers(results, run) + practice_text(results, run) + plots_at(figures, Place::answer) +
           fmt::format("<p class=\"scope\">{}</p>\n", escape(scope_sentence(scope_of(run)))) + trust_list(results, run);
}

std::string head_figure(const Results& results, const RunData& run, const PageFigures& figures) {
    std::string caption =
        "Left: from the side, gravity downwards; backplate and suction pipe transparent<span class=\"hint\">; drag to turn, then wheel or "
        "two fingers to zoom</span>. Right: from the hub along the axis, "
        "lowest side down. The arrow shows the sense of rotation.";
    if (run.operating_point.has_bank) caption += " Brown: the soil that the head swings into, in the left picture only.";
    if (results.spillage && figures.head.rocks_shown > 0) {
        caption += fmt::format(" Rocks in true size at the last checkpoint or the end; {} of {} lie outside the left picture.",
                               figures.head.rocks_outside_view, figures.head.rocks_shown);
        caption = fate_legend(results.spillage->fates) + caption;
    }
    return html::figure(figures.head.markup + figures.head_from_hub, caption, "head wide");
}

std::string figure_section(const Results& results, const RunData& run, const PageFigures& figures) {
    return html::section(results.spillage ? "Where the rock goes, and why" : "The flow through the head",
                         "<div class=\"figures\">" + head_figure(results, run, figures) + plots_at(figures, Place::figures) + "</div>");
}

std::string series_table(const Spillage& spillage) {
    std::vector<std::vector<std::string>> rows;
    const auto add = [&](const std::vector<RatiosAt>& series, const char* unit) {
        for (const RatiosAt& at : series) {
            rows.push_back({fmt::format("{:g} {}", at.since_feed, unit), percent(at.ratios.ratio), percent(at.ratios.ratio_min),
                            percent(at.ratios.ratio_max), percent(at.ratios.undecided)});
        }
    };
    add(spillage.at_revolutions, "rev");
    add(spillage.at_seconds, "s");
    if (rows.empty()) return "<p>Less than one revolution and one second since the first rock.</p>";
    return html::table({"since the first rock", "ratio", "lower", "upper", "undecided"}, rows, true);
}

std::string bins_table(const Results& results) {
    std::vector<std::vector<std::string>> rows;
    const std::size_t count = results.exits ? results.exits->bins.size() : results.outflow.size();
    for (std::size_t i = 0; i < count; ++i) {
        const geometry::AxialBin& bin = results.exits ? results.exits->bins[i].bin : results.outflow[i].bin;
        const std::string range =
            std::isfinite(bin.z_min) ? fmt::format("{:.3f} to {:.3f}", bin.z_min, bin.z_max) : fmt::format("below {:.3f}", bin.z_max);
        std::vector<std::string> row{bin_text(bin.name), range};
        if (results.exits) {
            row.push_back(fmt::format("{}", results.exits->bins[i].spilled.count));
            row.push_back(fmt::format("{:.4g}", results.exits->bins[i].spilled.mass));
        }
        row.push_back(results.outflow.empty() ? k_dash : number(results.outflow[i].radial_velocity, ""));
        rows.push_back(row);
    }
    std::vector<std::string> header{"bin", "z, m"};
    if (results.spillage) header.insert(header.end(), {"spilled rocks", "spilled, kg"});
    header.emplace_back("radial velocity, m/s");
    return html::table(header, rows, true);
}

std::string rock_section(const Results& results, const RunData& run) {
    std::string content = fmt::format("<div class=\"tables\"><div><h3>By axial bin{}</h3>{}</div><div>",
                                      results.fed        ? " (of the last exit, in the window of the production)"
                                      : results.spillage ? " (of the last exit)"
                                                         : "",
                                      bins_table(results));
    if (results.spillage) {
        // Of a head that is fed all the time a ratio says nothing without the hold-up of its window.
        if (!run.operating_point.fed_by_cutting)
            content += "<h3>At equal revolutions and at equal time</h3>" + series_table(*results.spillage);
        content += "<h3>Feed</h3>" + html::table({},
                                                 {{"requested", fmt::format("{} rocks", results.rock_requested)},
                                                  {"placed", fmt::format("{} rocks", results.spillage->fates.placed.count)},
                                                  {"rejected", fmt::format("{} rocks", results.rock_rejected)}},
                                                 true);
        if (run.feed) {
            for (const std::string& reason : run.feed->reasons) content += fmt::format("<p>{}</p>", escape(reason));
            for (const RockClass& rock : run.feed->classes) {
                content += fmt::format("<p>{:g} rocks of {:.3g} mm, {:.0f} kg/m³, settling at {} in still water.</p>", rock.count,
                                       1e3 * rock.diameter, rock.density, number(rock.settling_velocity, "m/s"));
            }
        }
    }
    return html::section("The numbers behind the figures", content + "</div></div>");
}

/// A row of the operating table: model value and, by Froude's law, that of the prototype: value times ratio^power.
std::vector<std::string> scaled_row(const std::string& name, const std::string& unit, const std::optional<double>& value, double ratio,
                                    double power) {
    std::vector<std::string> row{fmt::format("{} [{}]", name, unit), number(value, "", 4)};
    if (ratio != 1.0) row.push_back(value ? number(*value * std::pow(ratio, power), "", 4) : std::string(k_dash));
    return row;
}

/// Those that are known, of rock, blades, swing and friction.
void add_numbers_at_work(std::vector<std::vector<std::string>>& rows, const ScaleNumbers& scale) {
    const auto add = [&](const char* name, const std::optional<double>& value, const char* unit = "") {
        if (value) rows.push_back({name, number(value, unit)});
    };
    add("settling number S<sub>t</sub> = u<sub>t</sub> / (Q / (π R²))", scale.settling_number);
    add("fall-through number F = u<sub>t</sub> cos λ 2π / (z ω w); above 1 rock falls between two blades", scale.fall_through);
    add("swing over rotor speed v<sub>h</sub> / (ω R)", scale.swing_ratio);
    add("bite over blade depth f<sub>z</sub> / w, f<sub>z</sub> = 2π v<sub>h</sub> / (ω z)", scale.bite_ratio);
    add("soil cut over discharge Q<sub>c</sub> / Q", scale.cut_ratio);
    add("blades’ angle less the ladder’s β − λ; below 0 rock slides to the hub on most of a rising blade", scale.blade_angle_less_ladder,
        "°");
    add("friction μ of rock on rock", scale.friction_rock);
    add("friction μ of rock on steel", scale.friction_steel);
    add("friction μ of rock on soil", scale.friction_soil);
}

std::string operation_section(const Results& results, const RunData& run) {
    const OperatingPoint& point = run.operating_point;
    const double ratio = point.length_ratio;
    std::vector<std::vector<std::string>> rows{
        scaled_row("rotor speed", "rpm", point.speed_rpm, ratio, -0.5),
        scaled_row("ring radius", "m", run.contour.ring_radius(), ratio, 1.0),
        scaled_row("tip speed", "m/s", point.angular_speed() * run.tip_radius(), ratio, 0.5),
        scaled_row("discharge Q of the mixture", "m³/s", point.discharge, ratio, 2.5),
        scaled_row("velocity in the suction pipe", "m/s", results.delivery.pipe_velocity, ratio, 0.5),
        scaled_row("mean torque of the flow", "N m", mean_of(results.rotor.torque_flow), ratio, 4.0)};
    if (results.spillage) rows.push_back(scaled_row("mean torque of the rock", "N m", mean_of(results.rotor.torque_rock), ratio, 4.0));
    rows.push_back(scaled_row("mean power of the drive", "W", mean_of(results.rotor.power), ratio, 3.5));
    if (results.spillage) {
        rows.push_back(scaled_row("delivered concentration by volume", "-", results.delivery.concentration, ratio, 0.0));
        rows.push_back(scaled_row("mixture density", "kg/m³", results.delivery.mixture_density, ratio, 0.0));
        rows.push_back(scaled_row("placed rock", "kg", results.spillage->fates.placed.mass, ratio, 3.0));
    }
    const std::string cutter = std::filesystem::path(run.geometry.value("file", std::string())).filename().string();
    const std::vector<std::vector<std::string>> layout{
        {"cutter", cutter.empty() ? k_dash : escape(cutter)},
        {"rotor direction about hub to ring", spaced(point.rotor_direction)},
        {"swing direction", point.swing_direction.empty() ? k_dash : spaced(point.swing_direction)},
        {"axis below horizontal", number(point.inclination_deg, "°", 4)},
        {"suction mouth: radius", number(point.mouth_radius, "m")},
        {"suction mouth: distance from the axis", number(point.mouth_offset, "m")},
        {"suction mouth: azimuth (0 lowest)", number(point.mouth_azimuth_deg, "°", 4)},
        {"gap between ring and backplate", number(run.contour.z_backplate(), "m")}};
    std::vector<std::string> header{"quantity", "as computed"};
    if (ratio != 1.0) header.push_back(fmt::format("Froude-scaled {:g}:1", ratio));
    const auto of_mixing = [&](double Mixing::*member) {
        return results.mixing ? std::optional<double>((*results.mixing).*member) : std::nullopt;
    };
    const std::optional<double> boundary_error = results.mixing ? results.mixing->balance_error : std::nullopt;
    std::string balance = number(boundary_error, "", 2);
    if (boundary_error.value_or(0.0) > k_most_boundary_error)
        balance = fmt::format("<span class=\"failed\">{}: do not trust q</span>", balance);
    std::vector<std::vector<std::string>> numbers{
        {"flow number Q / (ω R³)", number(results.scale.flow_number)},
        {"outflow over discharge q = Q<sub>out</sub> / Q", number(of_mixing(&Mixing::outflow_over_discharge), "")},
        {"spillage of neutral, well-mixed rock, q / (1 + q)", number(of_mixing(&Mixing::well_mixed_spillage), "")},
        {"balance of the head’s boundary, |Σ fluxes + Q| / Q", balance},
        {"Froude number ω² R / g", number(results.scale.froude)},
        {"settling ratio u<sub>t</sub> / (ω R)", number(results.scale.settling_ratio)},
        {"size ratio d / R", number(results.scale.size_ratio)}};
    add_numbers_at_work(numbers, results.scale);
    std::string content = "<div class=\"tables\"><div><h3>Quantities</h3>" + html::table(header, rows, true) +
                          "</div><div><h3>Scale numbers</h3>" + html::table({}, numbers, true);
    content += "<h3>Layout</h3>" + html::table({}, layout, true);
    content +=
        "<p>R ring radius, ω rotor speed, u<sub>t</sub> settling velocity and d diameter of the rock (mean by mass), λ inclination of the "
        "ladder, z number, w depth and β angle with the axis of the blades. ";
    if (results.spillage)
        content += point.fed_by_cutting
                       ? "Delivered concentration and density of the mixture: in the window of the production. "
                       : "Delivered concentration: volume of sucked up rock over the mixture discharged since the first rock. ";
    content += fmt::format("Torques and power: {}.</p>", over_revolutions(results.rotor));
    return html::section("Operating point and scale", content + "</div></div>");
}

std::string mesh_section(const RunData& run) {
    std::string content;
    if (!run.mesh.empty()) content += "<div>" + html::table({"mesh", ""}, value_rows(run.mesh), true) + "</div>";
    std::vector<std::vector<std::string>> gates;
    for (const json& gate : run.mesh.value("gates", json::array())) {
        const bool passed = gate.value("passed", false);
        gates.push_back({escape(gate.value("name", "")), json_text(gate.value("value", json())), json_text(gate.value("limit", json())),
                         passed ? "<span class=\"passed\">passed</span>" : "<span class=\"failed\">failed</span>"});
    }
    std::string right;
    if (!gates.empty()) right += html::table({"gate", "value", "limit", ""}, gates, true);
    for (const char* part : {"head", "surface"}) {
        const json values = run.geometry.value(part, json::object());
        if (!values.empty()) right += html::table({fmt::format("cutter: {}", part), ""}, value_rows(values), true);
    }
    return html::section("Mesh quality and geometry", "<div class=\"tables\">" + content + "<div>" + right + "</div></div>");
}

std::string model_section(const RunData& run) {
    std::vector<std::vector<std::string>> on, off;
    for (const json& model : run.cost_summary.value("models", json::array())) {
        on.push_back({escape(model.value("name", "")), escape(model.value("why", ""))});
    }
    for (const NotModelled& item : not_modelled(scope_of(run))) off.push_back({escape(item.name), escape(item.consequence)});
    std::string content =
        on.empty() ? "<p>The run has not yet written its active models.</p>" : html::table({"active model", "reason"}, on, false);
    content += "<h3>What is not modelled</h3>" + html::table({"", "what that means for the result"}, off, false);
    return html::section("Models", content);
}

std::string prediction_table(const Cost& cost) {
    if (!cost.predicted) return "";
    const auto row = [](const char* name, const std::string& predicted, const std::string& actual, double error) {
        return std::vector<std::string>{name, predicted, actual, fmt::format("{:+.0f} %", 100.0 * error)};
    };
    std::vector<std::vector<std::string>> rows;
    const PredictedCost& p = *cost.predicted;
    if (cost.cells)
        rows.push_back(
            row("cells", fmt::format("{:.0f}", p.cells), fmt::format("{}", *cost.cells), p.cells / static_cast<double>(*cost.cells) - 1.0));
    rows.push_back(
        row("time steps", fmt::format("{:.0f}", p.steps), fmt::format("{}", cost.steps), p.steps / static_cast<double>(cost.steps) - 1.0));
    if (cost.core_s)
        rows.push_back(row("core time of the solver", duration(p.core_s), duration(*cost.core_s), p.core_s / *cost.core_s - 1.0));
    return html::table({"for the time that the run went through", "predicted", "actual", "error"}, rows, true);
}

std::string cost_section(const Results& results, const RunData& run, const PageFigures& figures) {
    std::string content = plots_at(figures, Place::cost);
    if (content.empty()) content = cost_legend(results.cost);
    content += prediction_table(results.cost);
    std::vector<std::vector<std::string>> stages;
    const json recorded = run.manifest.value("stages", json::object());
    for (const char* name : {"geometry", "mesh", "case", "start", "run", "report"}) {
        const json stage = recorded.value(name, json());
        if (!stage.is_object()) continue;
        const bool done = stage.value("state", json()) == "done";
        const auto seconds = [&stage, done](const char* key) {
            const auto found = stage.find(key);
            return done && found != stage.end() && found->is_number() ? duration(found->get<double>()) : std::string(k_dash);
        };
        const bool is_solver = std::string(name) == "run" && results.cost.core_s;  // of all attempts, also those that were interrupted
        stages.push_back({name, json_text(stage.value("state", json(""))), seconds("wall_s"),
                          is_solver ? duration(*results.cost.core_s) : seconds("core_s")});
    }
    if (!stages.empty()) content += html::table({"stage", "state", "wall time", "core time"}, stages, true);
    return html::section("Cost by part", content);
}

std::string version_section(const json& versions) {
    if (versions.empty()) return "";
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, version] : versions.items()) rows.push_back({escape(name), json_text(version)});
    return html::section("Versions", html::table({}, rows, false));
}

}  // namespace

void write_report_page(const Page& page, const Results& results, const RunData& run, const PageFigures& figures) {
    const std::string title = run.operating_point.study_name.empty() ? std::string("Cutter head") : escape(run.operating_point.study_name);
    std::string body = header(results, run) + page.how_to_make_live("cutterflow report RUN");
    body += unfinished_notice(results, run.flow.has_value()) + html::notices(run.warnings);
    body += answer_section(results, run, figures);
    if (!figures.note.empty()) body += fmt::format("<p class=\"notice\">{}</p>\n", escape(figures.note));
    body += figure_section(results, run, figures) + rock_section(results, run) + figures.steel + operation_section(results, run);
    body += cost_section(results, run, figures) + mesh_section(run) + model_section(run);
    body += version_section(results_json(results, run).at("versions"));
    page.write(title, body, fmt::format("The same numbers for programs: results.json ({}).", k_results_schema));
}

}  // namespace cutterflow::postproc
