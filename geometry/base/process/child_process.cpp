#include "geometry/base/process/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <optional>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/process/stop_signals.hpp"

extern char** environ;

namespace cutterflow {
namespace {

/// User and system time [s].
double core_s_of(const struct rusage& usage) {
    const auto seconds = [](const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

class FileDescriptor {
public:
    explicit FileDescriptor(int number) : number_(number) {}
    ~FileDescriptor() { close(); }
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;
    int number() const { return number_; }
    void close() {
        if (number_ >= 0) ::close(number_);
        number_ = -1;
    }

private:
    int number_;
};

/// The Debian package of a program; empty when unknown.
std::string package_of(const std::string& program) {
    static const std::set<std::string> openfoam{"blockMesh",           "snappyHexMesh", "checkMesh",      "surfaceFeatureExtract",
                                                "createBaffles",       "createPatch",   "topoSet",        "splitMeshRegions",
                                                "mergeOrSplitBaffles", "decomposePar",  "reconstructPar", "reconstructParMesh",
                                                "simpleFoam",          "pimpleFoam",    "potentialFoam",  "renumberMesh",
                                                "foamToVTK",           "postProcess",   "foamDictionary", "mapFields"};
    static const std::map<std::string, std::string> others{
        {"mpirun", "openmpi-bin"}, {"gnuplot", "gnuplot-nox"}, {"sbatch", "slurm-client"}, {"squeue", "slurm-client"}};
    if (openfoam.count(program) > 0) return "openfoam";
    const auto found = others.find(program);
    return found == others.end() ? "" : found->second;
}

Mistake missing_program(const std::string& program) {
    const std::string package = package_of(std::filesystem::path(program).filename().string());
    if (package.empty())
        return {"", fmt::format("the program {} was not found", program), "It is part of this project",
                "Run ./bootstrap in the repository, or add the program's folder to PATH"};
    return {"", fmt::format("the program {} was not found on PATH", program), fmt::format("It comes with the Debian package {}", package),
            fmt::format("Run ./bootstrap in the repository, or apt-get install {}", package)};
}

/// What cannot be looked at is no program, as for a shell.
bool is_program(const std::filesystem::path& path) {
    std::error_code unreadable;
    return std::filesystem::is_regular_file(path, unreadable) && ::access(path.c_str(), X_OK) == 0;
}

/// Path of a program by name or path; empty if it does not exist.
std::filesystem::path locate(const std::string& name) {
    if (name.find('/') == std::string::npos) return find_program(name);
    const std::filesystem::path path = std::filesystem::absolute(name);
    return is_program(path) ? path : std::filesystem::path();
}

std::vector<std::string> merged_environment(const std::map<std::string, std::string>& additions) {
    std::vector<std::string> merged;
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string text(*entry);
        if (additions.count(text.substr(0, text.find('='))) == 0) merged.push_back(text);
    }
    for (const auto& [name, value] : additions) merged.push_back(fmt::format("{}={}", name, value));
    return merged;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

void require_system(int error, const std::string& doing) {
    if (error != 0) throw std::system_error(error, std::generic_category(), doing);
}

/// Starts the program with its output on `output`, empty standard input, in a separate process group: the terminal's Ctrl-C
/// reaches it through StopSignals alone, once.
pid_t spawn(const std::filesystem::path& program, const ChildCommand& command, int output) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    require_system(posix_spawn_file_actions_init(&actions), "preparing a child process");
    require_system(posix_spawnattr_init(&attributes), "preparing a child process");
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
    if (!command.working_directory.empty()) posix_spawn_file_actions_addchdir_np(&actions, command.working_directory.c_str());
    sigset_t defaults;
    sigemptyset(&defaults);
    for (const int number : k_stop_signals) sigaddset(&defaults, number);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);

    std::vector<std::string> arguments = command.arguments;
    std::vector<std::string> environment = merged_environment(command.environment);
    pid_t child = 0;
    const int error =
        posix_spawn(&child, program.c_str(), &actions, &attributes, pointers_to(arguments).data(), pointers_to(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0)
        throw ToolError(
            {"", fmt::format("{} could not be started: {}", program.string(), std::strerror(error)),
             fmt::format("Its working directory is {}", command.working_directory.empty() ? "." : command.working_directory.string()),
             "Check that the folder exists and the program is executable"});
    return child;
}

/// Waits for the child in any case; kills it first when the caller leaves by an exception.
class ChildGuard {
public:
    explicit ChildGuard(pid_t child) : child_(child) {}
    ~ChildGuard() {
        if (child_ == 0) return;
        ::kill(child_, SIGTERM);
        wait();
    }
    ChildGuard(const ChildGuard&) = delete;
    ChildGuard& operator=(const ChildGuard&) = delete;

    /// How it ended, without the wall time.
    ChildResult wait() {
        int status = 0;
        struct rusage usage {};
        while (::wait4(child_, &status, 0, &usage) < 0 && errno == EINTR) {
        }
        child_ = 0;
        const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
        // The kernel counts the resident set in KiB.
        return {code, 0.0, core_s_of(usage), 1024.0 * static_cast<double>(usage.ru_maxrss)};
    }

private:
    pid_t child_;
};

/// Copies the child's output to the log and passes each complete line to the callback.
class OutputReader {
public:
    OutputReader(const std::filesystem::path& log, const std::function<void(const std::string&)>& each_line) : each_line_(each_line) {
        if (log.empty()) return;
        if (log.has_parent_path()) std::filesystem::create_directories(log.parent_path());
        log_.open(log, std::ios::binary | std::ios::trunc);
        if (!log_)
            throw UserError(fmt::format("cannot write the log {}", log.string()), "Its folder must be writable", "Check its permissions");
    }

    void read_all(int input) {
        std::array<char, 65536> buffer;
        while (true) {
            const ssize_t count = ::read(input, buffer.data(), buffer.size());
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) break;
            take(buffer.data(), static_cast<std::size_t>(count));
        }
        if (!line_.empty() && each_line_) each_line_(line_);
    }

private:
    void take(const char* text, std::size_t count) {
        if (log_.is_open()) log_.write(text, static_cast<std::streamsize>(count)).flush();
        if (!each_line_) return;
        line_.append(text, count);
        std::size_t begin = 0;
        for (std::size_t end = line_.find('\n'); end != std::string::npos; end = line_.find('\n', begin)) {
            each_line_(line_.substr(begin, end - begin));
            begin = end + 1;
        }
        line_.erase(0, begin);
    }

    std::ofstream log_;
    const std::function<void(const std::string&)>& each_line_;
    std::string line_;
};

std::string last_lines(const std::filesystem::path& log, std::size_t count) {
    std::ifstream stream(log);
    std::deque<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        if (line.empty()) continue;
        lines.push_back("    " + line);
        if (lines.size() > count) lines.pop_front();
    }
    return fmt::format("{}", fmt::join(lines, "\n"));
}

}  // namespace

