#include "solver/foam/single_phase/cutter_fluid.hpp"

#include <algorithm>
#include <cmath>

#include "solver/foam/multigrid/aggregation_multigrid.hpp"

#include "adjustPhi.H"
#include "constrainHbyA.H"
#include "constrainPressure.H"
#include "cyclicAMIFvPatch.H"
#include "fixedFluxPressureFvPatchScalarField.H"
#include "fvc.H"
#include "fvm.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

/// Gradient in the cells beside a patch, from values at faces; 0 in all others.
void add_gradient_beside(const fvPatch& patch, const surfaceScalarField& at_faces, vectorField& gradient) {
    const fvMesh& mesh = at_faces.mesh();
    for (const label cell : patch.faceCells()) {
        vector sum = Zero;
        for (const label face : mesh.cells()[cell]) {
            if (mesh.isInternalFace(face)) {
                sum += (mesh.faceOwner()[face] == cell ? 1.0 : -1.0) * at_faces[face] * mesh.Sf()[face];
            } else {
                const label number = mesh.boundaryMesh().patchID()[face - mesh.nInternalFaces()];
                const fvsPatchScalarField& values = at_faces.boundaryField()[number];
                if (values.empty()) continue;  // of patches of type empty
                const label at = face - mesh.boundaryMesh()[number].start();
                sum += values[at] * mesh.Sf().boundaryField()[number][at];
            }
        }
        gradient[cell] = sum / mesh.V()[cell];
    }
}

/// Sets the fluxes of the parts of sliding interfaces without what the new pressure drives: as predicted, and what the distance of the
/// cells beside a part misses of the present pressure's gradient.
void set_explicit_fluxes(OverlapFlux& parts, const volScalarField& pressure) {
    if (parts.sides().empty()) return;
    const fvMesh& mesh = pressure.mesh();
    const surfaceScalarField at_faces(fvc::interpolate(pressure));
    vectorField gradient(mesh.nCells(), Zero);
    for (const PartFluxes& part : parts.sides()) add_gradient_beside(mesh.boundary()[part.side.patch()], at_faces, gradient);
    for (PartFluxes& part : parts.sides()) {
        const OverlapSide& side = part.side;
        part.flux = part.predicted - part.conductance / side.strength() * (side.rest() & side.mean(gradient));
    }
}

}  // namespace

void CutterFluid::correct_pressure(fvVectorMatrix& momentum) {
    const volScalarField rAU(free_time(momentum));
    volVectorField H(momentum.H());
    if (soil_) {  // its part is in the share of the soil's velocity below
        H.primitiveFieldRef() -= soil_->sink().primitiveField() * soil_->velocity().value();
        H.correctBoundaryConditions();
    }
    if (!half_turn_.empty()) {
        H.primitiveFieldRef() -= turning_force();
        H.correctBoundaryConditions();
    }
    volVectorField HbyA(constrainHbyA(rAU * H, U_, p_));
    surfaceScalarField phiHbyA("phiHbyA", predicted_flux(HbyA, rAU));
    predict_parts(HbyA);
    close_domain(phiHbyA);
    const dimensionedScalar surplus(find_surplus(phiHbyA));

    tmp<volScalarField> rAtU(rAU);
    if (pimple_.consistent()) {
        rAtU = 1.0 / max(1.0 / rAU - momentum.H1(), 0.1 / rAU);
        phiHbyA += fvc::interpolate(rAtU() - rAU) * fvc::snGrad(p_) * mesh_.magSf();
        move_pressure_of_parts(rAtU() - rAU);
        HbyA -= (rAU - rAtU()) * pressure_gradient();
    }
    add_wall_forces(phiHbyA, rAtU());
    constrainPressure(p_, U_, phiHbyA, rAtU());

    surfaceScalarField alpha_rAtUf(rAtU().name(), alphaf_ * fvc::interpolate(rAtU()));
    if (soil_) {
        const surfaceScalarField soil_flux(soil_->velocity() & mesh_.Sf());
        phiHbyA -= soil_flux;
        soil_->set_drive(phiHbyA / (fvc::interpolate(rAtU()) * mesh_.magSf()));
        phiHbyA *= soil_->face_mobility();
        phiHbyA += soil_flux;
        alpha_rAtUf *= soil_->face_mobility();
    }
    set_conductances(alpha_rAtUf, rAtU());
    close_interfaces(phiHbyA, alpha_rAtUf);
    while (pimple_.correctNonOrthogonal()) {
        set_explicit_fluxes(parts_, p_);
        put_on_faces(phiHbyA);
        const volScalarField::Internal outflow(alpha_rate_ + fvc::div(alphaf_ * phiHbyA)().internalField() - surplus);
        const OverlapFlux::InMatrix parts(parts_);
        fvScalarMatrix pressure(fvm::laplacian(alpha_rAtUf, p_));
        pressure -= outflow;
        pressure.setReference(p_ref_cell_, p_ref_value_);
        pressure.solve(own_linear_solver(mesh_.solver(p_.select(pimple_.finalInnerIter()))));
        if (pimple_.finalNonOrthogonalIter()) phi_ = phiHbyA - pressure.flux() / alphaf_;
    }
    add_pressure_to_parts();
    put_on_faces(phi_);
    report_continuity();
    p_.relax();
    U_ = HbyA - rAtU * pressure_gradient();
    if (soil_) {
        const vector& of_soil = soil_->velocity().value();
        U_.primitiveFieldRef() = of_soil + soil_->mobility().primitiveField() * (U_.primitiveField() - of_soil);
    }
    U_.correctBoundaryConditions();
    sources_.correct(U_);
    fvc::correctUf(Uf_, U_, phi_);
    fvc::makeRelative(phi_, U_);
    alphaPhi_ = alphaf_ * phi_;
}

