#include "cases/scenes/room/solid_generators.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "cases/scenes/room/vec3_of.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/parameters/parameter_row.hpp"
#include "geometry/surface/simple_solids.hpp"

namespace cutterflow::cases {

namespace {

double size_of(const ParameterValues& solid, const char* name) {
    return solid.number(std::string("solid.") + name);
}

Vec3 place_of(const ParameterValues& solid, const char* name) {
    return vec3_of(solid, std::string("solid.") + name);
}

/// 0 when the key is absent.
double size_or_zero(const ParameterValues& solid, const char* name) {
    return solid.has(std::string("solid.") + name) ? size_of(solid, name) : 0.0;
}

geometry::TriangleSurface moved(const geometry::TriangleSurface& surface, const Vec3& to) {
    return geometry::transformed(surface, Eigen::Affine3d(Eigen::Translation3d(to)));
}

GeneratedSolid box(const ParameterValues& solid) {
    const Vec3 lower = place_of(solid, "lower_m"), upper = place_of(solid, "upper_m");
    return {geometry::generate_block(lower, upper), (upper - lower).minCoeff(), {}, {}};
}

GeneratedSolid plate(const ParameterValues& solid) {
    const Vec3 size(size_of(solid, "length_m"), size_of(solid, "width_m"), size_of(solid, "thickness_m"));
    const double tilt = size_or_zero(solid, "tilt_deg") * k_pi / 180.0, turn = size_or_zero(solid, "turn_deg") * k_pi / 180.0;
    const Eigen::Affine3d to_place = Eigen::Translation3d(place_of(solid, "centre_m")) * Eigen::AngleAxisd(turn, Vec3::UnitZ()) *
                                     Eigen::AngleAxisd(tilt, Vec3::UnitY()) * Eigen::Translation3d(0.0, 0.0, -size.z());
    return {geometry::transformed(geometry::generate_box(size, size.maxCoeff()), to_place), size.minCoeff(), {}, {}};
}

GeneratedSolid pipe(const ParameterValues& solid) {
    const Vec3 from = place_of(solid, "from_m"), to = place_of(solid, "to_m");
    geometry::PipeParameters parameters;
    parameters.inner_radius = size_of(solid, "inner_radius_m");
    parameters.wall = size_of(solid, "wall_m");
    parameters.length = (to - from).norm();
    parameters.edge_length = parameters.length + parameters.inner_radius + parameters.wall;
    const geometry::TriangleSurface upright = geometry::generate_pipe(parameters);
    const Eigen::Affine3d to_place =
        Eigen::Translation3d(from) * Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), (to - from).normalized());
    return {geometry::transformed(upright, to_place), parameters.wall, Bore{from, to, parameters.inner_radius}, {}};
}

GeneratedSolid disc_with_rim(const ParameterValues& solid) {
    const geometry::DishParameters dish{size_of(solid, "radius_m"), size_of(solid, "thickness_m"), size_or_zero(solid, "rim_height_m"),
                                        size_or_zero(solid, "rim_wall_m")};
    return {moved(geometry::generate_dish(dish), place_of(solid, "centre_m")),
            dish.rim_height > 0.0 ? std::min(dish.thickness, dish.rim_wall) : dish.thickness,
            {},
            {}};
}

GeneratedSolid hopper(const ParameterValues& solid) {
    const geometry::BinParameters bin{size_of(solid, "inner_radius_m"), size_of(solid, "height_m"), size_of(solid, "wall_m"),
                                      size_or_zero(solid, "orifice_radius_m")};
    GeneratedSolid made{moved(geometry::generate_bin(bin), place_of(solid, "centre_m")), bin.wall, {}, {}};
    if (bin.orifice_radius > 0.0) made.opening = 2.0 * bin.orifice_radius;
    return made;
}

GeneratedSolid funnel(const ParameterValues& solid) {
    geometry::FunnelParameters parameters;
    parameters.inlet_radius = size_of(solid, "inlet_radius_m");
    parameters.outlet_radius = size_of(solid, "outlet_radius_m");
    parameters.cone_height = size_of(solid, "cone_height_m");
    parameters.spout_length = size_or_zero(solid, "spout_length_m");
    parameters.wall = size_of(solid, "wall_m");
    parameters.edge_length = parameters.cone_height + parameters.inlet_radius + parameters.outlet_radius + parameters.wall;
    return {moved(geometry::generate_funnel(parameters), place_of(solid, "centre_m")), parameters.wall, {}, 2.0 * parameters.outlet_radius};
}

GeneratedSolid slotted_box(const ParameterValues& solid) {
    const geometry::SlottedBoxParameters parameters{{size_of(solid, "width_m"), size_of(solid, "length_m"), size_of(solid, "height_m")},
                                                    size_of(solid, "wall_m"),
                                                    size_of(solid, "slot_m")};
    return {moved(geometry::generate_slotted_box(parameters), place_of(solid, "centre_m")), parameters.wall, {}, parameters.slot};
}

