#include "cases/study/study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cases/study/closure_rules.hpp"
#include "cases/study/feed_keys.hpp"
#include "cases/study/size_law.hpp"
#include "cases/study/study_section.hpp"
#include "cases/study/study_shapes.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/base/statistics/developed_flow.hpp"
#include "geometry/base/statistics/production.hpp"
#include "geometry/head/axial_bins.hpp"
#include "meshing/cutter/mesh_plan.hpp"
#include "solver/physics/catalogue.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::cases {
namespace {

constexpr double k_degree = k_pi / 180.0;
// Bernoulli: where water at rest 35 m below the surface, as deep as cutters dredge, has reached 30 m/s, its pressure is the vapour's.
constexpr double k_largest_mouth_speed = 30.0;  // [m/s]
constexpr double k_most_rocks = 1e6;            // of a study; each is followed on its own
// Farther walls change nothing: at 50 ring radii a source's flow has fallen to 1/2500.
constexpr double k_largest_tank_in_rings = 50.0;
constexpr double k_thinnest_steel_in_rings = 1e-3;  // far below what any mesh resolves; thinner solids are lost to rounding
constexpr double k_most_writes = 1e4;

double period_of(const ParameterValues& values) {
    return 60.0 / values.number("rotor.speed_rpm");
}
double end_time_of(const ParameterValues& values) {
    return values.number("run.max_revolutions") * period_of(values);
}

void fill(ParameterValues& values, const char* key, double derived) {
    if (!values.gives(key)) values.set(key, derived);
}

/// Does what needs values some of which may have been refused, up to the first that is missing.
template <class Act>
void where_known(Act act) {
    try {
        act();
    } catch (const NoValue&) {
    }
}

/// As fill, of what follows from other keys: none where one of them was refused.
template <class Derive>
void fill_from(ParameterValues& values, const char* key, Derive derive) {
    where_known([&] { fill(values, key, derive()); });
}

/// Young's modulus [Pa] with which the densest rock at tip speed overlaps steel of the same modulus by the accepted share of its radius;
/// for slow rotors the softest that is allowed.
double needed_youngs_modulus(const ParameterValues& values, const HeadSize& head) {
    double density = 2650.0;
    for (const ParameterValues& feed : values.tables("feed"))
        for (const ParameterValues& rock : feed.tables("feed.class")) density = std::max(density, rock.number("feed.class.density_kg_m3"));
    if (values.has("soil.grain_density_kg_m3")) density = std::max(density, values.number("soil.grain_density_kg_m3"));
    const double inertia_density = density + values.number("closures.added_mass") * values.number("fluid.density_kg_m3");
    const double rock = values.number("rock.poisson_rock");
    const double steel = values.number("rock.poisson_steel");
    const double speed = rpm_to_rad_s(values.number("rotor.speed_rpm")) * head.tip_radius;
    const double modulus =
        physics::youngs_modulus_for_overlap(inertia_density, speed, physics::k_largest_overlap_ratio, 2.0 - rock * rock - steel * steel);
    return std::max(modulus, *k_contact_section.row("youngsModulus").minimum);
}

/// What the file does not give of the pairs of materials comes from its preset.
void resolve_pairs(ParameterValues& values) {
    if (!values.has(k_preset_key)) return;
    coupling::ContactSettings contact;
    coupling::use_preset(contact, values.text(k_preset_key));
    for (const coupling::MaterialPair& pair : coupling::k_material_pairs)
        for (const coupling::Setting<coupling::PairSettings>& setting : coupling::setting_table<coupling::PairSettings>())
            if (!values.gives(key_of(pair, setting))) values.set(key_of(pair, setting), setting.value_in(contact.*pair.settings));
}

/// \param resolved  with every key of the pairs
coupling::ContactSettings read_contact(const ParameterValues& resolved) {
    coupling::ContactSettings contact = k_contact_section.read(resolved);
    for (const coupling::MaterialPair& pair : coupling::k_material_pairs)
        for (const coupling::Setting<coupling::PairSettings>& setting : coupling::setting_table<coupling::PairSettings>())
            setting.assign(contact.*pair.settings, *resolved.find(key_of(pair, setting)));
    return contact;
}

double derived_outflow_start(const ParameterValues& values) {
    const double flow_only = values.number("run.flow_revolutions") * period_of(values);
    const double end = end_time_of(values);
    return flow_only < end ? flow_only : 0.5 * end;
}

/// Keys that say something of a bank or its soil.
constexpr std::array<const char*, 12> k_bank_keys = {
    "swing.speed_m_min",  "bank.cut_height_m",          "bank.step_m",       "bank.clearance_m",
    "bank.pick_length_m", "soil.grain_density_kg_m3",   "soil.porosity",     "bank.file",
    "soil.bulking",       "soil.specific_energy_mj_m3", "bed.spill_layer_m", "bank.permeability_m2"};
constexpr double k_wider_by_picks = 0.03;  // of the ring radius: a head that is wider than its ring by this has picks

void resolve_bank(ParameterValues& values, const HeadSize& head) {
    const double ring = head.ring_radius;
    const bool has_picks = head.tip_radius >= (1.0 + k_wider_by_picks) * ring;
    fill(values, "bank.cut_height_m", 0.8 * ring);
    fill(values, "bank.step_m", 0.4 * ring);
    fill(values, "bank.clearance_m", 0.02 * ring);
    fill(values, "bank.pick_length_m", has_picks ? 0.0 : 0.1 * ring);
    fill(values, "soil.grain_density_kg_m3", 2650.0);
    fill(values, "soil.porosity", 0.15);
    fill(values, "soil.bulking", 1.5);
    fill(values, "bed.spill_layer_m", 0.0);
    fill(values, "bank.permeability_m2", 0.0);
}

Study::Bank make_bank(const ParameterValues& resolved, const std::filesystem::path& folder) {
    const auto number = [&](const char* key) { return resolved.number(key); };
    std::optional<std::filesystem::path> file;
    if (resolved.has("bank.file")) file = std::filesystem::absolute(folder / resolved.text("bank.file"));
    return {number("swing.speed_m_min") / 60.0,
            number("bank.cut_height_m"),
            number("bank.step_m"),
            number("bank.clearance_m"),
            number("bank.pick_length_m"),
            number("soil.grain_density_kg_m3"),
            number("soil.porosity"),
            file,
            resolved.boolean("hauling.water"),
            number("soil.bulking"),
            number("bed.spill_layer_m"),
            number("bank.permeability_m2")};
}

bool is_cut_face(const ParameterValues& feed) {
    return feed.text("feed.kind") == k_cut_face;
}

bool has_size_law(const ParameterValues& feed) {
    return feed.text("feed.size_law") != k_classes;
}

/// Keys that the law of a feed needs.
std::vector<const char*> keys_of_law(const ParameterValues& feed) {
    const bool rosin = feed.text("feed.size_law") == k_rosin_rammler;
    return {rosin ? "feed.size_d63_m" : "feed.size_d50_m", "feed.size_spread", "feed.size_min_m", "feed.size_max_m"};
}

bool is_law_complete(const ParameterValues& feed) {
    const std::vector<const char*> keys = keys_of_law(feed);
    return std::all_of(keys.begin(), keys.end(), [&](const char* key) { return feed.has(key); });
}

/// \pre is_law_complete
SizeDistribution sizes_of(const ParameterValues& feed) {
    const bool rosin = feed.text("feed.size_law") == k_rosin_rammler;
    return {rosin ? SizeLaw::rosin_rammler : SizeLaw::log_normal, feed.number(keys_of_law(feed).front()), feed.number("feed.size_spread"),
            feed.number("feed.size_min_m"), feed.number("feed.size_max_m")};
}

/// Of a feed from a cut face: what a law has below its smallest rock is fines, and rock is as dense as the soil's grains.
void resolve_cut(ParameterValues& feed, const ParameterValues& study) {
    if (feed.where("feed.disintegration").empty() && has_size_law(feed) && is_law_complete(feed))
        feed.set("feed.disintegration", 1.0 - sizes_of(feed).mass_below(feed.number("feed.size_min_m")));
    if (!study.has("soil.grain_density_kg_m3") || feed.tables("feed.class").empty()) return;
    for (ParameterValues& rock : feed.tables_for_writing("feed.class"))
        if (rock.where("feed.class.density_kg_m3").empty()) rock.set("feed.class.density_kg_m3", study.number("soil.grain_density_kg_m3"));
}

void resolve_feed(ParameterValues& feed, const ParameterValues& study, const HeadSize& head) {
    fill_from(feed, "feed.start_revolution", [&] { return study.number("run.flow_revolutions"); });
    if (!feed.has("feed.kind")) return;
    if (is_cut_face(feed)) return where_known([&] { resolve_cut(feed, study); });
    fill_from(feed, "feed.azimuth_centre_deg",
              [&] { return bank_azimuth_deg(study.text("swing.direction"), study.text("rotor.direction")); });
    fill(feed, "feed.radius_to_m", head.tip_radius);
    fill(feed, "feed.depth_to_m", head.depth);
}

/// What a feed has of a batch alone.
void take_batch(const ParameterValues& feed, FeedRequest& request) {
    if (feed.has("feed.count")) request.count = feed.integer("feed.count");
    if (feed.has("feed.mass_kg")) request.mass = feed.number("feed.mass_kg");
    request.spacing = feed.number("feed.spacing_diameters");
    request.azimuth_centre = feed.number("feed.azimuth_centre_deg") * k_degree;
    request.azimuth_width = feed.number("feed.azimuth_width_deg") * k_degree;
    request.radius_from = feed.number("feed.radius_from_m");
    request.radius_to = feed.number("feed.radius_to_m");
    request.depth_from = feed.number("feed.depth_from_m");
    request.depth_to = feed.number("feed.depth_to_m");
}

/// What a feed has of rock from a cut face alone. \param end_time  of the run [s] \param grain_density  of the soil [kg/m3]
void take_cut_face(const ParameterValues& feed, double end_time, double grain_density, FeedRequest& request) {
    request.kind = FeedKind::cut_face;
    const double duration = feed.number("feed.duration_s");
    request.end = duration > 0.0 ? request.start + duration : end_time;
    request.velocity_share = feed.number("feed.velocity_share");
    request.disintegration = feed.number("feed.disintegration");
    if (has_size_law(feed) && is_law_complete(feed))  // check_file_rules refuses others
        for (const double diameter : equal_mass_diameters(sizes_of(feed), static_cast<int>(feed.integer("feed.size_classes"))))
            request.classes.push_back({diameter, grain_density, 1.0});
}

/// \param end_time  of the run [s] \param grain_density  of the soil [kg/m3] \param shapes  of the study, by their paths
FeedRequest make_feed(const ParameterValues& feed, double period, double end_time, double grain_density,
                      const std::map<std::string, ShapeFile>& shapes) {
    FeedRequest request;
    request.start = feed.number("feed.start_revolution") * period;
    request.seed = feed.integer("feed.seed");
    for (const ParameterValues& rock : feed.tables("feed.class")) {
        request.classes.push_back(
            {rock.number("feed.class.diameter_m"), rock.number("feed.class.density_kg_m3"), rock.number("feed.class.mass_share")});
        if (rock.has("feed.class.shape")) request.classes.back().shape = shapes.at(rock.text("feed.class.shape"));
    }
    if (is_cut_face(feed))
        take_cut_face(feed, end_time, grain_density, request);
    else
        take_batch(feed, request);
    return request;
}

/// Collects broken rules; each names the key's value and line.
class Rules {
public:
    /// \param file  in front of mistakes that no line of the study is known for
    explicit Rules(const ParameterValues& values, const std::string& file = {}) : values_(values), mistakes_(file) {}

