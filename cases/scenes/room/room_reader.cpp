/// \file From the values of a room's study to its scene; every mistake is found.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/scenes/room/grain_placement.hpp"
#include "cases/scenes/room/room_measures.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "cases/scenes/room/side_parts.hpp"
#include "cases/scenes/room/solid_generators.hpp"
#include "cases/study/closure_rules.hpp"
#include "cases/study/study_section.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/clump/clump_file.hpp"
#include "geometry/clump/unit_clump.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::cases {

namespace {

namespace fs = std::filesystem;

constexpr double k_tolerance = 1e-9;         // [m]
constexpr double k_narrowest_opening = 3.0;  // largest diameters; a narrower one is plugged by an arch
constexpr double k_longest_settling = 20.0;  // [s]
constexpr double k_look_per_fall = 0.1;      // longest step over sqrt(d/g)
constexpr double k_most_outputs = 1e4;
constexpr double k_most_fed = 1e6;  // grains
constexpr double k_pictures = 50.0, k_checkpoints = 5.0;
constexpr double k_water_density = 1000.0, k_water_viscosity = 1e-6;
constexpr double k_air_density = 1.2, k_air_viscosity = 1.5e-5;

constexpr std::array<const char*, 6> k_sides{"x_min", "x_max", "y_min", "y_max", "bottom", "top"};  // by coupling::DomainSide

std::vector<coupling::DomainSide> sides_of(const std::string& word) {
    using coupling::DomainSide;
    if (word == "sides") return {DomainSide::x_min, DomainSide::x_max, DomainSide::y_min, DomainSide::y_max};
    const auto found = std::find(k_sides.begin(), k_sides.end(), word);
    return {static_cast<DomainSide>(found - k_sides.begin())};
}

std::string text_of(const Vec3& v) {
    return fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z());
}

/// Reads one scene; collects what is wrong.
class RoomReader {
public:
    RoomReader(const ParameterValues& values, fs::path folder) : values_(values), folder_(std::move(folder)) {}

    RoomScene read() {
        scene_.name = values_.text("name");
        read_room();
        read_materials();
        for (const ParameterValues& grains : values_.tables("grains")) read_grains(grains);
        for (const ParameterValues& solid : values_.tables("solid")) read_solid(solid);
        for (const ParameterValues& boundary : values_.tables("boundary")) read_boundary(boundary);
        require_balanced_flow();
        require_whole_flows();
        require_patch_names();
        read_pairs();
        for (const ParameterValues& step : values_.tables("prepare")) read_step(step);
        require_ordered_preparation();
        read_measures();
        read_run();
        for (const ParameterValues& event : values_.tables("event")) read_event(event);
        require_something();
        mistakes_.refuse();
        return std::move(scene_);
    }

private:
    void refuse(const std::string& where, const std::string& what, const std::string& rule, const std::string& remedy) {
        mistakes_.add({where, what, rule, remedy});
    }

