#pragma once
/// \file Tables (CSV) of a run directory, joined over the restarts of the run.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace cutterflow::postproc {

/// Requirements of a reader on a table. Columns beyond these are read as numbers too when their name is not in `texts`.
struct TableRules {
    std::vector<std::string> numbers;       ///< required columns of finite numbers
    std::vector<std::string> texts;         ///< required columns of text
    std::vector<std::string> may_be_empty;  ///< of `numbers`: an empty field or nan is allowed and read as NaN
    std::string remedy;                     ///< what a user does when a column is missing
    std::vector<std::string> whole{};       ///< of `numbers`: 0 to 2147483647, without a fraction
};

/// Columns of equal length.
class Table {
public:
    std::size_t rows() const { return rows_; }
    bool empty() const { return rows_ == 0; }
    const std::vector<std::string>& columns() const { return columns_; }  ///< in the file's order
    bool has(const std::string& column) const { return numbers_.count(column) > 0 || texts_.count(column) > 0; }
    /// \throws std::out_of_range  when there is no such column (the rules make sure of the required ones)
    const std::vector<double>& number(const std::string& column) const { return numbers_.at(column); }
    const std::vector<std::string>& text(const std::string& column) const { return texts_.at(column); }
    /// One field as text, whatever the column's kind.
    std::string field(const std::string& column, std::size_t row) const;

    /// Keeps the rows for which `keep` (one per row) holds.
    void keep_rows(const std::vector<bool>& keep);
    /// Appends the rows of a table with the same columns.
    void append(const Table& other);

private:
    friend Table read_table(const std::filesystem::path& file, const TableRules& rules, bool is_finished);
    std::size_t rows_ = 0;
    std::vector<std::string> columns_;
    std::map<std::string, std::vector<double>> numbers_;
    std::map<std::string, std::vector<std::string>> texts_;
};

/// Reads one CSV file with a header line. A last line without a newline is what a killed run left behind and does not count.
/// \throws UserError  when the file cannot be read, a required column is missing, a line has another number of fields than the header, or
///                    a field is not a finite number or not a whole one where it must be; names file, line and column, every missing column
///                    at once
/// \param is_finished  nothing more is written: an empty file and a last line without a newline are mistakes
Table read_table(const std::filesystem::path& file, const TableRules& rules, bool is_finished = false);

/// The folders `<t0>` of postProcessing/<what> of a run, by increasing start time. Other entries are ignored.
std::vector<std::pair<double, std::filesystem::path>> start_folders(const std::filesystem::path& run_directory, const std::string& what);

/// The table `file` of postProcessing/<what> joined over all `<t0>` folders that have it, by its column `time_s`: rows of an earlier folder
/// later than the next start time are dropped; a row at the start time itself stays unless the later folder has the same one (equal in
/// time and in all columns named in `identity`). Empty table when no folder has the file.
/// \throws UserError  as read_table, when the folders' files have different columns, and when the file of a start that came to its end
///                    (its cost.json is there) is empty or ends within a line
Table read_joined_table(const std::filesystem::path& run_directory, const std::string& what, const std::string& file,
                        const TableRules& rules, const std::vector<std::string>& identity = {});

}  // namespace cutterflow::postproc
