#pragma once
/// \file A calibration file: which keys of which studies are varied, and what their runs are to agree with.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/sweep/sweep.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "postproc/analysis/calibration/estimate.hpp"

namespace cutterflow::cases {

namespace calibration = postproc::calibration;

struct StudyMeasure {
    std::string name;
    bool has_profile = false;  ///< heights over places beside its value
};

/// What a calibration asks of studies, whatever kind they are of.
struct StudyAccess {
    using Path = std::filesystem::path;
    /// As of a sweep: all combinations of the axes' values, repeats differ in the seed.
    /// \throws UserError  with every mistake: unknown keys, values that a study does not take
    std::function<std::vector<SweepPoint>(const Path& study, const std::vector<KeyAxis>& axes, const RepeatRange& repeats,
                                          const Path& folder)>
        points;
    /// Core seconds of one run; none where the kind has no prediction without building a case.
    std::function<std::optional<double>(const Path& study)> predicted_core_s;
    /// A study's measures; empty where the results are those of its kind.
    std::function<std::vector<StudyMeasure>(const Path& study)> measures;
};

struct CalibratedParameter {
    calibration::Range range;
    std::string key;             ///< of every study
    std::vector<double> values;  ///< of the grid
};

/// Where a run's value for a target is found.
struct Measured {
    std::size_t study = 0;       ///< index
    std::string measure;         ///< name in report/measures.json, or place of a number in report/results.json ("production.share")
    std::vector<double> places;  ///< [m] along a profile; empty: one value
};

/// Sets of parameters that are planned at most.
struct CalibrationPlan {
    std::size_t grid = 0, further = 0;
    std::size_t runs = 0;          ///< of all of them and of the answer
    std::optional<double> core_h;  ///< none where a study has no prediction
};

struct CalibrationFile {
    std::string name;
    std::vector<std::filesystem::path> studies;
    std::string method;  ///< "grid", "surface" or "bobyqa"
    const calibration::ObjectiveFunction* objective = nullptr;
    int repeats = 1, rounds = 0, evaluations = 0, repeats_at_answer = 1;
    double budget_runs = 0.0, budget_core_h = 0.0;
    std::vector<CalibratedParameter> parameters;
    calibration::Targets targets;
    std::vector<Measured> measured;  ///< of the fitted targets, then of the held-out ones
    CalibrationPlan plan;
    std::string identity;  ///< text that is the same for files that may share a folder: all but the budget

    std::vector<calibration::Range> ranges() const;
    /// Whether a target of that study is fitted; else its runs are wanted at the answer alone.
    bool is_fitted(std::size_t study) const;
    std::size_t runs_of_a_place() const;
    std::size_t runs_of_the_answer() const;
};

/// Every key of a calibration file.
const ParameterTable& calibration_table();

/// A value of a parameter as studies of its runs have it.
std::string number_text(double value);

/// \throws UserError  with every mistake: of the file, of keys and bounds in the studies, of targets, of a plan over the budget
CalibrationFile read_calibration(const std::filesystem::path& file, const StudyAccess& access);

}  // namespace cutterflow::cases
