#pragma once
/// \file Cells and steel of simple shapes, for tests and measurements of the mapping.
#include <cmath>
#include <functional>
#include <vector>

#include "geometry/base/axis_frame.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::coupling::testing {

/// One zone that turns about z by as many radians as seconds pass, so that a time is an angle.
inline const std::vector<ZoneMotion>& unit_turn() {
    static const std::vector<ZoneMotion> moving{{RotationAxis{}, 1.0, "rotor"}};
    return moving;
}

/// Owns what Cells and Steel view.
struct SyntheticMesh {
    std::vector<Vec3> centres;
    std::vector<double> volumes, sizes;
    std::vector<std::uint8_t> in_rotor;
    std::vector<std::int64_t> ids;
    std::vector<SteelTriangle> rotor_steel, stator_steel, soil;

    Cells cells() const { return {centres, volumes, sizes, in_rotor, ids}; }
    Steel steel() const { return {{stator_steel, rotor_steel}, soil}; }
    std::size_t size() const { return centres.size(); }

    void add_cell(const Vec3& centre, double volume, double cell_size, bool rotor) {
        centres.push_back(centre);
        volumes.push_back(volume);
        sizes.push_back(cell_size);
        in_rotor.push_back(rotor ? 1 : 0);
        ids.push_back(static_cast<std::int64_t>(ids.size()));
    }

    /// Cubes of edge dx that fill a box; `keep` (may be empty) selects the centres that remain.
    void add_box(const Vec3& lower, const Vec3& upper, double dx, bool rotor, const std::function<bool(const Vec3&)>& keep = {}) {
        const Eigen::Vector3i n = ((upper - lower) / dx).array().round().cast<int>();
        for (int k = 0; k < n[2]; ++k)
            for (int j = 0; j < n[1]; ++j)
                for (int i = 0; i < n[0]; ++i) {
                    const Vec3 centre = lower + dx * Vec3(i + 0.5, j + 0.5, k + 0.5);
                    if (!keep || keep(centre)) add_cell(centre, dx * dx * dx, dx, rotor);
                }
    }

    /// Cells of an annulus about the z axis: exact volumes and centroids.
    void add_annulus(double inner, double outer, int n_radius, int n_azimuth, double lower, double upper, int n_axial, bool rotor) {
        const double dr = (outer - inner) / n_radius, dz = (upper - lower) / n_axial, da = 2.0 * k_pi / n_azimuth;
        for (int k = 0; k < n_axial; ++k)
            for (int i = 0; i < n_radius; ++i) {
                const double r0 = inner + i * dr, r1 = r0 + dr;
                const double volume = 0.5 * da * (r1 * r1 - r0 * r0) * dz;
                const double r = 2.0 / 3.0 * (r1 * r1 * r1 - r0 * r0 * r0) / (r1 * r1 - r0 * r0) * std::sin(0.5 * da) / (0.5 * da);
                for (int j = 0; j < n_azimuth; ++j) {
                    const double a = (j + 0.5) * da;
                    add_cell(Vec3(r * std::cos(a), r * std::sin(a), lower + (k + 0.5) * dz), volume, std::cbrt(volume), rotor);
                }
            }
    }

    /// A parallelogram of steel, cut into n1 x n2 x 2 triangles.
    void add_sheet(const Vec3& corner, const Vec3& edge1, const Vec3& edge2, int n1, int n2, bool rotor) {
        auto& steel = rotor ? rotor_steel : stator_steel;
        const auto at = [&](int i, int j) -> Vec3 {
            return corner + edge1 * (static_cast<double>(i) / n1) + edge2 * (static_cast<double>(j) / n2);
        };
        for (int i = 0; i < n1; ++i)
            for (int j = 0; j < n2; ++j) {
                steel.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                steel.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    }

    /// The sides of a box of soil, without its top and bottom, which lines of sight that are nearly level do not meet.
    void add_sides_of_soil(const Vec3& lower, const Vec3& upper) {
        const Vec3 corners[] = {lower, {upper[0], lower[1], lower[2]}, {upper[0], upper[1], lower[2]}, {lower[0], upper[1], lower[2]}};
        const Vec3 up(0.0, 0.0, upper[2] - lower[2]);
        for (int i = 0; i < 4; ++i) {
            const Vec3 &a = corners[i], &b = corners[(i + 1) % 4];
            soil.push_back({a, b, b + up});
            soil.push_back({a, b + up, a + up});
        }
    }
    void add_box_of_soil(const Vec3& lower, const Vec3& upper) {
        add_sides_of_soil(lower, upper);
        const Vec3 b(upper[0], lower[1], lower[2]), c(lower[0], upper[1], lower[2]), up(0.0, 0.0, upper[2] - lower[2]);
        for (const Vec3& shift : {Vec3(Vec3::Zero()), up}) {
            soil.push_back({lower + shift, b + shift, c + shift});
            soil.push_back({b + shift, upper - up + shift, c + shift});
        }
    }

    /// The cells that `mine` picks, with all of the steel: one rank's share.
    SyntheticMesh part(const std::function<bool(std::size_t)>& mine) const {
        SyntheticMesh share;
        share.rotor_steel = rotor_steel;
        share.stator_steel = stator_steel;
        share.soil = soil;
        for (std::size_t c = 0; c < size(); ++c) {
            if (!mine(c)) continue;
            share.add_cell(centres[c], volumes[c], sizes[c], in_rotor[c] != 0);
            share.ids.back() = ids[c];
        }
        return share;
    }
};

/// A head of six helical blades in a rotor of radius 0.48 m, with a backplate: the size of the draft mesh of the model cutter.
inline SyntheticMesh draft_cutter(double dx) {
    SyntheticMesh mesh;
    const double interface = 0.48;
    const auto radius = [](const Vec3& x) { return std::hypot(x[0], x[1]); };
    mesh.add_box(Vec3(-0.5, -0.5, -0.55), Vec3(0.5, 0.5, 0.02), dx, true, [&](const Vec3& x) { return radius(x) < interface; });
    mesh.add_box(Vec3(-0.7, -0.7, -0.75), Vec3(0.7, 0.7, 0.25), 1.5 * dx, false,
                 [&](const Vec3& x) { return radius(x) >= interface || x[2] < -0.55 || x[2] > 0.02; });
    const auto blade_point = [](int blade, double side, double s, double t) -> Vec3 {
        // s from hub to ring, t from the inner to the outer edge; 70 degrees of wrap, 24 mm thick.
        const double outer = 0.12 + 0.28 * std::sqrt(s), inner = 0.08 + 0.20 * s;
        const double r = inner + t * (outer - inner);
        const double a = blade * k_pi / 3.0 + s * 70.0 * k_pi / 180.0 + side * 0.012 / r;
        return Vec3(r * std::cos(a), r * std::sin(a), -0.44 + 0.44 * s);
    };
    const int ns = 42, nt = 9;
    for (int blade = 0; blade < 6; ++blade)
        for (const double side : {-1.0, 1.0})
            for (int i = 0; i < ns; ++i)
                for (int j = 0; j < nt; ++j) {
                    const auto p = [&](int di, int dj) { return blade_point(blade, side, (i + di) / double(ns), (j + dj) / double(nt)); };
                    mesh.rotor_steel.push_back({p(0, 0), p(1, 0), p(1, 1)});
                    mesh.rotor_steel.push_back({p(0, 0), p(1, 1), p(0, 1)});
                }
    mesh.add_sheet(Vec3(-0.45, -0.45, 0.03), Vec3(0.9, 0, 0), Vec3(0, 0.9, 0), 30, 30, false);
    return mesh;
}

}  // namespace cutterflow::coupling::testing
