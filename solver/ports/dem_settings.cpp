#include "solver/ports/dem_settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gsl/assert>

#include "geometry/base/mistakes.hpp"

namespace cutterflow::coupling {
namespace {

constexpr const char* k_correct = "Correct the value";

/// By the names of their sections.
std::map<std::string, PairSettings> every_pair(const ContactSettings& contact) {
    std::map<std::string, PairSettings> pairs;
    for (const MaterialPair& pair : k_material_pairs) pairs[pair.name] = contact.*pair.settings;
    for (const auto& [material, pair] : contact.rock_on_others) pairs[k_pair_with_rock + material] = pair;
    return pairs;
}

void check_material(Mistakes& mistakes, const ContactSettings& contact, const std::string& key, const std::string& material) {
    if (contact.pair_on(material) != nullptr) return;
    const std::string pair = k_pair_with_rock + material;
    mistakes.add(fmt::format("{} = {}: rock.contact.pairs.{} is missing", key, material, pair),
                 "Contacts with a wall follow the pair of rock and its material",
                 fmt::format("Add {} {{ friction ...; restitution ...; rollingFriction ...; }} to pairs", pair));
}

void check_press(Mistakes& mistakes, const std::string& key, const WallSettings& wall) {
    if (!wall.press) return;
    mistakes.positive(key + ".press.force", wall.press->force);
    mistakes.positive(key + ".press.speed", wall.press->largest_speed);
    mistakes.require(std::abs(wall.press->direction.norm() - 1.0) < 1e-9, key + ".press.direction: its length",
                     wall.press->direction.norm(), "It must be 1", k_correct);
}

/// Each from a time to a later one, and one after the other.
void check_travels(Mistakes& mistakes, const std::string& key, const std::vector<WallTravel>& travels) {
    double free_from = -std::numeric_limits<double>::infinity();
    for (const WallTravel& travel : travels) {
        mistakes.require(travel.velocity.allFinite() && travel.begin <= travel.end,
                         fmt::format("{}.travel: from {} to {}", key, travel.begin, travel.end),
                         "A wall travels from a time to a later one", k_correct);
        mistakes.require(travel.begin >= free_from,
                         fmt::format("{}.travel: from {} on, and the one before lasts until {}", key, travel.begin, free_from),
                         "A wall has one velocity at a time, and its travels stand in their order", k_correct);
        free_from = std::max(free_from, travel.end);
    }
}

/// The surface of a wall at rest, or of one that travels or presses, may run.
void check_motions(Mistakes& mistakes, const std::string& key, const WallSettings& wall) {
    std::vector<std::string> ways;
    if (wall.rotating) ways.emplace_back("turns with the moving zone");
    if (wall.turn.speed != 0.0) ways.emplace_back("turns by itself");
    if (!wall.travels.empty()) ways.emplace_back("travels");
    if (wall.press) ways.emplace_back("presses");
    mistakes.require(ways.size() <= 1, fmt::format("{} {}", key, fmt::join(ways, " and ")), "A wall moves in one way",
                     "Remove one of them");
    mistakes.require(wall.surface_velocity.norm() == 0.0 || (!wall.rotating && wall.turn.speed == 0.0),
                     key + ".surfaceVelocity of a wall that turns", "A wall whose surface runs does not turn", "Remove one of them");
}

void check_walls(Mistakes& mistakes, const DemSettings& settings) {
    std::set<std::string> names;
    for (const WallSettings& wall : settings.walls) {
        const std::string key = "rock.walls." + wall.name;
        if (!names.insert(wall.name).second)
            mistakes.add(key + " is defined twice", "Forces and contacts are told by the wall's name", "Rename one of them");
        check_material(mistakes, settings.contact, key + ".material", wall.material);
        check_travels(mistakes, key, wall.travels);
        const WallTurn& turn = wall.turn;
        mistakes.require(std::isfinite(turn.speed) && turn.axis.origin.allFinite() && turn.begin <= turn.end,
                         fmt::format("{}.turn: {} rad/s from {} to {}", key, turn.speed, turn.begin, turn.end),
                         "A wall turns from a time to a later one", k_correct);
        mistakes.require(std::abs(turn.axis.direction.norm() - 1.0) < 1e-9, fmt::format("{}.turn.axis", key), "It must be of length 1",
                         k_correct);
        check_press(mistakes, key, wall);
        check_motions(mistakes, key, wall);
    }
    for (const char* side : k_domain_sides)
        mistakes.require(names.count(side) == 0, fmt::format("rock.walls.{} is called as a side of the domain", side),
                         "Forces and contacts are told by the wall's name", "Rename it");
    check_material(mistakes, settings.contact, "rock.domain.material", settings.domain.material);
    for (std::size_t side = 0; side < k_domain_sides.size(); ++side)
        mistakes.require(settings.domain.side_is_wall[side] || !settings.domain.side_is_frictionless[side],
                         fmt::format("rock.domain.frictionless: {} is no wall", k_domain_sides[side]), "An open side touches no rock",
                         "Add it to rock.domain.walls");
}

void check_linear(Mistakes& mistakes, const DemSettings& settings, const std::string& where) {
    const LinearContactSettings& law = settings.linear;
    mistakes.positive("contact.theta", law.theta);
    mistakes.positive("contact.reference_length_m", law.reference_length);
    mistakes.positive("contact gravity", law.gravity);
    mistakes.require(law.damping >= 0.0 && law.damping < std::sqrt(0.5), "contact.damping", law.damping,
                     "It must be at least 0 and below sqrt(1/2): a pair swings", k_correct);
    mistakes.require(law.poisson >= 0.0 && law.poisson <= 0.5, "contact.poisson", law.poisson, "It must be within 0 and 0.5", k_correct);
    mistakes.require(std::isfinite(law.steps_per_period) && law.steps_per_period >= 20.0, "contact steps per period", law.steps_per_period,
                     "It must be at least 20", k_correct);
    for (const auto& [name, given] : every_pair(settings.contact)) {
        mistakes.add(setting_mistakes(given, "contact.pairs." + name, where));
        mistakes.require(given.rolling_friction == 0.0, "rolling friction", given.rolling_friction, "It must be 0: the linear law has none",
                         k_correct);
    }
}

/// What Hertz' law works from.
void check_hertz(Mistakes& mistakes, const ContactSettings& contact, const std::string& where) {
    mistakes.add(setting_mistakes(contact, "rock.contact", where));
    for (const auto& [name, given] : every_pair(contact)) mistakes.add(setting_mistakes(given, "rock.contact.pairs." + name, where));
}

void check_shape(Mistakes& mistakes, const DemSettings& settings) {
    mistakes.not_negative("contact.gap_m", settings.contact_gap);
    if (settings.shape != RockShape::cylinder) return;
    mistakes.positive("cylinder length", settings.cylinder_length);
    mistakes.require(settings.shapes.empty(), fmt::format("{} shapes beside cylinders", settings.shapes.size()),
                     "Rock is cylinders, or spheres and clumps", "Remove the shapes");
    mistakes.require(settings.fluid.density == 0.0, "fluid density", settings.fluid.density,
                     "It must be 0 for cylinders: added mass and buoyancy are a sphere's", k_correct);
}

void check_cylinder(Mistakes& mistakes, const DomainSettings& domain) {
    mistakes.positive("rock.domain.radius", domain.radius);
    mistakes.require(domain.lower.z() < domain.upper.z(),
                     fmt::format("rock.domain.zMin = {}, rock.domain.zMax = {}", domain.lower.z(), domain.upper.z()),
                     "zMin must be below zMax", "Correct them");
    for (const std::size_t side : {0, 1, 2, 3})
        mistakes.require(!domain.side_is_wall[side], fmt::format("rock.domain.walls: {} of a cylinder", k_domain_sides[side]),
                         "A cylinder's plane sides are zMin and zMax", "Give its mantle as an STL in rock.walls");
}

void check_box(Mistakes& mistakes, const DomainSettings& domain) {
    for (Eigen::Index i = 0; i < 3; ++i)
        mistakes.require(
            domain.lower[i] < domain.upper[i],
            fmt::format("rock.domain.lower and rock.domain.upper: {0} from {1} to {2}", "xyz"[i], domain.lower[i], domain.upper[i]),
            "Corner lower must lie below corner upper", "Correct the corners");
}

void check_fluid(Mistakes& mistakes, const DemSettings& settings) {
    mistakes.not_negative("fluid density", settings.fluid.density);
    mistakes.not_negative("closures.addedMass", settings.added_mass);
    if (!settings.contact.wet_restitution) return;
    mistakes.require(
        settings.fluid.density > 0.0 && settings.fluid.kinematic_viscosity > 0.0,
        fmt::format("wet restitution with density {} and viscosity {}", settings.fluid.density, settings.fluid.kinematic_viscosity),
        "It needs a fluid with both > 0", "Set rock.contact.wetRestitution false, or give rho and nu");
}

}  // namespace

Vec3 way_until(const std::vector<WallTravel>& travels, double time) {
    Vec3 way = Vec3::Zero();
    for (const WallTravel& travel : travels) way += travel.way(time);
    return way;
}

Vec3 velocity_at(const std::vector<WallTravel>& travels, double time) {
    Vec3 velocity = Vec3::Zero();
    for (const WallTravel& travel : travels) velocity += travel.velocity_at(time);
    return velocity;
}

const std::array<PairPreset, 2>& pair_presets() {
    static const ContactSettings gravel;
    static const std::array<PairPreset, 2> presets{{{k_gravel_pairs, gravel.rock_rock, gravel.rock_steel, gravel.rock_soil},
                                                    {k_paper_pairs, {0.15, 0.97, 0.0}, {0.15, 0.97, 0.0}, {0.15, 0.97, 0.0}}}};
    return presets;
}

void use_preset(ContactSettings& settings, const std::string& name) {
    const auto& presets = pair_presets();
    const auto found = std::find_if(presets.begin(), presets.end(), [&](const PairPreset& preset) { return preset.name == name; });
    Expects(found != presets.end());
    settings.rock_rock = found->rock_rock;
    settings.rock_steel = found->rock_steel;
    settings.rock_soil = found->rock_soil;
}

const PairSettings* ContactSettings::pair_on(const std::string& material) const {
    for (const MaterialPair& pair : k_material_pairs)
        if (pair.other == material) return &(this->*pair.settings);
    const auto found = rock_on_others.find(material);
    return found == rock_on_others.end() ? nullptr : &found->second;
}

bool contains(const DomainSettings& domain, const Vec3& centre) {
    const auto between = [&](Eigen::Index i) { return centre[i] >= domain.lower[i] && centre[i] <= domain.upper[i]; };
    if (domain.shape == DomainShape::box) return between(0) && between(1) && between(2);
    return between(2) && (centre - domain.axis_point).head<2>().norm() <= domain.radius;
}

std::vector<Mistake> check_settings(const DemSettings& settings, const std::string& where) {
    Mistakes mistakes(where);
    if (settings.law == ContactLaw::linear)
        check_linear(mistakes, settings, where);
    else
        check_hertz(mistakes, settings.contact, where);
    check_walls(mistakes, settings);
    check_shape(mistakes, settings);
    if (settings.domain.shape == DomainShape::cylinder)
        check_cylinder(mistakes, settings.domain);
    else
        check_box(mistakes, settings.domain);
    check_fluid(mistakes, settings);
    return mistakes.take();
}

}  // namespace cutterflow::coupling
