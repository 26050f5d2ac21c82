#pragma once
/// \file Numeric CSV files with one header line; all mistakes are reported together.
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/base/error.hpp"

namespace cutterflow {

/// The numbers of a CSV file by column. Empty lines and lines that begin with # are left out.
class CsvTable {
public:
    /// Reads the columns `required` (all) and `optional` (those present); others are refused.
    /// Mistakes (file not readable, column missing or unknown, field missing or not a number) are appended to `mistakes`; rows with
    /// mistakes are left out.
    CsvTable(const std::filesystem::path& file, const std::vector<std::string>& required, const std::vector<std::string>& optional,
             std::vector<Mistake>& mistakes);

    std::size_t rows() const { return lines_.size(); }
    bool has(const std::string& column) const;
    double at(std::size_t row, const std::string& column) const;
    /// "file:line" of a row.
    std::string where(std::size_t row) const;

private:
    std::size_t index(const std::string& column) const;

    std::string name_;
    std::vector<std::string> columns_;
    std::vector<std::vector<double>> values_;  // [row][column]
    std::vector<int> lines_;
};

}  // namespace cutterflow
