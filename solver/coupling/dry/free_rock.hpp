#pragma once
/// \file Rock without a medium: weight and contacts alone.
#include <optional>

#include "solver/coupling/rock_coupling.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

/// m dv/dt = weight + contacts, every DEM step, and -m v/time in a step that begins calm (CalmingSettings). Nothing is sampled, mapped or
/// carried.
class FreeRock final : public RockCoupling {
public:
    /// \param fluid  gives the time step
    FreeRock(const std::optional<CalmingSettings>& calming, const FluidEngine& fluid, DemEngine& dem)
        : calming_(calming), fluid_(fluid), dem_(dem) {}

    /// Rock without a velocity starts at rest.
    std::vector<int> insert(const std::vector<FeedRock>& due) override;
    std::vector<bool> room_for(const std::vector<FeedRock>& rocks) const override;
    void remove(gsl::span<const int> ids) override { dem_.remove(ids); }
    void adopt_present_rock() override {}
    void sample() override {}
    /// Infinity: the DEM divides a step by its own rule.
    double travel_limit() const override;
    const DemStep& move() override;
    void map() override {}
    gsl::span<const double> void_fraction_old() const override { return {}; }
    gsl::span<const double> void_fraction_new() const override { return {}; }
    MomentumExchange exchange() const override { return {}; }
    ExchangeBalance book() override { return {}; }
    std::vector<std::string> take_warnings() override { return {}; }
    const std::vector<Vec3>& carry() const override { return carry_; }
    const BookedExchange& booked() const override { return booked_; }
    void restore(std::vector<Vec3>, const BookedExchange&) override {}

private:
    HydrodynamicForce resistance() const;

    std::optional<CalmingSettings> calming_;
    const FluidEngine& fluid_;
    DemEngine& dem_;
    DemStep step_;
    std::vector<Vec3> carry_;  // empty: there are no cells
    BookedExchange booked_;    // zero
};

}  // namespace cutterflow::coupling
