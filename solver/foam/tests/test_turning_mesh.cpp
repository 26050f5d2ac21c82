// What must not happen because the mesh turns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/foam/mesh_motion/overlap_flux.hpp"
#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/single_phase/cutter_fluid.hpp"
#include "solver/foam/tests/fluid_run.hpp"

#include "dynamicFvMesh.H"
#include "fvc.H"
#include "nearWallDist.H"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;

constexpr double k_omega = 2.0 * k_pi;  // 60 rpm

/// A cylinder whose whole boundary carries the velocity `u`.
testing::TinyCase cylinder(const std::string& name, const testing::TurningCylinder& shape, const std::string& u, double time_step,
                           double end_time) {
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(shape), time_step, end_time);
    tiny.files["constant/dynamicMeshDict"] = testing::turning(k_omega);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", u, "\".*\" { type fixedValue; value $internalField; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    return tiny;
}

/// Distances of the wall, which wall functions ask the registered model for, are computed once.
TEST(TurningMesh, KeepsTheDistancesOfTheWall) {
    testing::TurningAnnulus shape;
    shape.cells_around_quarter = shape.stator_cells_around_quarter = 4;
    testing::TinyCase tiny = testing::laminar_case("wall_distance", testing::block_mesh(shape), 0.01, 0.1);
    tiny.files["constant/dynamicMeshDict"] = testing::turning(k_omega);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*\" { type slip; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type zeroGradient; }");
    FluidRun run(testing::build_case(tiny), false);
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
    }
    const Foam::fvMesh& mesh = run.session().mesh();
    const auto& kept = mesh.lookupObject<Foam::turbulenceModel>(Foam::turbulenceModel::propertiesName).y();
    const Foam::nearWallDist computed(mesh);
    double worst = 0.0, largest = 0.0;
    for (const char* wall : {"hub", "rim"}) {
        const Foam::label patch = mesh.boundaryMesh().findPatchID(wall);
        worst = std::max(worst, Foam::max(Foam::scalarField(Foam::mag(kept[patch] - computed[patch]))));
        largest = std::max(largest, Foam::max(computed[patch]));
    }
    EXPECT_GT(run.largest(largest), 1e-3);
    EXPECT_LE(run.largest(worst), 1e-12);
}

double blob(const Vec3& point, const Vec3& centre, double depth, double sigma) {
    return 1.0 - depth * std::exp(-0.5 * (point - centre).squaredNorm() / (sigma * sigma));
}

TEST(TurningMesh, UniformFlowStaysUniform) {
    FluidRun run(testing::build_case(cylinder("uniform_flow", {}, "(0.7 -0.3 0.2)", 2e-3, 0.05)), false);
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
    }
    EXPECT_NEAR(run.engine().time(), 0.05, 1e-12);
    EXPECT_LE(run.deviation(Vec3(0.7, -0.3, 0.2)), 1e-10);
}

TEST(TurningMesh, RockAtRestRaisesNoFlow) {
    FluidRun run(testing::build_case(cylinder("rock_at_rest", {}, "(0 0 0)", 2e-3, 0.05)), true);
    while (run.engine().running()) {
        run.begin();
        const auto fraction = run.evaluate([](const Vec3& x) { return blob(x, Vec3(0.05, 0.02, 0.0), 0.6, 0.02); });
        run.end(fraction, fraction);
    }
    EXPECT_LE(run.deviation(Vec3::Zero()), 1e-10);
}

/// Makes faces of the interface carry the sum of their parts, as the solver's flux does, of a uniform velocity.
class PartsOfUniformFlow {
public:
    PartsOfUniformFlow(Foam::dynamicFvMesh& mesh, const Vec3& u)
        : zones_(read_moving_zones(mesh)), overlap_(mesh, zones_, 0.0), parts_(mesh), u_(to_foam(u)) {}

