#pragma once
/// \file What this process has cost.
#include <ctime>

namespace cutterflow {

/// Processor time of this process since its start, user and system, of all threads [s]. A wait for a core is not in it.
inline double processor_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace cutterflow
