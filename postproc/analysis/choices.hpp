#pragma once
/// \file What somebody chose differently between the settings of a comparison, and how settings and curves are called by it.
#include <map>
#include <set>
#include <string>
#include <vector>

#include "postproc/analysis/comparison.hpp"

namespace cutterflow::postproc {

inline constexpr const char* k_rotor_speed_key = "rotor.speed_rpm";
inline constexpr const char* k_discharge_key = "suction.discharge_m3_s";
inline constexpr const char* k_swing_speed_key = "swing.speed_m_min";

/// Keys in which settings differ, with the value of each setting, without those that follow from others: times of the run and of its
/// report, and the stiffness of rock, follow from the rotor's speed.
std::map<std::string, std::vector<std::string>> chosen_keys(const Comparison& comparison);

/// Each setting in words, as "model_cutter.stl, 45 rpm, suction.mouth_azimuth_deg = 90": equal where the chosen keys are equal, apart where
/// they are not. A key is named only where it tells settings apart that the keys before it do not; cutter, speed, discharge and swing come
/// first. \param along  keys that are left out, because a curve or a map runs along them
std::vector<std::string> told_apart(const Comparison& comparison, const std::set<std::string>& along = {});

/// Calls settings of one sweep, whose studies have long names, by what they differ in; others keep their labels.
void call_by_choice(Comparison& comparison);

}  // namespace cutterflow::postproc
