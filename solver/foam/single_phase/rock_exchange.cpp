#include "solver/foam/single_phase/cutter_fluid.hpp"

#include <algorithm>

#include <gsl/assert>

#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/single_phase/fields.hpp"

#include "cyclicAMIFvPatch.H"
#include "fvMatrices.H"
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
    const scalarField shown(alpha_.primitiveField());
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
    outside_.replaced = gSum(((old_field - shown) * old_volumes(mesh_) * U_.primitiveField())());
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
    DuDt_.ref() = fvc::ddt(U_)().internalField() - divergence * U_.internalField();
    {
        const KeptGradients gradients(mesh_);
        DuDt_.ref() += fvc::div(phi_, U_)().internalField();
    }
    if (!half_turn_.empty()) DuDt_.primitiveFieldRef() += turning_rate();
    DuDt_.correctBoundaryConditions();
}

/// alpha phi u at the faces [m4/s2].
tmp<surfaceVectorField> CutterFluid::momentum_flux() {
    const KeptGradients gradients(mesh_);
    return fvc::flux(alphaPhi_, U_, "div(phi,U)");
}

/// What the state shows: gain of momentum and its outflow, less pressure and stress. The pressure has made the last flux, so that its
/// remaining error of continuity takes no momentum along and a uniform flow receives nothing.
void CutterFluid::update_received(const fvVectorMatrix& stress) {
    const surfaceVectorField through(momentum_flux());
    received_ = fvc::ddt(alpha_, U_)().primitiveField() + fvc::div(through)().primitiveField() -
                continuity_residual() / mesh_.V().field() * U_.primitiveField() + pressure_gradient()().primitiveField() +
                (stress & U_)().primitiveField();
    if (soil_) received_ += soil_->resistance(U_);
    update_outside_momentum(stress, through);
    turn_received();
}

/// Sums over boundary faces, but for the explicit part of the stress: a sum over cells, in which the faces between them cancel.
void CutterFluid::update_outside_momentum(const fvVectorMatrix& stress, const surfaceVectorField& through) {
    vector boundary(sum(stress.source())), interface(Zero);
    // Beside soil the two sides of an interface have pressures of their own.
    tmp<surfaceScalarField> beside_soil;
    if (soil_) beside_soil = soil_->at_faces(p_);
    forAll(mesh_.boundary(), patch) {
        const fvPatchVectorField& u = U_.boundaryField()[patch];
        const bool is_interface = isA<cyclicAMIFvPatch>(u.patch());
        if (u.coupled() && !is_interface) continue;
        const vectorField beyond(is_interface ? vectorField(u.patchNeighbourField()) : vectorField(u.size(), vector::one));
        const scalarField& pressure = soil_ ? static_cast<const scalarField&>(beside_soil().boundaryField()[patch])
                                            : static_cast<const scalarField&>(p_.boundaryField()[patch]);
        (is_interface ? interface : boundary) -= sum(through.boundaryField()[patch] + pressure * u.patch().Sf() +
                                                     cmptMultiply(stress.internalCoeffs()[patch], vectorField(u.patchInternalField())) -
                                                     cmptMultiply(stress.boundaryCoeffs()[patch], beyond));
    }
    reduce(boundary, sumOp<vector>());
    if (soil_) boundary -= soil_->force(U_);
    reduce(interface, sumOp<vector>());
    outside_.boundary = time_.deltaTValue() * boundary;
    outside_.interface = time_.deltaTValue() * interface;
}

}  // namespace cutterflow::foam
