#include "validation/harness/scenes/rolling_trials.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/sphere.hpp"

namespace cutterflow::validation {
namespace {

constexpr double k_gravity = 9.81;  // [m/s2]
constexpr double k_moves = 1e-6;    // [m/s]; a sphere at rest is far slower, one that set off 0.01 degrees above the onset far faster
constexpr double k_resolution_deg = 0.02;
constexpr double k_seen_onset_deg = 0.05;  // what a search of that resolution tells apart
constexpr double k_below_onset_deg = 0.3;
const double k_degree = k_pi / 180.0;

Vec3 no_force(std::size_t, const Vec3&) {
    return Vec3::Zero();
}

coupling::Rocks sphere_at(const Vec3& position, double diameter, double density) {
    coupling::Rocks rocks;
    rocks.append({1, position, Vec3::Zero(), Vec3::Zero(), diameter, density});
    return rocks;
}

void require_all(coupling::DemEngine& engine, const coupling::Rocks& rocks) {
    if (engine.insert(rocks).size() != rocks.size()) throw std::runtime_error("the DEM did not take all spheres");
}

std::string text_of(const Plate& plate) {
    return fmt::format("{:g} mm, E = {:g} Pa, {}", 1e3 * plate.diameter, plate.youngs_modulus, plate.law);
}

/// Friction 0.6 and restitution 0.8 of a sphere without fluid and weight.
coupling::DemSettings dry_dem(double youngs_modulus, const coupling::PairSettings& pair, const std::string& law) {
    coupling::DemSettings settings;
    settings.contact.youngs_modulus = youngs_modulus;
    settings.contact.poisson_rock = settings.contact.poisson_steel = 0.45;
    settings.contact.set_every_pair(pair);
    settings.contact.rolling_law = law;
    settings.contact.wet_restitution = false;
    settings.contact.max_speed = 1.0;
    settings.fluid = {0.0, 0.0};
    settings.added_mass = 0.0;
    return settings;
}

}  // namespace

coupling::DemSettings plate_dem(const Plate& plate, double slope_deg, double time) {
    coupling::DemSettings settings = dry_dem(plate.youngs_modulus, {plate.friction, 0.8, plate.rolling}, plate.law);
    const double room = 10.0 * plate.diameter, way = 0.5 * k_gravity * time * time;
    settings.domain.lower = Vec3(-room, -room, 0.0);
    settings.domain.upper = Vec3(room + way, room, room);
    settings.domain.make_wall(coupling::DomainSide::z_min);
    const double slope = slope_deg * k_degree;
    settings.gravity = k_gravity * Vec3(std::sin(slope), 0.0, -std::cos(slope));
    return settings;
}

double settling_time(const Plate& plate) {
    return 25.0 * std::sqrt(plate.diameter / k_gravity);
}

Descent descend(const DemFactory& dem, const Plate& plate, double slope_deg, double time) {
    const auto engine = dem(plate_dem(plate, slope_deg, time));
    require_all(*engine, sphere_at(Vec3(0.0, 0.0, 0.5 * plate.diameter * (1.0 + 1e-7)), plate.diameter, plate.density));
    engine->advance(0.5 * time, no_force);
    const double before = engine->rocks().velocity[0].x();
    engine->advance(0.5 * time, no_force);
    return {engine->rocks().velocity[0].norm(), (engine->rocks().velocity[0].x() - before) / (0.5 * time)};
}

double onset_deg(const DemFactory& dem, const Plate& plate, double rests_at_deg, double moves_at_deg) {
    while (moves_at_deg - rests_at_deg > k_resolution_deg) {
        const double middle = 0.5 * (rests_at_deg + moves_at_deg);
        const bool moves = descend(dem, plate, middle, settling_time(plate)).speed > k_moves;
        (moves ? moves_at_deg : rests_at_deg) = middle;
    }
    return 0.5 * (rests_at_deg + moves_at_deg);
}

double rolling_acceleration(double rolling, double slope_deg) {
    return 5.0 / 7.0 * k_gravity * (std::sin(slope_deg * k_degree) - rolling * std::cos(slope_deg * k_degree));
}

void check_descent(Verification& verification, const DemFactory& dem, const Plate& plate) {
    const double onset = std::atan(plate.rolling) / k_degree, rest = onset - k_below_onset_deg;
    for (const double slope : {15.0, 20.0})
        verification.relative(fmt::format("acceleration down {:g} degrees, {}", slope, text_of(plate)), "m/s2",
                              descend(dem, plate, slope, 0.4 * settling_time(plate)).acceleration,
                              rolling_acceleration(plate.rolling, slope), 0.01,
                              {"Ai2011", "(5/7) g (sin - mu_r cos); a soft sphere's lever is shorter by half the overlap", {}});
    const double speed = descend(dem, plate, rest, settling_time(plate)).speed;
    const std::string name = fmt::format("speed at rest on {:.2f} degrees, {}", rest, text_of(plate));
    const About about{"exact", fmt::format("{:g} degrees below the onset", k_below_onset_deg), {}};
    if (plate.law == "spring")
        verification.at_most(name, "m/s", speed, 1e-9, about);
    else
        verification.report(name, "m/s", speed, 0.0, {"exact", "the law of constant couple has no rest: it creeps", {}});
}

void check_onset(Verification& verification, const DemFactory& dem, const Plate& plate) {
    const bool slides = plate.friction < plate.rolling;
    const std::string name = fmt::format("onset of {}, {}", slides ? "sliding" : "rolling", text_of(plate));
    const double onset = onset_deg(dem, plate, 5.0, 15.0), expected = std::atan(std::min(plate.friction, plate.rolling)) / k_degree;
    verification.absolute(name, "deg", onset, expected, k_below_onset_deg,
                          {"Ai2011", slides ? "atan(mu), friction 0.15" : "atan(mu_r), rolling friction 0.2", {}});
    verification.absolute(name + ", as good as it was", "deg", onset, expected, k_seen_onset_deg,
                          {"exact", fmt::format("bound: what the search sees, which halves down to {:g} degrees", k_resolution_deg), {}});
}

void check_gears(Verification& verification, const DemFactory& dem, const std::string& law) {
    constexpr double diameter = 0.004, density = 828.0, rolling = 0.2, force = 1e-3, start = 400.0, time = 0.02;
    coupling::DemSettings settings = dry_dem(5e6, {0.6, 0.8, rolling}, law);
    settings.domain.lower = Vec3::Constant(-0.02);
    settings.domain.upper = Vec3::Constant(0.02);
    const auto engine = dem(settings);
    coupling::Rocks pair = sphere_at(Vec3(-0.5 * diameter * (1.0 + 1e-7), 0.0, 0.0), diameter, density);
    pair.append(sphere_at(Vec3(0.5 * diameter * (1.0 + 1e-7), 0.0, 0.0), diameter, density), 0);
    pair.id[1] = 2;
    pair.angular_velocity = {Vec3(0.0, start, 0.0), Vec3(0.0, -start, 0.0)};
    require_all(*engine, pair);
    const auto press = [&](std::size_t rock, const Vec3&) { return Vec3(rock == 0 ? force : -force, 0.0, 0.0); };
    engine->advance(time, press);  // the force has settled
    const std::vector<Vec3> middle = engine->rocks().angular_velocity;
    engine->advance(time, press);
    const std::vector<Vec3> after = engine->rocks().angular_velocity;

    const double expected = rolling * force * 0.25 * diameter / sphere_inertia(diameter, sphere_mass(diameter, density));
    for (const std::size_t k : {0, 1})
        verification.relative(fmt::format("spin lost by sphere {} of a pair of gears, {}", k + 1, law), "rad/s2",
                              (middle[k].norm() - after[k].norm()) / time, expected, 0.01,
                              {"Ai2011", "mu_r F R*/I on both: what one loses the other loses", {}});
    verification.at_most(fmt::format("sum of their spins over the first one's, {}", law), "-",
                         (after[0] + after[1]).norm() / after[0].norm(), 1e-9,
                         {"exact", "the couple on one is the opposite of that on the other", {}});
}

}  // namespace cutterflow::validation
