#include "postproc/analysis/adv_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/head/head_names.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double k_same_place = 1e-6;  // [m]
constexpr double k_hit_share = 0.25;
constexpr const char* k_sample_again = "Add the points to the study (report.adv_points) and run it in a new directory";

/// Means of a point's place in the averaged revolutions, Cartesian, in the frame of the instrument (relative to a turning one).
struct PlaceMean {
    Vec3 sum = Vec3::Zero();  // weighted by the share of each revolution in water
    double weight = 0.0;
    std::vector<Vec3> by_revolution;
    std::vector<double> wet_share;
    std::optional<Vec3> mean() const { return weight > 0.0 ? std::optional<Vec3>(sum / weight) : std::nullopt; }
};

/// What the run wrote of its set adv.
struct Sampled {
    Table places;       // adv.csv
    Table revolutions;  // adv_revolutions.csv
    int whole_revolutions = 0;
};

Sampled read_sampled(const fs::path& directory) {
    const std::vector<std::string> velocity{"u_radial_m_s", "u_tangential_m_s", "u_axial_m_s"};
    const std::string mean_file = fmt::format("{}.csv", names::adv_set),
                      revolution_file = fmt::format("{}_revolutions.csv", names::adv_set);
    Sampled sampled;
    for (const auto& [start, folder] : start_folders(directory, "velocity")) {
        if (!fs::exists(folder / mean_file) || !fs::exists(folder / revolution_file)) continue;
        TableRules rules{{"point", "x_m", "y_m", "z_m", "rotating", "revolutions"}, {}, velocity, k_sample_again, {"revolutions"}};
        for (const char* component : {"radial", "tangential", "axial"}) rules.may_be_empty.push_back(fmt::format("se_{}_m_s", component));
        sampled.places = read_table(folder / mean_file, rules);
        sampled.revolutions =
            read_table(folder / revolution_file,
                       {{"revolution", "point", velocity[0], velocity[1], velocity[2], "wet_share"}, {}, velocity, k_sample_again});
    }
    if (sampled.places.empty())
        throw UserError(fmt::format("{} contains no velocities at measurement points", directory.string()),
                        "The run averages the velocity at the points that its study names", k_sample_again);
    sampled.whole_revolutions = static_cast<int>(sampled.places.number("revolutions")[0]);
    const std::size_t needed = sampled.places.rows() * static_cast<std::size_t>(sampled.whole_revolutions);
    if (sampled.revolutions.rows() < needed)
        throw UserError(fmt::format("{} of {} has {} rows", revolution_file, directory.string(), sampled.revolutions.rows()),
                        fmt::format("{} tells of {} places and {} whole revolutions: {} rows", mean_file, sampled.places.rows(),
                                    sampled.whole_revolutions, needed),
                        "Copy the run directory again as a whole");
    return sampled;
}

Vec3 place_of(const Table& places, std::size_t row) {
    return {places.number("x_m")[row], places.number("y_m")[row], places.number("z_m")[row]};
}

/// First row of the point's places, if the run sampled them.
std::optional<std::size_t> first_row(const Sampled& sampled, const AdvPoint& point, const AdvProbe& probe) {
    const std::vector<Vec3> wanted = adv_places(point, probe);
    for (std::size_t first = 0; first + k_adv_places <= sampled.places.rows(); first += k_adv_places) {
        bool same = (sampled.places.number("rotating")[first] != 0.0) == point.rotating;
        for (std::size_t i = 0; same && i < k_adv_places; ++i)
            same = (place_of(sampled.places, first + i) - wanted[i]).norm() <= k_same_place;
        if (same) return first;
    }
    return std::nullopt;
}

