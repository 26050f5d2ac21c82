// Circular Couette flow through a sliding interface that stands still or turns: velocity and torque have closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include <fmt/format.h>

#include "solver/foam/tests/fluid_run.hpp"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;

constexpr double k_omega = k_pi;
constexpr double k_viscosity = 2e-3;  // kinematic [m2/s]
constexpr double k_density = 1000.0;

struct CouetteResult {
    double velocity_error = 0.0;  ///< L2, over the hub's speed
    coupling::FluidLoads loads;
};

/// Serial only: on two ranks these small meshes do little but wait for each other.
class Couette : public ::testing::Test {
protected:
    void SetUp() override {
        if (PstreamCommunicator().size() > 1) GTEST_SKIP();
    }
};

/// Hub turning at k_omega, rim at rest; with `turning` the hub's zone of the mesh turns along.
CouetteResult run_couette(const std::string& name, testing::TurningAnnulus shape, bool turning, double time_step = 2e-3) {
    shape.plane = true;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(shape), time_step, 0.9);
    tiny.files["constant/transportProperties"] = fmt::format("transportModel Newtonian; nu {}; rho {};", k_viscosity, k_density);
    const std::string hub = turning ? "type movingWallVelocity; value uniform (0 0 0);"
                                    : fmt::format(
                                          "type rotatingWallVelocity; origin (0 0 0); axis (0 0 1); omega {:.17g}; "
                                          "value uniform (0 0 0);",
                                          k_omega);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "rim { type noSlip; } hub { " + hub + " }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type zeroGradient; }");
    if (turning) tiny.files["constant/dynamicMeshDict"] = testing::turning(k_omega);

    FluidRun run(testing::build_case(tiny), false);
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
    }
    const double r1 = shape.radius_hub, r2 = shape.radius;
    const double a = -k_omega * r1 * r1 / (r2 * r2 - r1 * r1), b = k_omega * r1 * r1 * r2 * r2 / (r2 * r2 - r1 * r1);
    double square = 0.0, volume = 0.0;
    const auto velocity = run.engine().fields().velocity;
    for (std::size_t i = 0; i < run.cells(); ++i) {
        const Vec3 x = run.centre(i);
        const double r = std::hypot(x.x(), x.y());
        const Vec3 exact = Vec3(-x.y(), x.x(), 0.0) / r * (a * r + b / r);
        square += (velocity[i] - exact).squaredNorm() * run.engine().cells().volumes[i];
        volume += run.engine().cells().volumes[i];
    }
    CouetteResult result;
    result.velocity_error = std::sqrt(run.total(square) / run.total(volume)) / (k_omega * r1);
    result.loads = run.engine().loads();
    return result;
}

/// Torque of the fluid on the hub about the axis [N m]: -4 pi mu Omega H R1^2 R2^2 / (R2^2 - R1^2).
double exact_torque(const testing::TurningAnnulus& s) {
    const double r1 = s.radius_hub * s.radius_hub, r2 = s.radius * s.radius;
    return -4.0 * k_pi * k_density * k_viscosity * k_omega * s.height * r1 * r2 / (r2 - r1);
}

TEST_F(Couette, HoldsThroughAnInterfaceThatTurns) {
    testing::TurningAnnulus shape;
    shape.stator_cells_around_quarter = 20;
    shape.cells_in_rotor = 32;  // the wall's shear is of first order in the first cell's height
    // The explicit part of the stress is stable up to nu dt/h^2 = 3.7, measured; 6.5 is not.
    const CouetteResult turning = run_couette("couette_turning", shape, true, 1e-3);
    EXPECT_LE(turning.velocity_error, 0.01);
    EXPECT_NEAR(turning.loads.torque_viscous / exact_torque(shape), 1.0, 0.01);
    EXPECT_LE(std::abs(turning.loads.torque_pressure), 1e-3 * std::abs(exact_torque(shape)));
}

TEST_F(Couette, IsTheSameThroughAnInterfaceAtRest) {
    testing::TurningAnnulus shape;
    const CouetteResult still = run_couette("couette_still", shape, false);
    EXPECT_LE(still.velocity_error, 0.01);
}

/// A predictor that does not turn with the mesh has too little speed, and passes it on through the viscous terms.
TEST_F(Couette, HasATorqueThatDoesNotDependOnTheStep) {
    testing::TurningAnnulus shape;
    shape.cells_in_rotor = shape.cells_in_stator = 8;
    shape.cells_around_quarter = shape.stator_cells_around_quarter = 16;
    const auto torque = [&](double step) { return run_couette("couette_torque", shape, true, step).loads.torque_viscous; };
    EXPECT_NEAR(torque(8e-3) / torque(2e-3), 1.0, 5e-4);
}

TEST_F(Couette, ErrorFallsWithTheSquareOfTheCellSize) {
    testing::TurningAnnulus coarse, fine;
    coarse.cells_in_rotor = coarse.cells_in_stator = 4;
    coarse.cells_around_quarter = coarse.stator_cells_around_quarter = 8;
    fine.cells_in_rotor = fine.cells_in_stator = 8;
    fine.cells_around_quarter = fine.stator_cells_around_quarter = 16;
    const double error_coarse = run_couette("couette_coarse", coarse, true).velocity_error;
    const double error_fine = run_couette("couette_fine", fine, true).velocity_error;
    EXPECT_GE(std::log2(error_coarse / error_fine), 1.5);
}

}  // namespace
}  // namespace cutterflow::foam
