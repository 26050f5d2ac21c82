#pragma once
/// \file What is read off a scene in every step: levels, flows through a pipe's mouth and holes, where the bodies are.
#include <optional>
#include <string>

#include "solver/free_surface/surface_run.hpp"

namespace cutterflow::free_surface {

/// An upright pipe, in space one of two walls across the tank. Its inside reaches from its bottom up; holes are open places of its walls.
struct PipeGauge {
    double axis = 0.0, inner_width = 0.0, wall = 0.0;  ///< [m]
    double bottom = 0.0, top = 0.0;                    ///< [m]
    bool is_inside(double x) const { return std::abs(x - axis) < 0.5 * inner_width; }
    bool is_outside(double x) const { return std::abs(x - axis) > 0.5 * inner_width + wall; }
};

struct SceneReading {
    double level = 0.0;              ///< mean over the tank, or outside the pipe [m]
    double level_in_pipe = 0.0;      ///< [m]
    double mouth_flow = 0.0;         ///< of water up into the pipe [m3/s]
    double hole_flow = 0.0;          ///< of water through the holes into the pipe [m3/s]
    double volume_in_pipe = 0.0;     ///< of the particles in it, between bottom and top [m3]
    int bodies_in_pipe = 0;          ///< centres higher than its bottom; without a pipe all
    double rise_in_pipe = 0.0;       ///< mean upward speed of those [m/s]
    Vec3 mean_place = Vec3::Zero();  ///< of the bodies [m]
    double farthest = 0.0;           ///< largest x that a body's surface reaches [m]
};

/// A place at which level and pressure are read.
struct Gauge {
    std::string name;
    double x = 0.0, y = 0.0;  ///< [m]; y means nothing in a plane scene
    std::optional<double> z;  ///< of the pressure; none: the level alone [m]
};

struct GaugeReading {
    double level = 0.0;     ///< of the column of cells around (x, y) [m]
    double pressure = 0.0;  ///< at (x, y, z), over that of the air [Pa]
};

/// The pressure is interpolated between the centres of cells; in a half cell at a wall or a solid it is that of the nearest centres.
GaugeReading read_gauge(const SurfaceRun& run, const Gauge& gauge);

/// The level of a column of cells is where air first stands over water, going up; solids and bodies do not count as air.
SceneReading read_gauges(const SurfaceRun& run, const std::optional<PipeGauge>& pipe);

}  // namespace cutterflow::free_surface
