#include "solver/foam/single_phase/cutter_fluid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gsl/assert>

#include "geometry/base/error.hpp"
#include "solver/foam/session/foam_conversions.hpp"

#include "adjustPhi.H"
#include "constrainHbyA.H"
#include "constrainPressure.H"
#include "cyclicAMIFvPatch.H"
#include "directionMixedFvPatchFields.H"
#include "findRefCell.H"
#include "fixedFluxPressureFvPatchScalarField.H"
#include "fvc.H"
#include "fvm.H"
#include "mixedFvPatchFields.H"
#include "zeroGradientFvPatchFields.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

/// Times are sums of steps: this share of a step or of an interval is rounding.
constexpr double k_time_tolerance = 1e-6;

/// Interval between fields that are written by simulated time; none when the case counts otherwise.
std::optional<double> read_write_interval(const dictionary& control) {
    const word kind(control.lookupOrDefault<word>("writeControl", "timeStep"));
    if (kind != "adjustable" && kind != "adjustableRunTime") return std::nullopt;
    return control.get<scalar>("writeInterval");
}

IOobject registered(const word& name, const fvMesh& mesh, IOobject::readOption read, IOobject::writeOption write) {
    return IOobject(name, mesh.time().timeName(), mesh, read, write);
}

IOobject unregistered(const word& name, const fvMesh& mesh) {
    return IOobject(name, mesh.time().timeName(), mesh, IOobject::NO_READ, IOobject::NO_WRITE, false);
}

/// A field of the exchange: kept in files only when there is rock.
IOobject of_rock(const word& name, const fvMesh& mesh, Rock rock) {
    if (rock == Rock::absent) return unregistered(name, mesh);
    return registered(name, mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE);
}

double read_density(const dictionary& transport, Rock rock) {
    if (rock == Rock::present && !transport.found("rho")) {
        throw UserError("constant/transportProperties has no rho", "Rock needs the fluid's density [kg/m3]", "Add: rho 998.2;");
    }
    return transport.lookupOrDefault<scalar>("rho", 998.2);
}

void copy_into(scalarField& field, gsl::span<const double> values) {
    Expects(static_cast<std::size_t>(field.size()) == values.size());
    std::copy(values.begin(), values.end(), field.begin());
}

void copy_into(vectorField& field, gsl::span<const Vec3> values) {
    Expects(static_cast<std::size_t>(field.size()) == values.size());
    std::transform(values.begin(), values.end(), field.begin(), to_foam);
}

/// Rate at which cells grow [1/s]: 0 on a mesh that is still, rounding errors on one that turns.
tmp<volScalarField::Internal> growth_rate(const fvMesh& mesh) {
    auto rate = tmp<volScalarField::Internal>::New(unregistered("growthRate", mesh), mesh, dimensionedScalar(dimless / dimTime, Zero));
    if (mesh.moving()) rate.ref().field() = (1.0 - mesh.V0().field() / mesh.V().field()) / mesh.time().deltaTValue();
    return rate;
}

}  // namespace

std::vector<label> interface_patches(const fvMesh& mesh) {
    std::vector<label> patches;
    forAll(mesh.boundary(), patch) if (isA<cyclicAMIFvPatch>(mesh.boundary()[patch])) patches.push_back(patch);
    return patches;
}

