#pragma once
/// \file The measures of a run on its page: a table, and a figure for each that has something to show.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "postproc/draw/page.hpp"
#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

/// Figures of the measures, in the order of their names: silhouettes with fitted lines, the height map of a cavity with outline and chords,
/// passed mass with the fitted slope, a profile beside a given one, maps of void and velocity, spectra, forces. A mass in a region and a
/// packing are numbers alone.
/// \param results  as report/measures.json has them
std::vector<Figure> measure_figures(const nlohmann::json& results);

/// The section "Measures": the table of values with their standard errors and, where gnuplot is installed, the figures; markup.
std::string measures_section(const Page& page, const nlohmann::json& results);

}  // namespace cutterflow::postproc
