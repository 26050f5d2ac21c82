#pragma once
/// \file A free-surface scene in numbers: tank, water, solids, bodies, run.
#include <limits>
#include <string>

#include "solver/free_surface/cut_cells/cut_cells.hpp"
#include "solver/free_surface/cut_cells/gate.hpp"
#include "solver/free_surface/cut_cells/still_solids.hpp"

namespace cutterflow::free_surface {

struct TankSettings {
    bool plane = true;
    std::array<int, 3> cells{1, 1, 1};  ///< in a plane scene 1 across
    double cell = 0.0;                  ///< h [m]
    double depth = 1.0;                 ///< of a plane scene [m]
    StaggeredGrid grid() const {
        return plane ? StaggeredGrid::plane(cells[0], cells[2], cell, depth) : StaggeredGrid::space(cells[0], cells[1], cells[2], cell);
    }
};

struct WaterBox {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< [m]
};

struct WaterSettings {
    double density = 1000.0;              ///< [kg/m3]
    double kinematic_viscosity = 1.0e-6;  ///< [m2/s]
    std::vector<WaterBox> filled;
};

/// Damping of the water in the gaps of contacts; 1: none.
struct GapDampingSettings {
    double remaining = 1.0;  ///< beta: share of the relative velocity left at the contact after `time`
    double time = 0.0;       ///< tau [s]
    double gap = 0.0;        ///< between touching surfaces [m]
};

inline constexpr double k_solid_travel = 0.25;  ///< cells that a body or a gate moves in a step, at most

struct RunSettings {
    double max_courant = 0.5;
    double longest_step = std::numeric_limits<double>::infinity();  ///< [s]
    double mixing_time = -1.0;   ///< tau_mix [s]; below 0: 50 h / sqrt(g H); infinite: none (FLIP); 0: whole (PIC)
    bool even_out = true;        ///< off only to show what it does
    double volume_limit = 0.02;  ///< of the occupied volume that may be lost or won before the run ends
    double pressure_tolerance = 1e-8;
    double even_out_tolerance = 1e-3;
};

/// The middle plane of an upright wall: particles that pass it are counted.
struct WatchedWall {
    double x = 0.0;                   ///< [m]
    double from_z = 0.0, to_z = 0.0;  ///< [m]
};

struct SceneSettings {
    TankSettings tank;
    Vec3 gravity = Vec3(0, 0, -9.81);  ///< [m/s2]
    WaterSettings water;
    std::vector<StillSolid> solids;
    std::vector<Gate> gates;
    std::vector<WatchedWall> watched_walls;
    bool spheres = false;      ///< bodies are spheres; else cylinders across the tank
    bool bodies_held = false;  ///< the pressure does not move them: they are on given paths
    GapDampingSettings damping;
    RunSettings run;
};

}  // namespace cutterflow::free_surface
