#include "validation/studies/benchmarks/descendants.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

/// VmHWM of /proc/<id>/status [bytes]; 0 of a process that has ended since.
double peak_memory_of(const fs::path& process) {
    std::ifstream status(process / "status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind("VmHWM:", 0) == 0) return 1024.0 * std::stod(line.substr(6));
    return 0.0;
}

}  // namespace

std::vector<Descendant> descendants() {
    struct Process {
        long parent;
        Descendant use;
    };
    const double ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
    std::map<long, Process> processes;
    for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        std::string text;
        std::getline(std::ifstream(entry.path() / "stat"), text);
        const std::size_t name_begin = text.find('('), name_end = text.rfind(')');  // a program's name may hold spaces
        if (name_end == std::string::npos) continue;                                // it has ended since
        std::istringstream fields(text.substr(name_end + 1));
        std::vector<std::string> value(15);  // from field 3 on: state, parent, ..., user and system ticks at 14 and 15
        for (std::string& each : value) fields >> each;
        processes[std::stol(name)] = {std::stol(value[1]),
                                      {text.substr(name_begin + 1, name_end - name_begin - 1),
                                       (std::stod(value[11]) + std::stod(value[12])) / ticks, peak_memory_of(entry.path())}};
    }
    const auto descends = [&](long id) {
        while (processes.count(id) != 0) {
            id = processes.at(id).parent;
            if (id == getpid()) return true;
        }
        return false;
    };
    std::vector<Descendant> found;
    for (const auto& [id, process] : processes)
        if (descends(id)) found.push_back(process.use);
    return found;
}

double core_seconds(const std::vector<Descendant>& processes) {
    double sum = 0.0;
    for (const Descendant& process : processes) sum += process.core_seconds;
    return sum;
}

}  // namespace cutterflow::validation
