#include <algorithm>
#include <cmath>

#include "solver/free_surface/scene_file/scene_file.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr double k_gravity = 9.81;
/// Core seconds of a step: of each cell of the tank, each particle with its part of the pressure, each cell of the squares or cubes around
/// the bodies.
struct StepCost {
    double cell, particle, body_cell;
};
// Measured on tanks of 8,000 to 74,360 cells with 7,680 to 137,040 particles and 0 to 33 cylinders,
constexpr StepCost k_plane_cost{3.0e-8, 3.1e-7, 1.0e-6};
// and of 19,200 to 38,400 cells with 36,864 to 129,648 particles and 0 to 4 spheres of eight cells.
constexpr StepCost k_space_cost{5.2e-8, 4.9e-7, 7.5e-6};
constexpr double k_bytes_per_particle = 100.0, k_bytes_per_cell = 600.0, k_bytes_of_program = 5e7;

}  // namespace

ScenePrediction predict(const Scene& scene) {
    const TankSettings& tank = scene.settings.tank;
    ScenePrediction result;
    const double across = tank.cells[1];
    result.cells = static_cast<double>(tank.cells[0]) * across * tank.cells[2];
    double height = 0.0;
    for (const WaterBox& box : scene.settings.water.filled) {
        const double to_x = std::min(box.to.x(), tank.cells[0] * tank.cell), to_z = std::min(box.to.z(), tank.cells[2] * tank.cell);
        const double share = tank.plane ? 1.0 : common({box.from.y(), box.to.y()}, {0.0, tank.depth}).length() / tank.depth;
        result.water_cells += share * across * (to_x - box.from.x()) * (to_z - box.from.z()) / (tank.cell * tank.cell);
        height = std::max(height, to_z);
    }
    result.particles = (tank.plane ? 4.0 : 8.0) * result.water_cells;
    double body_cells = 0.0;
    for (const double diameter : scene.bodies.diameter)
        body_cells += diameter * diameter / (tank.cell * tank.cell) * (scene.settings.spheres ? diameter / tank.cell : across);
    const double speed = 2.0 * std::sqrt(k_gravity * std::max(height, tank.cell));
    result.step = std::min(scene.settings.run.max_courant * tank.cell / speed, 0.7 * std::sqrt(tank.cell / k_gravity));
    result.steps = scene.end / result.step;
    for (const Gate& gate : scene.settings.gates) {
        const double lifted = std::max(0.0, std::min(gate.end, scene.end) - gate.start), longest = k_solid_travel * tank.cell / gate.speed;
        if (longest < result.step) result.steps += lifted * (1.0 / longest - 1.0 / result.step);
    }
    result.memory = k_bytes_per_particle * result.particles + k_bytes_per_cell * result.cells + k_bytes_of_program;
    const StepCost& cost = tank.plane ? k_plane_cost : k_space_cost;
    result.core_seconds = result.steps * (result.cells * cost.cell + result.particles * cost.particle + body_cells * cost.body_cell);
    if (scene.bodies.size() > 0)
        result.dem_step = physics::linear_contact_step(scene.dem.linear.theta, scene.dem.linear.reference_length, k_gravity,
                                                       scene.dem.linear.steps_per_period);
    return result;
}

}  // namespace cutterflow::free_surface
