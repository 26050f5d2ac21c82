#include "solver/ports/settings.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/csv_table.hpp"
#include "solver/physics/catalogue.hpp"

namespace cutterflow::coupling {
namespace {

using physics::ClosureKind;

/// Collects mistakes about one file's keys.
class Checker {
public:
    explicit Checker(std::string where) : where_(std::move(where)) {}

    void require(bool holds, const std::string& key, double value, const std::string& rule, const std::string& remedy) {
        if (!holds) mistakes_.push_back({where_, fmt::format("{} = {}", key, value), rule, remedy});
    }
    void require_positive(const std::string& key, double value) {
        require(value > 0.0, key, value, "It must be above 0", "Correct the value");
    }
    void require_closure(ClosureKind kind, const std::string& key, const std::string& name) {
        const std::vector<std::string> known = physics::closure_choices(kind);
        if (std::find(known.begin(), known.end(), name) == known.end())
            mistakes_.push_back({where_, fmt::format("{} = {} is not known", key, name),
                                 fmt::format("Known are {}", fmt::join(known, ", ")), "Choose one of them"});
    }
    void add(const std::string& what, const std::string& rule, const std::string& remedy) {
        mistakes_.push_back({where_, what, rule, remedy});
    }
    std::vector<Mistake> take() { return std::move(mistakes_); }

private:
    std::string where_;
    std::vector<Mistake> mistakes_;
};

void check_fluid(Checker& check, const FluidProperties& fluid) {
    check.require_positive("rho (of transportProperties)", fluid.density);
    check.require_positive("nu (of transportProperties)", fluid.kinematic_viscosity);
}

void check_kernel(Checker& check, const KernelSettings& kernel) {
    check.require(kernel.gamma >= 0.5, "kernel.gamma", kernel.gamma, "The kernel must be at least half a rock wide", "Use 1.0");
    check.require(kernel.min_width_in_cells >= 1.0, "kernel.minWidthInCells", kernel.min_width_in_cells,
                  "A kernel narrower than a cell is noise", "Use 1.5");
    check.require(kernel.max_solid_fraction > 0.0 && kernel.max_solid_fraction <= 0.9, "kernel.maxSolidFraction", kernel.max_solid_fraction,
                  "It must be above 0 and at most 0.9", "Use 0.7");
}

void check_closures(Checker& check, const ClosureSettings& closures) {
    check.require_closure(ClosureKind::drag, "closures.drag", closures.drag);
    check.require_closure(ClosureKind::hindrance, "closures.hindrance", closures.hindrance);
    check.require(closures.added_mass >= 0.0, "closures.addedMass", closures.added_mass, "It must not be negative", "Use 0.5, a sphere's");
    check.require_positive("closures.dragModifier", closures.drag_modifier);
    check.require(closures.sphericity > 0.0 && closures.sphericity <= 1.0, "closures.sphericity", closures.sphericity,
                  "It is above 0 and at most 1, a sphere's", "Correct the value");
    check.require_closure(ClosureKind::lift, "closures.lift", closures.lift);
    if (physics::drag_law_holds_void_fraction(closures.drag) && closures.hindrance != physics::k_no_closure)
        check.add(fmt::format("closures.drag = {} with closures.hindrance = {}", closures.drag, closures.hindrance),
                  "This drag law contains the void fraction: hindrance would count it twice", "Set: hindrance none;");
}

void check_fates(Checker& check, const FateSettings& fates) {
    if (fates.contour.empty())
        check.add("fates.contour is missing", "The head's volume is its contour of revolution", "Name a CSV file z_m,r_m");
    check.require_positive("fates.ringRadius", fates.ring_radius);
    check.require(fates.z_backplate >= 0.0, "fates.zBackplate", fates.z_backplate, "The backplate must not lie below the ring plane z = 0",
                  "Correct the value");
    check.require(fates.hysteresis >= 0.0, "fates.hysteresis", fates.hysteresis, "It must not be negative", "Use 0.25");
    check.require_positive("fates.binWidth", fates.bin_width);
    check.require_positive("fates.mouth.radius", fates.mouth.radius);
    check.require(fates.mouth.depth >= 0.0, "fates.mouth.depth", fates.mouth.depth, "It must not be negative", "Use the mouth's diameter");
    check.require(fates.mouth.direction.norm() > 0.0, "fates.mouth.direction: length", fates.mouth.direction.norm(),
                  "It is a direction into the pipe", "Use (0 0 1)");
}

void check_velocity(Checker& check, const VelocitySettings& velocity) {
    check.require(velocity.interval > 0.0 && velocity.interval <= 30.0, "velocity.interval", velocity.interval,
                  "It is an angle in degrees, above 0 and at most 30", "Use 3");
    check.require(velocity.blades >= 1, "velocity.blades", velocity.blades, "It must be 1 or more", "Correct the value");
    std::set<std::string> names;
    for (const VelocitySetSettings& set : velocity.sets) {
        const std::string key = "velocity.sets." + set.name;
        const bool plain = !set.name.empty() && std::all_of(set.name.begin(), set.name.end(),
                                                            [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
        if (!plain)
            check.add(fmt::format("velocity.sets: the name '{}'", set.name), "Results are named after it", "Use letters, digits, - and _");
        if (!names.insert(set.name).second) check.add(key + " is defined twice", "Results are named after the set", "Rename one of them");
        check.require(set.phases >= 0 && set.phases <= 360, key + ".phases", set.phases, "It must lie between 0 and 360", "Use 12");
    }
}

}  // namespace

std::vector<Mistake> check_settings(const CouplingSettings& settings, const FluidProperties& fluid, const std::string& where) {
    Checker check(where);
    check_fluid(check, fluid);
    if (settings.has_rock) {
        check_kernel(check, settings.kernel);
        check_closures(check, settings.closures);
        if (settings.rock_feed.empty()) check.add("rock.feed is missing", "Rock enters through a feed file", "Name a CSV file");
    }
    if (settings.fates)
        check_fates(check, *settings.fates);
    else if (settings.outflow)
        check.add("section outflow without section fates", "Outflow is sampled along the contour of fates", "Add fates or remove outflow");
    if (settings.outflow) {
        check.require(settings.outflow->offset >= 0.0, "outflow.offset", settings.outflow->offset, "It must not be negative",
                      "Use 0.015 for a ring radius of 0.4 m");
    }
    if (settings.velocity) check_velocity(check, *settings.velocity);
    if (settings.stop)
        check.require(settings.stop->undecided >= 0.0 && settings.stop->undecided < 1.0, "stop.undecided", settings.stop->undecided,
                      "It is a share of the placed mass, from 0 to below 1", "Use 0.05");
    if (settings.stop && !settings.has_rock)
        check.add("section stop without section rock", "Only rock is undecided", "Remove it or add rock");
    if (settings.stop && settings.has_rock && !settings.fates)
        check.add("section stop without section fates", "Rock is undecided until it has a fate", "Add fates or remove stop");
    if (settings.checkpoint) {
        check.require_positive("checkpoint.interval", settings.checkpoint->interval);
        check.require(settings.checkpoint->keep >= 1, "checkpoint.keep", settings.checkpoint->keep, "At least the newest one stays",
                      "Use 2");
    }
    return check.take();
}

geometry::Contour read_contour(const FateSettings& fates) {
    std::vector<Mistake> mistakes;
    const CsvTable table(fates.contour, {"z_m", "r_m"}, {}, mistakes);
    if (!mistakes.empty()) throw UserError(mistakes);
    std::vector<double> z, radius;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        z.push_back(table.at(row, "z_m"));
        radius.push_back(table.at(row, "r_m"));
    }
    try {
        return geometry::Contour(std::move(z), std::move(radius), fates.ring_radius, fates.z_backplate);
    } catch (const std::invalid_argument& error) {
        throw UserError(
            {{fates.contour.string(), error.what(), "Lines go from the lowest point of the head up to its ring", "Correct the file"}});
    }
}

}  // namespace cutterflow::coupling
