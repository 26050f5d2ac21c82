#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/parameters/parameter_words.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/surface/soundness.hpp"
#include "solver/free_surface/scene_file/scene_file_reading.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr double k_thinnest_wall = 2.0;  // cells
constexpr int k_places_along_box = 16;
constexpr int k_lines_of_gate = 16;  // along which solids are looked for in its way

double required(SceneFileReading& reading, const ParameterValues& solid, const std::string& key) {
    if (solid.has(key)) return solid.number(key);
    reading.refuse(solid.where("solid.kind"), fmt::format("{} is missing for a {}", key, solid.text("solid.kind")), "This kind needs it",
                   "Add it");
    return 1.0;
}

double wall_of(SceneFileReading& reading, const ParameterValues& solid) {
    const double wall = required(reading, solid, "solid.wall_m");
    if (wall < (k_thinnest_wall - 1e-6) * reading.cell())
        reading.refuse(
            solid.where("solid.wall_m"), fmt::format("solid.wall_m = {:g} m", wall),
            fmt::format("Walls are at least two cells thick ({:g} m), else water on both sides shares cells", 2.0 * reading.cell()),
            "Use smaller cells or a thicker wall");
    return wall;
}

void add_box(SceneFileReading& reading, double from_x, double from_z, double to_x, double to_z) {
    reading.scene.settings.solids.emplace_back(SolidBox{Vec3(from_x, -k_far, from_z), Vec3(to_x, k_far, to_z)});
}

/// Keys of other kinds. A study that is written out in full has their defaults.
void refuse_other_keys(SceneFileReading& reading, const ParameterValues& solid) {
    const std::string& kind = solid.text("solid.kind");
    const auto is_kind = [&](const SolidKind& one) { return kind == one.name; };
    const std::vector<std::string>& keys = std::find_if(solid_kinds().begin(), solid_kinds().end(), is_kind)->keys;
    for (const Parameter& row : scene_table()) {
        const ParameterValue* value = solid.find(row.key);
        const auto is_it = [&](const std::string& key) { return row.key == "solid." + key; };
        if (is_it("kind") || value == nullptr || *value == row.default_value || std::any_of(keys.begin(), keys.end(), is_it)) continue;
        reading.refuse(solid.where(row.key), fmt::format("{} = {} for a {}", row.key, toml_text(*value), kind),
                       fmt::format("A {} has {}", kind, parameter_words::join(keys, ", ")), "Remove it");
    }
}

void require_top_above_bottom(SceneFileReading& reading, const ParameterValues& solid, double bottom, double top) {
    if (top <= bottom)
        reading.refuse(solid.where("solid.top_m"), fmt::format("solid.top_m = {:g} m lies below solid.bottom_m = {:g} m", top, bottom),
                       "The top is above", "Exchange them");
}

/// Cylinders are looked at in the middle of the tank alone. \param across  where the solid is
void require_span_beside_cylinders(SceneFileReading& reading, const ParameterValues& solid, const Interval& across) {
    const std::vector<ParameterValues>& bodies = reading.values.tables("bodies");
    const auto is_cylinder = [](const ParameterValues& table) { return table.text("bodies.shape") == "cylinder"; };
    if (reading.plane() || std::none_of(bodies.begin(), bodies.end(), is_cylinder)) return;
    if (across.from <= k_tolerance && across.to >= reading.depth() - k_tolerance) return;
    reading.refuse(solid.where("solid.kind"),
                   fmt::format("A {} from {:g} to {:g} m across beside cylinders", solid.text("solid.kind"), std::max(0.0, across.from),
                               std::min(reading.depth(), across.to)),
                   fmt::format("Cylinders reach across the whole tank of {:g} m, and so do the solids beside them", reading.depth()),
                   "Let it reach across, or set bodies.shape = \"sphere\"");
}

