/// Arrival, rest and bounds of a dry column of cylinders.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "validation/harness/scenes/contact_bench.hpp"
#include "validation/harness/scenes/cylinder_column.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

Vec3 no_force(std::size_t, const Vec3&) {
    return Vec3::Zero();
}

double energy_of(const coupling::Rocks& rocks) {
    double energy = 0.0;
    for (std::size_t n = 0; n < rocks.size(); ++n) {
        const double radius = 0.5 * rocks.diameter[n];
        energy += 0.5 * rocks.velocity[n].squaredNorm() + 0.25 * radius * radius * rocks.angular_velocity[n].squaredNorm() +
                  9.81 * rocks.position[n].z();
    }
    return energy;  // per mass of one cylinder
}

struct Collapse {
    double arrival = 0.0, overlap = 0.0, energy_rise = 0.0, drift = 0.0;
    std::size_t count = 0;
};

/// Follows a column until `end`; the drift is that of the mean place in the last 0.2 s.
Collapse collapse(const CylinderColumn& column, double end) {
    const auto engine = column_engine(column);
    Collapse result;
    constexpr double sample = 1e-3;
    const double start = energy_of(engine->rocks());
    double lowest = start;
    Vec3 before = Vec3::Zero();
    for (int n = 1; n * sample <= end + 0.5 * sample; ++n) {
        const coupling::DemStep step = engine->advance(sample, no_force);
        result.overlap = std::max(result.overlap, 0.5 * step.max_overlap_ratio);
        const double energy = energy_of(engine->rocks());
        result.energy_rise = std::max(result.energy_rise, (energy - lowest) / start);
        lowest = std::min(lowest, energy);
        if (result.arrival == 0.0 && has_arrived(engine->rocks(), column)) result.arrival = n * sample;
        if (std::abs(n * sample - (end - 0.2)) < 0.5 * sample) before = mean_place(engine->rocks());
    }
    result.drift = (mean_place(engine->rocks()) - before).norm();
    result.count = engine->rocks().size();
    return result;
}

void run(Verification& verification) {
    const SingleProcess mpi;
    const Vec3 start = mean_place(column_rocks({}));
    verification.relative("mean x at the start over the tank's width", "-", start.x() / 0.286, 0.1171, 1e-3, {"Chen2019", "geometry", {}});
    verification.relative("mean z at the start", "m", start.z(), 0.0294, 1e-3, {"Chen2019", "geometry", {}});
    double sum = 0.0;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        CylinderColumn column;
        column.jitter = 1e-5;
        column.seed = seed;
        const double arrival = collapse(column, 0.7).arrival;
        sum += arrival / 5.0;
        verification.absolute(fmt::format("arrival, jitter {}", seed), "s", arrival, 0.47, 0.05,
                              {"Chen2019", "within half a second; histories lost", {}});
    }
    CylinderColumn smooth, rough, literal;
    smooth.friction = 0.0;
    rough.friction = 0.5;
    literal.accumulated_shear = false;
    verification.at_most("arrival without friction over the mean", "-", collapse(smooth, 0.8).arrival / sum, 0.9, {"exact", "earlier", {}});
    verification.at_least("arrival with friction 0.5 over the mean", "-", collapse(rough, 1.0).arrival / sum, 1.1, {"exact", "later", {}});
    const Collapse whole = collapse({}, 2.0);
    verification.at_most("largest overlap over the diameter", "-", whole.overlap, 0.03, {"exact", "with the gap's half in the radius", {}});
    verification.at_most("rise of the energy over its lowest, share of the start's", "-", whole.energy_rise, 1e-3,
                         {"exact", "kinetic, spin and weight; springs hold the rest", {}});
    verification.at_most("drift of the mean place in the last 0.2 of 2 s", "m", whole.drift, 1e-6,
                         {"exact", "a heap at rest does not creep", {}});
    verification.absolute("number of cylinders", "-", static_cast<double>(whole.count), 33.0, 0.0, {"exact", "", {}});
    verification.report("drift with the paper's one-step shear", "m", collapse(literal, 2.0).drift, {},
                        {"Chen2019", "no static friction", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
