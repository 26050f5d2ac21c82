#include "cases/scenes/room/grain_placement.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/packing/free_space.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_falling_share = 0.3;  // of the free part of a region that a batch fills at most
constexpr double k_falling_speed = 1.0;  // [m/s]
constexpr double k_times_to_fall = 2.0;  // until the next batch
constexpr int k_tries = 400;             // places tried for a grain before it waits for the next batch
constexpr int k_most_batches = 10000;
constexpr double k_gap = 1e-3;         // between grains that begin, over the diameter
constexpr double k_loose_share = 0.5;  // of a bed beside walls a few grains apart; what has come down lies no higher
constexpr double k_bumps = 2.0;        // of its surface, above the mean, over the largest grain

double bottom_of(const Region& region) {
    if (const auto* box = std::get_if<BoxRegion>(&region)) return box->lower.z();
    return std::get<CylinderRegion>(region).from.z();
}

std::pair<Eigen::Array2d, Eigen::Array2d> extent_of(const Region& region) {
    if (const auto* box = std::get_if<BoxRegion>(&region)) return {box->lower.head<2>().array(), box->upper.head<2>().array()};
    const auto& cylinder = std::get<CylinderRegion>(region);
    return {cylinder.from.head<2>().array() - cylinder.radius, cylinder.from.head<2>().array() + cylinder.radius};
}

bool overlap_seen_from_above(const Region& a, const Region& b) {
    const auto [a_from, a_to] = extent_of(a);
    const auto [b_from, b_to] = extent_of(b);
    return (a_from < b_to).all() && (b_from < a_to).all();
}

/// Grains that begin, found by the cells of a grid.
class Neighbours {
public:
    explicit Neighbours(double largest_diameter) : cell_(largest_diameter * (1.0 + k_gap)) {}

    bool has_room(const Vec3& place, double diameter) const {
        const auto [i, j, k] = cell_of(place);
        for (std::int64_t a = i - 1; a <= i + 1; ++a)
            for (std::int64_t b = j - 1; b <= j + 1; ++b)
                for (std::int64_t c = k - 1; c <= k + 1; ++c) {
                    const auto found = grains_.find(key(a, b, c));
                    if (found == grains_.end()) continue;
                    for (const auto& [other, size] : found->second)
                        if ((other - place).norm() < 0.5 * (size + diameter) * (1.0 + k_gap)) return false;
                }
        return true;
    }
    void add(const Vec3& place, double diameter) {
        const auto [i, j, k] = cell_of(place);
        grains_[key(i, j, k)].emplace_back(place, diameter);
    }

private:
    std::array<std::int64_t, 3> cell_of(const Vec3& place) const {
        return {static_cast<std::int64_t>(std::floor(place.x() / cell_)), static_cast<std::int64_t>(std::floor(place.y() / cell_)),
                static_cast<std::int64_t>(std::floor(place.z() / cell_))};
    }
    /// Cells of one key are tested by distance all the same.
    static std::int64_t key(std::int64_t i, std::int64_t j, std::int64_t k) { return (i * 73856093) ^ (j * 19349663) ^ (k * 83492791); }

    double cell_;
    std::unordered_map<std::int64_t, std::vector<std::pair<Vec3, double>>> grains_;
};

std::vector<geometry::SolidSearch> searches_of(const RoomScene& scene) {
    std::vector<geometry::SolidSearch> searches;
    for (const RoomSolid& solid : scene.solids) searches.emplace_back(solid.surface);
    return searches;
}

/// Random places of a region, within it as a whole, clear of the solids.
class Places {
public:
    Places(const RoomScene& scene, std::mt19937_64& random) : random_(random), solids_(searches_of(scene)) {}

    const std::vector<geometry::SolidSearch>& solids() const { return solids_; }

    /// \param from, to  levels between which the whole grain lies; none when there is no place between
    std::optional<Vec3> draw(const Region& region, double from, double to, double diameter) {
        const double radius = 0.5 * diameter;
        if (to - from < diameter) return std::nullopt;
        Vec3 place(0.0, 0.0, between(from + radius, to - radius));
        if (const auto* box = std::get_if<BoxRegion>(&region)) {
            if (box->upper.x() - box->lower.x() < diameter || box->upper.y() - box->lower.y() < diameter) return std::nullopt;
            place.x() = between(box->lower.x() + radius, box->upper.x() - radius);
            place.y() = between(box->lower.y() + radius, box->upper.y() - radius);
            return place;
        }
        const auto& cylinder = std::get<CylinderRegion>(region);
        if (cylinder.radius < radius) return std::nullopt;
        const double out = (cylinder.radius - radius) * std::sqrt(between(0.0, 1.0)), angle = between(0.0, 2.0 * k_pi);
        place.head<2>() = cylinder.from.head<2>() + out * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        return place;
    }

