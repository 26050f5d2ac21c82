#pragma once

namespace cutterflow {

/// Time [s] that a head must be fed before the share that it delivers has an interval: the shortest start-up and the fewest batches of
/// production_of. \param revolution  [s]
double shortest_fed_time(double revolution);

}  // namespace cutterflow
