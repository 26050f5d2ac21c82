#include "solver/app/stop_request.hpp"

#include <array>
#include <csignal>

#include "geometry/base/process/child_process.hpp"

namespace cutterflow {

namespace {

constexpr std::array<int, 4> k_stop_signals{k_end_in_order, SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t g_stop_is_asked = 0;

extern "C" void ask_to_stop(int) {
    g_stop_is_asked = 1;
    for (const int number : k_stop_signals) std::signal(number, SIG_DFL);
}

}  // namespace

void listen_for_stop() {
    for (const int number : k_stop_signals) std::signal(number, ask_to_stop);
}

bool is_asked_to_stop() {
    return g_stop_is_asked != 0;
}

}  // namespace cutterflow
