#pragma once
/// \file The strongest oscillation of a signal.
#include <optional>
#include <vector>

namespace cutterflow::postproc {

struct Spectrum {
    std::vector<double> frequency;         ///< [Hz], from 0 on
    std::vector<double> power;             ///< [unit of the signal squared per Hz], one-sided
    std::optional<double> peak_frequency;  ///< of the strongest, between the lines by a parabola through the logarithm [Hz]
    std::optional<double> standard_error;  ///< of the peak, from the segments [Hz]
    double amplitude = 0.0;                ///< of the sine that carries the power of the peak
    double peak_over_median = 0.0;         ///< power
    double noise_limit = 0.0;              ///< peak_over_median that white noise exceeds in at most 1 of 100 cases
    bool stands_out() const { return peak_over_median > noise_limit; }
};

/// Welch's periodogram [Welch1967]: half overlapping segments with Hann's window, without their means. The signal is taken linear between
/// its times and sampled at as many equal steps. The limit of noise uses 36 S^2/(19 S - 1) degrees of freedom for S segments
/// [PercivalWalden1993]. Oscillations of less than two periods in a segment are not sought; where power falls from there on there is no
/// peak, and all that is told of it is missing or 0. \param times  increasing [s]; \param values  as long as times \param segments  >= 1
/// \throws UserError  when a segment has fewer than 16 values
Spectrum spectrum_of(const std::vector<double>& times, const std::vector<double>& values, int segments);

}  // namespace cutterflow::postproc
