#include "cases/scenes/cutter/feed.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/scenes/cutter/study_bank.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/packing/rock_placement.hpp"
#include "solver/physics/catalogue.hpp"
#include "solver/physics/settling.hpp"

namespace cutterflow::cases {
namespace {

// Rock starts clear of steel by this share of its diameter, so that no contact is under way at the release.
constexpr double k_clearance_per_diameter = 0.05;
constexpr double k_patch_per_ring_radius = 0.02;  // of the cut face
constexpr double k_share_without_blade = 0.05;
constexpr int k_layers = 20;                       // up to the bank's height, whose sections are told
constexpr std::int64_t k_seed_of_layer = 1000003;  // beside the cut face's: their rock comes at times of its own

double mass_of(const FeedClass& rock) {
    return sphere_mass(rock.diameter, rock.density);
}

double largest_extent(const FeedRequest& request) {
    return std::max_element(request.classes.begin(), request.classes.end(),
                            [](const FeedClass& a, const FeedClass& b) { return a.extent() < b.extent(); })
        ->extent();
}

/// Whole numbers that add up to `total` in the proportion of `weights`: the largest remainders are rounded up.
std::vector<std::size_t> apportion(std::size_t total, const std::vector<double>& weights) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<std::size_t> counts;
    std::vector<double> remainders;
    for (const double weight : weights) {
        const double exact = static_cast<double>(total) * weight / sum;
        counts.push_back(static_cast<std::size_t>(exact));
        remainders.push_back(exact - std::floor(exact));
    }
    std::vector<std::size_t> order(weights.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return remainders[a] > remainders[b]; });
    const std::size_t given = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    for (std::size_t i = 0; i < total - given; ++i) ++counts[order[i]];
    return counts;
}

/// Classes of the rocks in the order of their places, drawn with the seed.
std::vector<std::size_t> shuffled_classes(const std::vector<std::size_t>& counts, std::int64_t seed) {
    std::vector<std::size_t> classes;
    for (std::size_t i = 0; i < counts.size(); ++i) classes.insert(classes.end(), counts[i], i);
    std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
    // Fisher-Yates by hand: std::shuffle gives other orders on other standard libraries.
    for (std::size_t i = classes.size(); i > 1; --i) std::swap(classes[i - 1], classes[generator() % i]);
    return classes;
}

geometry::RockBatch batch_of(const FeedRequest& request, std::size_t count) {
    const double diameter = largest_extent(request);
    geometry::RockBatch batch;
    batch.count = count;
    batch.diameter = diameter;
    batch.lattice_spacing = request.spacing * diameter;
    batch.clearance = k_clearance_per_diameter * diameter;
    batch.region = {request.azimuth_centre, request.azimuth_width, -request.depth_to,
                    -request.depth_from,    request.radius_from,   request.radius_to};
    batch.seed = static_cast<std::uint64_t>(request.seed);
    return batch;
}

