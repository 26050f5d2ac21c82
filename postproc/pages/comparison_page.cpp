#include "postproc/pages/comparison_page.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "postproc/analysis/best_speed.hpp"
#include "postproc/analysis/not_modelled.hpp"
#include "postproc/analysis/text.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/palette.hpp"
#include "postproc/pages/adv_trend.hpp"
#include "postproc/pages/comparison_figures.hpp"
#include "postproc/pages/head_picture.hpp"
#include "postproc/pages/own_document.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using html::escape;

constexpr const char* k_document = "comparison.json";

std::string estimate_markup(const Estimate& estimate) {
    const std::string bounds = estimate.low ? fmt::format("{:.3f} … {:.3f}", *estimate.low, *estimate.high) : "";
    if (!estimate.value) return bounds.empty() ? text::k_dash : bounds;
    std::string markup = is_count(*estimate.value) ? fmt::format("{:.0f}", *estimate.value) : text::digits_of(*estimate.value, 4);
    if (estimate.half_width) markup += " ± " + text::digits_of(*estimate.half_width, 2);
    return bounds.empty() ? markup : markup + "<br>" + bounds;
}

/// What the rows are, then the number of each setting.
std::vector<std::string> settings_header(const char* rows, const Comparison& comparison) {
    std::vector<std::string> header{rows};
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) header.push_back(fmt::format("{}", i + 1));
    return header;
}

std::string quantities_table(const Comparison& comparison) {
    std::vector<std::vector<std::string>> rows;
    for (const Quantity& quantity : comparison.quantities) {
        rows.push_back({escape(quantity.name) + (quantity.unit == "-" ? "" : " [" + quantity.unit + "]")});
        for (const Estimate& estimate : quantity.settings) rows.back().push_back(estimate_markup(estimate));
    }
    return html::scrolling(html::table(settings_header("quantity", comparison), rows, true));
}

std::string differences_table(const Comparison& comparison) {
    static const std::set<std::string> given{"speed_rpm",
                                             "discharge_m3_s",
                                             "swing_speed_m_min",
                                             "flow_number",
                                             "cells",
                                             "froude",
                                             "settling_ratio",
                                             "size_ratio",
                                             "settling_number",
                                             "fall_through",
                                             "swing_over_rotor_speed",
                                             "bite_over_blade_depth",
                                             "cut_over_discharge",
                                             "blade_angle_less_ladder_deg",
                                             "friction_rock",
                                             "friction_steel",
                                             "friction_soil",
                                             "cut_height_m",
                                             "step_m",
                                             "pipe_velocity_m_s",
                                             "flow_revolutions",
                                             "flow_change",
                                             "placed",
                                             "revolutions_since_feed",
                                             "undecided",
                                             "core_s_per_revolution",
                                             "flow_balance_max_error"};
    std::vector<std::string> header{"quantity"};
    for (std::size_t i = 1; i < comparison.settings.size(); ++i) header.push_back(fmt::format("{} − 1", i + 1));
    std::vector<std::vector<std::string>> rows;
    for (const Quantity& quantity : comparison.quantities) {
        if (given.count(quantity.key) > 0) continue;
        rows.push_back({escape(quantity.name) + (quantity.unit == "-" ? "" : " [" + quantity.unit + "]")});
        for (std::size_t i = 1; i < comparison.settings.size(); ++i) {
            const Difference difference = difference_of(comparison, quantity, i);
            rows.back().push_back(difference.estimate.value
                                      ? estimate_markup(difference.estimate) + "<br>" + verdict_text(difference.verdict)
                                      : std::string(text::k_dash));
        }
    }
    return html::scrolling(html::table(header, rows, true));
}

/// Settings beside tests of the same speed and discharge; nothing without tests.
std::string measured_section(const Comparison& comparison) {
    if (comparison.measured.empty()) return "";
    std::vector<std::vector<std::string>> rows;
    for (const MeasuredDifference& beside : measured_differences(comparison)) {
        const Quantity& quantity = *find_quantity(comparison, beside.key);
        const Estimate test{beside.measured.value, std::nullopt, std::nullopt, beside.measured.error};
        rows.push_back({fmt::format("{}", beside.setting + 1), escape(beside.series), escape(quantity.name), estimate_markup(test),
                        estimate_markup(quantity.settings[beside.setting]),
                        estimate_markup(beside.difference.estimate) + "<br>" + verdict_text(beside.difference.verdict)});
    }
    const std::string content =
        rows.empty()
            ? std::string("<p>No setting has the speed (and discharge) of a test within 0.5 %.</p>")
            : html::scrolling(html::table({"setting", "test", "quantity", "measured", "computed", "computed − measured"}, rows, true));
    return html::section("Beside the tests", content);
}

