/// Solid-body rotation through a sliding interface over 20 turns: nothing is made or lost.
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/harness/continuity_log.hpp"
#include "validation/harness/scenes/annulus_case.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_speed = 2.0 * k_pi;  // [rad/s]
constexpr int k_turns = 20;
constexpr double k_study_step = 1.0 / 256.0;        ///< [s], longer than one of a study with rock at this speed; its sums are exact
constexpr double k_development_step = 1.0 / 120.0;  ///< [s], that of a study while its flow develops: three degrees

struct Outcome {
    Continuity continuity;
    double velocity_error = 0.0;  ///< L2 over the L2 norm
};

AnnulusCase room(int stator_cells_around, int turns) {
    AnnulusCase annulus;
    annulus.radial_cells = 10;
    annulus.rotor_cells_around = 24;
    annulus.stator_cells_around = stator_cells_around;
    annulus.inner_speed = annulus.outer_speed = annulus.rotor_speed = k_speed;
    annulus.viscosity = 1e-3;
    annulus.time_step = 1.0 / 160.0;
    annulus.end_time = turns;
    annulus.start = [](double radius) { return k_speed * radius; };
    return annulus;
}

Outcome turn(const Verification& verification, const std::string& name, const AnnulusCase& annulus) {
    const auto folder = verification.folder(name);
    write_annulus_case(folder, annulus);
    run_annulus_case(folder);

    const AnnulusCells cells = annulus_cells(annulus, annulus.end_time);
    const std::vector<Vec3> velocity = read_vector_field(folder / fmt::format("{:g}/U", annulus.end_time), annulus.cell_count());
    double square = 0.0, reference = 0.0;
    for (std::size_t i = 0; i < velocity.size(); ++i) {
        const Vec3 exact = k_speed * Vec3(-cells.centre[i].y(), cells.centre[i].x(), 0.0);
        square += (velocity[i] - exact).squaredNorm() * cells.volume[i];
        reference += exact.squaredNorm() * cells.volume[i];
    }
    return {read_continuity(folder / "log.cutterFoam"), std::sqrt(square / reference)};
}

void check_continuity(Verification& verification, const Continuity& continuity, const std::string& with, const About& about) {
    verification.at_most("volume made or lost, over the room's" + with, "-", std::abs(continuity.cumulative), 1e-6, about);
    verification.at_most("largest sum over cells of |volume made or lost| in a step, over the room's" + with, "-", continuity.largest_local,
                         1e-6, about);
}

/// With the schemes, solvers, correctors, viscosity and step of a study at 60 rpm.
Outcome turn_in_study(const Verification& verification, cases::ConvectionScheme convection, double time_step, int turns) {
    AnnulusCase annulus = room(24, turns);
    annulus.study = convection;
    annulus.viscosity = 1e-6;
    annulus.time_step = time_step;
    const char* const scheme = convection == cases::ConvectionScheme::upwind ? "upwind" : "linear_upwind";
    return turn(verification, fmt::format("study_{}_step_{:g}_turns_{}", scheme, time_step, turns), annulus);
}

void check_study_settings(Verification& verification) {
    const About about{"exact",
                      "Euler, one outer corrector, water; 96 faces around; steps of 3.9 ms; a study with rock takes at most 2.8 ms at 60 "
                      "rpm, 8.3 ms while its flow develops",
                      {}};
    const std::string error = "L2 error of velocity over its L2 norm, settings of a study with and without rock";
    using cases::ConvectionScheme;
    const Outcome two = turn_in_study(verification, ConvectionScheme::linear_upwind, k_study_step, 2);
    verification.at_most(error + ", 2 turns", "-", two.velocity_error, 0.01, about);
    const Outcome twenty = turn_in_study(verification, ConvectionScheme::linear_upwind, k_study_step, k_turns);
    verification.at_most(error + ", 20 turns", "-", twenty.velocity_error, 0.03, about);
    check_continuity(verification, twenty.continuity, ", 20 turns, settings of a study", about);
    const Outcome longer = turn_in_study(verification, ConvectionScheme::linear_upwind, 6.25e-3, 2);
    verification.at_most(error + ", 2 turns, step of 6.25 ms", "-", longer.velocity_error, 0.01, about);
    const Outcome developing = turn_in_study(verification, ConvectionScheme::linear_upwind, k_development_step, 2);
    verification.at_most(error + ", 2 turns, step of 8.3 ms", "-", developing.velocity_error, 0.01, about);
    check_continuity(verification, developing.continuity, ", 2 turns, step of 8.3 ms", about);
    const Outcome upwind = turn_in_study(verification, ConvectionScheme::upwind, k_study_step, 2);
    verification.report("L2 error of velocity over its L2 norm, settings of a study but upwind, 2 turns", "-", upwind.velocity_error, {},
                        {"exact", "what first order would cost; studies with rock had it up to version 0.2.0", {}});
}

void run(Verification& verification) {
    const About about{
        "exact",
        "second order in space and time, two outer correctors; 96 faces around on both sides of the interface, 160 steps a turn",
        {}};
    const Outcome equal = turn(verification, "second_order", room(24, k_turns));
    check_continuity(verification, equal.continuity, ", 20 turns", about);
    verification.at_most("L2 error of velocity after 20 turns, over its L2 norm", "-", equal.velocity_error, 0.01, about);
    const Outcome unequal = turn(verification, "unequal", room(30, 5));
    verification.report("volume made or lost in 5 turns, over the room's, 120 faces on 96", "-", std::abs(unequal.continuity.cumulative),
                        {}, {"exact", "polygons of unequal number; the product's meshes have equal numbers", {}});
    check_study_settings(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
