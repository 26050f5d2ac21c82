/// Restitution, step and rolling of the linear contact law, through the engine.
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "solver/free_surface/scene_file/scene_file.hpp"
#include "solver/physics/contact.hpp"
#include "validation/harness/scenes/contact_bench.hpp"
#include "validation/harness/scenes/cylinder_column.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
using coupling::RockShape;

constexpr double k_study_steps = 150.0;  // a period: what a study takes
constexpr double k_fine_steps = 2250.0;  // a period: so many that the law remains and the step does not show

struct Trial {
    RockShape shape = RockShape::cylinder;
    bool pair = true, may_pull = false;
    double speed = 0.5, steps = k_study_steps;
};

coupling::DemSettings room(const Trial& trial) {
    CylinderColumn column;
    column.gap = 0.0;
    coupling::DemSettings settings = column_dem(column);
    settings.gravity = Vec3::Zero();
    settings.shape = trial.shape;
    settings.contact.set_every_pair({0.0, 1.0, 0.0});
    settings.linear.may_pull = trial.may_pull;
    settings.linear.steps_per_period = trial.steps;
    return settings;
}

/// The law's own step [s].
double step_of(const coupling::LinearContactSettings& law) {
    return physics::linear_contact_step(law.theta, law.reference_length, law.gravity, law.steps_per_period);
}

/// \throws std::runtime_error  when the DEM divides the law's step: the result would be that of another one
double restitution_of(const Trial& trial) {
    const double radius = 0.5 * k_cylinder_diameter, apart = radius * (1.0 + 1e-4);
    const Vec3 middle(0.1, 0.5 * k_cylinder_length, 0.1);
    std::vector<BenchBall> balls;
    if (trial.pair) {
        balls = {{radius, k_cylinder_density, middle - Vec3(apart, 0, 0), Vec3(0.5 * trial.speed, 0, 0)},
                 {radius, k_cylinder_density, middle + Vec3(apart, 0, 0), Vec3(-0.5 * trial.speed, 0, 0)}};
    } else {
        balls = {{radius, k_cylinder_density, Vec3(0.1, 0.5 * k_cylinder_length, apart), Vec3(0, 0, -trial.speed)}};
    }
    const coupling::DemSettings settings = room(trial);
    const ImpactOutcome impact = collide(settings, balls, step_of(settings.linear));
    if (impact.substeps != 1) throw std::runtime_error(fmt::format("the DEM makes {} steps of the law's one", impact.substeps));
    return (trial.pair ? impact.velocity[1].x() - impact.velocity[0].x() : impact.velocity[0].z()) / trial.speed;
}

/// zeta [-]: a at a wall; of two equal bodies a sqrt(2), because half a mass swings on the spring.
double damping_ratio(double damping, bool pair) {
    return pair ? damping * std::sqrt(2.0) : damping;
}

void check_restitution(Verification& verification, const Trial& trial) {
    const double expected = physics::linear_restitution(damping_ratio(0.4, trial.pair), trial.may_pull);
    verification.absolute(
        fmt::format("restitution of a {} {}, {}, {:g} m/s, {:g} steps a period", trial.shape == RockShape::cylinder ? "cylinder" : "sphere",
                    trial.pair ? "pair" : "at a wall", trial.may_pull ? "that may pull" : "without pull", trial.speed, trial.steps),
        "-", restitution_of(trial), expected, 0.003,
        {"SchwagerPoeschel2007",
         "through the engine, one DEM step a sample. A contact begins within a step; the dashpot counts the time for which it acts",
         {}});
}

void check_law(Verification& verification, double steps) {
    for (const bool pair : {true, false}) {
        for (const bool may_pull : {true, false}) {
            for (const double speed : {0.05, 0.5, 2.0})
                check_restitution(verification, {RockShape::cylinder, pair, may_pull, speed, steps});
        }
        check_restitution(verification, {RockShape::sphere, pair, false, 0.5, steps});
    }
}

void check_coarser_and_finer_steps(Verification& verification) {
    for (const bool pair : {true, false}) {
        for (const double steps : {75.0, 300.0}) check_restitution(verification, {RockShape::cylinder, pair, false, 0.5, steps});
    }
}

