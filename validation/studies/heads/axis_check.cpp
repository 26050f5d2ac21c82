#include "validation/studies/heads/axis_check.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <ctime>
#include <random>

#include "geometry/base/axis_frame.hpp"
#include "geometry/head/head.hpp"
#include "validation/studies/heads/head_family.hpp"

namespace cutterflow::validation {
namespace {

constexpr std::array<double, 4> k_noise = {0.0, 0.0005, 0.001, 0.002};
constexpr double k_largest_shift = 5.0;  // ring radii

geometry::TriangleSurface roughened(geometry::TriangleSurface surface, double deviation, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> noise(0.0, deviation);
    for (Vec3& point : surface.points) point += Vec3(noise(generator), noise(generator), noise(generator));
    return surface;
}

Vec3 unit_vector(double a, double b) {
    const double z = 2.0 * a - 1.0;
    const double azimuth = 2.0 * k_pi * b;
    const double radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

}  // namespace

bool AxisCheck::passed() const {
    return angle_error_deg < 0.1 && offset_error < 0.001 && blades_found == head.blade_count && carrying_found;
}

AxisCheck check_axis(int index) {
    AxisCheck check;
    check.head = family_head(index);
    check.noise = k_noise[static_cast<std::size_t>(index) % k_noise.size()];
    const double radius = check.head.ring_radius;
    const double turn = k_pi * family_share(index, 13);
    check.tilt_deg = turn * 180.0 / k_pi;
    const Vec3 about = unit_vector(family_share(index, 14), family_share(index, 15));
    const Vec3 shift =
        k_largest_shift * radius * (2.0 * Vec3(family_share(index, 11), family_share(index, 12), family_share(index, 10)) - Vec3::Ones());
    Eigen::Affine3d motion(Eigen::Translation3d(shift) * Eigen::AngleAxisd(turn, about));
    const geometry::TriangleSurface file = geometry::transformed(
        roughened(geometry::generate_crown_cutter(check.head), check.noise * radius, static_cast<unsigned>(index)), motion);

    const std::clock_t begin = std::clock();
    const geometry::Head found = geometry::understand_head(file);
    check.core_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;

    const Vec3 direction = motion.linear() * Vec3::UnitZ();
    const Vec3 offset = found.axis.origin - shift;
    check.angle_error_deg = std::atan2(found.axis.direction.cross(direction).norm(), found.axis.direction.dot(direction)) * 180.0 / k_pi;
    check.offset_error = (offset - direction * offset.dot(direction)).norm() / radius;
    check.radius_error = std::abs(found.ring_radius / radius - 1.0);
    check.blades_found = found.symmetry.blade_count;
    check.carrying_found =
        found.carrying.sense == (check.head.blade_wrap > 0.0 ? geometry::CarryingSense::positive : geometry::CarryingSense::negative);
    return check;
}

std::string table_header() {
    return fmt::format("{:>3} {:>7} {:>6} {:>8} {:>6} {:>7} {:>7} {:>10} {:>10} {:>8} {:>6} {:>8} {:>6}", "no", "R, m", "blades",
                       "wrap, deg", "picks", "noise,%", "tilt", "axis, deg", "axis, % R", "R, %", "found", "carrying", "core s");
}

std::string table_row(int index, const AxisCheck& c) {
    return fmt::format("{:>3} {:>7.4f} {:>6} {:>8.1f} {:>6} {:>7.2f} {:>7.1f} {:>10.4f} {:>10.4f} {:>8.3f} {:>6} {:>8} {:>6.2f} {}",
                       index + 1, c.head.ring_radius, c.head.blade_count, c.head.blade_wrap * 180.0 / k_pi, c.head.picks_per_blade,
                       100.0 * c.noise, c.tilt_deg, c.angle_error_deg, 100.0 * c.offset_error, 100.0 * c.radius_error, c.blades_found,
                       c.carrying_found ? "right" : "WRONG", c.core_s, c.passed() ? "passed" : "MISSED");
}

}  // namespace cutterflow::validation
