/// Circular Couette flow through a sliding interface that is at rest, turns with the inner wall or against the flow.
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/annulus_case.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_speed = k_pi;   // of the inner wall [rad/s]
constexpr double k_settled = 1.0;  // [s]

struct Mode {
    const char* name;
    double rotor_speed;
};

const Mode k_still{"interface still", 0.0}, k_with{"interface turning with the wall", k_speed},
    k_against{"interface turning against the flow", -k_speed};

AnnulusCase annulus_of(const Mode& mode, int refinement, double end_time) {
    AnnulusCase annulus;
    annulus.radial_cells = 4 * refinement;
    annulus.rotor_cells_around = 8 * refinement;
    annulus.stator_cells_around = 10 * refinement;
    annulus.grading = 0.1;
    annulus.inner_speed = k_speed;
    annulus.rotor_speed = mode.rotor_speed;
    annulus.viscosity = 5e-3;  // the slowest disturbance decays within 0.2 s
    annulus.time_step = 5e-3;
    annulus.end_time = end_time;
    return annulus;
}

/// u = A r + B/r between an inner wall at k_speed and an outer one at rest.
struct Exact {
    double a, b;
    explicit Exact(const AnnulusCase& s) {
        const double inner = s.inner * s.inner, outer = s.outer * s.outer;
        a = -k_speed * inner / (outer - inner);
        b = k_speed * inner * outer / (outer - inner);
    }
    double velocity(double radius) const { return a * radius + b / radius; }
    double torque(const AnnulusCase& s) const { return 4.0 * k_pi * s.density * s.viscosity * b * s.height; }
};

struct Result {
    double velocity_error = 0.0;  ///< L2 over the wall's speed
    double torque = 0.0;          ///< that the inner wall puts on the fluid [N m]
    std::vector<Vec3> velocity;
};

/// Torque of the wall on the fluid as the solver's loads have it, -mu r (du/dr - omega) times the wall's area, du/dr from the wall's speed
/// and the first cells'. The wall is a polygon: its faces' centres lie at inner cos(half a face's angle).
double wall_torque(const AnnulusCase& s, const AnnulusCells& cells, const std::vector<Vec3>& velocity) {
    const int rows = 4 * s.rotor_cells_around;
    const double half = k_pi / rows, radius = s.inner * std::cos(half), area = rows * 2.0 * s.inner * std::sin(half) * s.height;
    double tangential = 0.0;
    for (int j = 0; j < rows; ++j) {
        const std::size_t cell = static_cast<std::size_t>(j) * s.radial_cells;
        const Vec3& x = cells.centre[cell];
        tangential += (x.x() * velocity[cell].y() - x.y() * velocity[cell].x()) / x.norm() / rows;
    }
    const double slope = (tangential - k_speed * radius) / (cells.centre[0].norm() - radius);
    return -s.density * s.viscosity * radius * (slope - k_speed) * area;
}

Result run_couette(const Verification& verification, const Mode& mode, int refinement, int ranks, double end_time,
                   std::optional<cases::ConvectionScheme> study = {}) {
    AnnulusCase annulus = annulus_of(mode, refinement, end_time);
    annulus.study = study;
    const Exact exact(annulus);
    annulus.start = [&](double radius) { return exact.velocity(radius); };
    const auto folder = verification.folder(fmt::format("{}rotor_{:+.0f}_cells_{}_ranks_{}_until_{:g}", study ? "study_" : "",
                                                        mode.rotor_speed, 8 * refinement, ranks, end_time));
    write_annulus_case(folder, annulus);
    run_annulus_case(folder, ranks);
    const AnnulusCells cells = annulus_cells(annulus, annulus.end_time);
    Result result;
    result.velocity = read_vector_field(folder / fmt::format("{:g}/U", end_time), annulus.cell_count());
    double square = 0.0, volume = 0.0;
    for (std::size_t i = 0; i < cells.centre.size(); ++i) {
        const Vec3& x = cells.centre[i];
        const double radius = x.norm();
        square += (result.velocity[i] - exact.velocity(radius) / radius * Vec3(-x.y(), x.x(), 0.0)).squaredNorm() * cells.volume[i];
        volume += cells.volume[i];
    }
    result.velocity_error = std::sqrt(square / volume) / (k_speed * annulus.inner);
    result.torque = wall_torque(annulus, cells, result.velocity);
    return result;
}

void check_mode(Verification& verification, const Mode& mode) {
    const About about{"NieuwboerVanRheeKeetels2023",
                      "8, 16 and 32 cells across the gap, ten times smaller at the walls; order of the last halving. A wall's shear from "
                      "its first cell is of first order in that cell's height: half of it over the radius, 0.2 %",
                      {}};
    Result results[3];
    for (int mesh = 0; mesh < 3; ++mesh) {
        results[mesh] = run_couette(verification, mode, 1 << mesh, 1, k_settled);
        verification.report(fmt::format("{}: L2 error of velocity over the wall's speed, {} cells across", mode.name, 8 << mesh), "-",
                            results[mesh].velocity_error, 0.0, about);
    }
    verification.at_least(fmt::format("{}: order of the velocity's error", mode.name), "-",
                          std::log2(results[1].velocity_error / results[2].velocity_error), 1.8, about);
    verification.at_most(fmt::format("{}: L2 error of velocity over the wall's speed", mode.name), "-", results[2].velocity_error, 0.01,
                         about);
    const AnnulusCase annulus = annulus_of(mode, 4, k_settled);
    verification.relative(fmt::format("{}: torque on the inner wall", mode.name), "N m", results[2].torque, Exact(annulus).torque(annulus),
                          0.005, about);
    const About of_study{"NieuwboerVanRheeKeetels2023", "Euler, one outer corrector, linearUpwindV; 32 cells across the gap", {}};
    const Result shipped = run_couette(verification, mode, 4, 1, k_settled, cases::ConvectionScheme::linear_upwind);
    verification.at_most(fmt::format("{}: L2 error of velocity over the wall's speed, schemes and correctors of a study", mode.name), "-",
                         shipped.velocity_error, 0.01, of_study);
    verification.relative(fmt::format("{}: torque on the inner wall, schemes and correctors of a study", mode.name), "N m", shipped.torque,
                          Exact(annulus).torque(annulus), 0.005, of_study);
}

/// Largest difference of velocity between two runs, over the wall's speed.
double difference(const Result& one, const Result& other) {
    double largest = 0.0;
    for (std::size_t i = 0; i < one.velocity.size(); ++i) largest = larger(largest, (one.velocity[i] - other.velocity[i]).norm());
    return largest / (k_speed * AnnulusCase().inner);
}

void run(Verification& verification) {
    check_mode(verification, k_against);
    check_mode(verification, k_still);
    check_mode(verification, k_with);
    constexpr double early = 0.2;  // [s]
    const Result serial = run_couette(verification, k_against, 2, 1, early);
    for (const int ranks : {2, 4})
        verification.at_most(fmt::format("{}: largest difference of velocity on {} ranks, over the wall's speed", k_against.name, ranks),
                             "-", difference(run_couette(verification, k_against, 2, ranks, early), serial), 1e-8,
                             {"exact", "after 40 steps, 16 cells across; solvers to 1e-11 and 1e-12; ranks share the interface", {}});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
