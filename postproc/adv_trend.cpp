#include "postproc/adv_trend.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/run_names.hpp"
#include "postproc/adv_comparison.hpp"
#include "postproc/gnuplot.hpp"
#include "postproc/html.hpp"
#include "postproc/palette.hpp"
#include "postproc/text.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::array<const char*, 3> k_colours{palette::outflow, palette::sucked_up, palette::spilled};

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

/// The three components of one point.
PlotScript trend_plot(const std::vector<AdvTrend>& trends, std::size_t first, std::size_t index) {
    PlotScript plot{fmt::format("adv_{}", std::string(1, static_cast<char>('a' + index % 26)) + std::string(index / 26, 'z')), 540, 330, ""};
    std::vector<std::string> curves;
    for (std::size_t c = 0; c < k_adv_components.size(); ++c) {
        std::vector<std::vector<std::string>> model, measured;
        for (const AdvTrendValue& v : trends[first + c].values) {
            const std::string speed = fmt::format("{:.6g}", v.speed_rpm);
            if (v.model) model.push_back({speed, fmt::format("{:.6g}", *v.model), fmt::format("{:.6g}", v.position_bar.value_or(0.0))});
            if (v.measured) measured.push_back({speed, fmt::format("{:.6g}", *v.measured)});
        }
        const std::string name = trends[first + c].component;
        if (!model.empty()) {
            plot.commands += data_block(name, model);
            curves.push_back(fmt::format("${0} using 1:2 with lines lw 1.6 lc rgb \"{1}\" title \"{0}\"", name, k_colours[c]));
            curves.push_back(fmt::format("${} using 1:2:3 with yerrorbars pt 0 lw 1.2 lc rgb \"{}\" notitle", name, k_colours[c]));
        }
        if (!measured.empty()) {
            plot.commands += data_block(name + "_measured", measured);
            curves.push_back(fmt::format("${}_measured using 1:2 with points pt 7 ps 0.9 lc rgb \"{}\" notitle", name, k_colours[c]));
        }
    }
    plot.commands += fmt::format("set xlabel \"rotor speed (rpm)\"\nset ylabel \"velocity (m/s)\"\nset key outside top center horizontal\nplot {}\n",
                                 curves.empty() ? "NaN notitle" : fmt::format("{}", fmt::join(curves, ", ")));
    return plot;
}

std::string cell(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : std::string(text::k_dash);
}

}  // namespace

std::vector<AdvTrend> read_adv_trends(const std::vector<fs::path>& run_directories) {
    std::vector<AdvTrend> trends;
    for (const fs::path& directory : run_directories) {
        const fs::path file = directory / names::adv_json;
        if (!fs::exists(file)) continue;
        const json document = json::parse(read_file(file), nullptr, false);
        if (!document.is_object() || document.value("schema", "") != k_adv_schema) continue;
        for (const json& point : document.at("points"))
            for (const AdvComponent c : k_adv_components) {
                const std::string name = point.at("name"), component = adv_component_name(c);
                auto trend = std::find_if(trends.begin(), trends.end(), [&](const AdvTrend& t) { return t.point == name && t.component == component; });
                if (trend == trends.end()) trend = trends.insert(trends.end(), AdvTrend{name, component, {}});
                const json& v = point.at(component);
                trend->values.push_back({document.at("speed_rpm"), document.at("discharge_m3_s"), optional_of(v.at("measured_m_s")),
                                         optional_of(v.at("model_m_s")), optional_of(v.at("position_bar_m_s"))});
            }
    }
    trends.erase(std::remove_if(trends.begin(), trends.end(), [](const AdvTrend& t) { return speeds_of(t) < 2; }), trends.end());
    for (AdvTrend& trend : trends)
        std::stable_sort(trend.values.begin(), trend.values.end(), [](const AdvTrendValue& a, const AdvTrendValue& b) { return a.speed_rpm < b.speed_rpm; });
    return trends;
}

std::string adv_trend_section(const std::vector<AdvTrend>& trends, const fs::path& scratch) {
    if (trends.empty()) return "";
    std::string figures;
    std::vector<std::vector<std::string>> rows;
    for (std::size_t first = 0; first < trends.size(); first += k_adv_components.size()) {
        if (gnuplot_is_installed())
            figures += html::figure(draw_svg(trend_plot(trends, first, first / k_adv_components.size()), scratch),
                                    fmt::format("Point {}: lines are the model with its position bars, discs the measurement.", html::escape(trends[first].point)));
        for (std::size_t i = first; i < first + k_adv_components.size(); ++i)
            for (const AdvTrendValue& v : trends[i].values)
                rows.push_back({html::escape(trends[i].point), trends[i].component, fmt::format("{:g}", v.speed_rpm), fmt::format("{:g}", v.discharge),
                                cell(v.measured), cell(v.model), cell(v.position_bar)});
    }
    fs::remove_all(scratch);
    return html::section("Velocities at points against speed",
                         "<div class=\"figures\">" + figures + "</div>" +
                             html::table({"point", "component", "rpm", "m³/s", "measured [m/s]", "model [m/s]", "position ± [m/s]"}, rows, true));
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
