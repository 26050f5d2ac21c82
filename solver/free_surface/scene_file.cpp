#include "solver/free_surface/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/parameters/parameter_words.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/surface/soundness.hpp"
#include "solver/free_surface/body_list.hpp"
#include "solver/free_surface/cut_cells/close_places.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr double k_far = 1e3;            // [m]: solids reach across the tank
constexpr double k_fewest_cells = 5.0;   // a diameter
constexpr double k_enough_cells = 8.0;   // a diameter
constexpr double k_thinnest_wall = 2.0;  // cells
constexpr double k_smallest_gap = 0.25;  // cells
constexpr double k_tolerance = 1e-9;
constexpr int k_rim_points = 90;  // at which a body is looked for in solids
constexpr int k_rims = 16;        // of a sphere
constexpr int k_places_along_box = 16;
constexpr int k_lines_of_gate = 16;  // along which solids are looked for in its way
constexpr double k_gravity = 9.81;
constexpr double k_most_outputs = 1e4;
constexpr double k_most_bodies = 2e4;  // of a stack; 33 to 1,000 are usual
constexpr double k_most_cells = 5e6;   // of a tank, with k_bytes_per_cell 3 GB; also the bound of a room's mesh
/// Core seconds of a step: of each cell of the tank, each particle with its part of the pressure, each cell of the squares or cubes around
/// the bodies.
struct StepCost {
    double cell, particle, body_cell;
};
// Measured on tanks of 8,000 to 74,360 cells with 7,680 to 137,040 particles and 0 to 33 cylinders,
constexpr StepCost k_plane_cost{3.0e-8, 3.1e-7, 1.0e-6};
// and of 19,200 to 38,400 cells with 36,864 to 129,648 particles and 0 to 4 spheres of eight cells.
constexpr StepCost k_space_cost{5.2e-8, 4.9e-7, 7.5e-6};
constexpr double k_bytes_per_particle = 100.0, k_bytes_per_cell = 600.0, k_bytes_of_program = 5e7;
// The bounds of cutters and rooms.
constexpr double k_densest_water = 2e4, k_densest_body = 3e4;  // [kg/m3]
constexpr double k_most_viscous = 1.0;                         // [m2/s]
constexpr const char* k_reference = "Chen2019";

/// A word of `solid.kind` and the keys of [[solid]] that it has.
struct SolidKind {
    const char* name;
    std::vector<std::string> keys;
};

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

/// The bodies of a scene as they stand at its start.
std::vector<Body> bodies_of(const Scene& scene) {
    std::vector<Body> bodies;
    for (std::size_t n = 0; n < scene.bodies.size(); ++n)
        bodies.push_back(body_of(scene.bodies, n, scene.settings.spheres, scene.settings.tank.depth));
    return bodies;
}

/// A coefficient of two materials in contact, with its bounds.
Parameter pair_setting(const std::string& key, const std::string& key_in_dictionary, double value, const std::string& help) {
    const auto& table = coupling::setting_table<coupling::PairSettings>();
    const auto setting = std::find_if(table.begin(), table.end(), [&](const auto& one) { return one.parameter.key == key_in_dictionary; });
    return bounded(number(key, "-", value, setting->parameter.minimum.value(), help), setting->parameter.maximum.value());
}

/// Reads one scene; collects what is wrong.
class Reader {
public:
    Reader(const ParameterValues& values, std::filesystem::path folder) : values_(values), folder_(std::move(folder)) {}

    Scene read() {
        read_domain();
        read_water();
        for (const ParameterValues& solid : values_.tables("solid")) read_solid(solid);
        for (const ParameterValues& solid : values_.tables("solid")) require_thick_box(solid);
        for (const ParameterValues& solid : values_.tables("solid")) require_free_way(solid);
        for (const ParameterValues& bodies : values_.tables("bodies")) read_bodies(bodies);
        sort_bodies();
        for (const ParameterValues& gauge : values_.tables("gauge")) read_gauge(gauge);
        read_contact();
        read_run();
        if (scene_.settings.water.filled.empty() && scene_.bodies.size() == 0)
            refuse("fill", "The scene has neither water nor bodies", "One of them must be there", "Add [[fill]] or [[bodies]]");
        if (!mistakes_.empty()) throw UserError(std::move(mistakes_));
        find_close_places();
        return std::move(scene_);
    }

private:
    void refuse(const std::string& where, const std::string& what, const std::string& rule, const std::string& remedy) {
        mistakes_.push_back({where, what, rule, remedy});
    }
    double cell() const { return scene_.settings.tank.cell; }
    double width() const { return scene_.settings.tank.cells[0] * cell(); }
    double height() const { return scene_.settings.tank.cells[2] * cell(); }
    double depth() const { return scene_.settings.tank.depth; }
    std::string text_of_domain() const {
        if (plane()) return fmt::format("{:g} m x {:g} m", width(), height());
        return fmt::format("{:g} m x {:g} m x {:g} m", width(), depth(), height());
    }
    bool plane() const { return scene_.settings.tank.plane; }

    /// Keys that a plane scene has no use for.
    void refuse_in_plane(const ParameterValues& table, std::initializer_list<const char*> keys) {
        for (const char* key : keys) {
            if (plane() && table.has(key))
                refuse(table.where(key), fmt::format("{} in a plane scene", key), "A plane scene is the same all the way across",
                       "Remove it, or set domain.dimensions = \"space\"");
        }
    }