    void require(bool kept, const std::string& key, const std::string& rule, const std::string& remedy) {
        require(kept, values_, key, rule, remedy);
    }
    void require(bool kept, const ParameterValues& table, const std::string& key, const std::string& rule, const std::string& remedy) {
        if (!kept) mistakes_.add({table.where(key), value_text(table, key), rule, remedy});
    }
    void add(const std::string& what, const std::string& rule, const std::string& remedy) { mistakes_.add(what, rule, remedy); }
    void add(const Mistake& mistake) { mistakes_.add(mistake); }
    std::vector<Mistake> take() { return mistakes_.take(); }

private:
    static std::string value_text(const ParameterValues& table, const std::string& key) {
        const ParameterValue& value = *table.find(key);
        const bool is_number = !std::holds_alternative<std::string>(value) && !std::holds_alternative<bool>(value);
        return fmt::format("{} = {}", key, is_number ? fmt::format("{:.6g}", table.number(key)) : toml_text(value));
    }
    const ParameterValues& values_;
    Mistakes mistakes_;
};

/// A bank needs the speed of its swing, and keys of a bank need a bank.
void check_bank_keys(const ParameterValues& study, Rules& rules) {
    if (has_bank(study)) {
        rules.require(!lacks_swing(study), "bank.model", "A bank is cut by a swing: swing.speed_m_min is missing", "Add swing.speed_m_min");
        const auto& feeds = study.tables("feed");
        if (study.has("bed.spill_layer_m"))
            rules.require(study.number("bed.spill_layer_m") == 0.0 || feeds.empty() || std::any_of(feeds.begin(), feeds.end(), is_cut_face),
                          "bed.spill_layer_m", "What the swing before left comes in beside rock from a cut face, and no feed is of one",
                          "Set feed.kind = \"cut_face\", or remove the key");
        return;
    }
    rules.require(!study.boolean("hauling.water"), "hauling.water",
                  fmt::format("A head travels as it swings into a bank, and bank.model = \"{}\"", k_no_bank),
                  fmt::format("Set bank.model = \"{}\" and swing.speed_m_min, or remove the key", k_wall_bank));
    for (const char* key : k_bank_keys)
        if (study.has(key))
            rules.require(false, key, fmt::format("It belongs to a bank, and bank.model = \"{}\"", k_no_bank),
                          fmt::format("Set bank.model = \"{}\", or remove the key", k_wall_bank));
}

/// Sizes by a law, or by classes.
void check_sizes(const ParameterValues& feed, int index, Rules& rules) {
    const bool has_classes = feed.gives("feed.class");
    if (!has_size_law(feed)) {
        if (!has_classes)
            rules.add(fmt::format("feed {} has no class of rock", index), "Its sizes are [[feed.class]] tables or a feed.size_law",
                      "Add [[feed.class]] with diameter_m below this [[feed]], or a law");
        for (const ParameterValues& rock : feed.tables("feed.class"))
            if (feed.has("feed.size_min_m"))
                rules.require(rock.number("feed.class.diameter_m") >= feed.number("feed.size_min_m"), rock, "feed.class.diameter_m",
                              fmt::format("Rock is not finer than feed.size_min_m = {:g} m; what is finer counts as fines",
                                          feed.number("feed.size_min_m")),
                              "Remove the class, and lower feed.disintegration by its share");
        return;
    }
    if (has_classes)
        rules.add(fmt::format("feed {} has a size_law and [[feed.class]]", index), "Its sizes are given once", "Remove one of them");
    for (const char* key : keys_of_law(feed))
        if (!feed.gives(key))
            rules.require(false, feed, "feed.size_law", fmt::format("It needs {}", key), fmt::format("Add {} to this [[feed]]", key));
    if (!is_law_complete(feed)) return;
    const SizeDistribution sizes = sizes_of(feed);
    rules.require(sizes.smallest < sizes.largest, feed, "feed.size_max_m",
                  fmt::format("It must be more than feed.size_min_m = {:g} m", sizes.smallest), "Exchange or correct them");
    if (!(sizes.smallest < sizes.largest)) return;
    const double mass = sizes.mass_below(sizes.largest) - sizes.mass_below(sizes.smallest);
    rules.require(mass >= 0.01, feed, "feed.size_law",
                  fmt::format("Only {:.2g} of its mass lies between feed.size_min_m and feed.size_max_m; a hundredth is needed", mass),
                  "Correct the law or its bounds; diameters are in m");
}

/// Rock from a cut face: its quantity follows from the bank.
void check_cut(const ParameterValues& study, const ParameterValues& feed, Rules& rules) {
    for (const char* key : {"feed.count", "feed.mass_kg"})
        if (feed.has(key))
            rules.require(false, feed, key, "The quantity of rock from a cut face follows from swing, bank and soil", "Remove it");
    rules.require(has_bank(study), feed, "feed.kind", "Rock comes from a cut face only where the head cuts a bank",
                  "Set bank.model = \"wall\", or feed.kind = \"batch\"");
    if (study.has("swing.speed_m_min"))
        rules.require(!has_bank(study) || study.number("swing.speed_m_min") > 0.0, "swing.speed_m_min",
                      "A head that does not swing cuts nothing", "Give the speed of the swing, or set feed.kind = \"batch\"");
}

/// When rock comes from a cut face.
void check_duration(const ParameterValues& study, const ParameterValues& feed, Rules& rules) {
    const double start = feed.gives("feed.start_revolution") ? feed.number("feed.start_revolution") : study.number("run.flow_revolutions");
    const double end = start * period_of(study) + feed.number("feed.duration_s");
    if (feed.number("feed.duration_s") > 0.0)
        rules.require(end <= end_time_of(study) * (1.0 + 1e-9), feed, "feed.duration_s",
                      fmt::format("The feed would end at {:.4g} s, after the run's end at {:.4g} s", end, end_time_of(study)),
                      "Shorten it, raise run.max_revolutions, or use 0 for the whole run");
    else if (feed.has("feed.start_revolution"))
        rules.require(end < end_time_of(study), feed, "feed.start_revolution",
                      fmt::format("The feed would begin at {:.4g} s, not before the run's end at {:.4g} s", end, end_time_of(study)),
                      "Let it begin earlier, or raise run.max_revolutions");
}

void check_cut_face(const ParameterValues& study, const ParameterValues& feed, int index, Rules& rules) {
    where_known([&] { check_cut(study, feed, rules); });
    where_known([&] { check_sizes(feed, index, rules); });
    where_known([&] { check_duration(study, feed, rules); });
    if (study.tables("feed").size() > 1)
        rules.add(fmt::format("feed {} is a cut face among {} feeds", index, study.tables("feed").size()),
                  "A study has batches or one cut face: rates and batches are not told apart in the results", "Remove the other feeds");
}

void check_batch(const ParameterValues& feed, int index, Rules& rules) {
    const bool has_count = feed.gives("feed.count");
    if (has_count == feed.gives("feed.mass_kg"))
        rules.add(fmt::format("feed {} has {}", index, has_count ? "both count and mass_kg" : "neither count nor mass_kg"),
                  "A feed's quantity is given once", has_count ? "Remove one of them" : "Add count = <number of rocks> to this [[feed]]");
    if (!feed.gives("feed.class"))
        rules.add(fmt::format("feed {} has no class of rock", index), "A feed needs one or more [[feed.class]] with diameter_m",
                  "Add [[feed.class]] with diameter_m below this [[feed]]");
    rules.require(!has_size_law(feed), feed, "feed.size_law", "A batch has its sizes in [[feed.class]]; laws are for rock from a cut face",
                  "Remove it, or set feed.kind = \"cut_face\"");
    rules.require(feed.number("feed.duration_s") == 0.0, feed, "feed.duration_s", "A batch is released at once (duration 0)",
                  "Use 0, several [[feed]] tables with different start_revolution, or feed.kind = \"cut_face\"");
}

void check_kind(const ParameterValues& study, const ParameterValues& feed, int index, Rules& rules) {
    if (is_cut_face(feed))
        check_cut_face(study, feed, index, rules);
    else
        check_batch(feed, index, rules);
}

/// What can be said of the feeds without the cutter.
void check_feed_quantities(const ParameterValues& study, Rules& rules) {
    int index = 0;
    for (const ParameterValues& feed : study.tables("feed")) {
        ++index;
        where_known([&] { check_kind(study, feed, index, rules); });
        where_known([&] {
            for (const auto& [key, mistake] : keys_in_vain(feed, study_table())) rules.add(mistake);
        });
        for (const ParameterValues& rock : feed.tables("feed.class"))
            where_known([&] {
                rules.require(rock.number("feed.class.density_kg_m3") > study.number("fluid.density_kg_m3"), rock,
                              "feed.class.density_kg_m3",
                              fmt::format("Rock must be denser than the fluid ({} kg/m3)", study.number("fluid.density_kg_m3")),
                              "Correct the density");
            });
        if (feed.has("feed.start_revolution"))
            where_known([&] {
                rules.require(feed.number("feed.start_revolution") < study.number("run.max_revolutions"), feed, "feed.start_revolution",
                              fmt::format("Rock must be released before run.max_revolutions = {}", study.number("run.max_revolutions")),
                              "Release it earlier or run longer");
            });
    }
}

void check_suction(const ParameterValues& study, const HeadSize& head, Rules& rules) {
    const double offset = study.number("suction.mouth_offset_m");
    const double radius = study.number("suction.mouth_radius_m");
    const double wall = study.number("suction.pipe_wall_m");
    const double plate = study.number("suction.backplate_radius_m");
    // The key that the file gives is the one to change.
    const char* key = study.where("suction.mouth_radius_m").empty() ? "suction.mouth_offset_m" : "suction.mouth_radius_m";
    rules.require(
        offset + radius <= head.ring_radius, key,
        fmt::format("The mouth must lie inside the ring: mouth_offset_m + mouth_radius_m = {:.4g} may be at most the ring radius {:.4g} m",
                    offset + radius, head.ring_radius),
        "Make the mouth smaller or move it towards the axis");
    for (const char* part : {"suction.backplate_thickness_m", "suction.pipe_wall_m"})
        rules.require(study.number(part) >= k_thinnest_steel_in_rings * head.ring_radius, part,
                      fmt::format("Steel must be at least {:g} ring radius, {:.3g} m, thick", k_thinnest_steel_in_rings,
                                  k_thinnest_steel_in_rings * head.ring_radius),
                      "Correct the value; its unit is m");
    rules.require(
        offset + radius + wall <= plate, "suction.backplate_radius_m",
        fmt::format("The backplate must carry the pipe: mouth_offset_m + mouth_radius_m + pipe_wall_m = {:.4g} may be at most its radius",
                    offset + radius + wall),
        "Enlarge the backplate or make the pipe smaller");
}

/// Rocks of a feed; of a mass, whole ones of each class.
double number_of_rocks(const ParameterValues& feed) {
    if (feed.has("feed.count")) return static_cast<double>(feed.integer("feed.count"));
    double number = 0.0, shares = 0.0;
    for (const ParameterValues& rock : feed.tables("feed.class")) shares += rock.number("feed.class.mass_share");
    for (const ParameterValues& rock : feed.tables("feed.class")) {
        const double mass = sphere_mass(rock.number("feed.class.diameter_m"), rock.number("feed.class.density_kg_m3"));
        number += std::round(feed.number("feed.mass_kg") * rock.number("feed.class.mass_share") / shares / mass);
    }
    return number;
}

/// A feed that is told in full: others are refused by check_feed_quantities.
bool has_quantity(const ParameterValues& feed) {
    return feed.has("feed.count") != feed.has("feed.mass_kg") && !feed.tables("feed.class").empty();
}

void check_rocks(const ParameterValues& feed, const HeadSize& head, Rules& rules) {
    const auto require_smaller_than_head = [&](const ParameterValues& table, const char* key) {
        if (table.has(key))
            rules.require(table.number(key) < 2.0 * head.tip_radius, table, key,
                          fmt::format("Rock must be smaller than the head, whose diameter is {:.4g} m", 2.0 * head.tip_radius),
                          "Correct the diameter; its unit is m");
    };
    for (const ParameterValues& rock : feed.tables("feed.class")) require_smaller_than_head(rock, "feed.class.diameter_m");
    require_smaller_than_head(feed, "feed.size_max_m");
    if (!has_quantity(feed)) return;
    const double number = number_of_rocks(feed);
    if (feed.has("feed.mass_kg"))
        rules.require(number >= 1.0, feed, "feed.mass_kg", "It is less than half a rock of each class: nothing would be released",
                      "Release more, or give count");
    rules.require(number <= k_most_rocks, feed, feed.has("feed.count") ? "feed.count" : "feed.mass_kg",
                  fmt::format("It makes {:.3g} rocks; a feed has at most {:.3g}, as each is followed on its own", number, k_most_rocks),
                  "Release less, or larger rock");
}

void check_discharge(const ParameterValues& study, Rules& rules) {
    const double radius = study.number("suction.mouth_radius_m");
    const double speed = study.number("suction.discharge_m3_s") / (k_pi * radius * radius);
    rules.require(
        speed <= k_largest_mouth_speed, "suction.discharge_m3_s",
        fmt::format("Through a mouth of radius {:.4g} m it flows at {:.4g} m/s; above {:g} m/s water turns to vapour, which is not "
                    "modelled",
                    radius, speed, k_largest_mouth_speed),
        "Correct the discharge, or widen suction.mouth_radius_m");
}

void check_tank(const ParameterValues& study, const HeadSize& head, Rules& rules) {
    const double steel = study.number("suction.gap_m") + study.number("suction.backplate_thickness_m");
    const double least_height = study.number("tank.bed_clearance_m") + head.depth + steel;
    rules.require(study.number("tank.height_m") > least_height, "tank.height_m",
                  fmt::format("Bed clearance, head, gap and backplate take {:.4g} m of it", least_height), "Make the tank higher");
    rules.require(head.depth + study.number("tank.bed_clearance_m") > head.depth, "tank.bed_clearance_m", "The bed must lie below the head",
                  "Raise the clearance");
    for (const char* key : {"tank.radius_m", "tank.height_m"})
        rules.require(study.number(key) <= k_largest_tank_in_rings * head.ring_radius, key,
                      fmt::format("It may be at most {:g} ring radii, {:.4g} m: farther walls change nothing and cost cells",
                                  k_largest_tank_in_rings, k_largest_tank_in_rings * head.ring_radius),
                      "Make the tank smaller, or check cutter.unit");
    const double plate = study.number("suction.backplate_radius_m");
    const double widest = std::max(head.tip_radius, plate);
    rules.require(study.number("tank.radius_m") >= 1.5 * widest, "tank.radius_m",
                  fmt::format("It must be at least 1.5 times the radius of head ({:.4g} m) and backplate ({:.4g} m), {:.4g} m",
                              head.tip_radius, plate, 1.5 * widest),
                  "Widen the tank, or check cutter.unit");
}

void check_feed_region(const ParameterValues& feed, const HeadSize& head, Rules& rules) {
    if (is_cut_face(feed)) return;
    const double from = feed.number("feed.depth_from_m");
    const double to = feed.number("feed.depth_to_m");
    rules.require(feed.number("feed.radius_to_m") > feed.number("feed.radius_from_m"), feed, "feed.radius_to_m",
                  fmt::format("It must be more than radius_from_m = {}", feed.number("feed.radius_from_m")), "Exchange or correct them");
    rules.require(to > from, feed, "feed.depth_to_m", fmt::format("It must be more than depth_from_m = {}", from),
                  "Exchange or correct them");
    rules.require(to <= head.depth, feed, "feed.depth_to_m", fmt::format("The head ends {:.4g} m below the ring plane", head.depth),
                  "Keep the wedge inside the head");
}

void check_report(const ParameterValues& study, const HeadSize& head, Rules& rules) {
    const double bins = head.depth / study.number("report.bin_width_m");
    rules.require(bins <= geometry::k_most_axial_bins, "report.bin_width_m",
                  fmt::format("It divides the head, {:.4g} m deep, into {:.3g} bins; at most {:g} are counted", head.depth, bins,
                              geometry::k_most_axial_bins),
                  "Widen the bins");
    const double outflow = head.tip_radius + study.number("report.outflow_offset_m");
    rules.require(outflow < study.number("tank.radius_m"), "report.outflow_offset_m",
                  fmt::format("Outflow is sampled up to {:.4g} m from the axis; the water ends at tank.radius_m = {:.4g} m", outflow,
                              study.number("tank.radius_m")),
                  "Sample nearer to the head");
    rules.require(study.number("report.outflow_start_s") < end_time_of(study), "report.outflow_start_s",
                  fmt::format("The run ends at {:.4g} s", end_time_of(study)), "Start the average earlier");
}

void check_intervals(const ParameterValues& study, Rules& rules) {
    for (const char* key : {"run.checkpoint_interval_s", "run.write_interval_s"}) {
        const double times = end_time_of(study) / study.number(key);
        rules.require(times <= k_most_writes, key,
                      fmt::format("The run, {:.4g} s long, would write {:.3g} times; at most {:g} are written", end_time_of(study), times,
                                  k_most_writes),
                      "Write less often");
    }
}

/// Recorded phases are those of whole turns, before rock changes the flow.
void check_recording(const ParameterValues& study, Rules& rules) {
    const double recorded = study.number("run.record_revolutions");
    if (recorded == 0.0) return;
    const char* key = "run.record_revolutions";
    rules.require(recorded >= 1.0, key, "The rotor passes all its phases in one revolution", "Use 1 or more, or 0 for no recording");
    rules.require(!study.tables("feed").empty(), key, "A recording ends where rock comes in",
                  "Add a feed, of a few rocks near the run's end for the flow alone, or use 0");
    for (const ParameterValues& feed : study.tables("feed"))
        rules.require(
            recorded <= feed.number("feed.start_revolution"), key,
            fmt::format("It is at most the flow before the rock, feed.start_revolution = {:g}", feed.number("feed.start_revolution")),
            "Raise run.flow_revolutions");
}

}  // namespace

