#include "solver/replay/frozen_fluid.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace cutterflow::coupling {
namespace {

/// Phases of the still cells that a step passes at most.
constexpr double k_phases_per_step = 2.0;

Vec3 between(const std::vector<float>& values, std::size_t before, std::size_t after, double share) {
    const Eigen::Map<const Eigen::Vector3f> first(&values[before]), second(&values[after]);
    return (1.0 - share) * first.cast<double>() + share * second.cast<double>();
}

[[noreturn]] void not_recorded(const char* what) {
    throw std::logic_error(fmt::format("a recorded flow has no {}", what));
}

}  // namespace

FrozenFluid::FrozenFluid(FlowRecording recording, const ClockTimes& times)
    : recording_(std::move(recording)),
      clock_(times, k_phases_per_step * 2.0 * k_pi / (recording_.blades * recording_.phases * std::abs(recording_.moving.front().speed))),
      velocity_(recording_.cells.size()),
      acceleration_(recording_.cells.size()),
      void_fraction_(recording_.cells.size(), 1.0),
      zero_(recording_.cells.size(), 0.0) {
    set_fields();
}

void FrozenFluid::end_step(gsl::span<const double>, gsl::span<const double> void_fraction_new, const MomentumExchange&) {
    reset_void_fraction(void_fraction_new);
    set_fields();
}

void FrozenFluid::reset_void_fraction(gsl::span<const double> void_fraction) {
    void_fraction_.assign(void_fraction.begin(), void_fraction.end());
}

void FrozenFluid::set_fields() {
    const ZoneMotion& rotor = recording_.moving.front();
    const double angle = rotor.angle(time());
    const Eigen::Matrix3d from_rotor(Eigen::AngleAxisd(angle, rotor.axis.direction));
    const PhasePlace places[] = {phase_place(recording_, 0, angle), phase_place(recording_, 1, angle)};
    const std::size_t cells = recording_.cells.size();
    for (std::size_t c = 0; c < cells; ++c) {
        const std::size_t period = period_of(recording_.cells.zone[c]);
        const PhasePlace& place = places[period];
        const std::size_t before = 3 * (c + cells * place.before), after = 3 * (c + cells * place.after);
        velocity_[c] = between(recording_.velocity, before, after, place.share);
        acceleration_[c] = between(recording_.acceleration, before, after, place.share);
        if (period == 0) continue;
        velocity_[c] = from_rotor * velocity_[c];
        acceleration_[c] = from_rotor * acceleration_[c];
    }
}

gsl::span<const Vec3> FrozenFluid::vorticity() {
    not_recorded("vorticity");
}
gsl::span<const Vec3> FrozenFluid::stress_divergence() {
    not_recorded("stress");
}
gsl::span<const Vec3> FrozenFluid::received() const {
    not_recorded("momentum from rock");
}
void FrozenFluid::sample_velocity(gsl::span<const Vec3>, gsl::span<Vec3>) {
    not_recorded("velocity between cells");
}
void FrozenFluid::watch(const WatchedPlaces&) {
    not_recorded("velocity between cells");
}
std::vector<double> FrozenFluid::watched_means() {
    not_recorded("velocity between cells");
}

}  // namespace cutterflow::coupling
