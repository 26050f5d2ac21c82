/// Closures against tables made with another program in 40 digits.
#include <cmath>

#include <fmt/format.h>

#include "solver/physics/catalogue.hpp"
#include "solver/physics/drag.hpp"
#include "solver/physics/lift.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/reference_table.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_tolerance = 1e-6;

/// Keeps the largest relative error of a law over its table.
class Worst {
public:
    void take(double value, double reference) { error_ = larger(error_, std::abs(value / reference - 1.0)); }
    double error() const { return error_; }

private:
    double error_ = 0.0;
};

void check_drag(Verification& verification) {
    const std::vector<std::string> laws = physics::closure_names(physics::ClosureKind::drag);
    std::vector<ReferenceColumn> columns{{"Re", "-"}, {"void fraction", "-"}, {"sphericity", "-"}};
    for (const std::string& name : laws) columns.push_back({name, "-"});
    const ReferenceTable table = read_reference(case_file("closures/drag.csv"), columns);
    for (const std::string& name : laws) {
        const physics::Closure& closure = physics::find_closure(physics::ClosureKind::drag, name);
        const physics::DragLaw law = physics::find_drag_law(name);
        Worst coefficient;
        for (std::size_t i = 0; i < table.rows(); ++i) {
            const double reynolds = table.at("Re")[i], reference = table.at(name)[i];
            coefficient.take(law({reynolds, table.at("void fraction")[i], table.at("sphericity")[i]}), reference);
        }
        verification.at_most(fmt::format("{}: largest relative error of the drag coefficient", name), "-", coefficient.error(), k_tolerance,
                             {std::string(closure.citation),
                              "11 states, Re 0.01 to 2e5, void fraction 0.45 to 0.99, sphericity 0.6 to 1; in the form of model B",
                              {}});
    }
}

void check_hindrance(Verification& verification) {
    const ReferenceTable table =
        read_reference(case_file("closures/hindrance.csv"), {{"Re_p", "-"}, {"void fraction", "-"}, {"factor", "-"}});
    Worst worst;
    for (std::size_t i = 0; i < table.rows(); ++i)
        worst.take(physics::find_hindrance_law("di_felice")(table.at("void fraction")[i], table.at("Re_p")[i]), table.at("factor")[i]);
    verification.at_most("di_felice: largest relative error of the factor", "-", worst.error(), k_tolerance,
                         {table.source, "exponent 1 - beta: model B; 7 states, void fraction 0.3 to 0.98", {}});
}

void check_lift(Verification& verification) {
    const ReferenceTable table =
        read_reference(case_file("closures/lift.csv"), {{"Re_p", "-"}, {"Re_G", "-"}, {"J", "-"}, {"lift coefficient", "-"}});
    Worst ratio, coefficient;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const double re_p = table.at("Re_p")[i], re_g = table.at("Re_G")[i];
        ratio.take(physics::shear_lift_ratio(std::sqrt(re_g) / re_p), table.at("J")[i]);
        coefficient.take(physics::mei_lift_coefficient(re_p, re_g), table.at("lift coefficient")[i]);
    }
    verification.at_most("mei: largest relative error of J", "-", ratio.error(), k_tolerance, {table.source, "eps 0.05 to 70", {}});
    verification.at_most("mei: largest relative error of the lift coefficient", "-", coefficient.error(), k_tolerance,
                         {table.source, "", {}});
    verification.relative("mei: J(1)", "-", physics::shear_lift_ratio(1.0), 0.722, 1e-3,
                          {table.source, "the figure of the literature", {}});
    verification.relative("mei: J(5)", "-", physics::shear_lift_ratio(5.0), 0.989, 1e-3,
                          {table.source, "the figure of the literature", {}});
    // Slip along x at 0.1 m/s, vorticity along z: the force is along x cross z = -y. 2 mm in a fluid of nu 1e-4: Re_p = 2, Re_G = 0.4.
    const physics::RockInFluid rock{0.002, 1000.0, 1e-4, 1.0, 1.0};
    const double expected = 0.39269908169872414 * physics::mei_lift_coefficient(2.0, 0.4) * 1000.0 * 4e-6 * 0.01;
    const Vec3 force = physics::lift_force(rock, Vec3(0.1, 0.0, 0.0), Vec3(0.0, 0.0, 10.0), physics::mei_lift_coefficient);
    verification.relative("mei: force along slip cross vorticity", "N", -force.y(), expected, k_tolerance,
                          {table.source, "pi/8 C_L rho d^2 w^2", {}});
}

void check_fluid_forces(Verification& verification) {
    const double volume = 4.1887902047863905e-6, density = 998.2;  // 20 mm
    const Vec3 acceleration(0.3, -2.0, 1.5), stress(0.02, 0.05, -0.01);
    const About about{"NieuwboerVanRheeKeetels2023", "rho V (1 + C_AM) Du/Dt with C_AM = 1/2 and 0, 20 mm in water", {}};
    verification.relative("added mass and pressure gradient, along y", "N",
                          physics::fluid_acceleration_force(volume, density, 0.5, acceleration).y(), -0.012543751147253325, k_tolerance,
                          about);
    verification.relative("pressure gradient alone, along x", "N",
                          physics::fluid_acceleration_force(volume, density, 0.0, acceleration).x(), 0.0012543751147253325, k_tolerance,
                          about);
    verification.relative("viscous force, along y", "N", physics::viscous_force(volume, density, stress).y(), 0.00020906251912088876,
                          k_tolerance, {"NieuwboerVanRheeKeetels2023", "rho V div tau", {}});
}

void run(Verification& verification) {
    check_drag(verification);
    check_hindrance(verification);
    check_lift(verification);
    check_fluid_forces(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
