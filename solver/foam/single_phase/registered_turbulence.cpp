#include "solver/foam/single_phase/registered_turbulence.hpp"

namespace cutterflow::foam {
namespace {

const Foam::geometricOneField k_one;

/// Frees the model's name in the registry.
PhaseTurbulence& checked_out(PhaseTurbulence& model) {
    model.checkOut();
    return model;
}

}  // namespace

RegisteredTurbulence::RegisteredTurbulence(PhaseTurbulence& model, const Foam::surfaceScalarField& phase_flux)
    : Foam::incompressible::turbulenceModel(model.type(), k_one, k_one, checked_out(model).U(), phase_flux, phase_flux, model.transport(),
                                            propertiesName),
      model_(model) {}

/// The registry rereads what stands in it when the file has changed.
bool RegisteredTurbulence::read() {
    return Foam::turbulenceModel::read() && model_.read();
}

/// Wall functions take the distance of the wall from here. It is that of the start: zones turn as rigid bodies.
void RegisteredTurbulence::correct() {
    model_.correct();
}

}  // namespace cutterflow::foam
