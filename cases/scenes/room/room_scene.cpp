#include "cases/scenes/room/room_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/sphere.hpp"

namespace cutterflow::cases {

double RoomSolid::fastest() const {
    double fastest = 0.0;
    for (const coupling::WallTravel& travel : travels) fastest = std::max(fastest, travel.velocity.norm());
    if (!turn) return fastest;
    double farthest = 0.0;  // from the axis
    for (const Vec3& point : surface.points) farthest = std::max(farthest, (point - turn->axis.origin).cross(turn->axis.direction).norm());
    return std::abs(turn->speed) * farthest;
}

double ThroughFlow::largest_speed() const {
    double largest = 0.0;
    for (const auto& [time, value] : speed) largest = std::max(largest, value);
    return largest;
}

double ThroughFlow::changes_until() const {
    return speed.size() > 1 ? speed.back().first : 0.0;
}

double RoomGrains::girth() const {
    return shape ? 2.0 * shape->reach() : 1.0;
}

std::size_t RoomGrains::spheres() const {
    return shape ? shape->balls.size() : 1;
}

std::vector<GrainClass> RoomGrains::extremes() const {
    if (const auto* uniform = std::get_if<UniformByNumber>(&sizes))
        return {{uniform->smallest, 0.5, density}, {uniform->largest, 0.5, density}};
    return std::get<std::vector<GrainClass>>(sizes);
}

double RoomGrains::smallest() const {
    double smallest = std::numeric_limits<double>::infinity();
    for (const GrainClass& one : extremes()) smallest = std::min(smallest, one.diameter);
    return smallest;
}

double RoomGrains::largest() const {
    double largest = 0.0;
    for (const GrainClass& one : extremes()) largest = std::max(largest, one.diameter);
    return largest;
}

double RoomGrains::mean_mass() const {
    if (const auto* uniform = std::get_if<UniformByNumber>(&sizes)) {
        const double a = uniform->smallest, b = uniform->largest;
        return density * (k_pi / 6.0 * 0.25 * (a + b) * (a * a + b * b));  // of the mean of d^3 over [a, b]
    }
    double grains_per_mass = 0.0;
    for (const GrainClass& one : std::get<std::vector<GrainClass>>(sizes))
        grains_per_mass += one.mass_share / (one.density * sphere_volume(one.diameter));
    return 1.0 / grains_per_mass;
}

double RoomGrains::mean_density() const {
    const auto* classes = std::get_if<std::vector<GrainClass>>(&sizes);
    if (classes == nullptr) return density;
    double relative = 0.0;  // volume over that of as much mass of `density`: 1 to the bit where no class has a density of its own
    double shares = 0.0;
    for (const GrainClass& one : *classes) {
        relative += one.mass_share * (density / one.density);
        shares += one.mass_share;
    }
    return density * (shares / relative);
}

/// It is dry, and what the run does to solids is nothing to it.
coupling::ContactSettings RoomScene::bed_contact() const {
    coupling::ContactSettings of_bed = contact;
    of_bed.wet_restitution = false;
    of_bed.max_speed = bed_max_speed;
    return of_bed;
}

double RoomScene::smallest_grain() const {
    double smallest = std::numeric_limits<double>::infinity();
    for (const RoomGrains& kind : grains) smallest = std::min(smallest, kind.smallest());
    return smallest;
}

double RoomScene::largest_grain() const {
    double largest = 0.0;
    for (const RoomGrains& kind : grains) largest = std::max(largest, kind.largest());
    return largest;
}

double RoomScene::longest_grain() const {
    double longest = 0.0;
    for (const RoomGrains& kind : grains) longest = std::max(longest, kind.girth() * kind.largest());
    return longest;
}

double RoomScene::densest_grain() const {
    double densest = 0.0;
    for (const RoomGrains& kind : grains)
        for (const GrainClass& one : kind.extremes()) densest = std::max(densest, one.density);
    return densest;
}

double RoomScene::fed_mass() const {
    double mass = 0.0;
    for (const RoomEvent& event : events)
        if (const auto* feed = std::get_if<FeedEvent>(&event)) mass += feed->mass(run.end);
    return mass;
}

bool RoomScene::is_as_at_first(const RoomSolid& solid, double time) const {
    const bool gone = solid.removed_at && *solid.removed_at <= time;
    const bool moved = (!solid.travels.empty() && solid.travels.front().begin < time) || (solid.turn && solid.turn->begin < time);
    const bool pressed = std::any_of(preparation.begin(), preparation.end(), [&](const PrepareStep& step) {
        const auto* compress = std::get_if<CompressStep>(&step);
        return compress != nullptr && compress->solid == solid.name;
    });
    return !gone && !moved && !pressed;
}

const RoomGrains* RoomScene::find_grains(const std::string& wanted) const {
    const auto found = std::find_if(grains.begin(), grains.end(), [&](const RoomGrains& one) { return one.name == wanted; });
    return found == grains.end() ? nullptr : &*found;
}

const RoomSolid* RoomScene::find_solid(const std::string& wanted) const {
    const auto found = std::find_if(solids.begin(), solids.end(), [&](const RoomSolid& one) { return one.name == wanted; });
    return found == solids.end() ? nullptr : &*found;
}

const RoomGate* RoomScene::find_gate(const std::string& wanted) const {
    const auto found = std::find_if(gates.begin(), gates.end(), [&](const RoomGate& one) { return one.name == wanted; });
    return found == gates.end() ? nullptr : &*found;
}

}  // namespace cutterflow::cases
