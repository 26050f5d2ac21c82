#pragma once
/// \file What the DEM needs to know: contact law, walls, domain, fluid. solver/foam fills it from section `rock` of
/// constant/couplingProperties (and constant/g, constant/transportProperties); solver/liggghts works from it.
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/base/vec3.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

/// Contact law of rock on rock and rock on steel (seeds S0-18 to S0-21). Both materials have the same Young's modulus.
struct ContactSettings {
    double youngs_modulus = 0.0;      ///< [Pa]
    double poisson_rock = 0.24;       ///< [-]
    double poisson_steel = 0.27;      ///< [-]
    double friction = 0.15;           ///< Coulomb, rock on rock and rock on steel [-]
    double restitution = 0.97;        ///< dry [-], 0.14 to 1
    bool wet_restitution = true;      ///< e after Legendre from the impact speed
    double time_step_fraction = 0.1;  ///< of the smaller of Rayleigh and Hertz time
    double max_speed = 0.0;           ///< impact speed for the Hertz time [m/s]
};

/// A wall given as STL [m, run frame]; a rotating one stands in its file at rotor angle 0.
struct WallSettings {
    std::string name;
    std::filesystem::path file;
    bool rotating = false;
};

/// Rock leaves the run when its centre is outside this cylinder about the rotor's axis (parallel to z). A plane end may be a wall.
struct DomainSettings {
    double radius = 0.0;  ///< [m]
    double z_min = 0.0;   ///< [m]
    double z_max = 0.0;   ///< [m]
    bool z_min_is_wall = false;
    bool z_max_is_wall = false;
};

struct DemSettings {
    ContactSettings contact;
    std::vector<WallSettings> walls;
    DomainSettings domain;
    FluidProperties fluid;
    double added_mass = 0.5;      ///< C_AM [-]
    Vec3 gravity = Vec3::Zero();  ///< [m/s2]
    std::filesystem::path log;    ///< LIGGGHTS' own log; empty: none
};

}  // namespace cutterflow::coupling
