#include "cases/runner/disk_space.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

constexpr double k_nothing = 1e5;  // [bytes]: less than any field or checkpoint

std::string size_text(double bytes) {
    return bytes >= 1e9 ? fmt::format("{:.3g} GB", 1e-9 * bytes) : fmt::format("{:.3g} MB", 1e-6 * bytes);
}

/// Bytes of the files of a folder; those that vanish meanwhile do not count.
double bytes_below(const fs::path& folder) {
    double sum = 0.0;
    std::error_code failed;
    for (auto entry = fs::recursive_directory_iterator(folder, failed); !failed && entry != fs::recursive_directory_iterator();
         entry.increment(failed)) {
        const auto size = entry->is_regular_file(failed) ? entry->file_size(failed) : 0;
        if (!failed) sum += static_cast<double>(size);
        failed.clear();
    }
    return sum;
}

}  // namespace

double free_bytes(const fs::path& folder) {
    fs::path there = fs::absolute(folder);
    while (!fs::exists(there)) there = there.parent_path();
    return static_cast<double>(fs::space(there).available);
}

std::optional<Mistake> missing_space(const fs::path& folder, double needed) {
    const double free = free_bytes(folder);
    if (free >= needed) return std::nullopt;
    return Mistake{"", fmt::format("the disk of {} has {} free", folder.string(), size_text(free)),
                   fmt::format("The run is predicted to write about {}", size_text(needed)),
                   "Free space, choose a folder on another disk with -o, or write less (run.write_interval_s)"};
}

void require_free_bytes(const fs::path& folder, double needed) {
    if (const std::optional<Mistake> missing = missing_space(folder, needed)) throw UserError(std::vector<Mistake>{*missing});
}

bool is_disk_full(const fs::path& folder) {
    return free_bytes(folder) < k_nothing;
}

Mistake full_disk(const fs::path& folder, double needed) {
    const double written = bytes_below(folder);
    if (needed <= 0.0)
        return {"", fmt::format("the disk of {} is full", folder.string()), "A run writes its mesh, fields and tables there",
                "Free space and repeat the command (with --resume once it runs), or choose a folder on another disk with -o"};
    return {
        "",
        fmt::format("the disk of {} is full: {} are written, {} free", folder.string(), size_text(written), size_text(free_bytes(folder))),
        fmt::format("The run is predicted to write about {} in all, {} more", size_text(needed),
                    size_text(std::max(0.0, needed - written))),
        "Free space and use --resume; results are kept up to the last checkpoint"};
}

void refuse_full_disk(const fs::path& folder) {
    if (is_disk_full(folder)) throw ToolError(full_disk(folder, 0.0));
}

}  // namespace cutterflow::cases
