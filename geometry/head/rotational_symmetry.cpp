#include "geometry/head/rotational_symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "geometry/base/error.hpp"
#include "geometry/cgal/solid_search.hpp"

namespace cutterflow::geometry {
namespace {

constexpr int k_max_blades = 12;
constexpr double k_contrast = 0.6;
/// Below this share of the radius a residual at the worst angle is faceting: the surface is one of revolution.
constexpr double k_revolution = 0.004;
constexpr double k_kept = 0.9;
constexpr double k_beside = 0.08;  // how far beside an angle, as a share of it, the residual must be larger ...
constexpr double k_minimum = 0.8;  // ... so that it is at most this share of that
constexpr std::size_t k_scan_samples = 600;
constexpr std::size_t k_fit_samples = 6000;
constexpr std::size_t k_directions = 400;  // over the half sphere: about 7 degrees apart
constexpr std::size_t k_direction_samples = 60;
constexpr std::size_t k_candidates = 12;
constexpr double k_golden_angle = 2.399963229728653;

/// Points spread evenly over the surface: equal steps of cumulative area, placed in their triangles by a low-discrepancy sequence.
std::vector<Vec3> surface_samples(const TriangleSurface& surface, std::size_t count) {
    std::vector<double> cumulative;
    double total = 0.0;
    for (const Triangle& triangle : surface.triangles) cumulative.push_back(total += area_vector(surface, triangle).norm());
    std::vector<Vec3> samples;
    std::size_t t = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double target = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * total;
        while (t + 1 < cumulative.size() && cumulative[t] < target) ++t;
        // Roberts' R2 sequence: inverse powers of the plastic number.
        double a = std::fmod(0.5 + 0.7548776662466927 * static_cast<double>(i), 1.0);
        double b = std::fmod(0.5 + 0.5698402909980532 * static_cast<double>(i), 1.0);
        if (a + b > 1.0) {
            a = 1.0 - a;
            b = 1.0 - b;
        }
        const Triangle& triangle = surface.triangles[t];
        const Vec3& corner = surface.points[triangle[0]];
        samples.push_back(corner + a * (surface.points[triangle[1]] - corner) + b * (surface.points[triangle[2]] - corner));
    }
    return samples;
}

class SymmetryFinder {
public:
    explicit SymmetryFinder(const TriangleSurface& surface)
        : surface_(surface), search_(surface), scan_samples_(surface_samples(surface, k_scan_samples)) {
        const Vec3 extent = bounds_of(surface).extent();
        size_ = 0.5 * extent.norm();
    }

    RotationalSymmetry find() const {
        RotationalSymmetry found = judge(best_principal_axis());
        if (found.contrast >= k_contrast) return found.blade_count == 0 ? found : refined(found);
        // Nearly equal moments of inertia give no axis.
        for (const Candidate& candidate : best_directions()) {
            const RotationalSymmetry symmetry = judge(fitted(candidate.axis, candidate.blades, k_scan_samples));
            if (symmetry.contrast > found.contrast) found = symmetry;
        }
        require_symmetry(found);
        return refined(found);
    }

private:
    static void require_symmetry(const RotationalSymmetry& symmetry) {
        if (symmetry.contrast < k_contrast)
            throw UserError("no axis of rotational symmetry was found", "A cutter head repeats itself 2 to 12 times around its axis",
                            "Check that the file holds the whole head and nothing else");
    }

    /// On more samples; a body with few faces may not determine the fit, which then runs away.
    RotationalSymmetry refined(const RotationalSymmetry& found) const {
        const RotationalSymmetry symmetry = judge(fitted(found.axis, found.blade_count, k_fit_samples));
        require_symmetry(symmetry);
        return symmetry;
    }

    /// RMS distance of the turned samples from the surface, the worst tenth left out.
    double residual(const RotationAxis& axis, double angle, std::size_t samples = k_scan_samples) const {
        std::vector<double> distances;
        distances.reserve(samples);
        const std::size_t stride = scan_samples_.size() / samples;
        for (std::size_t i = 0; i < samples; ++i)
            distances.push_back(search_.nearest(rotate_about(axis, angle, scan_samples_[i * stride])).distance);
        const auto kept = static_cast<std::ptrdiff_t>(k_kept * static_cast<double>(distances.size()));
        std::nth_element(distances.begin(), distances.begin() + kept, distances.end());
        double sum = 0.0;
        for (std::ptrdiff_t i = 0; i < kept; ++i) sum += distances[i] * distances[i];
        return std::sqrt(sum / static_cast<double>(kept));
    }

    double smallest_residual(const RotationAxis& axis) const {
        double smallest = std::numeric_limits<double>::infinity();
        for (int n = 2; n <= k_max_blades; ++n) smallest = std::min(smallest, residual(axis, 2.0 * k_pi / n));
        return smallest;
    }

    RotationAxis best_principal_axis() const {
        const MassProperties mass = mass_properties(surface_);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(mass.inertia);
        RotationAxis best;
        double best_residual = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i) {
            const RotationAxis axis{mass.centroid, principal.eigenvectors().col(i).normalized()};
            const double found = smallest_residual(axis);
            if (found < best_residual) {
                best_residual = found;
                best = axis;
            }
        }
        return best;
    }

    struct Candidate {
        RotationAxis axis;
        int blades = 0;
        double residual = 0.0;
    };

