#include "cases/scenes/cutter/study_case.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/scenes/cutter/study_bank.hpp"
#include "cases/scenes/cutter/velocity_points.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/io/read_surface.hpp"

namespace cutterflow::cases {
namespace {

// The pipe ends this many ring radii above the water's surface, which cuts it.
constexpr double k_pipe_above_water = 0.25;
constexpr double k_steel_edge_per_ring_radius = 0.05;
// A few steps of the flow: the DEM sets itself up once for all rock of a packet.
constexpr double k_packet_interval = 0.005;  // [s]
constexpr double k_farthest_ahead = k_pi / 6.0;
constexpr double k_left_behind_per_ring_radius = 0.75, k_left_behind_the_axis_per_ring_radius = 1.5;
// The Courant limit takes over after the first step.
constexpr double k_first_step_per_revolution = 1e-4;

/// Velocity of ground and far water in the run's frame [m/s].
Vec3 hauling_of(const Study& study) {
    if (!study.bank || !study.bank->hauls) return Vec3::Zero();
    return Vec3(0.0, -study.bank_side() * study.bank->swing_speed, 0.0);
}

CaseInputs::Rock rock_of(const Study& study) {
    CaseInputs::Rock rock;
    for (const FeedRequest& feed : study.feeds)
        for (const FeedClass& rock_class : feed.classes) rock.density = std::max(rock.density, rock_class.density);
    rock.shapes = study.shapes();
    rock.contact = study.contact;
    rock.walls = standard_walls();
    if (study.bank && study.bank->adds_picks()) rock.walls.push_back(pick_wall());
    if (study.bank) rock.walls.push_back(bank_wall(hauling_of(study)));
    return rock;
}

/// Rock goes in by packets; what finds no place waits for the next blade; what lies far off is left behind.
void feed_by_cutting(const Study& study, const HeadSize& head, CaseInputs& inputs) {
    const double pitch = 2.0 * k_pi / head.blades;
    inputs.queue = coupling::QueueSettings{k_packet_interval, study.period() / head.blades, std::min(0.5 * pitch, k_farthest_ahead)};
    inputs.fates.cutting = coupling::CuttingSettings{k_left_behind_per_ring_radius * head.ring_radius, Vec3(0.0, -study.bank_side(), 0.0),
                                                     k_left_behind_the_axis_per_ring_radius * head.ring_radius};
}

std::optional<coupling::RecordSettings> record_of(const Study& study, const HeadSize& head) {
    if (study.run.record_revolutions == 0.0) return std::nullopt;
    coupling::RecordSettings record;
    record.end_time = study.first_release();
    record.start_time = std::max(0.0, record.end_time - study.run.record_revolutions * study.period());
    record.blades = head.blades;
    return record;
}

}  // namespace

std::optional<Mistake> missing_file(const ParameterValues& values, const char* key, const std::filesystem::path& study_folder) {
    if (!values.has(key)) return std::nullopt;
    const std::filesystem::path file = study_folder / values.text(key);
    if (std::filesystem::exists(file)) return std::nullopt;
    return Mistake{values.where(key), fmt::format("{} = \"{}\"", key, values.text(key)),
                   fmt::format("There is no file {}", std::filesystem::absolute(file).lexically_normal().string()),
                   "Check the name; the path is relative to the study file"};
}

void require_cutter_file(const ParameterValues& values, const std::filesystem::path& study_folder) {
    if (const auto missing = missing_file(values, "cutter.file", study_folder)) throw UserError(std::vector<Mistake>{*missing});
}

geometry::GeometryInspection import_study_cutter(const ParameterValues& values, const std::filesystem::path& study_folder) {
    const std::filesystem::path file = study_folder / values.text("cutter.file");
    require_cutter_file(values, study_folder);
    std::optional<geometry::LengthUnit> unit;
    if (values.has("cutter.unit")) unit = geometry::length_unit_of(values.text("cutter.unit"));
    const geometry::GeometryInspection inspection = geometry::inspect_cutter(geometry::import_cutter(file, unit), file.string());
    geometry::require_head(inspection);
    return inspection;
}

HeadSize head_size(const geometry::Head& head) {
    const double tip = *std::max_element(head.contour.radius.begin(), head.contour.radius.end());
    return {head.ring_radius, tip, -head.lowest_z, head.passage, head.thickness, std::max(1, head.symmetry.blade_count)};
}

geometry::Contour head_contour(const geometry::Head& head, double z_backplate) {
    return {head.contour.z, head.contour.radius, head.ring_radius, z_backplate};
}

geometry::StationarySteelParameters stationary_steel_of(const Study& study, const HeadSize& head) {
    geometry::StationarySteelParameters steel;
    steel.plate_radius = study.suction.backplate_radius;
    steel.gap = study.suction.gap;
    steel.plate_thickness = study.suction.backplate_thickness;
    steel.mouth = {study.suction.mouth_radius, study.suction.mouth_offset, study.suction.mouth_azimuth};
    steel.pipe_wall = study.suction.pipe_wall;
    steel.pipe_top = study.water(head).z_max + k_pipe_above_water * head.ring_radius;
    steel.edge_length = k_steel_edge_per_ring_radius * head.ring_radius;
    return steel;
}

std::vector<Mistake> carrying_warnings(const Study& study, const geometry::Head& head) {
    const bool positive = study.rotation_speed > 0.0;
    const geometry::CarryingSense with_rotation = positive ? geometry::CarryingSense::positive : geometry::CarryingSense::negative;
    if (head.carrying.sense == with_rotation) return {};
    const std::string what = fmt::format("rotor.direction = \"{}\"", positive ? "right_handed" : "left_handed");
    if (head.carrying.sense == geometry::CarryingSense::none)
        return {{"", what + " turns a head whose blades push rock along the axis in neither sense",
                 "Blades usually carry rock to the suction side", "Check the cutter"}};
    return {{"", what + " makes the blades carry rock away from the suction side",
             fmt::format("This head carries towards it when it turns {}", positive ? "left_handed" : "right_handed"),
             "Check rotor.direction, or mirror the cutter"}};
}

std::vector<Mistake> blade_warnings(const Study& study, const geometry::Head& head) {
    const std::optional<double> flatter = geometry::share_flatter_than(head.blades, study.inclination);
    if (!flatter || *flatter <= 0.5) return {};
    return {{"",
             fmt::format("ladder.inclination_deg = {:g} with blades that are flatter over {:.0f} % of their height",
                         study.inclination * 180.0 / k_pi, 100.0 * *flatter),
             "On a rising blade rock slides towards the ring where the blade's angle with the axis is larger than the ladder's",
             "Look at the blades' angles (cutterflow inspect); a flatter ladder or steeper blades keep rock from the hub"}};
}

CaseInputs case_inputs_of(const Study& study, const HeadSize& head, const geometry::Contour& contour, int ranks) {
    CaseInputs inputs(contour);
    inputs.rotor.speed = study.rotation_speed;
    inputs.discharge = study.suction.discharge;
    inputs.gravity = gravity_of(study.inclination);
    inputs.hauling = hauling_of(study);
    inputs.fluid = study.fluid;
    inputs.tank = study.water(head);
    const double azimuth = study.suction.mouth_azimuth;
    inputs.fates.mouth.centre = Vec3(study.suction.mouth_offset * std::cos(azimuth), study.suction.mouth_offset * std::sin(azimuth),
                                     study.suction.gap + study.suction.backplate_thickness);
    inputs.fates.mouth.radius = study.suction.mouth_radius;
    inputs.fates.bin_width = study.report.bin_width;
    inputs.outflow = {study.report.outflow_offset, study.report.outflow_start};
    inputs.numerics.max_courant = study.run.max_courant;
    inputs.times.end = study.end_time();
    inputs.times.write_interval = study.run.write_interval;
    inputs.times.first_time_step = k_first_step_per_revolution * study.period();
    inputs.times.development_end = study.development_end();
    inputs.checkpoint.interval = study.run.checkpoint_interval;
    inputs.kernel = study.kernel;
    inputs.closures = study.closures;
    inputs.blades = head.blades;
    inputs.velocity_sets = {axial_plane(study, head), plane_under_ring(study, head)};
    if (study.report.adv_points) inputs.velocity_sets.push_back(adv_set(study));
    inputs.ranks = ranks;
    if (!study.feeds.empty()) {
        inputs.rock = rock_of(study);
        if (study.is_fed_by_cutting()) feed_by_cutting(study, head, inputs);
        inputs.stop = study.run.stop;
        inputs.record = record_of(study, head);
    }
    if (study.bank) inputs.bank_permeability = study.bank->permeability;
    fill_scaled_defaults(inputs);
    return inputs;
}

}  // namespace cutterflow::cases
