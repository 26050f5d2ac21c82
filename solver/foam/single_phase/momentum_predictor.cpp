#include "solver/foam/single_phase/cutter_fluid.hpp"
#include "solver/foam/single_phase/fields.hpp"

#include "fvc.H"
#include "fvm.H"

namespace cutterflow::foam {

using namespace Foam;

tmp<fvVectorMatrix> CutterFluid::momentum_matrix(const fvVectorMatrix& stress) {
    tmp<fvVectorMatrix> matrix(fvm::ddt(alpha_, U_) + convection(alphaPhi_) - fvm::Sp(fvc::ddt(alpha_) + fvc::div(alphaPhi_), U_) + stress);
    if (rock_ == RockPresence::present) add_exchange(matrix.ref());
    if (soil_) matrix.ref() += fvm::Sp(soil_->sink().internalField(), U_) - soil_->sink().internalField() * soil_->velocity();
    if (!sources_.empty()) matrix.ref() -= sources_(U_);
    matrix.ref().relax();
    sources_.constrain(matrix.ref());
    return matrix;
}

tmp<fvVectorMatrix> CutterFluid::convection(const surfaceScalarField& flux) {
    const KeptGradients gradients(mesh_);
    return fvm::div(flux, U_);
}

/// -div(alpha tau). The viscosity weighted with alpha carries the plain viscosity's name, so that ordinary fvSchemes hold for it.
tmp<fvVectorMatrix> CutterFluid::viscous_matrix() {
    const KeptGradients gradients(mesh_);
    const volScalarField nuEff("nuEff", alpha_ * turbulence_.nuEff());
    return -fvc::div(nuEff * dev2(T(fvc::grad(U_)))) - fvm::laplacian(nuEff, U_);
}

void CutterFluid::add_exchange(fvVectorMatrix& momentum) {
    momentum += inertia_ * (fvm::ddt(U_) + convection(phi_) - fvm::Sp(growth_rate(mesh_) + fvc::div(phi_)().internalField(), U_));
    momentum += fvm::Sp(drag_rate_, U_);
    momentum -= explicit_source_ + drag_rate_ * U_.oldTime().internalField() + inertia_.internalField() * DuDt_.oldTime().internalField();
}

tmp<volVectorField> CutterFluid::pressure_gradient() const {
    return soil_ ? fvc::grad(soil_->at_faces(p_)) : fvc::grad(p_);
}

void CutterFluid::predict_velocity(fvVectorMatrix& momentum) {
    if (!pimple_.momentumPredictor()) return;
    fvVectorMatrix predictor(momentum == -pressure_gradient());
    solve(predictor);
    if (!half_turn_.empty()) {
        // What turns follows from the change in the step, which the first solution has: exactly where it is uniform.
        predictor.source() -= mesh_.V() * turning_force();
        solve(predictor);
    }
    sources_.correct(U_);
}

}  // namespace cutterflow::foam
