#include "solver/observe/velocity/velocity_sets.hpp"

#include <algorithm>
#include <cmath>
#include <istream>
#include <ostream>

#include <fmt/format.h>

#include "geometry/base/csv_table.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::coupling {
namespace {

constexpr double k_degree = k_pi / 180.0;
// A sample is due when no more than this of the angle is missing [rad]: angles are sums of steps and carry their rounding.
constexpr double k_rounding = 1e-6;

/// Velocity in components along the radius, the circumference and the axis at a place.
Vec3 cylindrical(const RotationAxis& axis, const Vec3& place, const Vec3& velocity) {
    const Vec3 arm = place - axis.origin;
    const Vec3 across = arm - axis.direction * axis.direction.dot(arm);
    const double radius = across.norm();
    const Vec3 radial = radius > 1e-12 ? Vec3(across / radius) : Vec3(Vec3::UnitX());
    return {velocity.dot(radial), velocity.dot(axis.direction.cross(radial)), velocity.dot(axis.direction)};
}

VelocitySet make_set(const VelocitySetSettings& settings, int blades, double origin) {
    std::vector<SamplePoint> points = read_sample_points(settings.file);
    std::vector<double> period;
    for (const SamplePoint& point : points) period.push_back(point.rotating ? 2.0 * k_pi : 2.0 * k_pi / blades);
    return {settings.name, std::move(points), VelocityStatistics(std::move(period), settings.phases, origin)};
}

}  // namespace

std::vector<SamplePoint> read_sample_points(const std::filesystem::path& file) {
    std::vector<Mistake> mistakes;
    const CsvTable table(file, {"x_m", "y_m", "z_m", "rotating"}, {}, mistakes);
    std::vector<SamplePoint> points;
    for (std::size_t row = 0; row < table.rows() && mistakes.empty(); ++row) {
        const double rotating = table.at(row, "rotating");
        if (rotating != 0.0 && rotating != 1.0)
            mistakes.push_back({table.where(row), fmt::format("rotating = {}", rotating), "It must be 0 (still) or 1 (turns with the head)",
                                "Correct the field"});
        points.push_back({{table.at(row, "x_m"), table.at(row, "y_m"), table.at(row, "z_m")}, rotating == 1.0});
    }
    if (!mistakes.empty()) throw UserError(mistakes);
    return points;
}

VelocitySets::VelocitySets(const VelocitySettings& settings, const FluidEngine& fluid)
    : start_time_(settings.start_time),
      interval_(settings.interval * k_degree),
      motion_(fluid.moving_zones().empty() ? ZoneMotion{} : fluid.moving_zones()[0]),
      rotor_steel_(motion_.speed == 0.0 ? gsl::span<const SteelTriangle>() : fluid.steel().of_zone[1]),
      stator_steel_(fluid.steel().of_zone[k_still_zone]),
      soil_(fluid.steel().soil) {
    std::vector<Mistake> mistakes;
    if (motion_.speed == 0.0)
        mistakes.push_back({names::coupling_properties, "section velocity with a rotor at rest", "Velocities are averaged over revolutions",
                            "Remove the section, or let the rotor turn"});
    for (const VelocitySetSettings& set : settings.sets) {
        try {
            sets_.push_back(make_set(set, settings.blades, std::abs(motion_.angle(start_time_))));
        } catch (const UserError& error) {
            mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
        }
    }
    if (!mistakes.empty()) throw UserError(mistakes);
    for (const VelocitySet& set : sets_) points_.insert(points_.end(), set.points.begin(), set.points.end());
    for (const SamplePoint& point : points_)
        always_dry_.push_back(point.rotating ? rotor_steel_.contains(point.place) : is_dry_at_rest(point.place));
    place_.resize(points_.size());
}

double VelocitySets::turned(double time) const {
    return std::abs(motion_.angle(time) - motion_.angle(start_time_));
}

void VelocitySets::sample_if_due(FluidEngine& fluid) {
    const double time = fluid.time();
    const double angle = turned(time);
    if (points_.empty() || time < start_time_ - k_rounding / std::abs(motion_.speed) || angle < next_ - k_rounding) return;
    next_ = interval_ * (std::floor((angle + k_rounding) / interval_) + 1.0);

    find_places(time);
    std::vector<Vec3> velocity(points_.size());
    fluid.sample_velocity(place_, velocity);
    const std::vector<std::uint8_t> wet = wet_points(motion_.angle(time));
    for (std::size_t i = 0; i < points_.size(); ++i) velocity[i] = cylindrical(motion_.axis, place_[i], velocity[i]);
    std::size_t first = 0;
    for (VelocitySet& set : sets_) {
        set.statistics.add(angle, gsl::span<const Vec3>(velocity).subspan(first, set.points.size()),
                           gsl::span<const std::uint8_t>(wet).subspan(first, set.points.size()));
        first += set.points.size();
    }
}

void VelocitySets::find_places(double time) {
    for (std::size_t i = 0; i < points_.size(); ++i)
        place_[i] = points_[i].rotating ? rotate_about(motion_.axis, motion_.angle(time), points_[i].place) : points_[i].place;
}

/// Whether what does not turn is at a place.
bool VelocitySets::is_dry_at_rest(const Vec3& place) const {
    return stator_steel_.contains(place) || soil_.contains(place);
}

std::vector<std::uint8_t> VelocitySets::wet_points(double rotor_angle) const {
    std::vector<std::uint8_t> wet(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
        // What moves past the point, in the frame in which it rests.
        const bool is_passed =
            points_[i].rotating ? is_dry_at_rest(place_[i]) : rotor_steel_.contains(rotate_about(motion_.axis, -rotor_angle, place_[i]));
        wet[i] = always_dry_[i] == 0 && !is_passed ? 1 : 0;
    }
    return wet;
}

/// What sums of this object are of: times, and each point with its phases.
std::vector<double> VelocitySets::identity() const {
    std::vector<double> numbers{start_time_, interval_};
    for (const VelocitySet& set : sets_)
        for (std::size_t i = 0; i < set.points.size(); ++i) {
            const Vec3& place = set.points[i].place;
            numbers.insert(numbers.end(), {place[0], place[1], place[2], set.points[i].rotating ? 1.0 : 0.0, set.statistics.period(i)});
        }
    return numbers;
}

void VelocitySets::write(std::ostream& stream) const {
    const std::vector<double> numbers = identity();
    stream.write(reinterpret_cast<const char*>(numbers.data()), static_cast<std::streamsize>(numbers.size() * sizeof(double)));
    stream.write(reinterpret_cast<const char*>(&next_), sizeof next_);
    for (const VelocitySet& set : sets_) set.statistics.write(stream);
}

bool VelocitySets::restore(std::istream& stream) {
    const std::vector<double> own = identity();
    std::vector<double> found(own.size());
    stream.read(reinterpret_cast<char*>(found.data()), static_cast<std::streamsize>(found.size() * sizeof(double)));
    if (!stream || found != own) return false;
    stream.read(reinterpret_cast<char*>(&next_), sizeof next_);
    return stream && std::isfinite(next_) &&
           std::all_of(sets_.begin(), sets_.end(), [&](VelocitySet& set) { return set.statistics.restore(stream); });
}

}  // namespace cutterflow::coupling