/// 1/A, A the matrix' diagonal without the soil's sink [s].
tmp<volScalarField> CutterFluid::free_time(const fvVectorMatrix& momentum) const {
    return soil_ ? 1.0 / (momentum.A() - soil_->sink()) : 1.0 / momentum.A();
}

tmp<surfaceScalarField> CutterFluid::predicted_flux(const volVectorField& HbyA, const volScalarField& rAU) const {
    if (rock_ == RockPresence::absent) return fvc::flux(HbyA) + fvc::interpolate(rAU) * fvc::ddtCorr(U_, phi_, Uf_);
    return fvc::flux(HbyA) + fvc::interpolate(rAU * (alpha_.oldTime() + inertia_)) * fvc::ddtCorr(U_, phi_, Uf_);
}

/// Where the pressure's gradient at a wall follows from the predicted flux, it must balance what rock beside the wall puts on the fluid,
/// and turn the fluid with the wall.
void CutterFluid::add_wall_forces(surfaceScalarField& flux, const volScalarField& rAU) const {
    forAll(p_.boundaryField(), patch) {
        if (!isA<fixedFluxPressureFvPatchScalarField>(p_.boundaryField()[patch])) continue;
        vectorField force(-alpha_.boundaryField()[patch] * wall_acceleration(patch));
        if (rock_ == RockPresence::present) force += mesh_.boundary()[patch].patchInternalField(explicit_source_.field());
        flux.boundaryFieldRef()[patch] += rAU.boundaryField()[patch] * (force & mesh_.Sf().boundaryField()[patch]);
    }
}

/// Where pressure is fixed nowhere, outflow is scaled to inflow.
void CutterFluid::close_domain(surfaceScalarField& flux) {
    if (!p_.needReference()) return;
    fvc::makeRelative(flux, U_);
    flux *= alphaf_;
    adjustPhi(flux, U_, p_);
    flux /= alphaf_;
    fvc::makeAbsolute(flux, U_);
}

/// What passes through the parts of sliding interfaces without pressure.
void CutterFluid::predict_parts(const volVectorField& HbyA) {
    for (PartFluxes& part : parts_.sides()) part.predicted = part.side.mean(HbyA.primitiveField()) & part.side.area();
}

/// The gradient of the last pressure, over a time [s], as the difference of the cells beside a part has it.
void CutterFluid::move_pressure_of_parts(const volScalarField& time) {
    for (PartFluxes& part : parts_.sides())
        part.predicted += part.side.mean(time.primitiveField()) * part.side.strength() * part.side.difference(p_.primitiveField());
}

/// What soil and rock leave of the fluxes of the parts, and what the pressure drives through them. Faces have the sum of their parts.
void CutterFluid::set_conductances(surfaceScalarField& alpha_rAtUf, const volScalarField& rAtU) {
    for (PartFluxes& part : parts_.sides()) {
        const OverlapSide& side = part.side;
        const label patch = side.patch();
        part.conductance = side.mean(rAtU.primitiveField()) * side.strength();
        if (soil_) {
            const scalarField mobility(side.mean(soil_->mobility().primitiveField()));
            const scalarField of_soil(soil_->velocity().value() & side.area());
            part.predicted = of_soil + mobility * (part.predicted - of_soil);
            part.conductance *= mobility;
        }
        const scalarField alpha(side.mean(alpha_.primitiveField()));
        part.predicted *= alpha;
        part.conductance *= alpha;
        alpha_rAtUf.boundaryFieldRef()[patch] =
            side.sum(part.conductance) / (mesh_.nonOrthDeltaCoeffs().boundaryField()[patch] * mesh_.magSf().boundaryField()[patch]);
    }
}

