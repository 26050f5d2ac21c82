#pragma once
/// \file The sub-models of a run, and why each is on: the run's first lines, and the report's table.
#include <vector>

#include "solver/foam/dictionary/coupling_dictionary.hpp"
#include "solver/foam/foam_fluid_engine.hpp"
#include "solver/observe/run_recorder.hpp"

namespace cutterflow {

/// One note for every model that is on, in the order of the equations.
std::vector<coupling::ModelNote> models_in_use(const foam::CouplingDictionary& dictionary, const foam::FoamFluidEngine& fluid);

}  // namespace cutterflow