PlacedFeed place_batch(const FeedRequest& request, const Study& study, const FeedScene& scene, const geometry::SolidSearch& stationary) {
    const double angle = study.rotation_speed * request.start;
    const Eigen::Affine3d turn(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    const geometry::SolidSearch cutter(geometry::transformed(scene.cutter, turn));
    const std::vector<std::size_t> counts = rocks_per_class(request);
    const std::size_t count = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    const AxialCylinder water = study.water(scene.size);
    const geometry::RockPlacement placement = geometry::place_rocks(batch_of(request, count), scene.head, water, {&cutter, &stationary});

    PlacedFeed feed{request, placement.requested, {}, {}};
    const std::vector<std::size_t> classes = shuffled_classes(counts, request.seed);
    for (std::size_t i = 0; i < placement.positions.size(); ++i)
        feed.rocks.push_back({request.start, {{placement.positions[i], std::nullopt}}, classes[i]});
    if (placement.rejected() > 0) feed.reasons.push_back(placement.rejection_reason());
    return feed;
}

/// Rock from a face of the bank that the head passes. \param mass_rate  of rock [kg/s]
PlacedFeed place_cut_face(const FeedRequest& request, const Study& study, const FeedScene& scene, const geometry::CutFace& face,
                          double mass_rate) {
    CutRequest cut;
    cut.face = face;
    cut.mass_rate = mass_rate;
    cut.begin = request.start;
    cut.end = request.end;
    cut.seed = static_cast<std::uint64_t>(request.seed);
    cut.classes = request.classes;
    PlacedFeed feed{request, 0, {}, {}};
    const CutSchedule schedule = cut_face_schedule(cut, {scene.head, scene.cutter, study.rotation_speed});
    for (const CutRock& rock : schedule.rocks) feed.rocks.push_back(placed_rock(rock, request.velocity_share * study.rotation_speed));
    if (schedule.share_without_blade > k_share_without_blade)
        feed.reasons.push_back(
            fmt::format("{:.0f} % of the cut face is passed by closed steel, a hub or a ring, where no blade takes rock in. "
                        "Its rock starts ahead of the blades beside it; look at the cutter's lowest part. A bank.step_m up to "
                        "about the ring radius or a flatter ladder may make it smaller, soil far from the head (bank.pick_length_m, "
                        "bank.clearance_m) makes it larger",
                        100.0 * schedule.share_without_blade));
    if (feed.rocks.empty())
        feed.reasons.push_back(
            fmt::format("not one rock comes from {:.4g} to {:.4g} s: the cut gives {:.2g} kg of it until then; swing faster or run longer",
                        request.start, request.end, mass_rate * (request.end - request.start)));
    feed.requested = feed.rocks.size();
    return feed;
}

/// What the swing cuts and, as another feed of the same sizes, the loose rock that the swing before left. \pre the scene has a cut face
std::vector<PlacedFeed> place_swing(const FeedRequest& request, const Study& study, const FeedScene& scene) {
    const Study::Bank& bank = *study.bank;
    const double cut = request.disintegration * cut_mass_rate(*scene.cut_face, bank.swing_speed, bank.grain_density, bank.porosity);
    std::vector<PlacedFeed> feeds{place_cut_face(request, study, scene, *scene.cut_face, cut)};
    feeds.front().layers = scene.layers;
    if (!scene.spill_layer) return feeds;
    FeedRequest of_layer = request;
    of_layer.seed += k_seed_of_layer;
    const double left = cut_mass_rate(*scene.spill_layer, bank.swing_speed, bank.grain_density, bank.porosity) / bank.bulking;
    feeds.push_back(place_cut_face(of_layer, study, scene, *scene.spill_layer, left));
    feeds.back().is_spill_layer = true;
    return feeds;
}

bool has_shapes(const std::vector<PlacedFeed>& feeds) {
    return std::any_of(feeds.begin(), feeds.end(), [](const PlacedFeed& feed) {
        const std::vector<FeedClass>& classes = feed.request.classes;
        return std::any_of(classes.begin(), classes.end(), [](const FeedClass& rock) { return rock.shape.has_value(); });
    });
}

}  // namespace

PlacedRock placed_rock(const CutRock& rock, double angular_velocity) {
    PlacedRock placed{rock.time, {}, rock.rock_class};
    for (const Vec3& place : rock.places) placed.places.push_back({place, angular_velocity * Vec3::UnitZ().cross(place)});
    return placed;
}

std::vector<std::size_t> rocks_per_class(const FeedRequest& request) {
    std::vector<double> numbers;  // of rocks per kilogram of the feed, times the sum of the shares
    double shares = 0.0;
    for (const FeedClass& rock : request.classes) {
        numbers.push_back(rock.mass_share / mass_of(rock));
        shares += rock.mass_share;
    }
    if (request.kind == FeedKind::cut_face) return std::vector<std::size_t>(request.classes.size(), 0);
    if (request.count) return apportion(static_cast<std::size_t>(*request.count), numbers);
    std::vector<std::size_t> counts;
    for (const double number : numbers) counts.push_back(static_cast<std::size_t>(std::llround(*request.mass * number / shares)));
    return counts;
}

FeedScene feed_scene(const Study& study, const HeadSize& size, const geometry::Contour& head, const geometry::TriangleSurface& cutter) {
    FeedScene scene{head, cutter, geometry::generate_stationary_steel(stationary_steel_of(study, size)).solid(), size};
    if (!study.is_fed_by_cutting()) return scene;
    const geometry::Bank bank = bank_of(study, head);
    const double patch = k_patch_per_ring_radius * size.ring_radius;
    scene.cut_face = bank.cut_face(patch);
    for (int i = 1; i <= k_layers; ++i) {
        const double thickness = study.bank->cut_height * i / k_layers;
        scene.layers.emplace_back(thickness, bank.layer_section(thickness));
    }
    if (study.bank->spill_layer > 0.0) scene.spill_layer = bank.layer_face(study.bank->spill_layer, patch);
    return scene;
}

