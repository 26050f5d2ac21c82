#pragma once
/// \file When the flow of a run is that of a head at work.

namespace cutterflow {

/// Revolutions in which a flow forgets the frozen rotor from which it starts (docs/design/013-replays.md).
constexpr double k_developed_revolutions = 6.0;

}  // namespace cutterflow