CutterFluid::CutterFluid(dynamicFvMesh& mesh, Rock rock)
    : mesh_(mesh),
      time_(const_cast<Time&>(mesh.time())),
      rock_(rock),
      pimple_(mesh),
      write_interval_(read_write_interval(time_.controlDict())),
      p_(registered("p", mesh, IOobject::MUST_READ, IOobject::AUTO_WRITE), mesh),
      U_(registered("U", mesh, IOobject::MUST_READ, IOobject::AUTO_WRITE), mesh),
      phi_(registered("phi", mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE), fvc::flux(U_)),
      alpha_(of_rock("voidFraction", mesh, rock), mesh, dimensionedScalar("voidFraction", dimless, 1.0),
             zeroGradientFvPatchScalarField::typeName),
      alphaf_("voidFractionf", fvc::interpolate(alpha_)),
      alphaPhi_(unregistered("phi", mesh), alphaf_ * phi_),
      DuDt_(of_rock("DuDt", mesh, rock), mesh, dimensionedVector(dimAcceleration, Zero), zeroGradientFvPatchVectorField::typeName),
      transport_(U_, phi_),
      turbulence_(TurbulenceModel::New(alpha_, U_, alphaPhi_, phi_, transport_)),
      density_(read_density(transport_, rock)),
      viscosity_(gMax(transport_.nu()().primitiveField())),
      alpha_rate_(unregistered("alphaRate", mesh), mesh, dimensionedScalar(dimless / dimTime, Zero)),
      explicit_source_(unregistered("explicitSource", mesh), mesh, dimensionedVector(dimAcceleration, Zero)),
      drag_rate_(unregistered("dragRate", mesh), mesh, dimensionedScalar(dimless / dimTime, Zero)),
      inertia_(unregistered("inertia", mesh), mesh, dimensionedScalar(dimless, Zero), zeroGradientFvPatchScalarField::typeName),
      received_(rock == Rock::present ? mesh.nCells() : 0, Zero),
      state_(IOobject("fluidState", mesh.time().timeName(), "uniform", mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE)) {
    if (rock_ == Rock::present) require_case_for_rock();
    setRefCell(p_, pimple_.dict(), p_ref_cell_, p_ref_value_);
    mesh_.setFluxRequired(p_.name());
    create_face_velocity();
    start_old_times();
    evaluate_flux_conditions();
    turbulence_->validate();
    restore_state();
    if (rock_ == Rock::present && !DuDt_.headerOk()) update_material_acceleration();
}

void CutterFluid::create_face_velocity() {
    if (!mesh_.dynamic()) return;
    Uf_.reset(new surfaceVectorField(registered("Uf", mesh_, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE), fvc::interpolate(U_)));
}

/// OpenFOAM makes a field's old value when it is first asked for, and once more in the same step: too late for one that is set by hand.
void CutterFluid::start_old_times() {
    alpha_.oldTime();
    U_.oldTime();
    phi_.oldTime();
    DuDt_.oldTime();
    if (Uf_.valid()) Uf_().oldTime();
}

/// A condition that follows the flux reads its values from a file but not which way the flow went; the viscosity of realizableKE, made from
/// gradients, would begin a resumed run with another one.
void CutterFluid::evaluate_flux_conditions() {
    for (fvPatchVectorField& patch : U_.boundaryFieldRef())
        if (isA<directionMixedFvPatchVectorField>(patch) || isA<mixedFvPatchVectorField>(patch)) patch.evaluate();
}

