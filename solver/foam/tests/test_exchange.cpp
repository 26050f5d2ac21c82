// What rock hands to the fluid, and what the fluid says it received.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/error.hpp"
#include "solver/foam/tests/fluid_run.hpp"

#include "dynamicFvMesh.H"
#include "surfaceFields.H"
#include "surfaceInterpolate.H"
#include "volFields.H"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;

constexpr double k_g = 9.81;
constexpr double k_density_ratio = 2.65;

/// A closed box of water at rest; `walls` is the type of U on them.
testing::TinyCase closed_box(const std::string& name, const testing::Box& box, const std::string& walls, double time_step,
                             double end_time) {
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(box), time_step, end_time);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*\" { type " + walls + "; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    return tiny;
}

testing::Box column() {
    testing::Box box;
    box.upper[0] = box.upper[1] = 0.1;
    box.upper[2] = 0.4;
    box.cells[0] = box.cells[1] = 4;
    box.cells[2] = 32;
    return box;
}

/// Slope of p* along `direction` between the cells that lie deepest and highest along it [m/s2].
double pressure_slope(FluidRun& run, const Vec3& direction) {
    const auto& p = run.session().mesh().lookupObject<Foam::volScalarField>("p");
    const auto position = run.evaluate([&](const Vec3& x) { return x.dot(direction); });
    double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t i = 0; i < position.size(); ++i) {
        const double y = p[static_cast<Foam::label>(i)];
        n += 1.0, sx += position[i], sy += y, sxx += position[i] * position[i], sxy += position[i] * y;
    }
    for (double* sum : {&n, &sx, &sy, &sxx, &sxy}) *sum = run.total(*sum);
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

class Suspension : public ::testing::TestWithParam<double> {};

// Rock that settles at constant speed puts its weight under water on the fluid, so that dp/dz = (alpha_c rho_c + alpha_p rho_p) g; of p*,
// which leaves out rho_c g, that is alpha_p (rho_p - rho_c) g / rho_c.
TEST_P(Suspension, PressureCarriesTheWeightOfTheMixture) {
    const double inclination = GetParam() * k_pi / 180.0;
    const double solid = 0.2;
    const Vec3 down(std::sin(inclination), 0.0, -std::cos(inclination));
    FluidRun run(testing::build_case(closed_box("suspension_" + std::to_string(int(GetParam())), column(), "noSlip", 5e-3, 0.1)), true);
    std::fill(run.source.begin(), run.source.end(), solid * (k_density_ratio - 1.0) * k_g * down);
    const std::vector<double> fraction(run.cells(), 1.0 - solid);
    while (run.engine().running()) {
        run.begin();
        run.end(fraction, fraction);
    }
    const double mixture_weight = (1.0 - solid + solid * k_density_ratio) * k_g;
    EXPECT_NEAR((pressure_slope(run, down) + k_g) / mixture_weight, 1.0, 1e-9);
    EXPECT_LE(run.deviation(Vec3::Zero()), 1e-9);
}
INSTANTIATE_TEST_SUITE_P(Inclinations, Suspension, ::testing::Values(0.0, 30.0));

// A cloud with soft edges: the pressure difference across it is its weight over the column's section.
TEST(Suspension, ACloudWeighsOnThePressureBelowIt) {
    FluidRun run(testing::build_case(closed_box("cloud", column(), "slip", 5e-3, 0.1)), true);
    const auto solid = run.evaluate([](const Vec3& x) { return 0.3 * std::exp(-0.5 * std::pow((x.z() - 0.2) / 0.04, 2)); });
    std::vector<double> fraction(run.cells());
    double weight = 0.0;
    for (std::size_t i = 0; i < solid.size(); ++i) {
        fraction[i] = 1.0 - solid[i];
        run.source[i] = Vec3(0.0, 0.0, -solid[i] * (k_density_ratio - 1.0) * k_g);
        weight += solid[i] * (k_density_ratio - 1.0) * k_g * run.engine().cells().volumes[i];
    }
    while (run.engine().running()) {
        run.begin();
        run.end(fraction, fraction);
    }
    const auto& p = run.session().mesh().lookupObject<Foam::volScalarField>("p");
    double high = -1e30, low = 1e30;
    for (const double value : p.primitiveField()) {
        high = std::max(high, value);
        low = std::min(low, value);
    }
    const double difference = run.largest(high) + run.largest(-low);
    EXPECT_NEAR(difference * 0.1 * 0.1 / run.total(weight), 1.0, 1e-3);
    EXPECT_LE(run.deviation(Vec3::Zero()), 2e-3);
}

