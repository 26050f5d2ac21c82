#include "cases/runner/run_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/statistics/replaced_starts.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_overrides = "overrides";
constexpr const char* k_lock = ".lock";

}  // namespace

void require_openfoam_path(const fs::path& path) {
    const std::string text = path.string();
    const std::size_t bad = text.find_first_of(" \t\n\r\"'`\\$(){}[];#*?|<>&!%");
    if (bad == std::string::npos) return;
    throw UserError(fmt::format("the folder \"{}\" has '{}' in its path", text, text[bad]),
                    "OpenFOAM and LIGGGHTS accept no paths with spaces, quotes, brackets, % or other shell characters",
                    "Choose a path of letters, digits, '-', '_', '.' and '/' with -o");
}

bool may_hold_a_run(const fs::path& path) {
    if (fs::exists(path / names::manifest)) return true;
    return std::all_of(fs::directory_iterator(path), fs::directory_iterator(), [](const fs::directory_entry& entry) {
        return entry.path().filename() == k_overrides || entry.path().filename() == k_lock;
    });
}

bool holds_files(const fs::path& folder) {
    if (!fs::is_directory(folder)) return fs::exists(folder);
    return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(),
                       [](const fs::directory_entry& entry) { return entry.path().filename() != k_lock; });
}

namespace {

/// Processes that hold a file open, as "cutterFoam, process 1234"; empty when that cannot be seen.
std::string holders_of(const fs::path& file) {
    std::vector<std::string> holders;
    std::error_code unreadable;
    for (const fs::directory_entry& process : fs::directory_iterator("/proc", unreadable)) {
        const std::string pid = process.path().filename().string();
        if (pid.find_first_not_of("0123456789") != std::string::npos || pid == std::to_string(::getpid())) continue;
        for (fs::directory_iterator open(process.path() / "fd", unreadable); !unreadable && open != fs::directory_iterator();
             open.increment(unreadable)) {
            std::error_code gone;
            if (fs::read_symlink(open->path(), gone) != file) continue;
            std::ifstream name(process.path() / "comm");
            std::string program;
            std::getline(name, program);
            holders.push_back(fmt::format("{}, process {}", program, pid));
            break;
        }
        unreadable.clear();
    }
    return fmt::format("{}", fmt::join(holders, "; "));
}

int take_lock(const fs::path& path) {
    // Without O_CLOEXEC: children keep the lock.
    const int lock = ::open((path / k_lock).c_str(), O_RDWR | O_CREAT, 0666);
    if (lock < 0)
        throw UserError(fmt::format("cannot write to {}: {}", path.string(), std::strerror(errno)),
                        "A folder is locked while it is worked with, also while it is read: it must be writable",
                        "Make it writable, or copy it to a place that is");
    if (::flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
    ::close(lock);
    const std::string holders = holders_of(fs::canonical(path) / k_lock);
    throw UserError(fmt::format("{} is in use by another process{}", path.string(), holders.empty() ? "" : fmt::format(" ({})", holders)),
                    "Only one process may work in a folder", "Wait for it, end it, or use another folder");
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : lock_(take_lock(folder)) {}

FolderLock::~FolderLock() {
    ::close(lock_);
}

void require_usable_run_directory(const fs::path& path) {
    require_openfoam_path(fs::absolute(path).lexically_normal());
    if (!fs::is_directory(path) || may_hold_a_run(path)) return;
    throw UserError(fmt::format("{} contains files but no {}", path.string(), names::manifest),
                    "A run directory is empty or made by cutterflow; nothing is overwritten", "Choose another with -o");
}

void require_start_donor(const fs::path& folder) {
    if (fs::is_directory(folder) && may_hold_a_run(folder)) return;
    throw UserError(fmt::format("--start-from {} {}", folder.string(), fs::exists(folder) ? "is no run directory" : "does not exist"),
                    fmt::format("It has a {}: its frozen-rotor flow or bed is reused", names::manifest),
                    "Correct the path, or leave --start-from out");
}

RunDirectory::RunDirectory(const fs::path& path) : path_(fs::absolute(path).lexically_normal()) {
    require_usable_run_directory(path_);
    std::error_code failed;
    fs::create_directories(path_, failed);
    if (failed || !fs::is_directory(path_))
        throw UserError(fmt::format("{} cannot be a run directory", path_.string()), "It must be a folder that exists or can be created",
                        "Choose another with -o");
    lock_.emplace(path_);
}

void remove_unfinished_run(const fs::path& directory) {
    std::vector<fs::path> left = processor_folders(directory);
    const int ranks = std::max(1, static_cast<int>(left.size()));
    for (const fs::path& start : time_folders(directory / "postProcessing/cost")) note_replaced_start(directory, start, ranks);
    for (const fs::path& folder : time_folders(directory))
        if (std::strtod(folder.filename().c_str(), nullptr) > 0.0) left.push_back(folder);
    for (const char* name : {"postProcessing", names::checkpoints})
        if (fs::is_directory(directory / name)) left.push_back(directory / name);
    for (const fs::path& folder : left) fs::remove_all(folder);
}

std::vector<std::string> files_below(const fs::path& root, const std::string& folder) {
    std::vector<std::string> files;
    if (!fs::is_directory(root / folder)) return files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
        if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(root).string());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::string> RunDirectory::overrides() const {
    std::vector<std::string> files = files_below(path_, k_overrides);
    for (std::string& file : files) file = fs::path(file).lexically_relative(k_overrides).string();
    return files;
}

std::vector<std::string> RunDirectory::apply_overrides(std::vector<std::string> files) const {
    for (const std::string& relative : files) {
        fs::create_directories(file(relative).parent_path());
        fs::copy_file(path_ / k_overrides / relative, file(relative), fs::copy_options::overwrite_existing);
    }
    return files;
}

}  // namespace cutterflow::cases
