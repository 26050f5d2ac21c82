#pragma once
/// \file The plots of the report of one run.
#include <string>
#include <vector>

#include "postproc/analysis/results.hpp"
#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

/// Production, undecided and spillage as one bar of the placed mass, with the ratio between its bounds.
Plot outcome_plot(const Spillage& spillage);

/// Spilled share of the placed mass per bin (with rock) and radial outflow on the twin axis, in the bins' order along the axis.
Plot bins_plot(const Results& results);

/// Spilled share of the placed mass against the radial velocity, a point a bin, that of the bin below the ring in front.
Plot top_bin_plot(const Results& results);

/// Mass of the placed rock by fate over revolutions since the first rock.
Plot fates_plot(const Table& fates, const Spillage& spillage, double revolution);

/// Spillage ratio between its bounds over revolutions since the first rock.
Plot ratio_plot(const Table& fates, const Spillage& spillage, double revolution);

/// Rocks by azimuth of their first exit, in sectors of 15 degrees, seen from the hub, lowest side down.
Plot first_exit_plot(const std::vector<double>& azimuths);

/// Torque of flow and rock over revolutions of the run, averaged over 1/100 revolution.
Plot torque_plot(const Table& loads, const RotorLoads& rotor, double revolution, bool with_rock);

/// Balance errors over revolutions of the run, on a logarithmic axis.
Plot balance_plot(const Table& balance, double revolution, bool with_rock);

/// A part of the cost as plot and legend show it.
struct CostPart {
    const char* key;  ///< in Cost::share
    const char* title;
    const char* colour;
    const char* text_colour;  ///< on it
};
const std::vector<CostPart>& cost_parts();

/// Shares of the wall time as one bar.
Plot cost_plot(const Cost& cost);

}  // namespace cutterflow::postproc
