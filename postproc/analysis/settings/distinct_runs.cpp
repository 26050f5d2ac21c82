#include "postproc/analysis/settings/distinct_runs.hpp"

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::postproc {

void require_distinct(const std::vector<std::filesystem::path>& runs, const std::function<bool(std::size_t, std::size_t)>& is_copy,
                      const std::string& differ_by) {
    namespace fs = std::filesystem;
    const auto same = [&](std::size_t a, std::size_t b) {
        return (fs::exists(runs[a]) && fs::exists(runs[b]) && fs::equivalent(runs[a], runs[b])) || (is_copy && is_copy(a, b));
    };
    std::vector<Mistake> mistakes;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        std::size_t other = 0;
        while (other < i && !same(other, i)) ++other;
        if (other == i) continue;
        mistakes.push_back({"", fmt::format("{} is the same run as {}", runs[i].string(), runs[other].string()),
                            fmt::format("Repeats of a setting differ by {}, as `cutterflow sweep --repeats` makes them", differ_by),
                            "Name each run once"});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

}  // namespace cutterflow::postproc
