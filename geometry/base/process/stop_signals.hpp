#pragma once
/// \file Stop signals of a program that runs others.
#include <sys/types.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <string>

namespace cutterflow {

inline constexpr std::array<int, 3> k_stop_signals{SIGINT, SIGTERM, SIGHUP};

/// Children that may run at a time.
inline constexpr std::size_t k_most_children = 256;

/// While one lives, stop signals are forwarded to the children that run and to those that begin later; the caller's handlers are restored
/// after the last. run_child has one of its own; who runs several children holds one beside, so that a signal that ended one child is not
/// forgotten when the next begins.
class StopSignals {
public:
    StopSignals();
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    /// The last one since the first of those that live was made, as the user knows it; empty: none.
    static std::string received();
    /// \throws Interrupted  when one was received
    void require_none() const;
};

/// A child that stop signals are forwarded to while this lives, one that was received before at once.
class ForwardedChild {
public:
    /// \param first_stop_signal  sent in place of the first; 0: none
    /// \pre fewer than k_most_children others
    ForwardedChild(pid_t child, int first_stop_signal);
    ~ForwardedChild();
    ForwardedChild(const ForwardedChild&) = delete;
    ForwardedChild& operator=(const ForwardedChild&) = delete;

private:
    std::size_t place_;
};

}  // namespace cutterflow
