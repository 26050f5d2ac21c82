/// Period of a disc that heaves on the surface.
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/free_surface/testing/free_bodies.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::free_surface;
using validation::Verification;

constexpr double k_radius = 0.05, k_width = 2.0, k_level = 0.5, k_depth = 0.02, k_lift = 0.4 * k_radius, k_gravity = 9.81;
constexpr double k_added_mass = 0.6;  // of the displaced mass; an estimate

struct Extreme {
    double time = 0.0, height = 0.0;
};

/// Vertex of the parabola through three points.
Extreme vertex(const std::array<Extreme, 3>& p) {
    const double a = p[0].time - p[1].time, b = p[2].time - p[1].time;
    const double ya = p[0].height - p[1].height, yb = p[2].height - p[1].height;
    const double curve = (ya / a - yb / b) / (a - b), slope = ya / a - curve * a;
    return {p[1].time - slope / (2.0 * curve), p[1].height - slope * slope / (4.0 * curve)};
}

/// The first trough and the crest after it; heights over the place of balance.
std::array<Extreme, 2> heave(int cells_per_diameter) {
    SceneSettings scene;
    scene.tank.cell = 2.0 * k_radius / cells_per_diameter;
    scene.tank.cells = {static_cast<int>(std::lround(k_width / scene.tank.cell)), 1, static_cast<int>(std::lround(0.65 / scene.tank.cell))};
    scene.tank.depth = k_depth;
    scene.water.filled = {{Vec3::Constant(-1), Vec3(k_width, 1, k_level)}};
    const Vec3 start(0.5 * k_width + 0.0013, 0.5 * k_depth, k_level + k_lift);
    FreeBodies body(one_rock(start, 2.0 * k_radius, 0.5 * scene.water.density), scene);
    SurfaceRun run(scene, &body);
    const double balance = (run.initial_volume() / k_depth + 0.5 * k_pi * k_radius * k_radius) / k_width;
    std::array<Extreme, 3> last{};
    std::array<Extreme, 2> found{};
    int count = 0;
    while (count < 2 && run.time() < 1.0) {
        run.step(5e-3);
        last = {last[1], last[2], {run.time(), body.rocks().position[0].z() - balance}};
        if (last[0].time == 0.0) continue;
        if ((last[1].height - last[0].height) * (last[2].height - last[1].height) < 0.0) found[count++] = vertex(last);
    }
    return found;
}

/// Of a damped oscillator that keeps a share of its height over a period [s].
double damped_period(double kept) {
    const double undamped = 2.0 * k_pi * std::sqrt((1.0 + k_added_mass) * k_pi / 4.0 * k_radius / k_gravity);
    const double decay = -std::log(kept) / (2.0 * k_pi);  // zeta/sqrt(1 - zeta^2)
    return undamped * std::sqrt(1.0 + decay * decay);
}

void run(Verification& verification) {
    for (const int cells : {20, 40}) {
        const auto [trough, crest] = heave(cells);
        const std::string mesh = fmt::format(", {} cells a diameter", cells);
        verification.relative("period of heave" + mesh, "s", crest.time, damped_period(crest.height / k_lift), 0.03,
                              {"exact",
                               "a damped oscillator that decays as the run does; its added mass, 0.6 of the displaced mass, is an estimate "
                               "without a source in references.bib; from the release to the next crest",
                               {}});
        verification.report("first trough over the lift" + mesh, "-", trough.height / k_lift, {}, {"exact", "", {}});
        verification.report("next crest over the lift" + mesh, "-", crest.height / k_lift, {}, {"exact", "", {}});
    }
}

}  // namespace

int main(int argc, char** argv) {
    return validation::verify(argc, argv, run);
}
