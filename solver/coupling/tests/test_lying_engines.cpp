// Every published balance fails when an engine lies, and holds when none does.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/coupling/tests/coupling_rig.hpp"

namespace cutterflow::coupling {
namespace {

using testing::FakeDem;
using testing::FakeFluid;

constexpr double k_half = 0.15, k_cell = 0.01;
constexpr int k_steps = 40;

/// Takes nothing and keeps its velocity, whatever it says.
class DeafFluid : public FakeFluid {
public:
    using FakeFluid::FakeFluid;
    void end_step(gsl::span<const double> old_values, gsl::span<const double> new_values, const MomentumExchange& exchange) override {
        const std::vector<Vec3> kept = velocity;
        FakeFluid::end_step(old_values, new_values, exchange);
        velocity = kept;
        acceleration.assign(velocity.size(), Vec3::Zero());
        for (Vec3& received : received_) received = says(received);
    }

private:
    virtual Vec3 says(const Vec3& would_have_received) = 0;
};

class BoastfulFluid final : public DeafFluid {
    using DeafFluid::DeafFluid;
    Vec3 says(const Vec3& would_have_received) override { return would_have_received; }
};

class BabblingFluid final : public DeafFluid {
    using DeafFluid::DeafFluid;
    Vec3 says(const Vec3&) override { return Vec3(any_(random_), any_(random_), any_(random_)); }
    std::mt19937 random_{7};
    std::uniform_real_distribution<double> any_{-5.0, 5.0};
};

class HonestDeafFluid final : public DeafFluid {
    using DeafFluid::DeafFluid;
    Vec3 says(const Vec3&) override { return Vec3::Zero(); }
};

/// Takes nothing, says that it took, and books what is then missing as an impulse that it did not have.
template <Vec3 FluidLoads::*blamed>
class FluidThatBlames final : public DeafFluid {
public:
    using DeafFluid::DeafFluid;
    void end_step(gsl::span<const double> old_values, gsl::span<const double> new_values, const MomentumExchange& exchange) override {
        DeafFluid::end_step(old_values, new_values, exchange);
        (given_loads.*blamed).setZero();
        for (std::size_t c = 0; c < mesh.size(); ++c) given_loads.*blamed -= density * mesh.volumes[c] * time_step() * received_[c];
    }

private:
    Vec3 says(const Vec3& would_have_received) override { return would_have_received; }
};

/// Takes a tenth of what it is given, and says so.
class ReluctantFluid final : public FakeFluid {
public:
    using FakeFluid::FakeFluid;
    void end_step(gsl::span<const double> old_values, gsl::span<const double> new_values, const MomentumExchange& exchange) override {
        constexpr double share = 0.1;
        const std::vector<Vec3> before = velocity;
        FakeFluid::end_step(old_values, new_values, exchange);
        for (std::size_t c = 0; c < mesh.size(); ++c) {
            velocity[c] = before[c] + share * (velocity[c] - before[c]);
            acceleration[c] = (velocity[c] - before[c]) / time_step();
            received_[c] = void_fraction[c] * acceleration[c];
        }
    }
};

/// Its wall at the lower end of x takes a hundredth of the momentum beside it, and no force on the boundary is reported.
class FluidAtLeakyWall final : public FakeFluid {
public:
    using FakeFluid::FakeFluid;
    void end_step(gsl::span<const double> old_values, gsl::span<const double> new_values, const MomentumExchange& exchange) override {
        FakeFluid::end_step(old_values, new_values, exchange);
        for (std::size_t c = 0; c < mesh.size(); ++c)
            if (mesh.centres[c].x() < -k_half + k_cell) velocity[c] *= 0.99;
    }
};

/// Keeps the void fraction that it had.
class FluidWithoutRoom final : public FakeFluid {
public:
    using FakeFluid::FakeFluid;
    void end_step(gsl::span<const double> old_values, gsl::span<const double> new_values, const MomentumExchange& exchange) override {
        const std::vector<double> kept = void_fraction;
        FakeFluid::end_step(old_values, new_values, exchange);
        for (std::size_t c = 0; c < mesh.size(); ++c) void_fraction[c] = 0.5 * (1.0 + kept[c]);
    }
};

constexpr double k_shrinkage = 0.01;

/// Shrinks its cells by a hundredth after the weights of rock were made for them, and keeps the promise of no array.
class FluidThatShrinks final : public FakeFluid {
public:
    using FakeFluid::FakeFluid;
    void begin_step(double travel_limit, double stop_time) override {
        FakeFluid::begin_step(travel_limit, stop_time);
        if (std::exchange(has_shrunk_, true)) return;
        for (double& volume : mesh.volumes) volume *= 1.0 - k_shrinkage;
    }

private:
    bool has_shrunk_ = false;
};

/// Stops rock at a wall at x = 0 without saying so.
class DemWithSilentWall final : public FakeDem {
public:
    using FakeDem::FakeDem;
    DemStep advance(double duration, const HydrodynamicForce& force) override {
        DemStep step = FakeDem::advance(duration, force);
        for (std::size_t p = 0; p < rocks_.size(); ++p)
            if (rocks_.position[p].x() > 0.0) rocks_.velocity[p].x() = 0.0;
        return step;
    }
};

/// Loses the first rock.
class DemWithLeak final : public FakeDem {
public:
    using FakeDem::FakeDem;
    DemStep advance(double duration, const HydrodynamicForce& force) override {
        DemStep step = FakeDem::advance(duration, force);
        remove(std::vector<int>{rocks_.id.front()});
        step.impulse.erase(step.impulse.begin());
        step.contact_impulse.erase(step.contact_impulse.begin());
        return step;
    }
};

/// Largest errors over all steps.
struct Worst {
    ExchangeBalance exchange;
    MomentumErrors momentum;
    double owed = 0.0;  ///< median of MomentumErrors::carried
};

/// Twenty rocks that fall and fly through water at rest.
template <class Fluid, class Dem>
Worst run_with() {
    testing::CouplingRig<Fluid, Dem> rig(testing::box(k_half, k_cell), {}, 2e-3);
    rig.dem.gravity = Vec3(3.0, -1.0, -9.0);
    std::vector<FeedRock> due;
    for (int i = 0; i < 20; ++i)
        due.push_back(
            {i + 1, 0.0, Vec3(0.022 * (i % 5) - 0.1, 0.03 * (i / 5) - 0.04, 0.008 * i - 0.06), 0.02, 2650.0, Vec3(0.6, 0.1, -0.2)});
    rig.coupling.insert(due);
    Worst worst;
    std::vector<double> carried;
    for (int n = 0; n < k_steps; ++n) {
        const ExchangeBalance exchange = rig.step();
        const MomentumErrors& errors = rig.momentum_errors;
        worst.exchange.solid_volume_error = std::max(worst.exchange.solid_volume_error, exchange.solid_volume_error);
        worst.exchange.deposit_error = std::max(worst.exchange.deposit_error, exchange.deposit_error);
        for (double MomentumErrors::*error : {&MomentumErrors::error, &MomentumErrors::interface_error, &MomentumErrors::replaced,
                                              &MomentumErrors::turned, &MomentumErrors::carried, &MomentumErrors::boundary})
            worst.momentum.*error = std::max(worst.momentum.*error, errors.*error);
        carried.push_back(errors.carried);
    }
    std::nth_element(carried.begin(), carried.begin() + k_steps / 2, carried.end());
    worst.owed = carried[k_steps / 2];
    return worst;
}

constexpr double k_momentum_gate = 1e-10, k_volume_gate = 1e-12;
// The bounds of validation cases (validation/harness/momentum_carried.hpp): less than a step's exchange is owed to a fluid that takes what
// it is given.
constexpr double k_carried_gate = 1.0;
constexpr double k_replaced_gate = 0.03;  // cells of the fake do not carry momentum to each other with the fluid that rock pushes aside

TEST(HonestEngines, pass_every_gate) {
    const Worst worst = run_with<FakeFluid, FakeDem>();
    EXPECT_LE(worst.momentum.error, k_momentum_gate);
    EXPECT_LE(worst.momentum.carried, k_carried_gate);
    EXPECT_LE(worst.owed, k_carried_gate);
    EXPECT_EQ(worst.momentum.boundary, 0.0);
    EXPECT_EQ(worst.momentum.interface_error, 0.0);
    EXPECT_EQ(worst.momentum.turned, 0.0);
    EXPECT_LE(worst.momentum.replaced, k_replaced_gate);
    EXPECT_LE(worst.exchange.solid_volume_error, k_volume_gate);
    EXPECT_LE(worst.exchange.deposit_error, k_momentum_gate);
}

// The balance believes what a fluid says of impulses from elsewhere: their own columns show them.
template <Vec3 FluidLoads::*blamed>
double column_of(double MomentumErrors::*column) {
    const Worst worst = run_with<FluidThatBlames<blamed>, FakeDem>();
    EXPECT_LE(worst.momentum.error, k_momentum_gate);
    EXPECT_LE(worst.momentum.carried, k_carried_gate);
    return worst.momentum.*column;
}

TEST(FluidThatTakesNothing, shows_what_it_blames) {
    EXPECT_GE(column_of<&FluidLoads::boundary_impulse>(&MomentumErrors::boundary), 0.1);
    EXPECT_GE(column_of<&FluidLoads::interface_impulse>(&MomentumErrors::interface_error), 0.1);
    EXPECT_GE(column_of<&FluidLoads::turned_momentum>(&MomentumErrors::turned), 0.1);
    EXPECT_GE(column_of<&FluidLoads::replaced_momentum>(&MomentumErrors::replaced), 0.1);
}

TEST(FluidThatTakesNothing, fails_the_momentum_balance_when_it_says_that_it_took) {
    for (const Worst& worst : {run_with<BoastfulFluid, FakeDem>(), run_with<BabblingFluid, FakeDem>()}) {
        EXPECT_GE(worst.momentum.error, 0.1);
        EXPECT_LE(worst.exchange.deposit_error, k_momentum_gate);  // which says nothing of the fluid
    }
}

TEST(FluidThatTakesNothing, owes_more_and_more_when_it_says_so) {
    const Worst worst = run_with<HonestDeafFluid, FakeDem>();
    EXPECT_LE(worst.momentum.error, k_momentum_gate);
    EXPECT_GE(worst.momentum.carried, 10.0);
    EXPECT_GE(worst.owed, 5.0 * k_carried_gate);
}

TEST(FluidThatTakesATenth, owes_more_than_a_step_exchanges) {
    const Worst worst = run_with<ReluctantFluid, FakeDem>();
    EXPECT_LE(worst.momentum.error, k_momentum_gate);
    EXPECT_GE(worst.momentum.carried, 2.0 * k_carried_gate);
    EXPECT_GE(worst.owed, k_carried_gate);
}

TEST(WallThatLeaksMomentum, fails_the_momentum_balance) {
    EXPECT_GE((run_with<FluidAtLeakyWall, FakeDem>().momentum.error), 1e3 * k_momentum_gate);
    EXPECT_GE((run_with<FakeFluid, DemWithSilentWall>().momentum.error), 1e3 * k_momentum_gate);
}

TEST(FluidThatMakesNoRoom, fails_the_volume_balance) {
    EXPECT_GE((run_with<FluidWithoutRoom, FakeDem>().exchange.solid_volume_error), 0.1);
}

/// Weights that were normalised with other volumes lose a hundredth of the rock, and of what it hands over.
TEST(MappingThatLosesVolume, fails_the_balances_of_deposit_and_volume) {
    const Worst worst = run_with<FluidThatShrinks, FakeDem>();
    EXPECT_NEAR(worst.exchange.solid_volume_error, k_shrinkage, 1e-12);
    EXPECT_LE(worst.exchange.deposit_error, 1.1 * k_shrinkage);
    EXPECT_GE(worst.exchange.deposit_error, 0.9 * k_shrinkage);
}

TEST(RockThatVanishes, ends_the_run) {
    EXPECT_THROW((run_with<FakeFluid, DemWithLeak>()), CheckFailure);
}

}  // namespace
}  // namespace cutterflow::coupling
