#pragma once
/// \file The force balance of a settling rock, independent of the solver's closures: the reference of coupled runs.

namespace cutterflow::validation {

/// A sphere in still water of a given void fraction: weight, buoyancy in pure water, Brown and Lawler's drag, Di Felice's hindrance, added
/// mass 1/2 [NieuwboerVanRheeKeetels2023].
struct FallingRock {
    double diameter = 0.01;        ///< [m]
    double density = 2650.0;       ///< [kg/m3]
    double void_fraction = 1.0;    ///< [-]
    double fluid_density = 998.2;  ///< [kg/m3]
    double viscosity = 1.0034e-6;  ///< kinematic [m2/s]
    double gravity = 9.81;         ///< [m/s2]
};

/// Acceleration [m/s2] at a slip speed [m/s], downward.
double fall_acceleration(const FallingRock& rock, double slip);

/// Slip speed [m/s] at which it is 0.
double terminal_slip(const FallingRock& rock);

/// Speed [m/s] that a rock of speed `start` has after `time` [s].
double fall_speed(const FallingRock& rock, double start, double time);

}  // namespace cutterflow::validation