/// Of the pressure just solved for.
void CutterFluid::add_pressure_to_parts() {
    if (parts_.sides().empty()) return;
    p_.correctBoundaryConditions();  // which the solution evaluated by the matrix' weights
    for (PartFluxes& part : parts_.sides()) part.flux -= part.conductance * part.side.difference(p_.primitiveField());
}

/// The sum of its parts' fluxes on each face of a sliding interface. \param flux  of u [m3/s]
void CutterFluid::put_on_faces(surfaceScalarField& flux) const {
    for (const PartFluxes& part : parts_.sides()) {
        const label patch = part.side.patch();
        flux.boundaryFieldRef()[patch] = part.side.sum(part.flux) / alphaf_.boundaryField()[patch];
    }
}

/// Where a sliding interface has no fluxes of parts: its two sides are different polygons, so that their fluxes differ slightly. Half of
/// the difference, shared out by area outside of soil, is taken from either side of the predicted flux; the pressure's own part of it is
/// that of the last pressure.
void CutterFluid::close_interfaces(surfaceScalarField& flux, const surfaceScalarField& alpha_rAtUf) const {
    const auto open_area = [this](label patch) {
        scalarField area(mesh_.magSf().boundaryField()[patch]);
        if (soil_) area *= soil_->face_mobility().boundaryField()[patch];
        return area;
    };
    for (const InterfacePair& pair : interface_pairs(mesh_)) {
        if (parts_.has(pair.owner)) continue;
        scalar difference = 0.0, area = 0.0;
        for (const label patch : {pair.owner, pair.neighbour}) {
            const scalarField& size = mesh_.magSf().boundaryField()[patch];
            const scalarField gradient(p_.boundaryField()[patch].snGrad(mesh_.nonOrthDeltaCoeffs().boundaryField()[patch]));
            difference +=
                sum(alphaf_.boundaryField()[patch] * flux.boundaryField()[patch] - alpha_rAtUf.boundaryField()[patch] * gradient * size);
            area += sum(open_area(patch));
        }
        reduce(difference, sumOp<scalar>());
        reduce(area, sumOp<scalar>());
        for (const label patch : {pair.owner, pair.neighbour})
            flux.boundaryFieldRef()[patch] -= difference / area * open_area(patch) / alphaf_.boundaryField()[patch];
    }
}

/// What is left in a closed domain's sum of continuity [1/s], which would all go to the pressure's reference cell; 0 in an open one. It is
/// rounding where void fractions conserve the rock; domain_surplus() shows it. Call it before forces at walls enter the flux: pressure
/// balances those there.
dimensionedScalar CutterFluid::find_surplus(const surfaceScalarField& flux) {
    if (!p_.needReference()) return dimensionedScalar(dimless / dimTime, Zero);
    surfaceScalarField through(alphaf_ * flux);
    for (const label patch : interface_patches(mesh_)) through.boundaryFieldRef()[patch] = Zero;  // close_interfaces handles it
    const volScalarField::Internal outflow(alpha_rate_ + fvc::div(through)().internalField());
    const dimensionedScalar surplus(outflow.weightedAverage(mesh_.V()));
    const double share = std::abs(surplus.value()) * time_.deltaTValue();
    if (std::isnan(share) || share > domain_surplus_) domain_surplus_ = share;
    return surplus;
}

/// Called while phi_ is absolute.
void CutterFluid::report_continuity() {
    const scalarField residual(alpha_rate_.field() + fvc::div(alphaf_ * phi_)().primitiveField());
    const scalarField& volume = mesh_.V().field();
    const scalar scale = time_.deltaTValue() / gSum(volume);
    const scalar global = scale * gSum(residual * volume);
    continuity_cumulative_ += global;
    Info << "time step continuity errors : sum local = " << scale * gSum(mag(residual) * volume) << ", global = " << global
         << ", cumulative = " << continuity_cumulative_ << endl;
}

}  // namespace cutterflow::foam
