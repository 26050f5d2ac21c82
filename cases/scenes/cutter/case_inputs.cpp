#include "cases/scenes/cutter/case_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/mistakes.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/head_names.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::cases {
namespace {

constexpr double k_standard_gravity = 9.81;
constexpr double k_bin_width_per_ring_radius = 0.075;
constexpr double k_outflow_offset_per_ring_radius = 0.0375;
// A twentieth of a passing of one of six blades: the trapezoidal rule in angle errs by 0.8 % of what passes once a blade, and by nothing
// after a whole revolution.
constexpr double k_degrees_between_samples = 3.0;
// Water of a sound flow is about as fast as blade tips and mouth together: in the example heads 0.8 to 0.9 of that, in jets at the mouth.
// A flow that blew up at its far boundary had 4 times as much within half a revolution.
constexpr double k_largest_speed_ratio = 4.0;
constexpr double k_turn_per_step = k_pi / 180.0;

void fill(double& value, double derived) {
    if (value == 0.0) value = derived;
}

void check_tank(const CaseInputs& inputs, Mistakes& rules) {
    const char* remedy = "Enlarge the tank";
    rules.require(inputs.tank.radius > tip_radius(inputs.contour), "tank radius [m]", inputs.tank.radius,
                  "It must be larger than the head's largest radius", remedy);
    rules.require(inputs.tank.z_min < inputs.contour.z_hub(), "tank bottom z [m]", inputs.tank.z_min, "It must lie below the head", remedy);
    rules.require(inputs.tank.z_max > inputs.contour.z_backplate(), "tank top z [m]", inputs.tank.z_max, "It must lie above the backplate",
                  remedy);
}

void check_times(const RunTimes& times, Mistakes& rules) {
    rules.positive("end time [s]", times.end);
    rules.positive("write interval [s]", times.write_interval);
    rules.positive("first time step [s]", times.first_time_step);
}

}  // namespace

CaseInputs::CaseInputs(geometry::Contour head) : contour(std::move(head)) {}

double tip_radius(const geometry::Contour& contour) {
    return *std::max_element(contour.radius().begin(), contour.radius().end());
}

double tip_speed(const CaseInputs& inputs) {
    return std::abs(inputs.rotor.speed) * tip_radius(inputs.contour);
}

double mouth_speed(const CaseInputs& inputs) {
    return inputs.discharge / (k_pi * inputs.fates.mouth.radius * inputs.fates.mouth.radius);
}

Vec3 gravity_of(double inclination) {
    return k_standard_gravity * Vec3(std::cos(inclination), 0.0, -std::sin(inclination));
}

double largest_time_step(double speed) {
    return k_turn_per_step / std::abs(speed);
}

double youngs_modulus_for(const CaseInputs& inputs) {
    const coupling::ContactSettings& contact = inputs.rock->contact;
    const double compliance = 2.0 - contact.poisson_rock * contact.poisson_rock - contact.poisson_steel * contact.poisson_steel;
    return physics::youngs_modulus_for_overlap(inputs.rock->density + inputs.closures.added_mass * inputs.fluid.density, tip_speed(inputs),
                                               physics::k_largest_overlap_ratio, compliance);
}

void fill_scaled_defaults(CaseInputs& inputs) {
    const double ring_radius = inputs.contour.ring_radius();
    fill(inputs.fates.bin_width, k_bin_width_per_ring_radius * ring_radius);
    fill(inputs.outflow.offset, k_outflow_offset_per_ring_radius * ring_radius);
    fill(inputs.fates.mouth.depth, 2.0 * inputs.fates.mouth.radius);
    if (!inputs.rock) return;
    fill(inputs.rock->contact.max_speed, tip_speed(inputs) + mouth_speed(inputs));
    fill(inputs.rock->contact.youngs_modulus, youngs_modulus_for(inputs));
}

std::string sample_file(const VelocitySetInput& set) {
    return fmt::format("{}/{}.csv", names::sample_points, set.name);
}

