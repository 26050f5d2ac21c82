#pragma once
/// \file Plots for plotly, which page.js draws over their pictures.
#include <nlohmann/json.hpp>

#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

/// plotly's `data` and `layout`; fonts, colours and margins come from page.js.
nlohmann::json plotly_figure(const Plot& plot);

}  // namespace cutterflow::postproc
