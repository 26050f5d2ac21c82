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

/// A dimensionless number on which a closure depends.
enum class ClosureArgument {
    reynolds,           ///< Re = |slip| d / nu
    particle_reynolds,  ///< Re_p = void fraction times Re
    shear_reynolds,     ///< Re_G = |vorticity| d^2 / nu
    void_fraction,
    sphericity,
    dry_restitution,  ///< e_dry
    stokes            ///< St of an impact, physics::impact_stokes
};

/// Symbol of an argument: "Re", "Re_p", "void_fraction" ...
std::string_view argument_symbol(ClosureArgument argument);

/// Where a closure holds: bounds (inclusive) of one argument.
struct ClosureRange {
    ClosureArgument argument;
    double minimum = 0.0;
    double maximum = 0.0;

    /// Whether the closure's value is wrong at `value`: it is above the range, below it, or no number. Below its range a Reynolds number is
    /// harmless: all closures tend to the limit of creeping flow there.
    bool excludes(double value) const;
};

/// The dimensionless numbers of a rock in the flow.
struct RockNumbers {
    double reynolds = 0.0;
    double particle_reynolds = 0.0;
    double shear_reynolds = 0.0;
    double void_fraction = 1.0;
    double sphericity = 1.0;
    /// \throws std::logic_error  for a number that a rock in the flow does not have (one of an impact)
    double value_of(ClosureArgument argument) const;
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

    /// Value at a point with one number per range. \throws std::logic_error  when a range's argument is none that the function takes
    double evaluate(const std::vector<double>& arguments) const;

    bool depends_on(ClosureArgument argument) const;
};

/// The rows of drag_laws.cpp.
std::vector<Closure> drag_laws();

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
