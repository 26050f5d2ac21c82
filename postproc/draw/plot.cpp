#include "postproc/draw/plot.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace cutterflow::postproc {

using nlohmann::json;

std::string plot_number(double value) {
    return std::isnan(value) ? "NaN" : fmt::format("{:.6g}", value);
}

std::string data_block(const std::string& name, const PlotRows& rows) {
    std::vector<std::vector<std::string>> fields;
    for (const auto& row : rows) {
        fields.emplace_back();
        for (const double value : row) fields.back().push_back(plot_number(value));
    }
    return data_block(name, fields);
}

json column(const PlotRows& rows, std::size_t index) {
    json values = json::array();
    for (const auto& row : rows) {
        values.push_back(std::isnan(row[index]) ? json(nullptr) : json(std::strtod(plot_number(row[index]).c_str(), nullptr)));
    }
    return values;
}

json curve(const PlotRows& rows, std::size_t x, std::size_t y, const std::string& name, const std::string& colour) {
    return {{"type", "scatter"},    {"mode", "lines"}, {"x", column(rows, x)},
            {"y", column(rows, y)}, {"name", name},    {"line", {{"color", colour}, {"width", 2}}}};
}

json axis(const std::string& title) {
    return {{"title", {{"text", title}}}};
}

}  // namespace cutterflow::postproc
