#pragma once
/// \file The ranges in which cutter suction dredges usually work in rock, in one table: outside of them a point deserves a look.
#include <map>
#include <string>
#include <vector>

namespace cutterflow {

/// Keys of the quantities that have a range.
namespace at_work {
inline constexpr const char *k_ring_diameter = "ring_diameter_m", *k_rotor_speed = "rotor_speed_rpm", *k_tip_speed = "tip_speed_m_s",
                            *k_swing_speed = "swing_speed_m_min", *k_step = "step_m", *k_cut_height = "cut_height_ring_diameters",
                            *k_ladder = "ladder_deg", *k_mouth_speed = "mouth_speed_m_s", *k_mixture_density = "mixture_density_kg_m3",
                            *k_spillage = "spillage_percent";
}  // namespace at_work

/// Where a quantity of the prototype usually lies.
struct UsualRange {
    std::string key;
    std::string name, unit;
    double from = 0.0, to = 0.0;
    double exponent = 0.0;  ///< of the length ratio under Froude's law
    std::string source;     ///< key in docs/references.bib, or "usual practice" where there is none
};

const std::vector<UsualRange>& usual_ranges();

/// Those of a head's quantities that lie outside of their ranges, each as "rotor speed 45 rpm (20 to 40)" with the prototype's value.
/// \param of_model  values by the keys above, in the model's scale; what is not known is left out
/// \param length_ratio  prototype's length over the model's
std::vector<std::string> outside_usual_ranges(const std::map<std::string, double>& of_model, double length_ratio);

}  // namespace cutterflow