/// A closed surface of a file, in metres.
void read_surface(SceneFileReading& reading, const ParameterValues& solid) {
    const std::string where = solid.where("solid.kind");
    if (reading.plane())
        return reading.refuse(where, "A surface in a plane scene", "Surfaces stand in space",
                              "Set domain.dimensions = \"space\", or build it of boxes and plates");
    if (!solid.has("solid.file")) return reading.refuse(where, "solid.file is missing for a surface", "This kind needs it", "Add it");
    const std::filesystem::path file = reading.folder / solid.text("solid.file");
    try {
        geometry::TriangleSurface surface = geometry::read_surface(file);
        const geometry::SoundnessReport report = geometry::inspect_surface(surface);
        geometry::require_sound(report, file.string());
        if ((report.bounds.min.array() >= Vec3(reading.width(), reading.scene.settings.tank.depth, reading.height()).array()).any() ||
            (report.bounds.max.array() <= 0.0).any())
            return reading.refuse(where,
                                  fmt::format("{} lies outside the domain of {:g} x {:g} x {:g} m", file.string(), reading.width(),
                                              reading.scene.settings.tank.depth, reading.height()),
                                  "Its coordinates are those of the scene, in metres", "Move or scale it");
        require_span_beside_cylinders(reading, solid, {report.bounds.min.y(), report.bounds.max.y()});
        reading.scene.settings.solids.emplace_back(SolidSurface{std::make_shared<const ClosedSurface>(std::move(surface))});
    } catch (const UserError& error) {
        reading.mistakes.insert(reading.mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
}

/// Two walls, cut by holes at equal distances from the bottom up.
void read_pipe(SceneFileReading& reading, const ParameterValues& solid) {
    const double axis = required(reading, solid, "solid.axis_x_m"), half = 0.5 * required(reading, solid, "solid.inner_width_m"),
                 wall = wall_of(reading, solid);
    const double bottom = required(reading, solid, "solid.bottom_m"), top = required(reading, solid, "solid.top_m");
    const double hole = solid.number("solid.hole_m");
    if (hole > 0.0 && hole < (1.0 - 1e-6) * reading.cell())
        reading.refuse(solid.where("solid.hole_m"), fmt::format("solid.hole_m = {:g} m", hole),
                       fmt::format("A hole narrower than a cell ({:g} m) would close", reading.cell()),
                       fmt::format("Use cells of {:g} m", hole));
    require_top_above_bottom(reading, solid, bottom, top);
    if (solid.has("solid.bottom_m") && bottom >= reading.height())
        reading.refuse(solid.where("solid.bottom_m"), fmt::format("solid.bottom_m = {:g} m lies above the domain", bottom),
                       fmt::format("The domain reaches to {:g} m", reading.height()), "Lower the pipe");
    if (!reading.scene.pipe) reading.scene.pipe = PipeGauge{axis, 2.0 * half, wall, bottom, top};
    const double spacing = hole > 0.0 ? required(reading, solid, "solid.hole_spacing_m") : k_far;
    if (spacing < hole + (1.0 - 1e-6) * reading.cell())
        reading.refuse(solid.where("solid.hole_spacing_m"), fmt::format("solid.hole_spacing_m = {:g} m", spacing),
                       fmt::format("Between holes of {:g} m there is at least a cell of wall", hole),
                       fmt::format("Use {:g} m or more", hole + reading.cell()));
    if (axis - half - wall < -k_tolerance || axis + half + wall > reading.width() + k_tolerance)
        reading.refuse(solid.where("solid.axis_x_m"),
                       fmt::format("A pipe from {:g} to {:g} m leaves the domain", axis - half - wall, axis + half + wall),
                       fmt::format("The domain reaches to {:g} m", reading.width()), "Move the pipe");
    if (!reading.mistakes.empty()) return;
    for (const double side : {-1.0, 1.0}) {
        const double near = axis + side * half, far = axis + side * (half + wall);
        double from = bottom;
        const auto add_wall = [&](double to) {
            add_box(reading, std::min(near, far), from, std::max(near, far), to);
            reading.scene.settings.watched_walls.push_back({0.5 * (near + far), from, to});
        };
        for (double centre = bottom + spacing; centre + 0.5 * hole < top; centre += spacing) {
            add_wall(centre - 0.5 * hole);
            from = centre + 0.5 * hole;
        }
        add_wall(top);
    }
}

Interval thickness_of_gate(const ParameterValues& solid) {
    const double axis = solid.number("solid.axis_x_m"), half = 0.5 * solid.number("solid.wall_m");
    return {axis - half, axis + half};
}

/// A wall; one with a speed leaves the tank by its top.
void read_gate(SceneFileReading& reading, const ParameterValues& solid) {
    const std::size_t before = reading.mistakes.size();
    required(reading, solid, "solid.axis_x_m");
    wall_of(reading, solid);
    const double bottom = required(reading, solid, "solid.bottom_m"), top = required(reading, solid, "solid.top_m");
    const double speed = required(reading, solid, "solid.speed_m_s"), start = solid.number("solid.start_s");
    require_top_above_bottom(reading, solid, bottom, top);
    if (reading.mistakes.size() > before) return;
    const Interval across = thickness_of_gate(solid);
    if (across.from < 0.0 || across.to > reading.width() || bottom >= reading.height())
        return reading.refuse(solid.where("solid.axis_x_m"),
                              fmt::format("A gate from {:g} to {:g} m leaves the domain", across.from, across.to),
                              fmt::format("The domain reaches to {:g} m x {:g} m", reading.width(), reading.height()), "Move the gate");
    if (speed == 0.0) return add_box(reading, across.from, bottom, across.to, top);
    const SolidBox box{Vec3(across.from, -k_far, bottom), Vec3(across.to, k_far, top)};
    reading.scene.settings.gates.push_back({box, speed, start, start + (reading.height() - bottom) / speed});
}

/// Two oblique plates from the given width upwards, their thickness outside.
void read_funnel(SceneFileReading& reading, const ParameterValues& solid) {
    const double axis = required(reading, solid, "solid.axis_x_m"), half = 0.5 * required(reading, solid, "solid.inner_width_m"),
                 wall = wall_of(reading, solid);
    const double bottom = required(reading, solid, "solid.bottom_m"), length = required(reading, solid, "solid.wall_length_m");
    const double angle = solid.number("solid.angle_deg") * k_pi / 180.0;
    const Eigen::Vector2d way(length * std::cos(angle), length * std::sin(angle));
    const Eigen::Vector2d right(axis + half, bottom), left(axis - half, bottom);
    reading.scene.settings.solids.emplace_back(plate(right + way, right, wall));
    reading.scene.settings.solids.emplace_back(plate(left, left + Eigen::Vector2d(-way.x(), way.y()), wall));
}

/// Its lower corner comes first, and a part of it stands in the tank.
void read_box(SceneFileReading& reading, const ParameterValues& solid) {
    const std::size_t before = reading.mistakes.size();
    const Interval y = reading.across(solid, "solid.from_y_m", "solid.to_y_m");
    const Vec3 from(required(reading, solid, "solid.from_x_m"), y.from, required(reading, solid, "solid.from_z_m"));
    const Vec3 to(required(reading, solid, "solid.to_x_m"), y.to, required(reading, solid, "solid.to_z_m"));
    if (reading.mistakes.size() > before) return;
    const auto shown = [&](const Vec3& corner) {  // an end that is not given is the tank's
        return reading.text_of(Vec3(corner.x(),
                                    std::abs(corner.y()) < k_far ? corner.y()
                                    : corner.y() < 0.0           ? 0.0
                                                                 : reading.depth(),
                                    corner.z()));
    };
    const std::string box = fmt::format("A box from {} to {}", shown(from), shown(to));
    if (from.x() >= to.x() || from.z() >= to.z())
        return reading.refuse(solid.where("solid.kind"), box, "Its lower corner must come first", "Exchange the corners");
    if ((to.array() <= 0.0).any() || (from.array() >= Vec3(reading.width(), reading.depth(), reading.height()).array()).any())
        return reading.refuse(solid.where("solid.kind"), box + " stands outside the domain",
                              fmt::format("The domain is {}", reading.text_of_domain()), "Move or remove it");
    require_span_beside_cylinders(reading, solid, y);
    reading.scene.settings.solids.emplace_back(SolidBox{from, to});
}

/// One side of it runs from one end to the other.
void read_plate(SceneFileReading& reading, const ParameterValues& solid) {
    const std::size_t before = reading.mistakes.size();
    const Eigen::Vector2d from(required(reading, solid, "solid.from_x_m"), required(reading, solid, "solid.from_z_m"));
    const Eigen::Vector2d to(required(reading, solid, "solid.to_x_m"), required(reading, solid, "solid.to_z_m"));
    const double wall = wall_of(reading, solid);
    if (reading.mistakes.size() > before) return;
    if ((to - from).norm() < (1.0 - 1e-6) * reading.cell())
        return reading.refuse(solid.where("solid.kind"),
                              fmt::format("A plate from ({:g}, {:g}) to ({:g}, {:g}) m", from.x(), from.y(), to.x(), to.y()),
                              fmt::format("It is at least a cell long ({:g} m)", reading.cell()), "Move one of its ends");
    reading.scene.settings.solids.emplace_back(plate(from, to, wall));
}

void read_solid(SceneFileReading& reading, const ParameterValues& solid) {
    const std::string& kind = solid.text("solid.kind");
    refuse_other_keys(reading, solid);
    if (kind == "box") {
        read_box(reading, solid);
    } else if (kind == "surface") {
        read_surface(reading, solid);
    } else if (kind == "plate") {
        read_plate(reading, solid);
    } else if (kind == "pipe") {
        read_pipe(reading, solid);
    } else if (kind == "gate") {
        read_gate(reading, solid);
    } else {
        read_funnel(reading, solid);
    }
}

/// Whether water can stand at a place of the tank.
bool is_open(const SceneFileReading& reading, const Vec3& place) {
    if ((place.array() <= 0.0).any() || (place.array() >= Vec3(reading.width(), reading.depth(), reading.height()).array()).any())
        return false;
    const auto& solids = reading.scene.settings.solids;
    return std::none_of(solids.begin(), solids.end(), [&](const StillSolid& solid) { return is_inside(solid, place); });
}

/// A box is a wall where water can stand on both sides of it: there it is at least two cells thick.
void require_thick_box(SceneFileReading& reading, const ParameterValues& solid) {
    if (solid.text("solid.kind") != "box" || !reading.mistakes.empty()) return;
    const Interval y = reading.across(solid, "solid.from_y_m", "solid.to_y_m");
    const Vec3 tank(reading.width(), reading.depth(), reading.height());
    const Vec3 from = Vec3(solid.number("solid.from_x_m"), y.from, solid.number("solid.from_z_m")).cwiseMax(0.0);
    const Vec3 to = Vec3(solid.number("solid.to_x_m"), y.to, solid.number("solid.to_z_m")).cwiseMin(tank);
    for (const int d : {0, 1, 2}) {
        const double thickness = to[d] - from[d], beside = 0.5 * reading.cell();
        if (thickness >= (k_thinnest_wall - 1e-6) * reading.cell()) continue;
        const int e = d == 0 ? 2 : 0, g = 3 - d - e;
        for (int n = 0; n < k_places_along_box * k_places_along_box; ++n) {
            Vec3 place = Vec3::Zero();
            place[e] = from[e] + (to[e] - from[e]) * (n % k_places_along_box + 0.5) / k_places_along_box;
            place[g] = from[g] + (to[g] - from[g]) * (n / k_places_along_box + 0.5) / k_places_along_box;
            place[d] = from[d] - beside;
            Vec3 opposite = place;
            opposite[d] = to[d] + beside;
            if (!is_open(reading, place) || !is_open(reading, opposite)) continue;
            return reading.refuse(solid.where("solid.kind"),
                                  fmt::format("A box is {:g} m thick between water at {} and {}", thickness, reading.text_of(place),
                                              reading.text_of(opposite)),
                                  fmt::format("Walls are at least two cells thick ({:g} m), else water on both sides shares cells",
                                              k_thinnest_wall * reading.cell()),
                                  "Use smaller cells or a thicker box");
        }
    }
}

/// Where a solid stands in the way of a gate; none: nowhere. Looked for along lines upwards, in the middle of every cell across.
std::optional<Vec3> in_way(const SceneFileReading& reading, const StillSolid& solid, const Interval& thickness, const Interval& way) {
    const TankSettings& tank = reading.scene.settings.tank;
    for (int j = 0; j < tank.cells[1]; ++j) {
        for (int n = 0; n <= k_lines_of_gate; ++n) {
            const double x = thickness.from + (k_tolerance + (thickness.length() - 2.0 * k_tolerance) * n / k_lines_of_gate);
            const double y = (j + 0.5) * tank.depth / tank.cells[1];
            for (const Interval& part : covered_parts(solid, {2, Vec3(x, y, 0.0)}))
                if (common(part, way).length() > k_tolerance) return Vec3(x, y, common(part, way).from);
        }
    }
    return std::nullopt;
}

/// A gate must not meet what stands still, nor another gate, on its way. \param number  of the gate
void require_free_way(SceneFileReading& reading, const ParameterValues& solid, std::size_t number) {
    const Interval across = thickness_of_gate(solid), way{solid.number("solid.bottom_m"), reading.height()};
    std::vector<StillSolid> others = reading.scene.settings.solids;
    const std::vector<Gate>& gates = reading.scene.settings.gates;
    for (std::size_t n = 0; n < gates.size(); ++n)
        if (n != number) others.emplace_back(gates[n].closed);
    for (const StillSolid& other : others) {
        const std::optional<Vec3> met = in_way(reading, other, across, way);
        if (!met) continue;
        return reading.refuse(solid.where("solid.kind"),
                              fmt::format("The gate at {:g} m meets a solid at {}", solid.number("solid.axis_x_m"), reading.text_of(*met)),
                              "Its way up is free", "Move the gate or the solid");
    }
}

}  // namespace

void read_solids(SceneFileReading& reading) {
    const std::vector<ParameterValues>& solids = reading.values.tables("solid");
    for (const ParameterValues& solid : solids) read_solid(reading, solid);
    for (const ParameterValues& solid : solids) require_thick_box(reading, solid);
    if (!reading.mistakes.empty()) return;
    std::size_t gate = 0;
    for (const ParameterValues& solid : solids)
        if (solid.text("solid.kind") == "gate" && solid.number("solid.speed_m_s") > 0.0) require_free_way(reading, solid, gate++);
}

}  // namespace cutterflow::free_surface
