#pragma once
/// \file A plot in two forms of the same numbers: a static picture by gnuplot, and one by plotly that answers the mouse where scripts run.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "postproc/draw/gnuplot.hpp"

namespace cutterflow::postproc {

struct Plot {
    PlotScript script;
    nlohmann::json traces = nlohmann::json::array();   ///< plotly's `data`
    nlohmann::json layout = nlohmann::json::object();  ///< plotly's `layout`; fonts, colours and margins come from page.js
};

/// Numbers of a plot, a row a point. NaN is a gap.
using PlotRows = std::vector<std::vector<double>>;

/// A number as both forms show it: six significant digits.
std::string plot_number(double value);

/// Data block `$name` of gnuplot.
std::string data_block(const std::string& name, const PlotRows& rows);

/// A column of the rows as plotly reads it.
nlohmann::json column(const PlotRows& rows, std::size_t index);

/// A curve of plotly through columns `x` and `y`, named in legend and tool tip. Names are markup: escape what comes from files.
nlohmann::json curve(const PlotRows& rows, std::size_t x, std::size_t y, const std::string& name, const std::string& colour);

/// An axis of plotly with its title.
nlohmann::json axis(const std::string& title);

}  // namespace cutterflow::postproc
