#pragma once
/// \file The smallest case with a sliding interface: two lumps of steel that turn in a cylinder of water
/// (cases/testing/tiny_rotor_mesh.hpp).
#include <filesystem>
#include <functional>
#include <string>

#include "cases/scenes/cutter/case_inputs.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/soil/bank.hpp"

namespace cutterflow::validation {

/// Writes the case into `folder` (absent) and makes its mesh, water at rest. Walls that inputs.rock names are added to the rotor's own
/// steel; their surfaces must be put into the folder afterwards.
/// \param inputs  as cases::test::tiny_inputs() with changes; without inputs.rock flow alone
/// \param feed    content of constant/rockFeed.csv, with rock
/// \param write_mesh  writes the system/blockMeshDict of a case, with patches as there
void write_rotor_case(const std::filesystem::path& folder, cases::CaseInputs inputs, const std::string& feed,
                      const std::function<void(const std::filesystem::path&)>& write_mesh = cases::test::write_tiny_block_mesh);

inline constexpr double k_reach_beside_rotor = 0.45;  ///< of the bank's surface from the axis [m]

/// A bank beside the rotor, for a ladder at 60 degrees.
geometry::Bank bank_beside_rotor(const geometry::Contour& contour);

/// The same with a ladder at 60 degrees, beside a bank towards which the head travels at 0.1 m/s.
/// \param inputs  with rock, whose only wall is the bank's
void write_rotor_beside_bank(const std::filesystem::path& folder, cases::CaseInputs inputs, const std::string& feed);

}  // namespace cutterflow::validation
