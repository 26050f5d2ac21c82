#pragma once
/// \file The sub-models of a run, and why each is on: the run's first lines, and the report's table.
#include <optional>
#include <vector>

#include "solver/foam/dictionary/coupling_dictionary.hpp"
#include "solver/foam/foam_fluid_engine.hpp"
#include "solver/observe/run_recorder.hpp"

namespace cutterflow {

/// Of a flow that is solved, of one that is played, and of none.
std::vector<coupling::ModelNote> flow_models(const foam::FoamFluidEngine& fluid, const std::optional<coupling::SoilSettings>& soil);
std::vector<coupling::ModelNote> recorded_flow_models(const foam::CouplingDictionary& dictionary);
std::vector<coupling::ModelNote> no_flow_models();

/// Of rock, in the order of the equations; none without rock.
std::vector<coupling::ModelNote> rock_models(const foam::CouplingDictionary& dictionary);

}  // namespace cutterflow
