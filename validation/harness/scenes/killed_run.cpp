#include "validation/harness/scenes/killed_run.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/run_files.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/scenes/box_case.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr int k_waits = 12000;  // of 10 ms

pid_t start(const fs::path& folder, int ranks) {
    const ChildCommand command = meshing::foam_command(folder, cutter_foam(), {}, ranks);
    std::vector<char*> arguments;
    for (const std::string& argument : command.arguments) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    if (chdir(folder.c_str()) != 0) _exit(1);
    for (const auto& [name, value] : command.environment) setenv(name.c_str(), value.c_str(), 1);
    if (freopen("log.killed", "w", stdout) == nullptr) _exit(1);
    execvp(arguments[0], arguments.data());
    _exit(127);
}

/// The process and all that it started, and these started: mpirun gives its ranks process groups of their own.
std::vector<pid_t> with_descendants(pid_t process) {
    std::vector<pid_t> all{process};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string pid = std::to_string(all[i]);
        std::ifstream children("/proc/" + pid + "/task/" + pid + "/children");
        for (pid_t child = 0; children >> child;) all.push_back(child);
    }
    return all;
}

}  // namespace

void run_and_kill_after(const fs::path& folder, const std::string& checkpoint, int ranks) {
    const fs::path written = folder / names::checkpoints / checkpoint;
    const pid_t child = start(folder, ranks);
    for (int wait = 0; wait < k_waits && !fs::exists(written); ++wait) std::this_thread::sleep_for(10ms);
    std::this_thread::sleep_for(200ms);
    for (const pid_t process : with_descendants(child)) kill(process, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    std::this_thread::sleep_for(200ms);  // until no rank writes any more
    if (!fs::exists(written)) throw std::runtime_error("the run never wrote " + written.string());
    if (!WIFSIGNALED(status)) throw std::runtime_error("the run ended before it could be killed");
    drop_times_after_checkpoint(folder);
}

std::vector<std::string> rows_of_all_starts(const fs::path& tables, const std::string& file) {
    std::vector<std::string> rows;
    for (const fs::path& start : time_folders(tables)) {
        std::ifstream stream(start / file);
        std::string line;
        std::getline(stream, line);
        while (std::getline(stream, line)) rows.push_back(line);
    }
    return rows;
}

}  // namespace cutterflow::validation
