#pragma once
/// \file Averages of the velocity at points over the rotor's angle: by whole revolution and by phase.
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <vector>

#include <gsl/span>

#include "geometry/base/vec3.hpp"

namespace cutterflow::coupling {

/// Sum of weight times velocity, and of the weights (angle [rad] during which the point was in water).
struct WeightedVelocity {
    Vec3 sum = Vec3::Zero();
    double weight = 0.0;
    void add(const Vec3& velocity, double angle) {
        sum += angle * velocity;
        weight += angle;
    }
    Vec3 mean() const { return sum / weight; }  ///< \pre weight > 0
};

/// Velocity of a number of points against the angle that the rotor has turned since averaging began.
///
/// A sample holds half-way to the samples before and after it (trapezoidal rule in angle: second order, and nearly exact for functions
/// periodic in the revolution); the first one also back to the start of averaging. At the end of a revolution or phase it is divided
/// by angle. Samples in which a point is inside steel do not count for it.
class VelocityStatistics {
public:
    /// \param period  angle [rad] after which each point's phases repeat, one per point
    /// \param phases  bins of equal width per period; 0: no phase averages
    /// \param origin  rotor angle [rad] at the start of averaging, from which phases are counted
    VelocityStatistics(std::vector<double> period, int phases, double origin);

    /// \param angle     turned since averaging began [rad], larger than at the sample before
    /// \param velocity  one per point [m/s]
    /// \param wet       one per point: 0 when it is in steel
    void add(double angle, gsl::span<const Vec3> velocity, gsl::span<const std::uint8_t> wet);

    std::size_t points() const { return period_.size(); }
    int phases() const { return phases_; }
    double period(std::size_t point) const { return period_[point]; }

    int whole_revolutions() const;
    /// Of the n-th revolution, which may not be whole yet.
    const WeightedVelocity& revolution(std::size_t n, std::size_t point) const { return revolutions_[n][point]; }
    const WeightedVelocity& phase(int phase, std::size_t point) const { return by_phase_[static_cast<std::size_t>(phase)][point]; }

    /// Over the whole revolutions; over what there is before the first one is whole. Weight 0: never in water.
    WeightedVelocity average(std::size_t point) const;

    /// Standard error of average() by batch means, a batch being a revolution: sqrt(sum (m_k - m)^2 / (n (n - 1))) over the n whole
    /// revolutions in which the point was in water. None below two of them.
    std::optional<Vec3> standard_error(std::size_t point) const;

    std::uint64_t samples() const { return samples_; }
    std::uint64_t dry_samples(std::size_t point) const { return dry_[point]; }

    /// Everything, to the bit. restore() needs an object made alike. \return false when the stream holds something else
    void write(std::ostream& stream) const;
    bool restore(std::istream& stream);

private:
    using Bins = std::vector<std::vector<WeightedVelocity>>;  // [bin][point]
    void hold(double from, double to, gsl::span<const Vec3> velocity, gsl::span<const std::uint8_t> wet);
    void hold_in_phases(double from, double to, gsl::span<const Vec3> velocity, gsl::span<const std::uint8_t> wet);

    std::vector<double> period_;
    int phases_;
    double origin_;
    Bins revolutions_, by_phase_;
    std::vector<std::uint64_t> dry_;
    std::uint64_t samples_ = 0;
    // The sample before.
    double last_angle_ = 0.0;
    std::vector<Vec3> last_velocity_;
    std::vector<std::uint8_t> last_wet_;
};

}  // namespace cutterflow::coupling
