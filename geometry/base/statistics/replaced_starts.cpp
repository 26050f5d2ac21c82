#include "geometry/base/statistics/replaced_starts.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/csv_table.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_file = "replaced_starts.csv";

/// Sum of a column; 0 when the table has none. \param mistakes  rows that cannot be read are left out and told
double sum_of(const fs::path& file, const std::string& column, const std::vector<std::string>& others, std::vector<Mistake>& mistakes) {
    const CsvTable table(file, {column}, others, mistakes);
    double sum = 0.0;
    for (std::size_t row = 0; table.has(column) && row < table.rows(); ++row) sum += table.at(row, column);
    return sum;
}

/// [s] What a damaged table does not tell is not counted: a start does not fail for it.
double core_seconds_of(const fs::path& start, int ranks) {
    if (fs::exists(start / "cost.json")) {
        const auto summary = nlohmann::json::parse(read_file(start / "cost.json"), nullptr, false);
        if (summary.is_object() && summary.contains("core_s") && summary["core_s"].is_number()) return summary["core_s"].get<double>();
    }
    std::vector<Mistake> damage;
    return fs::exists(start / "cost.csv") ? ranks * sum_of(start / "cost.csv", "step_s", {}, damage) : 0.0;
}

}  // namespace

void note_replaced_start(const fs::path& case_folder, const fs::path& start, int ranks) {
    const double core_s = core_seconds_of(start, ranks);
    if (core_s <= 0.0) return;
    const fs::path file = case_folder / k_file;
    const std::string before = fs::exists(file) ? read_file(file) : "start_s,core_s\n";
    write_file(file, before + fmt::format("{},{:.6g}\n", start.filename().string(), core_s));
}

double replaced_core_seconds(const fs::path& case_folder) {
    const fs::path file = case_folder / k_file;
    if (!fs::exists(file)) return 0.0;
    std::vector<Mistake> mistakes;
    const double sum = sum_of(file, "core_s", {"start_s"}, mistakes);
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return sum;
}

}  // namespace cutterflow
