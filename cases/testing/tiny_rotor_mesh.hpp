#pragma once
/// \file A rotor of two lumps of steel in a small cylinder of water, meshed by blockMesh alone: 2,928 cells with a cyclicAMI between rotor
/// and stator. Patches and zone are named as in a run directory (there is no suction pipe; the outlet is a ring in the top).
#include <filesystem>

#include "cases/scenes/cutter/case_inputs.hpp"

namespace cutterflow::cases::test {

inline constexpr double k_tiny_rotor_radius = 0.15;  ///< [m], of the steel
inline constexpr double k_tiny_tank_radius = 0.6;
inline constexpr int k_tiny_cells = 2928;
inline constexpr double k_tiny_z_min = -0.3;
inline constexpr double k_tiny_z_max = 0.1;

/// Writes system/blockMeshDict.
void write_tiny_block_mesh(const std::filesystem::path& case_directory);

/// Inputs that fit the mesh: 60 rpm, 10 litres per second, water, gravity for 30 degrees of inclination, a run of 0.1 s.
CaseInputs tiny_inputs();

}  // namespace cutterflow::cases::test
