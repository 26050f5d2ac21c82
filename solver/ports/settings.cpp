#include "solver/ports/settings.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "geometry/base/csv_table.hpp"
#include "geometry/base/mistakes.hpp"
#include "solver/physics/catalogue.hpp"

namespace cutterflow::coupling {
namespace {

std::vector<Mistake> fluid_mistakes(const FluidProperties& fluid) {
    Mistakes mistakes("constant/transportProperties");
    mistakes.positive("rho", fluid.density);
    mistakes.positive("nu", fluid.kinematic_viscosity);
    return mistakes.take();
}

void check_hindrance(Mistakes& mistakes, const ClosureSettings& closures) {
    if (physics::drag_law_holds_void_fraction(closures.drag) && closures.hindrance != physics::k_no_closure)
        mistakes.add(fmt::format("closures.drag = {} with closures.hindrance = {}", closures.drag, closures.hindrance),
                     "This drag law contains the void fraction: hindrance would count it twice", "Set: hindrance none;");
}

void check_map(Mistakes& mistakes, const KernelSettings& kernel) {
    if (kernel.map == k_cluster_map && kernel.cluster_size == 0.0)
        mistakes.add("kernel.clusterSize is missing", "Map cluster lays rock over cubes of this side", "Give it in m, a cell or more");
    if (kernel.map != k_cluster_map && kernel.cluster_size > 0.0)
        mistakes.add(fmt::format("kernel.clusterSize = {:g} with kernel.map = {}", kernel.cluster_size, kernel.map),
                     "Only map cluster has cubes", "Remove it, or set: map cluster;");
}

void check_fates(Mistakes& mistakes, const FateSettings& fates) {
    if (fates.contour.empty())
        mistakes.add("fates.contour is missing", "The head's volume is its contour of revolution", "Name a CSV file z_m,r_m");
    mistakes.positive("fates.ringRadius", fates.ring_radius);
    mistakes.require(fates.z_backplate >= 0.0, "fates.zBackplate", fates.z_backplate,
                     "The backplate must not lie below the ring plane z = 0", "Correct the value");
    mistakes.require(fates.hysteresis >= 0.0, "fates.hysteresis", fates.hysteresis, "It must not be negative", "Use 0.25");
    mistakes.positive("fates.binWidth", fates.bin_width);
    mistakes.positive("fates.mouth.radius", fates.mouth.radius);
    mistakes.require(fates.mouth.depth >= 0.0, "fates.mouth.depth", fates.mouth.depth, "It must not be negative",
                     "Use the mouth's diameter");
    if (fates.cutting) {
        mistakes.positive("fates.cutting.distance", fates.cutting->distance);
        mistakes.positive("fates.cutting.distanceBehind", fates.cutting->distance_behind);
        mistakes.require(std::abs(fates.cutting->behind.norm() - 1.0) < 1e-6, "fates.cutting.behind: length", fates.cutting->behind.norm(),
                         "It is a unit vector against the swing", "Use (0 -1 0) for a swing along +y");
    }
    mistakes.require(fates.mouth.direction.norm() > 0.0, "fates.mouth.direction: length", fates.mouth.direction.norm(),
                     "It is a direction into the pipe", "Use (0 0 1)");
}

void check_velocity(Mistakes& mistakes, const VelocitySettings& velocity) {
    mistakes.require(velocity.interval > 0.0 && velocity.interval <= 30.0, "velocity.interval", velocity.interval,
                     "It is an angle in degrees, above 0 and at most 30", "Use 3");
    mistakes.require(velocity.blades >= 1, "velocity.blades", velocity.blades, "It must be 1 or more", "Correct the value");
    std::set<std::string> names;
    for (const VelocitySetSettings& set : velocity.sets) {
        const std::string key = "velocity.sets." + set.name;
        const bool plain = !set.name.empty() && std::all_of(set.name.begin(), set.name.end(),
                                                            [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
        if (!plain)
            mistakes.add(fmt::format("velocity.sets: the name '{}'", set.name), "Results are named after it",
                         "Use letters, digits, - and _");
        if (!names.insert(set.name).second)
            mistakes.add(key + " is defined twice", "Results are named after the set", "Rename one of them");
        mistakes.require(set.phases >= 0 && set.phases <= 360, key + ".phases", set.phases, "It must lie between 0 and 360", "Use 12");
    }
}

void check_record(Mistakes& mistakes, const RecordSettings& record, bool has_rock, const std::string& where) {
    if (!has_rock)
        mistakes.add("section record without section rock", "A recording holds Du/Dt, which is computed with rock alone",
                     "Add rock that comes in after record.endTime, or remove record");
    mistakes.add(setting_mistakes(record, "record", where));
    mistakes.require(record.end_time > record.start_time, "record.endTime", record.end_time, "It must be later than record.startTime",
                     "Record a turn of the rotor or more");
}

/// What a recording does not hold cannot be asked of a replay.
void check_replay(Mistakes& mistakes, const CouplingSettings& settings) {
    const auto refuse = [&](bool wrong, const std::string& what) {
        if (wrong)
            mistakes.add(what + " with section replay", "A recording holds velocity and its material derivative in cells", "Remove it");
    };
    if (!settings.has_rock) mistakes.add("section replay without section rock", "Only rock moves in a recorded flow", "Add rock");
    refuse(settings.soil.has_value(), "section soil");
    refuse(settings.outflow.has_value(), "section outflow");
    refuse(settings.velocity.has_value(), "section velocity");
    refuse(settings.checkpoint.has_value(), "section checkpoint");
    refuse(settings.record.has_value(), "section record");
    refuse(settings.closures.lift != physics::k_no_closure, "closures.lift = " + settings.closures.lift);
    refuse(!settings.closures.viscous_force, "closures.viscousForce no");
}

/// Nothing flows where there is no medium.
void check_without_medium(Mistakes& mistakes, const CouplingSettings& settings) {
    const auto refuse = [&](bool wrong, const std::string& what) {
        if (wrong) mistakes.add(what + " with medium none", "Without a medium nothing flows", "Remove it, or the line: medium none;");
    };
    if (!settings.has_rock) mistakes.add("medium none without section rock", "Without a medium only rock moves", "Add rock");
    refuse(settings.fates.has_value(), "section fates");
    refuse(settings.outflow.has_value(), "section outflow");
    refuse(settings.velocity.has_value(), "section velocity");
    refuse(settings.record.has_value(), "section record");
    refuse(!settings.replay.empty(), "section replay");
    refuse(settings.soil.has_value(), "section soil");
    refuse(!settings.patches.outlet.empty() || !settings.patches.steel.empty(), "section patches");
}

void check_without_rock(Mistakes& mistakes, const CouplingSettings& settings) {
    const auto refuse = [&](bool wrong, const char* what) {
        if (wrong) mistakes.add(fmt::format("{} without section rock", what), "It is about rock", "Remove it or add rock");
    };
    refuse(!settings.operations.empty(), "section events");
    refuse(!settings.gates.empty(), "section gates");
    refuse(settings.at_rest.has_value(), "stop.atRest");
    refuse(settings.idle.has_value(), "stop.idle");
    refuse(settings.below.has_value(), "stop.below");
}

}  // namespace

std::vector<Mistake> check_settings(const CouplingSettings& settings, const FluidProperties& fluid, const std::string& where) {
    Mistakes mistakes(where);
    if (settings.has_medium)
        mistakes.add(fluid_mistakes(fluid));
    else
        check_without_medium(mistakes, settings);
    if (settings.has_rock) {
        if (settings.has_medium) {
            visit_coupling_sections(settings,
                                    [&](const char* key, const auto& section) { mistakes.add(setting_mistakes(section, key, where)); });
            check_map(mistakes, settings.kernel);
            check_hindrance(mistakes, settings.closures);
        }
        mistakes.add(setting_mistakes(settings.queue, "rock.queue", where));
        mistakes.add(setting_mistakes(settings.calming, "rock.calming", where));
        if (settings.calming && settings.has_medium)
            mistakes.add("rock.calming with a medium", "It is for a bed that comes to rest without one; in a medium drag slows rock down",
                         "Remove the section, or write medium none;");
        if (settings.rock_feed.empty() && settings.rock_start.empty())
            mistakes.add("rock.feed is missing", "Rock enters through a feed file, or is there from the start on (rock.start)",
                         "Name a CSV file");
    }
    if (settings.largest_speed) mistakes.positive("largestSpeed", *settings.largest_speed);
    mistakes.add(setting_mistakes(settings.soil, "soil", where));
    if (settings.fates)
        check_fates(mistakes, *settings.fates);
    else if (settings.outflow)
        mistakes.add("section outflow without section fates", "Outflow is sampled along the contour of fates",
                     "Add fates or remove outflow");
    mistakes.add(setting_mistakes(settings.outflow, "outflow", where));
    if (settings.velocity) check_velocity(mistakes, *settings.velocity);
    mistakes.add(setting_mistakes(settings.stop, "stop", where));
    if (settings.stop && !settings.has_rock)
        mistakes.add("section stop without section rock", "Only rock is undecided", "Remove it or add rock");
    if (settings.stop && settings.has_rock && !settings.fates)
        mistakes.add("section stop without section fates", "Rock is undecided until it has a fate", "Add fates or remove stop");
    check_bed_operations(mistakes, settings.operations, settings.gates, settings.at_rest, settings.idle, settings.below);
    if (!settings.has_rock) check_without_rock(mistakes, settings);
    if (!settings.operations.empty() && settings.fates)
        mistakes.add("section events with section fates", "Fates follow all rock of a cutter head", "Remove one of them");
    mistakes.add(setting_mistakes(settings.checkpoint, "checkpoint", where));
    if (settings.record) check_record(mistakes, *settings.record, settings.has_rock, where);
    if (!settings.replay.empty()) check_replay(mistakes, settings);
    return mistakes.take();
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
