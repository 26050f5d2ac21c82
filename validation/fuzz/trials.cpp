#include "validation/fuzz/trials.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "validation/fuzz/mutation.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t k_batch = 500;         // inputs of one process at most
constexpr std::size_t k_shown_output = 20000;  // bytes
constexpr double k_wall_per_core = 10.0;       // an input may wait for the machine so much longer than it computes

/// What the child tells while it works; shared between the processes.
struct Board {
    std::uint64_t done = 0;  // inputs of this batch
    FuzzEnd ends[k_batch] = {};
};

class SharedBoard {
public:
    SharedBoard() : memory_(::mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
        if (memory_ == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "mmap");
        new (memory_) Board;
    }
    ~SharedBoard() { ::munmap(memory_, sizeof(Board)); }
    SharedBoard(const SharedBoard&) = delete;
    SharedBoard& operator=(const SharedBoard&) = delete;
    volatile Board& operator*() { return *static_cast<volatile Board*>(memory_); }

private:
    void* memory_;
};

std::string content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write(const fs::path& file, const std::string& content) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
}

/// The exit code that the command line makes of what was thrown (cases/cli/main.cpp).
FuzzEnd end_of(const std::function<void()>& call) {
    try {
        call();
        return FuzzEnd::done;
    } catch (const Failure& failure) {
        const std::string text = failure.what();
        if (text.find(fmt::format("the importer (assimp) ended with code {}", k_sanitizer_exit_code)) != std::string::npos)
            return FuzzEnd::died;
        if (text.find("the importer (assimp)") != std::string::npos) return FuzzEnd::importer_died;
        switch (failure.code()) {
            case ExitCode::user_input:
                return FuzzEnd::user_input;
            case ExitCode::external_program:
                return FuzzEnd::external_program;
            case ExitCode::check_failed:
                return FuzzEnd::check_failed;
            default:
                return FuzzEnd::defect;
        }
    } catch (const fs::filesystem_error&) {
        return FuzzEnd::user_input;
    } catch (const std::exception& error) {
        std::cerr << "exit 1: " << error.what() << std::endl;
        return FuzzEnd::defect;
    }
}

void start_clocks(double core_s) {
    const auto clock = [](__itimer_which which, double seconds) {
        itimerval value{};
        value.it_value.tv_sec = static_cast<time_t>(seconds);
        value.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - std::floor(seconds)));
        ::setitimer(which, &value, nullptr);
    };
    clock(ITIMER_PROF, core_s);
    clock(ITIMER_REAL, k_wall_per_core * core_s);
}

FuzzEnd try_input(const FuzzKind& kind, const FuzzSeed& input, const fs::path& folder, double core_s) {
    const fs::path file = folder / input.file;
    write(file, input.content);
    start_clocks(core_s);
    const FuzzEnd end = end_of([&] { kind.read(folder, input.file); });
    start_clocks(0.0);
    return content_of(file) == input.content ? end : FuzzEnd::input_changed;
}

[[noreturn]] void work(const FuzzKind& kind, std::uint64_t seed, std::uint64_t first, std::uint64_t count, const FuzzLimits& limits,
                       const fs::path& folder, volatile Board& board) {
    const int output = ::open((folder / "output").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0644);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    const rlimit memory{limits.memory, limits.memory};
    if (limits.memory > 0) ::setrlimit(RLIMIT_AS, &memory);
    for (std::uint64_t i = 0; i < count; ++i) {
        (void)!::ftruncate(output, 0);
        const FuzzSeed input = fuzz_input(kind, seed, first + i);
        const FuzzEnd end = try_input(kind, input, folder / "files", limits.core_s);
        for (const FuzzSeed& good : kind.seeds)
            if (good.file == input.file) write(folder / "files" / good.file, good.content);
        board.ends[i] = end;
        board.done = i + 1;
        if (is_finding(end)) break;  // the next process begins with a clean output
    }
    std::cout.flush();
    std::cerr.flush();
    ::_exit(0);
}