std::vector<std::string> feed_lines(const std::vector<PlacedFeed>& feeds) {
    std::vector<std::string> lines;
    for (const PlacedFeed& feed : feeds) {
        lines.push_back(feed.request.kind == FeedKind::cut_face
                            ? fmt::format("{} rocks from {:.4g} to {:.4g} s{}", feed.rocks.size(), feed.request.start, feed.request.end,
                                          feed.is_spill_layer ? ", left by the swing before" : "")
                            : fmt::format("{} rocks requested, {} placed", feed.requested, feed.rocks.size()));
        for (const std::string& reason : feed.reasons) lines.push_back("warning: " + reason);
    }
    return lines;
}

std::vector<PlacedFeed> place_feeds(const Study& study, const FeedScene& scene) {
    const geometry::SolidSearch stationary(scene.stationary);
    std::vector<PlacedFeed> feeds;
    Mistakes mistakes;
    for (std::size_t i = 0; i < study.feeds.size(); ++i) {
        const FeedRequest& request = study.feeds[i];
        Mistakes of_feed(fmt::format("feed {}", i + 1));
        of_feed.gather([&] {
            if (request.kind == FeedKind::batch)
                feeds.push_back(place_batch(request, study, scene, stationary));
            else
                for (PlacedFeed& feed : place_swing(request, study, scene)) feeds.push_back(std::move(feed));
        });
        mistakes.add(of_feed.take());
    }
    mistakes.refuse();
    return feeds;
}

std::string rock_feed_csv(const std::vector<PlacedFeed>& feeds) {
    // Batches, which start with the water, and a cut face are not in one study.
    const bool of_cut_face = !feeds.empty() && feeds.front().request.kind == FeedKind::cut_face;
    const bool shaped = has_shapes(feeds);
    std::string text = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3";
    text += fmt::format("{}{}\n", of_cut_face ? ",vx_m_s,vy_m_s,vz_m_s,place" : "", shaped ? ",shape" : "");
    std::size_t id = 0;
    for (const PlacedFeed& feed : feeds)
        for (const PlacedRock& rock : feed.rocks) {
            ++id;
            const FeedClass& rock_class = feed.request.classes[rock.rock_class];
            for (std::size_t i = 0; i < rock.places.size(); ++i) {
                const auto& [position, velocity] = rock.places[i];
                text += fmt::format("{},{},{},{},{},{},{}", id, rock.time, position.x(), position.y(), position.z(), rock_class.diameter,
                                    rock_class.density);
                if (of_cut_face) text += fmt::format(",{},{},{},{}", velocity->x(), velocity->y(), velocity->z(), i);
                if (shaped) text += "," + (rock_class.shape ? rock_class.shape->name : std::string());
                text += "\n";
            }
        }
    return text;
}

std::string feed_json(const std::vector<PlacedFeed>& feeds, const Study& study) {
    nlohmann::json list = nlohmann::json::array();
    for (const PlacedFeed& feed : feeds) {
        nlohmann::json classes = nlohmann::json::array();
        for (std::size_t i = 0; i < feed.request.classes.size(); ++i) {
            const FeedClass& rock = feed.request.classes[i];
            const auto count = std::count_if(feed.rocks.begin(), feed.rocks.end(), [i](const PlacedRock& r) { return r.rock_class == i; });
            classes.push_back({{"diameter_m", rock.diameter},
                               {"density_kg_m3", rock.density},
                               {"count", count},
                               {"settling_velocity_m_s", settling_speed(study, rock)}});
            if (rock.shape) classes.back()["shape"] = rock.shape->file.filename().string();
        }
        nlohmann::json layers = nlohmann::json::array();
        for (const auto& [thickness, section] : feed.layers) layers.push_back({{"thickness_m", thickness}, {"section_m2", section}});
        list.push_back({{"requested", feed.requested},
                        {"placed", feed.rocks.size()},
                        {"rejected", feed.requested - feed.rocks.size()},
                        {"reasons", feed.reasons},
                        {"start_s", feed.request.start},
                        {"left_by_swing_before", feed.is_spill_layer},
                        {"layers", layers},
                        {"classes", classes}});
    }
    return nlohmann::json{{"feeds", list}}.dump(2) + "\n";
}

double settling_speed(const Study& study, const FeedClass& rock) {
    physics::SettlingRock settling;
    const double general = study.closures.sphericity;
    const double sphericity = rock.shape ? rock.shape->clump.sphericity.value_or(general) : general;
    settling.rock = {rock.diameter, study.fluid.density, study.fluid.kinematic_viscosity, 1.0, sphericity};
    settling.density = rock.density;
    settling.drag = physics::find_drag_law(study.closures.drag);
    settling.hindrance = physics::find_hindrance_law(study.closures.hindrance);
    return physics::terminal_slip_speed(settling);
}

}  // namespace cutterflow::cases