std::string settings_table(const Comparison& comparison) {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        const ComparedSetting& setting = comparison.settings[i];
        const RunData& run = comparison.runs[setting.runs.front()].run;
        const bool finished =
            std::all_of(setting.runs.begin(), setting.runs.end(), [&](std::size_t r) { return comparison.runs[r].results.finished; });
        rows.push_back({fmt::format("<i style=\"background: {}\"></i>{}", setting_colour(i), i + 1),
                        fmt::format("<span class=\"name\">{}</span>", escape(setting.label)),
                        escape(fs::path(run.geometry.value("file", std::string())).filename().string()),
                        escape(run.operating_point.mesh_preset), fmt::format("{}", setting.runs.size()),
                        finished ? "yes" : "<span class=\"failed\">no</span>"});
    }
    return "<div class=\"legend settings\">" + html::table({"setting", "name", "cutter", "mesh", "runs", "finished"}, rows, false) +
           "</div>";
}

/// A column of the table of operating points.
struct PointColumn {
    const char* key;
    const char* title;
    double factor;    ///< from the quantity's unit to the column's
    double exponent;  ///< of the length ratio, by Froude's law
};
constexpr PointColumn k_point_columns[] = {{"speed_rpm", "rpm", 1.0, -0.5},
                                           {"swing_speed_m_min", "swing, m/min", 1.0, 0.5},
                                           {"discharge_m3_s", "Q, m³/s", 1.0, 2.5},
                                           {"cut_height_m", "cut, m", 1.0, 1.0},
                                           {"step_m", "step, m", 1.0, 1.0},
                                           {"cut_in_situ_m3_h", "cut in situ, m³/h", 1.0, 2.5},
                                           {"delivered_in_situ_m3_h", "delivered in situ, m³/h", 1.0, 2.5},
                                           {"delivered_kg_s", "delivered rock, t/h", 3.6, 2.5},
                                           {"ratio", "spillage, %", 100.0, 0.0},
                                           {"spillage_with_fines", "spillage with fines, %", 100.0, 0.0},
                                           {"spilled_mixing_share", "mixing, %", 100.0, 0.0},
                                           {"spilled_cutting_share", "cutting, %", 100.0, 0.0},
                                           {"left_behind_share", "left behind, %", 100.0, 0.0},
                                           {"left_behind_cutting_share", "of that by cutting, %", 100.0, 0.0},
                                           {"hold_up_kg", "hold-up, kg", 1.0, 3.0},
                                           {"mixture_density_kg_m3", "mixture, kg/m³", 1.0, 0.0},
                                           {"concentration", "C<sub>vd</sub>, %", 100.0, 0.0},
                                           {"pipe_velocity_m_s", "mouth, m/s", 1.0, 0.5},
                                           {"largest_delivered_m", "largest rock, mm", 1e3, 1.0},
                                           {"spill_layer_m", "spill layer at most, m", 1.0, 1.0},
                                           {"next_layer_m", "next swing’s layer, m", 1.0, 1.0},
                                           {"torque_flow_mean_n_m", "torque flow, kN m", 1e-3, 4.0},
                                           {"torque_rock_mean_n_m", "torque rock, kN m", 1e-3, 4.0},
                                           {"cutting_torque_n_m", "torque cutting, kN m", 1e-3, 3.0},
                                           {"power_mean_w", "power flow and rock, kW", 1e-3, 3.5},
                                           {"cutting_power_w", "power cutting, kW", 1e-3, 2.5},
                                           {"energy_in_situ_j_m3", "MJ per delivered m³", 1e-6, 1.0},
                                           {"flow_number", "θ", 1.0, 0.0},
                                           {"froude", "ω²R/g", 1.0, 0.0},
                                           {"settling_ratio", "u<sub>t</sub>/(ωR)", 1.0, 0.0},
                                           {"size_ratio", "d/R", 1.0, 0.0},
                                           {"settling_number", "S<sub>t</sub>", 1.0, 0.0},
                                           {"fall_through", "F", 1.0, 0.0},
                                           {"swing_over_rotor_speed", "v<sub>h</sub>/(ωR)", 1.0, 0.0},
                                           {"bite_over_blade_depth", "f<sub>z</sub>/w", 1.0, 0.0},
                                           {"cut_over_discharge", "Q<sub>c</sub>/Q, %", 100.0, 0.0},
                                           {"blade_angle_less_ladder_deg", "β − λ, °", 1.0, 0.0},
                                           {"friction_rock", "μ rock on rock", 1.0, 0.0},
                                           {"friction_steel", "μ rock on steel", 1.0, 0.0},
                                           {"friction_soil", "μ rock on soil", 1.0, 0.0},
                                           {"well_mixed_spillage", "S<sub>mix</sub>, %", 100.0, 0.0},
                                           {"head_is_full", "full", 1.0, 0.0}};

