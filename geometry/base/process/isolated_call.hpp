#pragma once
/// \file Code that may crash, called in a process of its own.
#include <functional>
#include <string>

namespace cutterflow {

struct IsolatedResult {
    std::string bytes;  ///< what the work returned
    std::string
        death;  ///< how its process ended before it returned ("was ended by signal 11 (Segmentation fault)"); empty when it returned
};

/// Calls `work` in a fork of this process, without a shell and without standard output and error, and returns its bytes. Whatever the
/// work does to its memory or its process, the caller goes on. An exception of the work counts as a death.
/// \param cpu_limit_s  core time that the work may use [s], >= 1
/// \throws std::system_error  when no process can be started
IsolatedResult call_isolated(const std::function<std::string()>& work, double cpu_limit_s);

}  // namespace cutterflow
