#include "geometry/base/checkpoint_folders.hpp"

#include <cstdlib>
#include <map>
#include <string>

#include "geometry/base/run_files.hpp"

namespace cutterflow {
namespace {

namespace fs = std::filesystem;

double time_of(const fs::path& folder) {
    return std::strtod(folder.filename().c_str(), nullptr);
}

}  // namespace

std::vector<fs::path> time_folders(const fs::path& root) {
    std::map<double, fs::path> found;
    if (!fs::is_directory(root)) return {};
    for (const auto& entry : fs::directory_iterator(root)) {
        const std::string name = entry.path().filename().string();
        char* end = nullptr;
        const double time = std::strtod(name.c_str(), &end);
        if (entry.is_directory() && end != name.c_str() && *end == '\0') found[time] = entry.path();
    }
    std::vector<fs::path> folders;
    folders.reserve(found.size());
    for (const auto& [time, folder] : found) folders.push_back(folder);
    return folders;
}

std::vector<fs::path> checkpoint_folders(const fs::path& case_folder) {
    return time_folders(case_folder / names::checkpoints);
}

fs::path newest_checkpoint(const fs::path& case_folder) {
    const auto found = checkpoint_folders(case_folder);
    return found.empty() ? fs::path() : found.back();
}

std::vector<fs::path> times_after_checkpoint(const fs::path& case_folder) {
    const fs::path newest = newest_checkpoint(case_folder);
    if (newest.empty()) return {};
    std::vector<fs::path> roots{case_folder};
    for (const auto& entry : fs::directory_iterator(case_folder))
        if (entry.is_directory() && entry.path().filename().string().rfind("processor", 0) == 0) roots.push_back(entry.path());
    std::vector<fs::path> later;
    // The checkpoint and the fluid's folder of its time carry the same name, so that their times compare exactly.
    for (const fs::path& root : roots)
        for (const fs::path& folder : time_folders(root))
            if (time_of(folder) > time_of(newest)) later.push_back(folder);
    return later;
}

void drop_times_after_checkpoint(const fs::path& case_folder) {
    for (const fs::path& folder : times_after_checkpoint(case_folder)) fs::remove_all(folder);
}

}  // namespace cutterflow
