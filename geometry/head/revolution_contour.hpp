#pragma once
/// \file The contour of revolution of a surface: its largest radius about the z axis, against z.
#include <filesystem>
#include <vector>

#include "geometry/head/contour.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::geometry {

/// Largest radius of a surface about the z axis at any height, exact for its triangles.
class RadiusProfile {
public:
    explicit RadiusProfile(const TriangleSurface& surface);

    double z_min() const { return z_min_; }
    double z_max() const { return z_max_; }

    /// Largest radius [m] of the surface's points at height z [m]; 0 where there are none.
    double radius_at(double z) const;

private:
    const std::vector<std::size_t>& slab(double z) const;

    TriangleSurface surface_;
    double z_min_ = 0.0;
    double z_max_ = 0.0;
    std::vector<std::vector<std::size_t>> slabs_;  // triangles by height
};

/// Outer radius by nodes, piecewise linear between them.
struct RevolutionContour {
    std::vector<double> z;       ///< [m], increasing
    std::vector<double> radius;  ///< [m]
    double error = 0.0;          ///< largest distance [m], in the meridional plane, of the profile's points between nodes from the line
};

/// Nodes from z_low to z_high [m], denser where the profile bends, down to 1/4096 of the height at steps.
/// \param tolerance  target error [m]; steps of the profile may exceed it, `error` is the actual one
RevolutionContour fit_contour(const RadiusProfile& profile, double z_low, double z_high, double tolerance);

/// CSV with the header `z_m,r_m`. \throws UserError  when the file cannot be written
void write_contour_csv(const RevolutionContour& contour, const std::filesystem::path& file);

}  // namespace cutterflow::geometry