    void set(Foam::surfaceScalarField& flux, const Foam::volScalarField& alpha, double time) {
        overlap_.set(zones_.motion.front().angle(time));
        parts_.couple(overlap_);
        for (const PartFluxes& part : parts_.sides()) {
            const Foam::scalarField of_parts(part.side.mean(alpha.primitiveField()) * (u_ & part.side.area()));
            flux.boundaryFieldRef()[part.side.patch()] = part.side.sum(of_parts);
        }
    }

private:
    MovingZones zones_;
    SlidingOverlap overlap_;
    OverlapFlux parts_;
    Foam::vector u_;
};

// Both sides of the interface carry the same flow, though their faces do not meet: water that is thrown against the rim of a turning
// cylinder.
TEST(TurningMesh, WhatLeavesOneSideOfTheInterfaceEntersTheOther) {
    testing::TinyCase tiny = cylinder("thrown", {}, "(0.7 -0.3 0.2)", 2e-3, 0.05);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0.7 -0.3 0.2)", "\".*\" { type fixedValue; value uniform (0 0 0); }");
    FluidRun run(testing::build_case(tiny), false);
    double worst = 0.0;
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
        if (run.engine().time() > 0.025) worst = std::max(worst, run.engine().loads().interface_imbalance);
    }
    EXPECT_LE(worst, 1e-12);
    EXPECT_GE(run.deviation(Vec3(0.7, -0.3, 0.2)), 0.1);
}

/// Velocities after eight turning steps with rock, limited gradients and convection of second order, and the sum of all stresses.
std::vector<Vec3> thrown_past_rock(const std::string& name, const std::string& cached) {
    testing::TinyCase tiny = cylinder(name, {}, "(0.7 -0.3 0.2)", 2e-3, 0.016);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0.7 -0.3 0.2)", "\".*\" { type fixedValue; value uniform (0 0 0); }");
    tiny.files["system/fvSchemes"] +=
        "gradSchemes { grad(U) cellLimited Gauss linear 1; } divSchemes { div(phi,U) Gauss linearUpwindV grad(U); }\n";
    tiny.files["system/fvSolution"] += cached;
    FluidRun run(testing::build_case(tiny), true);
    Vec3 stresses = Vec3::Zero();
    while (run.engine().running()) {
        run.begin();
        for (const Vec3& stress : run.engine().stress_divergence()) stresses += stress;
        std::fill(run.inertia.begin(), run.inertia.end(), 0.2);
        const auto fraction = run.evaluate([](const Vec3& x) { return blob(x, Vec3(0.05, 0.02, 0.0), 0.6, 0.02); });
        run.end(fraction, fraction);
    }
    const auto velocity = run.engine().fields().velocity;
    std::vector<Vec3> result(velocity.begin(), velocity.end());
    result.push_back(stresses);
    return result;
}

// A gradient that is kept from one use to the next is never that of another velocity or of the mesh before the step.
TEST(TurningMesh, KeptGradientsChangeNothing) {
    const std::vector<Vec3> anew = thrown_past_rock("gradients_anew", "");
    const std::vector<Vec3> kept = thrown_past_rock("gradients_kept", "cache { grad(U) on; }\n");
    ASSERT_EQ(anew.size(), kept.size());
    for (std::size_t i = 0; i < anew.size(); ++i) EXPECT_EQ(anew[i], kept[i]) << i;
}

