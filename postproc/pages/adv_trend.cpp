#include "postproc/pages/adv_trend.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "geometry/base/json_document.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/analysis/adv_comparison.hpp"
#include "postproc/analysis/text.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::array<const char*, 3> k_colours{palette::outflow, palette::sucked_up, palette::spilled};

constexpr const char* k_report_again = "Make the report of that run again";

/// What a trend takes from adv.json.
std::vector<JsonField> document_fields() {
    std::vector<JsonField> fields{
        {"speed_rpm", JsonKind::number, true}, {"discharge_m3_s", JsonKind::number, true}, {"points/*/name", JsonKind::text, true}};
    for (const AdvComponent c : k_adv_components)
        for (const char* value : {"measured_m_s", "model_m_s", "position_bar_m_s"})
            fields.push_back({fmt::format("points/*/{}/{}", adv_component_name(c), value), JsonKind::number_or_null, true});
    return fields;
}

std::optional<double> optional_of(const json& value) {
    return value.is_number() ? std::optional<double>(value.get<double>()) : std::nullopt;
}

json json_of(const std::optional<double>& value) {
    return value ? json(*value) : json(nullptr);
}

std::size_t speeds_of(const AdvTrend& trend) {
    std::set<double> speeds;
    for (const AdvTrendValue& value : trend.values) speeds.insert(value.speed_rpm);
    return speeds.size();
}

/// The three components of one point. \param index  of the point on the page
Figure trend_figure(const std::vector<AdvTrend>& trends, std::size_t first, std::size_t index) {
    Plot plot;
    plot.name = fmt::format("adv_{}", index);
    plot.height = 250;
    plot.x.title = "rotor speed, rpm";
    plot.y.title = "velocity, m/s";
    plot.y.tip = {".3f", " m/s"};
    for (std::size_t c = 0; c < k_adv_components.size(); ++c) {
        const std::string& name = trends[first + c].component;
        Series model{name, k_colours[c], {}, {}}, measured{"", k_colours[c], {}, {}};
        model.line_width = 1.6;
        model.mark = Mark::disc;
        model.mark_size = 3.0;
        measured.mark = Mark::disc;
        measured.mark_size = 9.0;
        for (const AdvTrendValue& v : trends[first + c].values) {
            if (v.model) {
                const double bar = v.position_bar.value_or(0.0);
                model.x.push_back(v.speed_rpm);
                model.y.push_back(*v.model);
                model.y_low.push_back(*v.model - bar);
                model.y_high.push_back(*v.model + bar);
            }
            if (v.measured) {
                measured.x.push_back(v.speed_rpm);
                measured.y.push_back(*v.measured);
            }
        }
        for (const Series& series : {model, measured})
            if (!series.x.empty()) plot.series.push_back(series);
    }
    return {plot, html::escape(trends[first].point), ""};
}

/// An operating point of the sweep: speed [rpm], discharge [m3/s].
using Operation = std::pair<double, double>;

std::vector<Operation> operations_of(const std::vector<AdvTrend>& trends) {
    std::set<Operation> operations;
    for (const AdvTrend& trend : trends)
        for (const AdvTrendValue& value : trend.values) operations.emplace(value.speed_rpm, value.discharge);
    return {operations.begin(), operations.end()};
}

std::string cell(const AdvTrendValue& value) {
    std::string markup = value.model ? fmt::format("{:.3f}", *value.model) : std::string(text::k_dash);
    if (value.model && value.position_bar) markup += fmt::format(" ± {:.3f}", *value.position_bar);
    if (value.measured) markup += fmt::format("<br>({:.3f})", *value.measured);
    return markup;
}

bool is_measured(const std::vector<AdvTrend>& trends) {
    return std::any_of(trends.begin(), trends.end(), [](const AdvTrend& trend) {
        return std::any_of(trend.values.begin(), trend.values.end(), [](const AdvTrendValue& value) { return value.measured.has_value(); });
    });
}

