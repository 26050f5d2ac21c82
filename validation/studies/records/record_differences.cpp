/// \file record_differences: what changed between two sets of records of verification cases, as a Markdown page.
///
///     record_differences <folder with the older *.json> <folder with the newer ones>
///
/// A difference is measured in tolerances: |new - old| over the tolerance in the quantity's unit. Rows with more than a tenth of a
/// tolerance are listed, and all whose verdict changed.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "validation/harness/suite/case_results.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr double k_listed = 0.1;  // tolerances

std::map<std::string, VerifiedCase> records(const fs::path& folder) {
    if (!fs::is_directory(folder))
        throw UserError(folder.string() + " is no folder", "Two folders with records of cases are compared",
                        "Name a copy of docs/results/validation");
    std::map<std::string, VerifiedCase> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() != ".json") continue;
        VerifiedCase record = case_from_json(read_file(entry.path()), entry.path().string());
        found.emplace(record.name, std::move(record));
    }
    return found;
}

/// The tolerance in the quantity's unit; none where nothing is judged or the tolerance is zero.
std::optional<double> tolerance_in_unit(const VerifiedQuantity& quantity) {
    if (!quantity.tolerance || *quantity.tolerance == 0.0) return std::nullopt;
    if (quantity.rule == Rule::relative) return std::abs(*quantity.tolerance * quantity.reference.value_or(0.0));
    return std::abs(*quantity.tolerance);
}

std::string number(const std::optional<double>& value) {
    return value ? fmt::format("{:.6g}", *value) : "-";
}

struct Differences {
    int same = 0, gone = 0, added = 0, unjudged = 0;
    double largest = 0.0;  ///< tolerances
    std::vector<std::string> rows;
};

void compare(const std::string& name, const VerifiedQuantity& before, const VerifiedQuantity& now, Differences& differences) {
    ++differences.same;
    const std::optional<double> tolerance = tolerance_in_unit(now);
    const bool measurable = tolerance && *tolerance > 0.0 && before.value && now.value;
    if (!measurable) ++differences.unjudged;
    const double moved = measurable ? std::abs(*now.value - *before.value) / *tolerance : 0.0;
    differences.largest = std::max(differences.largest, moved);
    if (moved <= k_listed && before.verdict == now.verdict) return;
    differences.rows.push_back(fmt::format("| {} | {} | {} | {} | {} | {} | {} |", name, now.name, number(before.value), number(now.value),
                                           now.unit, measurable ? fmt::format("{:.2g}", moved) : "-",
                                           before.verdict == now.verdict
                                               ? verdict_text(now.verdict)
                                               : fmt::format("**{} -> {}**", verdict_text(before.verdict), verdict_text(now.verdict))));
}

Differences compare(const VerifiedCase& before, const VerifiedCase& now) {
    std::map<std::string, const VerifiedQuantity*> old;
    for (const VerifiedQuantity& quantity : before.quantities) old.emplace(quantity.name, &quantity);
    Differences differences;
    for (const VerifiedQuantity& quantity : now.quantities) {
        const auto found = old.find(quantity.name);
        if (found == old.end())
            ++differences.added;
        else
            compare(now.name, *found->second, quantity, differences);
    }
    differences.gone = static_cast<int>(old.size()) - differences.same;
    return differences;
}

void print_page(const std::map<std::string, VerifiedCase>& before, const std::map<std::string, VerifiedCase>& now) {
    std::vector<std::string> rows;
    fmt::print(
        "| case | before | now | in both | without a tolerance | gone | added | largest difference, tolerances "
        "|\n|---|---|---|---|---|---|---|---|\n");
    for (const auto& [name, record] : now) {
        const auto old = before.find(name);
        if (old == before.end()) continue;
        const Differences found = compare(old->second, record);
        fmt::print("| {} | {} | {} | {} | {} | {} | {} | {:.2g} |\n", name, old->second.date, record.date, found.same, found.unjudged,
                   found.gone, found.added, found.largest);
        rows.insert(rows.end(), found.rows.begin(), found.rows.end());
    }
    fmt::print("\n| case | quantity | before | now | unit | difference, tolerances | verdict |\n|---|---|---|---|---|---|---|\n");
    for (const std::string& row : rows) fmt::print("{}\n", row);
    for (const auto& [name, record] : before)
        if (now.count(name) == 0) fmt::print("\n{} is not among the newer records.\n", name);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "usage: record_differences <folder of older records> <folder of newer records>\n");
        return static_cast<int>(ExitCode::user_input);
    }
    try {
        print_page(records(argv[1]), records(argv[2]));
    } catch (const Failure& failure) {
        fmt::print(stderr, "record_differences: {}\n", failure.what());
        return static_cast<int>(failure.code());
    }
    return 0;
}