    bool clear_of_solids(const Vec3& place, double diameter) const {
        return clear_of_solids(place, diameter, [](std::size_t) { return true; });
    }
    /// \param counts  whether a solid does, by its index in the scene
    template <class Counts>
    bool clear_of_solids(const Vec3& place, double diameter, const Counts& counts) const {
        for (std::size_t n = 0; n < solids_.size(); ++n)
            if (counts(n) && (solids_[n].nearest(place).distance < 0.5 * diameter * (1.0 + k_gap) || solids_[n].contains(place)))
                return false;
        return true;
    }

private:
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

    std::mt19937_64& random_;
    std::vector<geometry::SolidSearch> solids_;
};

/// Time to fall a height from the speed with which grains begin.
double time_to_fall(double height, double gravity) {
    if (gravity == 0.0) return height / k_falling_speed;
    return (std::sqrt(k_falling_speed * k_falling_speed + 2.0 * gravity * height) - k_falling_speed) / gravity;
}

std::string shape_of(const RoomGrains& grains) {
    return grains.clump.empty() ? std::string() : grains.name;
}

DrawnGrain draw_grain(const RoomGrains& grains, std::mt19937_64& random) {
    if (const auto* uniform = std::get_if<UniformByNumber>(&grains.sizes))
        return {std::uniform_real_distribution<double>(uniform->smallest, uniform->largest)(random), grains.density};
    const auto& classes = std::get<std::vector<GrainClass>>(grains.sizes);
    std::vector<double> numbers;  // grains per mass, times one density: the same draws whatever it is
    for (const GrainClass& one : classes) numbers.push_back(one.mass_share / sphere_volume(one.diameter) * (grains.density / one.density));
    const GrainClass& drawn = classes[std::discrete_distribution<std::size_t>(numbers.begin(), numbers.end())(random)];
    return {drawn.diameter, drawn.density};
}

/// A place for a fed grain; solids that have moved by its time are left to the run, in which a grain without room waits.
std::optional<Vec3> place_in_feed(const RoomScene& scene, const FeedEvent& feed, Places& places, double time, double diameter) {
    const double bottom = bottom_of(feed.region);
    const auto stands = [&](std::size_t solid) { return scene.is_as_at_first(scene.solids[solid], time); };
    for (int i = 0; i < k_tries; ++i) {
        const std::optional<Vec3> place = places.draw(feed.region, bottom, bottom + height_of(feed.region), diameter);
        if (!place || places.clear_of_solids(*place, diameter, stands)) return place;
    }
    return std::nullopt;
}

/// \throws UserError  when a grain finds no place
void place_feed(const RoomScene& scene, const FeedEvent& feed, Places& places, int first_id, std::mt19937_64& random,
                std::vector<PlacedGrain>& grains) {
    const RoomGrains& kind = *scene.find_grains(feed.grains);
    double due = 0.0;
    for (const auto& [diameter, density] : draw_grains(kind, feed.rate * (feed.to - feed.from), random)) {
        const double time = feed.from + due / feed.rate;
        const std::optional<Vec3> place = place_in_feed(scene, feed, places, time, kind.girth() * diameter);
        if (!place)
            throw UserError(
                {{feed.where, fmt::format("grains of {} find no place in the region of their feed at {:.3g} s", feed.grains, time),
                  "They begin in the region as a whole, clear of the solids that stand there", "Give a larger region"}});
        grains.push_back({first_id + static_cast<int>(grains.size()), time, *place, diameter, density, Vec3::Zero(), shape_of(kind)});
        due += density * sphere_volume(diameter);
    }
}

}  // namespace

/// A pour in batches.
struct Pouring::Impl {
public:
    Impl(const RoomScene& scene, std::mt19937_64& random) : scene_(scene), random_(random), places_(scene, random) {}

