#pragma once
/// \file By which way rock left the head, of what is outside it at the end of a span of time.
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "postproc/analysis/spillage.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {

/// Sectors of equal width that the azimuth is divided into, the first from the lowest side on.
inline constexpr std::size_t k_last_exit_sectors = 12;

/// Quarters of the azimuth, each 90 degrees wide: the bank's side is where the head swings to, top the highest side.
struct ExitQuarters {
    bool bank_at_90 = false;  ///< the middle of the bank's side is at azimuth 90 degrees, else at 270
    RockAmount bank_side, top, trailing_side, bottom;
};

/// Spilled rock whose last exit lies in a span of time. Rock that comes back within the span, or is sucked up, has not left.
struct LastExits {
    double from = 0.0, to = 0.0;    ///< the span, its beginning excluded [s]
    double supplied = 0.0;          ///< fed in the span; of a batch all that was placed [kg]
    std::vector<BinSpillage> bins;  ///< all bins
    std::array<RockAmount, k_last_exit_sectors> sectors;
    std::optional<ExitQuarters> quarters;  ///< none of a head whose swing has no direction
};

/// Whether the bank stands at azimuth 90 degrees (else at -90), as direction of swing and rotor have it; none without a direction.
std::optional<bool> bank_is_at_90(const OperatingPoint& point);

/// \param supplied  as LastExits::supplied
/// \throws CheckFailure  when rock left through a bin that is none of `bins`
LastExits last_exits_of(const Table& events, const std::vector<geometry::AxialBin>& bins, const OperatingPoint& point, double from,
                        double to, double supplied);

}  // namespace cutterflow::postproc