void check_closed_forms(Verification& verification) {
    const About about{"Chen2019", "closed form against the number worked out by hand", {}};
    const auto form = [](bool pair, bool pull) { return physics::linear_restitution(damping_ratio(0.4, pair), pull); };
    verification.absolute("closed form, pair with pull", "-", form(true, true), 0.1159, 1e-4, about);
    verification.absolute("closed form, wall with pull", "-", form(false, true), 0.2538, 1e-4, about);
    verification.absolute("closed form, pair without pull", "-", form(true, false), 0.2645, 5e-4, about);
    verification.absolute("closed form, wall without pull", "-", form(false, false), 0.3635, 5e-4, about);
}

/// The same water and cylinder on two meshes: a stiffness that hangs on the cells would give the finer one a step of its own.
void check_step(Verification& verification) {
    const About about{"Chen2019", "sqrt(theta l/g) 2 pi/150 with l = 0.5 mm", {}};
    for (const double cell : {1e-3, 0.5e-3}) {
        const free_surface::Scene scene = free_surface::parse_scene(fmt::format("kind = \"free_surface\"\n"
                                                                                "[domain]\nwidth_m = 0.06\nheight_m = 0.04\ncell_m = {:g}\n"
                                                                                "[[bodies]]\ndiameter_m = 0.01\ncentre_x_m = 0.03\n"
                                                                                "lowest_m = 0.01\n[run]\nend_s = 0.1\n",
                                                                                cell),
                                                                    "a study");
        const std::string mesh = fmt::format(", cells of {:g} mm", 1e3 * cell);
        verification.relative("contact step that `check` tells" + mesh, "s", predict(scene).dem_step, 2.9905e-5, 1e-4, about);
        const liggghts::LiggghtsEngine engine(scene.dem, std::vector<coupling::ZoneMotion>{}, MPI_COMM_WORLD);
        verification.relative("time step of the study's engine" + mesh, "s", engine.largest_time_step(), 2.9905e-5, 1e-4, about);
    }
}

/// Mean acceleration down a slope, measured between 0.1 and 0.3 s; gravity is turned instead of the floor.
double rolling_acceleration(RockShape shape) {
    CylinderColumn column;
    column.gap = 0.0;
    coupling::DemSettings settings = column_dem(column);
    settings.shape = shape;
    const double angle = std::atan(0.2);
    settings.gravity = 9.81 * Vec3(std::sin(angle), 0, -std::cos(angle));
    liggghts::LiggghtsEngine engine(settings, std::vector<coupling::ZoneMotion>{}, MPI_COMM_WORLD);
    coupling::Rocks rock;
    rock.append(column_rocks(column), 0);
    rock.position[0] = Vec3(0.02, 0.5 * k_cylinder_length, 0.5 * k_cylinder_diameter + 1e-6);
    engine.insert(rock);
    const auto still = [](std::size_t, const Vec3&) { return Vec3(Vec3::Zero()); };
    engine.advance(0.1, still);
    const double early = engine.rocks().velocity[0].x();
    engine.advance(0.2, still);
    return (engine.rocks().velocity[0].x() - early) / 0.2;
}

void check_rolling(Verification& verification) {
    const double along = 9.81 * std::sin(std::atan(0.2));
    verification.relative("acceleration of a rolling cylinder", "m/s2", rolling_acceleration(RockShape::cylinder), 2.0 / 3.0 * along, 0.01,
                          {"exact", "slope 0.2, friction 0.3", {}});
    verification.relative("acceleration of a rolling sphere", "m/s2", rolling_acceleration(RockShape::sphere), 5.0 / 7.0 * along, 0.01,
                          {"exact", "slope 0.2, friction 0.3", {}});
}

void run(Verification& verification) {
    const SingleProcess mpi;
    check_closed_forms(verification);
    check_step(verification);
    check_law(verification, k_fine_steps);
    check_rolling(verification);
    if (!verification.wants(Effort::standard)) return;
    check_law(verification, k_study_steps);
    check_coarser_and_finer_steps(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
