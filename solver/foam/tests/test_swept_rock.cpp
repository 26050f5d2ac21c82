// Water beside walls that sweep rock. A long box travels at the speed v along its length, by turning about an axis far off, past rock at
// rest in space. What its end wall displaces, v A, passes every section, whatever rock lies between: alpha u = v. With the rock of the
// swept space taken from the cell at the wall (KernelCoupling::void_fraction_before), that holds to the pressure's tolerance.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/foam/tests/fluid_run.hpp"

#include "dynamicFvMesh.H"
#include "surfaceFields.H"
#include "surfaceInterpolate.H"
#include "volFields.H"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;

constexpr double k_far = 100.0;                            // from the axis [m]
constexpr double k_speed = 0.5;                            // [m/s]
constexpr double k_cell = 0.02, k_length = 20.0 * k_cell;  // [m]
constexpr double k_place = 0.03, k_width = 0.04;           // of a cloud's centre from its wall, and its width [m]
constexpr double k_most = 0.3;                             // solid fraction in it
constexpr int k_steps = 5;
// OpenFOAM ends a run in a closed domain in which all flow relative to the mesh is rounding.
constexpr double k_hardly_faster = 1.001;

/// Full of water that has the speed `water` along it. \param travel  of a step, over a cell
std::filesystem::path travelling_box(const std::string& name, double travel, double water) {
    testing::Box box;
    box.lower[0] = -0.5 * k_length, box.upper[0] = 0.5 * k_length;
    box.lower[1] = k_far - 0.5 * k_cell, box.upper[1] = k_far + 0.5 * k_cell;
    box.upper[2] = k_cell;
    box.cells[0] = 20, box.cells[1] = box.cells[2] = 1;
    const double step = travel * k_cell / k_speed;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(box), step, k_steps * step);
    tiny.files["constant/dynamicMeshDict"] =
        "dynamicFvMesh dynamicMotionSolverFvMesh; motionSolverLibs (fvMotionSolvers); motionSolver solidBody;\n"
        "solidBodyCoeffs { solidBodyMotionFunction rotatingMotion;\n"
        "rotatingMotionCoeffs { origin (0 0 0); axis (0 0 1); omega " +
        std::to_string(-k_speed / k_far) + "; } }\n";
    const auto along = [](double speed) { return "(" + std::to_string(speed) + " 0 0)"; };
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", along(water),
                                              "\".*\" { type movingWallVelocity; value uniform " + along(k_speed) + "; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    tiny.files["constant/transportProperties"] = "transportModel Newtonian; nu 1e-12; rho 1000;\n";
    return testing::build_case(tiny);
}

using Field = std::vector<double>;

/// Solid fraction of a cloud at rest. \param wall  the end of the box, at first, that it lies beside [m]
Field cloud(const FluidRun& run, double wall) {
    return run.evaluate([wall](const Vec3& x) {
        const double off = x.x() - wall + std::copysign(k_place, wall);
        return k_most * std::exp(-0.5 * off * off / (k_width * k_width));
    });
}

/// Of the solid in each cell, what walls sweep in the step: positive where they open space.
Field swept(FluidRun& run, Field solid) {
    for (std::size_t c = 0; c < solid.size(); ++c)
        solid[c] *= run.engine().time_step() * run.engine().wall_retreat()[c] / run.engine().cells().volumes[c];
    return solid;
}

Field sum(Field one, const Field& other) {
    for (std::size_t c = 0; c < one.size(); ++c) one[c] += other[c];
    return one;
}

/// A volume that is laid over a cloud as the cloud itself is.
Field laid_over(FluidRun& run, Field cloud, const Field& amount) {
    double all = 0.0, of_amount = 0.0;
    for (std::size_t c = 0; c < cloud.size(); ++c) {
        all += cloud[c] * run.engine().cells().volumes[c];
        of_amount += amount[c] * run.engine().cells().volumes[c];
    }
    const double share = run.total(of_amount) / run.total(all);
    for (double& value : cloud) value *= share;
    return cloud;
}

Field water(Field solid) {
    for (double& fraction : solid) fraction = 1.0 - fraction;
    return solid;
}

