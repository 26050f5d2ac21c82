#include "postproc/analysis/measures/measure_table.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter_row.hpp"
#include "geometry/base/parameters/parameter_words.hpp"
#include "postproc/analysis/measures/grain_maps.hpp"

namespace cutterflow::postproc {

namespace {

using nlohmann::json;
using Keys = std::vector<MeasureKey>;
constexpr auto k_number = ParameterKind::number;
constexpr auto k_integer = ParameterKind::integer;
constexpr auto k_text = ParameterKind::text;
constexpr auto k_choice = ParameterKind::choice;
constexpr auto k_path = ParameterKind::path;

MeasureKey single(const ParameterRow& row) {
    return {row, MeasureShape::single};
}

MeasureKey shaped(MeasureShape shape, const ParameterRow& row) {
    return {row, shape};
}

Keys joined(std::initializer_list<Keys> parts) {
    Keys all;
    for (const Keys& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

// --- keys that several kinds share ---------------------------------------------------------------

MeasureKey at_time() {
    return single(
        ParameterRow("at_s", k_number, "s", "Time of the picture; the nearest one counts.").at_least(0).derived("the last picture"));
}

Keys window() {
    return {single(ParameterRow("from_s", k_number, "s", "Start of the window of time.").at_least(0).derived("the start of the run")),
            single(ParameterRow("to_s", k_number, "s", "End of the window of time.").at_least(0).derived("the end of the run"))};
}

MeasureKey grains_in() {
    return shaped(MeasureShape::region,
                  ParameterRow("region", k_text, "-", "Grains whose centres lie in it count.").derived("all grains of the run"));
}

MeasureKey required_region(const char* help) {
    return shaped(MeasureShape::region, ParameterRow("region", k_text, "-", help));
}

MeasureKey base() {
    return single(ParameterRow("base_m", k_number, "m", "Level from which heights count.").by_default(0.0));
}

MeasureKey across() {
    return single(
        ParameterRow("across", k_choice, "-", "Direction over which the grid takes means.").one_of({"x", "y", "z"}).by_default("y"));
}

/// What counts mass: a gate or a region.
Keys mass_source() {
    return {
        shaped(MeasureShape::gate,
               ParameterRow("gate", k_text, "-",
                            "Gate through which mass passes: the name of one, or its place; with its place it has the measure's name.")
                   .derived("none: give a region")),
        shaped(MeasureShape::region, ParameterRow("region", k_text, "-",
                                                  "Mass that leaves this region, from pictures, in place of a gate. Grains belong to it "
                                                  "by their centres.")
                                         .derived("none: give a gate"))};
}

Keys profile_keys() {
    return {single(ParameterRow("along", k_choice, "-", "Direction of the profile; it is seen from the side across it.")
                       .one_of({"x", "y"})
                       .by_default("x")),
            single(ParameterRow("from_m", k_number, "m", "Start of the profile.").derived("the first grain")),
            single(ParameterRow("to_m", k_number, "m", "End of the profile.").derived("the last grain")),
            single(ParameterRow("points", k_integer, "-", "Points of the profile, at the middle of equal parts.")
                       .at_least(2)
                       .at_most(10000)
                       .by_default(std::int64_t{100})
                       .source("WasserfallCoetzeeMeyer2024")),
            base(),
            grains_in(),
            at_time()};
}

Keys wall_keys(ParameterRow wall, const char* absent) {
    if (*absent != '\0') wall.derived(absent);
    return {single(wall), single(ParameterRow("component", k_choice, "-", "Part of the force of rock on the wall.")
                                     .one_of({"x", "y", "z", "magnitude"})
                                     .by_default("magnitude"))};
}

// --- rules between keys --------------------------------------------------------------------------

using MeasureRules = std::vector<Mistake> (*)(const json&);

Mistake mistake(std::string what, std::string rule, std::string remedy) {
    return {"", std::move(what), std::move(rule), std::move(remedy)};
}

void require_order(const json& measure, const char* low, const char* high, std::vector<Mistake>& mistakes) {
    if (!measure.contains(low) || !measure.contains(high)) return;
    const double from = measure[low].get<double>(), to = measure[high].get<double>();
    if (from >= to)
        mistakes.push_back(mistake(fmt::format("{} = {:g} and {} = {:g}", low, from, high, to),
                                   fmt::format("{} must be below {}", low, high), "Exchange or correct them"));
}

std::vector<Mistake> window_rules(const json& measure) {
    std::vector<Mistake> mistakes;
    require_order(measure, "from_s", "to_s", mistakes);
    return mistakes;
}

std::vector<Mistake> profile_rules(const json& measure) {
    std::vector<Mistake> mistakes;
    require_order(measure, "from_m", "to_m", mistakes);
    return mistakes;
}

void require_one_of(const json& measure, const char* a, const char* b, std::vector<Mistake>& mistakes) {
    if (measure.contains(a) != measure.contains(b)) return;
    mistakes.push_back(mistake(fmt::format(measure.contains(a) ? "{} and {} are both given" : "neither {} nor {} is given", a, b),
                               fmt::format("Exactly one of {} and {} says what is measured", a, b),
                               measure.contains(a) ? "Remove one of them" : "Add one of them"));
}

std::vector<Mistake> mass_rules(const json& measure) {
    std::vector<Mistake> mistakes = window_rules(measure);
    require_one_of(measure, "gate", "region", mistakes);
    return mistakes;
}

void require_kind_of_region(const json& measure, const std::vector<std::string>& kinds, std::vector<Mistake>& mistakes) {
    if (!measure.contains("region")) return;
    const std::string kind = measure["region"].begin().key();
    if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) return;
    mistakes.push_back(
        mistake(fmt::format("region is a {}", kind), fmt::format("It must be a {} here", fmt::join(kinds, ", a ")), "Give one of these"));
}

std::vector<Mistake> packing_rules(const json& measure) {
    std::vector<Mistake> mistakes;
    require_kind_of_region(measure, {"box", "sphere", "cylinder"}, mistakes);
    return mistakes;
}

std::vector<Mistake> angle_rules(const json& measure) {
    std::vector<Mistake> mistakes;
    require_order(measure, "inner_radius_m", "radius_m", mistakes);
    if (measure.contains("window") && measure["window"][0].get<double>() >= measure["window"][1].get<double>())
        mistakes.push_back(mistake(fmt::format("window = {}", measure["window"].dump()), "Its first share must be below the second",
                                   "Exchange or correct them"));
    return mistakes;
}

/// A map over a box is no finer than a page can show. \param across  x, y or z: the direction that the map does not have
void require_map(const json& measure, char across, std::vector<Mistake>& mistakes) {
    const PlaneGrid grid{std::get<BoxRegion>(region_of(measure["region"])), across - 'x', MeasureValues(measure).number("cell_m")};
    const Vec3 size = grid.box.upper - grid.box.lower;
    if (const auto found = map_size_mistake(size[grid.first()], size[grid.second()], grid.cell)) mistakes.push_back(*found);
}

/// Without a box the extent is known with the grains. Of other regions the places outside would count as floor.
std::vector<Mistake> cavity_rules(const json& measure) {
    std::vector<Mistake> mistakes;
    require_kind_of_region(measure, {"box"}, mistakes);
    if (mistakes.empty() && measure.contains("region")) require_map(measure, 'z', mistakes);
    return mistakes;
}

std::vector<Mistake> box_rules(const json& measure) {
    std::vector<Mistake> mistakes;
    require_kind_of_region(measure, {"box"}, mistakes);
    if (mistakes.empty()) require_map(measure, MeasureValues(measure).text("across")[0], mistakes);
    return mistakes;
}

std::vector<Mistake> velocity_rules(const json& measure) {
    std::vector<Mistake> mistakes = window_rules(measure);
    for (Mistake& found : box_rules(measure)) mistakes.push_back(std::move(found));
    return mistakes;
}

std::vector<Mistake> void_rules(const json& measure) {
    std::vector<Mistake> mistakes = box_rules(measure);
    if (!measure["region"].contains("box")) return mistakes;
    const json& box = measure["region"]["box"];
    for (int i = 0; i < 3; ++i) {
        const double seed = measure["seed_m"][i].get<double>();
        if (seed >= box["lower_m"][i].get<double>() && seed <= box["upper_m"][i].get<double>()) continue;
        mistakes.push_back(
            mistake(fmt::format("seed_m = {}", measure["seed_m"].dump()), "It must lie in the region", "Move it, or widen the region"));
        break;
    }
    return mistakes;
}

/// A table is a file in a folder of postProcessing/, with one row for each time.
void require_table(const json& measure, std::vector<Mistake>& mistakes) {
    const std::string table = measure.value("table", "folder/file"), column = measure.value("column", "");
    const std::filesystem::path path(table);
    const bool has_folder = path.has_parent_path() && path.has_filename() && path.is_relative();
    if (!has_folder || std::find(path.begin(), path.end(), "..") != path.end())
        mistakes.push_back(mistake(fmt::format("table = \"{}\"", table),
                                   "It is a file in a folder of postProcessing/, without its time folder", "Write it as loads/loads.csv"));
    if (table == "rock/walls.csv")
        mistakes.push_back(mistake(fmt::format("table = \"{}\"", table), "Its rows are those of all walls", "Give a wall and a component"));
    if (column == "time_s") mistakes.push_back(mistake("column = \"time_s\"", "Time is no signal", "Name another column of the table"));
}

std::vector<Mistake> spectrum_rules(const json& measure) {
    std::vector<Mistake> mistakes = window_rules(measure);
    require_table(measure, mistakes);
    require_one_of(measure, "wall", "table", mistakes);
    if (measure.contains("table") != measure.contains("column"))
        mistakes.push_back(mistake(
            fmt::format("{} without {}", measure.contains("table") ? "table" : "column", measure.contains("table") ? "column" : "table"),
            "A table is read by one of its columns", "Give both, or a wall"));
    if (measure.value("quantity", "frequency") == "strouhal" && !(measure.contains("length_m") && measure.contains("velocity_m_s")))
        mistakes.push_back(mistake("quantity = strouhal without length_m and velocity_m_s", "The Strouhal number is f L/U",
                                   "Give both, or quantity = frequency"));
    return mistakes;
}

std::vector<Mistake> pressure_rules(const json& measure) {
    std::vector<Mistake> mistakes = window_rules(measure);
    if (measure["upstream_m"] == measure["downstream_m"])
        mistakes.push_back(mistake(fmt::format("upstream_m and downstream_m are the same place, {}", measure["upstream_m"].dump()),
                                   "The drop is between two places", "Move one of them"));
    return mistakes;
}

// --- the table -----------------------------------------------------------------------------------

MeasureKind angle_kind() {
    return {
        "angle",
        measure_angle,
        "deg",
        "Angle of a heap's or a hollow's slope with the horizontal: straight lines through the silhouettes, both sides; the cone through "
        "the whole surface beside it.",
        {single(ParameterRow("view", k_choice, "-",
                             "around: a round heap, silhouettes from 8 directions. x or y: a slope between two plates, one silhouette, "
                             "its profile along x or y.")
                    .one_of({"around", "x", "y"})
                    .by_default("around")),
         shaped(MeasureShape::pair,
                ParameterRow("centre_m", k_number, "m", "Axis of the heap, x and y.").derived("the grains' centre of mass")),
         single(
             ParameterRow("inner_radius_m", k_number, "m", "Distance from the axis at which the slope begins, as the edge of an opening.")
                 .at_least(0)
                 .by_default(0.0)),
         single(ParameterRow("radius_m", k_number, "m", "Distance from the axis at which the slope ends.")
                    .above(0)
                    .derived("where the silhouette comes down to 1 mean diameter, for each side")),
         shaped(MeasureShape::pair, ParameterRow("window", k_number, "-", "Part of the slope that the line is fitted to, from inside out.")
                                        .at_least(0)
                                        .at_most(1)
                                        .derived("[0.15, 0.85]")
                                        .source("WasserfallCoetzeeMeyer2024")),
         base(), grains_in(), at_time()},
        angle_rules};
}

std::vector<MeasureKind> make_table() {
    std::vector<MeasureKind> table;
    table.push_back(
        {"passed_mass", measure_passed_mass, "kg",
         "Mass of the grains that passed a gate along its normal less that of those that came back.",
         joined({{shaped(MeasureShape::gate,
                         ParameterRow("gate", k_text, "-", "The name of a gate, or its place; with its place it has the measure's name."))},
                 window()}),
         window_rules});
    table.push_back({"rate", measure_rate, "kg/s",
                     "Slope of passed mass by least squares: in the window, or without one over the middle half of what passes.",
                     joined({mass_source(), window()}), mass_rules});
    table.push_back(
        {"time_of", measure_time_of, "s", "Time at which a share of the mass has passed.",
         joined({mass_source(),
                 {single(ParameterRow("share", k_number, "-", "The share.").above(0).at_most(1)),
                  single(ParameterRow("of_kg", k_number, "kg", "The whole.").above(0).derived("what has passed by the end of the run"))}}),
         mass_rules});
    table.push_back({"mass_in",
                     measure_mass_in,
                     "kg",
                     "Mass of the grains whose centres lie in a region.",
                     {required_region("Where grains count."), at_time()}});
    table.push_back({"packing",
                     measure_packing,
                     "-",
                     "Volume of grains over the volume of a region; a grain at its border counts with the part inside.",
                     {required_region("A box, a sphere or a cylinder."), at_time()},
                     packing_rules});
    table.push_back({"profile", measure_profile, "m", "Upper envelope of the grains seen from a side; its value is the greatest height.",
                     profile_keys(), profile_rules, true});
    table.push_back({"profile_error", measure_profile_error, "-",
                     "Mean of |h - h_given| / h_given over the points of a profile. Points where the given height is below 1 mean diameter "
                     "are left out and counted.",
                     joined({profile_keys(),
                             {single(ParameterRow("against", k_path, "-",
                                                  "CSV file with the columns x_m,height_m, linear between its points; relative to the "
                                                  "study, in a measures.json by hand to the run directory.")
                                         .source("WasserfallCoetzeeMeyer2024"))}}),
                     profile_rules, true});
    table.push_back(angle_kind());
    table.push_back(
        {"cavity",
         measure_cavity,
         "m",
         "Hollow in a bed, from its height map: diameter of the circle of the largest area that lies 0.5 mean diameters and more below "
         "the undisturbed level; depth; volume; 8 chords.",
         {single(ParameterRow("undisturbed_m", k_number, "m", "Level of the bed before.")
                     .derived("the mean of the height map in the first picture")),
          single(ParameterRow("cell_m", k_number, "m", "Cell of the height map.").above(0).by_default(0.005)),
          single(
              ParameterRow("quantity", k_choice, "-", "What the value is.").one_of({"diameter", "depth", "volume"}).by_default("diameter")),
          shaped(MeasureShape::region,
                 ParameterRow("region", k_text, "-",
                              "A box: the part of the bed that is looked at. A bed that is not rectangular needs one within it.")
                     .derived("the grains' extent less a mean diameter at each side")),
          at_time()},
         cavity_rules});
    table.push_back({"void_area",
                     measure_void_area,
                     "m2",
                     "Area in which the void fraction, a mean across the room, is above a threshold, as far as it is connected to a place.",
                     {shaped(MeasureShape::point, ParameterRow("seed_m", k_number, "m", "The place, such as the mouth of a tuyere.")),
                      required_region("A box: the part of the room that is looked at. Its depth is that of the mean."), across(),
                      single(ParameterRow("cell_m", k_number, "m", "Cell of the map.").above(0)),
                      single(ParameterRow("threshold", k_number, "-", "Least void fraction; areas at 0.05 less and more stand beside.")
                                 .at_least(0.05)
                                 .at_most(0.95)
                                 .by_default(0.75)),
                      single(ParameterRow("quantity", k_choice, "-", "What the value is: the area, or the diameter of its circle [m].")
                                 .one_of({"area", "equivalent_diameter"})
                                 .by_default("area")),
                      at_time()},
                     void_rules});
    table.push_back(
        {"bed_velocity", measure_bed_velocity, "m/s",
         "Mean speed of the grains in a box over pictures, weighted by solid volume; its map on a grid beside it.",
         joined({{required_region("A box."), across(), single(ParameterRow("cell_m", k_number, "m", "Cell of the map.").above(0)),
                  single(ParameterRow("faster_than_m_s", k_number, "m/s", "Speed above which solid volume counts as moving.")
                             .at_least(0)
                             .by_default(0.1))},
                 window()}),
         velocity_rules});
    table.push_back(
        {"spectrum", measure_spectrum, "Hz", "Frequency of the strongest oscillation of a signal, by Welch's periodogram.",
         joined(
             {wall_keys(ParameterRow("wall", k_text, "-",
                                     "Wall whose force is the signal: a solid, or a side of the room that is one, xMin to zMax."),
                        "none: give a table"),
              {single(ParameterRow("table", k_text, "-", "Table of postProcessing/ without its time folder, as loads/loads.csv.")
                          .derived("none: give a wall")),
               single(ParameterRow("column", k_text, "-", "Column of the table that is the signal.").derived("none: give a wall")),
               single(ParameterRow("segments", k_integer, "-", "Half overlapping parts of the window.")
                          .at_least(1)
                          .at_most(1000)
                          .by_default(std::int64_t{7})
                          .source("Welch1967")),
               single(
                   ParameterRow("length_m", k_number, "m", "Length of the Strouhal number.").above(0).derived("none: no Strouhal number")),
               single(ParameterRow("velocity_m_s", k_number, "m/s", "Velocity of the Strouhal number.")
                          .above(0)
                          .derived("none: no Strouhal number")),
               single(ParameterRow("quantity", k_choice, "-", "What the value is.")
                          .one_of({"frequency", "strouhal"})
                          .by_default("frequency"))},
              window()}),
         spectrum_rules});
    table.push_back(
        {"wall_force", measure_wall_force, "N", "Mean force of rock on a wall.",
         joined({wall_keys(ParameterRow("wall", k_text, "-", "Name of the wall: a solid, or a side of the room that is one, xMin to zMax."),
                           ""),
                 window()}),
         window_rules});
    table.push_back({"pressure_drop", measure_pressure_drop, "Pa",
                     "Mean of the pressure at a place less that at another, without the weight of the fluid: its dynamic part.",
                     joined({{shaped(MeasureShape::point, ParameterRow("upstream_m", k_number, "m", "The first place.")),
                              shaped(MeasureShape::point, ParameterRow("downstream_m", k_number, "m", "The other place.")),
                              single(ParameterRow("density_kg_m3", k_number, "kg/m3", "Density of the fluid.").above(0).at_most(2e4))},
                             window()}),
                     pressure_rules});
    return table;
}

// --- checks of values ----------------------------------------------------------------------------

bool is_list_of_numbers(const json& value, std::size_t length) {
    return value.is_array() && value.size() == length &&
           std::all_of(value.begin(), value.end(), [](const json& item) { return item.is_number() && std::isfinite(item.get<double>()); });
}

/// The numbers of a table in a value, by key, such as {lower_m, upper_m}: how long each is (1: no list).
struct Part {
    const char* key;
    std::size_t length;
    bool above_zero = false;
    bool optional = false;
};

struct Form {
    const char* name;
    std::vector<Part> parts;
};

const std::vector<Form> k_regions = {{"box", {{"lower_m", 3}, {"upper_m", 3}}},
                                     {"sphere", {{"centre_m", 3}, {"radius_m", 1, true}}},
                                     {"cylinder", {{"from_m", 3}, {"to_m", 3}, {"radius_m", 1, true}}},
                                     {"half_space", {{"point_m", 3}, {"normal", 3}}}};
const std::vector<Form> k_gates = {{"disc", {{"disc_m", 3}, {"radius_m", 1, true}, {"normal", 3, false, true}}},
                                   {"rectangle", {{"lower_m", 3}, {"upper_m", 3}, {"normal", 3, false, true}}}};

std::string written(const Part& part) {
    return fmt::format("{}{}", part.key, part.length == 3 ? " = [x, y, z]" : "");
}

std::string written(const Form& form) {
    std::vector<std::string> parts;
    for (const Part& part : form.parts) parts.push_back(written(part));
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// As the solver takes the corners of a gate.
void check_rectangle(const json& value, const std::string& place, std::vector<Mistake>& mistakes) {
    int flat = 0;
    bool ordered = true;
    for (int i = 0; i < 3; ++i) {
        const double lower = value["lower_m"][i].get<double>(), upper = value["upper_m"][i].get<double>();
        if (lower == upper) ++flat;
        ordered = ordered && lower <= upper;
    }
    if (flat == 1 && ordered) return;
    mistakes.push_back(
        mistake(fmt::format("{}.lower_m = {} and upper_m = {} are no rectangle", place, value["lower_m"].dump(), value["upper_m"].dump()),
                "They agree in one direction, in the others lower_m lies below upper_m", "Correct the corners"));
}

/// Mistakes of a table {key = numbers} against its form. \param place  of the table, as "region.box"
void check_form(const json& value, const Form& form, const std::string& place, std::vector<Mistake>& mistakes) {
    const std::string rule = fmt::format("A {} has {}", form.name, written(form));
    const std::size_t before = mistakes.size();
    for (const auto& [key, item] : value.items()) {
        if (std::none_of(form.parts.begin(), form.parts.end(), [&, &name = key](const Part& part) { return part.key == name; }))
            mistakes.push_back(mistake(fmt::format("{}.{} is unknown", place, key), rule, "Remove it"));
    }
    for (const Part& part : form.parts) {
        const std::string name = fmt::format("{}.{}", place, part.key);
        if (!value.contains(part.key)) {
            if (!part.optional) mistakes.push_back(mistake(name + " is missing", rule, "Add it"));
            continue;
        }
        const json& item = value[part.key];
        const bool right = part.length == 1 ? item.is_number() && std::isfinite(item.get<double>()) : is_list_of_numbers(item, part.length);
        if (!right)
            mistakes.push_back(mistake(fmt::format("{} = {}", name, item.dump()),
                                       part.length == 1 ? "It must be a number" : "It must be three numbers", "Correct it"));
        else if (part.above_zero && item.get<double>() <= 0.0)
            mistakes.push_back(mistake(fmt::format("{} = {}", name, item.dump()), "It must be above 0", "Correct it"));
        else if (std::string(part.key) == "normal" && item == json({0, 0, 0}))
            mistakes.push_back(mistake(name + " = [0, 0, 0]", "It must be a direction", "Correct it"));
    }
    if (mistakes.size() > before) return;
    if (std::string(form.name) == "box") {
        for (int i = 0; i < 3; ++i) {
            if (value["lower_m"][i].get<double>() < value["upper_m"][i].get<double>()) continue;
            mistakes.push_back(
                mistake(fmt::format("{}.lower_m = {} and upper_m = {}", place, value["lower_m"].dump(), value["upper_m"].dump()),
                        "Each number of lower_m must be below that of upper_m", "Exchange or correct them"));
            return;
        }
    }
    if (std::string(form.name) == "rectangle") check_rectangle(value, place, mistakes);
    if (std::string(form.name) == "cylinder" && value["from_m"] == value["to_m"])
        mistakes.push_back(mistake(fmt::format("{}.from_m and to_m are the same place, {}", place, value["from_m"].dump()),
                                   "They are the ends of the axis", "Move one of them"));
}

std::string names_of(const std::vector<Form>& forms) {
    std::vector<std::string> names;
    for (const Form& form : forms) names.emplace_back(form.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

void check_region(const std::string& key, const json& value, std::vector<Mistake>& mistakes) {
    if (!value.is_object() || value.size() != 1)
        return mistakes.push_back(mistake(fmt::format("{} = {}", key, value.dump()),
                                          fmt::format("It must be a table with one of {}", names_of(k_regions)),
                                          "Write it as { box = { lower_m = [0, 0, 0], upper_m = [0.1, 0.1, 0.1] } }"));
    const std::string& name = value.begin().key();
    const auto form = std::find_if(k_regions.begin(), k_regions.end(), [&](const Form& one) { return one.name == name; });
    if (form == k_regions.end() || !value.begin()->is_object())
        return mistakes.push_back(mistake(fmt::format("{} = {}", key, value.dump()),
                                          fmt::format("A region is one of {}, each a table", names_of(k_regions)), "Give one of these"));
    check_form(*value.begin(), *form, key + "." + name, mistakes);
}

bool is_name(const std::string& text) {
    return !text.empty() && text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
}

void check_gate(const std::string& key, const json& value, std::vector<Mistake>& mistakes) {
    if (value.is_string() && is_name(value.get<std::string>())) return;
    if (!value.is_object())
        return mistakes.push_back(mistake(fmt::format("{} = {}", key, value.dump()), "It must be the name of a gate, or its place",
                                          "Write it as { disc_m = [0, 0, 0.3], radius_m = 0.05 }"));
    check_form(value, k_gates[value.contains("disc_m") ? 0 : 1], key, mistakes);
}

std::optional<ParameterValue> parameter_value(const Parameter& parameter, const json& value) {
    switch (parameter.kind) {
        case ParameterKind::number:
            if (value.is_number()) return value.get<double>();
            break;
        case ParameterKind::integer:
            if (value.is_number_integer() && (!value.is_number_unsigned() || value.get<std::uint64_t>() <= INT32_MAX))
                return value.get<std::int64_t>();
            break;
        case ParameterKind::boolean:
            if (value.is_boolean()) return value.get<bool>();
            break;
        default:
            if (value.is_string()) return value.get<std::string>();
    }
    return std::nullopt;
}

void check_single(const Parameter& parameter, const json& value, std::vector<Mistake>& mistakes) {
    const std::optional<ParameterValue> typed = parameter_value(parameter, value);
    if (!typed) {
        mistakes.push_back(mistake(fmt::format("{} = {} has the wrong type", parameter.key, value.dump()),
                                   fmt::format("It must be {}", parameter_words::kind_with_unit(parameter)), "Correct the value"));
    } else if (const std::optional<Mistake> found = value_mistake(parameter, *typed)) {
        mistakes.push_back(*found);
    } else if (parameter.kind == ParameterKind::text && value.get<std::string>().empty()) {
        mistakes.push_back(mistake(fmt::format("{} is empty", parameter.key), "It must name something", "Correct it"));
    }
}

void check_value(const MeasureKey& key, const json& value, std::vector<Mistake>& mistakes) {
    const std::string& name = key.parameter.key;
    switch (key.shape) {
        case MeasureShape::single:
            return check_single(key.parameter, value, mistakes);
        case MeasureShape::region:
            return check_region(name, value, mistakes);
        case MeasureShape::gate:
            return check_gate(name, value, mistakes);
        case MeasureShape::pair:
        case MeasureShape::point: {
            const std::size_t length = key.shape == MeasureShape::pair ? 2 : 3;
            if (!is_list_of_numbers(value, length))
                return mistakes.push_back(mistake(fmt::format("{} = {}", name, value.dump()), fmt::format("It must be {} numbers", length),
                                                  fmt::format("Write it as {}", length == 2 ? "[0.1, 0.2]" : "[0.1, 0.2, 0.3]")));
            for (const json& item : value) {
                const std::size_t before = mistakes.size();
                check_single(key.parameter, item, mistakes);
                if (mistakes.size() > before) return;
            }
        }
    }
}

bool is_required(const Parameter& parameter) {
    return !parameter.optional && !parameter.default_value;
}

/// Mistakes of a measure whose kind is known.
std::vector<Mistake> kind_mistakes(const MeasureKind& kind, const json& measure) {
    std::vector<Mistake> mistakes;
    std::vector<std::string> known{"name", "what"};
    for (const MeasureKey& key : kind.keys) known.push_back(key.parameter.key);
    for (const auto& [key, value] : measure.items()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        const std::string nearest = nearest_word(key, known);
        mistakes.push_back(mistake(fmt::format("key {} is unknown", key),
                                   fmt::format("The keys of a {} are {}", kind.what, fmt::join(known, ", ")),
                                   nearest.empty() ? "Remove it" : fmt::format("Did you mean {}?", nearest)));
    }
    for (const MeasureKey& key : kind.keys) {
        if (measure.contains(key.parameter.key))
            check_value(key, measure[key.parameter.key], mistakes);
        else if (is_required(key.parameter))
            mistakes.push_back(mistake(fmt::format("{} is missing", key.parameter.key), key.parameter.help, "Add it"));
    }
    if (mistakes.empty() && kind.rules != nullptr) mistakes = kind.rules(measure);
    return mistakes;
}

std::vector<Mistake> measure_mistakes(const json& measure) {
    std::vector<std::string> whats;
    for (const MeasureKind& kind : measure_table()) whats.emplace_back(kind.what);
    const std::string rule = fmt::format("what is one of {}", fmt::join(whats, ", "));
    if (!measure.contains("what")) return {mistake("what is missing", rule, "Add it")};
    if (!measure["what"].is_string()) return {mistake(fmt::format("what = {}", measure["what"].dump()), rule, "Correct it")};
    const auto what = measure["what"].get<std::string>();
    const MeasureKind* kind = find_measure_kind(what);
    if (kind != nullptr) return kind_mistakes(*kind, measure);
    const std::string nearest = nearest_word(what, whats);
    return {mistake(fmt::format("what = \"{}\"", what), rule,
                    nearest.empty() ? "Choose one of them" : fmt::format("Did you mean {}?", nearest))};
}

}  // namespace

const std::vector<MeasureKind>& measure_table() {
    static const std::vector<MeasureKind> table = make_table();
    return table;
}

const MeasureKind* find_measure_kind(const std::string& what) {
    const std::vector<MeasureKind>& table = measure_table();
    const auto found = std::find_if(table.begin(), table.end(), [&](const MeasureKind& kind) { return kind.what == what; });
    return found == table.end() ? nullptr : &*found;
}

std::vector<Mistake> check_measures(const json& measures, const std::string& where, std::size_t first) {
    if (!measures.is_array())
        return {{where, "the measures are no list", "A list of tables, each with name and what", "Write them as [[measure]] of a study"}};
    std::vector<Mistake> mistakes;
    std::set<std::string> names;
    for (std::size_t i = 0; i < measures.size(); ++i) {
        const json& measure = measures[i];
        const auto add = [&](const std::string& place, Mistake found) {
            found.where = where;
            found.what = place + ": " + found.what;
            mistakes.push_back(std::move(found));
        };
        std::string place = fmt::format("measure {}", first + i);
        if (!measure.is_object()) {
            add(place, mistake(measure.dump(), "A measure is a table with name and what", "Correct it"));
            continue;
        }
        const bool has_name = measure.contains("name");
        if (has_name && measure["name"].is_string() && is_name(measure["name"].get<std::string>())) {
            place = "measure." + measure["name"].get<std::string>();
            if (!names.insert(place).second)
                add(place, mistake("there are two of this name", "Names of measures are unique", "Rename one of them"));
        } else {
            add(place, mistake(has_name ? fmt::format("name = {}", measure["name"].dump()) : "name is missing",
                               "A name has letters, digits, _ and -", has_name ? "Change it" : "Give it a name"));
        }
        for (Mistake& found : measure_mistakes(measure)) add(place, std::move(found));
    }
    return mistakes;
}

MeasureValues::MeasureValues(const json& measure) : measure_(measure), kind_(find_measure_kind(measure.at("what").get<std::string>())) {}

const Parameter& MeasureValues::parameter(const std::string& key) const {
    return std::find_if(kind_->keys.begin(), kind_->keys.end(), [&](const MeasureKey& one) { return one.parameter.key == key; })->parameter;
}

double MeasureValues::number(const std::string& key) const {
    return measure_.contains(key) ? measure_[key].get<double>() : std::get<double>(*parameter(key).default_value);
}

std::optional<double> MeasureValues::optional_number(const std::string& key) const {
    if (!measure_.contains(key)) return std::nullopt;
    return measure_[key].get<double>();
}

int MeasureValues::integer(const std::string& key) const {
    return measure_.contains(key) ? measure_[key].get<int>() : static_cast<int>(std::get<std::int64_t>(*parameter(key).default_value));
}

std::string MeasureValues::text(const std::string& key) const {
    return measure_.contains(key) ? measure_[key].get<std::string>() : std::get<std::string>(*parameter(key).default_value);
}

Eigen::Vector2d MeasureValues::pair(const std::string& key) const {
    return {measure_.at(key)[0].get<double>(), measure_.at(key)[1].get<double>()};
}

Vec3 MeasureValues::point(const std::string& key) const {
    return {measure_.at(key)[0].get<double>(), measure_.at(key)[1].get<double>(), measure_.at(key)[2].get<double>()};
}

}  // namespace cutterflow::postproc