    /// From where to where across; the whole tank without the keys.
    Interval across(const ParameterValues& table, const std::string& from, const std::string& to) {
        refuse_in_plane(table, {from.c_str(), to.c_str()});
        const Interval part{table.has(from) ? table.number(from) : -k_far, table.has(to) ? table.number(to) : k_far};
        if (part.length() <= 0.0)
            refuse(table.where(from), fmt::format("{} = {:g} m is not below {} = {:g} m", from, part.from, to, part.to),
                   "The lower end comes first", "Exchange them");
        return part;
    }

    /// Of a tank's edge; a plane tank has one cell across.
    double count_cells(const std::string& key) const { return std::max(4.0, std::round(values_.number(key) / cell())); }

    /// Nothing in the tank is read when this throws: its counts would be as large.
    void require_affordable_cells() const {
        const double cells =
            count_cells("domain.width_m") * (plane() ? 1.0 : count_cells("domain.length_m")) * count_cells("domain.height_m");
        if (cells > k_most_cells)
            throw UserError(
                std::vector<Mistake>{{values_.where("domain.cell_m"), fmt::format("The tank has {:.3g} cells", cells),
                                      fmt::format("It has at most {:g}", k_most_cells), "Make domain.cell_m larger, or the tank smaller"}});
    }

    int whole_cells(const std::string& key) {
        const double length = values_.number(key);
        const int cells = static_cast<int>(count_cells(key));
        if (std::abs(cells * cell() - length) > 1e-6 * length)
            scene_.notes.push_back(fmt::format("{} = {:g} m is no whole number of cells: {:g} m is used", key, length, cells * cell()));
        return cells;
    }

    void find_close_places() {
        for (const ParameterValues& solid : values_.tables("solid")) {
            const double hole = solid.number("solid.hole_m");
            if (solid.text("solid.kind") == "pipe" && hole > 0.0 && hole < (k_close_cells - 1e-6) * cell())
                scene_.close.push_back(
                    fmt::format("closer than two cells: the edges of holes, {:g} m = {:.3g} cells", hole, hole / cell()));
        }
        std::vector<StillSolid> solids = scene_.settings.solids;
        for (const Gate& gate : scene_.settings.gates) solids.emplace_back(gate.closed);
        for (std::string& line : close_places(scene_.settings.tank.grid(), bodies_of(scene_), scene_.bodies.id, solids))
            scene_.close.push_back(std::move(line));
    }

    void read_domain() {
        scene_.name = values_.text("name");
        TankSettings& tank = scene_.settings.tank;
        tank.cell = values_.number("domain.cell_m");
        tank.plane = values_.text("domain.dimensions") == "plane";
        tank.depth = values_.number("domain.length_m");
        require_affordable_cells();
        tank.cells = {whole_cells("domain.width_m"), tank.plane ? 1 : whole_cells("domain.length_m"), whole_cells("domain.height_m")};
        if (!tank.plane) tank.depth = tank.cells[1] * tank.cell;
    }

    void read_water() {
        WaterSettings& water = scene_.settings.water;
        water.density = values_.number("water.density_kg_m3");
        water.kinematic_viscosity = values_.number("water.kinematic_viscosity_m2_s");
        for (const ParameterValues& fill : values_.tables("fill")) {
            const Interval y = across(fill, "fill.from_y_m", "fill.to_y_m");
            const Vec3 from(fill.number("fill.from_x_m"), y.from, fill.number("fill.from_z_m"));
            const Vec3 to(fill.number("fill.to_x_m"), y.to, fill.number("fill.to_z_m"));
            const std::string where = fill.where("fill.from_x_m");
            const std::string box = fmt::format("Water from ({:g}, {:g}) to ({:g}, {:g}) m", from.x(), from.z(), to.x(), to.z());
            if (from.x() >= to.x() || from.z() >= to.z()) refuse(where, box, "Its lower corner must come first", "Exchange the corners");
            // A domain that was rounded down to whole cells may be filled to its given end.
            const double end_x = std::max(width(), values_.number("domain.width_m")) + k_tolerance;
            const double end_z = std::max(height(), values_.number("domain.height_m")) + k_tolerance;
            const double end_y = std::max(depth(), values_.number("domain.length_m")) + k_tolerance;
            if (to.x() > end_x || to.z() > end_z || (fill.has("fill.to_y_m") && to.y() > end_y))
                refuse(where, box, fmt::format("It must lie in the domain of {}", text_of_domain()), "Make it smaller");
            for (const WaterBox& other : water.filled) {
                if ((from.array() < other.to.array() - k_tolerance).all() && (to.array() > other.from.array() + k_tolerance).all())
                    refuse(where, box + " overlaps another box", "Water is filled in once", "Make one of them smaller");
            }
            water.filled.push_back({from, to});
        }
    }

    double required(const ParameterValues& solid, const std::string& key) {
        if (solid.has(key)) return solid.number(key);
        refuse(solid.where("solid.kind"), fmt::format("{} is missing for a {}", key, solid.text("solid.kind")), "This kind needs it",
               "Add it");
        return 1.0;
    }

    double wall_of(const ParameterValues& solid) {
        const double wall = required(solid, "solid.wall_m");
        if (wall < (k_thinnest_wall - 1e-6) * cell())
            refuse(solid.where("solid.wall_m"), fmt::format("solid.wall_m = {:g} m", wall),
                   fmt::format("Walls are at least two cells thick ({:g} m), else water on both sides shares cells", 2.0 * cell()),
                   "Use smaller cells or a thicker wall");
        return wall;
    }

    void add_box(double from_x, double from_z, double to_x, double to_z) {
        scene_.settings.solids.emplace_back(SolidBox{Vec3(from_x, -k_far, from_z), Vec3(to_x, k_far, to_z)});
    }

