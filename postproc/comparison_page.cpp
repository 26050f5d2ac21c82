#include "postproc/comparison_page.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "postproc/gnuplot.hpp"
#include "postproc/head_picture.hpp"
#include "postproc/html.hpp"
#include "postproc/not_modelled.hpp"
#include "postproc/palette.hpp"
#include "postproc/text.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using html::escape;

/// Colours of settings, in order; told apart with any colour vision.
constexpr const char* k_colours[] = {"#0072b2", "#d55e00", "#00795c", "#a34b86", "#8a6d00", "#26303a", "#56b4e9", "#9aa3ab"};
constexpr int k_width = 540;

const char* colour_of(std::size_t setting) {
    return k_colours[setting % std::size(k_colours)];
}

const Quantity* find(const Comparison& comparison, const std::string& key) {
    const auto found =
        std::find_if(comparison.quantities.begin(), comparison.quantities.end(), [&](const Quantity& q) { return q.key == key; });
    return found == comparison.quantities.end() ? nullptr : &*found;
}

std::string number(double value) {
    return fmt::format("{:.6g}", value);
}

/// Bounds when there are some, else the interval, else the value itself.
std::pair<double, double> range_of(const Estimate& estimate) {
    if (estimate.low) return {*estimate.low, *estimate.high};
    const double half = estimate.half_width.value_or(0.0);
    return {*estimate.value - half, *estimate.value + half};
}

/// Shares by setting, with their bounds.
PlotScript shares_plot(const Comparison& comparison) {
    const Quantity* const shares[] = {find(comparison, "ratio"), find(comparison, "production")};
    const char* const colours[] = {palette::spilled, palette::sucked_up};
    PlotScript plot{"shares", k_width, 330, ""};
    std::vector<std::string> tics, curves;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) tics.push_back(fmt::format("\"{}\" {}", i + 1, i + 1));
    for (std::size_t s = 0; s < 2; ++s) {
        std::vector<std::vector<std::string>> rows;
        for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
            const Estimate& estimate = shares[s]->settings[i];
            if (!estimate.value) continue;
            const auto [low, high] = range_of(estimate);
            rows.push_back({number(static_cast<double>(i) + 0.92 + 0.16 * static_cast<double>(s)), number(100.0 * *estimate.value),
                            number(100.0 * low), number(100.0 * high)});
        }
        if (rows.empty()) continue;
        const std::string block = fmt::format("share{}", s);
        plot.commands += data_block(block, rows);
        curves.push_back(fmt::format("${} using 1:2:3:4 with yerrorbars pt 7 ps 0.8 lw 1.6 lc rgb \"{}\" title \"{}\"", block, colours[s],
                                     s == 0 ? "spillage ratio" : "production"));
    }
    plot.commands += fmt::format(
        "set xrange [0.5:{}.5]\nset yrange [0:100]\nset xtics ({})\nset xlabel \"setting\"\nset ylabel \"% by mass\"\n"
        "set key outside top center horizontal\n",
        comparison.settings.size(), fmt::join(tics, ", "));
    plot.commands += curves.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

/// Radial outflow of the bins, one curve a setting.
PlotScript outflow_plot(const Comparison& comparison) {
    std::vector<const Quantity*> bins;
    for (const Quantity& quantity : comparison.quantities)
        if (quantity.key.rfind("outflow_", 0) == 0) bins.push_back(&quantity);
    PlotScript plot{"outflow", k_width, 90 + 22 * static_cast<int>(bins.size()), ""};
    std::vector<std::string> tics, curves;
    for (std::size_t b = 0; b < bins.size(); ++b) {
        const std::string name = bins[b]->key.substr(8, bins[b]->key.size() - 8 - 4);
        tics.push_back(fmt::format("{} {}", quoted(name == "below_hub" ? "below hub" : name), -static_cast<int>(b)));
    }
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        std::vector<std::vector<std::string>> rows;
        for (std::size_t b = 0; b < bins.size(); ++b) {
            const Estimate& estimate = bins[b]->settings[i];
            if (estimate.value)
                rows.push_back({number(*estimate.value), number(-static_cast<double>(b)), number(estimate.half_width.value_or(0.0))});
        }
        if (rows.empty()) continue;
        plot.commands += data_block(fmt::format("bins{}", i), rows);
        curves.push_back(
            fmt::format("$bins{} using 1:2:3 with xerrorlines pt 7 ps 0.5 lw 1.4 lc rgb \"{}\" title \"{}\"", i, colour_of(i), i + 1));
    }
    plot.commands += fmt::format(
        "set ytics ({}) scale 0\nset yrange [{}:0.6]\nset xlabel \"mean radial velocity just outside the contour, m/s (outwards "
        "positive)\"\n"
        "set arrow 1 from 0,graph 0 to 0,graph 1 nohead lc rgb \"{}\" lw 1\nset key outside top center horizontal title \"setting\"\n",
        fmt::join(tics, ", "), 0.4 - static_cast<double>(bins.size()), palette::faint);
    plot.commands += curves.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(curves, ", "));
    return plot;
}