// A layer of rock sinks in a closed column: through every level as much fluid rises as rock sinks.
TEST(Displacement, OfASinkingLayerRisesPastIt) {
    const double time_step = 2e-3, speed = 0.2, thickness = 0.03;
    testing::Box box = column();
    box.cells[2] = 64;
    FluidRun run(testing::build_case(closed_box("sinking_layer", box, "slip", time_step, 0.1)), true);
    const auto solid = [&](double z, double time) { return 0.3 * std::exp(-0.5 * std::pow((z - 0.25 + speed * time) / thickness, 2)); };
    while (run.engine().running()) {
        const double before = run.engine().time();
        run.begin();
        const double now = run.engine().time();
        run.end(run.evaluate([&](const Vec3& x) { return 1.0 - solid(x.z(), before); }),
                run.evaluate([&](const Vec3& x) { return 1.0 - solid(x.z(), now); }));
    }
    const Foam::fvMesh& mesh = run.session().mesh();
    const auto& phi = mesh.lookupObject<Foam::surfaceScalarField>("phi");
    const Foam::surfaceScalarField alphaf(Foam::fvc::interpolate(mesh.lookupObject<Foam::volScalarField>("voidFraction")));
    double worst = 0.0;
    for (Foam::label face = 0; face < mesh.nInternalFaces(); ++face) {
        const double area = mesh.Sf()[face].z();
        const double rising = alphaf[face] * phi[face];
        const double sinking = area * speed * solid(mesh.Cf()[face].z(), run.engine().time() - 0.5 * time_step);
        worst = std::max(worst, std::abs(rising - sinking) / mesh.magSf()[face]);
    }
    EXPECT_LE(run.largest(worst), 0.005 * 0.3 * speed);
}

TEST(ClosedDomain, ShowsTheVolumeThatItHasTooMuch) {
    FluidRun run(testing::build_case(closed_box("surplus", column(), "slip", 1e-3, 0.01)), true);
    const std::vector<double> water(run.cells(), 1.0), less(run.cells(), 0.999);
    run.begin();
    run.end(water, less);
    EXPECT_NEAR(run.engine().loads().domain_surplus, 1e-3, 1e-12);
    run.begin();
    run.end(less, less);
    EXPECT_LE(run.engine().loads().domain_surplus, 1e-14);
}

/// Uniform fluid in a box that is periodic along x: nothing but the exchange acts, alpha du/dt = received.
class PeriodicBox : public ::testing::Test {
protected:
    static testing::TinyCase periodic_box(const std::string& name) {
        testing::Box box;
        for (int& cells : box.cells) cells = 4;
        box.periodic_x = true;
        return closed_box(name, box, "slip", 1e-3, 0.02);
    }
};

TEST_F(PeriodicBox, FluidGainsWhatItSaysItReceived) {
    const double solid = 0.4, alpha = 1.0 - solid, dt = 1e-3;
    FluidRun run(testing::build_case(periodic_box("received")), true);
    const std::vector<double> fraction(run.cells(), alpha);
    std::fill(run.source.begin(), run.source.end(), Vec3(3.0, 0.0, 0.0));
    std::fill(run.drag_rate.begin(), run.drag_rate.end(), 200.0);
    std::fill(run.inertia.begin(), run.inertia.end(), 1.5 * solid);
    double u = 0.0, a = 0.0;
    while (run.engine().running()) {
        run.begin();
        run.end(fraction, fraction);
        // alpha (u' - u)/dt = S - K (u' - u) - M ((u' - u)/dt - a)
        const double change = (3.0 + 1.5 * solid * a) / (alpha / dt + 200.0 + 1.5 * solid / dt);
        u += change;
        a = change / dt;
        const double received = 3.0 - 200.0 * change - 1.5 * solid * (a - run.engine().fields().material_acceleration[0].x());
        EXPECT_NEAR(received, 3.0 - 200.0 * change, 1e-9);
        for (std::size_t i = 0; i < run.cells(); ++i) {
            EXPECT_NEAR(run.engine().fields().velocity[i].x(), u, 1e-11);
            EXPECT_NEAR(run.engine().fields().material_acceleration[i].x(), a, 1e-8);
            EXPECT_NEAR(run.engine().received()[i].x(), alpha * a, 1e-8);
        }
    }
    EXPECT_GT(u, 0.05);
}

