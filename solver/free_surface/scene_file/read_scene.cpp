/// \file The scene of a file: its domain, water, gauges, contacts and run, and the order in which its tables are read.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "solver/free_surface/body_list.hpp"
#include "solver/free_surface/cut_cells/close_places.hpp"
#include "solver/free_surface/scene_file/scene_file_reading.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr double k_smallest_gap = 0.25;  // cells
constexpr double k_most_outputs = 1e4;
constexpr double k_most_cells = 5e6;  // of a tank, with k_bytes_per_cell 3 GB; also the bound of a room's mesh

/// The bodies of a scene as they stand at its start.
std::vector<Body> bodies_of(const Scene& scene) {
    std::vector<Body> bodies;
    for (std::size_t n = 0; n < scene.bodies.size(); ++n)
        bodies.push_back(body_of(scene.bodies, n, scene.settings.spheres, scene.settings.tank.depth));
    return bodies;
}

/// Of a tank's edge; a plane tank has one cell across.
double count_cells(const SceneFileReading& reading, const std::string& key) {
    return std::max(4.0, std::round(reading.values.number(key) / reading.cell()));
}

/// Nothing in the tank is read when this throws: its counts would be as large.
void require_affordable_cells(const SceneFileReading& reading) {
    const double cells = count_cells(reading, "domain.width_m") * (reading.plane() ? 1.0 : count_cells(reading, "domain.length_m")) *
                         count_cells(reading, "domain.height_m");
    if (cells > k_most_cells)
        throw UserError(
            std::vector<Mistake>{{reading.values.where("domain.cell_m"), fmt::format("The tank has {:.3g} cells", cells),
                                  fmt::format("It has at most {:g}", k_most_cells), "Make domain.cell_m larger, or the tank smaller"}});
}

int whole_cells(SceneFileReading& reading, const std::string& key) {
    const double length = reading.values.number(key);
    const int cells = static_cast<int>(count_cells(reading, key));
    if (std::abs(cells * reading.cell() - length) > 1e-6 * length)
        reading.scene.notes.push_back(
            fmt::format("{} = {:g} m is no whole number of cells: {:g} m is used", key, length, cells * reading.cell()));
    return cells;
}

void read_domain(SceneFileReading& reading) {
    reading.scene.name = reading.values.text("name");
    TankSettings& tank = reading.scene.settings.tank;
    tank.cell = reading.values.number("domain.cell_m");
    tank.plane = reading.values.text("domain.dimensions") == "plane";
    tank.depth = reading.values.number("domain.length_m");
    require_affordable_cells(reading);
    tank.cells = {whole_cells(reading, "domain.width_m"), tank.plane ? 1 : whole_cells(reading, "domain.length_m"),
                  whole_cells(reading, "domain.height_m")};
    if (!tank.plane) tank.depth = tank.cells[1] * tank.cell;
}

void read_water(SceneFileReading& reading) {
    WaterSettings& water = reading.scene.settings.water;
    water.density = reading.values.number("water.density_kg_m3");
    water.kinematic_viscosity = reading.values.number("water.kinematic_viscosity_m2_s");
    for (const ParameterValues& fill : reading.values.tables("fill")) {
        const Interval y = reading.across(fill, "fill.from_y_m", "fill.to_y_m");
        const Vec3 from(fill.number("fill.from_x_m"), y.from, fill.number("fill.from_z_m"));
        const Vec3 to(fill.number("fill.to_x_m"), y.to, fill.number("fill.to_z_m"));
        const std::string where = fill.where("fill.from_x_m");
        const std::string box = fmt::format("Water from ({:g}, {:g}) to ({:g}, {:g}) m", from.x(), from.z(), to.x(), to.z());
        if (from.x() >= to.x() || from.z() >= to.z())
            reading.refuse(where, box, "Its lower corner must come first", "Exchange the corners");
        // A domain that was rounded down to whole cells may be filled to its given end.
        const double end_x = std::max(reading.width(), reading.values.number("domain.width_m")) + k_tolerance;
        const double end_z = std::max(reading.height(), reading.values.number("domain.height_m")) + k_tolerance;
        const double end_y = std::max(reading.depth(), reading.values.number("domain.length_m")) + k_tolerance;
        if (to.x() > end_x || to.z() > end_z || (fill.has("fill.to_y_m") && to.y() > end_y) || from.y() >= end_y)
            reading.refuse(where, box, fmt::format("It must lie in the domain of {}", reading.text_of_domain()), "Make it smaller");
        for (const WaterBox& other : water.filled) {
            if ((from.array() < other.to.array() - k_tolerance).all() && (to.array() > other.from.array() + k_tolerance).all())
                reading.refuse(where, box + " overlaps another box", "Water is filled in once", "Make one of them smaller");
        }
        water.filled.push_back({from, to});
    }
}

