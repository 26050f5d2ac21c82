#pragma once
/// \file Reference data of the verification cases.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace cutterflow::validation {

/// A column that a case reads: its name and the unit that it must have.
struct ReferenceColumn {
    std::string name, unit;
};

struct ReferenceTable {
    std::string source;  ///< key in docs/references.bib
    std::map<std::string, std::vector<double>> columns;
    std::size_t rows() const { return columns.empty() ? 0 : columns.begin()->second.size(); }
    const std::vector<double>& at(const std::string& column) const { return columns.at(column); }
};

/// A file of validation/cases: "impacts/kharaz.csv".
std::filesystem::path case_file(const std::string& name);

/// Reads `# source: <key>`, further lines of comment, one line of columns as `speed [m/s],restitution [-]` and rows of numbers.
/// \throws UserError  with every mistake: no known source, a column without a unit, a wanted column that is missing or in another unit,
///                    a field that is no number
ReferenceTable read_reference(const std::filesystem::path& file, const std::vector<ReferenceColumn>& wanted);

/// \throws UserError  when the key is neither "exact" nor in docs/references.bib; `where` names what has it
void require_source(const std::string& key, const std::string& where);

}  // namespace cutterflow::validation