std::filesystem::path find_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::string folders = path == nullptr ? "/usr/local/bin:/usr/bin:/bin" : path;
    folders += ':';
    std::size_t begin = 0;
    for (std::size_t end = folders.find(':'); end != std::string::npos; end = folders.find(':', begin)) {
        std::filesystem::path candidate = std::filesystem::path(folders.substr(begin, end - begin)) / name;
        if (end > begin && is_program(candidate)) return candidate;
        begin = end + 1;
    }
    return {};
}

void require_programs(const std::vector<std::string>& programs) {
    std::vector<Mistake> missing;
    for (const std::string& program : programs)
        if (locate(program).empty()) missing.push_back(missing_program(program));
    if (!missing.empty()) throw ToolError(missing);
}

ChildResult run_child(const ChildCommand& command, const std::function<void(const std::string&)>& each_line) {
    const std::filesystem::path program = locate(command.arguments.at(0));
    if (program.empty()) throw ToolError(missing_program(command.arguments[0]));

    OutputReader reader(command.log, each_line);
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) require_system(errno, "opening a pipe");
    const FileDescriptor input(ends[0]);
    FileDescriptor output(ends[1]);

    const auto begin = std::chrono::steady_clock::now();
    const StopSignals signals;
    std::optional<ForwardedChild> forwarded;  // until it has been waited for
    const pid_t pid = spawn(program, command, output.number());
    ChildGuard child(pid);
    forwarded.emplace(pid, command.first_stop_signal);
    output.close();
    reader.read_all(input.number());
    ChildResult result = child.wait();
    result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (const std::string signal = StopSignals::received(); !signal.empty())
        throw Interrupted(fmt::format("{} was stopped by {}", program.filename().string(), signal));
    return result;
}

double children_core_s() {
    struct rusage usage {};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    return core_s_of(usage);
}

Mistake failure_of(const ChildCommand& command, const ChildResult& result) {
    const std::string log =
        command.log.empty() ? "" : fmt::format(". Its log {} ends with\n{}\n", command.log.string(), last_lines(command.log, 12));
    const int signal_number = result.exit_code - 128;
    const std::string how = signal_number > 0 ? fmt::format("was killed by signal {} ({})", signal_number, ::strsignal(signal_number))
                                              : fmt::format("ended with exit code {}", result.exit_code);
    return {"", fmt::format("{} {}{}", fmt::join(command.arguments, " "), how, log), "It must end with exit code 0",
            "Read the first error in the log"};
}

ChildResult require_child(const ChildCommand& command, const std::function<void(const std::string&)>& each_line) {
    const ChildResult result = run_child(command, each_line);
    if (result.exit_code != 0) throw ToolError(failure_of(command, result));
    return result;
}

}  // namespace cutterflow