    /// Keys of other kinds. A study that is written out in full has their defaults.
    void refuse_other_keys(const ParameterValues& solid) {
        const std::string& kind = solid.text("solid.kind");
        const auto is_kind = [&](const SolidKind& one) { return kind == one.name; };
        const std::vector<std::string>& keys = std::find_if(solid_kinds().begin(), solid_kinds().end(), is_kind)->keys;
        for (const Parameter& row : scene_table()) {
            const ParameterValue* value = solid.find(row.key);
            const auto is_it = [&](const std::string& key) { return row.key == "solid." + key; };
            if (is_it("kind") || value == nullptr || *value == row.default_value || std::any_of(keys.begin(), keys.end(), is_it)) continue;
            refuse(solid.where(row.key), fmt::format("{} = {} for a {}", row.key, toml_text(*value), kind),
                   fmt::format("A {} has {}", kind, parameter_words::join(keys, ", ")), "Remove it");
        }
    }

    void require_top_above_bottom(const ParameterValues& solid, double bottom, double top) {
        if (top <= bottom)
            refuse(solid.where("solid.top_m"), fmt::format("solid.top_m = {:g} m lies below solid.bottom_m = {:g} m", top, bottom),
                   "The top is above", "Exchange them");
    }

    void read_solid(const ParameterValues& solid) {
        const std::string& kind = solid.text("solid.kind");
        refuse_other_keys(solid);
        if (kind == "box") {
            const Interval y = across(solid, "solid.from_y_m", "solid.to_y_m");
            const Vec3 from(required(solid, "solid.from_x_m"), y.from, required(solid, "solid.from_z_m"));
            scene_.settings.solids.emplace_back(
                SolidBox{from, Vec3(required(solid, "solid.to_x_m"), y.to, required(solid, "solid.to_z_m"))});
        } else if (kind == "surface") {
            read_surface(solid);
        } else if (kind == "plate") {
            const Eigen::Vector2d from(required(solid, "solid.from_x_m"), required(solid, "solid.from_z_m"));
            const Eigen::Vector2d to(required(solid, "solid.to_x_m"), required(solid, "solid.to_z_m"));
            scene_.settings.solids.emplace_back(plate(from, to, wall_of(solid)));
        } else if (kind == "pipe") {
            read_pipe(solid);
        } else if (kind == "gate") {
            read_gate(solid);
        } else {
            read_funnel(solid);
        }
    }

    /// Whether water can stand at a place of the tank.
    bool is_open(const Vec3& place) const {
        if ((place.array() <= 0.0).any() || (place.array() >= Vec3(width(), depth(), height()).array()).any()) return false;
        const auto& solids = scene_.settings.solids;
        return std::none_of(solids.begin(), solids.end(), [&](const StillSolid& solid) { return is_inside(solid, place); });
    }

    /// A box is a wall where water can stand on both sides of it: there it is at least two cells thick.
    void require_thick_box(const ParameterValues& solid) {
        if (solid.text("solid.kind") != "box" || !mistakes_.empty()) return;
        const Interval y = across(solid, "solid.from_y_m", "solid.to_y_m");
        const Vec3 tank(width(), depth(), height());
        const Vec3 from = Vec3(solid.number("solid.from_x_m"), y.from, solid.number("solid.from_z_m")).cwiseMax(0.0);
        const Vec3 to = Vec3(solid.number("solid.to_x_m"), y.to, solid.number("solid.to_z_m")).cwiseMin(tank);
        if ((to.array() <= from.array()).any()) return;  // outside the tank
        for (const int d : {0, 1, 2}) {
            const double thickness = to[d] - from[d], beside = 0.5 * cell();
            if (thickness >= (k_thinnest_wall - 1e-6) * cell()) continue;
            const int e = d == 0 ? 2 : 0, g = 3 - d - e;
            for (int n = 0; n < k_places_along_box * k_places_along_box; ++n) {
                Vec3 place = Vec3::Zero();
                place[e] = from[e] + (to[e] - from[e]) * (n % k_places_along_box + 0.5) / k_places_along_box;
                place[g] = from[g] + (to[g] - from[g]) * (n / k_places_along_box + 0.5) / k_places_along_box;
                place[d] = from[d] - beside;
                Vec3 opposite = place;
                opposite[d] = to[d] + beside;
                if (!is_open(place) || !is_open(opposite)) continue;
                return refuse(solid.where("solid.kind"),
                              fmt::format("A box is {:g} m thick between water at {} and {}", thickness, text_of(place), text_of(opposite)),
                              fmt::format("Walls are at least two cells thick ({:g} m), else water on both sides shares cells",
                                          k_thinnest_wall * cell()),
                              "Use smaller cells or a thicker box");
            }
        }
    }

    /// A closed surface of a file, in metres.
    void read_surface(const ParameterValues& solid) {
        const std::string where = solid.where("solid.kind");
        if (plane())
            return refuse(where, "A surface in a plane scene", "Surfaces stand in space",
                          "Set domain.dimensions = \"space\", or build it of boxes and plates");
        if (!solid.has("solid.file")) return refuse(where, "solid.file is missing for a surface", "This kind needs it", "Add it");
        const std::filesystem::path file = folder_ / solid.text("solid.file");
        try {
            geometry::TriangleSurface surface = geometry::read_surface(file);
            const geometry::SoundnessReport report = geometry::inspect_surface(surface);
            geometry::require_sound(report, file.string());
            if ((report.bounds.min.array() >= Vec3(width(), scene_.settings.tank.depth, height()).array()).any() ||
                (report.bounds.max.array() <= 0.0).any())
                return refuse(where,
                              fmt::format("{} lies outside the domain of {:g} x {:g} x {:g} m", file.string(), width(),
                                          scene_.settings.tank.depth, height()),
                              "Its coordinates are those of the scene, in metres", "Move or scale it");
            scene_.settings.solids.emplace_back(SolidSurface{std::make_shared<const ClosedSurface>(std::move(surface))});
            scene_.surfaces.push_back(file);
        } catch (const UserError& error) {
            mistakes_.insert(mistakes_.end(), error.mistakes().begin(), error.mistakes().end());
        }
    }

