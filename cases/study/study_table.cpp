/// \file The one declaration of every key of a study.
#include <algorithm>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/study/feed_keys.hpp"
#include "cases/study/study.hpp"
#include "cases/study/study_section.hpp"
#include "geometry/base/parameters/parameter_row.hpp"
#include "geometry/base/statistics/developed_flow.hpp"
#include "meshing/cutter/mesh_plan.hpp"

namespace cutterflow::cases {
namespace {

using Row = ParameterRow;

// No cutter and no flume is larger: a value beyond is a slip of the unit.
constexpr double k_largest_length = 100.0, k_largest_tank = 1000.0;  // [m]
constexpr double k_most_revolutions = 1e4;

/// A row of the study, which belongs to a stage of a run.
Row row(const char* stage, std::string key, ParameterKind kind, const char* unit, std::string help) {
    const bool repeated = key.rfind("feed.", 0) == 0;
    Row made(std::move(key), kind, unit, std::move(help));
    return repeated ? made.stage(stage).repeated() : made.stage(stage);
}
Row number(const char* stage, const char* key, const char* unit, const char* help) {
    return row(stage, key, ParameterKind::number, unit, help);
}
/// A length above 0. \param largest  [m]
Row length(const char* stage, const char* key, double largest, const char* help) {
    return number(stage, key, "m", help).above(0.0).at_most(largest);
}
Row integer(const char* stage, const char* key, const char* help) {
    return row(stage, key, ParameterKind::integer, "-", help);
}
Row text(const char* stage, const char* key, const char* help) {
    return row(stage, key, ParameterKind::text, "-", help);
}
Row choice(const char* stage, const char* key, std::vector<std::string> choices, const char* help) {
    return row(stage, key, ParameterKind::choice, "-", help).one_of(std::move(choices));
}

ParameterTable head_rows() {
    return {
        text(k_report_stage, "name", "Name of the study, shown in its report.").by_default(std::string("study")),
        choice(k_report_stage, "scene.kind", {"cutter"}, "What is studied: a cutter. Rooms and free surfaces have keys of their own.")
            .by_default(std::string("cutter")),
        row(k_geometry_stage, "cutter.file", ParameterKind::path, "-",
            "Surface of the cutter (STL, OBJ or PLY), relative to this file; closed and facing outwards."),
        choice(k_geometry_stage, "cutter.unit", {"m", "mm", "cm", "inch", "ft"}, "Unit of length in the cutter's file.")
            .derived("metres, millimetres or inches, the first that gives a plausible size"),
        number(k_case_stage, "rotor.speed_rpm", "rpm", "Rotation speed of the cutter.").at_least(0.1).at_most(600.0),
        choice(k_case_stage, "rotor.direction", {"right_handed", "left_handed"},
               "Sense of rotation about the axis from hub to ring. Seen from the suction side, right_handed turns counterclockwise.")
            .by_default(std::string("right_handed")),
        number(k_case_stage, "suction.discharge_m3_s", "m3/s", "Volume flow of the mixture through the suction pipe.")
            .at_least(1e-6)
            .at_most(100.0),
        number(k_geometry_stage, "suction.mouth_azimuth_deg", "deg",
               "Azimuth of the mouth's centre: 0 is lowest, positive by the right hand about the axis.")
            .at_least(-360.0)
            .at_most(360.0)
            .by_default(0.0),
        number(k_geometry_stage, "suction.mouth_offset_m", "m", "Distance of the mouth's centre from the rotor's axis.")
            .at_least(0.0)
            .at_most(k_largest_length)
            .derived("0.55 ring radius"),
        length(k_geometry_stage, "suction.mouth_radius_m", k_largest_length, "Inner radius of mouth and suction pipe.")
            .derived("0.25 ring radius"),
        length(k_geometry_stage, "suction.gap_m", k_largest_length, "Gap between ring plane and backplate.").derived("0.075 ring radius"),
        length(k_geometry_stage, "suction.backplate_radius_m", k_largest_length, "Radius of the backplate.").derived("the ring radius"),
        length(k_geometry_stage, "suction.backplate_thickness_m", k_largest_length,
               "Thickness of the backplate; at least 0.001 ring radius.")
            .derived("0.05 ring radius"),
        length(k_geometry_stage, "suction.pipe_wall_m", k_largest_length, "Wall thickness of the suction pipe; at least 0.001 ring radius.")
            .derived("0.025 ring radius"),
        number(k_case_stage, "ladder.inclination_deg", "deg",
               "Rotor axis below horizontal; gravity stands at 90 degrees minus it from the axis.")
            .at_least(0.0)
            .at_most(90.0)
            .by_default(45.0),
        choice(k_case_stage, "swing.direction", {"over_cut", "under_cut"},
               "Whether blades cut the bank on their way down (over_cut) or up (under_cut); sets the side on which rock is released.")
            .by_default(std::string("over_cut")),
    };
}

/// The bank that the head swings into, and its soil. All belong to the study only with bank.model = "wall".
ParameterTable bank_rows() {
    return {
        number(k_case_stage, "swing.speed_m_min", "m/min",
               "Speed of the swing, of this head; the report's prototype swings faster by the root of scale.length_ratio.")
            .at_least(0.0)
            .at_most(1000.0)
            .derived("nothing; a bank needs it"),
        choice(k_case_stage, "bank.model", {k_no_bank, k_wall_bank},
               "Soil beside the head: none, or the bank that earlier swings left standing. Water and rock feel it, "
               "and it says how much rock comes from the cut face, where and when.")
            .by_default(std::string(k_no_bank)),
        length(k_case_stage, "bank.cut_height_m", k_largest_length,
               "Height of the bank's level top above the lowest point of the head with picks and clearance, vertical.")
            .derived("0.8 ring radius"),
        length(k_case_stage, "bank.step_m", k_largest_length, "Advance of the ship after each swing, horizontal.")
            .derived("0.4 ring radius"),
        number(k_case_stage, "bank.clearance_m", "m", "Distance of the soil from the head and its picks.")
            .at_least(0.0)
            .at_most(k_largest_length)
            .derived("0.02 ring radius"),
        number(
            k_case_stage, "bank.pick_length_m", "m",
            "By which picks that the cutter's file does not have stand out of the head's contour. They cut, and rock does not pass between "
            "them; water does.")
            .at_least(0.0)
            .at_most(k_largest_length)
            .derived("0 when the head is wider than its ring by 0.03 ring radius or more, as heads with picks are; else 0.1 ring radius"),
        row(k_case_stage, "bank.file", ParameterKind::path, "-",
            "Closed surface (STL, OBJ, PLY) of soil of your own in the run's frame, in metres: axis along z, ring plane at z = 0, the "
            "swing "
            "along y, lowest side of the head at positive x. Water and rock feel it in the place of the bank that earlier swings left; cut "
            "face and production still follow from the other keys.")
            .derived("what earlier swings left"),
        number(k_case_stage, "bank.permeability_m2", "m2",
               "Permeability of the bank by Darcy's law: water moves in it. Sand 1e-11, gravel 1e-8, rock without open joints 0.")
            .at_least(0.0)
            .at_most(1e-3)
            .derived("0"),
        row(k_case_stage, "hauling.water", ParameterKind::boolean, "-",
            "Whether the run's frame travels with the head at swing.speed_m_min: far water, bank and bed move past it, and the cut soil's "
            "volume comes into the water. Otherwise water and bank stand still.")
            .by_default(false),
        number(k_case_stage, "soil.grain_density_kg_m3", "kg/m3", "Density of the soil's grains.")
            .at_least(100.0)
            .at_most(30000.0)
            .derived("2650"),
        number(k_case_stage, "soil.porosity", "-", "Share of the standing soil that is water.").at_least(0.0).at_most(0.9).derived("0.15"),
        number(k_case_stage, "soil.bulking", "-", "Volume of loose rock over that of the soil it was cut from.")
            .at_least(1.0)
            .at_most(3.0)
            .derived("1.5"),
        number(
            k_report_stage, "soil.specific_energy_mj_m3", "MJ/m3",
            "Energy that cutting takes per volume of standing soil, from tests or a cutting theory of your own. The report adds the power "
            "that it needs; the program computes none.")
            .above(0.0)
            .at_most(1000.0)
            .derived("no power of cutting"),
        number(k_case_stage, "bed.spill_layer_m", "m",
               "Thickness of the loose rock that the swing before left on what it cut; it comes in beside the cut rock, as loose as "
               "soil.bulking says. A report tells the layer that its own spillage "
               "makes (next_layer_m).")
            .at_least(0.0)
            .at_most(k_largest_length)
            .derived("0"),
    };
}

ParameterTable water_rows() {
    return {
        length(k_geometry_stage, "tank.radius_m", k_largest_tank, "Radius of the water's cylinder about the axis; at most 50 ring radii.")
            .derived("6.25 ring radius"),
        length(k_geometry_stage, "tank.bed_clearance_m", k_largest_tank,
               "Distance of the head's lowest point from the bed, along the axis.")
            .derived("0.975 ring radius"),
        length(k_geometry_stage, "tank.height_m", k_largest_tank, "Height of the water's cylinder along the axis; at most 50 ring radii.")
            .derived("bed clearance + the head's height + 1.0875 ring radius"),
        choice(k_mesh_stage, "mesh.preset", meshing::mesh_preset_names(),
               "Resolution: draft has 40,000 to 70,000 cells, paper about 1,000,000 with 0.01 ring radius at the blades.")
            .by_default(std::string("draft")),
        number(k_case_stage, "fluid.density_kg_m3", "kg/m3", "Density of the water.").at_least(0.1).at_most(20000.0).by_default(998.2),
        number(k_case_stage, "fluid.kinematic_viscosity_m2_s", "m2/s", "Kinematic viscosity of the water.")
            .at_least(1e-8)
            .at_most(1.0)
            .by_default(1.0034e-6),
    };
}

/// The study's row of one setting of the solver, under the study's own name.
template <class Settings>
Row setting(const char* key, const char* name_in_dictionary) {
    for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>()) {
        if (setting.parameter.key != name_in_dictionary) continue;
        Parameter parameter = setting.parameter;
        parameter.key = key;
        return Row(std::move(parameter)).stage(k_case_stage);
    }
    throw std::logic_error(fmt::format("{} is no setting", name_in_dictionary));
}

/// Rows of all settings of a struct that the study offers.
template <class Settings>
ParameterTable settings_of(const StudySection<Settings>& section) {
    ParameterTable rows;
    for (const Parameter& row : section.rows()) rows.push_back(Row(row).stage(k_case_stage));
    return rows;
}

/// "0.5 (gravel), 0.15 (paper)".
std::string values_by_preset(const coupling::MaterialPair& pair, const coupling::Setting<coupling::PairSettings>& setting) {
    std::vector<std::string> values;
    for (const coupling::PairPreset& preset : coupling::pair_presets()) {
        coupling::ContactSettings contact;
        coupling::use_preset(contact, preset.name);
        values.push_back(fmt::format("{:g} ({})", std::get<double>(setting.value_in(contact.*pair.settings)), preset.name));
    }
    return fmt::format("{}", fmt::join(values, ", "));
}

/// Keys of every pair of materials; what a file leaves out comes from rock.preset.
ParameterTable pair_rows() {
    std::vector<std::string> names;
    for (const coupling::PairPreset& preset : coupling::pair_presets()) names.emplace_back(preset.name);
    ParameterTable rows{choice(k_case_stage, k_preset_key, names,
                               "Friction, restitution and rolling friction that the keys below do not give: of angular gravel, or the "
                               "reference's, in which rock is smooth and rolls freely.")
                            .by_default(std::string(coupling::k_gravel_pairs))
                            .source("NieuwboerVanRheeKeetels2023")};
    for (const coupling::Setting<coupling::PairSettings>& setting : coupling::setting_table<coupling::PairSettings>()) {
        for (const coupling::MaterialPair& pair : coupling::k_material_pairs) {
            Parameter of_pair = setting.parameter;
            of_pair.key = key_of(pair, setting);
            of_pair.help = fmt::format("Rock on {}. {}", pair.other, of_pair.help);
            rows.push_back(Row(std::move(of_pair)).derived(values_by_preset(pair, setting)).stage(k_case_stage));
        }
    }
    return rows;
}

ParameterTable rock_rows() {
    ParameterTable rows = settings_of(k_contact_section);
    rows.front() = Row(rows.front()).derived("so that rock at tip speed overlaps steel by 5 % of its radius");
    for (const ParameterTable& more : {pair_rows(), settings_of(k_closure_section), settings_of(k_kernel_section)})
        rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

ParameterTable run_rows() {
    return {
        number(k_report_stage, "scale.length_ratio", "-",
               "Length of the prototype over that of this head; the report adds columns scaled by Froude's law.")
            .at_least(1e-3)
            .at_most(1e3)
            .by_default(1.0),
        number(
            k_case_stage, "run.flow_revolutions", "-",
            "Revolutions of the flow alone before rock is released. It forgets the frozen rotor from which it starts in some six; all but "
            "those that are recorded and one more are computed in longer steps.")
            .at_least(0.0)
            .at_most(k_most_revolutions)
            .by_default(k_developed_revolutions),
        number(k_case_stage, "run.max_revolutions", "-", "Revolutions after which the run ends, those of the flow alone included.")
            .at_least(1e-3)
            .at_most(k_most_revolutions)
            .by_default(9.0),
        setting<coupling::StopSettings>("run.stop_undecided", "undecided").by_default(0.0),
        setting<coupling::StopSettings>("run.target_half_width", "targetHalfWidth").by_default(0.03),
        number(k_case_stage, "run.record_revolutions", "-",
               "Revolutions of the flow before the first rock that are recorded by rotor phase, for `cutterflow replay`: 1 or more, or 0 "
               "for none.")
            .at_least(0.0)
            .at_most(k_most_revolutions)
            .by_default(0.0),
        number(k_case_stage, "run.max_courant", "-", "Largest Courant number of the flow relative to the mesh.")
            .at_least(0.01)
            .at_most(5.0)
            .by_default(1.8),
        setting<coupling::CheckpointSettings>("run.checkpoint_interval_s", "interval").derived("a quarter of a revolution"),
        number(k_case_stage, "run.write_interval_s", "s",
               "Simulated time between fields and rock positions for ParaView; a run has at most 10,000 of them.")
            .above(0.0)
            .derived("a quarter of a revolution"),
        length(k_case_stage, "report.bin_width_m", k_largest_length,
               "Width of the axial bins of spillage and outflow; the head has at most 1,000.")
            .derived("0.075 ring radius"),
        setting<coupling::OutflowSettings>("report.outflow_offset_m", "offset").derived("0.0375 ring radius"),
        setting<coupling::OutflowSettings>("report.outflow_start_s", "startTime")
            .derived("the end of run.flow_revolutions, or half the run when that is not before its end"),
        row(k_case_stage, "report.adv_points", ParameterKind::path, "-",
            "CSV file of points at which velocities were measured; the run averages the velocity there. `cutterflow report --adv-template` "
            "prints one.")
            .derived("no points"),
        number(k_case_stage, "report.adv_probe_diameter_m", "m",
               "Diameter of the volume, a cylinder along the axis, in which the instrument measures.")
            .above(0.0)
            .at_most(1.0)
            .derived("0.006 m"),
        number(k_case_stage, "report.adv_probe_length_m", "m", "Length of that volume.").above(0.0).at_most(1.0).derived("0.009 m"),
        length(k_case_stage, "report.adv_position_error_m", k_largest_length,
               "How far the instrument may have been from where it is said to have been.")
            .derived("0.025 ring radius"),
    };
}

ParameterTable feed_rows() {
    return {
        choice(k_case_stage, "feed.kind", {k_batch, k_cut_face},
               "A batch of rock released at once inside the head, or rock that comes all the time where the head cuts the bank.")
            .by_default(std::string(k_batch)),
        integer(k_case_stage, "feed.count", "Number of rocks of a batch; give this or mass_kg.").at_least(1.0).derived("from mass_kg"),
        number(k_case_stage, "feed.mass_kg", "kg", "Mass of the rocks of a batch; give this or count.").above(0.0).derived("from count"),
        number(k_case_stage, "feed.start_revolution", "-", "Revolution at which the rock is released.")
            .at_least(0.0)
            .at_most(k_most_revolutions)
            .derived("run.flow_revolutions"),
        number(k_case_stage, "feed.duration_s", "s",
               "How long rock comes from a cut face; 0 goes on to the end of the run. Not for batches.")
            .at_least(0.0)
            .by_default(0.0),
        number(k_case_stage, "feed.velocity_share", "-",
               "Speed of rock from a cut face where it comes in, over that of the blade there: 0 lies, 1 is thrown.")
            .at_least(0.0)
            .at_most(1.0)
            .by_default(0.5),
        number(k_case_stage, "feed.disintegration", "-",
               "Share of what a cut face gives that becomes rock of the feed's sizes; the rest are fines, which are not followed. Of a "
               "size_law the default is its share above size_min_m.")
            .above(0.0)
            .at_most(1.0)
            .by_default(1.0),
        choice(k_case_stage, "feed.size_law", {k_classes, k_rosin_rammler, k_log_normal},
               "Sizes of rock from a cut face: the [[feed.class]] tables, or a law of mass over diameter, cut into classes of equal mass.")
            .by_default(std::string(k_classes)),
        number(k_case_stage, "feed.size_d63_m", "m", "Diameter d63 of rosin_rammler, F(d) = 1 - exp(-(d/d63)^spread).")
            .at_least(1e-5)
            .at_most(10.0)
            .derived("needed by rosin_rammler"),
        number(k_case_stage, "feed.size_d50_m", "m", "Median diameter by mass of log_normal.")
            .at_least(1e-5)
            .at_most(10.0)
            .derived("needed by log_normal"),
        number(k_case_stage, "feed.size_spread", "-", "Exponent of rosin_rammler, or standard deviation of ln(d) of log_normal.")
            .above(0.0)
            .at_most(20.0)
            .derived("needed by both laws"),
        number(k_case_stage, "feed.size_min_m", "m",
               "Smallest diameter of rock. A law is truncated to it; what it has below is fines (disintegration).")
            .at_least(1e-5)
            .at_most(10.0)
            .derived("needed by both laws"),
        number(k_case_stage, "feed.size_max_m", "m", "Largest diameter of rock by a law, which is truncated to it; less than the head's.")
            .at_least(1e-5)
            .at_most(10.0)
            .derived("needed by both laws"),
        integer(k_case_stage, "feed.size_classes", "Classes of equal mass into which a law is cut.")
            .at_least(1.0)
            .at_most(100.0)
            .by_default(std::int64_t{6}),
        integer(k_case_stage, "feed.seed", "Seed of the placement; repeats of a run differ by it.")
            .at_least(0.0)
            .by_default(std::int64_t{1}),
        number(k_case_stage, "feed.spacing_diameters", "-",
               "Distance between neighbouring rocks of a batch, centre to centre, over the largest diameter, of clumps that of the sphere "
               "around them.")
            .at_least(1.01)
            .at_most(20.0)
            .by_default(1.5),
        number(k_case_stage, "feed.azimuth_centre_deg", "deg",
               "Middle of the wedge in which rock of a batch is placed, in the fixed frame when it is released.")
            .at_least(-360.0)
            .at_most(360.0)
            .derived("the bank's side, from swing.direction and rotor.direction"),
        number(k_case_stage, "feed.azimuth_width_deg", "deg", "Width of the wedge; rock fills it from its middle.")
            .above(0.0)
            .at_most(360.0)
            .by_default(120.0),
        number(k_case_stage, "feed.radius_from_m", "m", "Inner radius of the wedge.")
            .at_least(0.0)
            .at_most(k_largest_length)
            .by_default(0.0),
        length(k_case_stage, "feed.radius_to_m", k_largest_length, "Outer radius of the wedge; rock stays within the head's contour.")
            .derived("the head's largest radius"),
        number(k_case_stage, "feed.depth_from_m", "m", "Upper end of the wedge, below the ring plane.")
            .at_least(0.0)
            .at_most(k_largest_length)
            .by_default(0.0),
        length(k_case_stage, "feed.depth_to_m", k_largest_length, "Lower end of the wedge, below the ring plane.")
            .derived("the head's lowest point"),
        number(k_case_stage, "feed.class.diameter_m", "m",
               "Diameter of the rocks of this class, of a clump that of the sphere of its volume; less than the head's.")
            .at_least(1e-5)
            .at_most(10.0),
        number(k_case_stage, "feed.class.density_kg_m3", "kg/m3",
               "Density of the rock. From a cut face the default is soil.grain_density_kg_m3.")
            .at_least(100.0)
            .at_most(30000.0)
            .by_default(2650.0),
        number(k_case_stage, "feed.class.mass_share", "-", "Share of this class in the feed's mass, relative to the sum of all shares.")
            .at_least(1e-6)
            .at_most(1e6)
            .by_default(1.0),
        row(k_case_stage, "feed.class.shape", ParameterKind::path, "-", "File of a clump, which these rocks are. Not for a size_law.")
            .derived("spheres"),
    };
}

}  // namespace

const ParameterTable& study_table() {
    static const ParameterTable table = [] {
        ParameterTable all;
        for (const ParameterTable& rows : {head_rows(), bank_rows(), water_rows(), rock_rows(), run_rows(), feed_rows()})
            std::copy(rows.begin(), rows.end(), std::back_inserter(all));
        return all;
    }();
    return table;
}

}  // namespace cutterflow::cases
