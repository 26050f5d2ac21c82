#pragma once
/// \file The closures of the coupled solver in one table, from which selection by name, range warnings, the manual and a test are made.
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "solver/physics/drag.hpp"

namespace cutterflow::physics {

enum class ClosureKind { drag, hindrance, added_mass, restitution };

/// Where a closure may be used: bounds (inclusive) of its argument.
struct ClosureRange {
    std::string_view argument;  ///< "Re", "void_fraction", ...
    double minimum = 0.0;
    double maximum = 0.0;
};

/// A closure is a constant or a function of one or two dimensionless numbers.
using ClosureFunction = std::variant<double, double (*)(double), double (*)(double, double)>;

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
HindranceLaw find_hindrance_law(std::string_view name);

/// Names of a kind, in the table's order.
std::vector<std::string> closure_names(ClosureKind kind);

}  // namespace cutterflow::physics
