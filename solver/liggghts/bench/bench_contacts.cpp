// Cost of one contact of two rocks in one DEM step.
//   build/bin/bench_contacts
#include <cstddef>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <Eigen/Geometry>

#include "solver/liggghts/contacts/contact_law.hpp"

namespace cutterflow::liggghts {
namespace {

constexpr double k_step = 8e-5;

struct Pair {
    Contact contact;
    Rolling rolling;
    SlipMemory slip;
    RollMemory roll;
};

/// Contacts of gravel at rest upon another, each a little different. \param speed  of slip [m/s]
std::vector<Pair> pairs(double speed) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.2, 1.2);
    std::normal_distribution<double> normal;
    const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    std::vector<Pair> all(2000);
    for (Pair& pair : all) {
        Contact& contact = pair.contact;
        contact.normal = vector().normalized();
        contact.overlap = 1e-5 * uniform(random);
        contact.radius = 5e-3;
        contact.mass = 0.01;
        contact.elastic = elastic_pair(1e7, 0.25, 0.25);
        contact.damping_factor = 0.1;
        contact.friction = 0.5;
        contact.rolling_friction = 0.1;
        contact.impact_radius = std::sqrt(contact.radius * 1e-5 * uniform(random));
        contact.most_slip_damping = resolved_slip_damping(contact.mass, k_step);
        contact.slip_velocity = speed * vector();
        contact.slip_velocity -= contact.normal * contact.normal.dot(contact.slip_velocity);
        pair.rolling = {100.0 * speed * vector(), 0.0, 1e-7, resolved_roll_damping(1e-7, k_step)};
    }
    return all;
}

/// range(0): speed of slip [um/s].
void slip(benchmark::State& state) {
    std::vector<Pair> all = pairs(1e-6 * static_cast<double>(state.range(0)));
    Vec3 sum = Vec3::Zero();
    for (auto _ : state) {
        for (Pair& pair : all) {
            pair.contact.slip_velocity *= -1.0;
            sum += contact_force(pair.contact, k_step, pair.slip);
        }
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}

void roll(benchmark::State& state) {
    std::vector<Pair> all = pairs(1e-6 * static_cast<double>(state.range(0)));
    Vec3 sum = Vec3::Zero();
    for (auto _ : state) {
        for (Pair& pair : all) {
            pair.rolling.spin *= -1.0;
            sum += rolling_couple(RollingLaw::spring, pair.contact, pair.rolling, 1.0, k_step, pair.roll);
        }
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}

BENCHMARK(slip)->Arg(1)->Arg(1000)->Arg(100000);
BENCHMARK(roll)->Arg(1)->Arg(1000)->Arg(100000);

}  // namespace
}  // namespace cutterflow::liggghts

BENCHMARK_MAIN();
