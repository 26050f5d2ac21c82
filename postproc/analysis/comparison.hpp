#pragma once
/// \file Runs side by side: design against design, speed against speed, repeats as one with their scatter.
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "postproc/analysis/not_modelled.hpp"
#include "postproc/analysis/results.hpp"
#include "postproc/run/measured_points.hpp"

namespace cutterflow::postproc {

inline constexpr const char* k_comparison_schema = "cutterflow.comparison/1";
inline constexpr int k_fewest_repeats = 3;  ///< fewer do not determine the scatter

struct ComparedRun {
    RunData run;
    Results results;
};

/// A number and how well it is known.
struct Estimate {
    std::optional<double> value;
    std::optional<double> low, high;   ///< bounds: where it lies whatever the undecided rock does; absent where nothing is undecided
    std::optional<double> half_width;  ///< of the 95 % interval: Student's t over repeats, or batch means in time; absent without them
};

/// A whole number of things, which is shown with all its digits.
bool is_count(double value);

/// Runs of one setting: repeats that differ by placement and time of release only.
struct ComparedSetting {
    std::string label;
    std::vector<std::size_t> runs;  ///< indices in Comparison::runs, by seed
};

struct Quantity {
    std::string key;   ///< with its unit, as in results.json
    std::string name;  ///< markup
    std::string unit;
    bool of_rock = false;                        ///< repeats scatter: from k_fewest_repeats on the interval is theirs
    std::vector<Estimate> settings;              ///< one for each setting
    std::vector<std::vector<Estimate>> repeats;  ///< the runs of each setting, in its order
};

/// Whether a setting differs from the first one in a quantity.
enum class ComparisonVerdict {
    differs,       ///< interval and bounds of the difference exclude zero
    equal,         ///< the interval of the difference holds zero: not significant
    undecided,     ///< the bounds of the difference hold zero
    no_replicate,  ///< the bounds exclude zero, but nothing is known of the scatter
    no_interval,   ///< a quantity of the flow without an error in time: its average is too short for batches
};

struct Difference {
    Estimate estimate;  ///< setting less the first setting
    ComparisonVerdict verdict = ComparisonVerdict::no_replicate;
};

struct Comparison {
    std::vector<ComparedRun> runs;
    std::vector<ComparedSetting> settings;
    std::vector<Quantity> quantities;
    std::optional<double> equal_time;         ///< [s] since the first rock that all runs reached
    std::optional<double> equal_revolutions;  ///< since the first rock that all runs reached
    std::vector<MeasuredSeries> measured;     ///< tests beside the runs
};

/// \param directories  of at least two runs
/// \throws UserError  when there are fewer than two, or a directory holds no run (all at once)
Comparison compare_runs(const std::vector<std::filesystem::path>& directories);

/// Keys of quantities that more than one figure needs.
namespace quantity {
inline constexpr const char *k_speed = "speed_rpm", *k_swing = "swing_speed_m_min", *k_delivered = "delivered_in_situ_m3_h",
                            *k_production = "production", *k_spillage = "ratio";
}

/// The quantity of a key; null when the comparison has none.
const Quantity* find_quantity(const Comparison& comparison, const std::string& key);

/// Of a quantity that the comparison has, for one setting.
const Estimate& quantity_of(const Comparison& comparison, const std::string& key, std::size_t setting);

/// Difference of setting `index` from setting 0. Repeats are paired when both settings have the same seeds, else taken as independent
/// (Welch).
Difference difference_of(const Comparison& comparison, const Quantity& quantity, std::size_t index);

/// A setting beside a test of its speed and discharge.
struct MeasuredDifference {
    std::string series;
    std::string key;  ///< of the quantity: "ratio" or "production"
    std::size_t setting = 0;
    MeasuredShare measured;
    Difference difference;  ///< setting less test; its interval is known when both errors are
};

/// Adds the tests of files to a comparison.
/// \throws UserError  when a file has mistakes, or the runs have no rock (all at once)
void add_measured(Comparison& comparison, const std::vector<std::filesystem::path>& files);

/// Whether a test was made at a run's discharge, within 0.5 %; one that does not tell its own stands beside all.
bool has_discharge_of(const OperatingPoint& run, const MeasuredPoint& test);

/// Every test with every setting whose speed, and discharge where the test has one, is within 0.5 % of it.
std::vector<MeasuredDifference> measured_differences(const Comparison& comparison);

/// Keys of the studies in which settings differ, with the value of each setting (empty: the study has none).
std::map<std::string, std::vector<std::string>> differing_keys(const Comparison& comparison);

/// The batch of every setting in words (requested rocks, sizes, densities, seeds) when they are not all the same; else
/// nothing, and nothing of heads that are fed all the time. Settings with different batches are compared, but a difference may then be that
/// of the batches.
std::vector<std::string> differing_batches(const Comparison& comparison);

/// Key of a quantity of an axial bin, such as "outflow_0-30mm_m_s" or "spilled_gap_share".
std::string bin_key(const std::string& what, const std::string& bin, const std::string& unit);

/// "differs", "not significant", ...
const char* verdict_text(ComparisonVerdict verdict);

/// Of all runs together: what one of them has, and cutting only when all are fed by it.
Scope scope_of(const Comparison& comparison);

/// The contract's document.
nlohmann::json comparison_json(const Comparison& comparison);

/// The quantities as a table of plain text.
std::string comparison_text(const Comparison& comparison);

}  // namespace cutterflow::postproc