double Study::period() const {
    return 2.0 * k_pi / std::abs(rotation_speed);
}
double Study::end_time() const {
    return run.max_revolutions * period();
}
double Study::first_release() const {
    return std::min_element(feeds.begin(), feeds.end(), [](const FeedRequest& a, const FeedRequest& b) { return a.start < b.start; })
        ->start;
}
double Study::development_end() const {
    double needed = report.outflow_start;
    if (!feeds.empty()) needed = std::min(needed, first_release() - run.record_revolutions * period());
    return std::max(0.0, needed - period());
}
double Study::bank_side() const {
    return (swing_direction == "under_cut") == (rotation_speed > 0.0) ? 1.0 : -1.0;
}
bool Study::is_fed_by_cutting() const {
    return std::any_of(feeds.begin(), feeds.end(), [](const FeedRequest& feed) { return feed.kind == FeedKind::cut_face; });
}
std::vector<ShapeFile> Study::shapes() const {
    std::map<std::string, ShapeFile> shapes;
    for (const FeedRequest& feed : feeds)
        for (const FeedClass& rock : feed.classes)
            if (rock.shape) shapes.emplace(rock.shape->name, *rock.shape);
    std::vector<ShapeFile> all;
    for (const auto& named : shapes) all.push_back(named.second);
    return all;
}
AxialCylinder Study::water(const HeadSize& head) const {
    const double bottom = -head.depth - tank.bed_clearance;
    return {tank.radius, bottom, bottom + tank.height};
}

