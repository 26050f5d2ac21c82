#include "solver/app/stop_request.hpp"

#include <csignal>

#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/stop_signals.hpp"

namespace cutterflow {

namespace {

volatile std::sig_atomic_t g_stop_is_asked = 0;

void handle_stop_signals(void (*handler)(int)) {
    std::signal(k_end_in_order, handler);
    for (const int number : k_stop_signals) std::signal(number, handler);
}

extern "C" void ask_to_stop(int) {
    g_stop_is_asked = 1;
    handle_stop_signals(SIG_DFL);
}

}  // namespace

void listen_for_stop() {
    handle_stop_signals(ask_to_stop);
}

bool is_asked_to_stop() {
    return g_stop_is_asked != 0;
}

}  // namespace cutterflow
