#pragma once
/// \file Velocities measured at points (by an Acoustic Doppler Velocimeter, ADV), and where the model is sampled to compare with them.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::postproc {

/// Directions of the components, in the order of all arrays here.
enum class AdvComponent { radial, tangential, axial };
inline constexpr std::array<AdvComponent, 3> k_adv_components{AdvComponent::radial, AdvComponent::tangential, AdvComponent::axial};
const char* adv_component_name(AdvComponent component);

/// A place of measurement in the run's frame.
struct AdvPoint {
    std::string name;
    Cylindrical place;                              ///< of a rotating point at rotor angle 0
    bool rotating = false;                          ///< the instrument turns with the head, and measures the velocity relative to it
    std::array<std::optional<double>, 3> measured;  ///< [m/s]; tangential by the right hand about the axis
    std::string where;                              ///< file:line

    Vec3 position() const;                         ///< [m]
    Vec3 direction(AdvComponent component) const;  ///< unit vector at the point
};

/// Reads a CSV file. Its header names, in any order: `name`; `x_m,y_m,z_m` or `r_m,theta_deg,z_m`; `frame` (still or rotating);
/// `u_radial_m_s,u_tangential_m_s,u_axial_m_s`. Units are in the header: lengths m, cm, mm; angles deg, rad; velocities m_s, cm_s,
/// mm_s. Lines that begin with # are left out; an empty velocity was not measured.
/// \throws UserError  with every mistake of the file: columns that are missing, unknown or of an unknown unit, lines with another number of
///                    fields, fields that are no numbers, frames and names that are wrong or duplicate
std::vector<AdvPoint> read_adv_points(const std::filesystem::path& file);

/// A commented file that read_adv_points accepts.
std::string adv_template();

/// The volume in which the instrument measures, and how well its place is known.
struct AdvProbe {
    double diameter = 0.006, length = 0.009;  ///< of a cylinder along the rotor's axis [m]
    double position_error = 0.01;             ///< +- [m]
};

/// Where the model is sampled for a point (rotating ones at rotor angle 0): first k_probe_places in the probe's volume, whose plain mean is
/// its mean for every field that is cubic in space; then, position_error away along each component's direction, one before and one after
/// the point.
std::vector<Vec3> adv_places(const AdvPoint& point, const AdvProbe& probe);
inline constexpr std::size_t k_probe_places = 8;
inline constexpr std::size_t k_adv_places = k_probe_places + 6;

}  // namespace cutterflow::postproc
