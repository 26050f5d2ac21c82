#include "solver/observe/run_recorder.hpp"

#include <cmath>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::coupling {

const char* fate_name(Fate fate) {
    constexpr const char* names[] = {"never_entered", "in_cutter", "spilled", "sucked_up"};
    return names[static_cast<std::size_t>(fate)];
}

const char* surface_name(EventSurface surface) {
    constexpr const char* names[] = {"feed", "head", "mouth", "domain", "start", "remove", "extract"};
    return names[static_cast<std::size_t>(surface)];
}

const char* direction_name(EventDirection direction) {
    return direction == EventDirection::in ? "in" : "out";
}

RockEvent rock_event(EventSurface surface, EventDirection direction, const Rocks& rocks, std::size_t p, const RunInstant& now) {
    const Vec3& position = rocks.position[p];
    const double azimuth = to_cylindrical(RotationAxis{}, Vec3::UnitX(), position).azimuth;
    return {now.time,        rocks.id[p], surface,     direction,         position,         rocks.velocity[p],
            now.rotor_angle, azimuth,     position[2], rocks.diameter[p], rocks.density[p], ""};
}

double RockLedger::error() const {
    const double known = owed + in_head + delivered + spilled_mixing + spilled_cutting + on_bed + left_behind_mixing + left_behind_cutting;
    return known == fed ? 0.0 : std::abs(fed - known) / fed;
}

double FateTotals::undecided() const {
    if (placed.count == 0) return 1.0;
    return 1.0 - (of(Fate::sucked_up).mass + of(Fate::spilled).mass) / placed.mass;
}

}  // namespace cutterflow::coupling