void CutterFluid::require_case_for_rock() const {
    std::vector<Mistake> mistakes;
    const word ddt(mesh_.ddtScheme("ddt(" + U_.name() + ')'));
    if (ddt != "Euler") {
        mistakes.push_back({"system/fvSchemes", fmt::format("ddtSchemes default = {}", std::string(ddt)),
                            "With rock the void fraction's rate pairs with an Euler step only", "Set: default Euler;"});
    }
    for (const char* name : {"div(phi,U)", "div(phi,k)", "div(phi,epsilon)", "div(phi,omega)"}) {
        if (!mesh_.schemesDict().subDict("divSchemes").found(name)) continue;
        if (word(mesh_.divScheme(name)) != "bounded") continue;
        mistakes.push_back({"system/fvSchemes", fmt::format("{} is bounded", name),
                            "With rock div(phi) is not zero and a bounded scheme would make it a source", "Leave out the word bounded"});
    }
    forAll(p_.boundaryField(), patch) {
        if (p_.boundaryField()[patch].type() != zeroGradientFvPatchScalarField::typeName) continue;
        mistakes.push_back({time_.timeName() + "/p", fmt::format("patch {} is zeroGradient", std::string(mesh_.boundary()[patch].name())),
                            "Rock beside a patch puts a force on the fluid, which the pressure's gradient there must balance",
                            "Set: type fixedFluxPressure;"});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

/// The time step in full: uniform/time keeps only as many digits as writePrecision says.
void CutterFluid::restore_state() {
    string time_step;
    if (!state_.readIfPresent("timeStep", time_step)) return;
    if (time_.controlDict().lookupOrDefault("adjustTimeStep", false)) time_.setDeltaT(std::stod(time_step), false);
    state_.readEntry("continuityCumulative", continuity_cumulative_);
}

void CutterFluid::save_state() {
    state_.set("timeStep", string(fmt::format("{:.17g}", time_.deltaTValue())));
    state_.set("continuityCumulative", continuity_cumulative_);
}

bool CutterFluid::running() {
    return time_.run();
}

void CutterFluid::begin_step(double travel_limit, double stop_time) {
    choose_time_step(travel_limit, stop_time);
    ++time_;
    Info << "Time = " << time_.timeName() << nl << endl;
    move_mesh();
}

void CutterFluid::end_step(gsl::span<const double> void_fraction_old, gsl::span<const double> void_fraction_new,
                           const coupling::MomentumExchange& exchange) {
    if (rock_ == Rock::present) {
        take_void_fraction(void_fraction_old, void_fraction_new);
        take_exchange(exchange);
    }
    alphaPhi_ = alphaf_ * phi_;
    while (pimple_.loop()) {
        tmp<fvVectorMatrix> momentum = momentum_matrix();
        predict_velocity(momentum.ref());
        while (pimple_.correct()) correct_pressure(momentum.ref());
        if (pimple_.turbCorr()) correct_turbulence();
    }
    if (rock_ == Rock::present) {
        update_material_acceleration();
        update_received();
    }
    save_state();
}

void CutterFluid::reset_void_fraction(gsl::span<const double> void_fraction) {
    Expects(rock_ == Rock::present);
    copy_into(alpha_.primitiveFieldRef(), void_fraction);
    alpha_.correctBoundaryConditions();
}

bool CutterFluid::write_if_due() {
    time_.printExecutionTime(Info);
    if (!write_interval_) return time_.write();
    const double half_step = 0.5 * time_.deltaTValue();
    const auto intervals = [this](double time) { return std::floor(time / *write_interval_); };
    if (intervals(time_.value() + half_step) == intervals(time_.value() - half_step)) return false;
    time_.writeNow();
    return true;
}

void CutterFluid::write_now() {
    time_.writeNow();
}
std::string CutterFluid::turbulence_model() const {
    return turbulence_->type();
}

void CutterFluid::update_courant_number() {
    const scalarField gross_flux(fvc::surfaceSum(mag(phi_))().primitiveField());
    const scalar half_step = 0.5 * time_.deltaTValue();
    courant_max_ = half_step * gMax(gross_flux / mesh_.V().field());
    const scalar mean = half_step * gSum(gross_flux) / gSum(mesh_.V().field());
    Info << "Courant Number mean: " << mean << " max: " << courant_max_ << endl;
}

void CutterFluid::choose_time_step(double travel_limit, double stop_time) {
    update_courant_number();
    const dictionary& control = time_.controlDict();
    if (!control.lookupOrDefault("adjustTimeStep", false)) {
        warn_of_long_step(travel_limit);
        return;
    }
    const scalar headroom = control.lookupOrDefault<scalar>("maxCo", 1.0) / (courant_max_ + SMALL);
    const bool first = time_.timeIndex() == 0;
    const scalar growth = first ? 1.0 : std::min(1.0 + 0.1 * headroom, 1.2);
    const scalar limit = std::min<scalar>(control.lookupOrDefault<scalar>("maxDeltaT", GREAT), travel_limit);
    const scalar step = std::min(std::min(headroom, growth) * time_.deltaTValue(), limit);
    // OpenFOAM's own way of meeting write times counts from the run's start, which a restart moves.
    const scalar ahead = std::min(next_write_time(), stop_time) - time_.value();
    time_.setDeltaT(ahead / std::ceil(ahead / step - k_time_tolerance), false);
    Info << "deltaT = " << time_.deltaTValue() << endl;
}

/// The next multiple of the write interval, or the end of the run when that is earlier.
double CutterFluid::next_write_time() const {
    const double end = time_.endTime().value();
    if (!write_interval_) return end;
    const double next = *write_interval_ * (std::floor(time_.value() / *write_interval_ + k_time_tolerance) + 1.0);
    return end - time_.value() > k_time_tolerance * time_.deltaTValue() ? std::min(next, end) : next;
}

/// A fixed time step is the user's choice; that it is too long for the rock is said once.
void CutterFluid::warn_of_long_step(double travel_limit) {
    if (long_step_warned_ || time_.deltaTValue() <= travel_limit) return;
    long_step_warned_ = true;
    Info << "Warning: deltaT = " << time_.deltaTValue() << " s is above " << travel_limit
         << " s. Rock must travel less than a quarter of its kernel in a step. Set adjustTimeStep yes, or a shorter deltaT." << endl;
}

/// Cells carry their velocity along, faces theirs: the flux is that of the old face velocity through the turned face, except where the
/// boundary condition states it.
void CutterFluid::move_mesh() {
    mesh_.update();
    if (!mesh_.moving()) return;
    phi_ = mesh_.Sf() & Uf_();
    forAll(phi_.boundaryField(), patch) {
        if (!U_.boundaryField()[patch].fixesValue()) continue;
        phi_.boundaryFieldRef()[patch] = mesh_.Sf().boundaryField()[patch] & U_.boundaryField()[patch];
    }
    fvc::makeRelative(phi_, U_);
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

tmp<fvVectorMatrix> CutterFluid::momentum_matrix() {
    tmp<fvVectorMatrix> matrix(fvm::ddt(alpha_, U_) + fvm::div(alphaPhi_, U_) - fvm::Sp(fvc::ddt(alpha_) + fvc::div(alphaPhi_), U_) +
                               viscous_matrix());
    if (rock_ == Rock::present) add_exchange(matrix.ref());
    matrix.ref().relax();
    return matrix;
}

/// -div(alpha tau). The viscosity weighted with alpha carries the plain viscosity's name, so that ordinary fvSchemes hold for it.
tmp<fvVectorMatrix> CutterFluid::viscous_matrix() {
    const volScalarField nuEff("nuEff", alpha_ * turbulence_->nuEff());
    return -fvc::div(nuEff * dev2(T(fvc::grad(U_)))) - fvm::laplacian(nuEff, U_);
}

void CutterFluid::add_exchange(fvVectorMatrix& momentum) {
    momentum += inertia_ * (fvm::ddt(U_) + fvm::div(phi_, U_) - fvm::Sp(growth_rate(mesh_) + fvc::div(phi_)().internalField(), U_));
    momentum += fvm::Sp(drag_rate_, U_);
    momentum -= explicit_source_ + drag_rate_ * U_.oldTime().internalField() + inertia_.internalField() * DuDt_.oldTime().internalField();
}

void CutterFluid::predict_velocity(fvVectorMatrix& momentum) {
    if (pimple_.momentumPredictor()) solve(momentum == -fvc::grad(p_));
}

void CutterFluid::correct_pressure(fvVectorMatrix& momentum) {
    const volScalarField rAU(1.0 / momentum.A());
    volVectorField HbyA(constrainHbyA(rAU * momentum.H(), U_, p_));
    surfaceScalarField phiHbyA("phiHbyA", predicted_flux(HbyA, rAU));
    close_domain(phiHbyA);
    const dimensionedScalar surplus(domain_surplus(phiHbyA));

    tmp<volScalarField> rAtU(rAU);
    if (pimple_.consistent()) {
        rAtU = 1.0 / max(1.0 / rAU - momentum.H1(), 0.1 / rAU);
        phiHbyA += fvc::interpolate(rAtU() - rAU) * fvc::snGrad(p_) * mesh_.magSf();
        HbyA -= (rAU - rAtU()) * fvc::grad(p_);
    }
    if (rock_ == Rock::present) add_wall_forces(phiHbyA, rAtU());
    constrainPressure(p_, U_, phiHbyA, rAtU());

    const surfaceScalarField alpha_rAtUf(rAtU().name(), alphaf_ * fvc::interpolate(rAtU()));
    close_interface(phiHbyA, alpha_rAtUf);
    const volScalarField::Internal outflow(alpha_rate_ + fvc::div(alphaf_ * phiHbyA)().internalField() - surplus);
    while (pimple_.correctNonOrthogonal()) {
        fvScalarMatrix pressure(fvm::laplacian(alpha_rAtUf, p_));
        pressure -= outflow;
        pressure.setReference(p_ref_cell_, p_ref_value_);
        pressure.solve(mesh_.solver(p_.select(pimple_.finalInnerIter())));
        if (pimple_.finalNonOrthogonalIter()) phi_ = phiHbyA - pressure.flux() / alphaf_;
    }
    report_continuity();
    p_.relax();
    U_ = HbyA - rAtU * fvc::grad(p_);
    U_.correctBoundaryConditions();
    fvc::correctUf(Uf_, U_, phi_);
    fvc::makeRelative(phi_, U_);
    alphaPhi_ = alphaf_ * phi_;
}

tmp<surfaceScalarField> CutterFluid::predicted_flux(const volVectorField& HbyA, const volScalarField& rAU) const {
    if (rock_ == Rock::absent) return fvc::flux(HbyA) + fvc::interpolate(rAU) * fvc::ddtCorr(U_, phi_, Uf_);
    return fvc::flux(HbyA) + fvc::interpolate(rAU * (alpha_.oldTime() + inertia_)) * fvc::ddtCorr(U_, phi_, Uf_);
}

/// Where the pressure's gradient at a wall follows from the predicted flux it must balance what rock beside the wall puts on the fluid.
void CutterFluid::add_wall_forces(surfaceScalarField& flux, const volScalarField& rAU) const {
    forAll(p_.boundaryField(), patch) {
        if (!isA<fixedFluxPressureFvPatchScalarField>(p_.boundaryField()[patch])) continue;
        const vectorField force(mesh_.boundary()[patch].patchInternalField(explicit_source_.field()));
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

/// The two sides of the sliding interface are polygons of their own, so that what leaves one is not quite what enters the other. Half of
/// the difference, shared out by area, is taken from either side of the predicted flux; the pressure's own part of it is that of the last
/// pressure.
void CutterFluid::close_interface(surfaceScalarField& flux, const surfaceScalarField& alpha_rAtUf) const {
    scalar difference = 0.0, area = 0.0;
    for (const label patch : interface_patches(mesh_)) {
        const scalarField& size = mesh_.magSf().boundaryField()[patch];
        const scalarField gradient(p_.boundaryField()[patch].snGrad(mesh_.nonOrthDeltaCoeffs().boundaryField()[patch]));
        difference +=
            sum(alphaf_.boundaryField()[patch] * flux.boundaryField()[patch] - alpha_rAtUf.boundaryField()[patch] * gradient * size);
        area += sum(size);
    }
    reduce(difference, sumOp<scalar>());
    reduce(area, sumOp<scalar>());
    for (const label patch : interface_patches(mesh_))
        flux.boundaryFieldRef()[patch] -= difference / area * mesh_.magSf().boundaryField()[patch] / alphaf_.boundaryField()[patch];
}

/// What is left in a closed domain's sum of continuity [1/s] (rounding), which would all go to the pressure's reference cell; 0 in an open
/// one. To be asked before forces at walls enter the flux: pressure balances those there.
dimensionedScalar CutterFluid::domain_surplus(const surfaceScalarField& flux) const {
    if (!p_.needReference()) return dimensionedScalar(dimless / dimTime, Zero);
    surfaceScalarField through(alphaf_ * flux);
    for (const label patch : interface_patches(mesh_)) through.boundaryFieldRef()[patch] = Zero;  // close_interface sees to it
    const volScalarField::Internal outflow(alpha_rate_ + fvc::div(through)().internalField());
    return outflow.weightedAverage(mesh_.V());
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

void CutterFluid::correct_turbulence() {
    transport_.correct();
    turbulence_->correct();
}

/// Du/Dt with the operators that stand in the matrix: Euler on the moving cells and convection by the relative flux.
void CutterFluid::update_material_acceleration() {
    const volScalarField::Internal divergence(growth_rate(mesh_) + fvc::div(phi_)().internalField());
    DuDt_.ref() = fvc::ddt(U_)().internalField() + fvc::div(phi_, U_)().internalField() - divergence * U_.internalField();
    DuDt_.correctBoundaryConditions();
}

void CutterFluid::update_received() {
    received_ = explicit_source_.field() - drag_rate_.field() * (U_.primitiveField() - U_.oldTime().primitiveField()) -
                inertia_.primitiveField() * (DuDt_.primitiveField() - DuDt_.oldTime().primitiveField());
}

tmp<vectorField> CutterFluid::vorticity() const {
    return tmp<vectorField>::New(fvc::curl(U_)().primitiveField());
}

tmp<vectorField> CutterFluid::stress_divergence() const {
    const volScalarField nuEff("nuEff", turbulence_->nuEff());
    return fvc::div(nuEff * dev2(T(fvc::grad(U_))))().primitiveField() + fvc::laplacian(nuEff, U_)().primitiveField();
}

tmp<scalarField> CutterFluid::continuity_residual() const {
    surfaceScalarField absolute(alphaPhi_);
    if (mesh_.moving()) absolute += alphaf_ * mesh_.phi();
    return mesh_.V().field() * (alpha_rate_.field() + fvc::div(absolute)().primitiveField());
}

}  // namespace cutterflow::foam
