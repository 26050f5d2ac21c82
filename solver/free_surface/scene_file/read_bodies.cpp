#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/free_surface/body_list.hpp"
#include "solver/free_surface/scene_file/scene_file_reading.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr double k_fewest_cells = 5.0;  // a diameter
constexpr double k_enough_cells = 8.0;  // a diameter
constexpr int k_rim_points = 90;        // at which a body is looked for in solids
constexpr int k_rims = 16;              // of a sphere
constexpr double k_most_bodies = 2e4;   // of a stack; 33 to 1,000 are usual

/// Spheres or cylinders: all of a scene are of one shape.
void read_shape(SceneFileReading& reading, const ParameterValues& bodies) {
    const bool spheres = bodies.text("bodies.shape") == "sphere";
    const std::string where = bodies.where("bodies.diameter_m");
    if (spheres && reading.plane())
        reading.refuse(where, "Spheres in a plane scene", "A plane scene holds cylinders across it", "Set domain.dimensions = \"space\"");
    if (reading.scene.bodies.size() > 0 && spheres != reading.scene.settings.spheres)
        reading.refuse(where, "Spheres and cylinders in one scene", "Bodies of a scene have one shape",
                       "Give all [[bodies]] the same shape");
    if (!spheres && (bodies.integer("bodies.rows") > 1 || bodies.has("bodies.centre_y_m")))
        reading.refuse(where, "bodies.rows or bodies.centre_y_m for cylinders", "Cylinders reach across the whole tank",
                       "Remove it, or set bodies.shape = \"sphere\"");
    reading.scene.settings.spheres = spheres;
}

std::vector<ListedBody> listed(SceneFileReading& reading, const ParameterValues& bodies) {
    const std::initializer_list<const char*> of_stacks{"bodies.centre_x_m", "bodies.centre_y_m", "bodies.lowest_m",   "bodies.layers",
                                                       "bodies.widest",     "bodies.rows",       "bodies.clearance_m"};
    for (const Parameter& row : scene_table()) {
        const auto is_it = [&](const char* key) { return row.key == key; };
        const ParameterValue* value = bodies.find(row.key);  // a study that is written out in full has the defaults
        if (value == nullptr || *value == row.default_value || std::none_of(of_stacks.begin(), of_stacks.end(), is_it)) continue;
        reading.refuse(bodies.where(row.key), fmt::format("{} = {} beside bodies.file", row.key, toml_text(*value)),
                       "Bodies are a stack or listed in a file", "Remove one of them; a second [[bodies]] may have the other");
    }
    std::vector<Mistake> mistakes;
    std::vector<ListedBody> list = read_body_list(reading.folder / bodies.text("bodies.file"), mistakes);
    for (Mistake& mistake : mistakes) {
        if (mistake.where.empty()) mistake.where = bodies.where("bodies.file");
        reading.mistakes.push_back(std::move(mistake));
    }
    if (reading.scene.settings.spheres) return list;
    for (const ListedBody& body : list) {
        const auto refuse = [&](const char* what, const char* column) {
            reading.refuse(body.where, fmt::format("The cylinder at x = {:g} m has a {} across", body.x, what),
                           "Cylinders reach across the tank",
                           fmt::format("Leave the column {} out, or set bodies.shape = \"sphere\"", column));
        };
        if (body.y) refuse("place", "y_m");
        if (body.moves_across) refuse("velocity", "vy_m_s");
    }
    return list;
}

