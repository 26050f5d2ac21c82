// Flow through an open domain whose discharge is set at the outlet and whose pressure is set at the inlet.
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"

#include <cmath>

#include "solver/foam/tests/fluid_run.hpp"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;

constexpr double k_discharge = 0.01;  // [m3/s]
constexpr double k_area = 0.01;
constexpr double k_length = 0.5;

testing::TinyCase duct(const std::string& name, double end_time) {
    testing::Box box;
    box.upper[0] = k_length;
    box.upper[1] = box.upper[2] = 0.1;
    box.cells[0] = 25;
    box.cells[1] = box.cells[2] = 5;
    box.duct = true;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(box), 2e-3, end_time);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(1 0 0)",
                                              "\".*\" { type slip; } inlet { type pressureInletOutletVelocity; value $internalField; }\n"
                                              "outlet { type flowRateOutletVelocity; volumetricFlowRate " +
                                                  std::to_string(k_discharge) + "; value $internalField; }");
    tiny.files["0/p"] = testing::volume_field(
        "[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; } inlet { type fixedValue; value uniform 0; }");
    // Central differences let rounding errors grow at an outlet that sets the velocity.
    tiny.files["system/fvSchemes"] += "divSchemes { div(phi,U) Gauss upwind; }\n";
    return tiny;
}

// A cloud that moves with half the flow's speed and leaves through the outlet.
TEST(Duct, DischargeIsHeldAndDisplacedVolumeComesThroughTheInlet) {
    FluidRun run(testing::build_case(duct("duct_cloud", 0.6)), true, {"outlet", {}});
    const auto solid = [](double time) {
        return [time](const Vec3& x) { return 1.0 - 0.3 * std::exp(-0.5 * std::pow((x.x() - 0.3 - 0.5 * time) / 0.05, 2)); };
    };
    while (run.engine().running()) {
        const double before = run.engine().time();
        run.begin();
        const auto old_fraction = run.evaluate(solid(before));
        const auto new_fraction = run.evaluate(solid(run.engine().time()));
        run.end(old_fraction, new_fraction);
        double displaced = 0.0;
        for (std::size_t i = 0; i < run.cells(); ++i) {
            displaced += (new_fraction[i] - old_fraction[i]) * run.engine().cells().volumes[i] / run.engine().time_step();
        }
        const coupling::FluidLoads loads = run.engine().loads();
        EXPECT_NEAR(loads.outlet_flow.value(), k_discharge, 1e-12);
        EXPECT_NEAR(loads.boundary_flow + run.total(displaced), 0.0, 1e-9 * k_discharge);
        EXPECT_LE(loads.continuity_error, 1e-8);
        EXPECT_LE(run.deviation(Vec3(1.0, 0.0, 0.0)), 0.35);
    }
}

// A pressure that is not solved for: water at 1 m/s passes a cloud at half its speed, and each section misses what the cloud displaces
// there, 0.5 m/s times the change of its solid fraction. Up to the cloud's middle and after it that adds up to 2 x 0.5 m/s x 0.3 of the
// section.
TEST(Duct, APressureThatIsNotSolvedShowsInContinuity) {
    testing::TinyCase tiny = duct("duct_unsolved", 2e-3);
    tiny.files["system/fvSolution"] += "solvers { \"p.*\" { solver PBiCGStab; preconditioner DIC; tolerance 10; relTol 0; } }\n";
    FluidRun run(testing::build_case(tiny), true, {"outlet", {}});
    const auto solid = [](double time) {
        return [time](const Vec3& x) { return 1.0 - 0.3 * std::exp(-0.5 * std::pow((x.x() - 0.25 - 0.5 * time) / 0.05, 2)); };
    };
    run.begin();
    run.end(run.evaluate(solid(0.0)), run.evaluate(solid(2e-3)));
    EXPECT_NEAR(run.engine().loads().continuity_error, 0.15, 0.01);
    EXPECT_NEAR(run.engine().loads().outlet_flow.value(), k_discharge, 1e-12);
}

// What goes out through the wall comes in through the inlet: a sum of all flows would be 0.
TEST(Duct, AWallThatLeaksIsNoOutflow) {
    constexpr double speed = 0.02, leak = speed * k_length * 0.1;
    testing::TinyCase tiny = duct("duct_leak", 0.02);
    const std::string last = "outlet {";
    tiny.files["0/U"].insert(tiny.files["0/U"].find(last),
                             "z_min { type fixedValue; value uniform (0 0 " + std::to_string(-speed) + "); }\n");
    FluidRun run(testing::build_case(tiny), false, {"outlet", {}});
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
    }
    const coupling::FluidLoads loads = run.engine().loads();
    EXPECT_NEAR(loads.wall_flow, leak, 1e-9 * leak);
    EXPECT_NEAR(loads.boundary_flow, -leak, 1e-6 * leak);
    EXPECT_NEAR(loads.outlet_flow.value(), k_discharge, 1e-12);
    EXPECT_NEAR(loads.through_flow, k_discharge + 0.5 * leak, 1e-6 * leak);
}