    /// Two walls, cut by holes at equal distances from the bottom up.
    void read_pipe(const ParameterValues& solid) {
        const double axis = required(solid, "solid.axis_x_m"), half = 0.5 * required(solid, "solid.inner_width_m"), wall = wall_of(solid);
        const double bottom = required(solid, "solid.bottom_m"), top = required(solid, "solid.top_m");
        const double hole = solid.number("solid.hole_m");
        if (hole > 0.0 && hole < (1.0 - 1e-6) * cell())
            refuse(solid.where("solid.hole_m"), fmt::format("solid.hole_m = {:g} m", hole),
                   fmt::format("A hole narrower than a cell ({:g} m) would close", cell()), fmt::format("Use cells of {:g} m", hole));
        require_top_above_bottom(solid, bottom, top);
        if (!scene_.pipe) scene_.pipe = PipeGauge{axis, 2.0 * half, wall, bottom, top};
        const double spacing = hole > 0.0 ? required(solid, "solid.hole_spacing_m") : k_far;
        if (spacing < hole + (1.0 - 1e-6) * cell())
            refuse(solid.where("solid.hole_spacing_m"), fmt::format("solid.hole_spacing_m = {:g} m", spacing),
                   fmt::format("Between holes of {:g} m there is at least a cell of wall", hole),
                   fmt::format("Use {:g} m or more", hole + cell()));
        if (axis - half - wall < -k_tolerance || axis + half + wall > width() + k_tolerance)
            refuse(solid.where("solid.axis_x_m"),
                   fmt::format("A pipe from {:g} to {:g} m leaves the domain", axis - half - wall, axis + half + wall),
                   fmt::format("The domain reaches to {:g} m", width()), "Move the pipe");
        if (!mistakes_.empty()) return;
        for (const double side : {-1.0, 1.0}) {
            const double near = axis + side * half, far = axis + side * (half + wall);
            double from = bottom;
            const auto add_wall = [&](double to) {
                add_box(std::min(near, far), from, std::max(near, far), to);
                scene_.settings.watched_walls.push_back({0.5 * (near + far), from, to});
            };
            for (double centre = bottom + spacing; centre + 0.5 * hole < top; centre += spacing) {
                add_wall(centre - 0.5 * hole);
                from = centre + 0.5 * hole;
            }
            add_wall(top);
        }
    }

    static Interval thickness_of_gate(const ParameterValues& solid) {
        const double axis = solid.number("solid.axis_x_m"), half = 0.5 * solid.number("solid.wall_m");
        return {axis - half, axis + half};
    }

    /// A wall; one with a speed leaves the tank by its top.
    void read_gate(const ParameterValues& solid) {
        const std::size_t before = mistakes_.size();
        required(solid, "solid.axis_x_m");
        wall_of(solid);
        const double bottom = required(solid, "solid.bottom_m"), top = required(solid, "solid.top_m");
        const double speed = required(solid, "solid.speed_m_s"), start = solid.number("solid.start_s");
        require_top_above_bottom(solid, bottom, top);
        if (mistakes_.size() > before) return;
        const Interval across = thickness_of_gate(solid);
        if (across.from < 0.0 || across.to > width() || bottom >= height())
            return refuse(solid.where("solid.axis_x_m"),
                          fmt::format("A gate from {:g} to {:g} m leaves the domain", across.from, across.to),
                          fmt::format("The domain reaches to {:g} m x {:g} m", width(), height()), "Move the gate");
        if (speed == 0.0) return add_box(across.from, bottom, across.to, top);
        const SolidBox box{Vec3(across.from, -k_far, bottom), Vec3(across.to, k_far, top)};
        scene_.settings.gates.push_back({box, speed, start, start + (height() - bottom) / speed});
    }

    /// A gate must not meet what stands still, nor another gate, on its way.
    void require_free_way(const ParameterValues& solid) {
        if (solid.text("solid.kind") != "gate" || !mistakes_.empty() || solid.number("solid.speed_m_s") == 0.0) return;
        const Interval across = thickness_of_gate(solid), way{solid.number("solid.bottom_m"), height()};
        std::vector<StillSolid> others = scene_.settings.solids;
        for (const Gate& gate : scene_.settings.gates) {
            if (gate.closed.from.x() != across.from || gate.closed.from.z() != way.from) others.emplace_back(gate.closed);
        }
        for (const StillSolid& other : others) {
            for (int n = 0; n <= k_lines_of_gate; ++n) {
                const double x = across.from + (k_tolerance + (across.length() - 2.0 * k_tolerance) * n / k_lines_of_gate);
                for (const Interval& part : covered_parts(other, {2, Vec3(x, 0.5 * scene_.settings.tank.depth, 0.0)})) {
                    if (common(part, way).length() <= k_tolerance) continue;
                    return refuse(solid.where("solid.kind"),
                                  fmt::format("The gate at {:g} m meets a solid at ({:.4g}, {:.4g}) m", solid.number("solid.axis_x_m"), x,
                                              common(part, way).from),
                                  "Its way up is free", "Move the gate or the solid");
                }
            }
        }
    }