Estimate scaled(Estimate estimate, double factor) {
    for (auto* number : {&estimate.value, &estimate.low, &estimate.high, &estimate.half_width})
        if (*number) *number = factor * **number;
    return estimate;
}

std::string points_table(const Comparison& comparison, double length_ratio) {
    std::vector<std::string> header{"setting"};
    std::vector<const PointColumn*> columns;
    for (const PointColumn& column : k_point_columns) {
        const Quantity* quantity = find_quantity(comparison, column.key);
        const auto is_known = [](const Estimate& estimate) { return estimate.value || estimate.low; };
        if (!quantity || std::none_of(quantity->settings.begin(), quantity->settings.end(), is_known)) continue;
        columns.push_back(&column);
        header.emplace_back(column.title);
    }
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        rows.push_back({fmt::format("{}", i + 1)});
        for (const PointColumn* column : columns) {
            const double factor = column->factor * std::pow(length_ratio, column->exponent);
            rows.back().push_back(estimate_markup(scaled(find_quantity(comparison, column->key)->settings[i], factor)));
        }
    }
    return html::scrolling(html::table(header, rows, true));
}

/// Every operating point of heads that are fed all the time in one line, in the model and, where all have the same, in the prototype.
std::string points_section(const Comparison& comparison) {
    std::string content = points_table(comparison, 1.0);
    const double ratio = comparison.runs.front().run.operating_point.length_ratio;
    const bool same = std::all_of(comparison.runs.begin(), comparison.runs.end(),
                                  [&](const ComparedRun& r) { return r.run.operating_point.length_ratio == ratio; });
    if (same && ratio != 1.0)
        content += fmt::format("<h3>Prototype, {:g} times as long, by Froude’s law</h3>", ratio) + points_table(comparison, ratio);
    content +=
        "<p>θ = Q/(ωR³); S<sub>t</sub> = u<sub>t</sub>/(Q/(πR²)); F = u<sub>t</sub> cos λ 2π/(zωw), λ the ladder’s inclination, z blades "
        "of depth w; f<sub>z</sub> = 2πv<sub>h</sub>/(ωz); Q<sub>c</sub> the soil cut; β the blades’ angle with the axis; "
        "S<sub>mix</sub>: spillage of neutral, well-mixed rock; d and u<sub>t</sub> are means by mass of the feed. Spillage with fines "
        "takes these as such rock. Spill layer: all that is spilled on one step’s width, the most that swings leave in the end; the next "
        "swing’s: on all that the head passed (bed.spill_layer_m). Torque and power of cutting only where soil.specific_energy_mj_m3 is "
        "given; it is the same energy per volume in the prototype.</p>";
    return html::section("The operating points", content);
}

std::string best_speeds(const Comparison& comparison) {
    std::string content;
    for (const std::string& sentence : best_speed_text(comparison)) content += fmt::format("<p><b>{}</b></p>\n", escape(sentence));
    return content;
}

/// Keys that differ between the studies, with the sizes derived from them.
std::string studies_table(const Comparison& comparison) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& [key, values] : differing_keys(comparison)) {
        rows.push_back({escape(key)});
        for (const std::string& value : values) rows.back().push_back(value.empty() ? std::string(text::k_dash) : escape(value));
    }
    return html::scrolling(html::table(settings_header("key", comparison), rows, true));
}

std::string heads(const Comparison& comparison, Page& page) {
    std::string content;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        const RunData& run = comparison.runs[comparison.settings[i].runs.front()].run;
        const HeadPicture head = draw_head_from_side(run, page, fmt::format("head_{}", i + 1));
        const std::string rock = head.rocks_shown > 0
                                     ? fmt::format(" Rock by fate at the end, in true size; {} of {} lie outside the picture.",
                                                   head.rocks_outside_view, head.rocks_shown)
                                     : "";
        content += html::figure(head.markup, fmt::format("Setting {}: {}.{}", i + 1, escape(comparison.settings[i].label), rock));
    }
    const std::string legend = find_quantity(comparison, quantity::k_spillage) ? html::legend({{palette::spilled, "spilled"},
                                                                                               {palette::in_cutter, "in cutter"},
                                                                                               {palette::never_entered, "never entered"},
                                                                                               {palette::sucked_up, "sucked up"}})
                                                                               : "";
    const std::string caption =
        "<p>From the side, gravity downwards; backplate and suction pipe transparent<span class=\"hint\">; drag to turn, then wheel or two "
        "fingers to zoom</span>.</p>";
    return html::section("The heads and their rock", caption + legend + "<div class=\"figures\">" + content + "</div>");
}