// Rock at rest with a drag 100 times stiffer than the step: the fluid comes to rest without overshooting.
TEST_F(PeriodicBox, StiffDragDoesNotOvershoot) {
    FluidRun run(testing::build_case(periodic_box("stiff_drag")), true);
    const double rate = 1e5;
    const std::vector<double> fraction(run.cells(), 0.6);
    auto& U = run.session().mesh().lookupObjectRef<Foam::volVectorField>("U");
    U.primitiveFieldRef() = Foam::vector(1.0, 0.0, 0.0);
    U.correctBoundaryConditions();
    U.oldTime() = U;
    double previous = 1.0;
    std::fill(run.drag_rate.begin(), run.drag_rate.end(), rate);
    while (run.engine().running()) {
        run.begin();
        for (std::size_t i = 0; i < run.cells(); ++i) run.source[i] = -rate * run.engine().fields().velocity[i];
        run.end(fraction, fraction);
        const double u = run.engine().fields().velocity[0].x();
        EXPECT_GE(u, -1e-15);
        EXPECT_LT(u, 0.02 * previous + 1e-12);
        previous = u;
    }
}

/// Largest velocity in a closed box that a sliding lid stirs, half filled with rock that does not move, whose force is the lagged
/// -(1 + C_AM) alpha_p Du/Dt.
double stirred_velocity(const std::string& name, bool in_matrix) {
    testing::Box box;
    for (int& cells : box.cells) cells = 8;
    testing::TinyCase tiny = closed_box(name, box, "noSlip", 5e-3, 0.2);
    tiny.files["0/U"] =
        testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*\" { type noSlip; } z_max { type fixedValue; value uniform (1 0 0); }");
    tiny.files["constant/transportProperties"] = "transportModel Newtonian; nu 1e-2; rho 1000;";
    FluidRun run(testing::build_case(tiny), true);
    const double solid = 0.5, inertia = 1.5 * solid;
    const std::vector<double> fraction(run.cells(), 1.0 - solid);
    double largest = 0.0;
    while (run.engine().running() && largest < 100.0) {
        run.begin();
        for (std::size_t i = 0; i < run.cells(); ++i) {
            run.source[i] = -inertia * run.engine().fields().material_acceleration[i];
            run.inertia[i] = in_matrix ? inertia : 0.0;
        }
        run.end(fraction, fraction);
        largest = run.deviation(Vec3::Zero());
    }
    return largest;
}

TEST(AddedMass, IsStableInTheMatrixWhereLaggedItBlowsUp) {
    EXPECT_LE(stirred_velocity("added_mass_implicit", true), 1.0);
    EXPECT_GE(stirred_velocity("added_mass_lagged", false), 100.0);
}

// Foam::bound() raises a negative k and tells only the log.
TEST(Turbulence, CountsTheCellsThatItsModelRaisesToALeastValue) {
    testing::TinyCase tiny = closed_box("clipped", column(), "noSlip", 1e-4, 0.1);
    testing::make_turbulent(tiny, 0.01, 0.1);
    FluidRun run(testing::build_case(tiny), false);
    const auto step = [&] {
        run.begin();
        run.end({}, {});
        return run.engine().loads().clipped_cells;
    };
    EXPECT_EQ(step(), 0);
    // four cells that touch no wall
    const auto chosen = run.evaluate([](const Vec3& x) {
        return std::abs(x.x() - 0.05) < 0.025 && std::abs(x.y() - 0.05) < 0.025 && std::abs(x.z() - 0.20625) < 1e-6 ? 1.0 : 0.0;
    });
    auto& k = run.session().mesh().lookupObjectRef<Foam::volScalarField>("k");
    for (std::size_t i = 0; i < chosen.size(); ++i)
        if (chosen[i] > 0.0) k[static_cast<Foam::label>(i)] = -0.1;
    EXPECT_EQ(step(), 4);
    EXPECT_EQ(step(), 0);
}

TEST(RockCase, RefusesWhatWouldBendItsBalance) {
    testing::TinyCase tiny = closed_box("refused", column(), "noSlip", 5e-3, 0.1);
    tiny.files["system/fvSchemes"] += "ddtSchemes { default backward; } divSchemes { div(phi,U) bounded Gauss upwind; }\n";
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type zeroGradient; }");
    FoamSession session(testing::build_case(tiny));
    try {
        FoamFluidEngine engine(session, true);
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 8u);
        EXPECT_NE(error.mistakes()[0].text().find("backward"), std::string::npos);
        EXPECT_NE(error.mistakes()[1].text().find("div(phi,U) is bounded"), std::string::npos);
        EXPECT_NE(error.mistakes()[2].text().find("fixedFluxPressure"), std::string::npos);
    }
    EXPECT_NO_THROW(FoamFluidEngine(session, false));
}

}  // namespace
}  // namespace cutterflow::foam