    /// \throws UserError  when grains find no place
    void pour(const PourStep& step) {
        const RoomGrains& grains = *scene_.find_grains(step.grains);
        const std::vector<DrawnGrain> drawn =
            step.count ? draw_grains(grains, *step.count, random_) : draw_grains(grains, step.mass, random_);
        const double bottom = bottom_of(step.region), top = bottom + height_of(step.region);
        const geometry::FreeSpace room(step.region, places_.solids());
        double lying = lying_in(step.region, room);
        std::size_t next = 0;
        for (int batch = 0; next < drawn.size() && batch < k_most_batches; ++batch) {
            const std::size_t before = next;
            const double level = lying > 0.0 ? room.level_of(lying) + k_bumps * grains.girth() * grains.largest() : bottom;
            const double placed = place_batch(step, grains, drawn, next, std::min(level, top), top, room);
            if (next == before) refuse(step, drawn.size() - next, drawn.size());
            history_.emplace_back(Deposit{step.region, placed / k_loose_share});
            lying += placed / k_loose_share;
            time_ += k_times_to_fall * time_to_fall(top - bottom, scene_.gravity_strength);
        }
        if (next < drawn.size()) refuse(step, drawn.size() - next, drawn.size());
    }

    void trim(const Region& region) {
        const auto* half = std::get_if<HalfSpaceRegion>(&region);
        if (half != nullptr && half->normal.z() > 0.0 && half->normal.head<2>().isZero())
            history_.emplace_back(TrimLevel{half->point.z()});
        else
            uncounted_trim_ = true;
    }

    std::vector<PlacedGrain> take() {
        time_ = 0.0;
        return std::exchange(grains_, {});
    }

private:
    /// Grains that came down in a region.
    struct Deposit {
        Region region;
        double bulk = 0.0;  // [m3]
    };
    /// All above a level was taken out.
    struct TrimLevel {
        double height = 0.0;  // [m]
    };

    /// \return volume of the placed grains [m3]
    double place_batch(const PourStep& step, const RoomGrains& grains, const std::vector<DrawnGrain>& drawn, std::size_t& next,
                       double level, double top, const geometry::FreeSpace& room) {
        Neighbours neighbours(grains.girth() * grains.largest());
        const double allowed = k_falling_share * (room.volume() - room.volume_below(level));
        double placed = 0.0;
        for (; next < drawn.size(); ++next) {
            const auto [diameter, density] = drawn[next];
            if (placed > 0.0 && placed + sphere_volume(diameter) > allowed) break;
            const std::optional<Vec3> place = free_place(step.region, neighbours, level, top, grains.girth() * diameter);
            if (!place) break;
            neighbours.add(*place, grains.girth() * diameter);
            placed += sphere_volume(diameter);
            grains_.push_back({++last_id_, time_, *place, diameter, density, Vec3(0.0, 0.0, -k_falling_speed), shape_of(grains)});
            if (!history_.empty()) grains_.back().above = place_at_top(*place, top, grains.girth() * diameter);
        }
        return placed;
    }

    std::optional<Vec3> free_place(const Region& region, const Neighbours& neighbours, double level, double top, double diameter) {
        for (int i = 0; i < k_tries; ++i) {
            const std::optional<Vec3> place = places_.draw(region, level, top, diameter);
            if (!place) return std::nullopt;
            if (neighbours.has_room(*place, diameter) && places_.clear_of_solids(*place, diameter)) return place;
        }
        return std::nullopt;
    }

    std::optional<Vec3> place_at_top(const Vec3& place, double top, double diameter) const {
        const Vec3 above(place.x(), place.y(), top - 0.5 * diameter);
        return places_.clear_of_solids(above, diameter) ? std::optional<Vec3>(above) : std::nullopt;
    }

    /// Bulk volume [m3] that earlier pours may have left in a region, at their loosest. \param room  that solids leave there
    double lying_in(const Region& region, const geometry::FreeSpace& room) const {
        double volume = 0.0;
        for (const std::variant<Deposit, TrimLevel>& past : history_) {
            if (const auto* trim = std::get_if<TrimLevel>(&past)) volume = std::min(volume, room.volume_below(trim->height));
            const auto* deposit = std::get_if<Deposit>(&past);
            if (deposit != nullptr && overlap_seen_from_above(deposit->region, region)) volume += deposit->bulk;
        }
        return volume;
    }

