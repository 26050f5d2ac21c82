#pragma once
/// \file What is done to rock in a region at a time, gates that count it, and rules by which a run of rock ends.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/mistakes.hpp"
#include "geometry/base/region.hpp"
#include "geometry/base/vec3.hpp"

namespace cutterflow::coupling {

enum class OperationKind { remove, freeze, thaw, extract };
inline constexpr std::array<const char*, 4> k_operation_names{"remove", "freeze", "thaw", "extract"};  ///< in the order of OperationKind
const char* name_of(OperationKind kind);

/// What is done to the rock whose centre lies in a region. At a time rock is removed, held (freeze) or let go (thaw); over a time it is
/// extracted: whole rocks, the first that came into the run first, so that their mass follows rate times time and never exceeds it. Held
/// rock is not extracted.
struct OperationSettings {
    OperationKind kind = OperationKind::remove;
    double begin = 0.0;  ///< the time, or the first time [s]
    double end = 0.0;    ///< the last time, of an extraction [s]
    double rate = 0.0;   ///< of an extraction [kg/s]
    Region region;
};

/// A disc, or a rectangle along the axes, whose crossings by centres of rock are counted.
struct GateSettings {
    std::string name;
    Vec3 centre = Vec3::Zero();          ///< of a disc [m]
    double radius = 0.0;                 ///< of a disc [m]
    std::optional<BoxRegion> rectangle;  ///< in place of the disc; flat in one direction
    Vec3 normal = Vec3::UnitZ();         ///< a crossing along it counts as +1
};

/// Rock is at rest when the mean of v^2/(2 g d) over all rocks that are not held is at most `energy`, and the largest v/sqrt(g d) at most
/// `speed`, for a time. Spin does not count: a rock that spins about the normal of its contact stays where it is, and no torque stops it.
struct AtRestSettings {
    double energy = 1e-6;  ///< [-]
    double speed = 0.01;   ///< [-]
    double hold = 0.05;    ///< [s]
    double from = 0.0;     ///< not before, as while a flow still grows [s]
};

/// Nothing crossed a gate for a time.
struct IdleSettings {
    std::string gate;
    double duration = 0.0;  ///< [s]
};

/// Less mass than `rate` a second crossed a gate on balance, in the mean over the last `window`.
struct BelowSettings {
    std::string gate;
    double rate = 0.0;    ///< [kg/s]
    double window = 0.0;  ///< [s]
};

/// Mistakes of all of these. \param gates  idle and below name one of them
void check_bed_operations(Mistakes& mistakes, const std::vector<OperationSettings>& operations, const std::vector<GateSettings>& gates,
                          const std::optional<AtRestSettings>& at_rest, const std::optional<IdleSettings>& idle,
                          const std::optional<BelowSettings>& below);

}  // namespace cutterflow::coupling