// The old void fraction is the one that a uniform velocity makes of the new one by the solver's own flux, so that the uniform velocity is
// the solution of the discrete equations, wherever the rock is and however the mesh turns below it.
TEST(TurningMesh, UniformFlowCarriesRockWithoutBendingAroundIt) {
    const Vec3 u(0.7, -0.3, 0.2);
    FluidRun run(testing::build_case(cylinder("carried_rock", {}, "(0.7 -0.3 0.2)", 2e-3, 0.03)), true);
    Foam::dynamicFvMesh& mesh = run.session().mesh();
    PartsOfUniformFlow parts(mesh, u);
    while (run.engine().running()) {
        run.begin();
        const auto new_fraction = run.evaluate([](const Vec3& x) { return blob(x, Vec3(0.08, 0.02, 0.0), 0.6, 0.02); });
        Foam::volScalarField alpha(Foam::IOobject("alphaOfTest", mesh.time().timeName(), mesh), mesh,
                                   Foam::dimensionedScalar("one", Foam::dimless, 1.0), "zeroGradient");
        std::copy(new_fraction.begin(), new_fraction.end(), alpha.primitiveFieldRef().begin());
        alpha.correctBoundaryConditions();
        Foam::surfaceScalarField flux(Foam::fvc::interpolate(alpha) *
                                      (mesh.Sf() & Foam::dimensionedVector("u", Foam::dimVelocity, to_foam(u))));
        parts.set(flux, alpha, run.engine().time());
        const Foam::scalarField outflow(Foam::fvc::div(flux)().primitiveField());
        std::vector<double> old_fraction(new_fraction);
        for (std::size_t i = 0; i < old_fraction.size(); ++i) old_fraction[i] += run.engine().time_step() * outflow[i];
        run.end(old_fraction, new_fraction);
    }
    EXPECT_LE(run.deviation(u), 1e-10);
}

/// A rock that crosses the turning interface at 0.5 m/s in a closed cylinder of water at rest.
class Crossing {
public:
    struct Result {
        double pressure_range_before = 0.0;
        double pressure_range_crossing = 0.0;
        double displaced_ratio = 0.0;  ///< volume of fluid that the outflow of the zone brought back in, over the rock's that left it
    };

    explicit Crossing(double time_step) : run_(testing::build_case(case_of(time_step)), true) {}

    /// `before` ends when the rock's kernel reaches the interface; `from` to `to` are where its centre crosses it [m].
    Result cross(double before, double from, double to) {
        Result result;
        result.pressure_range_before = range_while_moving(before - 60 * step(), before);
        volume_in_ = volume_out_ = 0.0;
        result.pressure_range_crossing = range_while_moving(from, to);
        result.displaced_ratio = volume_in_ / volume_out_;
        return result;
    }

private:
    static constexpr double k_speed = 0.5;
    static constexpr double k_sigma = 0.02;
    static constexpr int k_starting_steps = 20;  // the rock sets off in water at rest, which takes an impulse

    static testing::TinyCase case_of(double time_step) {
        testing::TurningCylinder shape;
        shape.radius_interface = 0.12;
        shape.radius = 0.24;
        shape.height = 0.16;
        shape.cells_around_quarter = 14;
        shape.stator_cells_around_quarter = 16;
        shape.cells_in_rotor_ring = 6;
        shape.cells_in_stator = 13;
        shape.cells_high = 14;
        testing::TinyCase tiny = cylinder(time_step < 5e-4 ? "crossing_short_step" : "crossing", shape, "(0 0 0)", time_step, 10.0);
        tiny.files["system/fvSolution"] +=
            "solvers { \"p.*\" { solver GAMG; smoother DICGaussSeidel; cacheAgglomeration no; tolerance 1e-9; } }\n";
        return tiny;
    }

    double step() { return k_speed * run_.engine().time_step(); }

    /// Solid fraction of a sphere of 20 mm with a kernel that ends smoothly at 3 sigma, normalised over the cells.
    std::vector<double> void_fraction(double x) {
        const double cut = 4.5, value = std::exp(-cut);
        std::vector<double> weight = run_.evaluate([&](const Vec3& point) {
            const double q = 0.5 * (point - Vec3(x, 0.003, 0.001)).squaredNorm() / (k_sigma * k_sigma);
            return q < cut ? std::exp(-q) - value * (1.0 + cut - q) : 0.0;
        });
        const auto volumes = run_.engine().cells().volumes;
        double sum = 0.0;
        for (std::size_t i = 0; i < weight.size(); ++i) sum += weight[i] * volumes[i];
        sum = run_.total(sum);
        const double rock_volume = k_pi / 6.0 * std::pow(0.02, 3);
        for (double& w : weight) w = 1.0 - rock_volume * w / sum;
        return weight;
    }