    /// Two oblique plates from the given width upwards, their thickness outside.
    void read_funnel(const ParameterValues& solid) {
        const double axis = required(solid, "solid.axis_x_m"), half = 0.5 * required(solid, "solid.inner_width_m"), wall = wall_of(solid);
        const double bottom = required(solid, "solid.bottom_m"), length = required(solid, "solid.wall_length_m");
        const double angle = solid.number("solid.angle_deg") * k_pi / 180.0;
        const Eigen::Vector2d way(length * std::cos(angle), length * std::sin(angle));
        const Eigen::Vector2d right(axis + half, bottom), left(axis - half, bottom);
        scene_.settings.solids.emplace_back(plate(right + way, right, wall));
        scene_.settings.solids.emplace_back(plate(left, left + Eigen::Vector2d(-way.x(), way.y()), wall));
    }

    /// Spheres or cylinders: all of a scene are of one shape.
    void read_shape(const ParameterValues& bodies) {
        const bool spheres = bodies.text("bodies.shape") == "sphere";
        const std::string where = bodies.where("bodies.diameter_m");
        if (spheres && plane())
            refuse(where, "Spheres in a plane scene", "A plane scene holds cylinders across it", "Set domain.dimensions = \"space\"");
        if (scene_.bodies.size() > 0 && spheres != scene_.settings.spheres)
            refuse(where, "Spheres and cylinders in one scene", "Bodies of a scene have one shape", "Give all [[bodies]] the same shape");
        if (!spheres && (bodies.integer("bodies.rows") > 1 || bodies.has("bodies.centre_y_m")))
            refuse(where, "bodies.rows or bodies.centre_y_m for cylinders", "Cylinders reach across the whole tank",
                   "Remove it, or set bodies.shape = \"sphere\"");
        scene_.settings.spheres = spheres;
    }

    void read_bodies(const ParameterValues& bodies) {
        read_shape(bodies);
        const double diameter = bodies.number("bodies.diameter_m"), density = bodies.number("bodies.density_kg_m3");
        const double across = diameter / cell();
        const std::string where = bodies.where("bodies.diameter_m");
        if (across < k_fewest_cells)
            refuse(where, fmt::format("bodies.diameter_m = {:g} m is {:.3g} cells", diameter, across),
                   fmt::format("A body needs at least {:g} cells across", k_fewest_cells),
                   fmt::format("Use cells of {:g} m", diameter / 10.0));
        else if (across < k_enough_cells)
            scene_.notes.push_back(
                fmt::format("bodies have {:.3g} cells across: below 8 their acceleration is off by 2 % and more", across));
        if (density < 1e-3 * scene_.settings.water.density)
            refuse(bodies.where("bodies.density_kg_m3"), fmt::format("bodies.density_kg_m3 = {:g}", density),
                   "The pressure of water and bodies is verified down to a thousandth of the water's density", "Use a heavier body");
        const double jitter = bodies.number("bodies.jitter_m");
        std::mt19937 random(static_cast<unsigned>(bodies.integer("bodies.seed")));
        std::uniform_real_distribution<double> shift(-jitter, jitter);
        for (ListedBody& body : bodies.has("bodies.file") ? listed(bodies) : stacked(bodies)) {
            body.z += shift(random);
            body.x += shift(random);
            if (scene_.settings.spheres) body.y = body.y.value_or(0.5 * scene_.settings.tank.depth) + shift(random);
            add_body(body, diameter, density);
        }
    }

    std::vector<ListedBody> listed(const ParameterValues& bodies) {
        for (const char* key : {"bodies.centre_x_m", "bodies.lowest_m"}) {
            if (bodies.has(key))
                refuse(bodies.where(key), fmt::format("{} beside bodies.file", key), "Bodies are a stack or listed in a file",
                       "Remove one of them; a second [[bodies]] may have the other");
        }
        std::vector<Mistake> mistakes;
        std::vector<ListedBody> list = read_body_list(folder_ / bodies.text("bodies.file"), mistakes);
        for (Mistake& mistake : mistakes) {
            if (mistake.where.empty()) mistake.where = bodies.where("bodies.file");
            mistakes_.push_back(std::move(mistake));
        }
        for (const ListedBody& body : list) {
            if (body.y && !scene_.settings.spheres)
                refuse(body.where, fmt::format("The cylinder at x = {:g} m has a place across", body.x), "Cylinders reach across the tank",
                       "Leave the column y_m out, or set bodies.shape = \"sphere\"");
        }
        return list;
    }

    std::vector<ListedBody> stacked(const ParameterValues& bodies) {
        for (const char* key : {"bodies.centre_x_m", "bodies.lowest_m"}) {
            if (bodies.has(key)) continue;
            refuse(bodies.where("bodies.diameter_m"), fmt::format("{} is missing", key), "A stack needs it", "Add it, or bodies.file");
            return {};
        }
        std::vector<ListedBody> stack;
        const double diameter = bodies.number("bodies.diameter_m"), spacing = diameter + bodies.number("bodies.clearance_m");
        const auto widest = bodies.integer("bodies.widest"), rows = bodies.integer("bodies.rows");
        const double all = static_cast<double>(bodies.integer("bodies.layers")) * static_cast<double>(widest) * static_cast<double>(rows);
        if (all > k_most_bodies) {
            refuse(bodies.where("bodies.layers"), fmt::format("a stack of {:g} bodies", all),
                   fmt::format("A stack has at most {:g}", k_most_bodies), "Make it smaller");
            return {};
        }
        const double centre_y = bodies.has("bodies.centre_y_m") ? bodies.number("bodies.centre_y_m") : 0.5 * scene_.settings.tank.depth;
        for (std::int64_t layer = 0; layer < bodies.integer("bodies.layers"); ++layer) {
            const auto count = std::max<std::int64_t>(1, layer % 2 == 0 ? widest : widest - 1);
            for (std::int64_t n = 0; n < count; ++n) {
                const double x =
                    bodies.number("bodies.centre_x_m") + (static_cast<double>(n) - 0.5 * static_cast<double>(count - 1)) * spacing;
                const double z = bodies.number("bodies.lowest_m") + 0.5 * diameter + static_cast<double>(layer) * std::sqrt(0.75) * spacing;
                for (std::int64_t row = 0; row < rows; ++row) {
                    ListedBody body;
                    body.x = x;
                    body.y = centre_y + (static_cast<double>(row) - 0.5 * static_cast<double>(rows - 1)) * spacing;
                    body.z = z;
                    body.where = bodies.where("bodies.diameter_m");
                    stack.push_back(std::move(body));
                }
            }
        }
        return stack;
    }

