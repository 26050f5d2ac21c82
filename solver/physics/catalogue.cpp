#include "solver/physics/catalogue.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "solver/physics/contact.hpp"

namespace cutterflow::physics {
namespace {

bool is_reynolds_number(ClosureArgument argument) {
    return argument == ClosureArgument::reynolds || argument == ClosureArgument::particle_reynolds ||
           argument == ClosureArgument::shear_reynolds;
}

double& member_of(DragState& state, ClosureArgument argument) {
    switch (argument) {
        case ClosureArgument::reynolds:
            return state.reynolds;
        case ClosureArgument::void_fraction:
            return state.void_fraction;
        case ClosureArgument::sphericity:
            return state.sphericity;
        case ClosureArgument::particle_reynolds:
        case ClosureArgument::shear_reynolds:
        case ClosureArgument::dry_restitution:
        case ClosureArgument::stokes:
            break;
    }
    throw std::logic_error(fmt::format("a drag law does not take {}", argument_symbol(argument)));
}

std::vector<Closure> other_closures() {
    using A = ClosureArgument;
    return {
        {"di_felice",
         ClosureKind::hindrance,
         "void_fraction^(1 - beta), beta = 3.7 - 0.65 exp(-(1.5 - log10 Re_p)^2/2)",
         di_felice_factor,
         {{A::void_fraction, 0.3, 1.0}, {A::particle_reynolds, 1e-2, 2e5}},
         "DiFelice1994"},
        {"mei",
         ClosureKind::lift,
         "C_L = 4.11 eps J(eps), eps = sqrt(Re_G)/Re_p",
         mei_lift_coefficient,
         {{A::particle_reynolds, 1e-2, 1.0}, {A::shear_reynolds, 1e-4, 1.0}},
         "Mei1992"},
        {"sphere", ClosureKind::added_mass, "C_AM = 1/2", k_sphere_added_mass, {}, "NieuwboerVanRheeKeetels2023"},
        {"legendre",
         ClosureKind::restitution,
         "e_wet = e_dry exp(-35/St)",
         wet_restitution,
         {{A::dry_restitution, 0.0, 1.0}, {A::stokes, 0.0, 1e5}},
         "Legendre2006"},
    };
}

}  // namespace

const std::vector<Closure>& catalogue() {
    static const std::vector<Closure> table = [] {
        std::vector<Closure> closures = drag_laws();
        const std::vector<Closure> others = other_closures();
        closures.insert(closures.end(), others.begin(), others.end());
        return closures;
    }();
    return table;
}

std::string_view argument_symbol(ClosureArgument argument) {
    switch (argument) {
        case ClosureArgument::reynolds:
            return "Re";
        case ClosureArgument::particle_reynolds:
            return "Re_p";
        case ClosureArgument::shear_reynolds:
            return "Re_G";
        case ClosureArgument::void_fraction:
            return "void_fraction";
        case ClosureArgument::sphericity:
            return "sphericity";
        case ClosureArgument::dry_restitution:
            return "e_dry";
        case ClosureArgument::stokes:
            return "St";
    }
    throw std::logic_error("unknown ClosureArgument");
}

bool ClosureRange::excludes(double value) const {
    return !(value <= maximum && (value >= minimum || is_reynolds_number(argument)));
}

double RockNumbers::value_of(ClosureArgument argument) const {
    switch (argument) {
        case ClosureArgument::reynolds:
            return reynolds;
        case ClosureArgument::particle_reynolds:
            return particle_reynolds;
        case ClosureArgument::shear_reynolds:
            return shear_reynolds;
        case ClosureArgument::void_fraction:
            return void_fraction;
        case ClosureArgument::sphericity:
            return sphericity;
        case ClosureArgument::dry_restitution:
        case ClosureArgument::stokes:
            break;
    }
    throw std::logic_error(fmt::format("a rock in the flow has no {}", argument_symbol(argument)));
}

double Closure::evaluate(const std::vector<double>& arguments) const {
    if (arguments.size() != ranges.size()) throw std::invalid_argument("a closure needs one number per argument");
    struct Call {
        const Closure& closure;
        const std::vector<double>& arguments;
        double operator()(double constant) const { return constant; }
        double operator()(double (*function)(double, double)) const { return function(arguments[0], arguments[1]); }
        double operator()(DragLaw drag) const {
            DragState state;
            for (std::size_t i = 0; i < arguments.size(); ++i) member_of(state, closure.ranges[i].argument) = arguments[i];
            return drag(state);
        }
    };
    return std::visit(Call{*this, arguments}, function);
}

bool Closure::depends_on(ClosureArgument argument) const {
    return std::any_of(ranges.begin(), ranges.end(), [&](const ClosureRange& range) { return range.argument == argument; });
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
    if (name == k_no_closure) return no_hindrance;
    return std::get<HindranceLaw>(find_closure(ClosureKind::hindrance, name).function);
}

LiftLaw find_lift_law(std::string_view name) {
    if (name == k_no_closure) return nullptr;
    return std::get<LiftLaw>(find_closure(ClosureKind::lift, name).function);
}

std::vector<std::string> closure_names(ClosureKind kind) {
    std::vector<std::string> names;
    for (const Closure& closure : catalogue())
        if (closure.kind == kind) names.emplace_back(closure.name);
    return names;
}

std::vector<std::string> closure_choices(ClosureKind kind) {
    std::vector<std::string> choices = closure_names(kind);
    if (kind == ClosureKind::hindrance || kind == ClosureKind::lift) choices.emplace_back(k_no_closure);
    return choices;
}

bool drag_law_holds_void_fraction(std::string_view name) {
    for (const Closure& closure : catalogue())
        if (closure.kind == ClosureKind::drag && closure.name == name) return closure.depends_on(ClosureArgument::void_fraction);
    return false;
}

}  // namespace cutterflow::physics
