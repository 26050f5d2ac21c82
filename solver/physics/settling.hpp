#pragma once
/// \file Settling of one rock in still water from its force balance.
#include "solver/physics/catalogue.hpp"

namespace cutterflow::physics {

/// A rock that settles in fluid of a given void fraction.
struct SettlingRock {
    RockInFluid rock;
    double density = 0.0;   ///< [kg/m3]
    double gravity = 9.81;  ///< [m/s2]
    DragLaw drag = find_drag_law("brown_lawler");
    HindranceLaw hindrance = di_felice_factor;
};

/// Slip speed [m/s] at which drag balances weight less buoyancy in pure fluid:  D(w) w = (rho_s - rho_f) V g. To 1e-12 relative.
/// \throws std::invalid_argument  when the rock is not heavier than the fluid
double terminal_slip_speed(const SettlingRock& settling);

}  // namespace cutterflow::physics
