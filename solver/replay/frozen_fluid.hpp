#pragma once
/// \file A recorded flow in the place of a fluid solver.
#include "solver/ports/fluid_engine.hpp"
#include "solver/replay/flow_recording.hpp"
#include "solver/replay/run_clock.hpp"

namespace cutterflow::coupling {

/// Plays a recording: fields are those of the rotor's angle, linear between phases. Rock does not change them (one-way coupling), but its
/// void fraction is kept, so that hindrance counts. On one rank.
class FrozenFluid final : public FluidEngine {
public:
    FrozenFluid(FlowRecording recording, const ClockTimes& times);

    bool feels_rock() const override { return false; }
    Cells cells() const override { return recording_.cells.view(); }
    Steel steel() const override { return {{recording_.steel.begin(), recording_.steel.end()}, recording_.soil}; }
    gsl::span<const ZoneMotion> moving_zones() const override { return recording_.moving; }
    FluidFields fields() const override { return {velocity_, acceleration_, void_fraction_}; }
    double time() const override { return clock_.time(); }
    std::string time_name() const override { return clock_.time_name(); }
    double time_step() const override { return clock_.step(); }
    bool running() override { return clock_.running(); }
    /// The step is at most two phases of the still cells, the shorter ones.
    void begin_step(double travel_limit, double stop_time) override { clock_.advance(travel_limit, stop_time); }
    /// Zero: nothing asks where rock was swept away by steel.
    gsl::span<const double> wall_retreat() const override { return zero_; }
    void end_step(gsl::span<const double> void_fraction_old, gsl::span<const double> void_fraction_new,
                  const MomentumExchange& exchange) override;
    void reset_void_fraction(gsl::span<const double> void_fraction) override;
    FluidLoads loads() override { return {}; }
    bool write_if_due() override { return clock_.write_is_due(); }
    void write_now() override {}

    /// \throws std::logic_error  a recording has neither; check_settings refuses what would ask for it
    gsl::span<const Vec3> vorticity() override;
    gsl::span<const Vec3> stress_divergence() override;
    gsl::span<const Vec3> received() const override;
    void sample_velocity(gsl::span<const Vec3> points, gsl::span<Vec3> velocity) override;
    void watch(const WatchedPlaces& places) override;
    std::vector<double> watched_means() override;

private:
    void set_fields();

    FlowRecording recording_;
    RunClock clock_;
    std::vector<Vec3> velocity_, acceleration_;
    std::vector<double> void_fraction_, zero_;
};

}  // namespace cutterflow::coupling