    /// A place in the words of the scene: x and z in a plane one.
    std::string text_of(const Vec3& place) const {
        if (plane()) return fmt::format("({:g}, {:g}) m", place.x(), place.z());
        return fmt::format("({:g}, {:g}, {:g}) m", place.x(), place.y(), place.z());
    }

    /// How deep a body reaches into a solid [m]; 0: not at all. Looked for in its middle and along its rim.
    static double depth_in(const StillSolid& solid, const Vec3& place, double radius, bool sphere) {
        if (const auto way = way_out(solid, place)) return (*way - place).norm() + radius;
        if (const auto* surface = std::get_if<SolidSurface>(&solid); surface && sphere)
            return std::max(0.0, radius - (surface->surface->nearest(place) - place).norm());
        double deepest = 0.0;
        for (int m = 0; m < (sphere ? k_rims : 1); ++m) {
            const double turn = k_pi * m / k_rims;
            for (int n = 0; n < k_rim_points; ++n) {
                const double angle = 2.0 * k_pi * n / k_rim_points, out = std::cos(angle);
                const Vec3 rim = place + radius * Vec3(out * std::cos(turn), out * std::sin(turn), std::sin(angle));
                if (const auto way = way_out(solid, rim)) deepest = std::max(deepest, (*way - rim).norm());
            }
        }
        return deepest;
    }

    void add_body(const ListedBody& body, double diameter, double density) {
        coupling::Rocks& rocks = scene_.bodies;
        const bool sphere = scene_.settings.spheres;
        const double depth = scene_.settings.tank.depth;
        const Vec3 place(body.x, sphere ? body.y.value_or(0.5 * depth) : 0.5 * depth, body.z);
        const std::string& where = body.where;
        const int id = body.id > 0 ? body.id : rocks.id.empty() ? 1 : *std::max_element(rocks.id.begin(), rocks.id.end()) + 1;
        const double radius = 0.5 * diameter;
        if (std::find(rocks.id.begin(), rocks.id.end(), id) != rocks.id.end())
            refuse(where, fmt::format("id {} is that of a body of another table", id), "Every body has an id of its own",
                   "Change the id, or leave the column out");
        double beyond = std::max({radius - place.x(), place.x() + radius - width(), radius - place.z(), place.z() + radius - height()});
        if (sphere) beyond = std::max({beyond, radius - place.y(), place.y() + radius - depth});
        if (beyond > 0.0)
            refuse(where, fmt::format("Body {} at {} leaves the domain by {:.3g} m", id, text_of(place), beyond),
                   fmt::format("The domain reaches to {}", text_of(Vec3(width(), depth, height()))), "Move it, or the stack");
        for (std::size_t n = 0; n < rocks.size(); ++n) {
            const double between = (rocks.position[n] - place).norm() - 0.5 * rocks.diameter[n] - radius;
            if (between < 0.0)
                refuse(where, fmt::format("Bodies {} and {} overlap by {:.3g} m", rocks.id[n], id, -between), "Bodies must not overlap",
                       "Move one of them, or give more clearance or less jitter");
        }
        double into = 0.0;
        for (const StillSolid& solid : scene_.settings.solids) into = std::max(into, depth_in(solid, place, radius, sphere));
        for (const Gate& gate : scene_.settings.gates) into = std::max(into, depth_in(gate.closed, place, radius, sphere));
        if (into > 0.0)
            refuse(where, fmt::format("Body {} at {} stands in a solid, {:.3g} m deep", id, text_of(place), into), "Bodies start free",
                   "Move it, or the stack");
        rocks.append({id, place, body.velocity, Vec3(0.0, body.spin, 0.0), diameter, density});
    }

