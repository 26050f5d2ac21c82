#pragma once
/// \file The figures of a comparison.
#include <string>
#include <vector>

#include "postproc/analysis/comparison.hpp"
#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

/// Spillage and production by setting, against speed, swing speed and flow number (where settings differ in them), outflow and spillage by
/// axial bin, spillage of the top bin against its outflow. Plots of rock are left out when a run has none.
std::vector<Figure> comparison_figures(const Comparison& comparison);

/// Colour of a setting, by its number from 0.
const char* setting_colour(std::size_t setting);

}  // namespace cutterflow::postproc
