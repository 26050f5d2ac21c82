#include "geometry/packing/rock_placement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::geometry {
namespace {

const RotationAxis k_rotor_axis{};
constexpr double k_most_places = 2e7;  // of a lattice that is searched: some ten seconds, a gigabyte

Cylindrical cylindrical_of(const Vec3& point) {
    return to_cylindrical(k_rotor_axis, Vec3::UnitX(), point);
}

/// Places of the lattice in the box around the region, all of which are looked at.
double lattice_count(const RockBatch& batch) {
    const double width = 2.0 * batch.region.radius_max / batch.lattice_spacing;
    return width * width * (batch.region.z_max - batch.region.z_min) / batch.lattice_spacing;
}

void require_consistent(const RockBatch& batch) {
    std::vector<Mistake> mistakes;
    const auto require = [&mistakes](bool holds, std::string what, std::string rule, std::string remedy) {
        if (!holds) mistakes.push_back({"", std::move(what), std::move(rule), std::move(remedy)});
    };
    require(batch.diameter > 0.0, fmt::format("the rock's diameter is {} m", batch.diameter), "It must be positive", "Give a diameter");
    require(batch.lattice_spacing > batch.diameter, fmt::format("the lattice spacing is {} m", batch.lattice_spacing),
            fmt::format("It must be larger than the rock's diameter, {} m", batch.diameter), "Space the rocks wider");
    const Wedge& region = batch.region;
    require(region.z_min < region.z_max, fmt::format("the feed region lies between z = {} and {} m", region.z_min, region.z_max),
            "The lower end must be below the upper one", "Exchange them");
    require(region.radius_min < region.radius_max,
            fmt::format("the feed region lies between radius {} and {} m", region.radius_min, region.radius_max),
            "The inner radius must be smaller than the outer one", "Exchange them");
    require(region.azimuth_span > 0.0 && region.azimuth_span <= 2.0 * k_pi,
            fmt::format("the feed region spans {} rad", region.azimuth_span), "It must be positive and one turn at most",
            "Give a span of up to 360 degrees");
    const double places = lattice_count(batch);
    if (mistakes.empty())
        require(places <= k_most_places,
                fmt::format("the feed region would take {:.2g} places {:.3g} m apart", places, batch.lattice_spacing),
                fmt::format("At most {:.2g} places are searched for rock", k_most_places),
                "Correct the diameter, make the region less deep, or space the rocks wider");
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

/// Uniform in [0, 1); the same on every platform, unlike the standard distributions.
double uniform(std::mt19937_64& generator) {
    return static_cast<double>(generator() >> 11) * 0x1p-53;
}

std::vector<Vec3> lattice_places(const RockBatch& batch) {
    std::mt19937_64 generator(batch.seed);
    const double a = batch.lattice_spacing;
    Vec3 shift;
    for (int i = 0; i < 3; ++i) shift[i] = a * uniform(generator);
    const Wedge& region = batch.region;
    const int half = static_cast<int>(std::ceil(region.radius_max / a)) + 1;
    const int k_first = static_cast<int>(std::floor((region.z_min - shift.z()) / a));
    const int k_last = static_cast<int>(std::ceil((region.z_max - shift.z()) / a));
    std::vector<Vec3> places;
    for (int k = k_first; k <= k_last; ++k)
        for (int j = -half; j <= half; ++j)
            for (int i = -half; i <= half; ++i) {
                const Vec3 place = a * Vec3(i, j, k) + shift;
                if (region.contains(cylindrical_of(place))) places.push_back(place);
            }
    return places;
}

void sort_from_middle(std::vector<Vec3>& places) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& place : places) middle += place / static_cast<double>(places.size());
    std::stable_sort(places.begin(), places.end(),
                     [&middle](const Vec3& a, const Vec3& b) { return (a - middle).squaredNorm() < (b - middle).squaredNorm(); });
}

class PlaceTest {
public:
    PlaceTest(const RockBatch& batch, const Contour& head, const AxialCylinder& water, const std::vector<const SolidSearch*>& steel)
        : radius_(0.5 * batch.diameter), clearance_(batch.clearance), head_(head), water_(water), steel_(steel) {}

    std::optional<Blocked> blocked(const Vec3& place) const {
        const Cylindrical at = cylindrical_of(place);
        if (at.radius + radius_ > water_.radius || at.axial - radius_ < water_.z_min || at.axial + radius_ > water_.z_max)
            return Blocked::outside_water;
        if (head_.signed_distance(at.radius, at.axial) > -radius_) return Blocked::outside_head;
        for (const SolidSearch* solid : steel_)
            if (solid->contains(place)) return Blocked::inside_steel;
        for (const SolidSearch* solid : steel_)
            if (solid->nearest(place).distance < radius_ + clearance_) return Blocked::too_close_to_steel;
        return std::nullopt;
    }

private:
    double radius_;
    double clearance_;
    const Contour& head_;
    const AxialCylinder& water_;
    const std::vector<const SolidSearch*>& steel_;
};

std::string blocked_text(const RockPlacement& placement) {
    std::string text;
    for (const auto& [reason, count] : placement.blocked)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, reason_of(reason));
    return text;
}

}  // namespace

bool Wedge::contains(const Cylindrical& at) const {
    const double turn = std::remainder(at.azimuth - azimuth_centre, 2.0 * k_pi);
    return at.axial >= z_min && at.axial <= z_max && at.radius >= radius_min && at.radius <= radius_max &&
           std::abs(turn) <= 0.5 * azimuth_span;
}

const char* reason_of(Blocked blocked) {
    switch (blocked) {
        case Blocked::outside_water:
            return "outside the water";
        case Blocked::outside_head:
            return "outside the head's contour";
        case Blocked::inside_steel:
            return "inside steel";
        case Blocked::too_close_to_steel:
            return "too close to steel";
    }
    return "";
}

std::string RockPlacement::rejection_reason() const {
    if (rejected() == 0) return "";
    return fmt::format("no free place left: of the region's {} places {} are blocked ({})", places, places - placed(), blocked_text(*this));
}

RockPlacement place_rocks(const RockBatch& batch, const Contour& head, const AxialCylinder& water,
                          const std::vector<const SolidSearch*>& steel) {
    require_consistent(batch);
    std::vector<Vec3> places = lattice_places(batch);
    sort_from_middle(places);
    const PlaceTest test(batch, head, water, steel);
    RockPlacement placement;
    placement.requested = batch.count;
    placement.places = places.size();
    for (std::size_t i = 0; i < places.size() && placement.placed() < batch.count; ++i) {
        if (const std::optional<Blocked> blocked = test.blocked(places[i])) {
            ++placement.blocked[*blocked];
            continue;
        }
        placement.positions.push_back(places[i]);
        if (i >= batch.count) ++placement.moved;
    }
    if (placement.positions.empty() && batch.count > 0)
        throw UserError(fmt::format("the feed region has no free place for a rock of {} m: {}", batch.diameter,
                                    places.empty() ? "no place of the lattice lies in it" : blocked_text(placement)),
                        "Rocks start in the water, within the head's contour and clear of steel",
                        "Move or enlarge the region, or take a smaller lattice spacing");
    return placement;
}

}  // namespace cutterflow::geometry
