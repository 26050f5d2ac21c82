// Cost of mapping 368 rocks on a mesh of the draft cutter's size: two stencils per step (old and new positions on the moved mesh), and one
// for each of a replay's longer steps; in open water and in the trough that a swing left in soil.
//   build/bin/bench_mapping
#include <random>

#include <benchmark/benchmark.h>

#include "solver/coupling/kernel/mapping.hpp"
#include "solver/ports/testing/synthetic_mesh.hpp"

namespace cutterflow::coupling {
namespace {

enum class Scene { open_water, trough };

constexpr double k_trough_radius = 0.44;

/// A place above the ground of the trough: its part of the way around, along the swing [m], and its height above ground [m].
Vec3 in_trough(double part, double along, double height) {
    const double r = k_trough_radius - 0.016 - height;
    return {r * std::cos(part * k_pi), along, -r * std::sin(part * k_pi)};
}

/// Soil around the lower half of the head, as a swing along y leaves it: a trough of long strips with a round end at the head, 48 edges
/// around.
void add_trough(testing::SyntheticMesh& mesh) {
    constexpr int around = 48, rows = 12;
    constexpr double radius = k_trough_radius, length = 4.0;
    const auto outline = [](double part) { return Vec3(std::cos(part * k_pi), 0.0, -std::sin(part * k_pi)); };
    const auto add = [&mesh](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        mesh.soil.push_back({a, b, c});
        mesh.soil.push_back({a, c, d});
    };
    mesh.add_sides_of_soil(Vec3(-3.0, -3.0, -2.0), Vec3(3.0, 3.0, 0.0));
    for (int k = 0; k < around; ++k) {
        const Vec3 p = radius * outline(double(k) / around), q = radius * outline(double(k + 1) / around), back(0.0, -length, 0.0);
        add(p, q, q + back, p + back);
        for (int j = 0; j < rows; ++j) {
            const auto at = [j](const Vec3& x, int dj) -> Vec3 {
                const double turn = 0.5 * k_pi * (j + dj) / rows;
                return std::cos(turn) * x + Vec3(0.0, radius * std::sin(turn), 0.0);
            };
            add(at(p, 0), at(q, 0), at(q, 1), at(p, 1));
        }
    }
}

/// Rocks in two of the spaces between the blades, as a batch that is released on the swing side, or in a trough around the head.
struct Batch {
    std::vector<int> id;
    std::vector<Vec3> position, velocity;
    std::vector<double> diameter;
    Batch(int count, Scene scene) {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> s(0.15, 0.95), t(0.0, 1.0), a(0.25, 0.8), v(-0.5, 0.5);
        for (int i = 0; i < count; ++i) {
            const double along = s(random);
            const double r = 0.1 + 0.2 * along + t(random) * 0.12;
            const double azimuth = (i % 2 + a(random)) * k_pi / 3.0 + along * 70.0 * k_pi / 180.0;
            id.push_back(i + 1);
            if (scene == Scene::trough && t(random) < 0.5)
                position.push_back(in_trough(0.25 + 0.5 * a(random), -0.5 * t(random), 0.03 * t(random)));
            else
                position.emplace_back(r * std::cos(azimuth), r * std::sin(azimuth), -0.44 + 0.44 * along);
            velocity.emplace_back(v(random), v(random), v(random));
            diameter.push_back(scene == Scene::trough ? 0.03 : 0.02);
        }
    }
    RockShapes shapes() const { return {id, position, diameter}; }
    RockShapes shapes(const std::vector<Vec3>& at) const { return {id, at, diameter}; }
};

/// range(0): cell size in the head [mm]; range(1): percent of the rotor's speed that the rocks turn with.
void map_one_step(benchmark::State& state, Scene scene) {
    const double dx = 1e-3 * static_cast<double>(state.range(0));
    const double share = 0.01 * static_cast<double>(state.range(1));
    testing::SyntheticMesh mesh = testing::draft_cutter(dx);
    if (scene == Scene::trough) add_trough(mesh);
    SerialCommunicator serial;
    const RotationAxis axis;
    Mapping mapping(mesh.cells(), mesh.steel(), testing::unit_turn(), KernelSettings{}, serial);
    Batch batch(368, scene);
    const double dt = scene == Scene::trough ? 3e-3 : 5e-4, speed = rpm_to_rad_s(60.0);
    double angle = 0.0;
    Stencils before, after;
    std::size_t entries = 0, steps = 0;
    for (auto _ : state) {
        const std::vector<Vec3> old = batch.position;
        for (std::size_t p = 0; p < old.size(); ++p)
            batch.position[p] = rotate_about(axis, share * speed * dt, old[p]) + dt * batch.velocity[p];
        angle += speed * dt;
        mapping.set_time(angle);
        mapping.build(batch.shapes(old), before);
        mapping.build(batch.shapes(), after);
        entries += before.cell.size() + after.cell.size();
        ++steps;
    }
    state.counters["cells"] = static_cast<double>(mesh.size());
    state.counters["triangles"] = static_cast<double>(mesh.rotor_steel.size() + mesh.stator_steel.size());
    state.counters["entries_per_rock"] = static_cast<double>(entries) / (2.0 * 368.0 * static_cast<double>(steps));
    state.counters["tests_per_step"] = static_cast<double>(mapping.visibility().tests()) / static_cast<double>(steps);
    state.counters["nodes"] = static_cast<double>(mapping.visibility().kept_nodes());
}

/// range(0): cell size in the head [mm]; range(1): the NodeView.
void map_one_step_of_a_replay(benchmark::State& state) {
    const testing::SyntheticMesh mesh = testing::draft_cutter(1e-3 * static_cast<double>(state.range(0)));
    SerialCommunicator serial;
    Mapping mapping(mesh.cells(), mesh.steel(), testing::unit_turn(), KernelSettings{}, serial, static_cast<NodeView>(state.range(1)));
    Batch batch(368, Scene::open_water);
    const double dt = 3e-3, speed = rpm_to_rad_s(60.0);
    double angle = 0.0;
    Stencils stencils;
    for (auto _ : state) {
        for (std::size_t p = 0; p < batch.position.size(); ++p)
            batch.position[p] = rotate_about(RotationAxis(), 0.5 * speed * dt, batch.position[p]) + dt * batch.velocity[p];
        angle += speed * dt;
        mapping.set_time(angle);
        mapping.build(batch.shapes(), stencils);
    }
}
BENCHMARK_CAPTURE(map_one_step, open_water, Scene::open_water)
    ->ArgsProduct({{4, 6, 12, 18}, {50, 90}})
    ->Iterations(40)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(map_one_step, trough, Scene::trough)->ArgsProduct({{12, 18}, {20}})->Iterations(40)->Unit(benchmark::kMillisecond);
BENCHMARK(map_one_step_of_a_replay)
    ->ArgsProduct({{12, 18}, {static_cast<int>(NodeView::all_nodes), static_cast<int>(NodeView::one_node)}})
    ->Iterations(40)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cutterflow::coupling

BENCHMARK_MAIN();