std::string plots(const Comparison& comparison, const Page& page) {
    if (!gnuplot_is_installed()) return "<p class=\"notice\">Plots are missing: the program gnuplot was not found.</p>";
    std::string content;
    for (const Figure& figure : comparison_figures(comparison)) content += page.draw(figure);
    return "<div class=\"figures\">" + content + "</div>";
}

/// Said on top when settings had different rock: then a difference may be that of the rock.
std::string batches_notice(const Comparison& comparison) {
    const std::vector<std::string> batches = differing_batches(comparison);
    if (batches.empty()) return "";
    std::string items;
    for (std::size_t i = 0; i < batches.size(); ++i) items += fmt::format("<br>Setting {}: {}.", i + 1, escape(batches[i]));
    return fmt::format(
        "<p class=\"notice\"><b>Different batches of rock.</b> A difference between these settings may be one of their rock.{}</p>\n",
        items);
}

/// The runs that an earlier comparison.json compares; none when it is no such document.
std::set<std::string> runs_of(const nlohmann::json& document) {
    std::set<std::string> runs;
    if (document.value("schema", nlohmann::json()) != k_comparison_schema) return runs;
    for (const nlohmann::json& setting : document.value("settings", nlohmann::json::array()))
        if (setting.is_object())
            for (const nlohmann::json& run : setting.value("runs", nlohmann::json::array()))
                if (run.is_string()) runs.insert(run.get<std::string>());
    return runs;
}

bool has_repeats(const Comparison& comparison) {
    return std::any_of(comparison.settings.begin(), comparison.settings.end(),
                       [](const ComparedSetting& s) { return s.runs.size() >= k_fewest_repeats; });
}

}  // namespace

void require_own_comparison(const Comparison& comparison, const fs::path& folder) {
    std::set<std::string> runs;
    for (const ComparedRun& compared : comparison.runs) runs.insert(compared.run.directory.string());
    require_own_document(folder, k_document, [&](const nlohmann::json& earlier) { return runs_of(earlier) == runs; });
}

fs::path write_comparison(const Comparison& comparison, const fs::path& folder, PageForm form) {
    const fs::path file = folder / "index.html", document = folder / k_document;
    fs::create_directories(folder);
    Page page(file, form);
    const bool with_rock = find_quantity(comparison, quantity::k_spillage) != nullptr;
    const std::string title = fmt::format("Comparison of {} settings", comparison.settings.size());
    std::string body = fmt::format("<header><h1>{}</h1></header>\n", title) + page.how_to_make_live("cutterflow compare RUN... -o FOLDER") +
                       batches_notice(comparison) + settings_table(comparison);
    body += fmt::format("<p class=\"scope\">{}</p>\n", escape(scope_sentence(scope_of(comparison))));
    if (scope_of(comparison).fed_by_cutting)
        body +=
            "<p>Each head is fed all the time: ± is the 95 % interval of batch means in time, or, with three or more repeats, that of "
            "their scatter. Where the hold-up still changes, spillage has bounds only. No share is to be read without its hold-up.</p>\n";
    else if (with_rock && !has_repeats(comparison))
        body +=
            "<p>No replicate: each setting is one batch. The ranges are bounds by the undecided rock, not intervals; three or more repeats "
            "of a setting give intervals.</p>\n";
    if (scope_of(comparison).fed_by_cutting) body += best_speeds(comparison) + points_section(comparison);
    body += plots(comparison, page);
    body += html::section("The numbers",
                          quantities_table(comparison) +
                              "<p>± half the 95 % interval: Student’s t over repeats for what rock does, batch means in time for the flow. "
                              "Second line: bounds, whatever the undecided rock does.</p>");
    body += measured_section(comparison);
    body += html::section("Differences from setting 1", differences_table(comparison));
    body += html::section("What the studies differ in", studies_table(comparison));
    std::vector<fs::path> directories;
    for (const ComparedRun& compared : comparison.runs) directories.push_back(compared.run.directory);
    const std::vector<AdvTrend> velocities = read_adv_trends(directories);
    body += adv_trend_section(velocities, page) + heads(comparison, page);
    nlohmann::json numbers = comparison_json(comparison);
    if (!velocities.empty()) numbers["velocities_at_points"] = adv_trend_json(velocities);
    write_file(document, numbers.dump(2) + "\n");
    page.write(title, body, fmt::format("The same numbers for programs: comparison.json ({}).", k_comparison_schema));
    return file;
}

}  // namespace cutterflow::postproc