bool has_bank(const ParameterValues& values) {
    return values.text("bank.model") == k_wall_bank;
}

bool lacks_swing(const ParameterValues& values) {
    return has_bank(values) && !values.gives("swing.speed_m_min");
}

double bank_azimuth_deg(const std::string& swing_direction, const std::string& rotor_direction) {
    const double rising = rotor_direction == "right_handed" ? 90.0 : -90.0;
    return swing_direction == "under_cut" ? rising : -rising;
}

double release_share(int index) {
    constexpr double golden_ratio = 0.6180339887498949;
    return index * golden_ratio - std::floor(index * golden_ratio);
}

double start_revolution(const ParameterValues& study, const ParameterValues& feed) {
    return feed.has("feed.start_revolution") ? feed.number("feed.start_revolution") : study.number("run.flow_revolutions");
}

void vary_release(ParameterValues& values, std::int64_t seeds, double revolutions) {
    for (ParameterValues& feed : values.tables_for_writing("feed")) {
        const double start = start_revolution(values, feed);
        feed.set("feed.seed", feed.integer("feed.seed") + seeds);
        if (revolutions > 0.0) feed.set("feed.start_revolution", start + revolutions);
    }
}

std::vector<Mistake> check_file_rules(const ParameterValues& study, const std::filesystem::path& file) {
    Rules rules(study, file.string());
    where_known([&] { check_bank_keys(study, rules); });
    check_feed_quantities(study, rules);
    if (!study.tables("feed").empty())
        where_known([&] {
            rules.require(study.number("run.flow_revolutions") < study.number("run.max_revolutions"), "run.flow_revolutions",
                          fmt::format("It must be less than run.max_revolutions = {}, or no rock is ever released",
                                      study.number("run.max_revolutions")),
                          "Raise run.max_revolutions");
        });
    return rules.take();
}