void read_gauge(SceneFileReading& reading, const ParameterValues& values) {
    reading.refuse_in_plane(values, {"gauge.y_m"});
    Gauge gauge{values.text("gauge.name"), values.number("gauge.x_m"), 0.5 * reading.depth(), {}};
    if (values.has("gauge.y_m")) gauge.y = values.number("gauge.y_m");
    if (values.has("gauge.z_m")) gauge.z = values.number("gauge.z_m");
    const std::string where = values.where("gauge.name");
    if (gauge.name.empty() || gauge.name.find_first_of(",\"\n\r") != std::string::npos)
        reading.refuse(where, fmt::format("gauge.name = \"{}\"", gauge.name), "A name is not empty and has no comma, quote or line break",
                       "Change it");
    const auto same = [&](const Gauge& other) { return other.name == gauge.name; };
    if (std::any_of(reading.scene.gauges.begin(), reading.scene.gauges.end(), same))
        reading.refuse(where, fmt::format("gauge.name = \"{}\" is given twice", gauge.name), "Every gauge has a name of its own",
                       "Change one");
    const double z = gauge.z.value_or(0.0);
    const Vec3 place(gauge.x, gauge.y, z);
    if (gauge.x > reading.width() || (!reading.plane() && gauge.y > reading.depth()) || z > reading.height())
        reading.refuse(values.where("gauge.x_m"), fmt::format("Gauge {} at {} lies outside the domain", gauge.name, reading.text_of(place)),
                       fmt::format("The domain is {}", reading.text_of_domain()), "Move it");
    const auto holds_it = [&](const StillSolid& solid) { return is_inside(solid, place); };
    if (gauge.z && std::any_of(reading.scene.settings.solids.begin(), reading.scene.settings.solids.end(), holds_it))
        reading.refuse(values.where("gauge.z_m"), fmt::format("Gauge {} at {} stands in a solid", gauge.name, reading.text_of(place)),
                       "It reads the pressure of water", "Move it");
    reading.scene.gauges.push_back(std::move(gauge));
}

void read_contact(SceneFileReading& reading) {
    coupling::DemSettings& dem = reading.scene.dem;
    dem.law = coupling::ContactLaw::linear;
    dem.linear.theta = reading.values.number("contact.theta");
    dem.linear.reference_length = reading.values.number("contact.reference_length_m");
    dem.linear.damping = reading.values.number("contact.damping");
    dem.linear.poisson = reading.values.number("contact.poisson");
    dem.linear.accumulated_shear = reading.values.text("contact.shear") == "accumulated";
    dem.contact.set_every_pair({reading.values.number("contact.friction"), dem.contact.rock_rock.restitution, 0.0});
    dem.contact.wet_restitution = false;
    if (dem.linear.damping >= std::sqrt(0.5))
        reading.refuse(reading.values.where("contact.damping"), fmt::format("contact.damping = {:g}", dem.linear.damping),
                       "A pair must swing: below sqrt(1/2) = 0.707", "Use 0.4");
    dem.contact_gap = reading.values.has("contact.gap_m") ? reading.values.number("contact.gap_m") : k_smallest_gap * reading.cell();
    if (reading.scene.bodies.size() > 1 && dem.contact_gap < (k_smallest_gap - 1e-6) * reading.cell())
        reading.refuse(
            reading.values.where("contact.gap_m"), fmt::format("contact.gap_m = {:g} m", dem.contact_gap),
            fmt::format("At least a quarter of a cell ({:g} m): water locked between bodies collapses", k_smallest_gap * reading.cell()),
            "Use a larger gap or smaller cells");
    dem.shape = reading.scene.settings.spheres ? coupling::RockShape::sphere : coupling::RockShape::cylinder;
    if (!reading.scene.settings.spheres) dem.cylinder_length = reading.scene.settings.tank.depth;
    dem.domain.lower = Vec3::Zero();
    dem.domain.upper = Vec3(reading.width(), reading.scene.settings.tank.depth, reading.height());
    for (const auto side :
         {coupling::DomainSide::x_min, coupling::DomainSide::x_max, coupling::DomainSide::z_min, coupling::DomainSide::z_max})
        dem.domain.make_wall(side);
    if (reading.scene.settings.spheres)
        for (const auto side : {coupling::DomainSide::y_min, coupling::DomainSide::y_max}) dem.domain.make_wall(side);
    dem.fluid = {0.0, 0.0};
    dem.added_mass = 0.0;
    dem.gravity = reading.scene.settings.gravity;

    GapDampingSettings& damping = reading.scene.settings.damping;
    damping.remaining = reading.values.number("contact.gap_damping");
    damping.gap = dem.contact_gap;
    if (reading.values.has("contact.gap_damping_time_s")) damping.time = reading.values.number("contact.gap_damping_time_s");
    if (damping.remaining < 1.0 && damping.time <= 0.0)
        reading.refuse(reading.values.where("contact.gap_damping"),
                       fmt::format("contact.gap_damping = {:g} without a time", damping.remaining), "The damping is a rate",
                       "Give contact.gap_damping_time_s, cell/(2 sqrt(g H))");
}

