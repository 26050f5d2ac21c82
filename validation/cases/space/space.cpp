/// A plane run beside the same scene in space.
#include <cmath>

#include <fmt/format.h>

#include "solver/free_surface/testing/free_bodies.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::free_surface;
using validation::larger;
using validation::Verification;

constexpr double k_cell = 0.005, k_end = 0.12;
constexpr int k_across = 4;

struct State {
    Vec3 body = Vec3::Zero(), velocity = Vec3::Zero(), water = Vec3::Zero();
    double speed = 0.0, across = 0.0, volume = 0.0, lost = 0.0;  // lost: largest of all steps, share
    long steps = 0;
};

State state_after(bool plane) {
    SceneSettings scene;
    scene.tank.plane = plane;
    scene.tank.cells = {40, plane ? 1 : k_across, 24};
    scene.tank.cell = k_cell;
    scene.tank.depth = k_across * k_cell;
    scene.water.filled = {{Vec3::Constant(-1), Vec3(0.06, 1, 0.09)}};
    scene.solids = {SolidBox{Vec3(0.045, -1, -1), Vec3(0.055, 1, 0.02)}};
    scene.run.longest_step = 1.5e-3;
    scene.run.max_courant = 1.0;  // the steps are those of longest_step in both
    scene.run.pressure_tolerance = 1e-13;
    scene.run.even_out_tolerance = 1e-13;
    scene.run.volume_limit = 1.0;
    FreeBodies body(one_rock(Vec3(0.0331, 0.5 * scene.tank.depth, 0.0417), 0.03, 2000.0), scene);
    SurfaceRun run(scene, &body);
    State state;
    while (run.time() < k_end * (1.0 - 1e-9)) {
        const StepReport& report = run.step(k_end - run.time());
        state.lost = larger(state.lost, std::abs(report.occupied_volume / run.initial_volume() - 1.0));
    }
    state.body = body.rocks().position[0];
    state.velocity = body.rocks().velocity[0];
    const WaterParticles& water = run.particles();
    const double count = static_cast<double>(water.size());
    for (std::size_t p = 0; p < water.size(); ++p) {
        state.water += water.place(p) / count;
        state.across = larger(state.across, std::abs(water.velocity[1][p]));
    }
    state.speed = largest_speed(water);
    state.volume = run.last().occupied_volume;
    return state;
}

void run(Verification& verification) {
    const State plane = state_after(true), space = state_after(false);
    const auto same = [&](const std::string& what, const std::string& unit, double of_space, double of_plane) {
        verification.relative(what + " in space", unit, of_space, of_plane, 1e-6, {"exact", "reference: the plane run, after 0.12 s", {}});
    };
    for (const int d : {0, 2}) {
        const std::string name = d == 0 ? "x" : "z";
        same(name + " of the cylinder", "m", space.body[d], plane.body[d]);
        same("speed of the cylinder in " + name, "m/s", space.velocity[d], plane.velocity[d]);
        same("mean " + name + " of the water", "m", space.water[d], plane.water[d]);
    }
    same("fastest water", "m/s", space.speed, plane.speed);
    same("occupied volume", "m3", space.volume, plane.volume);
    verification.at_most("occupied volume lost or won in space", "-", space.lost, 0.01, {"exact", "largest of all steps", {}});
    verification.at_most("fastest water across", "m/s", space.across, 1e-6 * plane.speed, {"exact", "nothing drives it", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return validation::verify(argc, argv, run);
}
