#include "solver/observe/velocity/velocity_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <istream>
#include <ostream>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::coupling {
namespace {

constexpr double k_turn = 2.0 * k_pi;
// A revolution is whole when no more than this is missing [rad]: angles are sums of steps and carry their rounding.
constexpr double k_rounding = 1e-6;
constexpr double k_most_revolutions = 1e6;  // of a checkpoint that is believed

template <class T>
void put(std::ostream& stream, const T* data, std::size_t count) {
    stream.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(count * sizeof(T)));
}

template <class T>
void take(std::istream& stream, T* data, std::size_t count) {
    stream.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(count * sizeof(T)));
}

/// Bytes from here to the end.
std::uint64_t bytes_left(std::istream& stream) {
    const auto here = stream.tellg();
    const auto end = stream.seekg(0, std::ios::end).tellg();
    stream.seekg(here);
    return here < 0 || end < here ? 0 : static_cast<std::uint64_t>(end - here);
}

/// Calls part(bin, from, to) for the pieces into which bins of equal width cut [from, to].
template <class Part>
void cut(double from, double to, double width, const Part& part) {
    for (double begin = from; begin < to;) {
        const double bin = std::floor(begin / width + 1e-12);
        const double end = std::min(to, (bin + 1.0) * width);
        if (end > begin) part(static_cast<std::size_t>(bin), begin, end);
        begin = std::max(end, std::nextafter(begin, to));
    }
}

}  // namespace

VelocityStatistics::VelocityStatistics(std::vector<double> period, int phases, double origin)
    : period_(std::move(period)),
      phases_(phases),
      origin_(origin),
      by_phase_(static_cast<std::size_t>(phases), std::vector<WeightedVelocity>(period_.size())),
      dry_(period_.size(), 0) {}

void VelocityStatistics::add(double angle, gsl::span<const Vec3> velocity, gsl::span<const std::uint8_t> wet) {
    if (samples_ == 0) {
        hold(0.0, angle, velocity, wet);
    } else {
        const double middle = 0.5 * (last_angle_ + angle);
        hold(last_angle_, middle, last_velocity_, last_wet_);
        hold(middle, angle, velocity, wet);
    }
    for (std::size_t i = 0; i < points(); ++i) dry_[i] += wet[i] != 0 ? 0 : 1;
    ++samples_;
    last_angle_ = angle;
    last_velocity_.assign(velocity.begin(), velocity.end());
    last_wet_.assign(wet.begin(), wet.end());
}

void VelocityStatistics::hold(double from, double to, gsl::span<const Vec3> velocity, gsl::span<const std::uint8_t> wet) {
    cut(from, to, k_turn, [&](std::size_t revolution, double begin, double end) {
        while (revolutions_.size() <= revolution) revolutions_.emplace_back(points());
        for (std::size_t i = 0; i < points(); ++i)
            if (wet[i] != 0) revolutions_[revolution][i].add(velocity[i], end - begin);
    });
    if (phases_ > 0) hold_in_phases(from, to, velocity, wet);
}

void VelocityStatistics::hold_in_phases(double from, double to, gsl::span<const Vec3> velocity, gsl::span<const std::uint8_t> wet) {
    for (std::size_t i = 0; i < points(); ++i) {
        if (wet[i] == 0) continue;
        cut(origin_ + from, origin_ + to, period_[i] / phases_, [&](std::size_t bin, double begin, double end) {
            by_phase_[bin % static_cast<std::size_t>(phases_)][i].add(velocity[i], end - begin);
        });
    }
}

int VelocityStatistics::whole_revolutions() const {
    return samples_ == 0 ? 0 : static_cast<int>(std::floor((last_angle_ + k_rounding) / k_turn));
}

WeightedVelocity VelocityStatistics::average(std::size_t point) const {
    WeightedVelocity all;
    const auto whole = static_cast<std::size_t>(whole_revolutions());
    const std::size_t used = whole > 0 ? std::min(whole, revolutions_.size()) : revolutions_.size();
    for (std::size_t n = 0; n < used; ++n) {
        all.sum += revolutions_[n][point].sum;
        all.weight += revolutions_[n][point].weight;
    }
    return all;
}

std::optional<Vec3> VelocityStatistics::standard_error(std::size_t point) const {
    std::vector<Vec3> means;
    for (int n = 0; n < whole_revolutions(); ++n) {
        const WeightedVelocity& batch = revolutions_[static_cast<std::size_t>(n)][point];
        if (batch.weight > 0.0) means.push_back(batch.mean());
    }
    if (means.size() < 2) return std::nullopt;
    const auto count = static_cast<double>(means.size());
    Vec3 mean = Vec3::Zero();
    for (const Vec3& batch : means) mean += batch / count;
    Vec3 squares = Vec3::Zero();
    for (const Vec3& batch : means) squares += (batch - mean).cwiseAbs2();
    return Vec3((squares / (count * (count - 1.0))).cwiseSqrt());
}

void VelocityStatistics::write(std::ostream& stream) const {
    const std::uint64_t header[] = {points(), static_cast<std::uint64_t>(phases_), revolutions_.size(), samples_};
    put(stream, header, 4);
    put(stream, &last_angle_, 1);
    for (const Bins* bins : {&revolutions_, &by_phase_})
        for (const auto& bin : *bins) put(stream, bin.data(), bin.size());
    put(stream, dry_.data(), dry_.size());
    if (samples_ == 0) return;
    put(stream, last_velocity_.data(), points());
    put(stream, last_wet_.data(), points());
}

bool VelocityStatistics::restore(std::istream& stream) {
    std::uint64_t header[4] = {};
    take(stream, header, 4);
    if (!stream || header[0] != points() || header[1] != static_cast<std::uint64_t>(phases_)) return false;
    const std::uint64_t bytes_per_revolution = points() * sizeof(WeightedVelocity);
    if (bytes_per_revolution > 0 && header[2] > bytes_left(stream) / bytes_per_revolution) return false;
    take(stream, &last_angle_, 1);
    const double turns = last_angle_ / k_turn;
    // The last revolution is there from its first moment on.
    if (!stream || !(turns >= 0.0 && turns <= k_most_revolutions) || std::abs(static_cast<double>(header[2]) - turns) > 1.001) return false;
    revolutions_.assign(header[2], std::vector<WeightedVelocity>(points()));
    samples_ = header[3];
    for (Bins* bins : {&revolutions_, &by_phase_})
        for (auto& bin : *bins) take(stream, bin.data(), bin.size());
    take(stream, dry_.data(), dry_.size());
    if (whole_revolutions() > static_cast<int>(revolutions_.size())) return false;
    if (samples_ == 0) return static_cast<bool>(stream);
    last_velocity_.resize(points());
    last_wet_.resize(points());
    take(stream, last_velocity_.data(), points());
    take(stream, last_wet_.data(), points());
    return static_cast<bool>(stream);
}

}  // namespace cutterflow::coupling