    /// The DEM keeps bodies by their ids.
    void sort_bodies() {
        const coupling::Rocks given = std::move(scene_.bodies);
        std::vector<std::size_t> order(given.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return given.id[a] < given.id[b]; });
        scene_.bodies = {};
        for (const std::size_t n : order) scene_.bodies.append(given, n);
    }

    void read_gauge(const ParameterValues& values) {
        refuse_in_plane(values, {"gauge.y_m"});
        Gauge gauge{values.text("gauge.name"), values.number("gauge.x_m"), 0.5 * depth(), {}};
        if (values.has("gauge.y_m")) gauge.y = values.number("gauge.y_m");
        if (values.has("gauge.z_m")) gauge.z = values.number("gauge.z_m");
        const std::string where = values.where("gauge.name");
        if (gauge.name.empty() || gauge.name.find_first_of(",\"\n\r") != std::string::npos)
            refuse(where, fmt::format("gauge.name = \"{}\"", gauge.name), "A name is not empty and has no comma, quote or line break",
                   "Change it");
        const auto same = [&](const Gauge& other) { return other.name == gauge.name; };
        if (std::any_of(scene_.gauges.begin(), scene_.gauges.end(), same))
            refuse(where, fmt::format("gauge.name = \"{}\" is given twice", gauge.name), "Every gauge has a name of its own", "Change one");
        const double z = gauge.z.value_or(0.0);
        const Vec3 place(gauge.x, gauge.y, z);
        if (gauge.x > width() || (!plane() && gauge.y > depth()) || z > height())
            refuse(values.where("gauge.x_m"), fmt::format("Gauge {} at {} lies outside the domain", gauge.name, text_of(place)),
                   fmt::format("The domain is {}", text_of_domain()), "Move it");
        const auto holds_it = [&](const StillSolid& solid) { return is_inside(solid, place); };
        if (gauge.z && std::any_of(scene_.settings.solids.begin(), scene_.settings.solids.end(), holds_it))
            refuse(values.where("gauge.z_m"), fmt::format("Gauge {} at {} stands in a solid", gauge.name, text_of(place)),
                   "It reads the pressure of water", "Move it");
        scene_.gauges.push_back(std::move(gauge));
    }

    void read_contact() {
        coupling::DemSettings& dem = scene_.dem;
        dem.law = coupling::ContactLaw::linear;
        dem.linear.theta = values_.number("contact.theta");
        dem.linear.reference_length = values_.number("contact.reference_length_m");
        dem.linear.damping = values_.number("contact.damping");
        dem.linear.poisson = values_.number("contact.poisson");
        dem.linear.accumulated_shear = values_.text("contact.shear") == "accumulated";
        dem.contact.set_every_pair({values_.number("contact.friction"), dem.contact.rock_rock.restitution, 0.0});
        dem.contact.wet_restitution = false;
        if (dem.linear.damping >= std::sqrt(0.5))
            refuse(values_.where("contact.damping"), fmt::format("contact.damping = {:g}", dem.linear.damping),
                   "A pair must swing: below sqrt(1/2) = 0.707", "Use 0.4");
        dem.contact_gap = values_.has("contact.gap_m") ? values_.number("contact.gap_m") : k_smallest_gap * cell();
        if (scene_.bodies.size() > 1 && dem.contact_gap < (k_smallest_gap - 1e-6) * cell())
            refuse(values_.where("contact.gap_m"), fmt::format("contact.gap_m = {:g} m", dem.contact_gap),
                   fmt::format("At least a quarter of a cell ({:g} m): water locked between bodies collapses", k_smallest_gap * cell()),
                   "Use a larger gap or smaller cells");
        dem.shape = scene_.settings.spheres ? coupling::RockShape::sphere : coupling::RockShape::cylinder;
        if (!scene_.settings.spheres) dem.cylinder_length = scene_.settings.tank.depth;
        dem.domain.lower = Vec3::Zero();
        dem.domain.upper = Vec3(width(), scene_.settings.tank.depth, height());
        for (const auto side :
             {coupling::DomainSide::x_min, coupling::DomainSide::x_max, coupling::DomainSide::z_min, coupling::DomainSide::z_max})
            dem.domain.make_wall(side);
        if (scene_.settings.spheres)
            for (const auto side : {coupling::DomainSide::y_min, coupling::DomainSide::y_max}) dem.domain.make_wall(side);
        dem.fluid = {0.0, 0.0};
        dem.added_mass = 0.0;
        dem.gravity = scene_.settings.gravity;

        GapDampingSettings& damping = scene_.settings.damping;
        damping.remaining = values_.number("contact.gap_damping");
        damping.gap = dem.contact_gap;
        if (values_.has("contact.gap_damping_time_s")) damping.time = values_.number("contact.gap_damping_time_s");
        if (damping.remaining < 1.0 && damping.time <= 0.0)
            refuse(values_.where("contact.gap_damping"), fmt::format("contact.gap_damping = {:g} without a time", damping.remaining),
                   "The damping is a rate", "Give contact.gap_damping_time_s, cell/(2 sqrt(g H))");
    }

    void read_run() {
        scene_.end = values_.number("run.end_s");
        const std::string& stop = values_.text("run.stop_when");
        scene_.stop = stop == "pipe_empty" ? StopRule::pipe_empty : stop == "arrival" ? StopRule::arrival : StopRule::none;
        scene_.settle = values_.number("run.settle_s");
        if (scene_.stop == StopRule::pipe_empty && !scene_.pipe)
            refuse(values_.where("run.stop_when"), "run.stop_when = \"pipe_empty\" without a pipe", "The rule watches a pipe",
                   "Add a [[solid]] of kind pipe, or take another rule");
        if (scene_.stop != StopRule::none && scene_.bodies.size() == 0)
            refuse(values_.where("run.stop_when"), fmt::format("run.stop_when = \"{}\" without bodies", stop), "The rule watches bodies",
                   "Add [[bodies]], or take none");
        scene_.write_interval = values_.number("run.write_interval_s");
        scene_.write_particles = static_cast<int>(values_.integer("run.write_particles"));
        scene_.checkpoint_interval = values_.number("run.checkpoint_interval_s");
        scene_.settings.run.max_courant = values_.number("run.max_courant");
        if (scene_.write_interval > scene_.end)
            refuse(values_.where("run.write_interval_s"), fmt::format("run.write_interval_s = {:g} s", scene_.write_interval),
                   fmt::format("It must not exceed run.end_s = {:g} s", scene_.end), "Write more often");
        for (const char* key : {"run.write_interval_s", "run.checkpoint_interval_s"})
            if (values_.number(key) < scene_.end / k_most_outputs)
                refuse(values_.where(key), fmt::format("{} = {:g} s in a run of {:g} s", key, values_.number(key), scene_.end),
                       fmt::format("A run has at most {:g} of them", k_most_outputs), "Write less often");
    }

    const ParameterValues& values_;
    const std::filesystem::path folder_;
    Scene scene_;
    std::vector<Mistake> mistakes_;
};

