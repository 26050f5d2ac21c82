#pragma once
/// \file The coupling's FluidEngine on OpenFOAM.
#include <memory>

#include "solver/ports/fluid_engine.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::foam {

class FoamSession;

/// Flow in the case of a session. What fields() and received() hand out are views of OpenFOAM's fields, good until the next call that
/// changes the flow (begin_step, end_step, reset_void_fraction); cells() and steel() stay for the engine's life.
class FoamFluidEngine final : public coupling::FluidEngine {
public:
    /// \param with_rock  false: a pure flow; void fraction and exchange of end_step are then not looked at and may be empty
    /// \param soil  hides the fluid in it from rock, as steel does
    /// \throws UserError  when dynamicMeshDict moves the mesh otherwise than by a rotor, a named patch is not there, or fvSchemes does not
    /// suit rock, or the soil's surface is not closed or holds no cell
    FoamFluidEngine(FoamSession& session, bool with_rock, const coupling::PatchSettings& patches = {},
                    const std::optional<coupling::SoilSettings>& soil = {});
    ~FoamFluidEngine() override;

    coupling::Cells cells() const override;
    coupling::Steel steel() const override;
    gsl::span<const coupling::ZoneMotion> moving_zones() const override;
    coupling::FluidFields fields() const override;
    gsl::span<const Vec3> vorticity() override;
    gsl::span<const Vec3> stress_divergence() override;
    double time() const override;
    std::string time_name() const override;
    double time_step() const override;
    bool running() override;
    void begin_step(double travel_limit, double stop_time) override;
    gsl::span<const double> wall_retreat() const override;
    void end_step(gsl::span<const double> void_fraction_old, gsl::span<const double> void_fraction_new,
                  const coupling::MomentumExchange& exchange) override;
    void reset_void_fraction(gsl::span<const double> void_fraction) override;
    gsl::span<const Vec3> received() const override;
    void sample_velocity(gsl::span<const Vec3> points, gsl::span<Vec3> velocity) override;
    void watch(const coupling::WatchedPlaces& places) override;
    std::vector<double> watched_means() override;
    coupling::FluidLoads loads() override;
    bool write_if_due() override;
    void write_now() override;

    /// As constant/transportProperties states them.
    coupling::FluidProperties fluid_properties() const;
    std::string turbulence_model() const;  ///< as constant/turbulenceProperties selects it

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace cutterflow::foam