/// Largest difference of the volume flow through sections from what the wall displaces, over that.
double error_of_flow(FluidRun& run) {
    const Foam::fvMesh& mesh = run.session().mesh();
    const auto& phi = mesh.lookupObject<Foam::surfaceScalarField>("phi");
    const Foam::surfaceScalarField alphaf(Foam::fvc::interpolate(mesh.lookupObject<Foam::volScalarField>("voidFraction")));
    double worst = 0.0;
    for (Foam::label face = 0; face < mesh.nInternalFaces(); ++face)
        worst = std::max(worst, std::abs(alphaf[face] * (phi[face] + mesh.phi()[face]) / (k_speed * k_cell * k_cell) - 1.0));
    return run.largest(worst);
}

/// Largest difference of alpha u from the wall's speed in cells that are at least `from_ends` cells from the ends, over that.
double error_of_velocity(FluidRun& run, int from_ends) {
    const coupling::FluidFields fields = run.engine().fields();
    double worst = 0.0;
    for (std::size_t c = 0; c < run.cells(); ++c) {
        if (std::abs(run.engine().cells().centres[c].x()) > 0.5 * k_length - from_ends * k_cell) continue;
        worst = std::max(worst, std::abs(fields.void_fraction[c] * fields.velocity[c].x() / k_speed - 1.0));
    }
    return run.largest(worst);
}

// The water goes on with v / alpha, also where the ends sweep the rock.
TEST(SweptRock, OfAUniformSolidFractionLeavesTheVelocityUniform) {
    for (const double travel : {0.1, 0.5}) {
        FluidRun run(travelling_box("swept_uniform", travel, k_speed / 0.8), true);
        const Field solid(run.cells(), 0.2);
        for (int n = 0; n < k_steps; ++n) {
            run.begin();
            run.end(water(sum(solid, swept(run, solid))), water(solid));
            EXPECT_LE(error_of_flow(run), 1e-9) << travel << ", " << n;
            EXPECT_LE(error_of_velocity(run, 0), 1e-6) << travel << ", " << n;
        }
    }
}

// Clouds at rest beside both ends, in water that had the box' speed. At a wall the water keeps that, and half a cell on it has gained half
// of what the cloud makes it gain, so that the cells at the ends stand between v and v / alpha. Those beside them see that by convection, a
// hundredth of a cell in a step, and all have the error of linear interpolation, (change of alpha from cell to cell)^2 / (4 alpha^2) =
// 4e-3.
TEST(SweptRock, LeavesTheFlowPastItAlone) {
    FluidRun run(travelling_box("swept_clouds", 0.1, k_hardly_faster * k_speed), true);
    for (int n = 0; n < k_steps; ++n) {
        run.begin();
        const Field solid = sum(cloud(run, -0.5 * k_length), cloud(run, 0.5 * k_length));
        run.end(water(sum(solid, swept(run, solid))), water(solid));
        EXPECT_LE(error_of_flow(run), 1e-9) << n;
        EXPECT_LE(error_of_velocity(run, 1), 0.03) << n;
    }
}

/// Of a step in which the cells at the ends are taken this share of what is swept, and the clouds the rest.
double error_of_flow_with(const std::string& name, double travel, double share) {
    FluidRun run(travelling_box(name, travel, k_hardly_faster * k_speed), true);
    run.begin();
    Field solid(run.cells(), 0.0), before(solid);
    for (const double wall : {-0.5 * k_length, 0.5 * k_length}) {
        const Field present = cloud(run, wall);
        Field here = swept(run, present), beyond = here;
        for (std::size_t c = 0; c < here.size(); ++c) here[c] *= share, beyond[c] *= 1.0 - share;
        solid = sum(solid, present);
        before = sum(before, sum(sum(present, here), laid_over(run, present, beyond)));
    }
    run.end(water(before), water(solid));
    return error_of_flow(run);
}

// What the tests above would see of swept rock that is taken from the whole cloud: behind the cell at the wall, where the cloud holds 0.27,
// the 0.77 of that which the cloud has elsewhere. At half a cell in a step the coupling takes a quarter of a cell from the cell itself,
// which leaves half of it: swept_limited_cells of balance.csv tells that it was so.
TEST(SweptRock, LaidOverTheCloudBendsTheFlow) {
    EXPECT_LE(error_of_flow_with("swept_in_the_cell", 0.5, 1.0), 1e-9);
    EXPECT_NEAR(error_of_flow_with("swept_over_the_cloud", 0.1, 0.0), 0.27 * 0.77, 0.02);
    EXPECT_NEAR(error_of_flow_with("swept_half_over_the_cloud", 0.5, 0.5), 0.5 * 0.29 * 0.75, 0.02);
}

}  // namespace
}  // namespace cutterflow::foam
