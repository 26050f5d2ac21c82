#include "cases/scenes/cutter/cut_face_feed.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/blade_faces.hpp"

namespace cutterflow::cases {
namespace {

constexpr double k_clearance_per_diameter = 0.05;
constexpr double k_heights_per_diameter = 4.0;  // of the smallest rock
constexpr int k_most_heights = 160;
constexpr double k_step_per_diameter = 0.1;  // in the search for room ahead of steel
constexpr double k_farthest_ahead = k_pi / 4.0;
constexpr double k_most_rocks = 1e6;
constexpr double k_innermost_place = 0.5;  // of the contour's radius there
constexpr int k_steps_per_diameter = 2;    // inwards: shorter than a rock's distance from steel, so that none leaps over a blade

double flux_area_of(const geometry::CutFace& face) {
    double area = 0.0;
    for (const geometry::CutFacePatch& patch : face.patches) area += patch.flux_area_m2;
    return area;
}

double positive_angle(double angle) {
    const double rest = std::fmod(angle, 2.0 * k_pi);
    return rest < 0.0 ? rest + 2.0 * k_pi : rest;
}

/// A place in the rotor's frame.
struct Place {
    double radius = 0.0, azimuth = 0.0;
};

/// Where rock of one class starts at one height: for each leading face the places ahead of it, from the contour inwards by diameters.
struct Start {
    double z = 0.0;
    std::vector<std::vector<Place>> ahead;
};

/// Radius at which a sphere lies `depth` within the head's contour; none where the head is too narrow there.
std::optional<double> radius_within(const geometry::Contour& head, double z, double depth) {
    double inside = 0.0, outside = head.radius_at(z);
    if (head.signed_distance(inside, z) > -depth) return std::nullopt;
    while (outside - inside > 1e-9) {
        const double middle = 0.5 * (inside + outside);
        (head.signed_distance(middle, z) > -depth ? outside : inside) = middle;
    }
    return inside;
}

class StartPlaces {
public:
    StartPlaces(const CutRequest& request, const CuttingHead& head)
        : head_(head), cutter_(head.cutter), sense_(head.rotation_speed > 0.0 ? 1.0 : -1.0) {
        double smallest = request.classes.front().extent();
        for (const FeedClass& rock : request.classes) smallest = std::min(smallest, rock.extent());
        const double depth = head.contour.z_ring() - head.contour.z_hub();
        const int heights = std::clamp(static_cast<int>(k_heights_per_diameter * depth / smallest), 4, k_most_heights);
        spacing_ = depth / heights;
        starts_.resize(request.classes.size());
        for (int h = 0; h < heights; ++h) {
            const double z = head.contour.z_hub() + (h + 0.5) * spacing_;
            const auto faces = geometry::steel_intervals(cutter_, head.contour, z, sense_);
            for (std::size_t c = 0; c < request.classes.size(); ++c) add(z, faces, request.classes[c].extent(), starts_[c]);
        }
        for (std::size_t c = 0; c < starts_.size(); ++c)
            if (starts_[c].empty())
                throw UserError({{"", fmt::format("rock of {:.4g} m has no room ahead of any blade", request.classes[c].extent()),
                                  "Rock from a cut face starts within the contour, ahead of a blade's leading face",
                                  "Make the rock smaller, or check the cutter"}});
    }

    bool has(std::size_t rock_class, double z) const { return std::abs(nearest(rock_class, z).z - z) <= spacing_; }

    /// For rock that is cut at height z; as far within the nearest height with places as z lies beyond it.
    const Start& of(std::size_t rock_class, double z) const {
        const Start& start = nearest(rock_class, z);
        return has(rock_class, z) ? start : nearest(rock_class, 2.0 * start.z - z);
    }

private:
    const Start& nearest(std::size_t rock_class, double z) const {
        const std::vector<Start>& starts = starts_[rock_class];
        return *std::min_element(starts.begin(), starts.end(),
                                 [z](const Start& a, const Start& b) { return std::abs(a.z - z) < std::abs(b.z - z); });
    }

    void add(double z, const std::vector<geometry::SteelInterval>& faces, double diameter, std::vector<Start>& starts) const {
        Start start{z, {}};
        for (const geometry::SteelInterval& face : faces) {
            std::vector<Place> places = places_ahead(face.leading, z, diameter);
            if (!places.empty()) start.ahead.push_back(std::move(places));
        }
        if (!start.ahead.empty()) starts.push_back(std::move(start));
    }

    /// Places from the contour inwards, ahead of one leading face: each step goes on from the place before.
    std::vector<Place> places_ahead(double leading, double z, double diameter) const {
        const double distance = (0.5 + k_clearance_per_diameter) * diameter;
        const double innermost = std::max(distance, k_innermost_place * head_.contour.radius_at(z));
        std::vector<Place> places;
        std::optional<double> azimuth;
        for (int step = 0;; ++step) {
            const std::optional<double> radius = radius_within(head_.contour, z, distance + step * diameter / k_steps_per_diameter);
            if (!radius || *radius < innermost) return places;
            azimuth = free_azimuth(azimuth.value_or(leading + sense_ * distance / *radius), leading, z, *radius, distance);
            if (!azimuth) return places;
            if (step % k_steps_per_diameter == 0) places.push_back({*radius, *azimuth});
        }
    }

