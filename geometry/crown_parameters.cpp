#include <utility>

#include "geometry/base/axis_frame.hpp"
#include "geometry/crown_cutter.hpp"

namespace cutterflow {
namespace {

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

Parameter blade_count() {
    Parameter parameter = number("blades.count", "-", 2, 12, "Number of blades.");
    parameter.kind = ParameterKind::integer;
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
        blade_count(),
        number("blades.wrap_deg", "deg", -120.0, 120.0,
               "Azimuth by which a blade's hub end leads its ring end, right-handed about hub-to-ring. Positive: positive rotation carries "
               "rock "
               "towards the suction side; negative: the mirrored head."),
        number("blades.rake_deg", "deg", -45.0, 45.0,
               "Angle between blade and radius; positive when the outer edge leads in the carrying sense of rotation."),
        length("blades.thickness_m", "Thickness of the blades, normal to their surface."),
        length("blades.depth_at_ring_m", "Width of a blade from its outer edge inwards, at the ring."),
        length("blades.depth_at_hub_m", "The same at the hub; linear in between."),
        number("blades.contour_exponent", "-", 1.0, 6.0,
               "Shape of the outer contour between ring and hub: 1 is a cone, 2 an ellipse, larger is fuller."),
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

CrownParameters read_crown_parameters(const std::filesystem::path& file) {
    const ParameterValues values = read_parameters(crown_parameter_table(), file);
    CrownParameters p;
    p.ring_radius = values.number("ring.radius_m");
    p.ring_inner_radius = values.number("ring.inner_radius_m");
    p.ring_height = values.number("ring.height_m");
    p.hub_radius = values.number("hub.radius_m");
    p.hub_depth = values.number("hub.depth_m");
    p.hub_height = values.number("hub.height_m");
    p.hub_cap_height = values.number("hub.cap_height_m");
    p.blade_count = static_cast<int>(values.integer("blades.count"));
    p.blade_wrap = radians(values.number("blades.wrap_deg"));
    p.blade_rake = radians(values.number("blades.rake_deg"));
    p.blade_thickness = values.number("blades.thickness_m");
    p.blade_depth_at_ring = values.number("blades.depth_at_ring_m");
    p.blade_depth_at_hub = values.number("blades.depth_at_hub_m");
    p.contour_exponent = values.number("blades.contour_exponent");
    p.edge_length = values.number("surface.edge_length_m");
    return p;
}

}  // namespace cutterflow
