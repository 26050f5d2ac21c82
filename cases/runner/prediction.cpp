#include "cases/runner/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/scenes/cutter/case_inputs.hpp"
#include "cases/scenes/cutter/feed.hpp"
#include "cases/scenes/cutter/start_flow.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/study/contact_rules.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/ports/mapping_width.hpp"

namespace cutterflow::cases {
namespace {

constexpr double k_gravity = 9.81;
// Core time of a coupled step over that of the flow alone, without what each rock adds, and what each rank beyond the first adds to
// either: least rounds of docs/results/step_cost.md, on one and two ranks.
constexpr double k_rock_share = 1.27;
constexpr double k_flow_per_rank = 0.44;
constexpr double k_rock_per_rank = 0.33;
// Rock may travel this share of its kernel width in a step.
constexpr double k_travel_share = 0.25;
// What each rock adds: its mapping, by the cells in the cube of its kernel's width (0.12 ms for 20 mm on the draft mesh, 0.43 ms for 30
// mm), and each step of its contacts, as in a dense bed.
constexpr double k_seconds_per_mapped_cell = 23e-6, k_seconds_per_contact_step = 0.65e-6;
// Memory of each rock by the same cells: 20 kB where its kernel is 1.5 cells wide (docs/results/many_rocks.md).
constexpr double k_bytes_per_mapped_cell = 6e3;
constexpr double k_seconds_of_feed_at_work = 2.0;  // of a cut face: in the head, and near it before it counts as left behind
// Core time of the stages before the run: per cell, and per cell and iteration (draft mesh of the model cutter).
constexpr double k_mesh_seconds_per_cell = 0.24e-3, k_start_seconds_per_cell = 2.8e-6;

// Text files of the demo (61,000 cells, two ranks): mesh in both forms, fields at the start, logs; fields with face fluxes and moved points
// at each write; momentum carried in a checkpoint. All a little above what was measured.
constexpr double k_mesh_bytes_per_cell = 700.0, k_mesh_bytes = 2e7;
constexpr double k_field_bytes_per_cell = 280.0, k_carry_bytes_per_cell = 40.0, k_table_bytes_per_step = 2500.0;

/// How often the run writes its fields: at write times, at checkpoints (often the same times) and at the end.
double writes_of_fields(const Study& study) {
    const auto [often, seldom] = std::minmax(study.run.write_interval, study.run.checkpoint_interval);
    const bool same_times = std::abs(std::remainder(seldom, often)) < 1e-6 * often;
    return std::floor(study.end_time() / often) + (same_times ? 0.0 : std::floor(study.end_time() / seldom)) + 1.0;
}

double smallest_rock(const Study& study) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const FeedRequest& feed : study.feeds)
        for (const FeedClass& each : feed.classes) smallest = std::min(smallest, each.diameter);
    return smallest;
}

/// Numbers of rocks of each class that are there at once: all of a batch; of a cut face that of some seconds of feed, by the rectangle of
/// cut height and step.
std::vector<double> rocks_at_work(const FeedRequest& feed, const Study& study) {
    if (feed.kind == FeedKind::batch) {
        const std::vector<std::size_t> counts = rocks_per_class(feed);
        return {counts.begin(), counts.end()};
    }
    const Study::Bank& bank = *study.bank;
    const double section = bank.cut_height * bank.step, mass = section * bank.swing_speed * bank.grain_density * (1.0 - bank.porosity) *
                                                               feed.disintegration * k_seconds_of_feed_at_work;
    const double shares = std::accumulate(feed.classes.begin(), feed.classes.end(), 0.0,
                                          [](double sum, const FeedClass& rock) { return sum + rock.mass_share; });
    std::vector<double> counts;
    counts.reserve(feed.classes.size());
    for (const FeedClass& rock : feed.classes) counts.push_back(mass * rock.mass_share / shares / sphere_mass(rock.diameter, rock.density));
    return counts;
}

/// Settings of the contacts with the speed that their step allows for.
coupling::ContactSettings contacts_of(const Study& study, double tip_speed, double mouth_speed) {
    coupling::ContactSettings contact = study.contact;
    contact.max_speed = tip_speed + mouth_speed;
    return contact;
}

struct RockCost {
    double contact_step = 0.0;     // of the smallest rock [s]; 0 without rock
    double mapped_cells = 0.0;     // in the cubes of all rock's kernel widths
    double contact_seconds = 0.0;  // and for one step of all rock's contacts [s]
    double of_step(double step) const {
        return contact_step > 0.0 ? mapped_cells * k_seconds_per_mapped_cell + contact_seconds * step / contact_step : 0.0;
    }
};