ParameterValues read_study(const std::filesystem::path& file) {
    ReadParameters read = parse_with_mistakes(study_table(), read_file(file), file.string());
    Mistakes mistakes;
    mistakes.add(read.mistakes);
    mistakes.add(check_file_rules(read.values, file));
    mistakes.refuse();
    return std::move(read.values);
}

ParameterValues resolve_study(const ParameterValues& values, const HeadSize& head) {
    ParameterValues resolved = values;
    const double ring = head.ring_radius;
    fill(resolved, "suction.mouth_offset_m", 0.55 * ring);
    fill(resolved, "suction.mouth_radius_m", 0.25 * ring);
    fill(resolved, "suction.gap_m", 0.075 * ring);
    fill(resolved, "suction.backplate_radius_m", ring);
    fill(resolved, "suction.backplate_thickness_m", 0.05 * ring);
    fill(resolved, "suction.pipe_wall_m", 0.025 * ring);
    fill(resolved, "tank.radius_m", 6.25 * ring);
    fill(resolved, "tank.bed_clearance_m", 0.975 * ring);
    fill_from(resolved, "tank.height_m", [&] { return resolved.number("tank.bed_clearance_m") + head.depth + 1.0875 * ring; });
    fill_from(resolved, "rock.youngs_modulus_pa", [&] { return needed_youngs_modulus(values, head); });
    resolve_pairs(resolved);
    if (values.has("bank.model") && has_bank(values)) resolve_bank(resolved, head);
    fill_from(resolved, "run.checkpoint_interval_s", [&] { return 0.25 * period_of(values); });
    fill_from(resolved, "run.write_interval_s", [&] { return 0.25 * period_of(values); });
    fill(resolved, "report.bin_width_m", 0.075 * ring);
    fill(resolved, "report.outflow_offset_m", 0.0375 * ring);
    fill_from(resolved, "report.outflow_start_s", [&] { return derived_outflow_start(values); });
    if (values.has("report.adv_points")) {
        fill(resolved, "report.adv_probe_diameter_m", 0.006);
        fill(resolved, "report.adv_probe_length_m", 0.009);
        fill(resolved, "report.adv_position_error_m", 0.025 * ring);
    }
    if (!values.tables("feed").empty())
        for (ParameterValues& feed : resolved.tables_for_writing("feed")) resolve_feed(feed, values, head);
    return resolved;
}