/// \param speed  of the rotor [rad/s], signed
PlaceMean mean_at(const Sampled& sampled, std::size_t row, bool rotating, double speed, int revolutions) {
    const Vec3 place = place_of(sampled.places, row);
    const double azimuth = std::atan2(place[1], place[0]);
    const Vec3 radial(std::cos(azimuth), std::sin(azimuth), 0.0), tangential = Vec3::UnitZ().cross(radial);
    const Vec3 frame = rotating ? Vec3(speed * Vec3::UnitZ().cross(place)) : Vec3(Vec3::Zero());
    PlaceMean mean;
    const Table& table = sampled.revolutions;
    for (int n = sampled.whole_revolutions - revolutions; n < sampled.whole_revolutions; ++n) {
        const std::size_t line = static_cast<std::size_t>(n) * sampled.places.rows() + row;
        const double share = table.number("wet_share")[line];
        mean.wet_share.push_back(share);
        const Vec3 velocity = share > 0.0
                                  ? Vec3(table.number("u_radial_m_s")[line] * radial + table.number("u_tangential_m_s")[line] * tangential +
                                         table.number("u_axial_m_s")[line] * Vec3::UnitZ() - frame)
                                  : Vec3(Vec3::Zero());
        mean.by_revolution.push_back(velocity);
        mean.sum += share * velocity;
        mean.weight += share;
    }
    return mean;
}

/// Mean over the probe's volume: places weigh as long as they were in water.
PlaceMean probe_mean(const std::vector<PlaceMean>& places) {
    PlaceMean probe;
    const std::size_t revolutions = places.front().by_revolution.size();
    for (std::size_t n = 0; n < revolutions; ++n) {
        Vec3 sum = Vec3::Zero();
        double weight = 0.0;
        for (std::size_t i = 0; i < k_probe_places; ++i) {
            sum += places[i].wet_share[n] * places[i].by_revolution[n];
            weight += places[i].wet_share[n];
        }
        probe.by_revolution.push_back(weight > 0.0 ? Vec3(sum / weight) : Vec3(Vec3::Zero()));
        probe.wet_share.push_back(weight / k_probe_places);
        probe.sum += sum;
        probe.weight += weight;
    }
    return probe;
}

/// Standard error of the mean of the revolutions in which there was water.
std::optional<double> batch_error(const PlaceMean& probe, const Vec3& direction) {
    std::vector<double> batches;
    for (std::size_t n = 0; n < probe.by_revolution.size(); ++n)
        if (probe.wet_share[n] > 0.0) batches.push_back(probe.by_revolution[n].dot(direction));
    if (batches.size() < 2) return std::nullopt;
    const auto count = static_cast<double>(batches.size());
    double mean = 0.0, squares = 0.0;
    for (const double batch : batches) mean += batch / count;
    for (const double batch : batches) squares += (batch - mean) * (batch - mean);
    return std::sqrt(squares / (count * (count - 1.0)));
}

/// Change of the component along `direction` over the position error in the steepest direction, by differences between the places on
/// both sides (from the point itself where one side was in steel). None when neither side of some direction was in water.
std::optional<double> position_bar(const std::vector<PlaceMean>& places, const Vec3& centre, const Vec3& direction) {
    double squares = 0.0;
    for (std::size_t d = 0; d < 3; ++d) {
        const std::optional<Vec3> before = places[k_probe_places + 2 * d].mean(), after = places[k_probe_places + 2 * d + 1].mean();
        if (!before && !after) return std::nullopt;
        const Vec3 change = before && after ? Vec3(0.5 * (*after - *before)) : after ? Vec3(*after - centre) : Vec3(centre - *before);
        squares += std::pow(change.dot(direction), 2);
    }
    return std::sqrt(squares);
}