    /// The first azimuth from `from` on, in the sense of rotation, at which steel is `distance` away: helical blades lean over what is
    /// ahead of them.
    std::optional<double> free_azimuth(double from, double leading, double z, double radius, double distance) const {
        const double step = sense_ * k_step_per_diameter * distance / radius;
        for (double azimuth = from; sense_ * (azimuth - leading) < k_farthest_ahead; azimuth += step) {
            const Vec3 place(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
            if (!cutter_.contains(place) && cutter_.nearest(place).distance >= distance) return azimuth;
        }
        return std::nullopt;
    }

    const CuttingHead& head_;
    geometry::SolidSearch cutter_;
    double sense_;
    double spacing_ = 0.0;                    // of the heights [m]
    std::vector<std::vector<Start>> starts_;  // by class, then by height
};

/// A leading face that passes a patch, in every turn of the head.
struct Passing {
    double time = 0.0;   ///< in the first turn [s]
    double share = 0.0;  ///< of what the whole face gives in a turn: what the patch gave since the passing before
    std::size_t patch = 0;
    double z = 0.0;  ///< of the places [m]
    const std::vector<Place>* places = nullptr;
};

/// Every passing of one turn for a class, in the order of time; the shares add up to 1.
std::vector<Passing> passings_of(std::size_t rock_class, const CutRequest& request, const StartPlaces& places, double speed) {
    const double turn = 2.0 * k_pi / std::abs(speed);
    const double area = flux_area_of(request.face);
    std::vector<Passing> passings;
    for (std::size_t p = 0; p < request.face.patches.size(); ++p) {
        const geometry::CutFacePatch& patch = request.face.patches[p];
        const Start& start = places.of(rock_class, -patch.depth_m);
        std::vector<Passing> of_patch;
        for (const std::vector<Place>& ahead : start.ahead) {
            const double in_rotor = ahead.front().azimuth;
            const double angle = positive_angle(speed > 0.0 ? patch.azimuth_rad - in_rotor : in_rotor - patch.azimuth_rad);
            of_patch.push_back({angle / std::abs(speed), 0.0, p, start.z, &ahead});
        }
        std::sort(of_patch.begin(), of_patch.end(), [](const Passing& a, const Passing& b) { return a.time < b.time; });
        for (std::size_t i = 0; i < of_patch.size(); ++i) {
            const double since = of_patch[i].time - (i == 0 ? of_patch.back().time - turn : of_patch[i - 1].time);
            of_patch[i].share = patch.flux_area_m2 / area * since / turn;
        }
        passings.insert(passings.end(), of_patch.begin(), of_patch.end());
    }
    std::sort(passings.begin(), passings.end(),
              [](const Passing& a, const Passing& b) { return a.time != b.time ? a.time < b.time : a.patch < b.patch; });
    return passings;
}

/// Places of the rock of a passing, the first of them where the face is; run's frame.
std::vector<Vec3> places_of(const Passing& passing, double patch_azimuth) {
    std::vector<Vec3> places;
    for (const Place& place : *passing.places) {
        const double azimuth = patch_azimuth + place.azimuth - passing.places->front().azimuth;
        places.emplace_back(place.radius * std::cos(azimuth), place.radius * std::sin(azimuth), passing.z);
    }
    return places;
}

/// Share of the cut face at heights without a leading face with room for the rock of a class.
double share_without_blade(const geometry::CutFace& face, const StartPlaces& places, std::size_t rock_class) {
    double area = 0.0;
    for (const geometry::CutFacePatch& patch : face.patches)
        if (!places.has(rock_class, -patch.depth_m)) area += patch.flux_area_m2;
    return area / flux_area_of(face);
}

double rocks_per_second(const CutRequest& request, const FeedClass& rock) {
    double shares = 0.0;
    for (const FeedClass& other : request.classes) shares += other.mass_share;
    return request.mass_rate * rock.mass_share / shares / sphere_mass(rock.diameter, rock.density);
}

void require_few_enough(const CutRequest& request) {
    double rocks = 0.0;
    for (const FeedClass& rock : request.classes) rocks += rocks_per_second(request, rock) * (request.end - request.begin);
    if (rocks <= k_most_rocks) return;
    throw UserError({{"", fmt::format("the cut face gives {:.3g} rocks", rocks),
                      fmt::format("A feed has at most {:.3g}, as each is followed on its own", k_most_rocks),
                      "Use larger rock, a shorter feed, or lower feed.disintegration"}});
}

}  // namespace

double cut_mass_rate(const geometry::CutFace& face, double swing_speed, double grain_density, double porosity) {
    return swing_speed * flux_area_of(face) * grain_density * (1.0 - porosity);
}

CutSchedule cut_face_schedule(const CutRequest& request, const CuttingHead& head) {
    require_few_enough(request);
    const StartPlaces places(request, head);
    const double turn = 2.0 * k_pi / std::abs(head.rotation_speed);
    std::mt19937_64 generator(request.seed);
    // By hand: the standard's distributions differ between libraries.
    const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
    CutSchedule schedule;
    for (std::size_t c = 0; c < request.classes.size(); ++c) {
        const std::vector<Passing> passings = passings_of(c, request, places, head.rotation_speed);
        const double per_turn = rocks_per_second(request, request.classes[c]) * turn;
        schedule.share_without_blade = std::max(schedule.share_without_blade, share_without_blade(request.face, places, c));
        // Rock number k of the class comes with the passing in which what was cut, in rocks, grows beyond k plus a draw.
        double cut = 0.0, number = 0.0, next = uniform();
        for (double begin = turn * std::floor(request.begin / turn); begin < request.end; begin += turn)
            for (const Passing& passing : passings) {
                const double time = begin + passing.time;
                if (time < request.begin || time >= request.end) continue;
                for (cut += per_turn * passing.share; next < cut; next = ++number + uniform()) {
                    schedule.rocks.push_back({time, places_of(passing, request.face.patches[passing.patch].azimuth_rad), c});
                }
            }
    }
    std::stable_sort(schedule.rocks.begin(), schedule.rocks.end(), [](const CutRock& a, const CutRock& b) { return a.time < b.time; });
    return schedule;
}

}  // namespace cutterflow::cases
