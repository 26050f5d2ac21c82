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

constexpr const char* k_digits = "0123456789";

/// Whether a name is a time as OpenFOAM writes one: "0", "0.25", "1e-05". A day ("2026-11-29") is none, nor is "e", "-", "nan" or "0x1".
bool is_time(const std::string& name) {
    if (name.find_first_of(k_digits) != 0 || name.find_first_not_of("0123456789.e+-") != std::string::npos) return false;
    char* end = nullptr;
    std::strtod(name.c_str(), &end);
    return *end == '\0';
}

/// "processor0", "processor1", ...
bool is_of_a_rank(const std::string& name) {
    const std::string word = "processor";
    return name.size() > word.size() && name.rfind(word, 0) == 0 && name.find_first_not_of(k_digits, word.size()) == std::string::npos;
}

}  // namespace

std::vector<fs::path> time_folders(const fs::path& root) {
    std::map<double, fs::path> found;
    if (!fs::is_directory(root)) return {};
    for (const auto& entry : fs::directory_iterator(root))
        if (entry.is_directory() && is_time(entry.path().filename().string())) found[time_of(entry.path())] = entry.path();
    std::vector<fs::path> folders;
    folders.reserve(found.size());
    for (const auto& [time, folder] : found) folders.push_back(folder);
    return folders;
}

std::vector<fs::path> processor_folders(const fs::path& case_folder) {
    std::vector<fs::path> folders;
    for (const auto& entry : fs::directory_iterator(case_folder))
        if (entry.is_directory() && is_of_a_rank(entry.path().filename().string())) folders.push_back(entry.path());
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
    std::vector<fs::path> roots = processor_folders(case_folder);
    roots.push_back(case_folder);
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