RockCost rock_cost(const Study& study, const coupling::ContactSettings& contact, double cell) {
    RockCost cost;
    for (const FeedRequest& feed : study.feeds) {
        const std::vector<double> counts = rocks_at_work(feed, study);
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const FeedClass& rock = feed.classes[i];
            const double step = rock.shape ? contact_step(contact, rock.shape->clump, rock.diameter, rock.density)
                                           : contact_step(contact, rock.diameter, rock.density);
            cost.contact_step = cost.contact_step > 0.0 ? std::min(cost.contact_step, step) : step;
            const double width = coupling::mapping_width(study.kernel, rock.diameter, cell) / cell;
            cost.mapped_cells += counts[i] * width * width * width;
            const auto spheres = static_cast<double>(rock.shape ? rock.shape->clump.balls.size() : 1);
            cost.contact_seconds += counts[i] * spheres * k_seconds_per_contact_step;
        }
    }
    return cost;
}

/// Longest step [s] of rock that the rotor carries, or that its cells pass, at tip speed.
double step_of_rock(double tip_speed, double cell_size, const Study& study) {
    const double width = coupling::mapping_width(study.kernel, smallest_rock(study), k_cell_at_rock * cell_size);
    return k_travel_share * width / tip_speed;
}

}  // namespace

meshing::MeshInput mesh_input_of(const Study& study, const HeadSize& head, const geometry::TriangleSurface& cutter) {
    meshing::MeshInput input;
    input.ring_radius = head.ring_radius;
    input.cutter = meshing::extent_of_cutter(cutter);
    input.cutter.passage = head.passage;
    input.cutter.thickness = head.thickness;
    input.steel = stationary_steel_of(study, head);
    input.tank = study.water(head);
    input.resolution = meshing::mesh_preset(study.mesh_preset);
    input.rotation_speed = study.rotation_speed;
    input.discharge = study.suction.discharge;
    input.max_courant = study.run.max_courant;
    return input;
}

Prediction predict(const Study& study, const HeadSize& head, const geometry::TriangleSurface& cutter, const RunMachine& machine) {
    Prediction prediction;
    prediction.machine = machine;
    const meshing::MeshPlan plan = meshing::plan_mesh(mesh_input_of(study, head, cutter));
    const double omega = std::abs(study.rotation_speed);
    prediction.mesh = plan.prediction;
    prediction.revolutions = study.run.max_revolutions;
    prediction.flow_step = std::min(plan.prediction.time_step, largest_time_step(omega));
    prediction.rock_step = prediction.flow_step;
    if (!study.feeds.empty())
        prediction.rock_step = std::min(prediction.flow_step, step_of_rock(omega * head.tip_radius, plan.cell_size, study));
    prediction.first_release = study.feeds.empty() ? study.end_time() : std::min(study.first_release(), study.end_time());
    const double flow_revolutions = prediction.first_release / study.period();
    const double rock_revolutions = prediction.revolutions - flow_revolutions;
    const double flow_steps = study.period() / prediction.flow_step, rock_steps = study.period() / prediction.rock_step;  // in a revolution
    prediction.development_end = study.development_end();
    const double development = prediction.development_end / study.period();
    const double full_flow_revolutions = flow_revolutions - development + development / k_development_step_ratio;  // by their steps
    prediction.steps = full_flow_revolutions * flow_steps + rock_revolutions * rock_steps;
    const double mouth = study.suction.mouth_radius;
    prediction.tip_speed = omega * head.tip_radius;
    prediction.mouth_speed = study.suction.discharge / (k_pi * mouth * mouth);
    const coupling::ContactSettings contact = contacts_of(study, prediction.tip_speed, prediction.mouth_speed);
    const RockCost cost = rock_cost(study, contact, k_cell_at_rock * plan.cell_size);
    prediction.contact_step = cost.contact_step;
    prediction.run_memory = plan.prediction.run_memory + cost.mapped_cells * k_bytes_per_mapped_cell;
    const double core_hours_per_step = plan.prediction.core_hours_per_revolution * plan.prediction.time_step / study.period();
    prediction.core_hours_per_revolution =
        machine.slowness * core_hours_per_step * (1.0 + k_flow_per_rank * (machine.ranks - 1)) * flow_steps;
    prediction.core_hours_per_revolution_with_rock = machine.slowness *
                                                     (core_hours_per_step * k_rock_share + cost.of_step(prediction.rock_step) / 3600.0) *
                                                     (1.0 + k_rock_per_rank * (machine.ranks - 1)) * rock_steps;
    prediction.mesh_seconds = machine.slowness * k_mesh_seconds_per_cell * plan.prediction.cells;
    prediction.start_seconds = machine.slowness * k_start_seconds_per_cell * k_start_iterations * plan.prediction.cells;
    prediction.core_hours =
        full_flow_revolutions * prediction.core_hours_per_revolution + rock_revolutions * prediction.core_hours_per_revolution_with_rock;
    prediction.mesh_disk = k_mesh_bytes + k_mesh_bytes_per_cell * plan.prediction.cells;
    prediction.run_disk = (writes_of_fields(study) * k_field_bytes_per_cell + 2.0 * k_carry_bytes_per_cell) * plan.prediction.cells +
                          prediction.steps * k_table_bytes_per_step;
    prediction.flow_number = study.suction.discharge / (omega * std::pow(head.ring_radius, 3));
    prediction.froude = omega * omega * head.ring_radius / k_gravity;
    for (const FeedRequest& feed : study.feeds) {
        const std::vector<std::size_t> counts = rocks_per_class(feed);
        prediction.rocks = std::accumulate(counts.begin(), counts.end(), prediction.rocks);
        for (const FeedClass& rock : feed.classes) prediction.settling_speeds.push_back(settling_speed(study, rock));
    }
    return prediction;
}

