#include "postproc/run/run_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow::postproc {
namespace {

bool contains(const std::vector<std::string>& list, const std::string& word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
        fields.push_back(line.substr(0, comma));
        line.remove_prefix(comma + 1);
    }
    fields.push_back(line);
    return fields;
}

/// Lines that end with a newline; a carriage return before it is not part of a line.
std::vector<std::string_view> complete_lines(std::string_view text) {
    std::vector<std::string_view> lines;
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
        std::string_view line = text.substr(0, end);
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        lines.push_back(line);
        text.remove_prefix(end + 1);
    }
    return lines;
}

double parse_number(std::string_view field, bool may_be_empty, const std::string& where, const std::string& column) {
    if (may_be_empty && (field.empty() || field == "nan" || field == "-nan")) return std::numeric_limits<double>::quiet_NaN();
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) {
        throw UserError(
            {{where, fmt::format("{} = \"{}\"", column, field), "The column has finite numbers", "Read the run's log at that time"}});
    }
    return value;
}

void require_whole(double value, const std::string& where, const std::string& column) {
    constexpr double largest = std::numeric_limits<int>::max();
    if (value >= 0.0 && value <= largest && value == std::floor(value)) return;
    throw UserError({{where, fmt::format("{} = {}", column, value), fmt::format("The column has whole numbers from 0 to {:.0f}", largest),
                      "Read the run's log at that time"}});
}

void require_columns(const std::vector<std::string>& columns, const TableRules& rules, const std::filesystem::path& file) {
    std::vector<Mistake> mistakes;
    for (const auto* required : {&rules.numbers, &rules.texts}) {
        for (const std::string& column : *required) {
            if (contains(columns, column)) continue;
            mistakes.push_back({file.string(), fmt::format("the column {} is missing", column),
                                fmt::format("The report needs it; the table has {}", fmt::join(columns, ", ")), rules.remedy});
        }
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

/// Two times are equal when they differ by less than the six digits of a folder's name resolve.
double time_tolerance(double time) {
    return 6e-6 * std::abs(time);
}

bool same_row(const Table& a, std::size_t i, const Table& b, std::size_t j, const std::vector<std::string>& identity) {
    const double time = a.number("time_s")[i];
    if (std::abs(time - b.number("time_s")[j]) > time_tolerance(time)) return false;
    return std::all_of(identity.begin(), identity.end(), [&](const std::string& column) {
        return contains(a.columns(), column) && a.field(column, i) == b.field(column, j);
    });
}

/// Drops from `earlier` what the folder that starts at `start` has replaced.
void drop_replaced_rows(Table& earlier, double start, const Table& later, const std::vector<std::string>& identity) {
    const std::vector<double>& time = earlier.number("time_s");
    std::vector<bool> keep(earlier.rows());
    for (std::size_t i = 0; i < keep.size(); ++i) {
        keep[i] = time[i] <= start + time_tolerance(start);
        for (std::size_t j = 0; keep[i] && j < later.rows() && later.number("time_s")[j] <= time[i] + time_tolerance(start); ++j) {
            keep[i] = !same_row(earlier, i, later, j, identity);
        }
    }
    earlier.keep_rows(keep);
}

/// \throws UserError  when the text of a finished table is empty or ends within a line
void require_whole(const std::string& text, const std::filesystem::path& file) {
    if (!text.empty() && text.back() == '\n') return;
    throw UserError({{file.string(), text.empty() ? "the table is empty" : "the table ends within a line",
                      "A run that came to its end has written all of its tables", "Copy the run directory again as a whole"}});
}

/// A start of a run writes its cost when all its tables are on the disk.
bool wrote_all_tables(const std::filesystem::path& run_directory, const std::filesystem::path& start_folder) {
    return std::filesystem::exists(run_directory / "postProcessing" / "cost" / start_folder.filename() / "cost.json");
}

}  // namespace

std::string Table::field(const std::string& column, std::size_t row) const {
    const auto text = texts_.find(column);
    return text != texts_.end() ? text->second.at(row) : fmt::format("{}", numbers_.at(column).at(row));
}

void Table::keep_rows(const std::vector<bool>& keep) {
    const auto filter = [&](auto& column) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < column.size(); ++i) {
            if (keep[i]) column[kept++] = column[i];
        }
        column.resize(kept);
    };
    for (auto& [name, column] : numbers_) filter(column);
    for (auto& [name, column] : texts_) filter(column);
    rows_ = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), true));
}

