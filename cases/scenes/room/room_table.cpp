/// \file The one declaration of every key of a room's study.
#include <fmt/format.h>

#include "cases/scenes/room/grain_placement.hpp"
#include "cases/scenes/room/room_measures.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "cases/scenes/room/solid_generators.hpp"
#include "cases/study/study_section.hpp"
#include "geometry/base/parameters/parameter_row.hpp"

namespace cutterflow::cases {

namespace {

using Row = ParameterRow;
using namespace room_stage;

constexpr double k_largest_length = 1e3;  // [m]
constexpr double k_longest_time = 1e6;    // [s]
constexpr double k_shortest_run = 1e-6;   // [s], of which the intervals of a run are parts above 0

Row number(const std::string& key, const char* unit, const char* help) {
    return Row(key, ParameterKind::number, unit, help);
}
Row length(const std::string& key, const char* help) {
    return number(key, "m", help).above(0.0).at_most(k_largest_length);
}
Row level(const std::string& key, const char* help) {
    return number(key, "m", help).at_least(-k_largest_length).at_most(k_largest_length);
}
Row time(const std::string& key, const char* help) {
    return number(key, "s", help).at_least(0.0).at_most(k_longest_time);
}
Row duration(const std::string& key, const char* help) {
    return number(key, "s", help).above(0.0).at_most(k_longest_time);
}
Row point(const std::string& key, const char* help) {
    return Row(key, ParameterKind::numbers, "m", help).of_length(3).at_least(-k_largest_length).at_most(k_largest_length);
}
Row text(const std::string& key, const char* help) {
    return Row(key, ParameterKind::text, "-", help);
}
Row choice(const std::string& key, std::vector<std::string> choices, const char* help) {
    return Row(key, ParameterKind::choice, "-", help).one_of(std::move(choices));
}
/// A setting of the solver, with its bounds and choices.
template <class Settings>
Row setting(const std::string& key, const char* key_in_dictionary, const char* help) {
    Parameter parameter = StudySection<Settings>::row(key_in_dictionary);
    parameter.key = key;
    parameter.help = help;
    parameter.default_value.reset();
    return Row(std::move(parameter));
}

/// A part of space: `key = { box = { lower_m = [..], upper_m = [..] } }`. Its rows stand in a table within an array's.
ParameterTable region_rows(const std::string& key) {
    return {point(key + ".box.lower_m", "Lower corner of a box.").optional(),
            point(key + ".box.upper_m", "Upper corner of a box.").optional(),
            point(key + ".cylinder.from_m", "One end of a cylinder's axis.").optional(),
            point(key + ".cylinder.to_m", "The other end.").optional(),
            length(key + ".cylinder.radius_m", "Of the cylinder.").optional(),
            point(key + ".sphere.centre_m", "Of a sphere.").optional(),
            length(key + ".sphere.radius_m", "Of the sphere.").optional(),
            point(key + ".half_space.point_m", "A point of the plane that bounds a half space.").optional(),
            Row(key + ".half_space.normal", ParameterKind::numbers, "-", "Direction into the half space.").of_length(3).optional(),
            level(key + ".above_m", "All that lies above this level.").optional(),
            level(key + ".below_m", "All that lies below this level.").optional()};
}

ParameterTable head_rows() {
    return {text("name", "Name of the study, shown in its report.").by_default(std::string("room")),
            choice("scene.kind", {"room"}, "What is studied.").by_default(std::string("room"))};
}

ParameterTable room_rows() {
    ParameterTable rows{
        Row("room.size_m", ParameterKind::numbers, "m", "Size of the box along x, y and z. x and y are centred on 0, z runs from 0 up.")
            .of_length(3)
            .above(0.0)
            .at_most(k_largest_length),
        choice("room.medium", {"none", "water", "air"}, "What fills the room; none moves grains by weight and contacts alone.")
            .by_default(std::string("none"))
            .stage(k_case),
        number("room.density_kg_m3", "kg/m3", "Density of the medium.")
            .at_least(1e-3)
            .at_most(3e3)
            .derived("water 1000, air 1.2")
            .stage(k_case),
        number("room.kinematic_viscosity_m2_s", "m2/s", "Kinematic viscosity of the medium.")
            .at_least(1e-8)
            .at_most(1.0)
            .derived("water 1e-6, air 1.5e-5")
            .stage(k_case),
        choice("room.turbulence", {"realizableKE", "kEpsilon", "laminar"}, "Model of turbulence of the medium.")
            .derived("realizableKE")
            .stage(k_case),
        length("room.cell_m", "Size of the mesh's cells; with a medium only.").derived("needed with a medium").stage(k_mesh),
        number("room.gravity_m_s2", "m/s2", "Gravity.").at_least(1e-3).at_most(100.0).by_default(9.81),
        number("room.tilt_deg", "deg", "By how much gravity leans from the vertical, towards +x, in the run; the preparation is upright.")
            .at_least(-90.0)
            .at_most(90.0)
            .by_default(0.0)
            .stage(k_case),
        text("room.material", "Material of the sides that are walls to grains.").by_default(std::string("steel")),
        length("room.refine.cell_m", "Size of the cells in the part that this table gives.").repeated().stage(k_mesh),
    };
    for (const Parameter& row : region_rows("room.refine")) rows.push_back(Row(row).stage(k_mesh));
    return rows;
}

ParameterTable solid_rows() {
    std::vector<std::string> generators;
    for (const SolidGenerator& generator : solid_generators()) generators.emplace_back(generator.name);
    ParameterTable rows{
        text("solid.name", "Name of the solid.").repeated(),
        choice("solid.generate", generators, "A solid of these sizes; give this or file.").optional().repeated(),
        Row("solid.file", ParameterKind::path, "-",
            "Closed surface (STL, OBJ or PLY) in the room's frame, in metres; give this or generate.")
            .optional()
            .repeated(),
        text("solid.material", "Material, for its contacts with grains.").by_default(std::string("steel")).repeated().stage(k_bed),
        Row("solid.fluid", ParameterKind::boolean, "-", "Whether the medium feels the solid; grains always do.")
            .by_default(true)
            .repeated()
            .stage(k_mesh),
        Row("solid.velocity_m_s", ParameterKind::numbers, "m/s",
            "Constant velocity from from_s to to_s; before and after the solid stands.")
            .of_length(3)
            .at_least(-100.0)
            .at_most(100.0)
            .optional()
            .repeated()
            .stage(k_case),
        Row("solid.turn_rpm", ParameterKind::number, "rpm",
            "Constant rotation, right-handed about its axis, from from_s to to_s; before and after the solid stands.")
            .at_least(-1e4)
            .at_most(1e4)
            .optional()
            .repeated()
            .stage(k_case),
        Row("solid.turn_axis", ParameterKind::numbers, "-", "Direction of the axis of turn_rpm.")
            .of_length(3)
            .at_least(-1e6)
            .at_most(1e6)
            .optional()
            .repeated()
            .stage(k_case),
        point("solid.turn_origin_m", "A point on the axis of turn_rpm.").optional().repeated().stage(k_case),
        time("solid.from_s", "When it begins to move.").optional().repeated().stage(k_case),
        time("solid.to_s", "When it stops.").optional().repeated().stage(k_case),
        time("solid.removed_at_s", "When it is taken away; 0: it is there for the preparation alone.").optional().repeated().stage(k_case),
    };
    for (const Parameter& row : solid_size_rows()) rows.push_back(row);
    return rows;
}

ParameterTable boundary_rows() {
    return {
        choice("boundary.on", {"bottom", "top", "sides", "x_min", "x_max", "y_min", "y_max"}, "The sides that the table is about.")
            .repeated(),
        text("boundary.name", "Name of its patch.").derived("from the side").repeated(),
        text("boundary.inside", "Name of a pipe: the part of the side within its bore.").optional().repeated(),
        level("boundary.above_m", "The part of vertical sides above this level.").optional().repeated(),
        level("boundary.below_m", "The part of vertical sides below this level.").optional().repeated(),
        point("boundary.disc.centre_m", "Centre of a disc on the side.").optional(),
        length("boundary.disc.radius_m", "Of the disc.").optional(),
        point("boundary.rectangle.lower_m", "Lower corner of a rectangle on the side.").optional(),
        point("boundary.rectangle.upper_m", "Upper corner of the rectangle.").optional(),
        choice("boundary.flow", {"no_slip", "slip", "pressure"},
               "What the medium meets there: walls, or water at the pressure outside; or a table with one of the keys of boundary.flow.")
            .optional()
            .repeated(),
        length("boundary.flow.rough_m", "Height k_s of the roughness of a wall.").optional(),
        number("boundary.flow.inflow_m_s", "m/s", "Mean speed into the room.").above(0.0).at_most(1e3).optional(),
        number("boundary.flow.outflow_m_s", "m/s", "Mean speed out of the room.").above(0.0).at_most(1e3).optional(),
        number("boundary.flow.inflow_m3_s", "m3/s", "Discharge into the room.").above(0.0).at_most(1e6).optional(),
        number("boundary.flow.outflow_m3_s", "m3/s", "Discharge out of the room.").above(0.0).at_most(1e6).optional(),
        time("boundary.flow.ramp_s", "Time in which the flow grows from 0.").optional(),
        Row("boundary.flow.times_s", ParameterKind::numbers, "s", "Times of a table of speeds, with speeds_m_s.").at_least(0.0).optional(),
        Row("boundary.flow.speeds_m_s", ParameterKind::numbers, "m/s", "Mean speeds into the room at these times.")
            .at_least(0.0)
            .optional(),
        choice("boundary.grains", {"wall", "open", "frictionless"}, "What the whole of these sides is to grains.")
            .derived("walls; the top is open")
            .repeated()
            .stage(k_bed),
    };
}

ParameterTable material_rows() {
    using Contact = coupling::ContactSettings;
    using Pair = coupling::PairSettings;
    return {
        text("material.name", "Name of the material.").repeated(),
        setting<Contact>("material.youngs_modulus_pa", "youngsModulus", "Young's modulus of the grains' material; solids get the same.")
            .optional()
            .repeated(),
        setting<Contact>("material.poisson", "poissonRock", "Poisson's ratio.").by_default(0.25).repeated(),
        Row("contact.pair", ParameterKind::texts, "-", "The two materials; one is that of the grains.").of_length(2).repeated(),
        setting<Pair>("contact.friction", "friction", "Coulomb friction.").repeated(),
        setting<Pair>("contact.rolling", "rollingFriction",
                      "Rolling friction: largest rolling couple over normal force and rolling radius.")
            .by_default(0.0)
            .repeated(),
        setting<Pair>("contact.restitution", "restitution", "Dry coefficient of restitution.").repeated(),
        setting<Contact>("dem.rolling_law", "rollingLaw", "How rolling friction acts: with a state of rest, or as a constant couple.")
            .by_default(std::string("spring")),
        setting<Contact>("dem.time_step_fraction", "timeStepFraction", "Step of the contacts over the smaller of Rayleigh and Hertz time.")
            .by_default(0.15),
        setting<Contact>("dem.max_speed_m_s", "maxSpeed", "Fastest impact that the step allows for.")
            .derived("the larger of a fall over the room's height and the speeds of its solids"),
        duration("dem.longest_step_s", "Longest time between looks at events, gates and stop rules.")
            .derived("0.1 sqrt(d/g), at most a write interval"),
    };
}

ParameterTable grain_rows() {
    return {
        text("grains.name", "Name of the kind of grains.").repeated(),
        text("grains.material", "Their material; all grains have the same.").repeated(),
        number("grains.density_kg_m3", "kg/m3", "Density.").at_least(10.0).at_most(3e4).repeated(),
        number("grains.diameter_m", "m", "Diameter; of a clump that of the sphere of its volume.")
            .at_least(1e-5)
            .at_most(10.0)
            .optional()
            .repeated(),
        Row("grains.diameter_m.uniform_by_number", ParameterKind::numbers, "m",
            "Smallest and largest diameter, each between as frequent as another.")
            .of_length(2)
            .at_least(1e-5)
            .at_most(10.0)
            .optional(),
        Row("grains.shape", ParameterKind::path, "-", "File of a clump.").derived("spheres").repeated(),
        number("grains.class.diameter_m", "m", "Diameter of a class; instead of grains.diameter_m.")
            .at_least(1e-5)
            .at_most(10.0)
            .repeated(),
        number("grains.class.mass_share", "-", "Its share of the mass, over the sum of all.")
            .above(0.0)
            .at_most(1e6)
            .by_default(1.0)
            .repeated(),
        number("grains.class.density_kg_m3", "kg/m3", "Density of the class.")
            .at_least(10.0)
            .at_most(3e4)
            .derived("grains.density_kg_m3")
            .repeated(),
    };
}

ParameterTable prepare_rows() {
    ParameterTable rows{
        choice("prepare.do", {"pour", "settle", "trim", "freeze", "compress"},
               "A step of the preparation; they are done in the file's order.")
            .repeated(),
        text("prepare.grains", "What is poured.").optional().repeated(),
        length("prepare.depth_m", "Depth of the poured bed; give this, mass_kg or count.").optional().repeated(),
        number("prepare.mass_kg", "kg", "Poured mass.").above(0.0).at_most(1e9).optional().repeated(),
        Row("prepare.count", ParameterKind::integer, "-", "Poured grains.").at_least(1.0).at_most(k_most_grains).optional().repeated(),
        duration("prepare.longest_s", "Settle and compress: by when grains must have come to rest.").derived("20 s").repeated(),
        text("prepare.solid", "Compress: the solid that is pressed on the grains until they bear it; then it stands.")
            .optional()
            .repeated(),
        number("prepare.pressure_pa", "Pa", "Compress: force over the area that the solid, as a convex one, shows along direction.")
            .above(0.0)
            .at_most(1e7)
            .optional()
            .repeated(),
        Row("prepare.direction", ParameterKind::numbers, "-", "Compress: in which the solid moves.")
            .of_length(3)
            .at_least(-1e3)
            .at_most(1e3)
            .derived("down, [0, 0, -1]")
            .repeated(),
        level("prepare.above_m", "Trim and freeze: what lies above this level.").optional().repeated(),
        level("prepare.below_m", "Trim and freeze: what lies below this level.").optional().repeated(),
    };
    for (const Parameter& row : region_rows("prepare.region")) rows.push_back(row);
    return rows;
}

ParameterTable event_rows() {
    ParameterTable rows{
        choice("event.do", {"feed", "extract", "remove", "freeze", "thaw", "move", "ramp"}, "What happens.").repeated(),
        text("event.grains", "What is fed.").optional().repeated(),
        time("event.at_s", "When; of remove, freeze and thaw.").optional().repeated(),
        time("event.from_s", "When it begins; of feed, extract, move and ramp.").optional().repeated(),
        time("event.to_s", "When it ends.").optional().repeated(),
        number("event.rate_kg_s", "kg/s", "Mass per time that is fed or extracted.").above(0.0).at_most(1e9).optional().repeated(),
        text("event.solid", "Move: name of the solid; beside or after its own motion, and as often as wanted.").optional().repeated(),
        Row("event.velocity_m_s", ParameterKind::numbers, "m/s", "Move: constant velocity from from_s to to_s.")
            .of_length(3)
            .at_least(-100.0)
            .at_most(100.0)
            .optional()
            .repeated(),
        text("event.boundary", "Ramp: boundary.name of one with an inflow or an outflow, which changes linearly to another one.")
            .optional()
            .repeated(),
        number("event.speed_m_s", "m/s", "Ramp: mean speed at to_s, in the boundary's direction; then it stays.")
            .at_least(0.0)
            .at_most(1e3)
            .optional()
            .repeated(),
        number("event.discharge_m3_s", "m3/s", "Ramp: in place of speed_m_s, the discharge.")
            .at_least(0.0)
            .at_most(1e6)
            .optional()
            .repeated(),
    };
    for (const Parameter& row : region_rows("event.region")) rows.push_back(row);
    return rows;
}

ParameterTable run_rows() {
    return {
        number("run.end_s", "s", "When the run ends.").at_least(k_shortest_run).at_most(k_longest_time),
        text("run.stop.measure",
             "Name of a measure with a gate: the run ends when nothing has passed the gate for idle_s, or little in window_s.")
            .optional(),
        duration("run.stop.idle_s", "How long nothing passes.").optional(),
        number("run.stop.below_kg_s", "kg/s", "Mean rate through the gate over the last window_s below which the run ends.")
            .above(0.0)
            .at_most(1e9)
            .optional(),
        duration("run.stop.window_s", "Over which the rate of below_kg_s is averaged; the run lasts for it at least.").optional(),
        Row("run.stop.settled", ParameterKind::boolean, "-", "End the run when the grains are at rest.").optional(),
        duration("run.write_interval_s", "Between pictures of the grains.").derived("a fiftieth of the run"),
        duration("run.checkpoint_interval_s", "Between checkpoints.").derived("a twentieth of the run"),
        number("run.max_courant", "-", "Largest Courant number of the flow relative to the mesh; with a medium only.")
            .at_least(0.01)
            .at_most(5.0)
            .derived("0.9 with a medium"),
        Row("run.seed", ParameterKind::integer, "-", "Seed of all random numbers; repeats differ by it.")
            .at_least(0.0)
            .at_most(1e9)
            .by_default(std::int64_t{1})
            .stage(k_bed),
    };
}

/// \param stage  of the rows that name none
void add(ParameterTable& table, const char* stage, const ParameterTable& rows) {
    for (const Parameter& row : rows) table.push_back(row.stage.empty() ? Row(row).stage(stage) : row);
}

/// The same keys, bounds and defaults as in a study of a cutter.
ParameterTable coupling_rows() {
    ParameterTable rows = k_closure_section.rows();
    for (const Parameter& row : k_kernel_section.rows()) rows.push_back(row);
    return rows;
}

}  // namespace

const ParameterTable& room_table() {
    static const ParameterTable table = [] {
        ParameterTable all;
        add(all, k_report, head_rows());
        add(all, k_bed, room_rows());
        add(all, k_case, run_rows());
        add(all, k_geometry, solid_rows());
        add(all, k_mesh, boundary_rows());
        add(all, k_bed, material_rows());
        add(all, k_bed, grain_rows());
        add(all, k_case, coupling_rows());
        add(all, k_bed, prepare_rows());
        add(all, k_case, event_rows());
        add(all, k_report, measure_rows());
        return all;
    }();
    return table;
}

std::string room_template(const std::string& name) {
    return fmt::format(
        "# A heap: a tube filled with glass beads on a disc with a rim, lifted.\n"
        "# All keys: cutterflow params --kind room\n"
        "name = {}\n\n"
        "[scene]\nkind = \"room\"\n\n"
        "[room]                       # x and y are centred on 0, z runs from 0 up\n"
        "size_m = [0.10, 0.10, 0.16]\nmedium = \"none\"              # weight and contacts alone\n\n"
        "[[solid]]\nname = \"disc\"\ngenerate = \"disc_with_rim\"\ncentre_m = [0, 0, 0.03]\nradius_m = 0.04\nthickness_m = 0.01\n"
        "rim_height_m = 0.004\nrim_wall_m = 0.002\n\n"
        "[[solid]]\nname = \"tube\"\ngenerate = \"tube\"\nfrom_m = [0, 0, 0.0301]\nto_m = [0, 0, 0.15]\ninner_radius_m = 0.02\n"
        "wall_m = 0.002\nvelocity_m_s = [0, 0, 0.03]\nfrom_s = 0.0\nto_s = 4.0\n\n"
        "[[material]]\nname = \"glass\"\nyoungs_modulus_pa = 5e6\npoisson = 0.25\n\n"
        "[[contact]]\npair = [\"glass\", \"glass\"]\nfriction = 0.3\nrolling = 0.015\nrestitution = 0.9\n\n"
        "[[contact]]\npair = [\"glass\", \"steel\"]\nfriction = 0.3\nrolling = 0.015\nrestitution = 0.9\n\n"
        "[[grains]]\nname = \"beads\"\nmaterial = \"glass\"\ndensity_kg_m3 = 2500\n"
        "diameter_m = {{ uniform_by_number = [0.0038, 0.0042] }}\n\n"
        "[[prepare]]\ndo = \"pour\"\ngrains = \"beads\"\ndepth_m = 0.06\n"
        "region = {{ cylinder = {{ from_m = [0, 0, 0.03], to_m = [0, 0, 0.15], radius_m = 0.02 }} }}\n\n"
        "[[prepare]]\ndo = \"settle\"\n\n"
        "[[measure]]                   # runs are compared by their measures\n"
        "name = \"angle\"\nwhat = \"angle\"\ncentre_m = [0, 0]\nradius_m = 0.04\nbase_m = 0.03\n"
        "region = {{ cylinder = {{ from_m = [0, 0, 0.03], to_m = [0, 0, 0.15], radius_m = 0.04 }} }}\n\n"
        "[run]\nend_s = 4\nstop = {{ settled = true }}\n",
        toml_text(ParameterValue(name)));
}

}  // namespace cutterflow::cases
