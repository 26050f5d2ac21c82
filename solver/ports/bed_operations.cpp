#include "solver/ports/bed_operations.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace cutterflow::coupling {
namespace {

constexpr const char* k_correct = "Correct the value";

void check(Mistakes&, const std::string&, const EverywhereRegion&) {}
void check(Mistakes& mistakes, const std::string& key, const BoxRegion& box) {
    mistakes.require((box.lower.array() < box.upper.array()).all(), key + ".region: a box without room",
                     "Corner lower must lie below corner upper", "Correct the corners");
}
void check(Mistakes& mistakes, const std::string& key, const SphereRegion& sphere) {
    mistakes.positive(key + ".region.radius", sphere.radius);
}
void check(Mistakes& mistakes, const std::string& key, const CylinderRegion& cylinder) {
    mistakes.positive(key + ".region.radius", cylinder.radius);
    mistakes.require((cylinder.to - cylinder.from).norm() > 0.0, key + ".region: a cylinder without length", "Its ends must differ",
                     "Correct from and to");
}
void check(Mistakes& mistakes, const std::string& key, const HalfSpaceRegion& half) {
    mistakes.require(half.normal.norm() > 0.0, key + ".region.normal = 0", "It is a direction", "Use (0 0 1) for what lies above point");
}

void check_operation(Mistakes& mistakes, const std::string& key, const OperationSettings& operation) {
    std::visit([&](const auto& region) { check(mistakes, key, region); }, operation.region);
    mistakes.not_negative(key + (operation.kind == OperationKind::extract ? ".from" : ".at"), operation.begin);
    if (operation.kind != OperationKind::extract) return;
    mistakes.positive(key + ".rate", operation.rate);
    mistakes.require(operation.end > operation.begin, key + ".to", operation.end, "It must be later than from", k_correct);
}

/// Directions in which a rectangle is flat.
int flat_directions(const BoxRegion& rectangle) {
    return static_cast<int>((rectangle.lower.array() == rectangle.upper.array()).count());
}

void check_gate(Mistakes& mistakes, const GateSettings& gate) {
    const std::string key = "gates." + gate.name;
    mistakes.require(!gate.name.empty(), "gates: a gate without a name", "Crossings are told by it", "Add: name outlet;");
    mistakes.require(gate.normal.norm() > 0.0, key + ".normal = 0", "It is the direction that counts as +1", "Use (0 0 1)");
    if (!gate.rectangle) return mistakes.positive(key + ".radius", gate.radius);
    const bool ordered = (gate.rectangle->lower.array() <= gate.rectangle->upper.array()).all();
    mistakes.require(ordered && flat_directions(*gate.rectangle) == 1, key + ".lower and .upper: no rectangle",
                     "They agree in one direction, in the others lower lies below upper", "Correct the corners");
}

}  // namespace

const char* name_of(OperationKind kind) {
    return k_operation_names[static_cast<std::size_t>(kind)];
}

void check_bed_operations(Mistakes& mistakes, const std::vector<OperationSettings>& operations, const std::vector<GateSettings>& gates,
                          const std::optional<AtRestSettings>& at_rest, const std::optional<IdleSettings>& idle,
                          const std::optional<BelowSettings>& below) {
    for (std::size_t k = 0; k < operations.size(); ++k)
        check_operation(mistakes, fmt::format("events[{}] ({})", k, name_of(operations[k].kind)), operations[k]);
    std::set<std::string> names;
    for (const GateSettings& gate : gates) {
        check_gate(mistakes, gate);
        if (!names.insert(gate.name).second)
            mistakes.add(fmt::format("gates.{} is defined twice", gate.name), "Crossings are told by the gate's name",
                         "Rename one of them");
    }
    if (at_rest) {
        mistakes.positive("stop.atRest.energy", at_rest->energy);
        mistakes.positive("stop.atRest.speed", at_rest->speed);
        mistakes.not_negative("stop.atRest.hold", at_rest->hold);
        mistakes.not_negative("stop.atRest.from", at_rest->from);
    }
    const auto require_gate = [&](const char* key, const std::string& gate) {
        mistakes.require(names.count(gate) > 0, fmt::format("{} = {}", key, gate), "It must be one of gates", k_correct);
    };
    if (idle) {
        mistakes.positive("stop.idle.duration", idle->duration);
        require_gate("stop.idle.gate", idle->gate);
    }
    if (below) {
        mistakes.positive("stop.below.rate", below->rate);
        mistakes.positive("stop.below.window", below->window);
        require_gate("stop.below.gate", below->gate);
    }
}

}  // namespace cutterflow::coupling