    /// The best few of directions spread over the half sphere, through the centroid (every axis of symmetry passes it).
    std::vector<Candidate> best_directions() const {
        const Vec3 centroid = mass_properties(surface_).centroid;
        std::vector<Candidate> candidates;
        for (std::size_t i = 0; i < k_directions; ++i) {
            const double height = (static_cast<double>(i) + 0.5) / static_cast<double>(k_directions);
            const double azimuth = k_golden_angle * static_cast<double>(i);
            const double radius = std::sqrt(1.0 - height * height);
            const RotationAxis axis{centroid, Vec3(radius * std::cos(azimuth), radius * std::sin(azimuth), height)};
            for (int n = 3; n <= k_max_blades; ++n) candidates.push_back({axis, n, residual(axis, 2.0 * k_pi / n, k_direction_samples)});
        }
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.residual < b.residual; });
        candidates.resize(k_candidates);
        return candidates;
    }

    /// blade_count stays 0 and contrast below k_contrast where there is no symmetry.
    RotationalSymmetry judge(const RotationAxis& axis) const {
        // Angles at which no n-fold body of up to 12 blades repeats, besides those at which it might.
        constexpr int k_angles = 25;
        double worst = 0.0;
        for (int k = 1; k <= k_angles; ++k) worst = std::max(worst, residual(axis, 2.0 * k_pi * k / (k_angles + 1.0)));
        RotationalSymmetry symmetry;
        symmetry.axis = axis;
        symmetry.residual = worst;
        symmetry.contrast = 1.0;
        if (worst < k_revolution * size_) return symmetry;
        symmetry.contrast = 0.0;
        for (int n = 2; n <= k_max_blades; ++n) {
            const double angle = 2.0 * k_pi / n;
            const double found = residual(axis, angle);
            if (1.0 - found / worst < k_contrast) continue;
            // Thick blades still overlap their neighbours at angles nearby; a symmetry is a minimum by itself.
            const double beside = std::min(residual(axis, (1.0 - k_beside) * angle), residual(axis, (1.0 + k_beside) * angle));
            if (found > k_minimum * beside) continue;
            symmetry.blade_count = n;
            symmetry.residual = found;
            symmetry.contrast = 1.0 - found / worst;
        }
        return symmetry;
    }

    /// Least-squares axis for n-fold symmetry. Unknowns of a step: two turns of the direction and two shifts of the origin, normal to it.
    RotationAxis fitted(RotationAxis axis, int n, std::size_t sample_count) const {
        const std::vector<Vec3> samples = surface_samples(surface_, sample_count);
        for (int iteration = 0; iteration < 30; ++iteration) {
            const Eigen::Vector4d step = fit_step(axis, n, samples);
            const Vec3 e0 = axis.direction.unitOrthogonal();
            const Vec3 e1 = axis.direction.cross(e0);
            const Vec3 turn = step[0] * e0 + step[1] * e1;
            axis.direction = (axis.direction + turn.cross(axis.direction)).normalized();
            axis.origin += step[2] * e0 + step[3] * e1;
            if (step.head<2>().norm() * size_ + step.tail<2>().norm() < 1e-9 * size_) break;
        }
        return axis;
    }

    Eigen::Vector4d fit_step(const RotationAxis& axis, int n, const std::vector<Vec3>& samples) const {
        const Vec3 e0 = axis.direction.unitOrthogonal();
        const Vec3 e1 = axis.direction.cross(e0);
        std::vector<double> residuals;
        std::vector<Eigen::Vector4d> rows;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const int multiple = 1 + static_cast<int>(i % static_cast<std::size_t>(n - 1));
            const Eigen::Matrix3d rotation = Eigen::AngleAxisd(2.0 * k_pi * multiple / n, axis.direction).toRotationMatrix();
            const Vec3 arm = samples[i] - axis.origin;
            const Vec3 turned = axis.origin + rotation * arm;
            const NearestPoint nearest = search_.nearest(turned);
            const Vec3 normal = area_vector(surface_, surface_.triangles[nearest.triangle]).normalized();
            residuals.push_back(normal.dot(turned - nearest.point));
            const auto turn_effect = [&](const Vec3& w) { return normal.dot(w.cross(rotation * arm) - rotation * w.cross(arm)); };
            const auto shift_effect = [&](const Vec3& s) { return normal.dot(s - rotation * s); };
            rows.emplace_back(turn_effect(e0), turn_effect(e1), shift_effect(e0), shift_effect(e1));
        }
        return robust_solution(rows, residuals);
    }

    /// Minimises the sum of (row . step + residual)^2 without the residuals above four times their median.
    Eigen::Vector4d robust_solution(const std::vector<Eigen::Vector4d>& rows, const std::vector<double>& residuals) const {
        std::vector<double> sizes;
        for (const double r : residuals) sizes.push_back(std::abs(r));
        const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
        std::nth_element(sizes.begin(), middle, sizes.end());
        const double limit = 4.0 * *middle + 1e-6 * size_;
        Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
        Eigen::Vector4d right = Eigen::Vector4d::Zero();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (std::abs(residuals[i]) > limit) continue;
            matrix += rows[i] * rows[i].transpose();
            right -= residuals[i] * rows[i];
        }
        return matrix.ldlt().solve(right);
    }

    const TriangleSurface& surface_;
    SolidSearch search_;
    std::vector<Vec3> scan_samples_;
    double size_ = 0.0;
};

}  // namespace

RotationalSymmetry find_rotational_symmetry(const TriangleSurface& surface) {
    return SymmetryFinder(surface).find();
}

}  // namespace cutterflow::geometry
