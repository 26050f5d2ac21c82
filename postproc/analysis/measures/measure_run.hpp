#pragma once
/// \file The measures of a finished run: measures.json says what is measured, report/measures.json has the results.
#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace cutterflow::postproc {

inline constexpr const char* k_measures = "measures.json";                ///< of a run directory: what is measured
inline constexpr const char* k_measure_results = "report/measures.json";  ///< of a run directory: what was found

/// Whether a run directory says what is measured in it.
bool has_measures(const std::filesystem::path& run_directory);

/// Measures a run: an object with one result for each measure, {what, value, unit, standard_error, detail, series}; value and
/// standard_error may be null.
/// \param name  of the only measure to make; absent: all
/// \throws UserError  with all mistakes of measures.json, or of all measures that the run's files do not allow
nlohmann::json measure_run(const std::filesystem::path& run_directory, const std::optional<std::string>& name = std::nullopt);

/// Writes report/measures.json anew. With a name the results of other measures stay as they are.
/// \return all results
nlohmann::json write_measures(const std::filesystem::path& run_directory, const std::optional<std::string>& name = std::nullopt);

/// As write_measures, for the report of a run that is done: a measure that the run's files do not allow has no value, and its
/// `detail.reason` says why.
/// \throws UserError  with all mistakes of measures.json
nlohmann::json write_possible_measures(const std::filesystem::path& run_directory);

/// The results of report/measures.json. \throws UserError  when there are none
nlohmann::json read_measures(const std::filesystem::path& run_directory);

/// One line for each result: name, value with its standard error, unit; the reason where there is no value.
std::string measures_text(const nlohmann::json& results);

/// "0.95 +- 0.04 kg"; a dash without a value.
std::string measure_value_text(const nlohmann::json& result);

}  // namespace cutterflow::postproc
