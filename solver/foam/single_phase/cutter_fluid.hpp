#pragma once
/// \file The fluid solver: volume-averaged incompressible flow on a moving mesh. Only for .cpp files of this folder.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gsl/span>

#include "solver/foam/mesh_motion/moving_zones.hpp"
#include "solver/foam/mesh_motion/overlap_flux.hpp"
#include "solver/foam/mesh_motion/rigid_rotation.hpp"
#include "solver/foam/mesh_motion/sliding_interface.hpp"
#include "solver/foam/single_phase/registered_turbulence.hpp"
#include "solver/foam/soil/soil.hpp"
#include "solver/ports/fluid_engine.hpp"

#include "dynamicFvMesh.H"
#include "fvMatrices.H"
#include "fvOptions.H"
#include "pimpleControl.H"
#include "surfaceFields.H"
#include "volFields.H"

namespace cutterflow::foam {

class TurbulenceClipping;

/// Whether rock shares the domain with the fluid. Without rock the void fraction stays 1 and no field of the exchange is kept.
enum class RockPresence { absent, present };

/// Momentum that the fluid of the whole mesh got in the last step from elsewhere than rock, over density [m4/s].
struct OutsideMomentum {
    Foam::vector boundary = Foam::Zero;   ///< pressure, stress and through-flow of all patches that are no interface, and the soil's sink
    Foam::vector interface = Foam::Zero;  ///< the same of both sides of all sliding interfaces
    Foam::vector replaced = Foam::Zero;   ///< of fluid that the step's old void fraction has more than the field before it
    Foam::vector turned = Foam::Zero;     ///< by pressure, stress and convection in turning cells, which the step turns by half its angle
};

/// Solves, for the interstitial velocity u and p* = p/rho - g.x,
///
///   d(alpha)/dt + div(alpha u) = 0,
///   alpha Du/Dt = -grad p* + div(alpha tau) + S - K (u - u_old) - M (Du/Dt - Du/Dt_old)              [m/s2]
///
/// with void fraction alpha, S, K, M of coupling::MomentumExchange and tau the laminar and turbulent stress over density. The pressure
/// gradient is not weighted by alpha: buoyancy is no part of the exchange [NieuwboerVanRheeKeetels2023].
///
/// On a moving mesh cells keep their u while alpha, which belongs to the rock, does not travel with them. Both void fractions are given on
/// the moved mesh, so the flux through cell faces that the mesh sweeps must be taken out of the old one: with
///
///   alpha_old* V_old = alpha_old V - dt sum(alpha_f meshPhi)
///
/// the pair {alpha_old*, alpha_f (phi - meshPhi)} obeys the same discrete continuity as {alpha_old, alpha_f phi}: a uniform velocity
/// stays uniform, rock at rest in the turning zone causes no flow, and transport equations of turbulence have no source.
///
/// With soil (class Soil) the momentum has its sink, and its mobility is a factor on velocity, flux and the pressure's coefficient.
class CutterFluid {
public:
    /// \param zones  must outlive the fluid
    CutterFluid(Foam::dynamicFvMesh& mesh, const MovingZones& zones, RockPresence rock, const std::optional<coupling::SoilSettings>& soil);

    bool running();

    /// Chooses the time step (see coupling::FluidEngine::begin_step), advances the time and moves the mesh.
    void begin_step(double travel_limit, double stop_time);

    /// Solves the step. Arrays have one entry per cell; without rock all are empty.
    void end_step(gsl::span<const double> void_fraction_old, gsl::span<const double> void_fraction_new,
                  const coupling::MomentumExchange& exchange);

    void reset_void_fraction(gsl::span<const double> void_fraction);

    bool write_if_due();  ///< \return true when it wrote
    void write_now();

    Foam::dynamicFvMesh& mesh() { return mesh_; }
    const Foam::dynamicFvMesh& mesh() const { return mesh_; }
    const Foam::volVectorField& velocity() const { return U_; }
    const Foam::volScalarField& pressure() const { return p_; }
    const Foam::surfaceScalarField& relative_flux() const { return phi_; }             ///< of u, relative to the mesh [m3/s]
    const Foam::surfaceScalarField& relative_fluid_flux() const { return alphaPhi_; }  ///< of alpha u, relative to the mesh [m3/s]
    const Foam::volScalarField& void_fraction() const { return alpha_; }
    const Foam::volVectorField& material_acceleration() const { return DuDt_; }
    const OverlapFlux& overlap_flux() const { return parts_; }  ///< of alpha u [m3/s]
    const Foam::vectorField& received() const { return received_; }
    const OutsideMomentum& outside_momentum() const { return outside_; }
    const Soil* soil() const { return soil_.get(); }  ///< null without
    Foam::tmp<Foam::volScalarField> effective_viscosity() const { return turbulence_.nuEff(); }
    Foam::tmp<Foam::vectorField> vorticity() const;          ///< curl u [1/s]
    Foam::tmp<Foam::vectorField> stress_divergence() const;  ///< div(tau) [m/s2]
    /// As turbulenceProperties selects it: "realizableKE", "laminar" ...
    std::string turbulence_model() const;
    double density() const { return density_; }      ///< [kg/m3]
    double viscosity() const { return viscosity_; }  ///< of the fluid at the start [m2/s]
    double courant_max() const { return courant_max_; }
    /// Of a closed domain, largest of the last step's correctors: |volume too much in the sum of continuity| / volume; 0 of an open one.
    double domain_surplus() const { return domain_surplus_; }
    /// Cells of the last step in which the turbulence model raised a field to its least value, over all fields and the whole mesh.
    Foam::label clipped_cells() const { return clipped_cells_; }

