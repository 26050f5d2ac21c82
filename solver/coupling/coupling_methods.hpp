#pragma once
/// \file The coupling methods, one row each.
#include <memory>
#include <vector>

#include "geometry/base/error.hpp"
#include "solver/coupling/rock_coupling.hpp"
#include "solver/observe/run_recorder.hpp"
#include "solver/ports/communicator.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

struct CouplingMethod {
    bool (*is_meant)(const CouplingSettings& settings);
    /// What is wrong with its settings on this mesh. check_settings tells what is wrong with them on any.
    std::vector<Mistake> (*mesh_mistakes)(const CouplingSettings& settings, const FluidEngine& fluid, Communicator& communicator);
    std::unique_ptr<RockCoupling> (*make)(const CouplingSettings& settings, const FluidProperties& properties, FluidEngine& fluid,
                                          DemEngine& dem, Communicator& communicator);
    /// Its sub-models that are on, in the order of the equations.
    std::vector<ModelNote> (*models)(const CouplingSettings& settings);
};

/// The first method of the table that the settings mean.
const CouplingMethod& coupling_method(const CouplingSettings& settings);

/// Water in soil has the soil's velocity.
ModelNote soil_model(const SoilSettings& soil);

}  // namespace cutterflow::coupling
