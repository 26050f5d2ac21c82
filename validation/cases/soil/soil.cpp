/// The soil that a swinging head leaves, against exact booleans and closed forms.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/exact_solid.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/soil/bank.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/reference_table.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::geometry;
using validation::larger;
using validation::Verification;

constexpr double k_degree = k_pi / 180.0;
constexpr double k_exact = 1e-9;

Contour model_head() {
    const auto table = validation::read_reference(validation::case_file("soil/contour.csv"), {{"z", "m"}, {"r", "m"}});
    return {table.at("z"), table.at("r"), 0.4, 0.03};
}

BankParameters model_bank(double inclination_deg, double swing_sign) {
    BankParameters bank;
    bank.inclination = inclination_deg * k_degree;
    bank.swing_sign = swing_sign;
    bank.cut_height = 0.32;
    bank.step = 0.16;
    bank.pick_length = 0.04;
    bank.clearance = 0.008;
    return bank;
}

/// Everything above the level `height` [m] near the head.
TriangleSurface above(double inclination, double height) {
    const double c = std::cos(inclination), s = std::sin(inclination);
    Eigen::Matrix3d directions;
    directions << -s, -c, 0.0, 0.0, 0.0, 1.0, -c, s, 0.0;  // columns: ahead, up, y
    TriangleSurface box;
    for (int i = 0; i < 8; ++i) box.points.emplace_back((i & 1) != 0 ? 3.0 : -3.0, (i & 2) != 0 ? 3.0 : height, (i & 4) != 0 ? 5.0 : -5.0);
    box.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return transformed(box, Eigen::Affine3d(directions));
}

double volume_taken(const Bank& bank, double inclination, double length) {
    ExactSolid taken(bank.sweep(length));
    for (const int steps : {1, 2}) taken.subtract(ExactSolid(bank.earlier_sweep(steps, 4.0)));
    taken.subtract(ExactSolid(above(inclination, bank.top())));
    return volume_of(taken.surface());
}

void compare_volumes(Verification& verification) {
    for (const double inclination : {30.0, 45.0, 60.0})
        for (const auto& [name, swing] : {std::pair("under-cut", 1.0), std::pair("over-cut", -1.0)}) {
            const Bank bank(model_head(), model_bank(inclination, swing));
            const double per_metre = volume_taken(bank, inclination * k_degree, 2.0) - volume_taken(bank, inclination * k_degree, 1.0);
            const std::string where = fmt::format("ladder at {:g} degrees, {}", inclination, name);
            verification.relative("volume per metre of the swing, " + where, "m2", per_metre, bank.cut_section(), k_exact,
                                  {"exact", "reference: the cut section; the rest is rounding", {}});
            double sum = 0.0;
            for (const CutFacePatch& patch : bank.cut_face(0.02).patches) sum += patch.flux_area_m2;
            verification.relative("patches of the cut face, " + where, "m2", sum, bank.cut_section(), k_exact,
                                  {"exact", "reference: the cut section", {}});
        }
}

double farthest(const TriangleSurface& points, const TriangleSurface& surface) {
    const SolidSearch search(surface);
    double distance = 0.0;
    for (const Vec3& point : points.points) distance = larger(distance, search.nearest(point).distance);
    return distance;
}

void compare_swings(Verification& verification) {
    const TriangleSurface over = Bank(model_head(), model_bank(45.0, -1.0)).soil(1.2);
    const TriangleSurface under = Bank(model_head(), model_bank(45.0, 1.0)).soil(1.2);
    const TriangleSurface mirrored = transformed(under, Eigen::Affine3d(Eigen::Scaling(1.0, -1.0, 1.0)));
    verification.relative("volume of soil, over-cut", "m3", volume_of(over), volume_of(mirrored), k_exact,
                          {"exact", "reference: under-cut, mirrored", {}});
    verification.at_most("distance of points of one from the mirrored other", "m",
                         larger(farthest(over, mirrored), farthest(mirrored, over)), k_exact,
                         {"exact", "over-cut and under-cut, ladder at 45 degrees", {}});
}

/// Half a ball of radius 0.4 m below the ring plane, by chords.
Contour half_ball(int chords) {
    std::vector<double> z, r;
    for (int k = 0; k <= chords; ++k) {
        const double angle = 0.5 * k_pi * k / chords;
        z.push_back(k == chords ? 0.0 : -0.4 * std::cos(angle));
        r.push_back(0.4 * std::sin(angle));
    }
    return {z, r, 0.4, 0.03};
}

void compare_crescent(Verification& verification) {
    constexpr double k_radius = 0.4, k_step = 0.1;
    const double lens = 2.0 * k_radius * k_radius * std::acos(0.5 * k_step / k_radius) -
                        0.5 * k_step * std::sqrt(4.0 * k_radius * k_radius - k_step * k_step);
    const double crescent = 0.5 * (k_pi * k_radius * k_radius - lens);
    std::vector<double> errors;
    for (const int segments : {24, 48, 96}) {
        BankParameters parameters;
        parameters.inclination = 90.0 * k_degree;
        parameters.cut_height = k_radius;
        parameters.step = k_step;
        parameters.segments = segments;
        const double section = Bank(half_ball(segments), parameters).cut_section();
        errors.push_back(section / crescent - 1.0);
        verification.relative(fmt::format("cut section of half a ball, {} edges around the axis", segments), "m2", section, crescent,
                              0.001 * std::pow(96.0 / segments, 2), {"exact", "crescent of two circles of 0.4 m, 0.1 m apart", {}});
    }
    verification.absolute("order of that error in the edges", "-", std::log2(errors[1] / errors[2]), 2.0, 0.1,
                          {"exact", "48 and 96 edges", {}});
}

void run(Verification& verification) {
    compare_volumes(verification);
    compare_swings(verification);
    compare_crescent(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return cutterflow::validation::verify(argc, argv, run);
}
