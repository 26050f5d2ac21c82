#include "geometry/base/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace cutterflow {
namespace {

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields;
    std::size_t begin = 0;
    for (std::size_t comma = line.find(','); comma != std::string::npos; comma = line.find(',', begin)) {
        fields.push_back(trimmed(line.substr(begin, comma - begin)));
        begin = comma + 1;
    }
    fields.push_back(trimmed(line.substr(begin)));
    return fields;
}

bool parse(const std::string& field, double& value) {
    char* end = nullptr;
    value = std::strtod(field.c_str(), &end);
    return !field.empty() && *end == '\0' && std::isfinite(value);
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& file, const std::vector<std::string>& required, const std::vector<std::string>& optional,
                   std::vector<Mistake>& mistakes, const std::vector<std::string>& words)
    : name_(file.string()) {
    std::ifstream stream(file);
    std::string line;
    int number = 0;
    /// The next line that is neither empty nor a comment.
    const auto next_line = [&] {
        while (std::getline(stream, line)) {
            ++number;
            if (const std::string text = trimmed(line); !text.empty() && text.front() != '#') return true;
        }
        return false;
    };
    if (!stream || !next_line()) {
        mistakes.push_back({name_, "the file cannot be read or is empty",
                            fmt::format("It must hold the columns {}", fmt::join(required, ",")),
                            "Check the file, and the path that names it"});
        return;
    }
    const int header = number;
    columns_ = split(line);
    if (columns_.size() == 1 && line.find_first_of(";\t") != std::string::npos) {
        mistakes.push_back({fmt::format("{}:{}", name_, header), fmt::format("the header \"{}\" has no comma", trimmed(line)),
                            "Columns are separated by commas, and numbers have a decimal point",
                            "Write the file with commas; a spreadsheet offers it where it saves as CSV"});
        columns_.clear();
        return;
    }
    for (const std::string& column : required)
        if (!has(column))
            mistakes.push_back({fmt::format("{}:{}", name_, header), fmt::format("column '{}' is missing", column),
                                fmt::format("The header line must name {}", fmt::join(required, ",")), "Add the column"});
    const auto among = [](const std::vector<std::string>& names, const std::string& column) {
        return std::find(names.begin(), names.end(), column) != names.end();
    };
    std::vector<std::string> extra = optional;
    extra.insert(extra.end(), words.begin(), words.end());
    for (const std::string& column : columns_)
        if (!among(required, column) && !among(extra, column))
            mistakes.push_back({fmt::format("{}:{}", name_, header), fmt::format("column '{}' is not known", column),
                                fmt::format("Columns are {}{}{}", fmt::join(required, ","), extra.empty() ? "" : " and optionally ",
                                            fmt::join(extra, ",")),
                                "Rename or remove it"});
    while (next_line()) {
        const std::vector<std::string> fields = split(line);
        std::vector<double> row(columns_.size());
        bool good = fields.size() == columns_.size();
        if (!good)
            mistakes.push_back({fmt::format("{}:{}", name_, number), fmt::format("{} fields instead of {}", fields.size(), columns_.size()),
                                "Every line needs one field per column of the header", "Complete the line"});
        for (std::size_t i = 0; good && i < fields.size(); ++i)
            if (!among(words, columns_[i]) && !parse(fields[i], row[i])) {
                mistakes.push_back({fmt::format("{}:{}", name_, number), fmt::format("{} = '{}' is not a number", columns_[i], fields[i]),
                                    "Fields are finite numbers with a decimal point", "Correct the field"});
                good = false;
            }
        if (!good) continue;
        values_.push_back(std::move(row));
        fields_.push_back(fields);
        lines_.push_back(number);
    }
}

bool CsvTable::has(const std::string& column) const {
    return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::size_t CsvTable::index(const std::string& column) const {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    if (found == columns_.end()) throw std::out_of_range("no column " + column);
    return static_cast<std::size_t>(found - columns_.begin());
}

double CsvTable::at(std::size_t row, const std::string& column) const {
    return values_.at(row)[index(column)];
}

const std::string& CsvTable::word(std::size_t row, const std::string& column) const {
    return fields_.at(row)[index(column)];
}

std::string CsvTable::where(std::size_t row) const {
    return fmt::format("{}:{}", name_, lines_.at(row));
}

}  // namespace cutterflow
