#pragma once
/// \file Soil delivered per hour over the speeds of rotor and swing, where runs vary both.
#include <vector>

#include "postproc/analysis/comparison.hpp"
#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

/// Fewest settings of a map: two speeds of the rotor with two of the swing.
inline constexpr std::size_t k_fewest_of_map = 4;

/// A map for all settings that differ in nothing but rotor speed and swing speed: four or more, at two or more of each, on a grid or
/// scattered. A cell reaches half-way to the neighbouring speeds of any setting; places without a setting stay empty. Its tip and, where
/// there is room, its label give what is delivered. None where there are no such settings.
std::vector<Figure> delivered_maps(const Comparison& comparison);

}  // namespace cutterflow::postproc
