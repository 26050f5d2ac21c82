#include <utility>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/head/crown_cutter.hpp"

namespace cutterflow::geometry {
namespace {

constexpr double k_pick_length = 0.08;  // over the ring radius
constexpr double k_pick_width = 0.07;

Parameter length(std::string key, std::string help) {
    Parameter parameter;
    parameter.key = std::move(key);
    parameter.unit = "m";
    parameter.minimum = 0.0;
    parameter.minimum_excluded = true;
    parameter.help = std::move(help);
    return parameter;
}

Parameter number(std::string key, std::string unit, double minimum, double maximum, std::string help) {
    Parameter parameter;
    parameter.key = std::move(key);
    parameter.unit = std::move(unit);
    parameter.minimum = minimum;
    parameter.maximum = maximum;
    parameter.help = std::move(help);
    return parameter;
}

Parameter count(std::string key, double minimum, double maximum, std::string help) {
    Parameter parameter = number(std::move(key), "-", minimum, maximum, std::move(help));
    parameter.kind = ParameterKind::integer;
    return parameter;
}

Parameter with_default(Parameter parameter, ParameterValue value) {
    parameter.default_value = std::move(value);
    return parameter;
}

Parameter derived(Parameter parameter, std::string rule) {
    parameter.optional = true;
    parameter.derived_from = std::move(rule);
    return parameter;
}

ParameterTable make_table() {
    return {
        length("ring.radius_m", "Outer radius of the ring."),
        length("ring.inner_radius_m", "Inner radius of the ring."),
        length("ring.height_m", "Height of the ring along the axis; its top face is the ring plane z = 0."),
        length("hub.radius_m", "Radius of the hub."),
        length("hub.depth_m", "Distance of the hub's lower rim from the ring plane."),
        length("hub.height_m", "Height of the hub's cylinder above its lower rim."),
        length("hub.cap_height_m", "Height of the spherical cap below the lower rim; the head's height is depth plus cap."),
        derived(length("shaft.radius_m", "Radius, in the ring plane, of the shaft or cone from there to the hub."), "no shaft"),
        derived(length("shaft.radius_at_hub_m", "The same at the hub; linear in between."), "shaft.radius_m"),
        count("blades.count", 2, 12, "Number of blades."),
        number("blades.wrap_deg", "deg", -120.0, 120.0,
               "Azimuth by which a blade's hub end leads its ring end, right-handed about hub-to-ring. Positive: positive rotation carries "
               "rock "
               "towards the suction side; negative: the mirrored head."),
        number("blades.rake_deg", "deg", -45.0, 45.0,
               "Angle between blade and radius; positive when the outer edge leads in the carrying sense of rotation."),
        length("blades.thickness_m", "Thickness of the blades at the ring, normal to their surface."),
        derived(length("blades.thickness_at_hub_m", "The same at the hub; linear in between."), "blades.thickness_m"),
        length("blades.depth_at_ring_m", "Width of a blade from its outer edge inwards, at the ring."),
        length("blades.depth_at_hub_m", "The same at the hub; linear in between."),
        number("blades.contour_exponent", "-", 1.0, 6.0,
               "Shape of the outer contour between ring and hub: 1 is a cone, 2 an ellipse, larger is fuller."),
        with_default(count("picks.per_blade", 0, 60, "Number of picks on the outer edge of each blade; 0 leaves them off."),
                     std::int64_t{0}),
        derived(length("picks.length_m", "Length of a pick beyond the blade's edge."), "0.08 ring.radius_m"),
        derived(length("picks.width_m", "Width of a pick's square base; its tip is half as wide."), "0.07 ring.radius_m"),
        with_default(number("picks.lean_deg", "deg", -60.0, 60.0,
                            "Angle by which picks lean from straight out of the head towards the carrying sense of rotation."),
                     20.0),
        length("surface.edge_length_m", "Edge length of the surface's triangles."),
    };
}

double radians(double degrees) {
    return degrees * k_pi / 180.0;
}

}  // namespace

const ParameterTable& crown_parameter_table() {
    static const ParameterTable table = make_table();
    return table;
}

std::string crown_manual_page() {
    return "# The file of a parametric crown cutter\n\n"
           "<!-- Made from the table in geometry/head/crown_parameters.cpp: build the target update_manual instead of editing this page. "
           "-->\n\n"
           "`cutterflow generate-cutter crown.toml -o cutter.stl` makes a watertight crown cutter, in metres, from these sizes: a ring, a "
           "hub,\n"
           "helical blades between them and, with `shaft.radius_m`, a shaft or cone, with picks on the blades' outer edges when "
           "`picks.per_blade` is above 0. The ring's top face is z "
           "= 0 and\n"
           "the head lies below it. `cases/examples/model_cutter/crown.toml` is an example.\n\n"
           "Solids of known volume for cases with a known answer come from `cutterflow generate-solid pipe`, `box` and `funnel`; "
           "`generate-solid\n"
           "backplate` writes a backplate with suction mouth and pipe as a study puts it behind a head. Sizes are options (`--help`).\n" +
           parameters_markdown(crown_parameter_table());
}

CrownParameters read_crown_parameters(const std::filesystem::path& file) {
    const ParameterValues values = read_parameters(crown_parameter_table(), file);
    if (values.has("shaft.radius_at_hub_m") && !values.has("shaft.radius_m"))
        throw UserError({{file.string(), "shaft.radius_at_hub_m without shaft.radius_m", "A shaft has a radius at its upper end, too",
                          "Give shaft.radius_m, or remove the key"}});
    CrownParameters p;
    p.ring_radius = values.number("ring.radius_m");
    p.ring_inner_radius = values.number("ring.inner_radius_m");
    p.ring_height = values.number("ring.height_m");
    p.hub_radius = values.number("hub.radius_m");
    p.hub_depth = values.number("hub.depth_m");
    p.hub_height = values.number("hub.height_m");
    p.hub_cap_height = values.number("hub.cap_height_m");
    if (values.has("shaft.radius_m")) {
        p.shaft_radius = values.number("shaft.radius_m");
        p.shaft_radius_at_hub = values.number(values.has("shaft.radius_at_hub_m") ? "shaft.radius_at_hub_m" : "shaft.radius_m");
    }
    p.blade_count = static_cast<int>(values.integer("blades.count"));
    p.blade_wrap = radians(values.number("blades.wrap_deg"));
    p.blade_rake = radians(values.number("blades.rake_deg"));
    p.blade_thickness = values.number("blades.thickness_m");
    p.blade_thickness_at_hub = values.number(values.has("blades.thickness_at_hub_m") ? "blades.thickness_at_hub_m" : "blades.thickness_m");
    p.blade_depth_at_ring = values.number("blades.depth_at_ring_m");
    p.blade_depth_at_hub = values.number("blades.depth_at_hub_m");
    p.contour_exponent = values.number("blades.contour_exponent");
    p.picks_per_blade = static_cast<int>(values.integer("picks.per_blade"));
    p.pick_length = values.has("picks.length_m") ? values.number("picks.length_m") : k_pick_length * p.ring_radius;
    p.pick_width = values.has("picks.width_m") ? values.number("picks.width_m") : k_pick_width * p.ring_radius;
    p.pick_lean = radians(values.number("picks.lean_deg"));
    p.edge_length = values.number("surface.edge_length_m");
    return p;
}

}  // namespace cutterflow::geometry
