#include "geometry/io/length_unit.hpp"

#include <array>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/error.hpp"

namespace cutterflow::geometry {
namespace {

struct UnitRow {
    LengthUnit unit;
    const char* name;
    double metres;
};

constexpr std::array<UnitRow, 5> k_units{{{LengthUnit::metre, "m", 1.0},
                                          {LengthUnit::millimetre, "mm", 1e-3},
                                          {LengthUnit::centimetre, "cm", 1e-2},
                                          {LengthUnit::inch, "inch", 0.0254},
                                          {LengthUnit::foot, "ft", 0.3048}}};

const UnitRow& row_of(LengthUnit unit) {
    return k_units.at(static_cast<std::size_t>(unit));
}

bool is_plausible(double half_extent, LengthUnit unit) {
    const double metres = half_extent * metres_per(unit);
    return metres >= k_smallest_head_radius && metres <= k_largest_head_radius;
}

std::string remedy_for(double half_extent) {
    std::vector<std::string> options;
    for (const UnitRow& row : k_units)
        if (is_plausible(half_extent, row.unit)) options.push_back(fmt::format("--unit {}", row.name));
    if (options.empty()) return "Check that the file holds one cutter head and nothing else; no known unit makes its size plausible";
    return fmt::format("Say in which unit the file is: {} (in a study cutter.unit)", fmt::join(options, " or "));
}

/// The other units in which the size would be plausible, in words.
std::string alternatives_to(LengthUnit taken, double half_extent) {
    std::vector<std::string> others;
    for (const UnitRow& row : k_units)
        if (row.unit != taken && is_plausible(half_extent, row.unit))
            others.push_back(fmt::format("{:.4g} m with --unit {}", half_extent * row.metres, row.name));
    return others.empty() ? "" : fmt::format(" ({})", fmt::join(others, ", "));
}

}  // namespace

double metres_per(LengthUnit unit) {
    return row_of(unit).metres;
}

const char* name_of(LengthUnit unit) {
    return row_of(unit).name;
}

LengthUnit length_unit_of(const std::string& name) {
    std::vector<std::string> names;
    for (const UnitRow& row : k_units) {
        if (name == row.name) return row.unit;
        names.emplace_back(row.name);
    }
    throw UserError(fmt::format("unknown unit \"{}\"", name), fmt::format("Known units are {}", fmt::join(names, ", ")),
                    "Take one of them");
}

UnitDecision decide_unit(double half_extent, std::optional<LengthUnit> given) {
    const std::string rule =
        fmt::format("A cutter head's half extent lies between {} and {} m", k_smallest_head_radius, k_largest_head_radius);
    if (given) {
        const double metres = half_extent * metres_per(*given);
        if (!is_plausible(half_extent, *given))
            throw UserError(
                fmt::format("half the surface's largest extent is {:.4g} m when the file is taken in {}", metres, name_of(*given)), rule,
                remedy_for(half_extent));
        return {*given, false, metres, fmt::format("unit {} as given: half the largest extent is {:.4g} m", name_of(*given), metres)};
    }
    for (const LengthUnit unit : {LengthUnit::metre, LengthUnit::millimetre, LengthUnit::inch}) {
        if (!is_plausible(half_extent, unit)) continue;
        const double metres = half_extent * metres_per(unit);
        return {unit, true, metres,
                fmt::format("unit {} told from the size: half the largest extent is {:.4g} m{}", name_of(unit), metres,
                            alternatives_to(unit, half_extent))};
    }
    throw UserError(
        fmt::format("half the surface's largest extent is {:.4g} in the file's unit, which fits none of m, mm and inch", half_extent), rule,
        remedy_for(half_extent));
}

}  // namespace cutterflow::geometry
