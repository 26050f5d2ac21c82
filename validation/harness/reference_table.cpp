#include "validation/harness/reference_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_source = "# source: ";

std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
}

/// "speed [m/s]" in its two parts; no unit when there are no brackets.
ReferenceColumn column_of(const std::string& text) {
    const std::size_t open = text.find(" [");
    if (open == std::string::npos || text.back() != ']') return {text, ""};
    return {text.substr(0, open), text.substr(open + 2, text.size() - open - 3)};
}

bool is_known(const std::string& key) {
    return !key.empty() && read_file(installation().data / "docs/references.bib").find("{" + key + ",") != std::string::npos;
}

void check_columns(const std::string& where, const std::vector<ReferenceColumn>& there, const std::vector<ReferenceColumn>& wanted,
                   std::vector<Mistake>& mistakes) {
    for (const ReferenceColumn& column : there)
        if (column.unit.empty())
            mistakes.push_back({where, fmt::format("column \"{}\" has no unit", column.name),
                                "A column is written as \"speed [m/s]\", a bare number as \"restitution [-]\"", "Add the unit"});
    for (const ReferenceColumn& column : wanted) {
        const auto found = std::find_if(there.begin(), there.end(), [&](const ReferenceColumn& c) { return c.name == column.name; });
        if (found == there.end())
            mistakes.push_back(
                {where, fmt::format("there is no column \"{} [{}]\"", column.name, column.unit), "The case reads it", "Add the column"});
        else if (!found->unit.empty() && found->unit != column.unit)
            mistakes.push_back({where, fmt::format("column \"{}\" is in [{}]", column.name, found->unit),
                                fmt::format("The case reads it in [{}]", column.unit), "Convert the column"});
    }
}

}  // namespace

fs::path case_file(const std::string& name) {
    return installation().data / "validation/cases" / name;
}

ReferenceTable read_reference(const fs::path& file, const std::vector<ReferenceColumn>& wanted) {
    ReferenceTable table;
    std::vector<Mistake> mistakes;
    std::vector<ReferenceColumn> columns;
    std::istringstream stream(read_file(file));
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        if (!line.empty() && line.back() == '\r') line.pop_back();
        const std::string where = fmt::format("{}:{}", file.string(), number);
        if (line.rfind(k_source, 0) == 0) table.source = line.substr(std::string(k_source).size());
        if (line.empty() || line.front() == '#') continue;
        const std::vector<std::string> fields = fields_of(line);
        if (columns.empty()) {
            for (const std::string& field : fields) columns.push_back(column_of(field));
            check_columns(where, columns, wanted, mistakes);
            continue;
        }
        if (fields.size() != columns.size())
            mistakes.push_back({where, fmt::format("{} fields", fields.size()), fmt::format("There are {} columns", columns.size()),
                                "Write one number a column"});
        for (std::size_t i = 0; i < std::min(fields.size(), columns.size()); ++i) {
            char* end = nullptr;
            const double value = std::strtod(fields[i].c_str(), &end);
            table.columns[columns[i].name].push_back(value);
            if (end == fields[i].c_str() || *end != '\0' || !std::isfinite(value))
                mistakes.push_back({where, fmt::format("\"{}\" in column \"{}\"", fields[i], columns[i].name), "It must be a finite number",
                                    "Correct it"});
        }
    }
    if (columns.empty()) mistakes.push_back({file.string(), "there are no columns", "One line names them", "Write it"});
    if (!columns.empty() && table.columns.empty())
        mistakes.push_back({file.string(), "there are no numbers", "One line below the names is one point of the reference", "Write them"});
    if (!is_known(table.source))
        mistakes.push_back({file.string(), fmt::format("source \"{}\"", table.source),
                            "A line \"# source: <key>\" names an entry of docs/references.bib", "Add the line, or the entry"});
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return table;
}

void require_source(const std::string& key, const std::string& where) {
    if (key == "exact" || is_known(key)) return;
    throw UserError(fmt::format("source \"{}\" of {}", key, where), "A source is a key in docs/references.bib, or \"exact\"",
                    "Add the entry");
}

}  // namespace cutterflow::validation
