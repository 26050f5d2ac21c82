#include "cases/scenes/cutter/case_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/physics/contact.hpp"

namespace cutterflow::cases {
namespace {

constexpr double k_standard_gravity = 9.81;
constexpr double k_bin_width_per_ring_radius = 0.075;
constexpr double k_outflow_offset_per_ring_radius = 0.0375;
constexpr double k_turn_per_step = k_pi / 180.0;

void fill(double& value, double derived) {
    if (value == 0.0) value = derived;
}

/// Collects broken rules.
class Rules {
public:
    void require(bool kept, const char* name, double value, const char* rule, const char* remedy) {
        if (!kept) mistakes_.push_back({"", fmt::format("{} = {}", name, value), rule, remedy});
    }
    void positive(const char* name, double value) {
        require(std::isfinite(value) && value > 0.0, name, value, "It must be above 0", "Give a positive value");
    }
    void within(const char* name, double value, double low, double high) {
        const bool kept = value >= low && value <= high;
        if (!kept)
            mistakes_.push_back(
                {"", fmt::format("{} = {}", name, value), fmt::format("It must lie between {} and {}", low, high), "Change it"});
    }
    std::vector<Mistake> mistakes_;
};

void check_tank(const CaseInputs& inputs, Rules& rules) {
    const char* remedy = "Enlarge the tank";
    rules.require(inputs.tank.radius > tip_radius(inputs.contour), "tank radius [m]", inputs.tank.radius,
                  "It must be larger than the head's largest radius", remedy);
    rules.require(inputs.tank.z_min < inputs.contour.z_hub(), "tank bottom z [m]", inputs.tank.z_min, "It must lie below the head", remedy);
    rules.require(inputs.tank.z_max > inputs.contour.z_backplate(), "tank top z [m]", inputs.tank.z_max, "It must lie above the backplate",
                  remedy);
}

void check_times(const RunTimes& times, Rules& rules) {
    rules.positive("end time [s]", times.end);
    rules.positive("write interval [s]", times.write_interval);
    rules.positive("checkpoint interval [s]", times.checkpoint_interval);
    rules.positive("number of checkpoints kept", times.checkpoints_kept);
    rules.positive("first time step [s]", times.first_time_step);
    rules.require(times.outflow_from >= 0.0 && times.outflow_from < times.end, "start of the outflow average [s]", times.outflow_from,
                  "It must lie between 0 and the end time", "Start it earlier");
}

void check_rock(const Rock& rock, Rules& rules) {
    rules.positive("Young's modulus [Pa]", rock.youngs_modulus);
    rules.positive("rock density [kg/m3]", rock.density);
    rules.within("Poisson's ratio of rock", rock.poisson_rock, 0.0, 0.5);
    rules.within("Poisson's ratio of steel", rock.poisson_steel, 0.0, 0.5);
    rules.within("friction", rock.friction, 0.0, 10.0);
    rules.within("restitution", rock.restitution, physics::k_smallest_restitution, 1.0);
    rules.within("fraction of the DEM time step", rock.time_step_fraction, 1e-3, 0.3);
    rules.positive("largest speed of rock [m/s]", rock.max_speed);
    rules.positive("kernel gamma", rock.kernel_gamma);
    rules.positive("kernel width in cells", rock.kernel_min_width_in_cells);
    rules.within("largest solid fraction", rock.max_solid_fraction, 0.01, 0.99);
    rules.require(!rock.walls.empty(), "number of DEM walls", 0.0, "Rock needs the steel as a wall",
                  "Name the surfaces of cutter and backplate");
}

}  // namespace

double tip_radius(const geometry::Contour& contour) {
    return *std::max_element(contour.radius().begin(), contour.radius().end());
}

double tip_speed(const CaseInputs& inputs) {
    return std::abs(inputs.rotor.speed) * tip_radius(inputs.contour);
}

double mouth_speed(const CaseInputs& inputs) {
    return inputs.discharge / (k_pi * inputs.mouth.radius * inputs.mouth.radius);
}

Vec3 gravity_of(double inclination) {
    return k_standard_gravity * Vec3(std::cos(inclination), 0.0, -std::sin(inclination));
}

double largest_time_step(double speed) {
    return k_turn_per_step / std::abs(speed);
}

double youngs_modulus_for(const CaseInputs& inputs) {
    const Rock& rock = *inputs.rock;
    const double compliance = 2.0 - rock.poisson_rock * rock.poisson_rock - rock.poisson_steel * rock.poisson_steel;
    return physics::youngs_modulus_for_overlap(rock.density + rock.added_mass * inputs.fluid.density, tip_speed(inputs),
                                               physics::k_largest_overlap_ratio, compliance);
}

void fill_scaled_defaults(CaseInputs& inputs) {
    const double ring_radius = inputs.contour.ring_radius();
    fill(inputs.fates.bin_width, k_bin_width_per_ring_radius * ring_radius);
    fill(inputs.fates.outflow_offset, k_outflow_offset_per_ring_radius * ring_radius);
    fill(inputs.mouth.sucked_up_depth, 2.0 * inputs.mouth.radius);
    if (!inputs.rock) return;
    fill(inputs.rock->max_speed, tip_speed(inputs) + mouth_speed(inputs));
    fill(inputs.rock->youngs_modulus, youngs_modulus_for(inputs));
}

std::vector<Mistake> check_case_inputs(const CaseInputs& inputs) {
    Rules rules;
    rules.require(std::isfinite(inputs.rotor.speed) && inputs.rotor.speed != 0.0, "rotor speed [rad/s]", inputs.rotor.speed,
                  "The rotor must turn", "Give a speed");
    rules.require(std::abs(inputs.rotor.axis.direction.norm() - 1.0) < 1e-9, "length of the rotor axis' direction",
                  inputs.rotor.axis.direction.norm(), "It must be a unit vector", "Normalise it");
    rules.positive("discharge [m3/s]", inputs.discharge);
    rules.positive("kinematic viscosity [m2/s]", inputs.fluid.kinematic_viscosity);
    rules.positive("fluid density [kg/m3]", inputs.fluid.density);
    check_tank(inputs, rules);
    rules.positive("mouth radius [m]", inputs.mouth.radius);
    rules.positive("depth of sucked up [m]", inputs.mouth.sucked_up_depth);
    rules.require(std::abs(inputs.mouth.direction.norm() - 1.0) < 1e-9, "length of the mouth's direction", inputs.mouth.direction.norm(),
                  "It must be a unit vector", "Normalise it");
    rules.positive("largest Courant number", inputs.numerics.max_courant);
    rules.positive("outer correctors", inputs.numerics.outer_correctors);
    rules.positive("pressure correctors", inputs.numerics.pressure_correctors);
    check_times(inputs.times, rules);
    rules.positive("bin width [m]", inputs.fates.bin_width);
    rules.positive("outflow offset [m]", inputs.fates.outflow_offset);
    rules.positive("ranks", inputs.ranks);
    if (inputs.rock) check_rock(*inputs.rock, rules);
    return rules.mistakes_;
}

}  // namespace cutterflow::cases
