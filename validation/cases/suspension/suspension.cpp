/// A settling uniform suspension carries its rock on the fluid: grad p = (alpha_c rho_c + alpha_p rho_p) g, so the reduced pressure has the
/// gradient alpha_p (rho_p - rho_c) g / rho_c. Detects every wrong sign or doubled term in the force balance.
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

/// Rock of diameter d on a simple cubic lattice of the given spacing that fills the box, all with one velocity.
std::vector<BoxRock> lattice(const BoxCase& box, double spacing, double diameter, const Vec3& velocity) {
    std::vector<BoxRock> rocks;
    const Eigen::Vector3i count = ((box.upper - box.lower) / spacing).array().round().cast<int>();
    for (int k = 0; k < count.z(); ++k)
        for (int j = 0; j < count.y(); ++j)
            for (int i = 0; i < count.x(); ++i) {
                BoxRock rock;
                rock.id = static_cast<int>(rocks.size()) + 1;
                rock.position = box.lower + spacing * Vec3(i + 0.5, j + 0.5, k + 0.5);
                rock.diameter = diameter;
                rock.velocity = velocity;
                rocks.push_back(rock);
            }
    return rocks;
}

/// Gradient of p* by least squares over the cells of the box's middle half.
Vec3 middle_gradient(const BoxCase& box, const std::vector<double>& pressure) {
    const Vec3 size = (box.upper - box.lower).cwiseQuotient(Vec3(box.cells[0], box.cells[1], box.cells[2]));
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    std::size_t cell = 0;
    for (int k = 0; k < box.cells[2]; ++k)
        for (int j = 0; j < box.cells[1]; ++j)
            for (int i = 0; i < box.cells[0]; ++i, ++cell) {
                const Vec3 centre = box.lower + size.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5));
                const Vec3 relative = (centre - box.lower).cwiseQuotient(box.upper - box.lower);
                if ((relative.array() < 0.25).any() || (relative.array() > 0.75).any()) continue;
                const Eigen::Vector4d row(1.0, centre.x(), centre.y(), centre.z());
                normal += row * row.transpose();
                right += row * pressure[cell];
            }
    return normal.ldlt().solve(right).tail<3>();
}

void settle(Verification& verification, double inclination_deg) {
    const double inclination = inclination_deg * k_pi / 180.0;
    BoxCase box;
    box.lower = Vec3(-0.09, -0.09, 0.0);
    box.upper = Vec3(0.09, 0.09, 0.36);
    box.cells = {18, 18, 36};
    box.gravity = 9.81 * Vec3(std::sin(inclination), 0.0, -std::cos(inclination));
    box.end_time = 0.02;
    box.time_step = 1e-3;
    const double spacing = 0.018;
    const double diameter = 0.010;
    // Near the settling speed from the start, and read early: what piles up on the floor, and with inclined
    // gravity the clear water along one side, must not yet be felt in the middle.
    box.rocks = lattice(box, spacing, diameter, 0.6 * box.gravity.normalized());
    const auto folder = verification.folder(fmt::format("inclination_{:.0f}", inclination_deg));
    write_box_case(folder, box);
    run_cutter_foam(folder);

    const double solid_fraction = k_pi / 6.0 * std::pow(diameter / spacing, 3);
    const double rock_density = 2650.0;
    const Vec3 expected = solid_fraction * (rock_density - box.density) / box.density * box.gravity;
    const Vec3 gradient = middle_gradient(box, read_scalar_field(folder / "0.02/p", box.cell_count()));
    const double mixture = 9.81 * (1.0 + solid_fraction * (rock_density - box.density) / box.density);
    // Full pressure over density: what the water weighs by itself comes on top.
    const Vec3 down = box.gravity.normalized();
    const About about{"exact", "dp/dz = (alpha_c rho_c + alpha_p rho_p) g: 10 mm rock of 2650 kg/m3 on a lattice of 18 mm", 0.001};
    verification.relative(fmt::format("dp/dz over the fluid's density at {:.0f} degrees", inclination_deg), "m/s2",
                          9.81 + gradient.dot(down), mixture, 0.01, about);
    verification.at_most(
        fmt::format("error of the pressure gradient's vector over the mixture's weight at {:.0f} degrees", inclination_deg), "-",
        (gradient - expected).norm() / mixture, 0.01, about);
    verification.report(fmt::format("what the rock adds to dp/dz over the fluid's density at {:.0f} degrees", inclination_deg), "m/s2",
                        gradient.dot(down), expected.norm(), about);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, [](Verification& verification) {
        for (const double inclination_deg : {0.0, 30.0}) settle(verification, inclination_deg);
    });
}