std::vector<Mistake> prediction_warnings(const Study& study, const Prediction& prediction) {
    const std::vector<double>& settling = prediction.settling_speeds;
    const auto fastest = std::max_element(settling.begin(), settling.end());
    if (fastest == settling.end() || *fastest <= prediction.mouth_speed) return {};
    return {{"",
             fmt::format("suction.discharge_m3_s = {:.6g} passes the mouth at {:.3g} m/s", study.suction.discharge, prediction.mouth_speed),
             fmt::format("Rock that settles at {:.3g} m/s is not lifted", *fastest), "Check the discharge and suction.mouth_radius_m"}};
}

std::string to_text(const Prediction& p) {
    std::string text = fmt::format("cells        about {:.0f}\n", p.mesh.cells);
    text += fmt::format("time step    about {:.2g} s, with rock {:.2g} s; {:.0f} steps for {:g} revolutions\n", p.flow_step, p.rock_step,
                        p.steps, p.revolutions);
    text += fmt::format("memory       about {:.2g} GB for the mesh, {:.2g} GB for the run on one rank\n", 1e-9 * p.mesh.mesh_memory,
                        1e-9 * p.run_memory);
    text += fmt::format("disk         about {:.2g} GB\n", 1e-9 * (p.mesh_disk + p.run_disk));
    if (p.contact_step > 0.0)
        text += fmt::format("contacts     step {:.2g} s, {:.0f} of them in a step with rock\n", p.contact_step,
                            std::ceil(p.rock_step / p.contact_step));
    text += fmt::format(
        "cost         about {:.2g} core hours: mesh {}, start {}, run {} on {} rank(s); this machine now takes {:.2f} times the "
        "reference's time\n",
        p.core_hours + (p.mesh_seconds + p.start_seconds) / 3600.0, duration_text(p.mesh_seconds), duration_text(p.start_seconds),
        duration_text(3600.0 * p.core_hours / p.machine.ranks), p.machine.ranks, p.machine.slowness);
    text += fmt::format("speeds       tip {:.3g} m/s, suction mouth {:.3g} m/s\n", p.tip_speed, p.mouth_speed);
    text += fmt::format("numbers      Q/(omega R^3) = {:.3g}, omega^2 R/g = {:.3g}\n", p.flow_number, p.froude);
    // Of a cut face the number follows from the bank; `run` tells it.
    text += p.rocks == 0 && !p.settling_speeds.empty() ? std::string("rock         from a cut face")
                                                       : fmt::format("rock         {} rocks", p.rocks);
    for (const double speed : p.settling_speeds) text += fmt::format(", settling at {:.3g} m/s", speed);
    return text + "\n";
}

nlohmann::json to_json(const Prediction& p) {
    return {{"cells", p.mesh.cells},
            {"cell_size_min_m", p.mesh.cell_size_min},
            {"time_step_s", p.flow_step},
            {"time_step_with_rock_s", p.rock_step},
            {"mesh_memory_bytes", p.mesh.mesh_memory},
            {"run_memory_bytes", p.run_memory},
            {"disk_bytes", p.mesh_disk + p.run_disk},
            {"steps", p.steps},
            {"contact_step_s", p.contact_step},
            {"mesh_core_s", p.mesh_seconds},
            {"start_core_s", p.start_seconds},
            {"core_hours", p.core_hours},
            {"ranks", p.machine.ranks},
            {"machine_slowness", p.machine.slowness},
            {"core_hours_per_revolution", p.core_hours_per_revolution},
            {"core_hours_per_revolution_with_rock", p.core_hours_per_revolution_with_rock},
            {"first_release_s", p.first_release},
            {"development_end_s", p.development_end},
            {"development_step_ratio", k_development_step_ratio},
            {"revolutions", p.revolutions},
            {"rocks", p.rocks},
            {"tip_speed_m_s", p.tip_speed},
            {"mouth_speed_m_s", p.mouth_speed},
            {"flow_number", p.flow_number},
            {"froude", p.froude},
            {"settling_velocity_m_s", p.settling_speeds}};
}

}  // namespace cutterflow::cases