void read_run(SceneFileReading& reading) {
    reading.scene.end = reading.values.number("run.end_s");
    const std::string& stop = reading.values.text("run.stop_when");
    reading.scene.stop = stop == "pipe_empty" ? StopRule::pipe_empty : stop == "arrival" ? StopRule::arrival : StopRule::none;
    reading.scene.settle = reading.values.number("run.settle_s");
    if (reading.scene.stop == StopRule::pipe_empty && !reading.scene.pipe)
        reading.refuse(reading.values.where("run.stop_when"), "run.stop_when = \"pipe_empty\" without a pipe", "The rule watches a pipe",
                       "Add a [[solid]] of kind pipe, or take another rule");
    if (reading.scene.stop != StopRule::none && reading.scene.bodies.size() == 0)
        reading.refuse(reading.values.where("run.stop_when"), fmt::format("run.stop_when = \"{}\" without bodies", stop),
                       "The rule watches bodies", "Add [[bodies]], or take none");
    reading.scene.write_interval = reading.values.number("run.write_interval_s");
    reading.scene.write_particles = static_cast<int>(reading.values.integer("run.write_particles"));
    reading.scene.checkpoint_interval = reading.values.number("run.checkpoint_interval_s");
    reading.scene.settings.run.max_courant = reading.values.number("run.max_courant");
    if (reading.scene.write_interval > reading.scene.end)
        reading.refuse(reading.values.where("run.write_interval_s"),
                       fmt::format("run.write_interval_s = {:g} s", reading.scene.write_interval),
                       fmt::format("It must not exceed run.end_s = {:g} s", reading.scene.end), "Write more often");
    for (const char* key : {"run.write_interval_s", "run.checkpoint_interval_s"})
        if (reading.values.number(key) < reading.scene.end / k_most_outputs)
            reading.refuse(reading.values.where(key),
                           fmt::format("{} = {:g} s in a run of {:g} s", key, reading.values.number(key), reading.scene.end),
                           fmt::format("A run has at most {:g} of them", k_most_outputs), "Write less often");
}

void find_close_places(SceneFileReading& reading) {
    for (const ParameterValues& solid : reading.values.tables("solid")) {
        const double hole = solid.number("solid.hole_m");
        if (solid.text("solid.kind") == "pipe" && hole > 0.0 && hole < (k_close_cells - 1e-6) * reading.cell())
            reading.scene.close.push_back(
                fmt::format("closer than two cells: the edges of holes, {:g} m = {:.3g} cells", hole, hole / reading.cell()));
    }
    std::vector<StillSolid> solids = reading.scene.settings.solids;
    for (const Gate& gate : reading.scene.settings.gates) solids.emplace_back(gate.closed);
    for (std::string& line : close_places(reading.scene.settings.tank.grid(), bodies_of(reading.scene), reading.scene.bodies.id, solids))
        reading.scene.close.push_back(std::move(line));
}

Scene read(const ParameterValues& values, const std::filesystem::path& folder) {
    SceneFileReading reading{values, folder};
    read_domain(reading);
    read_water(reading);
    read_solids(reading);
    read_all_bodies(reading);
    for (const ParameterValues& gauge : values.tables("gauge")) read_gauge(reading, gauge);
    read_contact(reading);
    read_run(reading);
    if (reading.scene.settings.water.filled.empty() && reading.scene.bodies.size() == 0)
        reading.refuse("fill", "The scene has neither water nor bodies", "One of them must be there", "Add [[fill]] or [[bodies]]");
    if (!reading.mistakes.empty()) throw UserError(std::move(reading.mistakes));
    find_close_places(reading);
    return std::move(reading.scene);
}

}  // namespace

Scene parse_scene(const std::string& toml, const std::string& name, const std::filesystem::path& folder) {
    return read(parse_parameters(scene_table(), toml, name), folder);
}

Scene read_scene(const std::filesystem::path& file) {
    return read(read_parameters(scene_table(), file), file.parent_path());
}

std::vector<std::string> water_notes(const Scene& scene) {
    std::vector<std::string> notes;
    const std::vector<Body> bodies = bodies_of(scene);
    SceneSettings alone = scene.settings;
    for (const WaterBox& box : scene.settings.water.filled) {
        alone.water.filled = {box};
        if (fill_water(alone, bodies).size() == 0)
            notes.push_back(fmt::format(
                "the box of water from ({:g}, {:g}) to ({:g}, {:g}) m has no particle: it is thinner than half a cell, or full of solids",
                box.from.x(), box.from.z(), box.to.x(), box.to.z()));
    }
    if (const int waters = enclosed_waters(scene.settings, bodies); waters > 0) notes.push_back(enclosed_note(waters, 0.0));
    return notes;
}

std::string enclosed_note(int waters, double time) {
    return fmt::format(
        "closed waters without a surface from {:.4g} s on: {}; their mean pressure is set to 0, only its differences mean anything", time,
        waters);
}

bool stops(const Scene& scene, const SceneReading& reading) {
    if (scene.stop == StopRule::pipe_empty) return reading.bodies_in_pipe == 0;
    return scene.stop == StopRule::arrival && reading.farthest + scene.dem.contact_gap >= scene.dem.domain.upper.x();
}

}  // namespace cutterflow::free_surface