/// Corners of a solid in x and z, counter-clockwise seen against y, and its part of the tank's depth.
struct Extruded {
    std::vector<Eigen::Vector2d> corners;
    Interval across;
};

/// None for a solid that has a surface of its own.
std::optional<Extruded> extruded(const StillSolid& solid, double depth) {
    const Interval tank{0.0, depth};
    if (const auto* prism = std::get_if<SolidPrism>(&solid)) return Extruded{prism->corners, tank};
    const auto* box = std::get_if<SolidBox>(&solid);
    if (!box) return {};
    return Extruded{
        {{box->from.x(), box->from.z()}, {box->to.x(), box->from.z()}, {box->to.x(), box->to.z()}, {box->from.x(), box->to.z()}},
        common({box->from.y(), box->to.y()}, tank)};
}

std::string facet(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto vertex = [](const Vec3& v) { return fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z()); };
    return "facet normal 0 0 0\nouter loop\n" + vertex(a) + vertex(b) + vertex(c) + "endloop\nendfacet\n";
}

}  // namespace

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
        keys.push_back(positive("domain.cell_m", "m", {}, "Edge of a cell; a body needs at least 5, better 10 across."));
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

Scene parse_scene(const std::string& toml, const std::string& name, const std::filesystem::path& folder) {
    return Reader(parse_parameters(scene_table(), toml, name), folder).read();
}

Scene read_scene(const std::filesystem::path& file) {
    return Reader(read_parameters(scene_table(), file), file.parent_path()).read();
}

std::vector<std::string> water_notes(const Scene& scene) {
    const int waters = enclosed_waters(scene.settings, bodies_of(scene));
    if (waters == 0) return {};
    return {enclosed_note(waters, 0.0)};
}

std::string enclosed_note(int waters, double time) {
    return fmt::format(
        "closed waters without a surface from {:.4g} s on: {}; their mean pressure is set to 0, only its differences mean anything", time,
        waters);
}

std::string wall_surface_stl(const std::vector<StillSolid>& solids, double depth) {
    std::string facets;
    for (const StillSolid& solid : solids) {
        const auto shape = extruded(solid, depth);
        if (!shape) continue;
        const auto& [corners, across] = *shape;
        const auto at = [&corners = corners](std::size_t n, double y) {
            const Eigen::Vector2d& corner = corners[n % corners.size()];
            return Vec3(corner.x(), y, corner.y());
        };
        const double near = across.from, far = across.to;
        for (std::size_t n = 0; n < corners.size(); ++n) {
            facets += facet(at(n, near), at(n, far), at(n + 1, far)) + facet(at(n, near), at(n + 1, far), at(n + 1, near));
        }
        for (std::size_t n = 1; n + 1 < corners.size(); ++n) {
            facets += facet(at(0, near), at(n, near), at(n + 1, near)) + facet(at(0, far), at(n + 1, far), at(n, far));
        }
    }
    return facets.empty() ? facets : "solid walls\n" + facets + "endsolid walls\n";
}

bool stops(const Scene& scene, const SceneReading& reading) {
    if (scene.stop == StopRule::pipe_empty) return reading.bodies_in_pipe == 0;
    return scene.stop == StopRule::arrival && reading.farthest + scene.dem.contact_gap >= scene.dem.domain.upper.x();
}

ScenePrediction predict(const Scene& scene) {
    const TankSettings& tank = scene.settings.tank;
    ScenePrediction result;
    const double across = tank.cells[1];
    result.cells = static_cast<double>(tank.cells[0]) * across * tank.cells[2];
    double height = 0.0;
    for (const WaterBox& box : scene.settings.water.filled) {
        const double to_x = std::min(box.to.x(), tank.cells[0] * tank.cell), to_z = std::min(box.to.z(), tank.cells[2] * tank.cell);
        const double share = tank.plane ? 1.0 : common({box.from.y(), box.to.y()}, {0.0, tank.depth}).length() / tank.depth;
        result.water_cells += share * across * (to_x - box.from.x()) * (to_z - box.from.z()) / (tank.cell * tank.cell);
        height = std::max(height, to_z);
    }
    result.particles = (tank.plane ? 4.0 : 8.0) * result.water_cells;
    double body_cells = 0.0;
    for (const double diameter : scene.bodies.diameter)
        body_cells += diameter * diameter / (tank.cell * tank.cell) * (scene.settings.spheres ? diameter / tank.cell : across);
    const double speed = 2.0 * std::sqrt(k_gravity * std::max(height, tank.cell));
    result.step = std::min(scene.settings.run.max_courant * tank.cell / speed, 0.7 * std::sqrt(tank.cell / k_gravity));
    result.steps = scene.end / result.step;
    for (const Gate& gate : scene.settings.gates) {
        const double lifted = std::max(0.0, std::min(gate.end, scene.end) - gate.start), longest = k_solid_travel * tank.cell / gate.speed;
        if (longest < result.step) result.steps += lifted * (1.0 / longest - 1.0 / result.step);
    }
    result.memory = k_bytes_per_particle * result.particles + k_bytes_per_cell * result.cells + k_bytes_of_program;
    const StepCost& cost = tank.plane ? k_plane_cost : k_space_cost;
    result.core_seconds = result.steps * (result.cells * cost.cell + result.particles * cost.particle + body_cells * cost.body_cell);
    if (scene.bodies.size() > 0)
        result.dem_step = physics::linear_contact_step(scene.dem.linear.theta, scene.dem.linear.reference_length, k_gravity,
                                                       scene.dem.linear.steps_per_period);
    return result;
}

}  // namespace cutterflow::free_surface
