#pragma once
/// \file What a study will cost and what its numbers mean, before anything is run.
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cases/study/study.hpp"
#include "geometry/head/head.hpp"
#include "meshing/cutter/mesh_plan.hpp"

namespace cutterflow::cases {

/// Input of a study's mesh plan.
meshing::MeshInput mesh_input_of(const Study& study, const HeadSize& head, const geometry::TriangleSurface& cutter);

/// What a run is to be computed on.
struct RunMachine {
    int ranks = 1;
    double slowness = 1.0;  ///< machine_slowness
};

struct Prediction {
    RunMachine machine;
    meshing::MeshPrediction mesh;
    double flow_step = 0.0;  ///< before rock is released [s]
    double rock_step = 0.0;  ///< from then on [s]; that of the flow without rock
    double steps = 0.0;
    double contact_step = 0.0;                         ///< [s]; 0 without rock
    double mesh_seconds = 0.0, start_seconds = 0.0;    ///< core time of these stages
    double core_hours = 0.0;                           ///< of the stage run
    double run_memory = 0.0;                           ///< of the solver on one rank, with its rock [bytes]
    double mesh_disk = 0.0;                            ///< written by the stages before the run [bytes]
    double run_disk = 0.0;                             ///< written by the run: fields, checkpoints kept, tables [bytes]
    double first_release = 0.0;                        ///< of rock [s]; the run's end without rock
    double development_end = 0.0;                      ///< of longer steps [s]
    double core_hours_per_revolution = 0.0;            ///< before rock is released
    double core_hours_per_revolution_with_rock = 0.0;  ///< from then on
    double revolutions = 0.0;
    std::size_t rocks = 0;
    double tip_speed = 0.0;               ///< [m/s]
    double mouth_speed = 0.0;             ///< [m/s]
    double flow_number = 0.0;             ///< Q / (omega R^3)
    double froude = 0.0;                  ///< omega^2 R / g
    std::vector<double> settling_speeds;  ///< [m/s], one per class of rock, in the study's order
};

/// \throws UserError  when the mesh cannot be planned (clearances, gap, mouth, tank)
Prediction predict(const Study& study, const HeadSize& head, const geometry::TriangleSurface& cutter, const RunMachine& machine);

/// What is likely a mistake in the operating point: rock that settles faster than the water passes the suction mouth.
std::vector<Mistake> prediction_warnings(const Study& study, const Prediction& prediction);

std::string to_text(const Prediction& prediction);
nlohmann::json to_json(const Prediction& prediction);

}  // namespace cutterflow::cases