FuzzEnd death_of(int status) {
    const bool timed_out = WIFSIGNALED(status) && (WTERMSIG(status) == SIGPROF || WTERMSIG(status) == SIGALRM);
    return timed_out ? FuzzEnd::hung : FuzzEnd::died;
}

std::string death_text(int status) {
    if (WIFSIGNALED(status)) return fmt::format("signal {} ({})\n", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    return fmt::format("exit {}\n", WEXITSTATUS(status));
}

void prepare(const FuzzKind& kind, const fs::path& folder) {
    fs::remove_all(folder);
    fs::create_directories(folder / "files");
    if (kind.around) kind.around(folder / "files");
    for (const FuzzSeed& seed : kind.seeds) write(folder / "files" / seed.file, seed.content);
}

/// One process. \return number of inputs tried
std::uint64_t try_batch(const FuzzKind& kind, std::uint64_t seed, std::uint64_t first, std::uint64_t count, const FuzzLimits& limits,
                        const fs::path& folder, FuzzCounts& counts) {
    SharedBoard shared;
    volatile Board& board = *shared;
    std::cout.flush();
    const pid_t child = ::fork();
    if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) work(kind, seed, first, count, limits, folder, board);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
    const std::uint64_t done = board.done;
    const auto book = [&](std::uint64_t i, FuzzEnd end, const std::string& told) {
        ++counts.ends[end];
        if (!is_finding(end)) return;
        const FuzzSeed input = fuzz_input(kind, seed, first + i);
        std::string output = content_of(folder / "output");
        if (output.size() > k_shown_output) output.erase(0, output.size() - k_shown_output);
        counts.findings.push_back({first + i, end, input.content, input.file, told + output});
    };
    for (std::uint64_t i = 0; i < done; ++i) book(i, board.ends[i], "");
    const bool whole = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (whole) return done;
    book(done, death_of(status), death_text(status));
    prepare(kind, folder);  // what the dead one left half written is not the next one's
    return done + 1;
}

}  // namespace

const char* fuzz_end_name(FuzzEnd end) {
    switch (end) {
        case FuzzEnd::untried:
            return "untried";
        case FuzzEnd::done:
            return "exit 0";
        case FuzzEnd::defect:
            return "exit 1";
        case FuzzEnd::user_input:
            return "exit 2";
        case FuzzEnd::external_program:
            return "exit 3";
        case FuzzEnd::check_failed:
            return "exit 4";
        case FuzzEnd::importer_died:
            return "exit 2, importer died";
        case FuzzEnd::input_changed:
            return "input changed";
        case FuzzEnd::died:
            return "died";
        case FuzzEnd::hung:
            return "hung";
    }
    return "";
}

bool is_finding(FuzzEnd end) {
    return end == FuzzEnd::untried || end == FuzzEnd::defect || end == FuzzEnd::input_changed || end == FuzzEnd::died ||
           end == FuzzEnd::hung;
}

FuzzSeed fuzz_input(const FuzzKind& kind, std::uint64_t seed, std::uint64_t index) {
    FuzzDice dice(seed, kind.name, index);
    const FuzzSeed& good = kind.seeds[dice.below(kind.seeds.size())];
    const FuzzSeed& other = kind.seeds[dice.below(kind.seeds.size())];
    return {good.file, mutated(good.content, other.content, kind.words, dice)};
}

FuzzCounts try_inputs(const FuzzKind& kind, std::uint64_t seed, std::uint64_t first, std::uint64_t count, const FuzzLimits& limits,
                      const fs::path& folder, const std::function<void(std::uint64_t)>& progress) {
    prepare(kind, folder);
    FuzzCounts counts;
    for (std::uint64_t done = 0; done < count;) {
        done += try_batch(kind, seed, first + done, std::min(k_batch, count - done), limits, folder, counts);
        if (progress) progress(done);
    }
    return counts;
}

}  // namespace cutterflow::validation