Study make_study(const ParameterValues& resolved, const std::filesystem::path& folder) {
    const auto number = [&](const char* key) { return resolved.number(key); };
    Study study;
    study.name = resolved.text("name");
    study.cutter.file = std::filesystem::absolute(folder / resolved.text("cutter.file"));
    if (resolved.has("cutter.unit")) study.cutter.unit = resolved.text("cutter.unit");
    const double sense = resolved.text("rotor.direction") == "right_handed" ? 1.0 : -1.0;
    study.rotation_speed = sense * rpm_to_rad_s(number("rotor.speed_rpm"));
    study.suction = {number("suction.discharge_m3_s"),
                     number("suction.mouth_azimuth_deg") * k_degree,
                     number("suction.mouth_offset_m"),
                     number("suction.mouth_radius_m"),
                     number("suction.gap_m"),
                     number("suction.backplate_radius_m"),
                     number("suction.backplate_thickness_m"),
                     number("suction.pipe_wall_m")};
    study.inclination = number("ladder.inclination_deg") * k_degree;
    study.swing_direction = resolved.text("swing.direction");
    if (has_bank(resolved)) study.bank = make_bank(resolved, folder);
    study.tank = {number("tank.radius_m"), number("tank.bed_clearance_m"), number("tank.height_m")};
    study.mesh_preset = resolved.text("mesh.preset");
    study.fluid = {number("fluid.density_kg_m3"), number("fluid.kinematic_viscosity_m2_s")};
    study.contact = read_contact(resolved);
    study.closures = k_closure_section.read(resolved);
    study.kernel = k_kernel_section.read(resolved);
    study.length_ratio = number("scale.length_ratio");
    study.run = {number("run.flow_revolutions"),
                 number("run.max_revolutions"),
                 {number("run.stop_undecided"), number("run.target_half_width")},
                 number("run.max_courant"),
                 number("run.checkpoint_interval_s"),
                 number("run.write_interval_s"),
                 number("run.record_revolutions")};
    study.report = {number("report.bin_width_m"), number("report.outflow_offset_m"), number("report.outflow_start_s"), {}, {}};
    if (resolved.has("report.adv_points")) {
        study.report.adv_points = std::filesystem::absolute(folder / resolved.text("report.adv_points"));
        study.report.adv_probe = {number("report.adv_probe_diameter_m"), number("report.adv_probe_length_m"),
                                  number("report.adv_position_error_m")};
    }
    const std::map<std::string, ShapeFile> shapes = read_shapes(resolved, folder);
    for (const ParameterValues& feed : resolved.tables("feed"))
        study.feeds.push_back(make_feed(feed, study.period(), study.end_time(), study.bank ? study.bank->grain_density : 0.0, shapes));
    return study;
}

