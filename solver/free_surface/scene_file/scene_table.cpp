#include <algorithm>

#include "solver/free_surface/scene_file/scene_file_reading.hpp"

namespace cutterflow::free_surface {

namespace {

// The bounds of cutters and rooms.
constexpr double k_densest_water = 2e4, k_densest_body = 3e4;  // [kg/m3]
constexpr double k_most_viscous = 1.0;                         // [m2/s]
constexpr const char* k_reference = "Chen2019";

std::vector<std::string> solid_kind_names() {
    std::vector<std::string> names;
    for (const SolidKind& kind : solid_kinds()) names.emplace_back(kind.name);
    return names;
}

Parameter number(const std::string& key, const std::string& unit, std::optional<double> value, double minimum, const std::string& help) {
    Parameter parameter;
    parameter.key = key;
    parameter.unit = unit;
    if (value) parameter.default_value = *value;
    parameter.minimum = minimum;
    parameter.help = help;
    const std::string section = key.substr(0, key.find('.'));
    parameter.repeated = section == "fill" || section == "solid" || section == "bodies" || section == "gauge";
    return parameter;
}

Parameter positive(const std::string& key, const std::string& unit, std::optional<double> value, const std::string& help) {
    Parameter parameter = number(key, unit, value, 0.0, help);
    parameter.minimum_excluded = true;
    return parameter;
}

Parameter derived(Parameter parameter, const std::string& from) {
    parameter.default_value.reset();
    parameter.optional = true;
    parameter.derived_from = from;
    return parameter;
}

Parameter whole(const std::string& key, std::int64_t value, double minimum, const std::string& help) {
    Parameter parameter = number(key, "-", {}, minimum, help);
    parameter.kind = ParameterKind::integer;
    parameter.default_value = value;
    return parameter;
}

Parameter choice(const std::string& key, std::optional<std::string> value, std::vector<std::string> choices, const std::string& help) {
    Parameter parameter = number(key, "-", {}, 0.0, help);
    parameter.minimum.reset();
    parameter.kind = ParameterKind::choice;
    if (value) parameter.default_value = *value;
    parameter.choices = std::move(choices);
    return parameter;
}

Parameter file_name(const std::string& key, const std::string& help, const std::string& otherwise) {
    Parameter parameter = derived(number(key, "-", {}, 0.0, help), otherwise);
    parameter.minimum.reset();
    parameter.kind = ParameterKind::path;
    return parameter;
}

Parameter bounded(Parameter parameter, double maximum) {
    parameter.maximum = maximum;
    return parameter;
}

/// A coefficient of two materials in contact, with its bounds.
Parameter pair_setting(const std::string& key, const std::string& key_in_dictionary, double value, const std::string& help) {
    const auto& table = coupling::setting_table<coupling::PairSettings>();
    const auto setting = std::find_if(table.begin(), table.end(), [&](const auto& one) { return one.parameter.key == key_in_dictionary; });
    return bounded(number(key, "-", value, setting->parameter.minimum.value(), help), setting->parameter.maximum.value());
}

}  // namespace

const std::vector<SolidKind>& solid_kinds() {
    static const std::vector<SolidKind> kinds{
        {"box", {"from_x_m", "from_z_m", "to_x_m", "to_z_m", "from_y_m", "to_y_m"}},
        {"plate", {"from_x_m", "from_z_m", "to_x_m", "to_z_m", "wall_m"}},
        {"pipe", {"axis_x_m", "inner_width_m", "wall_m", "bottom_m", "top_m", "hole_m", "hole_spacing_m"}},
        {"funnel", {"axis_x_m", "inner_width_m", "wall_m", "bottom_m", "wall_length_m", "angle_deg"}},
        {"gate", {"axis_x_m", "wall_m", "bottom_m", "top_m", "speed_m_s", "start_s"}},
        {"surface", {"file"}}};
    return kinds;
}

const ParameterTable& scene_table() {
    static const ParameterTable table = [] {
        ParameterTable keys;
        keys.push_back(choice("kind", "free_surface", {"free_surface"}, "Kind of the scene."));
        Parameter name = choice("name", "free surface", {}, "Name of the scene.");
        name.kind = ParameterKind::text;
        keys.push_back(name);
        keys.push_back(positive("domain.width_m", "m", {}, "Width of the tank, along x."));
        keys.push_back(positive("domain.height_m", "m", {}, "Height of the tank, along z."));
        keys.push_back(choice("domain.dimensions", "plane", {"plane", "space"}, "A plane scene, or one in space with cells across."));
        keys.push_back(positive("domain.length_m", "m", 0.1, "Length of the tank across, along y, and of its cylinders."));
        keys.push_back(positive("domain.cell_m", "m", {}, "Edge of a cell; a body needs at least 5, better 8 across."));
        keys.push_back(bounded(positive("water.density_kg_m3", "kg/m3", 1000.0, "Density of the water."), k_densest_water));
        keys.push_back(
            bounded(number("water.kinematic_viscosity_m2_s", "m2/s", 1e-6, 0.0, "Kinematic viscosity of the water."), k_most_viscous));
        for (const char* key : {"from_x_m", "from_z_m", "to_x_m", "to_z_m"})
            keys.push_back(
                number(std::string("fill.") + key, "m", {}, 0.0, "Corner of a box of water at rest; solids in it are left out."));
        for (const char* key : {"from_y_m", "to_y_m"})
            keys.push_back(derived(number(std::string("fill.") + key, "m", {}, 0.0, "Where a box of water in space ends across."),
                                   "the whole tank across"));
        keys.push_back(choice("solid.kind", {}, solid_kind_names(), "What stands in the tank."));
        keys.push_back(file_name("solid.file",
                                 "STL, OBJ or PLY file of a closed surface in a scene in space, in metres and in the scene's coordinates;"
                                 " relative to the study file.",
                                 "a surface needs it"));
        for (const char* key : {"from_y_m", "to_y_m"})
            keys.push_back(
                derived(number(std::string("solid.") + key, "m", {}, 0.0, "Where a box in space ends across."), "the whole tank across"));
        for (const char* key : {"from_x_m", "from_z_m", "to_x_m", "to_z_m"})
            keys.push_back(derived(number(std::string("solid.") + key, "m", {}, 0.0, "Corners of a box, or ends of a plate's side."),
                                   "box and plate need it"));
        keys.push_back(derived(
            positive("solid.wall_m", "m", {}, "Thickness of a plate, of a gate, of a pipe's or funnel's walls, at least two cells."),
            "all but boxes need it"));
        keys.push_back(derived(number("solid.axis_x_m", "m", {}, 0.0, "Place of a pipe's, funnel's or gate's middle."),
                               "pipe, funnel and gate need it"));
        keys.push_back(derived(positive("solid.inner_width_m", "m", {}, "Inner width of a pipe, or of a funnel at its bottom."),
                               "pipe and funnel need it"));
        keys.push_back(derived(number("solid.bottom_m", "m", {}, 0.0, "Height of the lower end."), "pipe, funnel and gate need it"));
        keys.push_back(derived(positive("solid.top_m", "m", {}, "Height of a pipe's or gate's upper end."), "pipe and gate need it"));
        keys.push_back(derived(bounded(number("solid.speed_m_s", "m/s", {}, 0.0, "Speed at which a gate rises; 0: it is a wall."), 100.0),
                               "a gate needs it"));
        keys.push_back(number("solid.start_s", "s", 0.0, 0.0, "Time at which a gate begins to rise."));
        keys.push_back(number("solid.hole_m", "m", 0.0, 0.0, "Height of the holes in a pipe's walls; 0: none, else at least a cell."));
        keys.push_back(
            derived(positive("solid.hole_spacing_m", "m", {}, "Distance of the holes, from the bottom up."), "a pipe with holes needs it"));
        keys.push_back(bounded(positive("solid.angle_deg", "deg", 45.0, "Angle of a funnel's walls from the horizontal."), 89.0));
        keys.push_back(derived(positive("solid.wall_length_m", "m", {}, "Length of a funnel's walls."), "a funnel needs it"));
        keys.push_back(choice("bodies.shape", "cylinder", {"cylinder", "sphere"}, "Cylinders across the tank; spheres in space alone."));
        keys.push_back(positive("bodies.diameter_m", "m", {}, "Diameter of the bodies."));
        keys.push_back(bounded(positive("bodies.density_kg_m3", "kg/m3", 2700.0, "Density of the bodies."), k_densest_body));
        keys.push_back(file_name("bodies.file",
                                 "CSV file with the places of their centres: x_m,z_m and, if wanted, vx_m_s,vz_m_s,spin_rad_s,id,"
                                 " of spheres also y_m and vy_m_s;"
                                 " relative to the study file.",
                                 "a stack"));
        keys.push_back(whole("bodies.layers", 1, 1, "Layers of the stack."));
        keys.push_back(whole("bodies.widest", 1, 1, "Bodies in the first and every second layer; the others have one less."));
        keys.push_back(whole("bodies.rows", 1, 1, "Spheres behind each other, across the tank."));
        keys.push_back(derived(positive("bodies.centre_x_m", "m", {}, "Middle of the stack."), "a stack needs it"));
        keys.push_back(derived(positive("bodies.centre_y_m", "m", {}, "Middle of a stack of spheres across."), "the tank's middle"));
        keys.push_back(derived(number("bodies.lowest_m", "m", {}, 0.0, "Lowest point of the stack."), "a stack needs it"));
        keys.push_back(number("bodies.clearance_m", "m", 0.0, 0.0, "Between neighbours."));
        keys.push_back(number("bodies.jitter_m", "m", 0.0, 0.0, "Largest random shift of a place; repeats differ in it."));
        keys.push_back(whole("bodies.seed", 1, 0, "Seed of the shifts."));
        Parameter gauge = choice("gauge.name", {}, {}, "Name of a place at which level and pressure are read in every step.");
        gauge.kind = ParameterKind::text;
        keys.push_back(gauge);
        keys.push_back(number("gauge.x_m", "m", {}, 0.0, "Its place along x: the level of the water there."));
        keys.push_back(derived(number("gauge.y_m", "m", {}, 0.0, "Its place across, in space."), "the tank's middle"));
        keys.push_back(derived(number("gauge.z_m", "m", {}, 0.0, "Its height: the pressure there."), "the level alone"));
        keys.push_back(bounded(positive("contact.theta", "-", 0.01, "Overlap under the own weight over the reference length."), 1.0));
        keys.push_back(positive("contact.reference_length_m", "m", 5e-4, "Length of the contact law; not tied to the cells."));
        keys.push_back(number("contact.damping", "-", 0.4, 0.0, "Damping of the contact law, below 0.707."));
        keys.push_back(bounded(number("contact.poisson", "-", 0.3, 0.0, "Poisson's ratio in the tangential stiffness."), 0.5));
        keys.push_back(pair_setting("contact.friction", "friction", 0.3, "Coulomb friction."));
        keys.push_back(choice("contact.shear", "accumulated", {"accumulated", "one_step"}, "What stretches the tangential spring."));
        keys.push_back(derived(number("contact.gap_m", "m", {}, 0.0, "Distance at which surfaces touch; half of it at walls."),
                               "a quarter of a cell"));
        keys.push_back(bounded(
            number("contact.gap_damping", "-", 1.0, 0.0,
                   "beta: share of the relative velocity of the water in a contact's gap that is left after the damping time; 1: off."),
            1.0));
        keys.push_back(derived(positive("contact.gap_damping_time_s", "s", {}, "Time of the gap damping."), "needed with gap damping"));
        keys.push_back(positive("run.end_s", "s", {}, "End of the run."));
        keys.push_back(choice("run.stop_when", "none", {"none", "pipe_empty", "arrival"},
                              "What ends the run earlier: no body higher than the pipe's mouth, or a body at the right wall."));
        keys.push_back(number("run.settle_s", "s", 0.1, 0.0, "The run goes on for so long after that."));
        keys.push_back(bounded(positive("run.max_courant", "-", 0.5, "Courant number of the fastest water."), 1.0));
        keys.push_back(positive("run.write_interval_s", "s", 0.02, "Between pictures and rows of the bodies."));
        keys.push_back(
            bounded(whole("run.write_particles", 1, 0, "Of how many water particles one is written with the pictures; 0: none."), 1e6));
        keys.push_back(positive("run.checkpoint_interval_s", "s", 0.2, "Between checkpoints."));
        for (Parameter& key : keys)
            if (key.key.rfind("contact.", 0) == 0) key.reference = k_reference;
        return keys;
    }();
    return table;
}

}  // namespace cutterflow::free_surface
