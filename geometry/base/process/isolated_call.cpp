#include "geometry/base/process/isolated_call.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

namespace cutterflow {
namespace {

constexpr int k_failed = 1;

[[noreturn]] void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

/// No core file; SIGXCPU at the limit, SIGKILL a second later.
void set_limits(double cpu_limit_s) {
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    const auto seconds = static_cast<rlim_t>(std::ceil(cpu_limit_s));
    const rlimit cpu{seconds, seconds + 1};
    ::setrlimit(RLIMIT_CPU, &cpu);
}

bool write_all(int file, const std::string& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t count = ::write(file, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno != EINTR) return false;
        if (count > 0) done += static_cast<std::size_t>(count);
    }
    return true;
}

/// Ends without destructors and exit handlers: they belong to the caller's process.
[[noreturn]] void run_in_child(const std::function<std::string()>& work, double cpu_limit_s, int to_parent) {
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXCPU, SIGPIPE}) std::signal(signal, SIG_DFL);
    set_limits(cpu_limit_s);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    try {
        ::_exit(write_all(to_parent, work()) ? 0 : k_failed);
    } catch (...) {
        ::_exit(k_failed);
    }
}

std::string read_all(int file) {
    std::string bytes;
    char buffer[65536];
    for (;;) {
        const ssize_t count = ::read(file, buffer, sizeof buffer);
        if (count == 0) return bytes;
        if (count < 0 && errno != EINTR) fail("read from a child process");
        if (count > 0) bytes.append(buffer, static_cast<std::size_t>(count));
    }
}

std::string death_of(int status, double cpu_limit_s) {
    if (WIFEXITED(status)) return WEXITSTATUS(status) == 0 ? "" : fmt::format("ended with code {}", WEXITSTATUS(status));
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) return fmt::format("was stopped after {:.0f} s of core time", std::ceil(cpu_limit_s));
    return fmt::format("was ended by signal {} ({})", signal, ::strsignal(signal));
}

}  // namespace

IsolatedResult call_isolated(const std::function<std::string()>& work, double cpu_limit_s) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail("pipe");
    const pid_t child = ::fork();
    if (child < 0) {
        ::close(ends[0]);
        ::close(ends[1]);
        fail("fork");
    }
    if (child == 0) {
        ::close(ends[0]);
        run_in_child(work, cpu_limit_s, ends[1]);
    }
    ::close(ends[1]);
    IsolatedResult result{read_all(ends[0]), ""};
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) fail("waitpid");
    result.death = death_of(status, cpu_limit_s);
    return result;
}

}  // namespace cutterflow
