// Cost of a DEM step with rock in a turning head of six blades, by the number of its triangles.
//   build/bin/bench_walls
#include <cmath>
#include <filesystem>
#include <fstream>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <mpi.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/liggghts/liggghts_engine.hpp"

namespace cutterflow::liggghts {
namespace {

constexpr int k_blades = 6;
constexpr double k_speed = 2.0 * k_pi;

/// A twisted sheet from the hub outwards, of 2 n^2 triangles.
void write_blade(std::ofstream& stream, double azimuth, int n) {
    const auto corner = [&](int i, int j) {
        const double r = 0.08 + 0.22 * i / n, z = -0.2 + 0.3 * j / n, angle = azimuth + 1.5 * z;
        return Vec3(r * std::cos(angle), r * std::sin(angle), z);
    };
    const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        stream << "facet normal 0 0 0\nouter loop\n";
        for (const Vec3& v : {a, b, c}) stream << fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z());
        stream << "endloop\nendfacet\n";
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            facet(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1));
            facet(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
        }
    }
}

std::filesystem::path write_head(int n) {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("bench_walls_{}.stl", n);
    std::ofstream stream(file);
    stream << "solid head\n";
    for (int blade = 0; blade < k_blades; ++blade) write_blade(stream, 2.0 * k_pi / k_blades * blade, n);
    stream << "endsolid head\n";
    return file;
}

/// 368 rocks of 20 mm between the blades.
coupling::Rocks batch() {
    coupling::Rocks rocks;
    for (int k = 0; rocks.size() < 368; ++k) {
        const int column = k % 23, layer = k / 23;
        const double azimuth = 2.0 * k_pi * (column % 12 + 0.5) / 12.0, r = column < 12 ? 0.25 : 0.16;
        const Vec3 place(r * std::cos(azimuth), r * std::sin(azimuth), -0.19 + 0.022 * layer);
        rocks.append({k + 1, place, Vec3(0, 0, k_speed).cross(place), Vec3::Zero(), 0.02, 2650.0});
    }
    return rocks;
}

/// range(0): cells of a blade along each side.
void step_in_a_turning_head(benchmark::State& state) {
    const int n = static_cast<int>(state.range(0));
    coupling::DemSettings settings;
    settings.contact.youngs_modulus = 1.1e8;
    settings.contact.max_speed = 4.0;
    settings.domain = coupling::cylinder_domain(0.5, -0.2, 0.5);
    settings.domain.make_wall(coupling::DomainSide::z_min);
    settings.fluid = {998.2, 1.0034e-6};
    settings.added_mass = 0.5;
    settings.gravity = Vec3(0, 0, -9.81);
    settings.walls = {{"head", write_head(n), true}};
    coupling::ZoneMotion rotor;
    rotor.speed = k_speed;
    LiggghtsEngine engine(settings, {rotor}, MPI_COMM_WORLD);
    const std::size_t inserted = engine.insert(batch()).size();
    const auto drag = [](std::size_t, const Vec3& velocity) { return Vec3(-0.05 * velocity); };
    engine.advance(0.1, drag);
    double steps = 0.0, touches = 0.0, calls = 0.0;
    for (auto _ : state) {
        const coupling::DemStep done = engine.advance(5e-3, drag);
        steps += done.substeps;
        touches += done.contacts;
        ++calls;
    }
    state.counters["per_step"] = benchmark::Counter(steps, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["triangles"] = 2.0 * k_blades * n * n;
    state.counters["rocks"] = static_cast<double>(inserted);
    state.counters["contacts"] = touches / calls;
}
BENCHMARK(step_in_a_turning_head)->Arg(14)->Arg(25)->Iterations(40)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cutterflow::liggghts

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    MPI_Finalize();
}
