// What the fluid says it received adds up to what its state gained, at any setting of the correctors, and on a turning mesh to what rock
// gave it; and a leaking wall shows.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/foam/tests/fluid_run.hpp"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;

/// Momentum over density of all ranks [m4/s].
Vec3 total(FluidRun& run, gsl::span<const double> weight, gsl::span<const Vec3> values) {
    const auto volumes = run.engine().cells().volumes;
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < run.cells(); ++c) sum += volumes[c] * weight[c] * values[c];
    return {run.total(sum.x()), run.total(sum.y()), run.total(sum.z())};
}

Vec3 momentum(FluidRun& run) {
    return total(run, run.engine().fields().void_fraction, run.engine().fields().velocity);
}

/// Solid fraction of a cloud that moves at 0.5 m/s and keeps its volume.
std::vector<double> cloud(FluidRun& run, double time) {
    std::vector<double> solid =
        run.evaluate([time](const Vec3& x) { return std::exp(-0.5 * (x - Vec3(0.5 * time, 0.02, 0.01)).squaredNorm() / (0.02 * 0.02)); });
    double volume = 0.0;
    for (std::size_t c = 0; c < run.cells(); ++c) volume += run.engine().cells().volumes[c] * solid[c];
    volume = run.total(volume);
    for (double& fraction : solid) fraction *= 3e-5 / volume;
    return solid;
}

std::vector<double> void_fraction(std::vector<double> solid) {
    for (double& fraction : solid) fraction = 1.0 - fraction;
    return solid;
}

std::vector<Vec3> copy_of(gsl::span<const Vec3> values) {
    return {values.begin(), values.end()};
}

/// Momentum over density that rock has handed over in a step [m4/s], from the flow before it.
Vec3 given(FluidRun& run, const std::vector<Vec3>& velocity, const std::vector<Vec3>& acceleration) {
    const coupling::FluidFields now = run.engine().fields();
    std::vector<Vec3> rate(run.cells());
    for (std::size_t c = 0; c < run.cells(); ++c)
        rate[c] = run.source[c] - run.drag_rate[c] * (now.velocity[c] - velocity[c]) -
                  run.inertia[c] * (now.material_acceleration[c] - acceleration[c]);
    return run.engine().time_step() * total(run, std::vector<double>(run.cells(), 1.0), rate);
}

struct Errors {
    double balance = 0.0;   ///< largest error of a step's balance over what the fluid received in it
    double received = 0.0;  ///< |received - given| over what was given in the last step
};

/// Drives the fluid with a cloud that moves through it.
Errors errors_of(FluidRun& run, double density) {
    const std::vector<double> everywhere(run.cells(), 1.0);
    Errors errors;
    bool first = true;
    while (run.engine().running()) {
        const double before = run.engine().time();
        const Vec3 old_momentum = momentum(run);
        const std::vector<Vec3> velocity = copy_of(run.engine().fields().velocity);
        const std::vector<Vec3> acceleration = copy_of(run.engine().fields().material_acceleration);
        run.begin();
        const double now = run.engine().time();
        const std::vector<double> solid = cloud(run, now);
        for (std::size_t c = 0; c < run.cells(); ++c) {
            run.source[c] = 10.0 * solid[c] * Vec3(1.0, 0.2, -0.1);
            run.drag_rate[c] = 20.0 * solid[c];
            run.inertia[c] = 1.5 * solid[c];
        }
        run.end(void_fraction(cloud(run, before)), void_fraction(solid));
        const coupling::FluidLoads loads = run.engine().loads();
        const Vec3 outside = (loads.boundary_impulse + loads.interface_impulse + loads.replaced_momentum + loads.turned_momentum) / density;
        const Vec3 received = run.engine().time_step() * total(run, everywhere, run.engine().received());
        // The cloud appears in the first step.
        if (!first) errors.balance = std::max(errors.balance, (momentum(run) - old_momentum - outside - received).norm() / received.norm());
        first = false;
        const Vec3 gave = given(run, velocity, acceleration);
        errors.received = (received - gave).norm() / gave.norm();
    }
    return errors;
}

TEST(Momentum, ReceivedInAPeriodicBoxIsWhatTheStateGained) {
    testing::Box box;
    for (int i = 0; i < 3; ++i) {
        box.cells[i] = 8;
        box.lower[i] = -0.08;
        box.upper[i] = 0.08;
    }
    box.periodic_x = true;
    testing::TinyCase tiny = testing::laminar_case("momentum_box", testing::block_mesh(box), 1e-3, 0.02);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*\" { type noSlip; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    tiny.files["constant/transportProperties"] = "transportModel Newtonian; nu 1e-3; rho 1000;\n";
    FluidRun run(testing::build_case(tiny), true);
    EXPECT_LE(errors_of(run, 1000.0).balance, 1e-9);
    EXPECT_GE(run.deviation(Vec3::Zero()), 1e-3);
}

TEST(Momentum, ReceivedOnATurningMeshIsWhatTheStateGained) {
    testing::TinyCase tiny = testing::laminar_case("momentum_turning", testing::block_mesh(testing::TurningCylinder{}), 1e-3, 0.02);
    tiny.files["constant/dynamicMeshDict"] = testing::turning(2.0 * k_pi);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*\" { type fixedValue; value $internalField; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    FluidRun run(testing::build_case(tiny), true);
    const Errors errors = errors_of(run, 1000.0);
    EXPECT_LE(errors.balance, 1e-8);
    EXPECT_LE(errors.received, 0.02);
    EXPECT_GE(run.deviation(Vec3::Zero()), 1e-3);
}

// A duct whose upper wall lets through half of the discharge: every cell closes, and still the balance does not.
TEST(Flow, ThroughALeakingWallShows) {
    testing::Box box;
    box.upper[0] = 0.5;
    box.upper[1] = box.upper[2] = 0.1;
    box.cells[0] = 25;
    box.cells[1] = box.cells[2] = 5;
    box.duct = true;
    testing::TinyCase tiny = testing::laminar_case("leaking_wall", testing::block_mesh(box), 2e-3, 0.01);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(1 0 0)",
                                              "\".*\" { type slip; } z_max { type fixedValue; value uniform (0 0 0.1); }\n"
                                              "inlet { type fixedValue; value $internalField; }\n"
                                              "outlet { type pressureInletOutletVelocity; value $internalField; }");
    tiny.files["0/p"] = testing::volume_field(
        "[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; } outlet { type fixedValue; value uniform 0; }");
    FluidRun run(testing::build_case(tiny), false);
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
    }
    const coupling::FluidLoads loads = run.engine().loads();
    EXPECT_LE(loads.continuity_error, 1e-8);
    EXPECT_NEAR(loads.wall_flow, 0.005, 1e-9);
    EXPECT_NEAR(loads.boundary_flow, -0.005, 1e-9);
}

}  // namespace
}  // namespace cutterflow::foam
