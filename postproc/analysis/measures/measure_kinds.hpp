#pragma once
/// \file Makes each kind of measure from a run: from the values of its keys to its value, its error and what its figure shows.
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"

namespace cutterflow::postproc {

class MeasureSource;
class MeasureValues;

struct MeasureOutcome {
    std::optional<double> value;  ///< none: the run has no such value, and `detail` has the `reason`
    std::string unit;
    std::optional<double> standard_error;
    nlohmann::json detail = nlohmann::json::object();
    nlohmann::json series = nullptr;  ///< arrays by name
};

/// What is wrong with the cells of a map. \param width, height, cell  [m] \return none: it has no more than a page can show
std::optional<Mistake> map_size_mistake(double width, double height, double cell);

MeasureOutcome measure_passed_mass(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_rate(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_time_of(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_mass_in(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_packing(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_profile(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_profile_error(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_angle(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_cavity(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_void_area(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_bed_velocity(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_spectrum(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_wall_force(const MeasureSource& source, const MeasureValues& values);
MeasureOutcome measure_pressure_drop(const MeasureSource& source, const MeasureValues& values);

}  // namespace cutterflow::postproc
