#include "solver/foam/single_phase/cutter_fluid.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "solver/foam/session/case_times.hpp"
#include "solver/foam/single_phase/fields.hpp"
#include "solver/foam/single_phase/turbulence_clipping.hpp"
#include "solver/foam/soil/soil_turbulence.hpp"

#include "directionMixedFvPatchFields.H"
#include "findRefCell.H"
#include "fvc.H"
#include "mixedFvPatchFields.H"
#include "zeroGradientFvPatchFields.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

IOobject registered(const word& name, const fvMesh& mesh, IOobject::readOption read, IOobject::writeOption write) {
    return IOobject(name, mesh.time().timeName(), mesh, read, write);
}

/// A field of the exchange: kept in files only when there is rock.
IOobject of_rock(const word& name, const fvMesh& mesh, RockPresence rock) {
    if (rock == RockPresence::absent) return unregistered(name, mesh);
    return registered(name, mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE);
}

double read_density(const dictionary& transport, RockPresence rock) {
    if (rock == RockPresence::present && !transport.found("rho")) {
        throw UserError("constant/transportProperties has no rho", "Rock needs the fluid's density [kg/m3]", "Add: rho 998.2;");
    }
    return transport.lookupOrDefault<scalar>("rho", 998.2);
}

}  // namespace

CutterFluid::CutterFluid(dynamicFvMesh& mesh, const MovingZones& zones, RockPresence rock,
                         const std::optional<coupling::SoilSettings>& soil)
    : mesh_(mesh),
      zones_(zones),
      rotation_(mesh, zones),
      parts_(mesh),
      time_(const_cast<Time&>(mesh.time())),
      rock_(rock),
      pimple_(mesh),
      write_interval_(case_times(time_).write_interval),
      p_(registered("p", mesh, IOobject::MUST_READ, IOobject::AUTO_WRITE), mesh),
      U_(registered("U", mesh, IOobject::MUST_READ, IOobject::AUTO_WRITE), mesh),
      phi_(registered("phi", mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE), fvc::flux(U_)),
      alpha_(of_rock("voidFraction", mesh, rock), mesh, dimensionedScalar("voidFraction", dimless, 1.0),
             zeroGradientFvPatchScalarField::typeName),
      alphaf_("voidFractionf", fvc::interpolate(alpha_)),
      alphaPhi_(unregistered("phi", mesh), alphaf_ * phi_),
      DuDt_(of_rock("DuDt", mesh, rock), mesh, dimensionedVector(dimAcceleration, Zero), zeroGradientFvPatchVectorField::typeName),
      transport_(U_, phi_),
      sources_(fv::options::New(mesh)),
      phase_turbulence_(PhaseTurbulence::New(alpha_, U_, alphaPhi_, phi_, transport_)),
      turbulence_(phase_turbulence_(), alphaPhi_),
      density_(read_density(transport_, rock)),
      viscosity_(gMax(transport_.nu()().primitiveField())),
      alpha_rate_(unregistered("alphaRate", mesh), mesh, dimensionedScalar(dimless / dimTime, Zero)),
      explicit_source_(unregistered("explicitSource", mesh), mesh, dimensionedVector(dimAcceleration, Zero)),
      drag_rate_(unregistered("dragRate", mesh), mesh, dimensionedScalar(dimless / dimTime, Zero)),
      inertia_(unregistered("inertia", mesh), mesh, dimensionedScalar(dimless, Zero), zeroGradientFvPatchScalarField::typeName),
      received_(rock == RockPresence::present ? mesh.nCells() : 0, Zero),
      half_turn_(zones.motion.empty() || word(mesh.ddtScheme("ddt(U)")) != "Euler" ? 0 : mesh.nCells(), Zero),
      state_(IOobject("fluidState", mesh.time().timeName(), "uniform", mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE)) {
    require_supported_case();
    if (soil) put_in_soil(*soil);
    watch_clipping();
    if (rock_ == RockPresence::present) require_case_for_rock();
    setRefCell(p_, pimple_.dict(), p_ref_cell_, p_ref_value_);
    mesh_.setFluxRequired(p_.name());
    create_face_velocity();
    start_old_times();
    evaluate_flux_conditions();
    turbulence_.validate();
    if (soil_) still_eddies(soil_->share());
    restore_state();
    if (rock_ == RockPresence::present && !DuDt_.headerOk()) update_material_acceleration();
}

