/// \file Every drag law: its function and its row of the catalogue.
#include <cmath>

#include "solver/physics/catalogue.hpp"

namespace cutterflow::physics {
namespace {

/// Drag coefficient of a single sphere [-]:  Cd = 24/Re (1 + 0.150 Re^0.681) + 0.407 / (1 + 8710/Re). Valid for Re <= 2e5.
/// [BrownLawler2003]
double brown_lawler(const DragState& state) {
    const double re = state.reynolds;
    return 24.0 / re * (1.0 + 0.150 * std::pow(re, 0.681)) + 0.407 / (1.0 + 8710.0 / re);
}

/// Drag coefficient of a single sphere [-]:  Cd = 24/Re (1 + 0.15 Re^0.687) below Re = 1000, 0.44 from there on (it jumps up by 0.4 %
/// there). [SchillerNaumann1935]
double schiller_naumann(const DragState& state) {
    const double re = state.reynolds;
    return re < 1000.0 ? 24.0 / re * (1.0 + 0.15 * std::pow(re, 0.687)) : 0.44;
}

/// Drag coefficient of a single rock of sphericity psi [-], with diameter and frontal area of the sphere of equal volume:
///   Cd = 24/Re (1 + A Re^B) + C / (1 + D/Re),  A = 8.1716 e^(-4.0655 psi), B = 0.0964 + 0.5565 psi, C = 73.69 e^(-5.0748 psi),
///   D = 5.378 e^(6.2122 psi). [HaiderLevenspiel1989]
double haider_levenspiel(const DragState& state) {
    const double re = state.reynolds, psi = state.sphericity;
    const double a = 8.1716 * std::exp(-4.0655 * psi), b = 0.0964 + 0.5565 * psi;
    const double c = 73.69 * std::exp(-5.0748 * psi), d = 5.378 * std::exp(6.2122 * psi);
    return 24.0 / re * (1.0 + a * std::pow(re, b)) + c / (1.0 + d / re);
}

/// Gidaspow's law, which contains the void fraction a, as a drag coefficient of one rock [-] in the sense of drag_coefficient_per_slip
/// (with hindrance 1). The published momentum exchange coefficient belongs to the form in which the fluid feels a grad p (model A); with
/// the full pressure gradient and buoyancy in pure fluid (model B, the solver's form) the force on rock is that over a:
///   a <= 0.8, Ergun:   Cd = 4/3 (150 (1 - a) / (a^2 Re) + 1.75/a)
///   a >  0.8, Wen-Yu:  Cd = Cd0(a Re) a^(-2.65), Cd0 of Schiller and Naumann
/// The two differ where they meet: by 15 % in creeping flow, by a factor 3.7 at high Re. [Gidaspow1994]
double gidaspow(const DragState& state) {
    const double re = state.reynolds, a = state.void_fraction;
    if (a <= 0.8) return 4.0 / 3.0 * (150.0 * (1.0 - a) / (a * a * re) + 1.75 / a);
    return schiller_naumann({a * re}) * std::pow(a, -2.65);
}

/// Koch's and Hill's law, as gidaspow in the form for the full pressure gradient; with the solid fraction s = 1 - a:
///   Cd = 24/Re a (F0 + F3 a Re / 2),  F3 = 0.0673 + 0.212 s + 0.0232/a^5,
///   F0 = [1 + 3 sqrt(s/2) + 135/64 s ln s + 16.14 s] / [1 + 0.681 s - 8.48 s^2 + 8.16 s^3] for s < 0.4, 10 s/a^3 from there on.
/// [KochHill2001]
double koch_hill(const DragState& state) {
    const double re = state.reynolds, a = state.void_fraction, s = 1.0 - a;
    const double s_log_s = s > 0.0 ? s * std::log(s) : 0.0;
    const double dilute =
        (1.0 + 3.0 * std::sqrt(0.5 * s) + 135.0 / 64.0 * s_log_s + 16.14 * s) / (1.0 + 0.681 * s - 8.48 * s * s + 8.16 * s * s * s);
    const double f0 = s < 0.4 ? dilute : 10.0 * s / std::pow(a, 3);
    const double f3 = 0.0673 + 0.212 * s + 0.0232 / std::pow(a, 5);
    return 24.0 / re * a * (f0 + 0.5 * f3 * a * re);
}

}  // namespace

std::vector<Closure> drag_laws() {
    using A = ClosureArgument;
    return {
        {"brown_lawler",
         ClosureKind::drag,
         "Cd = 24/Re (1 + 0.150 Re^0.681) + 0.407/(1 + 8710/Re)",
         brown_lawler,
         {{A::reynolds, 1e-3, 2e5}},
         "BrownLawler2003"},
        {"schiller_naumann",
         ClosureKind::drag,
         "Cd = 24/Re (1 + 0.15 Re^0.687), 0.44 from Re = 1000 on",
         schiller_naumann,
         {{A::reynolds, 1e-3, 2e5}},
         "SchillerNaumann1935"},
        {"haider_levenspiel",
         ClosureKind::drag,
         "Cd = 24/Re (1 + A Re^B) + C/(1 + D/Re), A = 8.1716 e^(-4.0655 psi), B = 0.0964 + 0.5565 psi, C = 73.69 e^(-5.0748 psi), "
         "D = 5.378 e^(6.2122 psi)",
         haider_levenspiel,
         {{A::reynolds, 1e-3, 2.5e4}, {A::sphericity, 0.6, 1.0}},
         "HaiderLevenspiel1989"},
        {"gidaspow",
         ClosureKind::drag,
         "Cd = 4/3 (150 (1 - a)/(a^2 Re) + 1.75/a) up to a = 0.8, Cd0(a Re) a^-2.65 above, Cd0 of Schiller and Naumann",
         gidaspow,
         {{A::reynolds, 1e-3, 2e5}, {A::void_fraction, 0.3, 1.0}},
         "Gidaspow1994"},
        {"koch_hill",
         ClosureKind::drag,
         "Cd = 24/Re a (F0 + F3 a Re/2), F3 = 0.0673 + 0.212 s + 0.0232/a^5, s = 1 - a, F0 = [1 + 3 sqrt(s/2) + 135/64 s ln s + 16.14 s]/"
         "[1 + 0.681 s - 8.48 s^2 + 8.16 s^3], 10 s/a^3 from s = 0.4 on",
         koch_hill,
         {{A::reynolds, 1e-3, 150.0}, {A::void_fraction, 0.35, 1.0}},
         "KochHill2001"},
    };
}

}  // namespace cutterflow::physics
