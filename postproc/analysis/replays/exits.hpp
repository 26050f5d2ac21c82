#pragma once
/// \file Where spilled rock left the head, as means over replays.
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "postproc/analysis/spillage.hpp"

namespace cutterflow::postproc {

/// Sectors of equal width that the azimuth is divided into, the first from the lowest point on.
inline constexpr std::size_t k_exit_sectors = 8;

/// Where the spilled rock of one run or replay left the head.
struct Exits {
    std::vector<std::string> bins;  ///< names, from the backplate down
    std::vector<double> by_bin;     ///< shares of the spilled mass, by the axial bin of the last exit [-]
    /// Shares of the rocks that left and were not sucked up, by azimuth of the first exit [-].
    std::array<double, k_exit_sectors> by_sector{};
};

/// Nothing where no rock is spilled.
std::optional<Exits> exits_of(const Spillage& spillage);

/// Shares of several replays of one head. \pre an element; all with the same bins
Exits mean_exits(const std::vector<Exits>& exits);

/// Table where (bin or azimuth_deg), place, share (mean over replays), smallest and largest share of a replay. \pre as mean_exits
std::string exits_csv(const std::vector<Exits>& exits);

/// A line for the user: the three bins that most left by, and the half of the azimuth that did.
std::string exits_text(const Exits& mean);

}  // namespace cutterflow::postproc
