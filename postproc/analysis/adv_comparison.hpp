#pragma once
/// \file Measured velocities beside the model's: the numbers of report/adv.json and adv.html.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "postproc/run/adv_points.hpp"

namespace cutterflow::postproc {

inline constexpr const char* k_adv_schema = "cutterflow.adv/1";

/// One component of the velocity at a point [m/s].
struct AdvVelocity {
    std::optional<double> measured;
    std::optional<double> model;              ///< mean over the probe's volume and the revolutions; none: the point was never in water
    std::optional<double> position_bar;       ///< +-, change of the model's mean over the position error: |grad u| times it
    std::optional<double> statistical_error;  ///< standard error of the model's mean by batch means over revolutions; none below two
};

struct AdvResult {
    AdvPoint point;
    std::array<AdvVelocity, 3> velocity;  ///< by AdvComponent
    bool inside = false;                  ///< within the head's contour of revolution
    double wet_share = 0.0;               ///< of the averaged time in which the probe's volume was in water
};

/// How well model and measurement agree over `count` components, with P the model and O the measurement:
///   bias = mean(P - O), rmse = sqrt(mean((P - O)^2)), slope = sum(P O) / sum(O^2) of the line through the origin, hit rate = share
///   with |P - O| <= 0.25 |O| or <= W, where W is the position bar plus two standard errors (key VDI3783-9, with a W of each point).
struct AdvAgreement {
    std::size_t count = 0;
    double bias = 0.0, rmse = 0.0;  ///< [m/s]
    std::optional<double> slope;    ///< none when nothing but 0 was measured
    double hit_rate = 0.0;
};

struct AdvComparison {
    std::string run, points_file;
    double speed_rpm = 0.0, discharge = 0.0;
    AdvProbe probe;
    int revolutions = 0;  ///< the last ones of the run, over which the model is averaged
    std::vector<AdvResult> points;
};

/// Agreement over all measured components of the points that are inside (or outside) the head, or of one component alone.
AdvAgreement agreement(const AdvComparison& comparison, bool inside, std::optional<AdvComponent> component = std::nullopt);

/// Reads what a run has averaged at the points of a file.
/// \param revolutions  the last ones to average over; none: all whole ones since averaging began
/// \throws UserError  with every mistake: of the points' file, points that the run did not sample, more revolutions than there are
AdvComparison compare_with_measurement(const std::filesystem::path& run_directory, const std::filesystem::path& points_file,
                                       std::optional<int> revolutions = std::nullopt);

nlohmann::json adv_json(const AdvComparison& comparison);
std::string adv_text(const AdvComparison& comparison);  ///< the table for a terminal

}  // namespace cutterflow::postproc