AdvResult result_at(const Sampled& sampled, std::size_t first, const AdvPoint& point, const geometry::Contour& contour, double speed,
                    int revolutions) {
    std::vector<PlaceMean> places;
    for (std::size_t i = 0; i < k_adv_places; ++i) places.push_back(mean_at(sampled, first + i, point.rotating, speed, revolutions));
    const PlaceMean probe = probe_mean(places);
    AdvResult result;
    result.point = point;
    result.inside = contour.signed_distance(point.place.radius, point.place.axial) < 0.0;
    result.wet_share = probe.weight / (k_probe_places * revolutions);
    for (std::size_t c = 0; c < 3; ++c) {
        AdvVelocity& velocity = result.velocity[c];
        velocity.measured = point.measured[c];
        const std::optional<Vec3> mean = probe.mean();
        if (!mean) continue;
        const Vec3 direction = point.direction(k_adv_components[c]);
        velocity.model = mean->dot(direction);
        velocity.position_bar = position_bar(places, *mean, direction);
        velocity.statistical_error = batch_error(probe, direction);
    }
    return result;
}

int revolutions_to_average(const Sampled& sampled, std::optional<int> wanted) {
    const int whole = sampled.whole_revolutions;
    if (whole == 0)
        throw UserError("the run has no whole revolution of velocities at points", "Means are over whole revolutions",
                        "Run longer (run.max_revolutions), or start averaging earlier (report.outflow_start_s)");
    if (wanted && (*wanted < 1 || *wanted > whole))
        throw UserError(fmt::format("--revolutions {}", *wanted),
                        fmt::format("The run has {} whole revolution(s) of velocities at points", whole),
                        fmt::format("Use 1 to {}", whole));
    return wanted.value_or(whole);
}

json optional_json(const std::optional<double>& value) {
    return value ? json(*value) : json(nullptr);
}

json agreement_json(const AdvAgreement& a) {
    if (a.count == 0) return {{"count", 0}};
    return {{"count", a.count}, {"bias_m_s", a.bias}, {"rmse_m_s", a.rmse}, {"slope", optional_json(a.slope)}, {"hit_rate", a.hit_rate}};
}

}  // namespace

AdvAgreement agreement(const AdvComparison& comparison, bool inside, std::optional<AdvComponent> component) {
    AdvAgreement result;
    double products = 0.0, squares = 0.0, errors = 0.0;
    for (const AdvResult& point : comparison.points) {
        if (point.inside != inside) continue;
        for (const AdvComponent c : k_adv_components) {
            const AdvVelocity& v = point.velocity[static_cast<std::size_t>(c)];
            if ((component && *component != c) || !v.measured || !v.model) continue;
            const double error = *v.model - *v.measured;
            const double width = v.position_bar.value_or(0.0) + 2.0 * v.statistical_error.value_or(0.0);
            ++result.count;
            result.bias += error;
            errors += error * error;
            products += *v.model * *v.measured;
            squares += *v.measured * *v.measured;
            result.hit_rate += std::abs(error) <= std::max(k_hit_share * std::abs(*v.measured), width) ? 1.0 : 0.0;
        }
    }
    if (result.count == 0) return result;
    const auto count = static_cast<double>(result.count);
    result.bias /= count;
    result.hit_rate /= count;
    result.rmse = std::sqrt(errors / count);
    if (squares > 0.0) result.slope = products / squares;
    return result;
}

