#include "solver/coupling/dry/free_rock.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::coupling {

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

const DemStep& FreeRock::move() {
    const std::size_t before = dem_.rocks().size();
    step_ = dem_.advance(fluid_.time_step(), [](std::size_t, const Vec3&) -> Vec3 { return Vec3::Zero(); });
    const std::size_t after = dem_.rocks().size() + step_.left.size();
    if (after != before)
        throw CheckFailure({"", fmt::format("of {} rocks {} are there or left after a step", before, after),
                            "Rock stays in the run or leaves it through the domain's boundary", "Report this as a defect"});
    return step_;
}

}  // namespace cutterflow::coupling
