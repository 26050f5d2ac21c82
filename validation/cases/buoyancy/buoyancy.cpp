/// Buoyancy of held, floating and half-immersed discs.
#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/free_surface/cut_cells/covered_area.hpp"
#include "solver/free_surface/testing/free_bodies.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/contact_bench.hpp"
#include "validation/harness/scenes/cylinder_column.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::free_surface;
using validation::Effort;
using validation::larger;
using validation::Verification;

constexpr double k_diameter = 0.1, k_depth = 0.02, k_gravity = 9.81, k_density = 1000.0;

SceneSettings pool(int cells_per_diameter, double width, double level) {
    SceneSettings scene;
    scene.tank.cell = k_diameter / cells_per_diameter;
    scene.tank.cells = {static_cast<int>(std::lround(width / scene.tank.cell)), 1, static_cast<int>(std::lround(0.4 / scene.tank.cell))};
    scene.tank.depth = k_depth;
    scene.water.filled = {{Vec3::Constant(-1), Vec3(width, 1, level)}};
    return scene;
}

double disc_volume() {
    return 0.25 * k_pi * k_diameter * k_diameter * k_depth;
}

/// What the pressure gives to water, bodies and walls together, over what it gives to the bodies.
double momentum_made(const StepReport& report) {
    return report.impulses.sum().norm() / report.impulses.bodies.norm();
}

void check_held(Verification& verification, int cells) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> within(0.0, 1.0);
    double worst = 0.0, momentum = 0.0;
    for (int n = 0; n < 20; ++n) {
        const SceneSettings scene = pool(cells, 0.6, 0.3);
        HeldBodies body(one_rock(Vec3(0.3 + within(random) * scene.tank.cell, 0.5 * k_depth, 0.15 + within(random) * scene.tank.cell),
                                 k_diameter, 500.0));
        SceneSettings held = scene;
        held.run.longest_step = 1e-3;
        held.bodies_held = true;
        SurfaceRun run(held, &body);
        const StepReport& report = run.step();
        worst = larger(worst, std::abs(report.body_force[0].z() / (k_density * k_gravity * disc_volume()) - 1.0));
        momentum = larger(momentum, momentum_made(report));
    }
    verification.at_most(fmt::format("error of the force on a held disc, {} cells a diameter", cells), "-", worst, 1e-4,
                         {"exact", "rho g V; largest of 20 places within a cell", {}});
    verification.at_most(fmt::format("momentum that the pressure makes, over the disc's, {} cells", cells), "-", momentum, 1e-6,
                         {"exact", "water, body and walls together", {}});
}

/// Share of a disc under a level.
double immersed(double centre, double level) {
    const double radius = 0.5 * k_diameter;
    return disc_in_rectangle(radius, {-radius, radius}, {-radius, std::clamp(level - centre, -radius, radius)}) / (k_pi * radius * radius);
}

void check_floating(Verification& verification, double ratio) {
    SceneSettings scene = pool(20, 0.4, 0.2);
    const double radius = 0.5 * k_diameter;
    double low = -radius, high = radius;  // of the centre over the level at balance
    for (int n = 0; n < 60; ++n) (immersed(0.5 * (low + high), 0.0) > ratio ? low : high) = 0.5 * (low + high);
    const double centre = 0.2 + 0.5 * (low + high);
    scene.water.kinematic_viscosity = 1e-4;
    FreeBodies body(one_rock(Vec3(0.2013, 0.5 * k_depth, centre), k_diameter, k_density * ratio), scene);
    SurfaceRun run(scene, &body);
    // The water of the boxes gave way to the disc, so the still level is that of the water's volume and the disc's part under it.
    const double level = (run.initial_volume() / k_depth + ratio * k_pi * radius * radius) / 0.4;
    double mean = 0.0, weight = 0.0, momentum = 0.0;
    while (run.time() < 2.0) {
        const StepReport& report = run.step();
        momentum = larger(momentum, momentum_made(report));
        if (run.time() < 1.0) continue;
        mean += report.step * immersed(body.rocks().position[0].z(), level);
        weight += report.step;
    }
    verification.relative(fmt::format("share of a floating disc under the still level, density ratio {:g}", ratio), "-", mean / weight,
                          ratio, 0.02, {"exact", "Archimedes; mean of the second second, 20 cells a diameter", {}});
    verification.at_most(fmt::format("momentum that the pressure makes, over the floating disc's, density ratio {:g}", ratio), "-",
                         momentum, 1e-6, {"exact", "every step of 2 s", {}});
}

/// A heavy cylinder rests on the floor, a gap off, in the middle of the tank: nothing may roll it. The DEM takes weight and water's force
/// in each of its own steps.
void check_resting(Verification& verification, double gap_cells, double step) {
    SceneSettings scene = pool(20, 0.4, 0.2);
    const double gap = gap_cells * scene.tank.cell, ratio = 2.7;
    scene.run.longest_step = step;
    validation::CylinderColumn column;
    column.gap = gap;
    coupling::DemSettings dem = validation::column_dem(column);
    dem.cylinder_length = k_depth;
    dem.domain.upper = Vec3(0.4 - 0.5 * gap, k_depth, 0.4 - 0.5 * gap);
    liggghts::LiggghtsEngine engine(dem, std::vector<coupling::ZoneMotion>{}, MPI_COMM_WORLD);
    engine.insert(one_rock(Vec3(0.2, 0.5 * k_depth, 0.5 * k_diameter + gap), k_diameter, ratio * k_density));
    SurfaceRun run(scene, &engine);
    double speed = 0.0, momentum = 0.0;
    while (run.time() < 0.6) {
        const StepReport& report = run.step();
        momentum = larger(momentum, momentum_made(report));
        if (run.time() > 0.4) speed = larger(speed, engine.rocks().velocity[0].norm());
    }
    const double displaced = k_density * k_gravity * disc_volume(), water = run.last().body_force[0].z();
    const std::string about = fmt::format(", gap {:g} cells, step {:g} s", gap_cells, step);
    verification.relative("force on a disc on the floor" + about, "N", water, displaced, gap_cells < 1.0 ? 0.005 : 0.001,
                          {"exact", "rho g V; a gap below one cell has no pressure of its own", {}});
    verification.relative("contact force of the floor" + about, "N", run.last().contact_force[0].z(), ratio * displaced - water, 1e-6,
                          {"exact", "weight less the water's force", {}});
    verification.at_most("speed of the disc at rest" + about, "m/s", speed, 1e-6, {"exact", "largest of the last 0.2 of 0.6 s", {}});
    verification.at_most("momentum that the pressure makes, over the disc's" + about, "-", momentum, 1e-6,
                         {"exact", "every step of 0.6 s", {}});
}

void run(Verification& verification) {
    const validation::SingleProcess mpi;
    for (const int cells : {10, 20}) check_held(verification, cells);
    for (const double gap_cells : {0.25, 1.0, 2.0}) {
        for (const double step : {1e-3, 1e-2}) check_resting(verification, gap_cells, step);
    }
    for (const double ratio : {0.1, 0.5}) check_floating(verification, ratio);
}

}  // namespace

int main(int argc, char** argv) {
    return validation::verify(argc, argv, run);
}
