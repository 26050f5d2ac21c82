#include "geometry/head/revolution_contour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"

namespace cutterflow::geometry {
namespace {

constexpr std::size_t k_slabs = 512;
constexpr int k_first_intervals = 64;
constexpr int k_finest_intervals = 4096;
constexpr int k_probes = 4;  // between two nodes

double radius_of(const Vec3& point) {
    return std::hypot(point.x(), point.y());
}

double distance_to_chord(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d chord = b - a;
    const double t = std::clamp((p - a).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
    return (p - a - t * chord).norm();
}

class ContourFit {
public:
    ContourFit(const RadiusProfile& profile, double z_low, double z_high, double tolerance)
        : profile_(profile), tolerance_(tolerance), finest_(1.5 * (z_high - z_low) / k_finest_intervals) {
        add_node(z_low, profile_.radius_at(z_low));
        for (int i = 0; i < k_first_intervals; ++i) {
            const double upper = i + 1 < k_first_intervals ? z_low + (z_high - z_low) * (i + 1) / k_first_intervals : z_high;
            divide(upper, profile_.radius_at(upper));
        }
    }

    RevolutionContour contour;

private:
    void add_node(double z, double radius) {
        contour.z.push_back(z);
        contour.radius.push_back(radius);
    }

    /// Adds the nodes from the last one up to (z, radius).
    void divide(double z, double radius) {
        const double z_last = contour.z.back();
        const Eigen::Vector2d a(contour.radius.back(), z_last);
        const Eigen::Vector2d b(radius, z);
        double deviation = 0.0;
        for (int k = 1; k <= k_probes; ++k) {
            const double at = z_last + (z - z_last) * k / (k_probes + 1);
            deviation = std::max(deviation, distance_to_chord({profile_.radius_at(at), at}, a, b));
        }
        if (deviation <= tolerance_ || z - z_last < finest_) {
            contour.error = std::max(contour.error, deviation);
            add_node(z, radius);
            return;
        }
        const double middle = 0.5 * (z_last + z);
        divide(middle, profile_.radius_at(middle));
        divide(z, radius);
    }

    const RadiusProfile& profile_;
    double tolerance_;
    double finest_;
};

}  // namespace

RadiusProfile::RadiusProfile(const TriangleSurface& surface) : surface_(surface), slabs_(k_slabs) {
    const Bounds bounds = bounds_of(surface);
    z_min_ = bounds.min.z();
    z_max_ = bounds.max.z();
    const auto slab_of = [this](double z) {
        const double share = (z - z_min_) / (z_max_ - z_min_);
        return std::min(k_slabs - 1, static_cast<std::size_t>(share * k_slabs));
    };
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const Triangle& triangle = surface.triangles[t];
        const auto [low, high] =
            std::minmax({surface.points[triangle[0]].z(), surface.points[triangle[1]].z(), surface.points[triangle[2]].z()});
        for (std::size_t s = slab_of(low); s <= slab_of(high); ++s) slabs_[s].push_back(t);
    }
}

const std::vector<std::size_t>& RadiusProfile::slab(double z) const {
    const double share = (z - z_min_) / (z_max_ - z_min_);
    return slabs_[std::min(k_slabs - 1, static_cast<std::size_t>(share * k_slabs))];
}

// The radius is convex along a line, so that its largest value in the section of a triangle lies on an edge.
double RadiusProfile::radius_at(double z) const {
    if (z < z_min_ || z > z_max_) return 0.0;
    double radius = 0.0;
    for (const std::size_t t : slab(z)) {
        const Triangle& triangle = surface_.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& a = surface_.points[triangle[k]];
            const Vec3& b = surface_.points[triangle[(k + 1) % 3]];
            if (z < std::min(a.z(), b.z()) || z > std::max(a.z(), b.z())) continue;
            const bool level = a.z() == b.z();
            radius =
                std::max(radius, level ? std::max(radius_of(a), radius_of(b)) : radius_of(a + (z - a.z()) / (b.z() - a.z()) * (b - a)));
        }
    }
    return radius;
}

RevolutionContour fit_contour(const RadiusProfile& profile, double z_low, double z_high, double tolerance) {
    return ContourFit(profile, z_low, z_high, tolerance).contour;
}

void write_contour_csv(const RevolutionContour& contour, const std::filesystem::path& file) {
    std::string text = "z_m,r_m\n";
    for (std::size_t i = 0; i < contour.z.size(); ++i) text += fmt::format("{:.7g},{:.7g}\n", contour.z[i], contour.radius[i]);
    write_file(file, text);
}

}  // namespace cutterflow::geometry