    /// Residual of continuity in each cell, times its volume [m3/s].
    Foam::tmp<Foam::scalarField> continuity_residual() const;

private:
    void put_in_soil(const coupling::SoilSettings& settings);
    void create_face_velocity();
    void start_old_times();
    void evaluate_flux_conditions();
    void require_supported_case() const;
    void require_case_for_rock() const;
    void take_in_the_rest();
    void update_courant_number();
    void choose_time_step(double travel_limit, double stop_time);
    double next_write_time() const;
    void warn_of_long_step(double travel_limit);
    void move_mesh();
    void update_half_turns();
    Foam::scalarField old_fluid_share() const;
    Foam::vectorField turning_rate() const;
    Foam::vectorField turning_force() const;
    void turn_received();
    Foam::vectorField wall_acceleration(Foam::label patch) const;
    void take_void_fraction(gsl::span<const double> old_values, gsl::span<const double> new_values);
    void take_exchange(const coupling::MomentumExchange& exchange);
    Foam::tmp<Foam::fvVectorMatrix> momentum_matrix(const Foam::fvVectorMatrix& stress);
    Foam::tmp<Foam::fvVectorMatrix> viscous_matrix();
    Foam::tmp<Foam::fvVectorMatrix> convection(const Foam::surfaceScalarField& flux);
    void add_exchange(Foam::fvVectorMatrix& momentum);
    void predict_velocity(Foam::fvVectorMatrix& momentum);
    void correct_pressure(Foam::fvVectorMatrix& momentum);
    Foam::tmp<Foam::volVectorField> pressure_gradient() const;
    Foam::tmp<Foam::volScalarField> free_time(const Foam::fvVectorMatrix& momentum) const;
    Foam::tmp<Foam::surfaceScalarField> predicted_flux(const Foam::volVectorField& HbyA, const Foam::volScalarField& rAU) const;
    void add_wall_forces(Foam::surfaceScalarField& flux, const Foam::volScalarField& rAU) const;
    void close_domain(Foam::surfaceScalarField& flux);
    void predict_parts(const Foam::volVectorField& HbyA);
    void move_pressure_of_parts(const Foam::volScalarField& time);
    void set_conductances(Foam::surfaceScalarField& alpha_rAtUf, const Foam::volScalarField& rAtU);
    void add_pressure_to_parts();
    void put_on_faces(Foam::surfaceScalarField& flux) const;
    void close_interfaces(Foam::surfaceScalarField& flux, const Foam::surfaceScalarField& alpha_rAtUf) const;
    Foam::dimensionedScalar find_surplus(const Foam::surfaceScalarField& flux);
    void report_continuity();
    void correct_turbulence();
    void watch_clipping();
    void update_material_acceleration();
    Foam::tmp<Foam::surfaceVectorField> momentum_flux();
    void update_received(const Foam::fvVectorMatrix& stress);
    void update_outside_momentum(const Foam::fvVectorMatrix& stress, const Foam::surfaceVectorField& through);
    void restore_state();
    void save_state();

    Foam::dynamicFvMesh& mesh_;
    const MovingZones& zones_;
    RigidRotation rotation_;
    OverlapFlux parts_;
    Foam::Time& time_;
    const RockPresence rock_;
    Foam::pimpleControl pimple_;
    const std::optional<double> write_interval_;  // [s]

    Foam::volScalarField p_;
    Foam::volVectorField U_;
    Foam::surfaceScalarField phi_;  // relative to the mesh outside correct_pressure
    Foam::volScalarField alpha_;
    Foam::surfaceScalarField alphaf_;
    Foam::surfaceScalarField alphaPhi_;  // alphaf * phi; carries the name phi so that ordinary fvSchemes hold for it
    Foam::autoPtr<Foam::surfaceVectorField> Uf_;
    Foam::volVectorField DuDt_;

    Foam::singlePhaseTransportModel transport_;
    Foam::fv::optionList& sources_;  // system/ or constant/fvOptions
    Foam::autoPtr<PhaseTurbulence> phase_turbulence_;
    RegisteredTurbulence turbulence_;
    double density_;
    double viscosity_;

    Foam::volScalarField::Internal alpha_rate_;  // d(alpha)/dt
    Foam::volVectorField::Internal explicit_source_;
    Foam::volScalarField::Internal drag_rate_;
    Foam::volScalarField inertia_;
    Foam::vectorField received_;
    OutsideMomentum outside_;
    Foam::vectorField half_turn_;  // tan(omega dt/2) n of each cell; empty unless an Euler step turns cells

    std::unique_ptr<Soil> soil_;

    Foam::IOdictionary state_;
    Foam::label p_ref_cell_ = 0;
    Foam::scalar p_ref_value_ = 0.0;
    double courant_max_ = 0.0;
    double domain_surplus_ = 0.0;
    TurbulenceClipping* clipping_ = nullptr;
    Foam::label clipped_cells_ = 0;
    bool long_step_warned_ = false;
    double continuity_cumulative_ = 0.0;
};

}  // namespace cutterflow::foam
