#pragma once
/// \file A rotor with a ramp of steel under a backplate at rest, meshed by blockMesh alone, with cells of at most a quarter of the rock
/// that is squeezed between both. Patches and zone are named as in a run directory; tank and interface stand as in tiny_rotor_mesh.hpp.
#include <filesystem>

namespace cutterflow::cases::test {

inline constexpr double k_ramp_rock = 0.04;                             ///< [m], diameter
inline constexpr double k_ramp_from_deg = 45.0, k_ramp_to_deg = 135.0;  ///< azimuths at rotor angle 0
inline constexpr double k_ramp_hub_radius = 0.1, k_ramp_radius = 0.18;  ///< [m]
inline constexpr double k_ramp_narrow = 0.9, k_ramp_wide = 1.5;         ///< gap at both ends of the ramp, over the rock's diameter
inline constexpr double k_ramp_smallest_cell = 0.006;                   ///< [m], a side

/// Gap between ramp and backplate over the rock's diameter, which grows evenly along the ramp.
double ramp_gap(double azimuth_deg);

/// Writes system/blockMeshDict.
void write_ramp_block_mesh(const std::filesystem::path& case_directory);

}  // namespace cutterflow::cases::test
