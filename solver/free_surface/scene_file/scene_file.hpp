#pragma once
/// \file The file of a free-surface scene (scene.toml), plane or in space: its keys, and the scene that they describe.
#include <filesystem>

#include "geometry/base/parameters/parameter.hpp"
#include "solver/free_surface/output/scene_gauges.hpp"
#include "solver/free_surface/scene.hpp"
#include "solver/ports/dem_engine.hpp"
#include "solver/ports/dem_settings.hpp"

namespace cutterflow::free_surface {

/// What ends a run before its end time.
enum class StopRule { none, pipe_empty, arrival };

/// Everything that a run of a scene needs.
struct Scene {
    std::string name;
    SceneSettings settings;
    coupling::DemSettings dem;  ///< without the walls that are files: wall_surface_stl writes them
    coupling::Rocks bodies;     ///< at the start
    double end = 0.0;           ///< [s]
    StopRule stop = StopRule::none;
    double settle = 0.0;               ///< the run goes on for so long after its stop rule holds [s]
    double write_interval = 0.0;       ///< [s]
    int write_particles = 0;           ///< of how many water particles one is written at an output; 0: none
    double checkpoint_interval = 0.0;  ///< [s]
    std::optional<PipeGauge> pipe;     ///< the first one
    std::vector<Gauge> gauges;
    std::vector<std::string> close;  ///< what is closer than two cells, a line each
    std::vector<std::string> notes;  ///< what the user should know: rounded sizes, coarse bodies
};

/// All keys with unit, bounds, default and help.
const ParameterTable& scene_table();

/// \throws UserError  with every mistake of the file
Scene read_scene(const std::filesystem::path& file);
/// As read_scene, from text; `name` stands for the file in messages. \param folder  in which the files lie that it names
Scene parse_scene(const std::string& toml, const std::string& name, const std::filesystem::path& folder = {});

/// What is told of the water at the start: boxes without a particle, water without a surface. Fills the tank, which takes as long as a
/// step.
std::vector<std::string> water_notes(const Scene& scene);
/// That so many waters are enclosed from a time on [s].
std::string enclosed_note(int waters, double time);

/// Solids as one closed surface each, boxes and plates across a tank of that depth, as text of an STL file [m]; empty without any.
std::string wall_surface_stl(const std::vector<StillSolid>& solids, double depth);

/// Whether a reading meets the stop rule of a scene: no body higher than the pipe's mouth, or a body at the right wall.
bool stops(const Scene& scene, const SceneReading& reading);

/// What a run will take, from counts measured on scenes of these kinds.
struct ScenePrediction {
    double cells = 0.0, water_cells = 0.0, particles = 0.0;
    double step = 0.0;  ///< [s], at the speed of the front of a dam of the water's height, 2 sqrt(g H) [Ritter1892]
    double steps = 0.0;
    double core_seconds = 0.0;
    double dem_step = 0.0;  ///< [s]; 0 without bodies
    double memory = 0.0;    ///< [bytes]
};
ScenePrediction predict(const Scene& scene);

}  // namespace cutterflow::free_surface
