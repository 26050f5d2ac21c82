#include "solver/physics/catalogue.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "solver/physics/contact.hpp"

namespace cutterflow::physics {
const std::vector<Closure>& catalogue() {
    static const std::vector<Closure> table{
        {"brown_lawler",
         ClosureKind::drag,
         "Cd = 24/Re (1 + 0.150 Re^0.681) + 0.407/(1 + 8710/Re)",
         brown_lawler_drag_coefficient,
         {{"Re", 1e-3, 2e5}},
         "BrownLawler2003"},
        {"di_felice",
         ClosureKind::hindrance,
         "void_fraction^(1 - beta), beta = 3.7 - 0.65 exp(-(1.5 - log10 Re_p)^2/2)",
         di_felice_factor,
         {{"void_fraction", 0.3, 1.0}, {"Re_p", 1e-2, 2e5}},
         "DiFelice1994"},
        {"sphere", ClosureKind::added_mass, "C_AM = 1/2", k_sphere_added_mass, {}, "NieuwboerVanRheeKeetels2023"},
        {"legendre",
         ClosureKind::restitution,
         "e_wet = e_dry exp(-35/St)",
         wet_restitution,
         {{"e_dry", 0.0, 1.0}, {"St", 0.0, 1e5}},
         "Legendre2006"},
    };
    return table;
}

double Closure::evaluate(const std::vector<double>& arguments) const {
    if (arguments.size() != ranges.size()) throw std::invalid_argument("a closure needs one number per argument");
    struct Call {
        const std::vector<double>& arguments;
        double operator()(double constant) const { return constant; }
        double operator()(double (*function)(double)) const { return function(arguments[0]); }
        double operator()(double (*function)(double, double)) const { return function(arguments[0], arguments[1]); }
    };
    return std::visit(Call{arguments}, function);
}

const ClosureRange* Closure::outside(const std::vector<double>& arguments) const {
    for (std::size_t i = 0; i < ranges.size(); ++i)
        if (!(arguments.at(i) >= ranges[i].minimum && arguments[i] <= ranges[i].maximum)) return &ranges[i];
    return nullptr;
}

const Closure& find_closure(ClosureKind kind, std::string_view name) {
    for (const Closure& closure : catalogue())
        if (closure.kind == kind && closure.name == name) return closure;
    throw std::out_of_range(fmt::format("closure '{}' is not known; known: {}", name, fmt::join(closure_names(kind), ", ")));
}

DragLaw find_drag_law(std::string_view name) {
    return std::get<DragLaw>(find_closure(ClosureKind::drag, name).function);
}

HindranceLaw find_hindrance_law(std::string_view name) {
    return std::get<HindranceLaw>(find_closure(ClosureKind::hindrance, name).function);
}

std::vector<std::string> closure_names(ClosureKind kind) {
    std::vector<std::string> names;
    for (const Closure& closure : catalogue())
        if (closure.kind == kind) names.emplace_back(closure.name);
    return names;
}

}  // namespace cutterflow::physics
