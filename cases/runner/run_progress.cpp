#include "cases/runner/run_progress.hpp"

#include <cstdlib>

#include <fmt/format.h>

namespace cutterflow::cases {

std::optional<double> simulated_time(const std::string& line) {
    static const std::string lead = "Time = ";
    if (line.compare(0, lead.size(), lead) != 0) return std::nullopt;
    const char* begin = line.c_str() + lead.size();
    char* end = nullptr;
    const double time = std::strtod(begin, &end);
    if (end == begin || (*end != '\0' && *end != 's' && *end != ' ' && *end != '\r')) return std::nullopt;
    return time;
}

RunProgress::RunProgress(const Study& study) : end_time_(study.end_time()), period_(study.period()), progress_("  run") {}

void RunProgress::take(const std::string& line) {
    const std::optional<double> time = simulated_time(line);
    if (time) progress_.update(*time / end_time_, fmt::format("{:.3f} of {:g} revolutions", *time / period_, end_time_ / period_));
}

void RunProgress::finish() {
    progress_.finish();
}

void TimeProgress::take(const std::string& line) {
    if (const std::optional<double> time = simulated_time(line))
        progress_.update(*time / end_time_, fmt::format("{:.4g} of {:g} s", *time, end_time_));
}

void keep_older_log(const std::filesystem::path& log) {
    if (!std::filesystem::exists(log)) return;
    for (int i = 1;; ++i) {
        std::filesystem::path kept = log;
        kept += fmt::format(".{}", i);
        if (std::filesystem::exists(kept)) continue;
        std::filesystem::rename(log, kept);
        return;
    }
}

}  // namespace cutterflow::cases
