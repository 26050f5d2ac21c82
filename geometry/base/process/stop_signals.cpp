#include "geometry/base/process/stop_signals.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <string_view>

#include <gsl/assert>

#include "geometry/base/process/child_process.hpp"

namespace cutterflow {
namespace {

// State of the signal handler; a handler must not access anything else.
struct RunningChild {
    volatile std::sig_atomic_t pid, first_stop_signal;
};
std::array<RunningChild, k_most_children> g_children{};
volatile std::sig_atomic_t g_received = 0;

std::mutex g_mutex;  // of the places among the children and of what follows
int g_lives = 0;     // of StopSignals
std::array<struct sigaction, k_stop_signals.size()> g_previous{};

constexpr std::string_view k_ends_in_order = "\nstopping at the end of this step; a second time stops at once\n";

extern "C" void pass_on(int signal_number) {
    const int saved_errno = errno;
    const bool is_first = g_received == 0;
    g_received = signal_number;
    bool ends_in_order = false;
    for (const RunningChild& child : g_children) {
        if (child.pid <= 0) continue;
        const bool asks = is_first && child.first_stop_signal != 0;
        ::kill(static_cast<pid_t>(child.pid), asks ? child.first_stop_signal : signal_number);
        ends_in_order = ends_in_order || asks;
    }
    if (ends_in_order) {
        [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, k_ends_in_order.data(), k_ends_in_order.size());
    }
    errno = saved_errno;
}

}  // namespace

StopSignals::StopSignals() {
    const std::lock_guard<std::mutex> lock(g_mutex);
    if (g_lives++ > 0) return;
    g_received = 0;
    struct sigaction action {};
    action.sa_handler = pass_on;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < k_stop_signals.size(); ++i) ::sigaction(k_stop_signals[i], &action, &g_previous[i]);
}

StopSignals::~StopSignals() {
    const std::lock_guard<std::mutex> lock(g_mutex);
    if (--g_lives > 0) return;
    for (std::size_t i = 0; i < k_stop_signals.size(); ++i) ::sigaction(k_stop_signals[i], &g_previous[i], nullptr);
}

std::string StopSignals::received() {
    switch (g_received) {
        case 0:
            return "";
        case SIGINT:
            return "Ctrl-C (SIGINT)";
        case SIGTERM:
            return "a request to end (SIGTERM)";
        case SIGHUP:
            return "the end of its terminal (SIGHUP)";
    }
    return ::strsignal(g_received);
}

void StopSignals::require_none() const {
    if (const std::string signal = received(); !signal.empty()) throw Interrupted("stopped by " + signal);
}

ForwardedChild::ForwardedChild(pid_t child, int first_stop_signal) {
    const std::lock_guard<std::mutex> lock(g_mutex);
    const auto free = std::find_if(g_children.begin(), g_children.end(), [](const RunningChild& c) { return c.pid == 0; });
    Expects(free != g_children.end());
    place_ = static_cast<std::size_t>(free - g_children.begin());
    free->first_stop_signal = first_stop_signal;
    free->pid = child;
    if (g_received != 0) ::kill(child, g_received);  // received before the child was registered
}

ForwardedChild::~ForwardedChild() {
    const std::lock_guard<std::mutex> lock(g_mutex);
    g_children[place_].pid = 0;
}

}  // namespace cutterflow
