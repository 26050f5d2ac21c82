#include "solver/foam/single_phase/cutter_fluid.hpp"

#include <algorithm>

#include <gsl/assert>

#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/single_phase/fields.hpp"

#include "fvc.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

void copy_into(scalarField& field, gsl::span<const double> values) {
    Expects(static_cast<std::size_t>(field.size()) == values.size());
    std::copy(values.begin(), values.end(), field.begin());
}

void copy_into(vectorField& field, gsl::span<const Vec3> values) {
    Expects(static_cast<std::size_t>(field.size()) == values.size());
    std::transform(values.begin(), values.end(), field.begin(), to_foam);
}

}  // namespace

void CutterFluid::reset_void_fraction(gsl::span<const double> void_fraction) {
    Expects(rock_ == RockPresence::present);
    copy_into(alpha_.primitiveFieldRef(), void_fraction);
    alpha_.correctBoundaryConditions();
}

void CutterFluid::take_void_fraction(gsl::span<const double> old_values, gsl::span<const double> new_values) {
    copy_into(alpha_.primitiveFieldRef(), new_values);
    alpha_.correctBoundaryConditions();
    alphaf_ = fvc::interpolate(alpha_);

    volScalarField& alpha_old = alpha_.oldTime();
    scalarField& old_field = alpha_old.primitiveFieldRef();
    copy_into(old_field, old_values);
    alpha_rate_.field() = (alpha_.primitiveField() - old_field) / time_.deltaTValue();
    if (mesh_.moving()) {
        const scalarField swept(time_.deltaTValue() * fvc::surfaceIntegrate(alphaf_ * mesh_.phi())().primitiveField());
        old_field = (old_field - swept) * mesh_.V().field() / mesh_.V0().field();
    }
    alpha_old.correctBoundaryConditions();
}

void CutterFluid::take_exchange(const coupling::MomentumExchange& exchange) {
    copy_into(explicit_source_.field(), exchange.explicit_source);
    copy_into(drag_rate_.field(), exchange.drag_rate);
    copy_into(inertia_.primitiveFieldRef(), exchange.inertia);
    inertia_.correctBoundaryConditions();
}

/// Du/Dt with the operators of the matrix: Euler on the moving cells and convection by the relative flux.
void CutterFluid::update_material_acceleration() {
    const volScalarField::Internal divergence(growth_rate(mesh_) + fvc::div(phi_)().internalField());
    DuDt_.ref() = fvc::ddt(U_)().internalField() + fvc::div(phi_, U_)().internalField() - divergence * U_.internalField();
    DuDt_.correctBoundaryConditions();
}

void CutterFluid::update_received() {
    received_ = explicit_source_.field() - drag_rate_.field() * (U_.primitiveField() - U_.oldTime().primitiveField()) -
                inertia_.primitiveField() * (DuDt_.primitiveField() - DuDt_.oldTime().primitiveField());
}

}  // namespace cutterflow::foam
