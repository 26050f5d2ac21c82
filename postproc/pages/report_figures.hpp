#pragma once
/// \file The figures of the report of one run.
#include <string>
#include <vector>

#include "postproc/analysis/results.hpp"
#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

/// The section of the page that a figure stands in.
enum class Place { answer, figures, cost };

struct PlacedFigure {
    Place place;
    Figure figure;
};

/// All figures that the run has numbers for, in the page's order. To add one: a function that makes it, and its row in this list.
std::vector<PlacedFigure> report_figures(const Results& results, const RunData& run);

/// Colours of the fates with the number of rocks of each (markup).
std::string fate_legend(const Fates& fates);

/// Colours of the parts of the cost with their shares (markup).
std::string cost_legend(const Cost& cost);

}  // namespace cutterflow::postproc