std::vector<Mistake> check_study(const ParameterValues& resolved, const HeadSize& head) {
    Rules rules(resolved);
    where_known([&] { check_suction(resolved, head, rules); });
    where_known([&] { check_discharge(resolved, rules); });
    where_known([&] { check_tank(resolved, head, rules); });
    for (const ParameterValues& feed : resolved.tables("feed")) {
        where_known([&] { check_feed_region(feed, head, rules); });
        where_known([&] { check_rocks(feed, head, rules); });
    }
    where_known([&] { check_report(resolved, head, rules); });
    where_known([&] { check_intervals(resolved, rules); });
    where_known([&] { check_recording(resolved, rules); });
    where_known([&] {
        for (const Mistake& mistake : closure_mistakes(resolved)) rules.add(mistake);
    });
    where_known([&] {
        rules.require(resolved.text("kernel.map") != coupling::k_cluster_map, "kernel.map",
                      "Clusters of cells do not turn with the rotor, and reach through its blades", "Set kernel.map = \"gaussian\"");
    });
    where_known([&] {
        rules.require(resolved.number("kernel.cluster_size_m") == 0.0, "kernel.cluster_size_m",
                      "Only map cluster has cubes, and a cutter's mesh turns", "Remove it");
    });
    return rules.take();
}

