#pragma once
/// \file What an engineer asks of a head at work: rates, losses by their way out, the layer left behind, power, and what limits.
#include <optional>
#include <string>
#include <vector>

#include "postproc/analysis/results.hpp"

namespace cutterflow::postproc {

/// Of a run that is fed from a cut face, in the window of its production. With v_h the swing's speed, s the step, B the bulking,
/// M_c = rho_grain (1 - n) the dry mass per volume of standing soil.
/// \pre results.fed
Dredging dredging_of(const Results& results, const RunData& run);

/// What of a head at work lies outside of usual practice in the prototype (geometry/base/at_work); mixture and spillage once they are
/// steady. None of a run without a bank and a cut face.
std::vector<std::string> outside_usual_practice(const Results& results, const RunData& run);

/// What limits the head, in words: which way the lost rock went, and whether the head is full.
std::string limits_text(const Results& results);

}  // namespace cutterflow::postproc
