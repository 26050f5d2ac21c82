#pragma once
/// \file Dimensionless numbers of a run (docs/theory/scaling.md).
#include <optional>

#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {

/// R ring radius, omega rotor speed, d and u_t mean diameter and settling velocity by mass, lambda the ladder's inclination, z number of
/// blades and w their depth, v_h the swing's speed. Of the blades none in runs of earlier programs.
struct ScaleNumbers {
    double flow_number = 0.0;               ///< Q / (omega R^3)
    double froude = 0.0;                    ///< omega^2 R / g
    std::optional<double> settling_ratio;   ///< u_t / (omega R)
    std::optional<double> size_ratio;       ///< d / R
    std::optional<double> settling_number;  ///< S_t = u_t / (Q / (pi R^2))
    std::optional<double> fall_through;     ///< F = u_t cos(lambda) 2 pi / (z omega w): above 1 rock falls through between two blades
    std::optional<double> swing_ratio;      ///< v_h / (omega R)
    std::optional<double> bite_ratio;       ///< f_z / w, f_z = 2 pi v_h / (omega z): what a blade takes over its depth
    std::optional<double> cut_ratio;        ///< Q_c / Q, Q_c the soil that is cut
    std::optional<double> blade_angle_less_ladder;  ///< beta - lambda [deg], beta the middle one of the slices with blades
    std::optional<double> friction_rock, friction_steel, friction_soil;  ///< mu of rock on rock, on steel and on soil
};

/// \param cut_in_situ  soil that the swing cuts [m3/s], where it is known
ScaleNumbers scale_numbers_of(const RunData& run, const std::optional<double>& cut_in_situ);

}  // namespace cutterflow::postproc
