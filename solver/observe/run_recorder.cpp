#include "solver/observe/run_recorder.hpp"

namespace cutterflow::coupling {

const char* fate_name(Fate fate) {
    constexpr const char* names[] = {"never_entered", "in_cutter", "spilled", "sucked_up"};
    return names[static_cast<std::size_t>(fate)];
}

const char* surface_name(EventSurface surface) {
    constexpr const char* names[] = {"feed", "head", "mouth", "domain"};
    return names[static_cast<std::size_t>(surface)];
}

const char* direction_name(EventDirection direction) {
    return direction == EventDirection::in ? "in" : "out";
}

double FateTotals::undecided() const {
    if (placed.count == 0) return 1.0;
    return 1.0 - (of(Fate::sucked_up).mass + of(Fate::spilled).mass) / placed.mass;
}

}  // namespace cutterflow::coupling
