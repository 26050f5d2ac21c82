#pragma once
/// \file Is the axis of a head found that was tilted, shifted and roughened?
#include <string>

#include "geometry/head/crown_cutter.hpp"

namespace cutterflow::validation {

/// Transformation of a head of the family, and the error of understand_head.
struct AxisCheck {
    geometry::CrownParameters head;
    double noise = 0.0;            ///< standard deviation of each coordinate of each point, over the ring radius
    double tilt_deg = 0.0;         ///< turned by, about a direction of its own
    double angle_error_deg = 0.0;  ///< between the axis found and the true one
    double offset_error = 0.0;     ///< of the origin found from the true axis, over the ring radius
    double radius_error = 0.0;     ///< of the ring radius, relative
    int blades_found = 0;
    bool carrying_found = false;  ///< is the sense right in which it carries rock?
    double core_s = 0.0;

    /// Axis within 0.1 degrees and 0.1 % of the radius, blades and carrying sense right.
    bool passed() const;
};

/// Head `index` of the family, turned about any axis by any angle, shifted by up to five ring radii in each direction, its points moved by
/// Gaussian noise of 0, 0.05, 0.1 or 0.2 % of the ring radius in turn.
AxisCheck check_axis(int index);

std::string table_header();
std::string table_row(int index, const AxisCheck& check);

}  // namespace cutterflow::validation