std::vector<ListedBody> stacked(SceneFileReading& reading, const ParameterValues& bodies) {
    for (const char* key : {"bodies.centre_x_m", "bodies.lowest_m"}) {
        if (bodies.has(key)) continue;
        reading.refuse(bodies.where("bodies.diameter_m"), fmt::format("{} is missing", key), "A stack needs it", "Add it, or bodies.file");
        return {};
    }
    std::vector<ListedBody> stack;
    const double diameter = bodies.number("bodies.diameter_m"), spacing = diameter + bodies.number("bodies.clearance_m");
    const auto widest = bodies.integer("bodies.widest"), rows = bodies.integer("bodies.rows");
    const double all = static_cast<double>(bodies.integer("bodies.layers")) * static_cast<double>(widest) * static_cast<double>(rows);
    if (all > k_most_bodies) {
        reading.refuse(bodies.where("bodies.layers"), fmt::format("a stack of {:g} bodies", all),
                       fmt::format("A stack has at most {:g}", k_most_bodies), "Make it smaller");
        return {};
    }
    const double centre_y = bodies.has("bodies.centre_y_m") ? bodies.number("bodies.centre_y_m") : 0.5 * reading.scene.settings.tank.depth;
    for (std::int64_t layer = 0; layer < bodies.integer("bodies.layers"); ++layer) {
        const auto count = std::max<std::int64_t>(1, layer % 2 == 0 ? widest : widest - 1);
        for (std::int64_t n = 0; n < count; ++n) {
            const double x = bodies.number("bodies.centre_x_m") + (static_cast<double>(n) - 0.5 * static_cast<double>(count - 1)) * spacing;
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

/// How deep a body reaches into a solid [m]; 0: not at all. Looked for in its middle and along its rim.
double depth_in(const StillSolid& solid, const Vec3& place, double radius, bool sphere) {
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

/// A body that reaches out of the domain.
struct Leaving {
    std::string where;
    int id = 0;
    Vec3 place = Vec3::Zero();
    double beyond = 0.0;  // [m]
};

/// Each body of a list at its line, those of a stack at once. \param all  bodies of the table
void refuse_leaving(SceneFileReading& reading, const std::vector<Leaving>& leaving, std::size_t all, bool is_stack) {
    const Vec3 end(reading.width(), reading.scene.settings.tank.depth, reading.height());
    const std::string rule = fmt::format("The domain reaches to {}", reading.text_of(end));
    const auto named = [&](const Leaving& body) { return fmt::format("{} at {}", body.id, reading.text_of(body.place)); };
    if (is_stack && leaving.size() > 1)
        return reading.refuse(leaving.front().where,
                              fmt::format("{} of {} bodies leave the domain; the first, body {}, by {:.3g} m", leaving.size(), all,
                                          named(leaving.front()), leaving.front().beyond),
                              rule, "Move the stack, or make it smaller");
    for (const Leaving& body : leaving)
        reading.refuse(body.where, fmt::format("Body {} leaves the domain by {:.3g} m", named(body), body.beyond), rule,
                       "Move it, or the stack");
}

/// \param leaving  receives it when it reaches out of the domain
void add_body(SceneFileReading& reading, const ListedBody& body, double diameter, double density, std::vector<Leaving>& leaving) {
    coupling::Rocks& rocks = reading.scene.bodies;
    const bool sphere = reading.scene.settings.spheres;
    const double depth = reading.scene.settings.tank.depth;
    const Vec3 place(body.x, sphere ? body.y.value_or(0.5 * depth) : 0.5 * depth, body.z);
    const std::string& where = body.where;
    const int id = body.id > 0 ? body.id : rocks.id.empty() ? 1 : *std::max_element(rocks.id.begin(), rocks.id.end()) + 1;
    const double radius = 0.5 * diameter;
    if (std::find(rocks.id.begin(), rocks.id.end(), id) != rocks.id.end())
        reading.refuse(where, fmt::format("id {} is that of a body of another table", id), "Every body has an id of its own",
                       "Change the id, or leave the column out");
    double beyond =
        std::max({radius - place.x(), place.x() + radius - reading.width(), radius - place.z(), place.z() + radius - reading.height()});
    if (sphere) beyond = std::max({beyond, radius - place.y(), place.y() + radius - depth});
    if (beyond > 0.0) leaving.push_back({where, id, place, beyond});
    for (std::size_t n = 0; n < rocks.size(); ++n) {
        const double between = (rocks.position[n] - place).norm() - 0.5 * rocks.diameter[n] - radius;
        if (between < 0.0)
            reading.refuse(where, fmt::format("Bodies {} and {} overlap by {:.3g} m", rocks.id[n], id, -between), "Bodies must not overlap",
                           "Move one of them, or give more clearance or less jitter");
    }
    double into = 0.0;
    for (const StillSolid& solid : reading.scene.settings.solids) into = std::max(into, depth_in(solid, place, radius, sphere));
    for (const Gate& gate : reading.scene.settings.gates) into = std::max(into, depth_in(gate.closed, place, radius, sphere));
    if (into > 0.0)
        reading.refuse(where, fmt::format("Body {} at {} stands in a solid, {:.3g} m deep", id, reading.text_of(place), into),
                       "Bodies start free", "Move it, or the stack");
    rocks.append({id, place, body.velocity, Vec3(0.0, body.spin, 0.0), diameter, density});
}

void read_bodies(SceneFileReading& reading, const ParameterValues& bodies) {
    read_shape(reading, bodies);
    const double diameter = bodies.number("bodies.diameter_m"), density = bodies.number("bodies.density_kg_m3");
    const double across = diameter / reading.cell();
    const std::string where = bodies.where("bodies.diameter_m");
    if (across < k_fewest_cells)
        reading.refuse(where, fmt::format("bodies.diameter_m = {:g} m is {:.3g} cells", diameter, across),
                       fmt::format("A body needs at least {:g} cells across", k_fewest_cells),
                       fmt::format("Use cells of {:g} m", diameter / 10.0));
    else if (across < k_enough_cells)
        reading.scene.notes.push_back(
            fmt::format("bodies have {:.3g} cells across: below 8 their acceleration is off by 2 % and more", across));
    if (density < 1e-3 * reading.scene.settings.water.density)
        reading.refuse(bodies.where("bodies.density_kg_m3"), fmt::format("bodies.density_kg_m3 = {:g}", density),
                       "The pressure of water and bodies is verified down to a thousandth of the water's density", "Use a heavier body");
    const double jitter = bodies.number("bodies.jitter_m");
    std::mt19937 random(static_cast<unsigned>(bodies.integer("bodies.seed")));
    std::uniform_real_distribution<double> shift(-jitter, jitter);
    const bool is_stack = !bodies.has("bodies.file");
    std::vector<ListedBody> all = is_stack ? stacked(reading, bodies) : listed(reading, bodies);
    std::vector<Leaving> leaving;
    for (ListedBody& body : all) {
        body.z += shift(random);
        body.x += shift(random);
        if (reading.scene.settings.spheres) body.y = body.y.value_or(0.5 * reading.scene.settings.tank.depth) + shift(random);
        add_body(reading, body, diameter, density, leaving);
    }
    refuse_leaving(reading, leaving, all.size(), is_stack);
}

/// The DEM keeps bodies by their ids.
void sort_bodies(SceneFileReading& reading) {
    const coupling::Rocks given = std::move(reading.scene.bodies);
    std::vector<std::size_t> order(given.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return given.id[a] < given.id[b]; });
    reading.scene.bodies = {};
    for (const std::size_t n : order) reading.scene.bodies.append(given, n);
}

}  // namespace

void read_all_bodies(SceneFileReading& reading) {
    for (const ParameterValues& bodies : reading.values.tables("bodies")) read_bodies(reading, bodies);
    sort_bodies(reading);
}

}  // namespace cutterflow::free_surface