coupling::CouplingSettings solver_settings(const CaseInputs& inputs) {
    coupling::CouplingSettings settings;
    settings.has_rock = inputs.rock.has_value();
    settings.patches.outlet = names::outlet_patch;
    if (settings.has_rock) settings.rock_feed = names::rock_feed;
    settings.queue = inputs.queue;
    settings.kernel = inputs.kernel;
    settings.closures = inputs.closures;
    settings.fates = inputs.fates;
    settings.fates->contour = names::contour_for_solver;
    settings.fates->ring_radius = inputs.contour.ring_radius();
    settings.fates->z_backplate = inputs.contour.z_backplate();
    settings.stop = inputs.stop;
    settings.record = inputs.record;
    settings.replay = inputs.replay;
    if (!inputs.replay.empty()) return settings;  // nothing of the flow is observed or saved
    const double driving_speed = tip_speed(inputs) + mouth_speed(inputs) + inputs.hauling.norm();
    if (driving_speed > 0.0) settings.largest_speed = k_largest_speed_ratio * driving_speed;
    if (inputs.bank_permeability) settings.soil = coupling::SoilSettings{names::bank_surface, *inputs.bank_permeability, inputs.hauling};
    settings.outflow = inputs.outflow;
    if (!inputs.velocity_sets.empty()) {
        settings.velocity.emplace();
        settings.velocity->start_time = inputs.outflow.start_time;
        settings.velocity->interval = k_degrees_between_samples;
        settings.velocity->blades = inputs.blades;
        for (const VelocitySetInput& set : inputs.velocity_sets)
            settings.velocity->sets.push_back({set.name, sample_file(set), set.phases});
    }
    settings.checkpoint = inputs.checkpoint;
    return settings;
}

coupling::DemSettings dem_settings(const CaseInputs& inputs) {
    coupling::DemSettings dem;
    dem.contact = inputs.rock->contact;
    dem.walls = inputs.rock->walls;
    dem.domain = coupling::cylinder_domain(inputs.tank.radius, inputs.tank.z_min, inputs.tank.z_max);
    dem.domain.make_wall(coupling::DomainSide::z_min);
    dem.domain.make_wall(coupling::DomainSide::z_max);
    dem.fluid = inputs.fluid;
    dem.added_mass = inputs.closures.added_mass;
    dem.gravity = inputs.gravity;
    for (const ShapeFile& shape : inputs.rock->shapes) dem.shapes.push_back({shape.name, shape.clump});
    return dem;
}

std::vector<Mistake> check_case_inputs(const CaseInputs& inputs) {
    Mistakes rules;
    rules.require(std::isfinite(inputs.rotor.speed) && inputs.rotor.speed != 0.0, "rotor speed [rad/s]", inputs.rotor.speed,
                  "The rotor must turn", "Give a speed");
    rules.require(std::abs(inputs.rotor.axis.direction.norm() - 1.0) < 1e-9, "length of the rotor axis' direction",
                  inputs.rotor.axis.direction.norm(), "It must be a unit vector", "Normalise it");
    rules.positive("discharge [m3/s]", inputs.discharge);
    check_tank(inputs, rules);
    rules.positive("largest Courant number", inputs.numerics.max_courant);
    rules.positive("outer correctors", inputs.numerics.outer_correctors);
    rules.positive("pressure correctors", inputs.numerics.pressure_correctors);
    check_times(inputs.times, rules);
    rules.require(inputs.outflow.start_time < inputs.times.end, "start of the outflow average [s]", inputs.outflow.start_time,
                  "It must lie before the end time", "Start it earlier");
    rules.positive("ranks", inputs.ranks);
    rules.add(coupling::check_settings(solver_settings(inputs), inputs.fluid, names::coupling_properties));
    if (!inputs.rock) return rules.take();
    rules.add(coupling::check_settings(dem_settings(inputs), names::coupling_properties));
    rules.require(!inputs.rock->walls.empty(), "number of DEM walls", 0.0, "Rock needs the steel as a wall",
                  "Name the surfaces of cutter and backplate");
    return rules.take();
}

}  // namespace cutterflow::cases
