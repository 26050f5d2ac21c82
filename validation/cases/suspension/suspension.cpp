/// A settling uniform suspension carries its rock on the fluid: grad p = (alpha_c rho_c + alpha_p rho_p) g, so the reduced pressure has the
/// gradient alpha_p (rho_p - rho_c) g / rho_c. Detects every wrong sign or doubled term in the force balance.
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/study_numerics.hpp"
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

bool in_middle_half(const BoxCase& box, const Vec3& place) {
    const Vec3 relative = (place - box.lower).cwiseQuotient(box.upper - box.lower);
    return (relative.array() >= 0.25).all() && (relative.array() <= 0.75).all();
}

/// Centres of the cells of the box's middle half, by their index.
std::vector<std::pair<std::size_t, Vec3>> middle_cells(const BoxCase& box) {
    const Vec3 size = (box.upper - box.lower).cwiseQuotient(Vec3(box.cells[0], box.cells[1], box.cells[2]));
    std::vector<std::pair<std::size_t, Vec3>> cells;
    std::size_t cell = 0;
    for (int k = 0; k < box.cells[2]; ++k)
        for (int j = 0; j < box.cells[1]; ++j)
            for (int i = 0; i < box.cells[0]; ++i, ++cell) {
                const Vec3 centre = box.lower + size.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5));
                if (in_middle_half(box, centre)) cells.emplace_back(cell, centre);
            }
    return cells;
}

/// Gradient of p* by least squares over the middle half at the end of the run [m/s2].
Vec3 middle_gradient(const BoxCase& box, const std::filesystem::path& folder) {
    const std::vector<double> pressure = read_scalar_field(folder / fmt::format("{:g}/p", box.end_time), box.cell_count());
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const auto& [cell, centre] : middle_cells(box)) {
        const Eigen::Vector4d row(1.0, centre.x(), centre.y(), centre.z());
        normal += row * row.transpose();
        right += row * pressure[cell];
    }
    return normal.ldlt().solve(right).tail<3>();
}

constexpr double k_spacing = 0.018, k_diameter = 0.010, k_rock_density = 2650.0;  // [m], [m], [kg/m3]

BoxCase suspension(double inclination, double speed) {
    BoxCase box;
    box.lower = Vec3(-0.09, -0.09, 0.0);
    box.upper = Vec3(0.09, 0.09, 0.36);
    box.cells = {18, 18, 36};
    box.gravity = 9.81 * Vec3(std::sin(inclination), 0.0, -std::cos(inclination));
    box.end_time = 0.02;
    box.time_step = box.write_interval = 1e-3;
    box.rocks = lattice(box, k_spacing, k_diameter, speed * box.gravity.normalized());
    return box;
}

/// Means over the box's middle half in the last step [m/s2].
struct Accelerations {
    Vec3 rock = Vec3::Zero(), water = Vec3::Zero();
};

Vec3 acceleration_of_water(const BoxCase& box, const std::filesystem::path& folder) {
    const auto velocity = [&](double time) { return read_vector_field(folder / fmt::format("{:g}/U", time), box.cell_count()); };
    const std::vector<Vec3> last = velocity(box.end_time), before = velocity(box.end_time - box.time_step);
    const auto cells = middle_cells(box);
    Vec3 sum = Vec3::Zero();
    for (const auto& [cell, centre] : cells) sum += (last[cell] - before[cell]) / box.time_step;
    return sum / static_cast<double>(cells.size());
}

Vec3 acceleration_of_rock(const BoxCase& box, const std::filesystem::path& folder) {
    const std::vector<RockSnapshot> snapshots = all_rocks(folder);
    const RockSnapshot &last = snapshots.back(), &before = snapshots.at(snapshots.size() - 2);
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (std::size_t p = 0; p < last.position.size(); ++p) {
        if (!in_middle_half(box, last.position[p])) continue;
        sum += (last.velocity[p] - before.velocity[p]) / (last.time - before.time);
        ++count;
    }
    return sum / count;
}

/// Gradient of p* that the sum of both balances of momentum asks for [m/s2].
Vec3 carrying_gradient(const BoxCase& box, const Accelerations& acceleration) {
    const double solid_fraction = k_pi / 6.0 * std::pow(k_diameter / k_spacing, 3);
    const double rock_density = k_rock_density / box.density;
    return solid_fraction * ((rock_density - 1.0) * box.gravity - rock_density * acceleration.rock) -
           (1.0 - solid_fraction) * acceleration.water;
}

void compare(Verification& verification, const std::string& against, double inclination_deg, const Vec3& gradient, const Vec3& expected,
             double tolerance, const About& about) {
    const std::string where = fmt::format("{} at {:.0f} degrees", against, inclination_deg);
    verification.relative("what the rock adds to dp/dz over the fluid's density, against " + where, "m/s2",
                          gradient.dot(expected.normalized()), expected.norm(), tolerance, about);
    verification.at_most("error of the pressure gradient's vector over the rock's part, against " + where, "-",
                         (gradient - expected).norm() / expected.norm(), tolerance, about);
}

/// \param as_study  with the schemes and linear solvers of a study in place of those of a plain box
void settle(Verification& verification, double inclination_deg, bool as_study) {
    const double inclination = inclination_deg * k_pi / 180.0;
    const auto run = [&](const BoxCase& box, double speed) {
        const auto folder =
            verification.folder(fmt::format("{}inclination_{:.0f}_at_{:g}_m_s", as_study ? "study_" : "", inclination_deg, speed));
        write_box_case(folder, box);
        if (as_study) use_study_numerics(folder);
        run_cutter_foam(folder);
        return folder;
    };
    const std::string numerics = as_study ? ", numerics of a study," : "";
    const std::string room = "10 mm rock of 2650 kg/m3 on a lattice of 18 mm, released at ";

    const BoxCase early = suspension(inclination, 0.6);
    const auto early_folder = run(early, 0.6);
    compare(verification, "the forces that act" + numerics, inclination_deg, middle_gradient(early, early_folder),
            carrying_gradient(early, {acceleration_of_rock(early, early_folder), acceleration_of_water(early, early_folder)}), 0.003,
            {"exact", room + "0.6 m/s; with the accelerations of rock and water in the last step; at 0.02 s", {}});

    const BoxCase late = suspension(inclination, 0.62);
    compare(verification, "the rock's weight" + numerics, inclination_deg, middle_gradient(late, run(late, 0.62)),
            carrying_gradient(late, {}), 0.01, {"exact", room + "0.62 m/s; alpha_p (rho_p - rho_c) g over rho_c; at 0.02 s", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, [](Verification& verification) {
        for (const double inclination_deg : {0.0, 30.0}) settle(verification, inclination_deg, false);
        settle(verification, 30.0, true);
    });
}