GeneratedSolid wedge_wall(const ParameterValues& solid) {
    const Vec3 from = place_of(solid, "from_m"), to = place_of(solid, "to_m");
    const double height = size_of(solid, "height_m"), wall = size_of(solid, "wall_m");
    if (from.z() != to.z())
        throw UserError("from_m and to_m at different heights", "The foot of a wedge_wall is level", "Give both the same height");
    const Vec3 along = to - from;
    const Vec3 size(along.norm(), wall, height);
    const Eigen::Affine3d to_place =
        Eigen::Translation3d(0.5 * (from + to)) * Eigen::AngleAxisd(std::atan2(along.y(), along.x()), Vec3::UnitZ());
    return {geometry::transformed(geometry::generate_box(size, size.maxCoeff()), to_place), wall, {}, {}};
}

Parameter length(const char* name, const char* help) {
    return ParameterRow(std::string("solid.") + name, ParameterKind::number, "m", help).above(0.0).at_most(1e3).optional().repeated();
}
Parameter place(const char* name, const char* help) {
    return ParameterRow(std::string("solid.") + name, ParameterKind::numbers, "m", help)
        .of_length(3)
        .at_least(-1e3)
        .at_most(1e3)
        .optional()
        .repeated();
}
Parameter angle(const char* name, const char* help) {
    return ParameterRow(std::string("solid.") + name, ParameterKind::number, "deg", help)
        .at_least(-180.0)
        .at_most(180.0)
        .optional()
        .repeated();
}

}  // namespace

const std::vector<SolidGenerator>& solid_generators() {
    static const std::vector<SolidGenerator> table{
        {"box", "A block along the axes between two corners.", {"lower_m", "upper_m"}, {}, box},
        {"plate",
         "A rectangular plate: length along x, width along y; tilted about y (its +x end goes down), then turned about z.",
         {"centre_m", "length_m", "width_m", "thickness_m"},
         {"tilt_deg", "turn_deg"},
         plate},
        {"disc_with_rim",
         "A round plate with a rim around it; centre_m is the middle of its upper face.",
         {"centre_m", "radius_m", "thickness_m"},
         {"rim_height_m", "rim_wall_m"},
         disc_with_rim},
        {"tube", "A round tube, open at both ends.", {"from_m", "to_m", "inner_radius_m", "wall_m"}, {}, pipe},
        {"pipe", "The same as a tube.", {"from_m", "to_m", "inner_radius_m", "wall_m"}, {}, pipe},
        {"ring", "The same as a tube: a short one.", {"from_m", "to_m", "inner_radius_m", "wall_m"}, {}, pipe},
        {"hopper",
         "A flat-bottomed cylindrical bin, open at the top, with an orifice in its floor; centre_m is the middle of the floor's upper "
         "face.",
         {"centre_m", "inner_radius_m", "height_m", "wall_m"},
         {"orifice_radius_m"},
         hopper},
        {"funnel",
         "A cone that narrows to a spout; centre_m is the middle of the spout's lower end.",
         {"centre_m", "inlet_radius_m", "outlet_radius_m", "cone_height_m", "wall_m"},
         {"spout_length_m"},
         funnel},
        {"slotted_box",
         "Two walls and a floor with a slot along y, open at the top and at both ends along y; centre_m is the middle of the floor's upper "
         "face.",
         {"centre_m", "width_m", "length_m", "height_m", "wall_m", "slot_m"},
         {},
         slotted_box},
        {"wedge_wall", "A vertical wall of equal thickness over a level line.", {"from_m", "to_m", "height_m", "wall_m"}, {}, wedge_wall},
    };
    return table;
}

const SolidGenerator* find_solid_generator(const std::string& name) {
    const auto& table = solid_generators();
    const auto found = std::find_if(table.begin(), table.end(), [&](const SolidGenerator& one) { return name == one.name; });
    return found == table.end() ? nullptr : &*found;
}

ParameterTable solid_size_rows() {
    return {place("lower_m", "Lower corner."),
            place("upper_m", "Upper corner."),
            place("centre_m", "Middle of the upper face of a plate, disc or floor; of a funnel the middle of the spout's lower end."),
            place("from_m", "One end of the axis, or of a wall's foot."),
            place("to_m", "The other end."),
            length("length_m", "Along x of a plate, along y of a slotted box."),
            length("width_m", "Along y of a plate, along x of a slotted box (inside)."),
            length("height_m", "Inside."),
            length("thickness_m", "Of a plate or disc."),
            length("radius_m", "Of a disc, inside its rim."),
            length("rim_height_m", "Of a rim above the disc."),
            length("rim_wall_m", "Thickness of a rim."),
            length("inner_radius_m", "Inside."),
            length("wall_m", "Thickness of walls and floor."),
            length("orifice_radius_m", "Of the hole in the floor."),
            length("slot_m", "Width of the slot along x."),
            length("inlet_radius_m", "Inside, at the upper end."),
            length("outlet_radius_m", "Inside, of the spout."),
            length("cone_height_m", "Of the cone above the spout."),
            length("spout_length_m", "Of the spout below the cone."),
            angle("tilt_deg", "Of a plate, about y; positive lowers its +x end."),
            angle("turn_deg", "Of a plate, about z, after the tilt.")};
}

}  // namespace cutterflow::cases