// Rock that is sucked up is taken out between two steps, and fluid takes its place without a source. Fluid and rock together then pass
// every section below with the discharge of the outlet, also in the step of the removal: the mixture's flow is the discharge, the fluid's
// is that less the rock's. An outlet that let less through while rock is taken out would take it from the mixture.
TEST(Duct, TakingRockOutIsNoSourceSoThatTheMixtureFlowsWithTheDischarge) {
    FluidRun run(testing::build_case(duct("duct_removal", 0.2)), true, {"outlet", {}});
    const auto fraction_at = [&](double time) {
        if (time > 0.1) return std::vector<double>(run.cells(), 1.0);
        return run.evaluate([time](const Vec3& x) { return 1.0 - 0.3 * std::exp(-0.5 * std::pow((x.x() - 0.2 - 0.5 * time) / 0.05, 2)); });
    };
    const auto rock_volume = [&](const std::vector<double>& fraction) {
        double sum = 0.0;
        for (std::size_t i = 0; i < run.cells(); ++i) sum += (1.0 - fraction[i]) * run.engine().cells().volumes[i];
        return run.total(sum);
    };
    std::vector<double> present = fraction_at(0.0);
    double taken_out = 0.0;
    while (run.engine().running()) {
        run.begin();
        std::vector<double> next = fraction_at(run.engine().time());
        if (rock_volume(next) == 0.0 && rock_volume(present) > 0.0) {
            taken_out = rock_volume(present);
            present = next;
            run.engine().reset_void_fraction(present);
        }
        run.end(present, next);
        const double displaced = (rock_volume(present) - rock_volume(next)) / run.engine().time_step();
        const coupling::FluidLoads loads = run.engine().loads();
        const double inflow = loads.outlet_flow.value() - loads.boundary_flow;
        EXPECT_NEAR(loads.outlet_flow.value(), k_discharge, 1e-12);
        EXPECT_NEAR(inflow, k_discharge + displaced, 1e-9 * k_discharge);
        EXPECT_LE(loads.continuity_error, 1e-8);
        present = next;
    }
    EXPECT_GT(taken_out, 0.02 * k_discharge * 0.2);
}

// Rock held in the flow takes momentum out of it: the pressure falls along the duct by its drag over the section.
TEST(Duct, DragOfHeldRockIsThePressureDrop) {
    FluidRun run(testing::build_case(duct("duct_drag", 0.6)), true, {"outlet", {}});
    const double rate = 4.0;
    const std::vector<double> fraction(run.cells(), 0.9);
    while (run.engine().running()) {
        run.begin();
        for (std::size_t i = 0; i < run.cells(); ++i) {
            run.source[i] = -rate * run.engine().fields().velocity[i];
            run.drag_rate[i] = rate;
        }
        run.end(fraction, fraction);
    }
    EXPECT_LE(run.deviation(Vec3(1.0, 0.0, 0.0)), 1e-9);
    EXPECT_NEAR(run.engine().loads().outlet_pressure.value(), -rate * k_length, 1e-8);
}

// The measure of the balance is what passes the open patches, whatever they are called.
TEST(Duct, ThroughFlowNeedsNoNamedOutlet) {
    FluidRun run(testing::build_case(duct("duct_unnamed", 0.01)), false);
    run.begin();
    run.end({}, {});
    const coupling::FluidLoads loads = run.engine().loads();
    EXPECT_NEAR(loads.through_flow, k_discharge, 1e-9);
    EXPECT_LE(std::abs(loads.boundary_flow), 1e-9 * k_discharge);
    EXPECT_FALSE(loads.outlet_flow);
    EXPECT_FALSE(loads.outlet_pressure);
}

TEST(Duct, PatchRolesAreFoundByNameAndWrongOnesAreRefused) {
    const std::filesystem::path folder = testing::build_case(duct("duct_roles", 0.01));
    {
        FluidRun all(folder, false), one(folder, false, {"", {"z_min"}});
        EXPECT_EQ(all.engine().steel().of_zone.at(0).size(), 2u * (4u * 25u * 5u));
        EXPECT_EQ(one.engine().steel().of_zone.at(0).size(), 2u * 25u * 5u);
    }
    try {
        FluidRun run(folder, false, {"outlett", {"inlet", "floor"}});
        FAIL() << "accepted";
    } catch (const UserError& error) {
        ASSERT_EQ(error.mistakes().size(), 3u);
        EXPECT_NE(error.mistakes()[0].text().find("inlet, outlet, y_min"), std::string::npos) << error.mistakes()[0].text();
    }
}

}  // namespace
}  // namespace cutterflow::foam
