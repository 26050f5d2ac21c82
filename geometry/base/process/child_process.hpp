#pragma once
/// \file Programs started as children: without a shell, with their output kept in a log file.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/base/error.hpp"

namespace cutterflow {

/// At this signal cutterFoam and cutterSurface write a checkpoint at the end of their step and end.
inline constexpr int k_end_in_order = SIGUSR1;

/// Command to start. Arguments are passed unchanged, without a shell.
struct ChildCommand {
    std::vector<std::string> arguments;              ///< program (searched on PATH) and its arguments
    std::filesystem::path working_directory;         ///< empty: the caller's
    std::filesystem::path log;                       ///< receives standard output and error; overwritten
    std::map<std::string, std::string> environment;  ///< added to the caller's environment
    int first_stop_signal = 0;                       ///< of a program that ends in order at it (run_child); 0: it has none
};

/// How it ended.
struct ChildResult {
    int exit_code = 0;  ///< 128 + signal when a signal ended it
    double wall_s = 0.0;
    double core_s = 0.0;  ///< user and system time of the child and its waited-for descendants
    double memory = 0.0;  ///< largest resident set of any one of them [bytes]
};

/// Runs a program to its end. `each_line` (may be empty) is called with every complete line of output while the program runs, after it
/// was written to the log. Several may run in parallel, one per thread. SIGINT and SIGTERM that reach the caller are forwarded to
/// the child, which is waited for; then the call throws Interrupted. (Every child that runs gets the signal.) A child with a first stop
/// signal gets that one in place of the first, and the user is told; the next ones are forwarded as they are.
/// \throws ToolError  when the program is not found or cannot be started (names it, its package when known, and what to do)
ChildResult run_child(const ChildCommand& command, const std::function<void(const std::string&)>& each_line = {});

/// As run_child, but an exit code other than 0 throws ToolError, which quotes the log's last lines and names the log.
ChildResult require_child(const ChildCommand& command, const std::function<void(const std::string&)>& each_line = {});

/// User and system time of all children of this process that have ended [s].
double children_core_s();

/// Message for an exit code other than 0: how the program ended, name and last lines of the log.
Mistake failure_of(const ChildCommand& command, const ChildResult& result);

/// Full path of a program on PATH; empty when there is none.
std::filesystem::path find_program(const std::string& name);

/// \param programs  names on PATH, or paths
/// \throws ToolError  naming every missing program, its package and the remedy
void require_programs(const std::vector<std::string>& programs);

/// The run was stopped by the user (SIGINT or SIGTERM); what was done is kept.
class Interrupted : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace cutterflow