void Table::append(const Table& other) {
    for (auto& [name, column] : numbers_) column.insert(column.end(), other.number(name).begin(), other.number(name).end());
    for (auto& [name, column] : texts_) column.insert(column.end(), other.text(name).begin(), other.text(name).end());
    rows_ += other.rows_;
}

Table read_table(const std::filesystem::path& file, const TableRules& rules, bool is_finished) {
    const std::string text = read_file(file);
    if (is_finished) require_whole(text, file);
    const std::vector<std::string_view> lines = complete_lines(text);
    Table table;
    if (lines.empty()) return table;
    for (const std::string_view column : split(lines.front())) table.columns_.emplace_back(column);
    require_columns(table.columns_, rules, file);
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const std::string where = fmt::format("{}:{}", file.string(), i + 1);
        const std::vector<std::string_view> fields = split(lines[i]);
        if (fields.size() != table.columns_.size()) {
            throw UserError(
                {{where, fmt::format("the line has {} fields", fields.size()),
                  fmt::format("The header names {} columns", table.columns_.size()), "Restore the file from the run or remove the line"}});
        }
        for (std::size_t c = 0; c < fields.size(); ++c) {
            const std::string& column = table.columns_[c];
            if (contains(rules.texts, column)) {
                table.texts_[column].emplace_back(fields[c]);
            } else {
                const double value = parse_number(fields[c], contains(rules.may_be_empty, column), where, column);
                if (contains(rules.whole, column)) require_whole(value, where, column);
                table.numbers_[column].push_back(value);
            }
        }
        ++table.rows_;
    }
    for (const std::string& column : table.columns_) {
        if (contains(rules.texts, column)) {
            table.texts_[column];
        } else {
            table.numbers_[column];
        }
    }
    return table;
}

std::vector<std::pair<double, std::filesystem::path>> start_folders(const std::filesystem::path& run_directory, const std::string& what) {
    std::vector<std::pair<double, std::filesystem::path>> folders;
    const std::filesystem::path parent = run_directory / "postProcessing" / what;
    if (!std::filesystem::is_directory(parent)) return folders;
    for (const auto& entry : std::filesystem::directory_iterator(parent)) {
        const std::string name = entry.path().filename().string();
        double start = 0.0;
        const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), start);
        if (entry.is_directory() && error == std::errc{} && end == name.data() + name.size()) folders.emplace_back(start, entry.path());
    }
    std::sort(folders.begin(), folders.end());
    return folders;
}

Table read_joined_table(const std::filesystem::path& run_directory, const std::string& what, const std::string& file,
                        const TableRules& rules, const std::vector<std::string>& identity) {
    Table joined;
    for (const auto& [start, folder] : start_folders(run_directory, what)) {
        const Table table =
            std::filesystem::exists(folder / file) ? read_table(folder / file, rules, wrote_all_tables(run_directory, folder)) : Table{};
        if (joined.columns().empty()) {
            joined = table;
            continue;
        }
        // A restart replaces what came after it even when it was stopped before it wrote anything.
        drop_replaced_rows(joined, start, table, identity);
        if (table.columns().empty()) continue;
        if (table.columns() != joined.columns()) {
            throw UserError(
                fmt::format("{} has other columns than the same table of an earlier start of the run", (folder / file).string()),
                "A run must be continued by the version that started it", "Repeat the run with one version of cutterFoam");
        }
        joined.append(table);
    }
    return joined;
}

}  // namespace cutterflow::postproc