    /// Names of solids, materials and gates are words of dictionaries and of tables.
    void require_name(const std::string& name, const std::string& key, const std::string& where) {
        const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; };
        if (name.empty() || !std::all_of(name.begin(), name.end(), is_letter))
            refuse(where, fmt::format("{} = \"{}\"", key, name), "It has letters, digits, - and _ alone", "Change it");
    }

    /// Of solids and sides.
    void require_material(const std::string& name, const std::string& key, const std::string& where) {
        require_name(name, key, where);
        if (name == "rock")
            refuse(where, fmt::format("{} = \"rock\"", key), "The solver calls grains so", "Give the material another name");
    }

    /// Keys that go with another setting only.
    void refuse_keys(const ParameterValues& table, std::initializer_list<const char*> keys, const std::string& rule) {
        for (const char* key : keys)
            if (!table.where(key).empty()) refuse(table.where(key), fmt::format("{} is given", key), rule, "Remove it");
    }

    /// The key's place, or that of another one when it is absent.
    static std::string place_of(const ParameterValues& table, const std::string& key, const std::string& otherwise) {
        return table.where(key).empty() ? table.where(otherwise) : table.where(key);
    }

    std::optional<double> required(const ParameterValues& table, const std::string& key, const std::string& of, const std::string& at) {
        if (table.has(key)) return table.number(key);
        refuse(table.where(at), fmt::format("{} is missing for {}", key, of), "It needs the key", "Add it");
        return std::nullopt;
    }

    // ---------------------------------------------------------------- room

    void read_room() {
        scene_.size = vec3_of(values_, "room.size_m");
        const double tilt = values_.number("room.tilt_deg") * k_pi / 180.0;
        scene_.gravity = values_.number("room.gravity_m_s2") * Vec3(std::sin(tilt), 0.0, -std::cos(tilt));
        scene_.medium.name = values_.text("room.medium");
        scene_.side_material = values_.text("room.material");
        require_material(scene_.side_material, "room.material", place_of(values_, "room.material", "room.size_m"));
        scene_.sides.fill(SideForGrains::wall);
        scene_.sides[static_cast<std::size_t>(coupling::DomainSide::z_max)] = SideForGrains::open;
        if (!scene_.medium.present()) {
            refuse_keys(values_, {"room.density_kg_m3", "room.kinematic_viscosity_m2_s", "room.turbulence", "room.cell_m"},
                        "Without a medium there are neither flow nor mesh (room.medium = \"none\")");
            for (const ParameterValues& refine : values_.tables("room.refine"))
                refuse_keys(refine, {"room.refine.cell_m"}, "Without a medium there is no mesh (room.medium = \"none\")");
            refuse_coupling_keys();
            return;
        }
        const bool water = scene_.medium.name == "water";
        scene_.medium.density = number_or(values_, "room.density_kg_m3", water ? k_water_density : k_air_density);
        scene_.medium.kinematic_viscosity =
            number_or(values_, "room.kinematic_viscosity_m2_s", water ? k_water_viscosity : k_air_viscosity);
        scene_.kernel = k_kernel_section.read(values_);
        scene_.closures = k_closure_section.read(values_);
        mistakes_.add(closure_mistakes(values_));
        scene_.medium.turbulence = values_.has("room.turbulence") ? values_.text("room.turbulence") : "realizableKE";
        if (const auto cell = required(values_, "room.cell_m", "a room with " + scene_.medium.name, "room.size_m")) scene_.cell = *cell;
        check_map();
        for (const ParameterValues& refine : values_.tables("room.refine")) {
            const std::string where = refine.where("room.refine.cell_m");
            const double cell = refine.number("room.refine.cell_m");
            if (cell >= scene_.cell && scene_.cell > 0.0)
                refuse(where, fmt::format("room.refine.cell_m = {:g}", cell),
                       fmt::format("It must be below room.cell_m = {:g}", scene_.cell), "Correct one of them");
            const std::optional<Region> region = read_region(refine, "room.refine", where);
            if (!region) continue;
            if (!std::holds_alternative<RegionBox>(*region) && !std::holds_alternative<RegionCylinder>(*region))
                refuse(where, "a refined part that is neither box nor cylinder", "The mesh is refined in boxes and cylinders",
                       "Use one of them");
            else
                scene_.refinements.push_back({*region, cell});
        }
    }

    /// Cubes belong to map cluster, and hold a cell or more.
    void check_map() {
        const double side = scene_.kernel.cluster_size;
        const bool clusters = scene_.kernel.map == coupling::k_cluster_map;
        const std::string where = values_.where(side > 0.0 ? "kernel.cluster_size_m" : "kernel.map");
        if (!clusters && side > 0.0)
            refuse(where, fmt::format("kernel.cluster_size_m = {:g} with kernel.map = \"{}\"", side, scene_.kernel.map),
                   "Only map cluster has cubes", "Remove it, or set kernel.map = \"cluster\"");
        else if (clusters && side < scene_.cell)
            refuse(where, fmt::format("kernel.cluster_size_m = {:g}", side),
                   fmt::format("A cube of map cluster holds a cell of {:g} m or more", scene_.cell), "Give a cell or more");
    }

    /// Keys of closures and kernel count with a medium only. A study that is written out in full has their defaults.
    void refuse_coupling_keys() {
        ParameterTable rows = k_closure_section.rows();
        for (const Parameter& row : k_kernel_section.rows()) rows.push_back(row);
        for (const Parameter& row : rows)
            if (*values_.find(row.key) != row.default_value)
                refuse_keys(values_, {row.key.c_str()}, "Without a medium nothing drags grains (room.medium = \"none\")");
    }

    static double number_or(const ParameterValues& table, const char* key, double otherwise) {
        return table.has(key) ? table.number(key) : otherwise;
    }

    // ------------------------------------------------------------- regions

    /// All that `shape` needs, or none with a mistake.
    bool has_all(const ParameterValues& table, const std::string& shape, std::initializer_list<const char*> keys,
                 const std::string& where) {
        bool complete = true;
        for (const char* key : keys) {
            if (table.has(shape + "." + key)) continue;
            refuse(where, fmt::format("{}.{} is missing", shape, key), "The region is not complete without it", "Add it");
            complete = false;
        }
        return complete;
    }

    /// The part of space that a table gives; none when it gives none, or a wrong one.
    std::optional<Region> read_region(const ParameterValues& table, const std::string& key, const std::string& where) {
        std::vector<std::string> given;
        for (const char* shape : {"box", "cylinder", "sphere", "half_space", "above_m", "below_m"})
            if (!table.where(key + "." + shape).empty()) given.push_back(shape);
        if (given.empty()) return std::nullopt;
        if (given.size() > 1) {
            refuse(where, fmt::format("{} of one table", fmt::join(given, " and ")), "A table has one region", "Remove all but one");
            return std::nullopt;
        }
        const std::string at = key + "." + given.front();
        if (given.front() == "above_m") return above(table.number(at));
        if (given.front() == "below_m") return below(table.number(at));
        if (given.front() == "box") {
            if (!has_all(table, at, {"lower_m", "upper_m"}, where)) return std::nullopt;
            const RegionBox box{vec3_of(table, at + ".lower_m"), vec3_of(table, at + ".upper_m")};
            if ((box.lower.array() < box.upper.array()).all()) return box;
            refuse(where, fmt::format("a box from {} to {}", text_of(box.lower), text_of(box.upper)),
                   "Every coordinate of the lower corner is below that of the upper", "Correct them");
            return std::nullopt;
        }
        if (given.front() == "cylinder") {
            if (!has_all(table, at, {"from_m", "to_m", "radius_m"}, where)) return std::nullopt;
            const RegionCylinder cylinder{vec3_of(table, at + ".from_m"), vec3_of(table, at + ".to_m"), table.number(at + ".radius_m")};
            if (cylinder.from != cylinder.to) return cylinder;
            refuse(where, fmt::format("a cylinder from {} to the same place", text_of(cylinder.from)), "Its axis has two ends",
                   "Correct one");
            return std::nullopt;
        }
        if (given.front() == "sphere") {
            if (!has_all(table, at, {"centre_m", "radius_m"}, where)) return std::nullopt;
            return RegionSphere{vec3_of(table, at + ".centre_m"), table.number(at + ".radius_m")};
        }
        if (!has_all(table, at, {"point_m", "normal"}, where)) return std::nullopt;
        const RegionHalfSpace half{vec3_of(table, at + ".point_m"), vec3_of(table, at + ".normal")};
        if (half.normal.norm() > 0.0) return RegionHalfSpace{half.point, half.normal.normalized()};
        refuse(where, "a half space with normal (0, 0, 0)", "It has a direction", "Correct it");
        return std::nullopt;
    }

    static Region above(double z) { return RegionHalfSpace{Vec3(0.0, 0.0, z), Vec3::UnitZ()}; }
    static Region below(double z) { return RegionHalfSpace{Vec3(0.0, 0.0, z), -Vec3::UnitZ()}; }

    /// Whether a region and the room have a part in common (by the boxes around them).
    bool meets_room(const Region& region) const {
        const Vec3 lower = scene_.lower(), upper = scene_.upper();
        if (std::holds_alternative<RegionHalfSpace>(region)) {
            for (int corner = 0; corner < 8; ++corner) {
                const Vec3 place(corner & 1 ? lower.x() : upper.x(), corner & 2 ? lower.y() : upper.y(),
                                 corner & 4 ? lower.z() : upper.z());
                if (contains(region, place)) return true;
            }
            return false;
        }
        const auto overlap = [&](const Vec3& from, const Vec3& to) {
            return (from.array() < upper.array()).all() && (to.array() > lower.array()).all();
        };
        if (const auto* box = std::get_if<RegionBox>(&region)) return overlap(box->lower, box->upper);
        if (const auto* sphere = std::get_if<RegionSphere>(&region))
            return overlap(sphere->centre - Vec3::Constant(sphere->radius), sphere->centre + Vec3::Constant(sphere->radius));
        if (const auto* cylinder = std::get_if<RegionCylinder>(&region)) {
            const Vec3 margin = Vec3::Constant(cylinder->radius);
            return overlap(cylinder->from.cwiseMin(cylinder->to) - margin, cylinder->from.cwiseMax(cylinder->to) + margin);
        }
        return true;
    }

    void require_in_room(const Region& region, const std::string& what, const std::string& where) {
        if (!meets_room(region))
            refuse(where, fmt::format("{} is about a region outside the room", what), room_rule(), "Correct the region");
    }

    std::string room_rule() const {
        return fmt::format("The room reaches from {} to {} m", text_of(scene_.lower()), text_of(scene_.upper()));
    }

    // ----------------------------------------------------------- materials

    void read_materials() {
        std::set<std::string> names;
        for (const ParameterValues& material : values_.tables("material"))
            if (!names.insert(material.text("material.name")).second)
                refuse(material.where("material.name"),
                       fmt::format("material.name = \"{}\" is given twice", material.text("material.name")), "Every material has one table",
                       "Remove one of them");
        scene_.contact.rolling_law = values_.text("dem.rolling_law");
        scene_.contact.time_step_fraction = values_.number("dem.time_step_fraction");
        scene_.contact.wet_restitution = scene_.medium.name == "water";
        scene_.contact.max_speed = values_.has("dem.max_speed_m_s")
                                       ? values_.number("dem.max_speed_m_s")
                                       : std::max(0.1, std::sqrt(2.0 * scene_.gravity.norm() * scene_.size.z()));
    }

    const ParameterValues* find_material(const std::string& name) const {
        for (const ParameterValues& material : values_.tables("material"))
            if (material.text("material.name") == name) return &material;
        return nullptr;
    }

    /// Young's modulus and Poisson's ratio of the grains, and that of the solids.
    void read_elasticity(const std::string& where) {
        const ParameterValues* material = find_material(scene_.grain_material);
        if (material == nullptr || !material->has("material.youngs_modulus_pa"))
            return refuse(material == nullptr ? where : material->where("material.name"),
                          fmt::format("Young's modulus of {}, the grains' material, is missing", scene_.grain_material),
                          "The step of the contacts follows from it",
                          fmt::format("Write [[material]] with name = \"{}\" and youngs_modulus_pa", scene_.grain_material));
        scene_.contact.youngs_modulus = material->number("material.youngs_modulus_pa");
        scene_.contact.poisson_rock = scene_.contact.poisson_steel = material->number("material.poisson");
        bool found_other = false;
        for (const ParameterValues& other : values_.tables("material")) {
            if (&other == material) continue;
            if (other.has("material.youngs_modulus_pa") && other.number("material.youngs_modulus_pa") != scene_.contact.youngs_modulus)
                refuse(
                    other.where("material.youngs_modulus_pa"),
                    fmt::format("material.youngs_modulus_pa = {:g} of {}", other.number("material.youngs_modulus_pa"),
                                other.text("material.name")),
                    fmt::format("All materials of a room have the Young's modulus of the grains, {:g} Pa", scene_.contact.youngs_modulus),
                    "Leave it out");
            const double poisson = other.number("material.poisson");
            if (found_other && poisson != scene_.contact.poisson_steel)
                refuse(place_of(other, "material.poisson", "material.name"),
                       fmt::format("material.poisson = {:g} of {}", poisson, other.text("material.name")),
                       fmt::format("All materials besides the grains' have one Poisson's ratio, {:g}", scene_.contact.poisson_steel),
                       "Make them equal");
            scene_.contact.poisson_steel = poisson;
            found_other = true;
        }
    }

    /// Materials that grains can touch, in the order of their first use; the grains' own first.
    std::vector<std::string> touched_materials() const {
        std::vector<std::string> names{scene_.grain_material};
        const auto add = [&](const std::string& name) {
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        };
        for (const ParameterValues& solid : values_.tables("solid")) add(solid.text("solid.material"));
        if (std::any_of(scene_.sides.begin(), scene_.sides.end(), [](SideForGrains side) { return side != SideForGrains::open; }))
            add(scene_.side_material);
        return names;
    }

    void read_pairs() {
        if (scene_.grains.empty()) return;
        const std::vector<std::string> touched = touched_materials();
        std::set<std::string> done;
        for (const ParameterValues& contact : values_.tables("contact")) {
            const std::vector<std::string>& pair = contact.texts("contact.pair");
            const std::string where = contact.where("contact.pair");
            const std::string text = fmt::format("contact.pair = [\"{}\", \"{}\"]", pair[0], pair[1]);
            if (pair[0] != scene_.grain_material && pair[1] != scene_.grain_material) {
                refuse(where, text, fmt::format("One of the two is the grains' material, {}", scene_.grain_material),
                       "Correct it or remove the table");
                continue;
            }
            const std::string& other = pair[0] == scene_.grain_material ? pair[1] : pair[0];
            if (std::find(touched.begin(), touched.end(), other) == touched.end()) {
                const std::string nearest = nearest_word(other, touched);
                refuse(where, text, fmt::format("Grains touch {}", fmt::join(touched, ", ")),
                       nearest.empty() ? "Remove the table" : fmt::format("Did you mean {}?", nearest));
                continue;
            }
            if (!done.insert(other).second) {
                refuse(where, text + " is given twice", "Every pair has one table", "Remove one of them");
                continue;
            }
            scene_.pairs.push_back(
                {other, {contact.number("contact.friction"), contact.number("contact.restitution"), contact.number("contact.rolling")}});
        }
        for (const std::string& other : touched)
            if (done.count(other) == 0)
                refuse(values_.tables("grains").front().where("grains.material"),
                       fmt::format("[[contact]] of {} and {} is missing", scene_.grain_material, other),
                       "Every material that grains touch has a pair with theirs",
                       fmt::format("Write [[contact]] with pair = [\"{}\", \"{}\"], friction, rolling, restitution", scene_.grain_material,
                                   other));
    }

    // -------------------------------------------------------------- grains

    void read_grains(const ParameterValues& values) {
        RoomGrains grains;
        grains.name = values.text("grains.name");
        const std::string where = values.where("grains.name");
        if (scene_.find_grains(grains.name) != nullptr)
            refuse(where, fmt::format("grains.name = \"{}\" is given twice", grains.name), "Every kind of grains has a name of its own",
                   "Change one");
        grains.density = values.number("grains.density_kg_m3");
        const std::string material = values.text("grains.material");
        require_name(material, "grains.material", values.where("grains.material"));
        if (scene_.grain_material.empty()) {
            scene_.grain_material = material;
            read_elasticity(values.where("grains.material"));
        } else if (material != scene_.grain_material) {
            refuse(values.where("grains.material"), fmt::format("grains.material = \"{}\"", material),
                   fmt::format("All grains of a room have one material, here {}", scene_.grain_material), "Use it for all");
        }
        if (values.has("grains.shape")) {
            grains.clump = folder_ / values.text("grains.shape");
            if (!fs::exists(grains.clump))
                refuse(values.where("grains.shape"), fmt::format("{} does not exist", grains.clump.string()),
                       "grains.shape names the file of a clump", "Check the path");
            else
                mistakes_.gather([&] {
                    grains.girth = 2.0 * geometry::unit_clump(geometry::read_clump(grains.clump)).reach();
                    grains.clump_text = read_file(grains.clump);
                });
        }
        if (read_sizes(values, grains)) scene_.grains.push_back(std::move(grains));
    }

    bool read_sizes(const ParameterValues& values, RoomGrains& grains) {
        const bool one = values.has("grains.diameter_m"), uniform = values.has("grains.diameter_m.uniform_by_number");
        const auto& classes = values.tables("grains.class");
        const std::string where = values.where("grains.name");
        if (one + uniform + !classes.empty() != 1) {
            refuse(
                where,
                fmt::format("the grains {} have {} diameter", grains.name, one + uniform + !classes.empty() == 0 ? "no" : "more than one"),
                "Give diameter_m, diameter_m = { uniform_by_number = [a, b] }, or [[grains.class]]", "Correct it");
            return false;
        }
        if (one) grains.sizes = std::vector<GrainClass>{{values.number("grains.diameter_m"), 1.0}};
        if (uniform) {
            const std::vector<double>& range = values.numbers("grains.diameter_m.uniform_by_number");
            if (range[0] >= range[1]) {
                refuse(values.where("grains.diameter_m.uniform_by_number"),
                       fmt::format("uniform_by_number = [{:g}, {:g}]", range[0], range[1]), "The smaller diameter comes first",
                       "Exchange them");
                return false;
            }
            grains.sizes = UniformByNumber{range[0], range[1]};
        }
        if (classes.empty()) return true;
        double sum = 0.0;
        for (const ParameterValues& one_class : classes) sum += one_class.number("grains.class.mass_share");
        std::vector<GrainClass> made;
        for (const ParameterValues& one_class : classes)
            made.push_back({one_class.number("grains.class.diameter_m"), one_class.number("grains.class.mass_share") / sum});
        grains.sizes = made;
        return true;
    }

    // -------------------------------------------------------------- solids

    void read_solid(const ParameterValues& values) {
        RoomSolid solid;
        solid.name = values.text("solid.name");
        const std::string where = values.where("solid.name");
        require_name(solid.name, "solid.name", where);
        if (!solid_names_.insert(solid.name).second)
            refuse(where, fmt::format("solid.name = \"{}\" is given twice", solid.name), "Every solid has a name of its own", "Change one");
        solid.material = values.text("solid.material");
        require_material(solid.material, "solid.material", place_of(values, "solid.material", "solid.name"));
        solid.felt_by_fluid = values.boolean("solid.fluid");
        if (values.has("solid.removed_at_s")) {
            solid.removed_at = values.number("solid.removed_at_s");
            require_in_run(*solid.removed_at, "solid.removed_at_s", values);
            refuse_in_medium(solid, where, "is taken away");
        }
        read_motion(values, solid);
        if (!read_surface(values, solid)) return;
        require_inside(solid, where);
        scene_.solids.push_back(std::move(solid));
    }

    /// How many of these keys are given.
    static int given(const ParameterValues& values, std::initializer_list<const char*> keys) {
        return static_cast<int>(std::count_if(keys.begin(), keys.end(), [&](const char* key) { return values.has(key); }));
    }

    void read_motion(const ParameterValues& values, RoomSolid& solid) {
        const bool travels = values.has("solid.velocity_m_s");
        const int of_turn = given(values, {"solid.turn_rpm", "solid.turn_axis", "solid.turn_origin_m"});
        const int times = given(values, {"solid.from_s", "solid.to_s"});
        if (!travels && of_turn + times == 0) return;
        const std::string where = values.where("solid.name");
        if (travels && of_turn > 0)
            return refuse(where, fmt::format("{} has velocity_m_s and keys of a turn", solid.name), "A solid travels or turns",
                          "Remove one of them");
        if (times < 2 || (!travels && of_turn < 3))
            return refuse(
                where, fmt::format("the motion of {} is not complete", solid.name),
                "A solid travels with velocity_m_s, or turns with turn_rpm about turn_axis through turn_origin_m, from from_s to to_s",
                "Give all of them");
        const double begin = values.number("solid.from_s"), end = values.number("solid.to_s");
        if (begin >= end)
            refuse(values.where("solid.to_s"), fmt::format("solid.to_s = {:g} of {}", end, solid.name),
                   fmt::format("It is after from_s = {:g}", begin), "Correct one of them");
        if (travels)
            solid.travel = coupling::WallTravel{vec3_of(values, "solid.velocity_m_s"), begin, end};
        else
            read_turn(values, begin, end, solid);
        refuse_in_medium(solid, where, "moves");
    }

    void read_turn(const ParameterValues& values, double begin, double end, RoomSolid& solid) {
        const Vec3 axis = vec3_of(values, "solid.turn_axis");
        if (axis.norm() == 0.0)
            return refuse(values.where("solid.turn_axis"), fmt::format("solid.turn_axis of {} has no length", solid.name),
                          "It is a direction", "Give one that is not 0");
        solid.turn = coupling::WallTurn{
            {vec3_of(values, "solid.turn_origin_m"), axis.normalized()}, rpm_to_rad_s(values.number("solid.turn_rpm")), begin, end};
    }

    void refuse_in_medium(const RoomSolid& solid, const std::string& where, const char* what) {
        if (scene_.medium.present() && solid.felt_by_fluid)
            refuse(where, fmt::format("{} {} in {}", solid.name, what, scene_.medium.name),
                   "The mesh stands still: the medium feels solids that stand", "Set fluid = false");
    }

    bool read_surface(const ParameterValues& values, RoomSolid& solid) {
        const std::string where = values.where("solid.name");
        const bool generated = values.has("solid.generate"), file = values.has("solid.file");
        if (generated == file) {
            refuse(where, fmt::format("{} has {}", solid.name, file ? "both generate and file" : "neither generate nor file"),
                   "A solid is generated or read from a file", file ? "Remove one of them" : "Add one of them");
            return false;
        }
        return generated ? generate(values, solid) : read_file_of(values, solid);
    }

    bool generate(const ParameterValues& values, RoomSolid& solid) {
        const std::string where = values.where("solid.generate");
        const SolidGenerator& generator = *find_solid_generator(values.text("solid.generate"));
        const auto has = [&](const char* key) { return values.has(std::string("solid.") + key); };
        bool complete = true;
        for (const char* key : generator.keys) {
            if (has(key)) continue;
            refuse(where, fmt::format("solid.{} is missing for {}, a {}", key, solid.name, generator.name), generator.help, "Add it");
            complete = false;
        }
        for (const Parameter& row : solid_size_rows()) {
            const std::string key = row.key.substr(std::string("solid.").size());
            const auto is_it = [&](const char* known) { return key == known; };
            const bool known = std::any_of(generator.keys.begin(), generator.keys.end(), is_it) ||
                               std::any_of(generator.may_have.begin(), generator.may_have.end(), is_it);
            if (known || !values.has(row.key)) continue;
            refuse(values.where(row.key), fmt::format("{} of {}", row.key, solid.name),
                   fmt::format("A {} has {}", generator.name, fmt::join(generator.keys, ", ")), "Remove it");
        }
        if (!complete) return false;
        try {
            GeneratedSolid made = generator.make(values);
            solid.surface = std::move(made.surface);
            solid.bore = made.bore;
            solid.thinnest = made.thinnest;
            solid.opening = made.opening.value_or(0.0);
            require_opening(made.opening, solid.name, where);
        } catch (const UserError& error) {
            for (Mistake mistake : error.mistakes()) {
                mistake.where = where;
                mistake.what = fmt::format("{}: {}", solid.name, mistake.what);
                mistakes_.add(std::move(mistake));
            }
            return false;
        }
        return true;
    }

    void require_opening(const std::optional<double>& opening, const std::string& name, const std::string& where) {
        const double least = k_narrowest_opening * scene_.largest_grain();
        if (opening && *opening > 0.0 && *opening < least - k_tolerance)
            refuse(where, fmt::format("the opening of {} is {:g} m wide", name, *opening),
                   fmt::format("An opening below {:g} diameters of the largest grain ({:g} m) is plugged by an arch", k_narrowest_opening,
                               least),
                   "Widen it, or take smaller grains");
    }

    bool read_file_of(const ParameterValues& values, RoomSolid& solid) {
        refuse_sizes_beside_file(values);
        const fs::path file = folder_ / values.text("solid.file");
        try {
            solid.surface = geometry::read_surface(file);
            geometry::require_sound(geometry::inspect_surface(solid.surface), file.string());
            return true;
        } catch (const UserError& error) {
            for (Mistake mistake : error.mistakes()) {
                if (mistake.where.empty()) mistake.where = values.where("solid.file");
                mistakes_.add(std::move(mistake));
            }
            return false;
        }
    }

    void refuse_sizes_beside_file(const ParameterValues& values) {
        for (const Parameter& row : solid_size_rows())
            if (values.has(row.key))
                refuse(values.where(row.key), fmt::format("{} beside solid.file", row.key), "A file has its size", "Remove it");
    }

    void require_inside(const RoomSolid& solid, const std::string& where) {
        const geometry::Bounds bounds = geometry::bounds_of(solid.surface);
        const double allowed = 1e-6 * scene_.size.maxCoeff();
        const bool inside = (bounds.min.array() >= scene_.lower().array() - allowed).all() &&
                            (bounds.max.array() <= scene_.upper().array() + allowed).all();
        if (!inside)
            refuse(where, fmt::format("{} reaches from {} to {} m", solid.name, text_of(bounds.min), text_of(bounds.max)),
                   fmt::format("It must lie in the room, from {} to {} m", text_of(scene_.lower()), text_of(scene_.upper())),
                   "Move it, or make the room larger");
    }

    // ---------------------------------------------------------- boundaries

    void read_boundary(const ParameterValues& values) {
        const std::string where = values.where("boundary.on"), on = values.text("boundary.on");
        RoomBoundary boundary;
        boundary.sides = sides_of(on);
        boundary.name = values.has("boundary.name") ? values.text("boundary.name") : fmt::format("{}_{}", on, scene_.boundaries.size() + 1);
        if (values.has("boundary.grains")) set_sides(boundary.sides, values.text("boundary.grains"), values.where("boundary.grains"));
        const std::optional<SideFlow> flow = read_flow(values, where);
        const std::optional<SidePart> part = read_part(values, boundary, where);
        if (!flow || !part) return;
        if (!scene_.medium.present())
            return refuse(place_of(values, "boundary.flow", "boundary.on"), "boundary.flow in a room without a medium",
                          "Nothing flows there (room.medium = \"none\")", "Remove it");
        boundary.flow = *flow;
        boundary.part = *part;
        require_on_sides(boundary, where);
        set_flow_through(boundary, values);
        boundary_places_.push_back(where);
        scene_.boundaries.push_back(std::move(boundary));
    }

    /// The area is known when the part is; a discharge was kept as a speed through 1 m2 until now.
    void set_flow_through(RoomBoundary& boundary, const ParameterValues& values) const {
        auto* flow = std::get_if<ThroughFlow>(&boundary.flow);
        if (flow == nullptr) return;
        flow->area = area_of(boundary, scene_);
        if (values.has("boundary.flow.inflow_m3_s") || values.has("boundary.flow.outflow_m3_s"))
            for (auto& [time, speed] : flow->speed) speed /= flow->area;
    }

    /// Discs and rectangles lie on their side, bands between bottom and top.
    void require_on_sides(const RoomBoundary& boundary, const std::string& where) {
        const double allowed = 1e-6 * scene_.size.maxCoeff();
        for (const coupling::DomainSide side : boundary.sides) {
            const RegionBox whole = bounds_of(WholeSide{}, side, scene_), part = bounds_of(boundary.part, side, scene_);
            const bool inside =
                (part.lower.array() >= whole.lower.array() - allowed).all() && (part.upper.array() <= whole.upper.array() + allowed).all();
            const bool has_area = ((part.upper - part.lower).array() > 0.0).count() == 2;
            if (inside && has_area && distance_to_side(boundary.part, side) <= allowed) continue;
            return refuse(where, fmt::format("{} is about no part of the side {}", boundary.name, k_sides[static_cast<std::size_t>(side)]),
                          fmt::format("The side reaches from {} to {} m", text_of(whole.lower), text_of(whole.upper)),
                          "Correct the disc, rectangle or level");
        }
    }

    double distance_to_side(const SidePart& part, coupling::DomainSide side) const {
        const auto number = static_cast<std::size_t>(side);
        const auto axis = static_cast<Eigen::Index>(number / 2);
        const double position = (number % 2 == 0 ? scene_.lower() : scene_.upper())[axis];
        if (const auto* disc = std::get_if<SideDisc>(&part)) return std::abs(disc->centre[axis] - position);
        if (const auto* rectangle = std::get_if<SideRectangle>(&part))
            return std::max(std::abs(rectangle->lower[axis] - position), std::abs(rectangle->upper[axis] - position));
        return 0.0;
    }

    void set_sides(const std::vector<coupling::DomainSide>& sides, const std::string& word, const std::string& where) {
        const SideForGrains kind = word == "open"           ? SideForGrains::open
                                   : word == "frictionless" ? SideForGrains::frictionless
                                                            : SideForGrains::wall;
        for (const coupling::DomainSide side : sides) {
            const auto [given, is_new] = grains_at_.emplace(side, word);
            if (!is_new && given->second != word)
                refuse(where, fmt::format("boundary.grains = \"{}\" where another table says \"{}\"", word, given->second),
                       "A side is one thing to grains, all over", "Remove one of them");
            scene_.sides[static_cast<std::size_t>(side)] = kind;
        }
    }

    std::optional<SideFlow> read_flow(const ParameterValues& values, const std::string& where) {
        if (values.has("boundary.flow")) {
            const std::string& word = values.text("boundary.flow");
            if (word == "slip") return Slip{};
            if (word == "pressure") return FixedPressure{};
            return NoSlip{};
        }
        if (values.where("boundary.flow").empty()) return std::nullopt;
        std::vector<std::string> given;
        for (const char* key : {"rough_m", "inflow_m_s", "outflow_m_s", "inflow_m3_s", "outflow_m3_s", "speeds_m_s"})
            if (values.has(std::string("boundary.flow.") + key)) given.emplace_back(key);
        if (given.size() != 1) {
            refuse(where, fmt::format("boundary.flow has {}", given.empty() ? "no kind" : fmt::format("{}", fmt::join(given, " and "))),
                   "It has one of rough_m, inflow_m_s, outflow_m_s, inflow_m3_s, outflow_m3_s, speeds_m_s",
                   given.empty() ? "Add one" : "Remove all but one");
            return std::nullopt;
        }
        if (given.front() == "rough_m") return RoughWall{values.number("boundary.flow.rough_m")};
        ThroughFlow flow;
        flow.into_room = given.front().rfind("outflow", 0) != 0;
        if (given.front() == "speeds_m_s") return with_table(values, flow, where);
        const double speed = values.number("boundary.flow." + given.front()), ramp = number_or(values, "boundary.flow.ramp_s", 0.0);
        if (ramp > 0.0) flow.speed.emplace_back(0.0, 0.0);
        flow.speed.emplace_back(ramp, speed);
        return flow;
    }

    std::optional<SideFlow> with_table(const ParameterValues& values, ThroughFlow flow, const std::string& where) {
        const std::vector<double> times =
            values.has("boundary.flow.times_s") ? values.numbers("boundary.flow.times_s") : std::vector<double>{};
        const std::vector<double>& speeds = values.numbers("boundary.flow.speeds_m_s");
        if (times.size() != speeds.size() || !std::is_sorted(times.begin(), times.end(), std::less_equal<>())) {
            refuse(where, fmt::format("{} times_s and {} speeds_m_s", times.size(), speeds.size()),
                   "There is a time for every speed, and times rise", "Correct them");
            return std::nullopt;
        }
        for (std::size_t i = 0; i < times.size(); ++i) flow.speed.emplace_back(times[i], speeds[i]);
        return flow;
    }

    std::optional<SidePart> read_part(const ParameterValues& values, const RoomBoundary& boundary, const std::string& where) {
        std::vector<std::string> given;
        for (const char* key : {"boundary.inside", "boundary.disc", "boundary.rectangle"})
            if (!values.where(key).empty()) given.emplace_back(key);
        const bool band = values.has("boundary.above_m") || values.has("boundary.below_m");
        if (band) given.emplace_back("above_m or below_m");
        if (given.size() > 1) {
            refuse(where, fmt::format("{} in one table", fmt::join(given, " and ")), "A table is about one part of its sides",
                   "Write two tables");
            return std::nullopt;
        }
        if (given.empty()) return WholeSide{};
        if (band) return SideBand{number_or(values, "boundary.above_m", 0.0), number_or(values, "boundary.below_m", scene_.size.z())};
        if (boundary.sides.size() > 1) {
            refuse(where, fmt::format("{} on several sides", given.front()), "A disc or rectangle lies on one side", "Name the side");
            return std::nullopt;
        }
        if (given.front() == "boundary.disc") {
            if (!has_all(values, "boundary.disc", {"centre_m", "radius_m"}, where)) return std::nullopt;
            return SideDisc{vec3_of(values, "boundary.disc.centre_m"), values.number("boundary.disc.radius_m")};
        }
        if (given.front() == "boundary.rectangle") {
            if (!has_all(values, "boundary.rectangle", {"lower_m", "upper_m"}, where)) return std::nullopt;
            return SideRectangle{vec3_of(values, "boundary.rectangle.lower_m"), vec3_of(values, "boundary.rectangle.upper_m")};
        }
        return part_inside(values, boundary.sides.front());
    }

    std::optional<SidePart> part_inside(const ParameterValues& values, coupling::DomainSide side) {
        const std::string& name = values.text("boundary.inside");
        const auto solid = std::find_if(scene_.solids.begin(), scene_.solids.end(), [&](const RoomSolid& one) { return one.name == name; });
        if (solid == scene_.solids.end() || !solid->bore) {
            refuse(values.where("boundary.inside"), fmt::format("boundary.inside = \"{}\"", name),
                   "It names a solid that is a pipe, a tube or a ring", "Correct it");
            return std::nullopt;
        }
        const auto number = static_cast<std::size_t>(side);
        const auto axis = static_cast<Eigen::Index>(number / 2);
        const double position = (number % 2 == 0 ? scene_.lower() : scene_.upper())[axis];
        const Vec3 along = (solid->bore->to - solid->bore->from).normalized();
        const bool ends_there = std::min(std::abs(solid->bore->from[axis] - position), std::abs(solid->bore->to[axis] - position)) <
                                1e-6 * scene_.size.maxCoeff();
        if (!ends_there || std::abs(std::abs(along[axis]) - 1.0) > 1e-6) {
            refuse(values.where("boundary.inside"),
                   fmt::format("{} does not meet the side {} at a right angle", name, values.text("boundary.on")),
                   "The bore cuts a disc out of the side", "End the pipe on the side, or give disc");
            return std::nullopt;
        }
        Vec3 centre = solid->bore->from;
        centre[axis] = position;
        return SideDisc{centre, solid->bore->radius};
    }

    /// What flows in flows out, through a part where the pressure is given: flows that are both given differ by rounding at least.
    void require_balanced_flow() {
        bool in = false, out = false, pressure = false;
        for (const RoomBoundary& boundary : scene_.boundaries) {
            pressure = pressure || std::holds_alternative<FixedPressure>(boundary.flow);
            if (const auto* flow = std::get_if<ThroughFlow>(&boundary.flow)) (flow->into_room ? in : out) = true;
        }
        if (pressure || (!in && !out)) return;
        refuse(boundary_places_.front(), in ? "an inflow without an outlet" : "an outflow without an inlet",
               "What comes into a closed room leaves it at once", "Add a boundary with flow = \"pressure\"");
    }

    /// Later tables cover earlier ones, but a flow has the area that its table gives.
    void require_whole_flows() {
        const std::vector<RoomBoundary>& all = scene_.boundaries;
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t later = i + 1; later < all.size(); ++later)
                if (std::holds_alternative<ThroughFlow>(all[i].flow) && overlap(all[i], all[later], scene_))
                    refuse(boundary_places_[later], fmt::format("{} covers a part of {}", all[later].name, all[i].name),
                           "Later tables cover earlier ones, and a flow goes through the whole of its part",
                           "Write the flow's table last, or give it a disc or a rectangle that nothing covers");
    }

    /// Sides, solids and boundaries are patches of one mesh.
    void require_patch_names() {
        if (!scene_.medium.present()) return;
        std::set<std::string> names(k_sides.begin(), k_sides.end());
        const auto require_free = [&](const std::string& name, const std::string& key, const std::string& where) {
            if (names.count(name) > 0)
                refuse(where, fmt::format("{} = \"{}\" is the name of another solid, side or boundary", key, name),
                       "Each is a patch of the mesh with a name of its own", "Change it");
        };
        for (const ParameterValues& solid : values_.tables("solid"))
            require_free(solid.text("solid.name"), "solid.name", solid.where("solid.name"));
        names.insert(solid_names_.begin(), solid_names_.end());
        for (std::size_t i = 0; i < scene_.boundaries.size(); ++i) {
            const std::string& name = scene_.boundaries[i].name;
            require_name(name, "boundary.name", boundary_places_[i]);
            require_free(name, "boundary.name", boundary_places_[i]);
            names.insert(name);
        }
    }

    // --------------------------------------------------------- preparation

    std::optional<Region> region_of_step(const ParameterValues& values, const std::string& where) {
        const bool has_above = values.has("prepare.above_m"), has_below = values.has("prepare.below_m");
        std::optional<Region> region = read_region(values, "prepare.region", where);
        if (has_above + has_below + region.has_value() > 1) {
            refuse(where, "more than one of region, above_m and below_m", "A step has one region", "Remove all but one");
            return std::nullopt;
        }
        if (has_above) region = above(values.number("prepare.above_m"));
        if (has_below) region = below(values.number("prepare.below_m"));
        return region;
    }

    void read_step(const ParameterValues& values) {
        const std::string& what = values.text("prepare.do");
        const std::string where = values.where("prepare.do");
        if (what != "pour")
            refuse_keys(values, {"prepare.grains", "prepare.depth_m", "prepare.mass_kg", "prepare.count"}, "It belongs to do = \"pour\"");
        if (what != "settle" && what != "compress")
            refuse_keys(values, {"prepare.longest_s"}, "It belongs to do = \"settle\" and \"compress\"");
        if (what != "compress")
            refuse_keys(values, {"prepare.solid", "prepare.direction", "prepare.pressure_pa"}, "It belongs to do = \"compress\"");
        if (what == "settle") {
            refuse_keys(values, {"prepare.above_m", "prepare.below_m", "prepare.region"}, "All grains settle");
            scene_.preparation.emplace_back(SettleStep{number_or(values, "prepare.longest_s", k_longest_settling)});
            return;
        }
        if (what == "compress") {
            refuse_keys(values, {"prepare.above_m", "prepare.below_m", "prepare.region"}, "A solid compresses what is in its way");
            return read_compress(values, where);
        }
        const std::optional<Region> region = region_of_step(values, where);
        if (what == "pour") return read_pour(values, region, where);
        if (!region)
            return refuse(where, fmt::format("do = \"{}\" without a region", what), "It is about a part of the room",
                          "Add above_m, below_m or region");
        require_in_room(*region, fmt::format("do = \"{}\"", what), where);
        if (what == "trim") scene_.preparation.emplace_back(TrimStep{*region});
        if (what == "freeze") scene_.preparation.emplace_back(FreezeStep{*region});
    }

    void read_compress(const ParameterValues& values, const std::string& where) {
        const auto pressure = required(values, "prepare.pressure_pa", "do = \"compress\"", "prepare.do");
        const RoomSolid* solid = pressed_solid(values, where);
        const Vec3 given = values.has("prepare.direction") ? vec3_of(values, "prepare.direction") : Vec3(-Vec3::UnitZ());
        if (given.norm() == 0.0)
            refuse(values.where("prepare.direction"), "prepare.direction = [0, 0, 0]", "It must not be zero", "Correct it");
        if (!pressure || solid == nullptr || given.norm() == 0.0) return;
        const Vec3 direction = given.normalized();
        scene_.preparation.emplace_back(CompressStep{solid->name, direction, *pressure,
                                                     *pressure * geometry::area_seen_along(solid->surface, direction),
                                                     number_or(values, "prepare.longest_s", k_longest_settling)});
    }

    /// Null with a mistake, or when the solid's own mistakes are told.
    const RoomSolid* pressed_solid(const ParameterValues& values, const std::string& where) {
        if (!values.has("prepare.solid")) {
            refuse(where, "do = \"compress\" without solid", "A solid presses on the grains", "Name it");
            return nullptr;
        }
        const RoomSolid* solid = scene_.find_solid(values.text("prepare.solid"));
        if (solid == nullptr)
            refuse_unknown(values, "prepare.solid", {solid_names_.begin(), solid_names_.end()}, "solids");
        else
            refuse_in_medium(*solid, values.where("prepare.solid"), "is pressed");
        return solid;
    }

    const RoomGrains* grains_of(const ParameterValues& values, const std::string& key, const std::string& where) {
        if (!values.has(key)) {
            refuse(where, fmt::format("{} is missing", key), "It names a kind of grains", "Add it");
            return nullptr;
        }
        const RoomGrains* grains = scene_.find_grains(values.text(key));
        if (grains == nullptr) {
            std::vector<std::string> names;
            for (const ParameterValues& one : values_.tables("grains")) names.push_back(one.text("grains.name"));
            refuse_unknown(values, key, names, "grains");
        }
        return grains;
    }

    /// A key names a table that the study has not. One of `names` was read with mistakes, which are told.
    void refuse_unknown(const ParameterValues& values, const std::string& key, const std::vector<std::string>& names,
                        const std::string& tables) {
        if (std::find(names.begin(), names.end(), values.text(key)) != names.end()) return;
        const std::string nearest = nearest_word(values.text(key), names);
        refuse(values.where(key), fmt::format("{} = \"{}\"", key, values.text(key)),
               names.empty() ? fmt::format("The study has no {}", tables)
                             : fmt::format("The study's {} are {}", tables, fmt::join(names, ", ")),
               nearest.empty() ? "Correct it" : fmt::format("Did you mean {}?", nearest));
    }

    /// A box or upright cylinder, in which grains begin; the room without one.
    std::optional<Region> region_for_grains(const std::optional<Region>& given, const std::string& where) {
        if (!given) return RegionBox{scene_.lower(), scene_.upper()};
        if (const auto* box = std::get_if<RegionBox>(&*given)) {
            if (const RegionBox cut{box->lower.cwiseMax(scene_.lower()), box->upper.cwiseMin(scene_.upper())};
                (cut.lower.array() < cut.upper.array()).all())
                return cut;
        } else if (const auto* cylinder = std::get_if<RegionCylinder>(&*given)) {
            const bool upright = cylinder->from.head<2>() == cylinder->to.head<2>();
            if (upright && cylinder->from.z() < cylinder->to.z() && meets_room(*given)) return given;
            if (!upright || cylinder->from.z() > cylinder->to.z()) {
                refuse(where, fmt::format("a cylinder from {} to {}", text_of(cylinder->from), text_of(cylinder->to)),
                       "Grains begin in an upright cylinder, from below to above", "Correct it");
                return std::nullopt;
            }
        } else {
            refuse(where, "grains begin in a region of this kind", "They begin in a box or an upright cylinder", "Use one of them");
            return std::nullopt;
        }
        require_in_room(*given, "do", where);
        return std::nullopt;
    }

    void read_pour(const ParameterValues& values, const std::optional<Region>& given, const std::string& where) {
        const RoomGrains* grains = grains_of(values, "prepare.grains", where);
        const std::optional<Region> region = region_for_grains(given, where);
        const bool depth = values.has("prepare.depth_m"), mass = values.has("prepare.mass_kg"), count = values.has("prepare.count");
        if (depth + mass + count != 1)
            return refuse(where, fmt::format("a pour with {} of depth_m, mass_kg and count", depth + mass + count), "It has one of them",
                          "Correct it");
        if (grains == nullptr || !region) return;
        PourStep pour{grains->name, *region, 0.0, where};
        if (depth) pour.mass = grains->density * k_packed_share * area_of(*region) * values.number("prepare.depth_m");
        if (mass) pour.mass = values.number("prepare.mass_kg");
        if (count) {
            pour.count = static_cast<std::size_t>(values.integer("prepare.count"));
            pour.mass = static_cast<double>(*pour.count) * grains->density * grains->mean_volume();
        }
        const double bulk = pour.mass / (grains->density * k_packed_share), place = area_of(*region) * height_of(*region);
        if (bulk > place)
            return refuse(where, fmt::format("poured grains fill {:.3g} m3", bulk), fmt::format("Their region holds {:.3g} m3", place),
                          "Pour less, or give a larger region");
        scene_.preparation.emplace_back(pour);
    }

    void require_ordered_preparation() {
        bool poured = false;
        const auto& steps = values_.tables("prepare");
        for (const ParameterValues& step : steps) {
            const std::string& what = step.text("prepare.do");
            if (what != "pour" && !poured) {
                refuse(step.where("prepare.do"), fmt::format("do = \"{}\" before anything is poured", what), "The first step pours",
                       "Move it");
                return;
            }
            poured = true;
        }
    }

    // -------------------------------------------------------------- events

    void read_event(const ParameterValues& values) {
        const std::string& what = values.text("event.do");
        const std::string where = values.where("event.do");
        const bool lasting = what == "feed" || what == "extract";
        if (lasting)
            refuse_keys(values, {"event.at_s"}, fmt::format("do = \"{}\" lasts from from_s to to_s", what));
        else
            refuse_keys(values, {"event.from_s", "event.to_s", "event.rate_kg_s"}, fmt::format("do = \"{}\" happens at at_s", what));
        if (what != "feed") refuse_keys(values, {"event.grains"}, "It belongs to do = \"feed\"");
        const std::optional<Region> region = read_region(values, "event.region", where);
        if (!region && values.where("event.region").empty() && what != "feed")
            refuse(where, fmt::format("do = \"{}\" without a region", what), "It is about a part of the room", "Add region");
        if (region) require_in_room(*region, fmt::format("do = \"{}\"", what), where);
        if (!lasting) {
            const auto at = required(values, "event.at_s", fmt::format("do = \"{}\"", what), "event.do");
            if (at) require_in_run(*at, "event.at_s", values);
            if (at && region) scene_.events.emplace_back(RegionEvent{what, *at, *region});
            return;
        }
        const auto from = required(values, "event.from_s", what, "event.do"), to = required(values, "event.to_s", what, "event.do"),
                   rate = required(values, "event.rate_kg_s", what, "event.do");
        if (from) require_in_run(*from, "event.from_s", values);
        if (from && to && *from >= *to)
            refuse(values.where("event.to_s"), fmt::format("event.to_s = {:g}", *to), fmt::format("It is after from_s = {:g}", *from),
                   "Correct one of them");
        if (!from || !to || !rate) return;
        if (what == "extract") {
            if (region) scene_.events.emplace_back(ExtractEvent{*from, *to, *rate, *region});
            return;
        }
        const RoomGrains* grains = grains_of(values, "event.grains", where);
        const std::optional<Region> place = region_for_grains(region, where);
        if (grains == nullptr || !place) return;
        const double fed = *rate * (*to - *from) / (grains->density * grains->mean_volume());
        if (fed > k_most_fed)
            return refuse(values.where("event.rate_kg_s"), fmt::format("a feed of {:.3g} grains", fed),
                          fmt::format("A feed has at most {:g}", k_most_fed), "Feed less, or larger grains");
        scene_.events.emplace_back(FeedEvent{grains->name, *from, *to, *rate, *place});
    }

    /// A stop rule may end the run earlier, none later.
    void require_in_run(double at, const char* key, const ParameterValues& values) {
        const double end = values_.number("run.end_s");
        if (at > end)
            refuse(values.where(key), fmt::format("{} = {:g}", key, at), fmt::format("The run ends at {:g} s", end), "Correct one of them");
    }

    // ----------------------------------------------------------------- run

    /// The rules of every table by itself, then those of the sound ones in their room.
    void read_measures() {
        std::set<std::string> names;
        std::vector<const ParameterValues*> sound;
        scene_.measures = nlohmann::json::array();
        for (const ParameterValues& measure : values_.tables("measure")) {
            const std::string &name = measure.text("measure.name"), where = measure.where("measure.name");
            if (!names.insert(name).second)
                refuse(where, fmt::format("measure.name = \"{}\" is given twice", name), "Every measure has a name of its own",
                       "Change one");
            const std::vector<Mistake> mistakes = measure_mistakes(measure);
            mistakes_.add(mistakes);
            if (!mistakes.empty()) {
                wrong_measures_.insert(name);
                continue;
            }
            sound.push_back(&measure);
            scene_.measures.push_back(measure_json(measure));
        }
        scene_.gates = gates_of(scene_.measures);
        for (const ParameterValues* measure : sound) check_measure(*measure);
    }

    void check_measure(const ParameterValues& measure) {
        const std::string &name = measure.text("measure.name"), where = measure.where("measure.name");
        if (measure.text("measure.what") == "pressure_drop" && !scene_.medium.present())
            refuse(where, "measure.what = \"pressure_drop\" in a room without a medium", "Without a medium there is no pressure",
                   "Remove the measure, or choose a room.medium");
        if (measure.has("measure.against") && !fs::is_regular_file(folder_ / measure.text("measure.against")))
            refuse(measure.where("measure.against"),
                   fmt::format("measure.against: there is no file {}", (folder_ / measure.text("measure.against")).string()),
                   "It is a CSV file of a profile; its path is relative to the study", "Correct the path, or put the file there");
        check_places(measure);
        for (const char* key : {"measure.at_s", "measure.from_s"})
            if (measure.has(key)) require_in_run(measure.number(key), key, measure);
        if (find_gate(name) != nullptr) require_name(name, "measure.name", where);
        if (measure.has("measure.gate") && find_gate(measure.text("measure.gate")) == nullptr &&
            wrong_measures_.count(measure.text("measure.gate")) == 0)
            refuse(measure.where("measure.gate"), fmt::format("measure.gate = \"{}\"", measure.text("measure.gate")),
                   "It names a measure that places a gate, or places one itself",
                   "Correct it, or write gate = { disc_m = [x, y, z], radius_m = r }");
        if (measure.has("measure.wall") && !is_wall(measure.text("measure.wall")))
            refuse(measure.where("measure.wall"), fmt::format("measure.wall = \"{}\"", measure.text("measure.wall")),
                   "It names a solid, or a side of the room that is a wall", "Correct it");
    }

    /// Region, gate and points of a measure are in the room; gates and points may lie on its sides.
    void check_places(const ParameterValues& measure) {
        const std::string& name = measure.text("measure.name");
        if (const std::optional<Region> region = read_region(measure, "measure.region", measure.where("measure.name")))
            require_in_room(*region, "measure." + name, place_of(measure, "measure.region", "measure.name"));
        if (measure.has("measure.gate.disc_m")) {
            const RoomGate& gate = *find_gate(name);
            const Vec3 reach = gate.radius * (1.0 - gate.normal.array().square()).max(0.0).sqrt().matrix();
            require_place(measure, "measure.gate.disc_m", gate.centre - reach, gate.centre + reach);
        }
        if (measure.has("measure.gate.lower_m")) {
            const RoomGate& gate = *find_gate(name);
            require_place(measure, "measure.gate.lower_m", gate.lower.cwiseMin(gate.upper), gate.lower.cwiseMax(gate.upper));
        }
        for (const char* key : {"measure.upstream_m", "measure.downstream_m"})
            if (measure.has(key)) require_place(measure, key, vec3_of(measure, key), vec3_of(measure, key));
        check_levels(measure);
    }

    /// Levels and the axis of a heap are in the room, and so is a part of a profile.
    void check_levels(const ParameterValues& measure) {
        for (const char* key : {"measure.base_m", "measure.undisturbed_m"})
            if (measure.has(key)) require_interval(measure, key, 2, measure.number(key), measure.number(key));
        if (measure.has("measure.centre_m"))
            for (int axis = 0; axis < 2; ++axis) {
                const double at = measure.numbers("measure.centre_m")[axis];
                require_interval(measure, "measure.centre_m", axis, at, at);
            }
        const int along = measure.has("measure.along") && measure.text("measure.along") == "y" ? 1 : 0;
        if (measure.has("measure.from_m"))
            require_interval(measure, "measure.from_m", along, measure.number("measure.from_m"), scene_.upper()[along]);
        if (measure.has("measure.to_m"))
            require_interval(measure, "measure.to_m", along, scene_.lower()[along], measure.number("measure.to_m"));
    }

    /// \param from,to  what the key places along an axis, 0 to 2
    void require_interval(const ParameterValues& measure, const char* key, int axis, double from, double to) {
        const double allowed = 1e-6 * scene_.size.maxCoeff();
        if (from <= to && from <= scene_.upper()[axis] + allowed && to >= scene_.lower()[axis] - allowed) return;
        refuse(measure.where(key), fmt::format("{} of {} lies outside the room along {}", key, measure.text("measure.name"), "xyz"[axis]),
               room_rule(), "Correct it");
    }

    /// \param lower,upper  corners of the box around what the key places
    void require_place(const ParameterValues& measure, const char* key, const Vec3& lower, const Vec3& upper) {
        const double allowed = 1e-6 * scene_.size.maxCoeff();
        if ((lower.array() <= scene_.upper().array() + allowed).all() && (upper.array() >= scene_.lower().array() - allowed).all()) return;
        refuse(measure.where(key),
               fmt::format("{} = {} of {} lies outside the room", key, text_of(vec3_of(measure, key)), measure.text("measure.name")),
               room_rule(), "Correct it");
    }

    const RoomGate* find_gate(const std::string& name) const {
        const auto found = std::find_if(scene_.gates.begin(), scene_.gates.end(), [&](const RoomGate& gate) { return gate.name == name; });
        return found == scene_.gates.end() ? nullptr : &*found;
    }

    bool is_wall(const std::string& name) const {
        if (solid_names_.count(name) > 0) return true;
        const auto side = std::find(coupling::k_domain_sides.begin(), coupling::k_domain_sides.end(), name);
        if (side == coupling::k_domain_sides.end()) return false;
        return scene_.sides[static_cast<std::size_t>(side - coupling::k_domain_sides.begin())] != SideForGrains::open;
    }

    void read_run() {
        RoomRun& run = scene_.run;
        run.end = values_.number("run.end_s");
        run.write_interval = number_or(values_, "run.write_interval_s", run.end / k_pictures);
        run.checkpoint_interval = number_or(values_, "run.checkpoint_interval_s", run.end / k_checkpoints);
        for (const char* key : {"run.write_interval_s", "run.checkpoint_interval_s"})
            if (values_.has(key) && values_.number(key) > run.end)
                refuse(values_.where(key), fmt::format("{} = {:g}", key, values_.number(key)),
                       fmt::format("The run ends at {:g} s", run.end), "Correct one of them");
        for (const char* key : {"run.write_interval_s", "run.checkpoint_interval_s"})
            if (values_.has(key) && values_.number(key) < run.end / k_most_outputs)
                refuse(values_.where(key), fmt::format("{} = {:g} in a run of {:g} s", key, values_.number(key), run.end),
                       fmt::format("A run has at most {:g} of them", k_most_outputs), "Write less often");
        const double fall =
            scene_.grains.empty() || scene_.gravity.norm() == 0.0 ? 1.0 : std::sqrt(scene_.smallest_grain() / scene_.gravity.norm());
        scene_.bed_step = number_or(values_, "dem.longest_step_s", k_look_per_fall * fall);
        run.longest_step = std::min(scene_.bed_step, run.write_interval);
        run.seed = static_cast<std::uint64_t>(values_.integer("run.seed"));
        read_stop();
    }

    void read_stop() {
        const bool idle = values_.has("run.stop.measure") || values_.has("run.stop.idle_s");
        const bool settled = values_.has("run.stop.settled") && values_.boolean("run.stop.settled");
        const std::string where = values_.where("run.stop");
        if (idle && settled) return refuse(where, "run.stop with a measure and settled", "A run has one stop rule", "Remove one of them");
        if (settled) scene_.run.stop = StopWhenAtRest{};
        if (!idle) return;
        if (!values_.has("run.stop.measure") || !values_.has("run.stop.idle_s"))
            return refuse(where, "run.stop has only one of measure and idle_s", "Nothing passes the gate of a measure for a time",
                          "Give both");
        const std::string name = gate_of(values_.text("run.stop.measure"));
        if (wrong_measures_.count(values_.text("run.stop.measure")) > 0) return;  // its gate was not read
        if (name.empty())
            return refuse(where, fmt::format("run.stop.measure = \"{}\"", values_.text("run.stop.measure")),
                          "It names a measure with a gate", "Correct it");
        scene_.run.stop = StopWhenIdle{name, values_.number("run.stop.idle_s")};
    }

    /// The gate of a measure: its own, or the one that it names; empty without one.
    std::string gate_of(const std::string& measure) const {
        if (find_gate(measure) != nullptr) return measure;
        for (const ParameterValues& table : values_.tables("measure"))
            if (table.text("measure.name") == measure && table.has("measure.gate")) return table.text("measure.gate");
        return "";
    }

    void require_something() {
        if (values_.tables("grains").empty())
            refuse(values_.where("room.size_m"), "The room has no grains", "Rooms are studies of grains; a flow alone is any OpenFOAM case",
                   "Add [[grains]]");
        const bool comes = std::any_of(scene_.events.begin(), scene_.events.end(),
                                       [](const RoomEvent& event) { return std::holds_alternative<FeedEvent>(event); });
        if (!values_.tables("grains").empty() && values_.tables("prepare").empty() && !comes && values_.tables("event").empty())
            refuse(values_.tables("grains").front().where("grains.name"), "No grains come into the room",
                   "They are poured before the run or fed in it", "Add [[prepare]] with do = \"pour\", or [[event]] with do = \"feed\"");
    }

    const ParameterValues& values_;
    fs::path folder_;
    RoomScene scene_;
    Mistakes mistakes_;
    std::set<std::string> solid_names_, wrong_measures_;
    std::map<coupling::DomainSide, std::string> grains_at_;
    std::vector<std::string> boundary_places_;  ///< of scene_.boundaries, in the study
};

}  // namespace

RoomScene room_scene(const ParameterValues& values, const fs::path& folder) {
    return RoomReader(values, folder).read();
}

RoomScene read_room(const fs::path& study) {
    return room_scene(read_parameters(room_table(), study), study.parent_path());
}

ParameterValues read_placed_room(const fs::path& study) {
    ParameterValues values = read_parameters(room_table(), study);
    const auto place = [&](ParameterValues& table, const char* key) {
        if (table.has(key)) table.set(key, fs::absolute(study.parent_path() / table.text(key)).lexically_normal().string());
    };
    for (ParameterValues& solid : values.tables_for_writing("solid")) place(solid, "solid.file");
    for (ParameterValues& grains : values.tables_for_writing("grains")) place(grains, "grains.shape");
    for (ParameterValues& measure : values.tables_for_writing("measure")) place(measure, "measure.against");
    return values;
}

}  // namespace cutterflow::cases
