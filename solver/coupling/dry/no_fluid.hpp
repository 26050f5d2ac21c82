#pragma once
/// \file The place of a fluid where there is none.
#include "solver/ports/fluid_engine.hpp"
#include "solver/replay/run_clock.hpp"

namespace cutterflow::coupling {

/// A clock without cells: rock moves by weight and contacts alone. Nothing is solved, sampled or written.
class NoFluid final : public FluidEngine {
public:
    /// \param longest_step  between looks at feed, pictures and checkpoints [s]
    NoFluid(const ClockTimes& times, double longest_step) : clock_(times, longest_step) {}

    bool feels_rock() const override { return false; }
    Cells cells() const override { return {}; }
    Steel steel() const override { return {}; }
    gsl::span<const ZoneMotion> moving_zones() const override { return {}; }
    FluidFields fields() const override { return {}; }
    double time() const override { return clock_.time(); }
    std::string time_name() const override { return clock_.time_name(); }
    double time_step() const override { return clock_.step(); }
    bool running() override { return clock_.running(); }
    void begin_step(double travel_limit, double stop_time) override { clock_.advance(travel_limit, stop_time); }
    void end_step(gsl::span<const double>, gsl::span<const double>, const MomentumExchange&) override {}
    bool write_if_due() override { return clock_.write_is_due(); }
    void write_now() override {}

    /// \throws std::logic_error  nothing flows; check_settings refuses what would ask for it
    gsl::span<const Vec3> vorticity() override;
    gsl::span<const Vec3> stress_divergence() override;
    gsl::span<const double> wall_retreat() const override;
    void reset_void_fraction(gsl::span<const double> void_fraction) override;
    gsl::span<const Vec3> received() const override;
    void sample_velocity(gsl::span<const Vec3> points, gsl::span<Vec3> velocity) override;
    void watch(const WatchedPlaces& places) override;
    std::vector<double> watched_means() override;
    FluidLoads loads() override;

private:
    RunClock clock_;
};

}  // namespace cutterflow::coupling
