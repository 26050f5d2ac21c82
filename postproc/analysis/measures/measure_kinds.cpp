#include "postproc/analysis/measures/measure_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/profiles/profile.hpp"
#include "postproc/analysis/measures/cavity.hpp"
#include "postproc/analysis/measures/grain_maps.hpp"
#include "postproc/analysis/measures/heap.hpp"
#include "postproc/analysis/measures/measure_source.hpp"
#include "postproc/analysis/measures/measure_table.hpp"
#include "postproc/analysis/measures/spectrum.hpp"
#include "postproc/analysis/time_average.hpp"

namespace cutterflow::postproc {

namespace {

using nlohmann::json;

constexpr std::size_t k_most_points = 500;  ///< of a series over time
constexpr double k_most_cells = 250000.0;   ///< of a map
constexpr int k_error_batches = 10;         ///< of a window, for the error of a mean
constexpr double k_rounding = 1e-6;         ///< of the time at which a run ends

double rounded(double value) {
    return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

json numbers(const std::vector<double>& values) {
    json list = json::array();
    for (const double value : values) list.push_back(rounded(value));
    return list;
}

json place_of(const Eigen::Vector2d& place) {
    return {rounded(place.x()), rounded(place.y())};
}

/// At most k_most_points of two arrays, evenly; the last one always.
json series_of(const char* x_name, const std::vector<double>& x, const char* y_name, const std::vector<double>& y) {
    std::vector<double> fewer_x, fewer_y;
    const std::size_t step = (x.size() + k_most_points - 1) / k_most_points;
    for (std::size_t n = 0; n < x.size(); ++n) {
        if (n % step != 0 && n + 1 != x.size()) continue;
        fewer_x.push_back(x[n]);
        fewer_y.push_back(y[n]);
    }
    return {{x_name, numbers(fewer_x)}, {y_name, numbers(fewer_y)}};
}

Region region_or_everywhere(const MeasureValues& values) {
    return values.has("region") ? region_of(values.raw("region")) : Region(EverywhereRegion{});
}

/// The grains that a measure looks at, and the time of their picture.
struct Look {
    Grains grains;
    double time = 0.0;
};

Look look(const MeasureSource& source, const MeasureValues& values) {
    const std::size_t picture = source.picture_near(values.optional_number("at_s"));
    return {grains_in(source.grains(picture), region_or_everywhere(values)), source.picture_times()[picture]};
}

std::string why_no_grains(const MeasureValues& values, double time) {
    return fmt::format("the picture at {:g} s has no grains{}", time, values.has("region") ? " in the region" : "");
}

MeasureOutcome without_value(const std::string& unit, const std::string& reason) {
    MeasureOutcome outcome;
    outcome.unit = unit;
    outcome.detail["reason"] = reason;
    return outcome;
}

// --- mass over time ------------------------------------------------------------------------------

PassedMass passed_mass(const MeasureSource& source, const MeasureValues& values) {
    if (values.has("region")) return source.out_of_region(region_of(values.raw("region")));
    const json& gate = values.raw("gate");
    return source.through_gate(gate.is_string() ? gate.get<std::string>() : values.name());
}

/// The passed mass with its ends, as a line that a figure can draw.
json mass_series(const PassedMass& passed) {
    std::vector<double> time{passed.start}, mass{passed.at(passed.start)};
    for (std::size_t n = 0; n < passed.time.size(); ++n) {
        if (passed.time[n] <= passed.start) continue;
        time.push_back(passed.time[n]);
        mass.push_back(passed.mass[n]);
    }
    if (passed.end > time.back()) {
        time.push_back(passed.end);
        mass.push_back(passed.total());
    }
    return series_of("time_s", time, "passed_kg", mass);
}

json to_json(const Rate& rate) {
    json detail{{"from_s", rate.from}, {"to_s", rate.to}, {"slope_kg_s", rate.slope}, {"intercept_kg", rate.intercept}};
    detail["standard_error_kg_s"] = rate.standard_error ? json(*rate.standard_error) : json(nullptr);
    detail["half_interval_95_kg_s"] = rate.standard_error ? json(rate.half_interval) : json(nullptr);
    return detail;
}

// --- signals -------------------------------------------------------------------------------------

/// Rows of a signal within the measure's window. \throws UserError  when there are fewer than two
Signal in_window(const Signal& signal, const MeasureValues& values) {
    const double from = values.optional_number("from_s").value_or(-std::numeric_limits<double>::infinity());
    const double to = values.optional_number("to_s").value_or(std::numeric_limits<double>::infinity());
    Signal part;
    for (std::size_t n = 0; n < signal.time.size(); ++n) {
        if (signal.time[n] < from || signal.time[n] > to) continue;
        part.time.push_back(signal.time[n]);
        part.value.push_back(signal.value[n]);
    }
    if (part.time.size() < 2)
        throw UserError(fmt::format("the window has {} of the {} values", part.time.size(), signal.time.size()), "A mean needs two or more",
                        fmt::format("The values run from {:g} to {:g} s: widen the window", signal.time.front(), signal.time.back()));
    return part;
}

MeasureOutcome mean_of(const Signal& signal, const MeasureValues& values, const std::string& unit, const char* series_name) {
    const Signal part = in_window(signal, values);
    const double from = part.time.front(), to = part.time.back();
    const auto average = time_average(part.time, part.value, from, to, (to - from) / k_error_batches);
    const auto [low, high] = std::minmax_element(part.value.begin(), part.value.end());
    MeasureOutcome outcome;
    outcome.value = average->mean;
    outcome.unit = unit;
    outcome.standard_error = average->standard_error;
    outcome.detail = {{"from_s", from}, {"to_s", to}, {"least", *low}, {"greatest", *high}, {"last", part.value.back()}};
    outcome.series = series_of("time_s", signal.time, series_name, signal.value);
    return outcome;
}

// --- profiles ------------------------------------------------------------------------------------

struct MeasuredProfile {
    Profile profile;
    double time = 0.0, diameter = 0.0;
    std::string reason;  ///< empty: there are grains
};

/// Without grains all heights are 0. \return nothing where grains give the ends of the profile, and there are none
std::optional<MeasuredProfile> measured_profile(const MeasureSource& source, const MeasureValues& values) {
    const Look seen = look(source, values);
    const Eigen::Vector2d direction = values.text("along") == "x" ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
    const int axis = values.text("along") == "x" ? 0 : 1;
    double from = values.optional_number("from_m").value_or(0.0), to = values.optional_number("to_m").value_or(from);
    const bool empty = seen.grains.size() == 0;
    if (empty && !(values.has("from_m") && values.has("to_m"))) return std::nullopt;
    if (!empty) {
        const auto [lower, upper] = bounds_of(seen.grains);
        if (!values.has("from_m")) from = lower[axis];
        if (!values.has("to_m")) to = upper[axis];
    }
    if (from >= to)
        throw UserError(fmt::format("the profile runs from {:g} to {:g} m", from, to), "It has a length", "Give from_m and to_m");
    return MeasuredProfile{profile_of(seen.grains, direction, {from, to, values.integer("points")}, values.number("base_m")), seen.time,
                           mean_diameter(seen.grains), empty ? why_no_grains(values, seen.time) : ""};
}

SlopeSearch slope_search(const MeasureValues& values, const Grains& grains) {
    SlopeSearch search;
    search.around = values.text("view") == "around";
    if (values.text("view") == "y") search.direction = Eigen::Vector2d::UnitY();
    if (values.has("centre_m")) {
        search.axis = values.pair("centre_m");
    } else {
        double volume = 0.0;
        for (std::size_t n = 0; n < grains.size(); ++n) {
            const double part = std::pow(grains.diameter[n], 3);
            search.axis += part * grains.position[n].head<2>();
            volume += part;
        }
        if (volume > 0.0) search.axis /= volume;
    }
    search.base = values.number("base_m");
    search.inner_radius = values.number("inner_radius_m");
    search.radius = values.optional_number("radius_m");
    if (values.has("window")) {
        search.window_from = values.pair("window")[0];
        search.window_to = values.pair("window")[1];
    }
    return search;
}

/// Grains that the surface over a region is made of: those of a box and within a mean diameter beside it, so that its edges are covered.
Grains grains_of_map(const Grains& grains, const Region& region) {
    const auto* box = std::get_if<BoxRegion>(&region);
    if (box == nullptr) return grains_in(grains, region);
    const double beside = mean_diameter(grains);
    const Vec3 reach(beside, beside, 0.0);
    return grains_in(grains, BoxRegion{box->lower - reach, box->upper + reach});
}

/// Horizontal extent of a map: of the box, or of the grains less a mean diameter at each side, where a bed's edge is no cavity.
std::pair<Eigen::Vector2d, Eigen::Vector2d> map_extent(const Grains& grains, const Region& region) {
    if (grains.size() == 0) return {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
    if (const auto* box = std::get_if<BoxRegion>(&region)) return {box->lower.head<2>(), box->upper.head<2>()};
    const auto [lower, upper] = bounds_of(grains);
    const Eigen::Vector2d edge = Eigen::Vector2d::Constant(mean_diameter(grains));
    return {lower.head<2>() + edge, upper.head<2>() - edge};
}

/// Lines up to four times the strongest; without one all.
std::size_t lines_to_show(const Spectrum& spectrum) {
    const double highest = spectrum.peak_frequency ? 4.0 * *spectrum.peak_frequency : spectrum.frequency.back();
    const auto after = std::upper_bound(spectrum.frequency.begin(), spectrum.frequency.end(), highest);
    return std::min<std::size_t>(static_cast<std::size_t>(after - spectrum.frequency.begin()), 4 * k_most_points);
}

PlaneGrid plane_grid(const MeasureValues& values) {
    return {std::get<BoxRegion>(region_of(values.raw("region"))), values.text("across")[0] - 'x', values.number("cell_m")};
}

json grid_json(const PlaneGrid& grid) {
    std::vector<double> x, z;
    for (int i = 0; i < grid.columns(); ++i) x.push_back(grid.x(i));
    for (int j = 0; j < grid.rows(); ++j) z.push_back(grid.z(j));
    return {{"columns_m", numbers(x)}, {"rows_m", numbers(z)}};
}

/// Why nothing is known of a time before the first picture.
std::string why_no_start(const PassedMass& passed) {
    return fmt::format("the first picture is of {:g} s, and there is no events.csv that tells which grains were in the region before",
                       passed.start);
}

/// Why there is no middle half of what has passed.
std::string why_no_rate(const PassedMass& passed) {
    if (passed.time.empty()) return "nothing has passed";
    if (passed.total() < 0.0) return fmt::format("{:.4g} kg have passed against the normal: turn it round", -passed.total());
    return "as much has passed back, or all at one time";
}

}  // namespace

std::optional<Mistake> map_size_mistake(double width, double height, double cell) {
    const double cells = (width / cell + 1.0) * (height / cell + 1.0);
    if (cells <= k_most_cells) return std::nullopt;
    return Mistake{"", fmt::format("cell_m = {:g} gives a map of {:.3g} cells over {:.4g} x {:.4g} m", cell, cells, width, height),
                   fmt::format("It has at most {:.0f}", k_most_cells), "Take larger cells or a smaller region"};
}

/// A run may end before its study's end: stopped, or not finished.
MeasureOutcome measure_passed_mass(const MeasureSource& source, const MeasureValues& values) {
    const PassedMass passed = passed_mass(source, values);
    const double from = values.optional_number("from_s").value_or(passed.start), to = values.optional_number("to_s").value_or(passed.end);
    if (from > passed.start && from >= passed.end)
        return without_value("kg", fmt::format("the run ends at {:g} s, before the window, which begins at {:g} s", passed.end, from));
    const bool beyond = to > passed.end * (1.0 + k_rounding);
    MeasureOutcome outcome;
    outcome.value = passed.at(to) - passed.at(from);
    outcome.unit = "kg";
    const auto inside = std::count_if(passed.time.begin(), passed.time.end(), [&](double time) { return time > from && time <= to; });
    outcome.detail = {{"from_s", from}, {"to_s", std::min(to, passed.end)}, {"crossings", inside}};
    if (beyond) outcome.detail["reason"] = fmt::format("the run ends at {:g} s, in the window of {:g} to {:g} s", passed.end, from, to);
    outcome.detail["last_crossing_s"] = passed.time.empty() ? json(nullptr) : json(passed.time.back());
    outcome.series = mass_series(passed);
    return outcome;
}

MeasureOutcome measure_rate(const MeasureSource& source, const MeasureValues& values) {
    const PassedMass passed = passed_mass(source, values);
    if (!passed.whole && values.optional_number("from_s").value_or(0.0) < passed.start)
        return without_value("kg/s", why_no_start(passed) + fmt::format(": let the window begin at {:g} s or later", passed.start));
    const auto half = middle_half(passed);
    const bool has_window = values.has("from_s") || values.has("to_s");
    if (!has_window && !half) return without_value("kg/s", why_no_rate(passed));
    Rate rate;
    MeasureOutcome outcome;
    if (has_window) {
        const double from = values.optional_number("from_s").value_or(passed.start),
                     to = values.optional_number("to_s").value_or(passed.end);
        if (from >= to || to > passed.end * (1.0 + k_rounding))
            throw UserError(fmt::format("the window of the rate is {:g} to {:g} s", from, to),
                            fmt::format("The run has {:g} to {:g} s", passed.start, passed.end), "Move the window into the run");
        rate = rate_in(passed, from, to);
    } else {
        rate = rate_in(passed, half->first, half->second);
    }
    outcome.value = rate.slope;
    outcome.unit = "kg/s";
    outcome.standard_error = rate.standard_error;
    outcome.detail = to_json(rate);
    outcome.detail["middle_half"] = half ? to_json(rate_in(passed, half->first, half->second)) : json(nullptr);
    outcome.series = mass_series(passed);
    return outcome;
}

MeasureOutcome measure_time_of(const MeasureSource& source, const MeasureValues& values) {
    const PassedMass passed = passed_mass(source, values);
    if (!passed.whole) return without_value("s", why_no_start(passed));
    const double whole = values.optional_number("of_kg").value_or(passed.total());
    if (whole <= 0.0) return without_value("s", why_no_rate(passed));
    const auto time = time_when(passed, values.number("share") * whole);
    if (!time)
        return without_value("s",
                             fmt::format("{:.4g} kg have passed by the end, not {:.4g}", passed.total(), values.number("share") * whole));
    MeasureOutcome outcome;
    outcome.value = *time;
    outcome.unit = "s";
    outcome.detail = {{"whole_kg", whole}, {"passed_kg", passed.total()}};
    outcome.series = mass_series(passed);
    return outcome;
}

MeasureOutcome measure_mass_in(const MeasureSource& source, const MeasureValues& values) {
    const Look seen = look(source, values);
    MeasureOutcome outcome;
    outcome.value = mass_of(seen.grains);
    outcome.unit = "kg";
    outcome.detail = {{"at_s", seen.time}, {"grains", seen.grains.size()}};
    return outcome;
}

MeasureOutcome measure_packing(const MeasureSource& source, const MeasureValues& values) {
    const std::size_t picture = source.picture_near(values.optional_number("at_s"));
    const Region region = region_of(values.raw("region"));
    MeasureOutcome outcome;
    outcome.value = solid_share(source.grains(picture), region);
    outcome.unit = "-";
    outcome.detail = {{"at_s", source.picture_times()[picture]}, {"volume_m3", volume_of(region)}};
    return outcome;
}

MeasureOutcome measure_profile(const MeasureSource& source, const MeasureValues& values) {
    const std::optional<MeasuredProfile> measured = measured_profile(source, values);
    if (!measured) return without_value("m", why_no_grains(values, look(source, values).time));
    MeasureOutcome outcome;
    outcome.value = *std::max_element(measured->profile.height.begin(), measured->profile.height.end());
    outcome.unit = "m";
    outcome.detail = {{"at_s", measured->time}};
    if (!measured->reason.empty()) outcome.detail["reason"] = measured->reason;
    outcome.series = {{"place_m", numbers(measured->profile.place)}, {"height_m", numbers(measured->profile.height)}};
    return outcome;
}

Profile given_profile(const MeasureSource& source, const MeasureValues& values) {
    const std::filesystem::path file = source.directory() / values.text("against");
    if (!std::filesystem::is_regular_file(file))
        throw UserError({{file.string(), "there is no such file", "against names a CSV file; its path is relative to the run directory",
                          "Put the file there, or correct the path in measures.json"}});
    return read_profile(file);
}

MeasureOutcome measure_profile_error(const MeasureSource& source, const MeasureValues& values) {
    const Profile given = given_profile(source, values);
    const std::optional<MeasuredProfile> measured = measured_profile(source, values);
    if (!measured) return without_value("-", why_no_grains(values, look(source, values).time));
    const ProfileError error = profile_error(measured->profile, given, measured->diameter);
    MeasureOutcome outcome;
    outcome.value = error.error;
    outcome.unit = "-";
    outcome.detail = {
        {"at_s", measured->time}, {"points", error.used}, {"left_out", error.left_out}, {"least_height_m", measured->diameter}};
    if (!measured->reason.empty()) outcome.detail["reason"] = measured->reason;
    outcome.series = {{"place_m", numbers(measured->profile.place)},
                      {"height_m", numbers(measured->profile.height)},
                      {"given_place_m", numbers(given.place)},
                      {"given_height_m", numbers(given.height)}};
    return outcome;
}

MeasureOutcome measure_angle(const MeasureSource& source, const MeasureValues& values) {
    const Look seen = look(source, values);
    if (seen.grains.size() == 0) return without_value("deg", "no angle: " + why_no_grains(values, seen.time));
    const SlopeSearch search = slope_search(values, seen.grains);
    const Slopes slopes = slopes_of(seen.grains, search);
    MeasureOutcome outcome;
    outcome.value = slopes.angle_deg;
    outcome.unit = "deg";
    if (slopes.angle_deg) outcome.standard_error = slopes.spread_deg / std::sqrt(static_cast<double>(slopes.sides.size()));
    outcome.detail = {{"at_s", seen.time},
                      {"spread_deg", slopes.spread_deg},
                      {"r2", slopes.r2},
                      {"rises_outwards", slopes.rises_outwards},
                      {"centre_m", place_of(search.axis)}};
    outcome.detail["cone_angle_deg"] = slopes.cone_angle_deg ? json(*slopes.cone_angle_deg) : json(nullptr);
    outcome.detail["cone_r2"] = slopes.cone_angle_deg ? json(slopes.cone_r2) : json(nullptr);
    if (!slopes.reason.empty()) outcome.detail["reason"] = slopes.reason;
    json sides = json::array(), silhouettes = json::array();
    for (const SlopeSide& side : slopes.sides) {
        const double length = side.radius - search.inner_radius;
        sides.push_back({{"view_deg", rounded(side.view_deg)},
                         {"angle_deg", rounded(side.angle_deg)},
                         {"r2", rounded(side.line.r2)},
                         {"residual_m", rounded(side.line.residual)},
                         {"straight", side.is_straight},
                         {"slope", rounded(side.line.slope)},
                         {"intercept_m", rounded(side.line.intercept)},
                         {"from_m", rounded(search.inner_radius + search.window_from * length)},
                         {"to_m", rounded(search.inner_radius + search.window_to * length)}});
    }
    for (const Profile& silhouette : slopes.silhouettes)
        silhouettes.push_back(series_of("place_m", silhouette.place, "height_m", silhouette.height));
    outcome.detail["sides"] = sides;
    outcome.series = {{"silhouettes", silhouettes}};
    return outcome;
}

MeasureOutcome measure_cavity(const MeasureSource& source, const MeasureValues& values) {
    const std::size_t picture = source.picture_near(values.optional_number("at_s"));
    const Region region = region_or_everywhere(values);
    const Grains grains = grains_of_map(source.grains(picture), region);
    const std::string quantity = values.text("quantity"), unit = quantity == "volume" ? "m3" : "m";
    const auto [lower, upper] = map_extent(grains, region);
    if (!(lower.array() < upper.array()).all()) return without_value(unit, "no grains, or too few for a map");
    const double cell = values.number("cell_m");
    if (const auto mistake = map_size_mistake(upper.x() - lower.x(), upper.y() - lower.y(), cell)) throw UserError({*mistake});
    const bool is_level_given = values.has("undisturbed_m");
    const Grains first = is_level_given ? Grains{} : grains_of_map(source.grains(0), region);
    const auto is_bare = [&](const Grains& bed) { return has_bare_corner(bed, lower, upper, cell); };
    if (!values.has("region") && (is_bare(grains) || (!is_level_given && is_bare(first))))
        return without_value(unit, "a corner of the bed's extent has no grains: give a region, a box within the bed");
    const double undisturbed = is_level_given ? values.number("undisturbed_m") : surface_level(first, lower, upper, cell);
    const auto cavity = cavity_of(grains, lower, upper, undisturbed, cell);
    if (!cavity) {
        MeasureOutcome none = without_value(unit, "no cavity: no place lies half a mean diameter below the undisturbed level");
        none.value = 0.0;
        return none;
    }
    MeasureOutcome outcome;
    outcome.value = quantity == "depth" ? cavity->depth : quantity == "volume" ? cavity->volume : cavity->diameter;
    outcome.unit = unit;
    json chords = json::array();
    for (const auto& [from, to] : cavity->chords) chords.push_back({place_of(from), place_of(to)});
    outcome.detail = {{"at_s", source.picture_times()[picture]},
                      {"depth_m", cavity->depth},
                      {"diameter_m", cavity->diameter},
                      {"area_m2", cavity->area},
                      {"volume_m3", cavity->volume},
                      {"centre_m", place_of(cavity->centre)},
                      {"level_m", cavity->level},
                      {"undisturbed_m", undisturbed},
                      {"chord_mean_m", cavity->chord_mean},
                      {"chords", chords},
                      {"chord_spread_m", cavity->chord_spread},
                      {"reaches_border", cavity->at_border}};
    const HeightMap& map = cavity->surface;
    outcome.series = {{"x0_m", map.x0},
                      {"y0_m", map.y0},
                      {"cell_m", map.cell},
                      {"columns", map.columns},
                      {"rows", map.rows},
                      {"height_m", numbers(map.height)},
                      {"outline_x_m", numbers(cavity->outline_x)},
                      {"outline_y_m", numbers(cavity->outline_y)}};
    return outcome;
}

MeasureOutcome measure_void_area(const MeasureSource& source, const MeasureValues& values) {
    const std::size_t picture = source.picture_near(values.optional_number("at_s"));
    const PlaneGrid grid = plane_grid(values);
    const std::vector<double> fraction = void_fraction(solid_map(source.grains(picture), grid), grid);
    const Vec3 seed = values.point("seed_m");
    const double threshold = values.number("threshold");
    const auto area_at = [&](double limit) { return void_area(fraction, grid, seed[grid.first()], seed[grid.second()], limit); };
    const VoidArea found = area_at(threshold);
    const bool diameter = values.text("quantity") == "equivalent_diameter";
    MeasureOutcome outcome;
    outcome.value = diameter ? found.equivalent_diameter : found.area;
    outcome.unit = diameter ? "m" : "m2";
    outcome.detail = {{"at_s", source.picture_times()[picture]},
                      {"area_m2", found.area},
                      {"equivalent_diameter_m", found.equivalent_diameter},
                      {"width_m", found.width},
                      {"height_m", found.height},
                      {"threshold", threshold},
                      {"area_at_lower_threshold_m2", area_at(threshold - 0.05).area},
                      {"area_at_higher_threshold_m2", area_at(threshold + 0.05).area}};
    if (found.area == 0.0) outcome.detail["reason"] = "the void fraction at the seed is below the threshold";
    outcome.series = grid_json(grid);
    outcome.series["void_fraction"] = numbers(fraction);
    outcome.series["outline_column_m"] = numbers(found.outline_x);
    outcome.series["outline_row_m"] = numbers(found.outline_z);
    return outcome;
}

MeasureOutcome measure_bed_velocity(const MeasureSource& source, const MeasureValues& values) {
    const PlaneGrid grid = plane_grid(values);
    const std::vector<double>& times = source.picture_times();
    const double from = values.optional_number("from_s").value_or(times.front()),
                 to = values.optional_number("to_s").value_or(times.back());
    SolidMap sum;
    sum.volume.assign(grid.cells(), 0.0);
    sum.volume_by_velocity.assign(grid.cells(), Vec3::Zero());
    Signal speeds;
    double volume = 0.0, speed_sum = 0.0, faster = 0.0;
    for (std::size_t n = 0; n < times.size(); ++n) {
        if (times[n] < from || times[n] > to) continue;
        const SolidMap map = solid_map(source.grains(n), grid, values.number("faster_than_m_s"));
        double solid = 0.0;
        for (std::size_t c = 0; c < grid.cells(); ++c) {
            sum.volume[c] += map.volume[c];
            sum.volume_by_velocity[c] += map.volume_by_velocity[c];
            solid += map.volume[c];
        }
        volume += solid;
        speed_sum += map.speed_sum;
        faster += map.faster_volume;
        speeds.time.push_back(times[n]);
        speeds.value.push_back(solid > 0.0 ? map.speed_sum / solid : 0.0);
    }
    if (volume == 0.0) return without_value("m/s", speeds.time.empty() ? "no picture in the window" : "no grains in the region");
    MeasureOutcome outcome;
    outcome.value = speed_sum / volume;
    outcome.unit = "m/s";
    const double length = speeds.time.back() - speeds.time.front();
    if (const auto average = time_average(speeds.time, speeds.value, speeds.time.front(), speeds.time.back(), length / k_error_batches))
        outcome.standard_error = average->standard_error;
    outcome.detail = {{"from_s", speeds.time.front()},
                      {"to_s", speeds.time.back()},
                      {"pictures", speeds.time.size()},
                      {"moving_share", faster / volume},
                      {"faster_than_m_s", values.number("faster_than_m_s")}};
    std::vector<double> along, up;
    for (std::size_t c = 0; c < grid.cells(); ++c) {
        const Vec3 velocity = sum.volume[c] > 0.0 ? Vec3(sum.volume_by_velocity[c] / sum.volume[c]) : Vec3(Vec3::Zero());
        along.push_back(velocity[grid.first()]);
        up.push_back(velocity[grid.second()]);
    }
    outcome.series = grid_json(grid);
    outcome.series["velocity_along_columns_m_s"] = numbers(along);
    outcome.series["velocity_along_rows_m_s"] = numbers(up);
    outcome.series["solid_m3"] = numbers(sum.volume);
    outcome.series["time_s"] = numbers(speeds.time);
    outcome.series["speed_m_s"] = numbers(speeds.value);
    return outcome;
}

MeasureOutcome measure_spectrum(const MeasureSource& source, const MeasureValues& values) {
    const Signal signal = values.has("wall") ? source.wall_force(values.text("wall"), values.text("component"))
                                             : source.column(values.text("table"), values.text("column"));
    const Signal part = in_window(signal, values);
    const Spectrum spectrum = spectrum_of(part.time, part.value, values.integer("segments"));
    const bool strouhal = values.text("quantity") == "strouhal";
    const auto length = values.optional_number("length_m"), velocity = values.optional_number("velocity_m_s");
    const double factor = strouhal ? *length / *velocity : 1.0;
    MeasureOutcome outcome;
    outcome.unit = strouhal ? "-" : "Hz";
    outcome.detail = {{"from_s", part.time.front()},
                      {"to_s", part.time.back()},
                      {"amplitude", spectrum.amplitude},
                      {"peak_over_median", spectrum.peak_over_median},
                      {"noise_limit", spectrum.noise_limit}};
    const auto& peak = spectrum.peak_frequency;
    outcome.detail["peak_frequency_hz"] = peak ? json(*peak) : json(nullptr);
    outcome.detail["strouhal"] = peak && length && velocity ? json(*peak * *length / *velocity) : json(nullptr);
    if (!peak) {
        outcome.detail["reason"] = "the signal changes slowly, and power falls with frequency: take a later window";
    } else if (spectrum.stands_out()) {
        outcome.value = factor * *peak;
        if (spectrum.standard_error) outcome.standard_error = factor * *spectrum.standard_error;
    } else if (!std::isfinite(spectrum.peak_over_median)) {
        outcome.detail["reason"] = "the signal does not change";
    } else {
        outcome.detail["reason"] =
            fmt::format("no oscillation stands out: the highest line is {:.1f} times the median, noise reaches {:.1f}",
                        spectrum.peak_over_median, spectrum.noise_limit);
    }
    const std::size_t shown = lines_to_show(spectrum);
    outcome.series = {
        {"frequency_hz", numbers({spectrum.frequency.begin(), spectrum.frequency.begin() + static_cast<std::ptrdiff_t>(shown)})},
        {"power", numbers({spectrum.power.begin(), spectrum.power.begin() + static_cast<std::ptrdiff_t>(shown)})}};
    return outcome;
}

MeasureOutcome measure_wall_force(const MeasureSource& source, const MeasureValues& values) {
    return mean_of(source.wall_force(values.text("wall"), values.text("component")), values, "N", "force_n");
}

MeasureOutcome measure_pressure_drop(const MeasureSource& source, const MeasureValues& values) {
    Signal drop = source.probe_difference(values.name());
    for (double& value : drop.value) value *= values.number("density_kg_m3");
    return mean_of(drop, values, "Pa", "pressure_pa");
}

}  // namespace cutterflow::postproc
