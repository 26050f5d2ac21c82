#pragma once
/// \file OpenFOAM dictionaries of the flow: fields, properties, schemes and solvers, for the frozen-rotor start and for the transient run.
#include <string>
#include <vector>

#include "cases/scenes/cutter/case_inputs.hpp"
#include "cases/scenes/flow/flow_files.hpp"

namespace cutterflow::cases {

/// Of the water that enters: mean speed through the tank's circumference, L = 0.07 R.
Turbulence inlet_turbulence(const CaseInputs& inputs);

/// To start from: tip speed of the rotor, L = 0.07 R.
Turbulence initial_turbulence(const CaseInputs& inputs);

/// 0/U, p, k, epsilon, nut. p is p/rho - g.x (gravity is left out of the fluid's equations), 0 on the circumference.
std::vector<FoamFile> field_files(const CaseInputs& inputs);

/// constant/transportProperties, turbulenceProperties, g.
std::vector<FoamFile> property_files(const CaseInputs& inputs);

/// constant/dynamicMeshDict: the only source of the rotor's motion in the transient run.
FoamFile dynamic_mesh_file(const CaseInputs& inputs);

/// constant/MRFProperties: the rotor of the frozen start. Never in one case with dynamic_mesh_file.
FoamFile frozen_rotor_file(const CaseInputs& inputs);

/// system/fvSchemes, fvSolution, controlDict of the transient run, for cutterFoam and for stock pimpleFoam.
std::vector<FoamFile> run_system_files(const CaseInputs& inputs);

/// The same for the frozen-rotor start with stock simpleFoam, with the monitors that start_flow reads: every `iterations` one write.
std::vector<FoamFile> start_system_files(const CaseInputs& inputs, int iterations);

/// system/decomposeParDict. \pre ranks >= 1
FoamFile decompose_file(int ranks);

}  // namespace cutterflow::cases
