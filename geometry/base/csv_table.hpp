#pragma once
/// \file CSV files of numbers and words with one header line; all mistakes are reported together.
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/base/error.hpp"

namespace cutterflow {

/// The fields of a CSV file by column. Empty lines and lines that begin with # are left out.
class CsvTable {
public:
    /// Reads the columns `required` (all) and `optional` (those present); others are refused.
    /// Mistakes (file not readable, column missing or unknown, field missing or not a number) are appended to `mistakes`; rows with
    /// mistakes are left out. Fields of the optional columns `words` are words, all others numbers.
    CsvTable(const std::filesystem::path& file, const std::vector<std::string>& required, const std::vector<std::string>& optional,
             std::vector<Mistake>& mistakes, const std::vector<std::string>& words = {});

    std::size_t rows() const { return lines_.size(); }
    bool has(const std::string& column) const;
    double at(std::size_t row, const std::string& column) const;
    const std::string& word(std::size_t row, const std::string& column) const;
    /// "file:line" of a row.
    std::string where(std::size_t row) const;

private:
    std::size_t index(const std::string& column) const;

    std::string name_;
    std::vector<std::string> columns_;
    std::vector<std::vector<double>> values_;       // [row][column]; of words 0
    std::vector<std::vector<std::string>> fields_;  // as they stand in the file
    std::vector<int> lines_;
};

}  // namespace cutterflow
