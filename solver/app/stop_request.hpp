#pragma once
/// \file A solver's request to stop: SIGINT, SIGTERM, SIGHUP or k_end_in_order. The first one is remembered until the step is done.

namespace cutterflow {

/// From now on the first of these signals is remembered; the next one stops the program at once.
void listen_for_stop();

bool is_asked_to_stop();

}  // namespace cutterflow