namespace {

/// Whether rock is placed so densely that its drag grows by that of other rock.
bool is_dense(const ParameterValues& feed) {
    const double spacing = feed.number("feed.spacing_diameters");
    return is_cut_face(feed) || k_pi / 6.0 > k_dilute_solids * spacing * spacing * spacing;
}

void warn_of_wide_kernels(const ParameterValues& resolved, const HeadSize& head, Rules& rules) {
    double largest = 0.0;
    for (const ParameterValues& feed : resolved.tables("feed")) {
        if (has_size_law(feed)) largest = std::max(largest, feed.number("feed.size_max_m"));
        for (const ParameterValues& rock : feed.tables("feed.class")) largest = std::max(largest, rock.number("feed.class.diameter_m"));
    }
    if (largest == 0.0) return;
    const coupling::KernelSettings kernel = k_kernel_section.read(resolved);
    const double cell = k_cell_at_rock * meshing::mesh_preset(resolved.text("mesh.preset")).cell_size * head.ring_radius;
    for (const char* key : {"suction.mouth_radius_m", "suction.gap_m"})
        if (const auto warning = wide_kernel_warning({resolved.where(key), key, resolved.number(key), cell}, kernel, largest))
            rules.add(*warning);
}

/// A flow that remembers its start is another one than the head's at work.
void warn_of_young_flow(const ParameterValues& resolved, Rules& rules) {
    const std::vector<ParameterValues>& feeds = resolved.tables("feed");
    const auto start = [](const ParameterValues& feed) { return feed.number("feed.start_revolution"); };
    const auto first = std::min_element(feeds.begin(), feeds.end(),
                                        [&](const ParameterValues& a, const ParameterValues& b) { return start(a) < start(b); });
    if (first == feeds.end()) return;
    rules.require(start(*first) >= k_developed_revolutions, *first, "feed.start_revolution",
                  fmt::format("For some {:g} revolutions the flow remembers the frozen rotor from which it starts: beside a bank a head "
                              "delivered 7 % of its rock in the second revolution's flow and 2 % in the sixth's",
                              k_developed_revolutions),
                  fmt::format("Set run.flow_revolutions = {:g} or more", k_developed_revolutions));
}

/// Of rock from a cut face: that it sinks, and that enough of it comes for an interval.
void warn_of_cut_rock(const ParameterValues& resolved, const ParameterValues& feed, Rules& rules) {
    if (has_size_law(feed))
        rules.require(
            resolved.number("soil.grain_density_kg_m3") > resolved.number("fluid.density_kg_m3"), "soil.grain_density_kg_m3",
            fmt::format("Rock by a size_law has this density, and floats in a fluid of {} kg/m3", resolved.number("fluid.density_kg_m3")),
            "Correct the density");
    const double needed = shortest_fed_time(period_of(resolved));
    const double rest = end_time_of(resolved) - feed.number("feed.start_revolution") * period_of(resolved);
    const double duration = feed.number("feed.duration_s"), fed = duration > 0.0 ? std::min(duration, rest) : rest;
    rules.require(
        fed >= needed, "run.max_revolutions",
        fmt::format("Rock comes for {:.4g} s; spillage has an interval after {:.4g} s at the earliest, with the start-up", fed, needed),
        "Raise it, or take the interval from repeats or replays");
}

/// Of rock that may block the way through the head.
void warn_of_large_rock(const ParameterValues& resolved, const Study& study, const HeadSize& head, Rules& rules) {
    const double mouth = 2.0 * resolved.number("suction.mouth_radius_m");
    const double passage = head.passage ? std::min(mouth, *head.passage) : mouth;
    const char* place = passage < mouth ? "between the blades" : "the suction mouth";
    const std::string rule = fmt::format("Rock larger than a third of the smallest passage ({:.4g} m, {}) may block it", passage, place);
    for (std::size_t f = 0; f < study.feeds.size(); ++f) {
        const ParameterValues& feed = resolved.tables("feed")[f];
        if (has_size_law(feed))
            rules.require(feed.number("feed.size_max_m") <= passage / 3.0, feed, "feed.size_max_m", rule, "Check the diameter");
        for (std::size_t c = 0; c < feed.tables("feed.class").size(); ++c) {
            const FeedClass& rock = study.feeds[f].classes[c];
            const std::string reach = rock.shape ? fmt::format("; with its shape this rock is {:.4g} m long", rock.extent()) : "";
            rules.require(rock.extent() <= passage / 3.0, feed.tables("feed.class")[c], "feed.class.diameter_m", rule + reach,
                          "Check the diameter");
        }
    }
}

}  // namespace

std::vector<Mistake> study_warnings(const ParameterValues& resolved, const Study& study, const HeadSize& head) {
    Rules rules(resolved);
    const auto& feeds = resolved.tables("feed");
    for (const ParameterValues& feed : feeds)
        if (is_cut_face(feed)) warn_of_cut_rock(resolved, feed, rules);
    for (const Mistake& warning : hindrance_warnings(resolved, std::any_of(feeds.begin(), feeds.end(), is_dense))) rules.add(warning);
    warn_of_wide_kernels(resolved, head, rules);
    warn_of_young_flow(resolved, rules);
    warn_of_large_rock(resolved, study, head, rules);
    const double speed = rpm_to_rad_s(resolved.number("rotor.speed_rpm")) * head.tip_radius;
    // Hertz' largest overlap goes with E^(-2/5).
    const double softness = needed_youngs_modulus(resolved, head) / resolved.number("rock.youngs_modulus_pa");
    if (!resolved.tables("feed").empty())
        rules.require(
            softness <= 1.0 + 1e-9, "rock.youngs_modulus_pa",
            fmt::format("At a tip speed of {:.3g} m/s rock overlaps steel by {:.0f} % of its radius; {:.0f} % is accepted", speed,
                        100.0 * physics::k_largest_overlap_ratio * std::pow(softness, 0.4), 100.0 * physics::k_largest_overlap_ratio),
            "Raise it, or look at overlap_ratio_max in the report");
    return rules.take();
}

std::string study_template(const std::string& name, const std::string& cutter_file, const std::optional<std::string>& unit) {
    ParameterValues values;
    values.set("name", name);
    values.set("cutter.file", cutter_file);
    if (unit) values.set("cutter.unit", *unit);
    values.set("rotor.speed_rpm", 60.0);
    values.set("suction.discharge_m3_s", 0.12);
    ParameterValues feed;
    feed.set("feed.count", std::int64_t{368});
    ParameterValues rock;
    rock.set("feed.class.diameter_m", 0.02);
    feed.tables_for_writing("feed.class").push_back(rock);
    values.tables_for_writing("feed").push_back(feed);
    return "# A study: one operating point of one cutter. `cutterflow check` validates it and predicts its cost.\n"
           "# Lines without a value show what is derived when they are left so. Without [[feed]] only the flow is solved.\n\n" +
           commented_toml(study_table(), &values);
}

std::string study_manual_page() {
    return "# The study file\n\n"
           "<!-- Made from the table in cases/study/study_table.cpp: build the target update_manual instead of editing this page. -->\n\n"
           "A study is one operating point of one cutter, in TOML. Every key carries its unit in its name; an unknown key, a wrong type or "
           "a\n"
           "value out of bounds is refused with its line. Lengths without a value follow the ring radius. `cutterflow new` writes a "
           "commented\n"
           "study, `cutterflow check` validates one and predicts its cost, `cutterflow params` prints this list.\n\n"
           "Frame: the axis points from hub to ring (suction side), the ring plane is z = 0, azimuth 0 is lowest and positive by the "
           "right\n"
           "hand about the axis. `[[feed]]` may stand several times, each with one or more `[[feed.class]]` below it; without `[[feed]]` "
           "only\n"
           "the flow is solved. The number of ranks is no property of a study: `cutterflow run --ranks`.\n" +
           parameters_markdown(study_table());
}

}  // namespace cutterflow::cases