void CutterFluid::put_in_soil(const coupling::SoilSettings& settings) {
    soil_ = std::make_unique<Soil>(mesh_, zones_, settings);
    sources_.append(new SoilTurbulence(mesh_, soil_->sink()));
}

/// The list of sources owns it.
void CutterFluid::watch_clipping() {
    auto* clipping = new TurbulenceClipping(mesh_, phase_turbulence_(), soil_ ? &soil_->sink() : nullptr);
    sources_.append(clipping);
    clipping_ = clipping;
}

void CutterFluid::create_face_velocity() {
    if (!mesh_.dynamic()) return;
    Uf_.reset(new surfaceVectorField(registered("Uf", mesh_, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE), fvc::interpolate(U_)));
}

/// OpenFOAM creates a field's old value at its first use and stores it again in the same step, which overwrites a value set by hand.
void CutterFluid::start_old_times() {
    alpha_.oldTime();
    U_.oldTime();
    phi_.oldTime();
    DuDt_.oldTime();
    if (Uf_.valid()) Uf_().oldTime();
}

/// Flux-dependent conditions read their values from a file but not the flow direction; the viscosity of realizableKE, computed from
/// gradients, would begin a resumed run with another one.
void CutterFluid::evaluate_flux_conditions() {
    for (fvPatchVectorField& patch : U_.boundaryFieldRef())
        if (isA<directionMixedFvPatchVectorField>(patch) || isA<mixedFvPatchVectorField>(patch)) patch.evaluate();
}

/// The time step with all digits: uniform/time has only the digits of writePrecision.
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

void CutterFluid::begin_step(double travel_limit, double stop_time) {
    choose_time_step(travel_limit, stop_time);
    ++time_;
    Info << "Time = " << time_.timeName() << nl << endl;
    move_mesh();
    update_half_turns();
    if (!soil_) return;
    soil_->follow_mesh();
    soil_->update_sink(time_.deltaTValue(), viscosity_);
}

void CutterFluid::end_step(gsl::span<const double> void_fraction_old, gsl::span<const double> void_fraction_new,
                           const coupling::MomentumExchange& exchange) {
    if (rock_ == RockPresence::present) {
        take_void_fraction(void_fraction_old, void_fraction_new);
        take_exchange(exchange);
    }
    alphaPhi_ = alphaf_ * phi_;
    domain_surplus_ = 0.0;
    clipped_cells_ = 0;
    while (pimple_.loop()) {
        const tmp<fvVectorMatrix> stress = viscous_matrix();
        tmp<fvVectorMatrix> momentum = momentum_matrix(stress());
        if (soil_) soil_->update_mobility(momentum().A(), U_);
        predict_velocity(momentum.ref());
        while (pimple_.correct()) correct_pressure(momentum.ref());
        if (rock_ == RockPresence::present && pimple_.finalIter()) update_received(stress());
        if (pimple_.turbCorr()) correct_turbulence();
    }
    if (rock_ == RockPresence::present) update_material_acceleration();
    save_state();
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
    return turbulence_.type();
}

/// On a mesh that changes, OpenFOAM measures the distances of the walls anew in each step. Those of a rigid zone stay, and its volumes too,
/// which is all else that the model takes from the motion: its fluxes are relative to the mesh and their divergence is that of the absolute
/// ones.
void CutterFluid::correct_turbulence() {
    transport_.correct();
    const bool moving = mesh_.moving(mesh_.moving() && !rotation_.is_rigid());
    turbulence_.correct();
    if (soil_) still_eddies(soil_->share());
    mesh_.moving(moving);
    clipped_cells_ += returnReduce(clipping_->take_count(), sumOp<label>());
}

tmp<vectorField> CutterFluid::vorticity() const {
    return tmp<vectorField>::New(fvc::curl(U_)().primitiveField());
}

tmp<vectorField> CutterFluid::stress_divergence() const {
    const KeptGradients gradients(mesh_);
    const volScalarField nuEff("nuEff", turbulence_.nuEff());
    return fvc::div(nuEff * dev2(T(fvc::grad(U_))))().primitiveField() + fvc::laplacian(nuEff, U_)().primitiveField();
}

tmp<scalarField> CutterFluid::continuity_residual() const {
    surfaceScalarField absolute(alphaPhi_);
    if (mesh_.moving()) absolute += alphaf_ * mesh_.phi();
    return mesh_.V().field() * (alpha_rate_.field() + fvc::div(absolute)().primitiveField());
}

}  // namespace cutterflow::foam
