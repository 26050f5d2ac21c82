#pragma once
/// \file Mass that passes over time: slopes, shares.
#include <optional>
#include <vector>

namespace cutterflow::postproc {

/// A sum over time. `steps`: it jumps at each time and holds until the next (crossings of a gate); else it is linear between (pictures).
struct PassedMass {
    std::vector<double> time;  ///< increasing [s]
    std::vector<double> mass;  ///< passed by then [kg]
    bool steps = true;
    double start = 0.0, end = 0.0;  ///< of the run [s]
    bool whole = true;              ///< false: what passed before `start` is not known

    double at(double when) const;
    double total() const { return mass.empty() ? 0.0 : mass.back(); }
};

/// First time at which `mass` has passed; nothing when it never has. \param mass  > 0 [kg]
std::optional<double> time_when(const PassedMass& passed, double mass);

/// Slope with its error.
struct Rate {
    double slope = 0.0;                    ///< by least squares [kg/s]
    std::optional<double> standard_error;  ///< [kg/s]; none: fewer than k_fewest_stretches in the window have mass
    double half_interval = 0.0;            ///< half of the 95 % interval by Student's t [kg/s]; 0 without a standard error
    double intercept = 0.0;                ///< of the line at t = 0 [kg]
    double from = 0.0, to = 0.0;           ///< [s]
};

inline constexpr int k_stretches = 10;        ///< of the window, for the error
inline constexpr int k_fewest_stretches = 4;  ///< pictures allow no more stretches than they have intervals

/// Slope of the passed mass in a window by least squares over equally spaced times.
///
/// Passed mass sums up grains that come at random times, so its deviations from the line add up as those of a random walk do. The error
/// that ordinary least squares states for independent deviations would be far too small. The variance of the slope of a random walk whose
/// variance grows by q per time is 6 q / (5 T) over a window T; q comes from the increments over equal stretches of the window.
/// \pre from < to
Rate rate_in(const PassedMass& passed, double from, double to);

/// The window between the times when a quarter and three quarters of the total have passed. \return nothing when nothing passed
std::optional<std::pair<double, double>> middle_half(const PassedMass& passed);

}  // namespace cutterflow::postproc
