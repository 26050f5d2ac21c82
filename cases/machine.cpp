#include "cases/machine.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "geometry/base/child_process.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::cases {
namespace {

constexpr const char* k_openfoam = "v1912";

void require_openfoam_environment() {
    const char* version = std::getenv("WM_PROJECT_VERSION");
    if (version == nullptr || std::string(version).empty() || std::string(version) == k_openfoam) return;
    throw UserError(fmt::format("the environment of OpenFOAM {} is loaded (WM_PROJECT_VERSION)", version),
                    fmt::format("Cutterflow works with OpenFOAM {} alone", k_openfoam),
                    "Use a shell in which that version's etc/bashrc was not sourced");
}

void require_ranks(int ranks) {
    const int cores = available_cores();
    if (ranks >= 1 && ranks <= cores) return;
    throw UserError(fmt::format("--ranks {} on {} core(s)", ranks, cores), "A rank needs a core of its own",
                    fmt::format("Use --ranks {}, or a machine with more cores", ranks < 1 ? 1 : cores));
}

}  // namespace

int available_cores() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void require_machine(int ranks, const std::vector<std::string>& programs) {
    require_ranks(ranks);
    require_openfoam_environment();
    require_programs(programs);
}

}  // namespace cutterflow::cases
