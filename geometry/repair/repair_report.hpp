#pragma once
/// \file A repair in words and as JSON.
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "geometry/io/length_unit.hpp"
#include "geometry/repair/repair.hpp"

namespace cutterflow::geometry::repair {

/// `{schema, file, unit {..}, limits {..}, before {..}, steps: [{name, counted, count, volume_change_m3, area_change_m2, remark}],
/// repaired, after {..} or refusals: [{what, rule, remedy}]}`
nlohmann::json to_json(const RepairOutcome& outcome, const std::string& file, const UnitDecision& unit);

/// The same for people: a line for each step.
std::string to_text(const RepairOutcome& outcome, const std::string& file, const UnitDecision& unit);

}  // namespace cutterflow::geometry::repair
