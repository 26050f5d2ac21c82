/// Exact first acceleration of bodies lighter and heavier than water.
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "solver/free_surface/testing/free_bodies.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::free_surface;
using validation::Effort;
using validation::larger;
using validation::Verification;

constexpr double k_radius = 0.01, k_cavity = 0.04, k_gravity = 9.81;

struct Start {
    bool sphere = false;
    int cells_per_diameter = 20;
    double density_ratio = 0.1;
    double step = 1e-3;
};

double exact(const Start& start) {
    const double s = start.density_ratio, r = k_radius, cavity = k_cavity;
    const double added = start.sphere ? 0.5 * (std::pow(cavity, 3) + 2 * std::pow(r, 3)) / (std::pow(cavity, 3) - std::pow(r, 3))
                                      : (cavity * cavity + r * r) / (cavity * cavity - r * r);
    return k_gravity * (1.0 - s) / (s + added);
}

struct Acceleration {
    double up = 0.0, sideways = 0.0, momentum = 0.0;
};

Acceleration accelerate(const Start& start, const Vec3& offset) {
    SceneSettings scene;
    const double cell = 2.0 * k_radius / start.cells_per_diameter;
    const int cells = static_cast<int>(std::lround(2.0 * k_cavity / cell)) + 4;
    scene.tank.plane = !start.sphere;
    scene.tank.cells = {cells, start.sphere ? cells : 1, cells};
    scene.tank.cell = cell;
    scene.tank.depth = 0.01;
    scene.spheres = start.sphere;
    Vec3 centre = cell * (Vec3::Constant(cells / 2) + offset);
    if (!start.sphere) centre.y() = 0.5 * scene.tank.depth;
    scene.solids = {SolidCavity{centre, k_cavity, start.sphere}};
    scene.water.filled = {{Vec3::Constant(-1), Vec3::Constant(1)}};
    scene.water.kinematic_viscosity = 0.0;
    scene.run.longest_step = start.step;
    FreeBodies body(one_rock(centre, 2 * k_radius, scene.water.density * start.density_ratio), scene);
    SurfaceRun run(scene, &body);
    const StepReport& report = run.step();
    const Vec3 acceleration = body.rocks().velocity[0] / report.step;
    return {acceleration.z(), std::abs(acceleration.x()) / k_gravity, report.impulses.sum().norm() / report.impulses.bodies.norm()};
}

struct Errors {
    double mean = 0.0, worst = 0.0, sideways = 0.0, momentum = 0.0;
};

/// Errors of the acceleration as a share of the exact one; at equal densities as a share of g.
Errors errors_of(const Start& start, int places) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> within(0.0, 1.0);
    Errors errors;
    for (int n = 0; n < places; ++n) {
        const Acceleration found = accelerate(start, Vec3(within(random), within(random), within(random)));
        const double error = start.density_ratio == 1.0 ? found.up / k_gravity : found.up / exact(start) - 1.0;
        errors.mean += std::abs(error) / places;
        errors.worst = larger(errors.worst, std::abs(error));
        errors.sideways = larger(errors.sideways, found.sideways);
        errors.momentum = larger(errors.momentum, found.momentum);
    }
    return errors;
}

void check_ratios(Verification& verification) {
    for (const double ratio : {0.001, 0.01, 0.1, 1.0, 2.7}) {
        const Errors errors = errors_of({false, 20, ratio}, 20);
        const std::string about = fmt::format("disc of density ratio {:g}, 20 cells a diameter", ratio);
        verification.at_most("error of the first acceleration: " + about, ratio == 1.0 ? "g" : "-", errors.worst, 0.015,
                             {"exact", "largest of 20 places within a cell", 0.003});
        verification.at_most("sideways acceleration: " + about, "g", errors.sideways, 1e-3, {"exact", "", {}});
        verification.at_most("momentum that the pressure makes, over the body's: " + about, "-", errors.momentum, 1e-6,
                             {"exact", "water, body and walls together", {}});
    }
}

void check_order(Verification& verification) {
    std::vector<double> means;
    for (const int cells : {8, 10, 16, 20, 40}) {
        means.push_back(errors_of({false, cells, 0.1}, 10).mean);
        verification.report(fmt::format("mean error at {} cells a diameter, density ratio 0.1", cells), "-", means.back(), {},
                            {"exact", "", {}});
    }
    verification.at_least("order of the error from 10 to 40 cells a diameter", "-", std::log(means[1] / means[4]) / std::log(4.0), 1.3,
                          {"exact", "", {}});
}

void check_steps(Verification& verification) {
    double spread = 0.0;
    for (const double ratio : {0.001, 0.1, 2.7}) {
        const double middle = accelerate({false, 20, ratio, 1e-3}, Vec3(0.3, 0, 0.7)).up;
        for (const double step : {1e-5, 1e-2}) {
            spread = larger(spread, std::abs(accelerate({false, 20, ratio, step}, Vec3(0.3, 0, 0.7)).up / middle - 1.0));
        }
    }
    verification.at_most("change of the first acceleration over steps from 1e-5 to 1e-2 s", "-", spread, 1e-6,
                         {"exact", "density ratios 0.001, 0.1 and 2.7", {}});
}

/// Up from deep water through the surface: the fastest a buoyant body of a drag coefficient of 0.28 may become is the limit.
void check_rise(Verification& verification, double cell) {
    for (const double step : {1e-3, 5e-3}) {
        SceneSettings scene;
        scene.tank.cells = {static_cast<int>(std::lround(0.12 / cell)), 1, static_cast<int>(std::lround(0.16 / cell))};
        scene.tank.cell = cell;
        scene.tank.depth = 0.01;
        scene.water.filled = {{Vec3::Constant(-1), Vec3(1, 1, 0.12)}};
        scene.run.longest_step = step;
        FreeBodies body(one_rock(Vec3(0.0603, 0.005, 0.0304), 0.02, 100.0), scene);
        SurfaceRun run(scene, &body);
        double fastest = 0.0;
        while (run.time() < 0.3) {
            run.step();
            fastest = larger(fastest, body.rocks().velocity[0].norm());
        }
        verification.at_most(
            fmt::format("fastest speed of a rising disc of density ratio 0.1, cells of {:g} mm, step {:g} s", 1e3 * cell, step), "m/s",
            fastest, 1.0,
            {"exact",
             "a drag coefficient of 0.28 would allow 1.0, half of what a disc has; an unstable coupling exceeds it in a few steps",
             {}});
        verification.absolute(fmt::format("height of the disc after 0.3 s, cells of {:g} mm, step {:g} s", 1e3 * cell, step), "m",
                              body.rocks().position[0].z(), 0.125, 0.015,
                              {"exact", "it has reached the surface and stays there; floating at rest its centre stands at 0.126 m", {}});
    }
}

void check_sphere(Verification& verification) {
    for (const double ratio : {0.001, 0.1, 2.7}) {
        const Errors errors = errors_of({true, 10, ratio}, 1);
        verification.at_most(fmt::format("error of the first acceleration: sphere of density ratio {:g}, 10 cells a diameter", ratio), "-",
                             errors.worst, 0.03, {"exact", "in space", {}});
    }
}

void run(Verification& verification) {
    check_ratios(verification);
    check_order(verification);
    check_steps(verification);
    check_rise(verification, 2e-3);
    if (verification.wants(Effort::standard)) check_rise(verification, 1e-3);
    check_sphere(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return validation::verify(argc, argv, run);
}
