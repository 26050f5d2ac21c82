#include "solver/coupling/dry/free_rock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"

namespace cutterflow::coupling {
namespace {

/// Root mean square [m/s] of the velocities of rock that is not frozen; 0 without.
double speed_of(const Rocks& rocks, const std::vector<int>& frozen) {
    double sum = 0.0;
    std::size_t moving = 0;
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        if (std::binary_search(frozen.begin(), frozen.end(), rocks.id[p])) continue;
        sum += rocks.velocity[p].squaredNorm();
        ++moving;
    }
    return moving > 0 ? std::sqrt(sum / static_cast<double>(moving)) : 0.0;
}

std::vector<double> masses_of(const Rocks& rocks) {
    std::vector<double> masses;
    for (std::size_t p = 0; p < rocks.size(); ++p) masses.push_back(sphere_mass(rocks.diameter[p], rocks.density[p]));
    return masses;
}

}  // namespace

std::vector<int> FreeRock::insert(const std::vector<FeedRock>& due) {
    const Rocks candidates = rocks_of(due);
    const std::vector<int> inserted = dem_.insert(candidates);
    std::vector<int> rejected;
    for (const int id : candidates.id)
        if (!std::binary_search(inserted.begin(), inserted.end(), id)) rejected.push_back(id);
    return rejected;
}

std::vector<bool> FreeRock::room_for(const std::vector<FeedRock>& rocks) const {
    return dem_.room_for(as_listed(rocks));
}

double FreeRock::travel_limit() const {
    return std::numeric_limits<double>::infinity();
}

/// Force [N] that slows rock down over the next step.
HydrodynamicForce FreeRock::resistance() const {
    if (!calming_ || speed_of(dem_.rocks(), dem_.frozen()) > calming_->speed)
        return [](std::size_t, const Vec3&) -> Vec3 { return Vec3::Zero(); };
    return [masses = masses_of(dem_.rocks()), time = calming_->time](std::size_t p, const Vec3& velocity) -> Vec3 {
        return -masses[p] / time * velocity;
    };
}

const DemStep& FreeRock::move() {
    const std::size_t before = dem_.rocks().size();
    step_ = dem_.advance(fluid_.time_step(), resistance());
    const std::size_t after = dem_.rocks().size() + step_.left.size();
    if (after != before)
        throw CheckFailure({"", fmt::format("of {} rocks {} are there or left after a step", before, after),
                            "Rock stays in the run or leaves it through the domain's boundary", "Report this as a defect"});
    return step_;
}

}  // namespace cutterflow::coupling