AdvComparison compare_with_measurement(const fs::path& directory, const fs::path& points_file, std::optional<int> wanted) {
    Mistakes inputs;
    std::vector<AdvPoint> points;
    std::optional<RunData> read;
    inputs.gather([&] { points = read_adv_points(points_file); });
    inputs.gather([&] { read.emplace(read_run(directory)); });
    inputs.refuse();
    const RunData& run = *read;
    const Sampled sampled = read_sampled(directory);
    AdvComparison comparison;
    comparison.run = run.operating_point.study_name;
    comparison.points_file = points_file.string();
    comparison.speed_rpm = run.operating_point.speed_rpm;
    comparison.discharge = run.operating_point.discharge;
    comparison.probe = run.adv_probe;
    comparison.revolutions = revolutions_to_average(sampled, wanted);
    const double speed = (run.operating_point.rotor_direction == "left_handed" ? -1.0 : 1.0) * run.operating_point.angular_speed();
    std::vector<Mistake> mistakes;
    for (const AdvPoint& point : points) {
        const std::optional<std::size_t> first = first_row(sampled, point, comparison.probe);
        if (first)
            comparison.points.push_back(result_at(sampled, *first, point, run.contour, speed, comparison.revolutions));
        else
            mistakes.push_back({point.where, fmt::format("the run did not sample the point {}", point.name),
                                "A run averages the velocity at the points that its study names, with the study's probe", k_sample_again});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return comparison;
}

json adv_json(const AdvComparison& comparison) {
    json document{{"schema", k_adv_schema},
                  {"study", comparison.run},
                  {"points_file", comparison.points_file},
                  {"speed_rpm", comparison.speed_rpm},
                  {"discharge_m3_s", comparison.discharge},
                  {"revolutions", comparison.revolutions},
                  {"probe",
                   {{"diameter_m", comparison.probe.diameter},
                    {"length_m", comparison.probe.length},
                    {"position_error_m", comparison.probe.position_error}}}};
    document["points"] = json::array();
    for (const AdvResult& result : comparison.points) {
        const Cylindrical& place = result.point.place;
        json point{{"name", result.point.name},    {"frame", result.point.rotating ? "rotating" : "still"},
                   {"r_m", place.radius},          {"theta_deg", place.azimuth * 180.0 / k_pi},
                   {"z_m", place.axial},           {"inside_head", result.inside},
                   {"wet_share", result.wet_share}};
        for (const AdvComponent c : k_adv_components) {
            const AdvVelocity& v = result.velocity[static_cast<std::size_t>(c)];
            point[adv_component_name(c)] = {{"measured_m_s", optional_json(v.measured)},
                                            {"model_m_s", optional_json(v.model)},
                                            {"position_bar_m_s", optional_json(v.position_bar)},
                                            {"standard_error_m_s", optional_json(v.statistical_error)}};
        }
        document["points"].push_back(std::move(point));
    }
    for (const bool inside : {true, false}) {
        json& part = document["agreement"][inside ? "inside_head" : "outside_head"];
        part["all"] = agreement_json(agreement(comparison, inside));
        for (const AdvComponent c : k_adv_components) part[adv_component_name(c)] = agreement_json(agreement(comparison, inside, c));
    }
    return document;
}

std::string adv_text(const AdvComparison& comparison) {
    const auto value = [](const std::optional<double>& v) { return v ? fmt::format("{:.3f}", *v) : std::string("-"); };
    std::string text = fmt::format("{:<12} {:<8} {:<8} {:<10} {:>9} {:>9} {:>10} {:>10}\n", "point", "frame", "head", "component",
                                   "measured", "model", "position+-", "std. error");
    for (const AdvResult& result : comparison.points)
        for (const AdvComponent c : k_adv_components) {
            const AdvVelocity& v = result.velocity[static_cast<std::size_t>(c)];
            text += fmt::format("{:<12} {:<8} {:<8} {:<10} {:>9} {:>9} {:>10} {:>10}\n", result.point.name,
                                result.point.rotating ? "rotating" : "still", result.inside ? "inside" : "outside", adv_component_name(c),
                                value(v.measured), value(v.model), value(v.position_bar), value(v.statistical_error));
        }
    for (const bool inside : {true, false}) {
        const AdvAgreement a = agreement(comparison, inside);
        if (a.count > 0)
            text += fmt::format("{} the head, {} values: bias {:.3f} m/s, RMSE {:.3f} m/s, slope {}, hit rate {:.0f} %\n",
                                inside ? "inside" : "outside", a.count, a.bias, a.rmse, value(a.slope), 100.0 * a.hit_rate);
    }
    return text + fmt::format("velocities in m/s, model averaged over {} revolution{}\n", comparison.revolutions,
                              comparison.revolutions == 1 ? "" : "s");
}

}  // namespace cutterflow::postproc