std::string estimate_markup(const Estimate& estimate) {
    if (!estimate.value) return text::k_dash;
    std::string markup = text::digits_of(*estimate.value, 4);
    if (estimate.half_width) markup += " ± " + text::digits_of(*estimate.half_width, 2);
    if (estimate.low) markup += fmt::format("<br>{:.3f} … {:.3f}", *estimate.low, *estimate.high);
    return markup;
}

std::string quantities_table(const Comparison& comparison) {
    std::vector<std::string> header{"quantity"};
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) header.push_back(fmt::format("{}", i + 1));
    std::vector<std::vector<std::string>> rows;
    for (const Quantity& quantity : comparison.quantities) {
        rows.push_back({escape(quantity.name) + (quantity.unit == "-" ? "" : " [" + quantity.unit + "]")});
        for (const Estimate& estimate : quantity.settings) rows.back().push_back(estimate_markup(estimate));
    }
    return html::table(header, rows, true);
}

std::string differences_table(const Comparison& comparison) {
    static const std::set<std::string> given{
        "speed_rpm", "discharge_m3_s",        "flow_number",           "cells", "placed", "revolutions_since_feed",
        "undecided", "core_s_per_revolution", "flow_balance_max_error"};
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
    return html::table(header, rows, true);
}

std::string settings_table(const Comparison& comparison) {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        const Setting& setting = comparison.settings[i];
        const RunData& run = comparison.runs[setting.runs.front()].run;
        const bool finished =
            std::all_of(setting.runs.begin(), setting.runs.end(), [&](std::size_t r) { return comparison.runs[r].results.finished; });
        rows.push_back({fmt::format("<i style=\"background: {}\"></i>{}", colour_of(i), i + 1), escape(setting.label),
                        escape(fs::path(run.geometry.value("file", std::string())).filename().string()),
                        escape(run.operating_point.mesh_preset), fmt::format("{}", setting.runs.size()),
                        finished ? "yes" : "<span class=\"failed\">no</span>"});
    }
    return "<div class=\"legend\">" + html::table({"setting", "name", "cutter", "mesh", "runs", "finished"}, rows, false) + "</div>";
}

std::string heads(const Comparison& comparison) {
    std::string content;
    for (std::size_t i = 0; i < comparison.settings.size(); ++i) {
        const RunData& run = comparison.runs[comparison.settings[i].runs.front()].run;
        content += html::figure(draw_head(run).side_view,
                                fmt::format("Setting {}: {}. Rock by fate at the end.", i + 1, escape(comparison.settings[i].label)));
    }
    return html::section("The heads and their rock", "<div class=\"figures\">" + content + "</div>");
}

std::string plots(const Comparison& comparison, const fs::path& scratch) {
    if (!gnuplot_is_installed()) return "<p class=\"notice\">Plots are missing: the program gnuplot was not found.</p>";
    std::string content;
    if (find(comparison, "ratio"))
        content += html::figure(draw_svg(shares_plot(comparison), scratch),
                                "Spillage ratio and production; the bars are bounds: what the undecided rock could still do.");
    content += html::figure(
        draw_svg(outflow_plot(comparison), scratch),
        "Radial velocity just outside the contour by axial bin, averaged over azimuth and time; bars: 95 % interval by batch means.");
    fs::remove_all(scratch);
    return "<div class=\"figures\">" + content + "</div>";
}

bool has_repeats(const Comparison& comparison) {
    return std::any_of(comparison.settings.begin(), comparison.settings.end(),
                       [](const Setting& s) { return s.runs.size() >= k_fewest_repeats; });
}

}  // namespace

fs::path write_comparison(const Comparison& comparison, const fs::path& folder) {
    const fs::path page = folder / "index.html", document = folder / "comparison.json";
    if (fs::exists(folder) && !fs::is_empty(folder) && !fs::exists(document))
        throw UserError(fmt::format("{} holds files that are not of a comparison", folder.string()), "Nothing is overwritten",
                        "Name another folder");
    fs::create_directories(folder);
    const bool with_rock = find(comparison, "ratio") != nullptr;
    const std::string title = fmt::format("Comparison of {} settings", comparison.settings.size());
    std::string body = fmt::format("<header><h1>{}</h1></header>\n", title) + settings_table(comparison);
    body += fmt::format("<p class=\"scope\">{}</p>\n", escape(scope_sentence(with_rock)));
    if (with_rock && !has_repeats(comparison))
        body +=
            "<p>No replicate: each setting is one batch. The ranges are bounds by the undecided rock, not intervals; three or more repeats "
            "of a setting give intervals.</p>\n";
    body += plots(comparison, folder / "plots.part");
    body += html::section("The numbers",
                          quantities_table(comparison) +
                              "<p>± half the 95 % interval: Student’s t over repeats for what rock does, batch means in time for the flow. "
                              "Second line: bounds, whatever the undecided rock does.</p>");
    body += html::section("Differences from setting 1", differences_table(comparison));
    body += heads(comparison);
    write_file(document, comparison_json(comparison).dump(2) + "\n");
    write_file(page, html::document(title, body, fmt::format("The same numbers for programs: comparison.json ({}).", k_comparison_schema)));
    return page;
}

}  // namespace cutterflow::postproc
