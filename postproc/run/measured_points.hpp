#pragma once
/// \file Spillage and production that a user measured in tests, to stand beside those of runs.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cutterflow::postproc {

/// A share by mass and half its 95 % interval.
struct MeasuredShare {
    double value = 0.0;
    std::optional<double> error;
};

/// One test.
struct MeasuredPoint {
    double speed_rpm = 0.0;
    std::optional<double> discharge;  ///< [m3/s]; none: it is compared with runs of any discharge
    std::optional<MeasuredShare> spillage, production;
};

/// The tests of one file.
struct MeasuredSeries {
    std::string name;  ///< the file's, without its extension
    std::vector<MeasuredPoint> points;
};

/// Reads a CSV file: `speed_rpm`, then `spillage` or `production` or both (shares by mass from 0 to 1), and optionally `discharge_m3_s`,
/// `spillage_error`, `production_error` (half the 95 % interval). Speed and discharge are those of the runs, in the model's scale. Lines
/// that begin with # are left out.
/// \throws UserError  with every mistake of the file: it is missing, has no points or no share, columns missing or unknown, fields that are
/// no numbers or out of their bounds
MeasuredSeries read_measured_points(const std::filesystem::path& file);

/// A commented file to fill in.
std::string measured_template();

}  // namespace cutterflow::postproc
