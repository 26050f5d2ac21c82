#pragma once
/// \file The closures of the coupled solver in one table: the source of selection by name, range warnings, the manual and a test.
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "solver/physics/drag.hpp"
#include "solver/physics/lift.hpp"

namespace cutterflow::physics {

enum class ClosureKind { drag, hindrance, lift, added_mass, restitution };

/// Where a closure may be used: bounds (inclusive) of its argument.
struct ClosureRange {
    std::string_view argument;  ///< as RockNumbers names it, or "e_dry", "St"
    double minimum = 0.0;
    double maximum = 0.0;
};

/// The dimensionless numbers of a rock in the flow, by the names that ranges use.
struct RockNumbers {
    double reynolds = 0.0;           ///< "Re", |slip| d / nu
    double particle_reynolds = 0.0;  ///< "Re_p", void fraction times Re
    double shear_reynolds = 0.0;     ///< "Re_G", |vorticity| d^2 / nu
    double void_fraction = 1.0;      ///< "void_fraction"
    double sphericity = 1.0;         ///< "sphericity"
    /// \throws std::out_of_range  for any other name
    double named(std::string_view argument) const;
};

/// A closure is a constant, a function of two dimensionless numbers or a drag law.
using ClosureFunction = std::variant<double, double (*)(double, double), DragLaw>;

struct Closure {
    std::string_view name;  ///< as couplingProperties names it
    ClosureKind kind;
    std::string_view equation;
    ClosureFunction function;  ///< arguments in the order of `ranges`
    std::vector<ClosureRange> ranges;
    std::string_view citation;  ///< key in docs/references.bib

    /// Value at a point with one number per range.
    double evaluate(const std::vector<double>& arguments) const;

    /// The first argument that lies outside its range, or null.
    const ClosureRange* outside(const std::vector<double>& arguments) const;
};

/// Every closure there is.
const std::vector<Closure>& catalogue();

/// \throws std::out_of_range  naming the known ones, when `name` is not a closure of that kind
const Closure& find_closure(ClosureKind kind, std::string_view name);
DragLaw find_drag_law(std::string_view name);
HindranceLaw find_hindrance_law(std::string_view name);  ///< k_no_closure: no_hindrance
LiftLaw find_lift_law(std::string_view name);            ///< k_no_closure: null

/// Names of a kind, in the table's order.
std::vector<std::string> closure_names(ClosureKind kind);

/// The name that switches hindrance or lift off.
inline constexpr std::string_view k_no_closure = "none";

/// Choices of a user: the names of a kind, and k_no_closure where the kind is optional.
std::vector<std::string> closure_choices(ClosureKind kind);

/// Whether a drag law contains the void fraction, so that hindrance must be off. False for an unknown name.
bool drag_law_holds_void_fraction(std::string_view name);

}  // namespace cutterflow::physics
