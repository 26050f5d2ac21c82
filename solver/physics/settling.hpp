#pragma once
/// \file Settling of rock in still water from the force balance of one rock: the reference that coupled runs are checked against.
#include <vector>

#include "solver/physics/drag.hpp"

namespace cutterflow::physics {

/// A rock that settles in fluid of a given void fraction.
struct SettlingRock {
    RockInFluid rock;
    double density = 0.0;   ///< [kg/m3]
    double gravity = 9.81;  ///< [m/s2]
    DragLaw drag = brown_lawler_drag_coefficient;
    HindranceLaw hindrance = di_felice_factor;
};

/// Slip speed [m/s] at which drag balances weight less buoyancy in pure fluid:  D(w) w = (rho_s - rho_f) V g. To 1e-12 relative.
/// \throws std::invalid_argument  when the rock is not heavier than the fluid
double terminal_slip_speed(const SettlingRock& settling);

/// State of a falling rock.
struct FallState {
    double time = 0.0;      ///< [s]
    double speed = 0.0;     ///< [m/s], downward
    double distance = 0.0;  ///< [m]
};

/// Fall from rest in still fluid with added mass, (rho_s + C_AM rho_f) V dv/dt = (rho_s - rho_f) V g - D(v) v, by the classical Runge-Kutta
/// scheme. \return states at 0, dt, 2 dt, ... up to and including the first one at or after `duration`.
std::vector<FallState> fall_from_rest(const SettlingRock& settling, double added_mass_coefficient, double duration, double time_step);

}  // namespace cutterflow::physics
