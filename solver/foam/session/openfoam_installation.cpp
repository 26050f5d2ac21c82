#include "solver/foam/session/openfoam_installation.hpp"

#include <alloca.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

#include "foamVersion.H"

namespace {

/// libOpenFOAM reads etc/controlDict while it is loaded, long before main: only what stands in the environment when the program starts
/// counts. Runs before every library's initialisation, so that nothing but system calls may be used here.
void start_with_project_dir(int, char** argv, char** environment) {
    static char project_dir[] = "WM_PROJECT_DIR=" CUTTERFLOW_OPENFOAM_PROJECT_DIR;
    const std::size_t name = sizeof "WM_PROJECT_DIR=" - 1;
    std::size_t count = 0;
    for (; environment[count] != nullptr; ++count)
        if (std::strncmp(environment[count], project_dir, name) == 0) return;
    char** completed = static_cast<char**>(alloca((count + 2) * sizeof(char*)));
    std::memcpy(completed, environment, count * sizeof(char*));
    completed[count] = project_dir;
    completed[count + 1] = nullptr;
    execve("/proc/self/exe", argv, completed);  // on failure OpenFOAM says what it does not find
}

__attribute__((section(".preinit_array"), used)) void (*const k_start)(int, char**, char**) = start_with_project_dir;

}  // namespace

namespace cutterflow::foam {
namespace {

/// `api=...` of an installation; empty when it does not say (Debian's does not).
std::string api_of(const std::string& project_dir) {
    std::ifstream stream(project_dir + "/META-INFO/api-info");
    for (std::string line; std::getline(stream, line);)
        if (line.rfind("api=", 0) == 0) return line.substr(4);
    return {};
}

std::string value_of(const char* variable) {
    const char* value = std::getenv(variable);
    return value == nullptr ? std::string() : std::string(value);
}

}  // namespace

void require_openfoam_of_build() {
    const std::string built_for = std::to_string(OPENFOAM);
    std::vector<Mistake> mistakes;
    const auto require = [&](const std::string& what, const std::string& version) {
        if (version.empty() || version == built_for || version == "v" + built_for) return;
        mistakes.push_back({"", fmt::format("{} {}", what, version), fmt::format("This cutterFoam is built for OpenFOAM v{}", built_for),
                            "Use a shell in which no other version's etc/bashrc was sourced, or build cutterFoam for that version"});
    };
    require("WM_PROJECT_VERSION =", value_of("WM_PROJECT_VERSION"));
    require(fmt::format("WM_PROJECT_DIR = {} holds OpenFOAM", value_of("WM_PROJECT_DIR")), api_of(value_of("WM_PROJECT_DIR")));
    require("the OpenFOAM libraries that were loaded are of version", std::to_string(Foam::foamVersion::api));
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

}  // namespace cutterflow::foam
