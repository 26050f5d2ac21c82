#pragma once
/// \file The unit of a surface file. STL, OBJ and PLY do not contain it: it is given, or derived from plausible sizes of a cutter head.
#include <optional>
#include <string>

namespace cutterflow::geometry {

enum class LengthUnit { metre, millimetre, centimetre, inch, foot };

/// Bounds of half the largest extent of a cutter head's bounding box [m], which is its ring radius or a little more.
inline constexpr double k_smallest_head_radius = 0.05;
inline constexpr double k_largest_head_radius = 3.0;

double metres_per(LengthUnit unit);

/// "m", "mm", "cm", "inch", "ft".
const char* name_of(LengthUnit unit);

/// \throws UserError  when the name is none of name_of's
LengthUnit length_unit_of(const std::string& name);

/// Which unit was taken and why. Reports and logs always print `reason`.
struct UnitDecision {
    LengthUnit unit = LengthUnit::metre;
    bool detected = false;     ///< false: given by the user
    double half_extent = 0.0;  ///< [m] with that unit
    std::string reason;
};

/// Metres if that gives a plausible head, else millimetres, else inches (a half extent of 3 to 50). No size is plausible in metres and in
/// millimetres; centimetres and feet are taken only when given. `reason` names every other unit in which the size would be plausible.
/// \param half_extent  half the largest extent of the bounding box, in the file's unit
/// \throws UserError   when the size is implausible in the given unit, or when no unit was given and none of the three fits
UnitDecision decide_unit(double half_extent, std::optional<LengthUnit> given);

}  // namespace cutterflow::geometry