/// A row for every point and component, a column for every operating point.
std::string trend_table(const std::vector<AdvTrend>& trends) {
    const std::vector<Operation> operations = operations_of(trends);
    const bool one_discharge =
        std::all_of(operations.begin(), operations.end(), [&](const Operation& o) { return o.second == operations.front().second; });
    std::vector<std::string> header{"point", "component"};
    for (const auto& [speed, discharge] : operations)
        header.push_back(one_discharge ? fmt::format("{:g} rpm", speed) : fmt::format("{:g} rpm, {:g} m³/s", speed, discharge));
    std::vector<std::vector<std::string>> rows;
    for (const AdvTrend& trend : trends) {
        std::vector<std::string> row{html::escape(trend.point), trend.component};
        for (const Operation& operation : operations) {
            const auto found = std::find_if(trend.values.begin(), trend.values.end(), [&](const AdvTrendValue& value) {
                return Operation(value.speed_rpm, value.discharge) == operation;
            });
            row.push_back(found == trend.values.end() ? std::string(text::k_dash) : cell(*found));
        }
        rows.push_back(row);
    }
    return html::scrolling(html::table(header, rows, true));
}

}  // namespace

std::vector<AdvTrend> read_adv_trends(const std::vector<fs::path>& run_directories) {
    std::vector<AdvTrend> trends;
    for (const fs::path& directory : run_directories) {
        const fs::path file = directory / names::adv_json;
        if (!fs::exists(file)) continue;
        if (read_json_document(file, {{"schema", JsonKind::text, true}}, k_report_again).at("schema") != k_adv_schema) continue;
        const json document = read_json_document(file, document_fields(), k_report_again);
        for (const json& point : document.at("points"))
            for (const AdvComponent c : k_adv_components) {
                const std::string name = point.at("name"), component = adv_component_name(c);
                auto trend = std::find_if(trends.begin(), trends.end(),
                                          [&](const AdvTrend& t) { return t.point == name && t.component == component; });
                if (trend == trends.end()) trend = trends.insert(trends.end(), AdvTrend{name, component, {}});
                const json& v = point.at(component);
                trend->values.push_back({document.at("speed_rpm"), document.at("discharge_m3_s"), optional_of(v.at("measured_m_s")),
                                         optional_of(v.at("model_m_s")), optional_of(v.at("position_bar_m_s"))});
            }
    }
    trends.erase(std::remove_if(trends.begin(), trends.end(), [](const AdvTrend& t) { return speeds_of(t) < 2; }), trends.end());
    for (AdvTrend& trend : trends)
        std::stable_sort(trend.values.begin(), trend.values.end(),
                         [](const AdvTrendValue& a, const AdvTrendValue& b) { return a.speed_rpm < b.speed_rpm; });
    return trends;
}

std::string adv_trend_section(const std::vector<AdvTrend>& trends, const Page& page) {
    if (trends.empty()) return "";
    const bool measured = is_measured(trends);
    std::string figures;
    for (std::size_t first = 0; gnuplot_is_installed() && first < trends.size(); first += k_adv_components.size())
        figures += page.draw(trend_figure(trends, first, first / k_adv_components.size()));
    const std::string reading = fmt::format(
        "<p>Mean velocity of the water at named points, in m/s: lines are the model, with bars for the error of the point’s "
        "position{}.</p>\n",
        measured ? "; discs, and numbers in brackets, the measurement" : ". Nothing was measured at these points");
    return html::section("Velocities at points against speed",
                         reading + "<div class=\"figures\">" + figures + "</div>" + trend_table(trends));
}

json adv_trend_json(const std::vector<AdvTrend>& trends) {
    json all = json::array();
    for (const AdvTrend& trend : trends) {
        json values = json::array();
        for (const AdvTrendValue& v : trend.values)
            values.push_back({{"speed_rpm", v.speed_rpm},
                              {"discharge_m3_s", v.discharge},
                              {"measured_m_s", json_of(v.measured)},
                              {"model_m_s", json_of(v.model)},
                              {"position_bar_m_s", json_of(v.position_bar)}});
        all.push_back({{"point", trend.point}, {"component", trend.component}, {"values", values}});
    }
    return all;
}

}  // namespace cutterflow::postproc