    double range_while_moving(double from, double to) {
        double range = 0.0;
        const int steps = static_cast<int>(std::lround((to - from) / step()));
        for (int i = 0; i < steps; ++i) {
            run_.begin();
            const double x = from + i * step();
            const auto old_fraction = void_fraction(x);
            const auto new_fraction = void_fraction(x + step());
            run_.end(old_fraction, new_fraction);
            book_volumes(old_fraction, new_fraction);
            if (i >= k_starting_steps) range = std::max(range, pressure_range());
        }
        return range;
    }

    double pressure_range() {
        const auto& p = run_.session().mesh().lookupObject<Foam::volScalarField>("p");
        double low = 1e30, high = -1e30;
        for (const double value : p.primitiveField()) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
        return run_.largest(high) + run_.largest(-low);
    }

    /// Fluid that flowed into the rotor zone, measured on the stator's side of the interface, and rock that left the zone in the step.
    void book_volumes(const std::vector<double>& old_fraction, const std::vector<double>& new_fraction) {
        const Foam::fvMesh& mesh = run_.session().mesh();
        const Foam::label patch = mesh.boundaryMesh().findPatchID("stator_interface");
        const auto& phi = mesh.lookupObject<Foam::surfaceScalarField>("phi");
        const auto& alpha = mesh.lookupObject<Foam::volScalarField>("voidFraction");
        const Foam::surfaceScalarField alphaf(Foam::fvc::interpolate(alpha));
        double inflow = 0.0, rock_out = 0.0;
        for (Foam::label i = 0; i < mesh.boundary()[patch].size(); ++i) {
            inflow += alphaf.boundaryField()[patch][i] * phi.boundaryField()[patch][i];
        }
        const coupling::Cells cells = run_.engine().cells();
        for (std::size_t i = 0; i < old_fraction.size(); ++i) {
            if (cells.zone[i] != 0) rock_out += (new_fraction[i] - old_fraction[i]) * cells.volumes[i];
        }
        volume_in_ += run_.total(inflow) * run_.engine().time_step();
        volume_out_ += run_.total(rock_out);
    }

    FluidRun run_;
    double volume_in_ = 0.0;
    double volume_out_ = 0.0;
};

TEST(TurningMesh, RockThatCrossesTheInterfaceDisplacesItsVolumeAndNoMore) {
    const Crossing::Result result = Crossing(1e-3).cross(0.06, 0.1, 0.135);
    EXPECT_LE(result.pressure_range_crossing, 1.1 * result.pressure_range_before);
    EXPECT_NEAR(result.displaced_ratio, 1.0, 1e-3);
    RecordProperty("range_ratio", std::to_string(result.pressure_range_crossing / result.pressure_range_before));
    RecordProperty("displaced_ratio", std::to_string(result.displaced_ratio));
}

TEST(TurningMesh, PressureOfACrossingRockDoesNotGrowWithShorterSteps) {
    if (PstreamCommunicator().size() > 1) GTEST_SKIP() << "the long step is tested on several ranks";
    const Crossing::Result result = Crossing(2e-4).cross(0.06, 0.116, 0.124);
    EXPECT_LE(result.pressure_range_crossing, 1.1 * result.pressure_range_before);
    EXPECT_NEAR(result.displaced_ratio, 1.0, 1e-3);
    RecordProperty("range_ratio", std::to_string(result.pressure_range_crossing / result.pressure_range_before));
    RecordProperty("displaced_ratio", std::to_string(result.displaced_ratio));
}

}  // namespace
}  // namespace cutterflow::foam
