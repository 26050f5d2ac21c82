#include "validation/harness/program_run.hpp"

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

double stage_core_s(const fs::path& run, const std::string& stage) {
    return nlohmann::json::parse(read_file(run / names::manifest)).at("stages").at(stage).at("core_s");
}

}  // namespace cutterflow::validation