    [[noreturn]] void refuse(const PourStep& step, std::size_t left, std::size_t all) const {
        const char* trimmed =
            uncounted_trim_ ? "; what a trim takes out of another region than one above a level counts as lying there" : "";
        throw UserError(
            {{step.where, fmt::format("{} of {} grains of {} find no place in the region of their pour", left, all, step.grains),
              fmt::format("They begin in its free part, above what has come down, clear of the solids{}", trimmed),
              "Pour less, or give a larger region"}});
    }

    const RoomScene& scene_;
    std::mt19937_64& random_;
    Places places_;
    std::vector<PlacedGrain> grains_;
    double time_ = 0.0;
    std::vector<std::variant<Deposit, TrimLevel>> history_;
    bool uncounted_trim_ = false;
    int last_id_ = 0;
};

Pouring::Pouring(const RoomScene& scene, std::mt19937_64& random) : impl_(std::make_unique<Impl>(scene, random)) {}
Pouring::~Pouring() = default;

void Pouring::pour(const PourStep& step) {
    impl_->pour(step);
}

void Pouring::trim(const Region& region) {
    impl_->trim(region);
}

std::vector<PlacedGrain> Pouring::take() {
    return impl_->take();
}

double area_of(const Region& region) {
    if (const auto* box = std::get_if<BoxRegion>(&region)) return (box->upper.x() - box->lower.x()) * (box->upper.y() - box->lower.y());
    const auto& cylinder = std::get<CylinderRegion>(region);
    return k_pi * cylinder.radius * cylinder.radius;
}

double height_of(const Region& region) {
    if (const auto* box = std::get_if<BoxRegion>(&region)) return box->upper.z() - box->lower.z();
    const auto& cylinder = std::get<CylinderRegion>(region);
    return cylinder.to.z() - cylinder.from.z();
}

double free_volume(const RoomScene& scene, const Region& region) {
    return geometry::FreeSpace(region, searches_of(scene)).volume();
}

std::vector<DrawnGrain> draw_grains(const RoomGrains& grains, double mass, std::mt19937_64& random) {
    std::vector<DrawnGrain> all;
    for (double drawn = 0.0;;) {
        const DrawnGrain grain = draw_grain(grains, random);
        const double weight = grain.density * sphere_volume(grain.diameter);
        if (drawn + 0.5 * weight > mass && !all.empty()) return all;
        all.push_back(grain);
        drawn += weight;
    }
}

std::vector<DrawnGrain> draw_grains(const RoomGrains& grains, std::size_t count, std::mt19937_64& random) {
    std::vector<DrawnGrain> all(count);
    std::generate(all.begin(), all.end(), [&] { return draw_grain(grains, random); });
    return all;
}

std::vector<PlacedGrain> place_feeds(const RoomScene& scene, int first_id, std::mt19937_64& random) {
    Places places(scene, random);
    std::vector<PlacedGrain> grains;
    Mistakes mistakes;
    for (const RoomEvent& event : scene.events)
        if (const auto* feed = std::get_if<FeedEvent>(&event))
            mistakes.gather([&] { place_feed(scene, *feed, places, first_id, random, grains); });
    mistakes.refuse();
    std::stable_sort(grains.begin(), grains.end(), [](const PlacedGrain& a, const PlacedGrain& b) { return a.time < b.time; });
    return grains;
}

std::string grain_feed_csv(const std::vector<PlacedGrain>& grains) {
    const bool shaped = std::any_of(grains.begin(), grains.end(), [](const PlacedGrain& g) { return !g.shape.empty(); });
    const bool several = std::any_of(grains.begin(), grains.end(), [](const PlacedGrain& g) { return g.above.has_value(); });
    std::string text = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s";
    text += fmt::format("{}{}\n", several ? ",place" : "", shaped ? ",shape" : "");
    const auto add = [&](const PlacedGrain& g, const Vec3& position, int place) {
        text += fmt::format("{},{},{},{},{},{},{},{},{},{}", g.id, g.time, position.x(), position.y(), position.z(), g.diameter, g.density,
                            g.velocity.x(), g.velocity.y(), g.velocity.z());
        if (several) text += fmt::format(",{}", place);
        text += shaped ? "," + g.shape + "\n" : "\n";
    };
    for (const PlacedGrain& g : grains) {
        add(g, g.position, 0);
        if (g.above) add(g, *g.above, 1);
    }
    return text;
}

}  // namespace cutterflow::cases
