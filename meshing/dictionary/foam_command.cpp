#include "meshing/dictionary/foam_command.hpp"

#include <cstdlib>

namespace cutterflow::meshing {
namespace {

std::map<std::string, std::string> missing_environment() {
    const std::map<std::string, std::string> wanted = {
        {"WM_PROJECT_DIR", "/usr/share/openfoam"},  // where Debian keeps OpenFOAM's etc/
        {"OMPI_ALLOW_RUN_AS_ROOT", "1"},            // Open MPI refuses root unless both are set
        {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
        {"OMPI_MCA_btl_vader_single_copy_mechanism", "none"},  // containers forbid it, with a warning per message
    };
    std::map<std::string, std::string> missing;
    for (const auto& [name, value] : wanted)
        if (!std::getenv(name.c_str())) missing.emplace(name, value);
    return missing;
}

}  // namespace

ChildCommand foam_command(const std::filesystem::path& case_directory, const std::string& program,
                          const std::vector<std::string>& arguments, int ranks) {
    ChildCommand command;
    // Open MPI counts cores, not hardware threads, and refuses more ranks than it counted.
    if (ranks > 1) command.arguments = {"mpirun", "--oversubscribe", "--bind-to", "none", "-n", std::to_string(ranks)};
    command.arguments.push_back(program);
    command.arguments.insert(command.arguments.end(), arguments.begin(), arguments.end());
    if (ranks > 1) command.arguments.emplace_back("-parallel");
    command.working_directory = case_directory;
    command.log = case_directory / ("log." + std::filesystem::path(program).filename().string());
    command.environment = missing_environment();
    command.environment["PWD"] =
        std::filesystem::absolute(case_directory).lexically_normal().string();  // OpenFOAM warns when it is another
    return command;
}

}  // namespace cutterflow::meshing
