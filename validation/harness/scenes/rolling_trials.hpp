#pragma once
/// \file Trials of rolling friction in any DEM: a sphere on a tilted plate, two spheres that turn on each other like gears.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "solver/ports/dem_engine.hpp"
#include "solver/ports/dem_settings.hpp"
#include "validation/harness/verification.hpp"

namespace cutterflow::validation {

/// Makes the DEM that is put to the trial.
using DemFactory = std::function<std::unique_ptr<coupling::DemEngine>(const coupling::DemSettings& settings)>;

/// A sphere on a plate of the same Young's modulus. By default the set-up of an inclined plate for polypropylene spheres of 4 mm; the
/// plate's friction is any above the rolling friction.
struct Plate {
    double diameter = 0.004;      ///< [m]
    double density = 828.0;       ///< [kg/m3]
    double youngs_modulus = 5e6;  ///< [Pa]
    double friction = 0.6;        ///< [-]
    double rolling = 0.2;         ///< rolling friction [-]
    std::string law = "spring";
};

/// The plate's DEM; the plate is z = 0 and gravity tilted so that x points downhill. \param slope  [deg]
coupling::DemSettings plate_dem(const Plate& plate, double slope_deg, double time);

/// What became of a sphere that was laid on the plate at rest.
struct Descent {
    double speed = 0.0;         ///< at the end [m/s]
    double acceleration = 0.0;  ///< mean of the last half [m/s2]
};
Descent descend(const DemFactory& dem, const Plate& plate, double slope_deg, double time);

/// Time [s] in which a sphere comes to rest or is off: 0.5 s at 4 mm, and as sqrt(d/g).
double settling_time(const Plate& plate);

/// Slope [deg] at which a sphere starts to move, by bisection between two slopes to 0.02 degrees.
double onset_deg(const DemFactory& dem, const Plate& plate, double rests_at_deg, double moves_at_deg);

/// Acceleration [m/s2] of a sphere that rolls down:  (5/7) g (sin - mu_r cos). [Ai2011]
double rolling_acceleration(double rolling, double slope_deg);

/// Acceleration and rest of that sphere against the closed form.
void check_descent(Verification& verification, const DemFactory& dem, const Plate& plate);
/// Where it starts to roll, or, with a friction below the rolling friction, to slide.
void check_onset(Verification& verification, const DemFactory& dem, const Plate& plate);
/// Two spheres that a constant force presses together spin against each other without slip: their spins fall by
/// mu_r F R* / I per time and stay each other's opposite.
void check_gears(Verification& verification, const DemFactory& dem, const std::string& law);

}  // namespace cutterflow::validation
