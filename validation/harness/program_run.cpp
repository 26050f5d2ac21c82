#include "validation/harness/program_run.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::validation {

namespace fs = std::filesystem;

ChildResult run_cutterflow(const fs::path& folder, const std::vector<std::string>& arguments) {
    fs::create_directories(folder);
    ChildCommand command;
    command.arguments = {(installation().programs / "cutterflow").string()};
    command.arguments.insert(command.arguments.end(), arguments.begin(), arguments.end());
    command.working_directory = folder;
    command.log = folder / ("log." + arguments.front());
    return require_child(command);
}

nlohmann::json run_study(const fs::path& folder, const fs::path& start_from) {
    std::vector<std::string> arguments = {"run", "study.toml", "-o", "run", "--resume"};
    if (!start_from.empty()) arguments.insert(arguments.end(), {"--start-from", fs::absolute(start_from).string()});
    run_cutterflow(folder, arguments);
    return nlohmann::json::parse(read_file(folder / "run" / names::results_json));
}

void run_studies(const std::vector<StudyRun>& runs) {
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&] {
        for (std::size_t i = next++; i < runs.size(); i = next++) {
            try {
                run_study(runs[i].folder, runs[i].start_from);
            } catch (...) {
                const std::lock_guard<std::mutex> lock(mutex);
                if (!failure) failure = std::current_exception();
                next = runs.size();
            }
        }
    };
    std::vector<std::thread> workers;
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    for (unsigned core = 0; core < cores; ++core) workers.emplace_back(work);
    for (std::thread& worker : workers) worker.join();
    if (failure) std::rethrow_exception(failure);
}

double stage_core_s(const fs::path& run, const std::string& stage) {
    return nlohmann::json::parse(read_file(run / names::manifest)).at("stages").at(stage).at("core_s");
}

}  // namespace cutterflow::validation
