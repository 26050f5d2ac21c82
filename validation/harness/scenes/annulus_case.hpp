#pragma once
/// \file Plane flow between two cylinders for cutterFoam, with a sliding interface between them: the simplest room in which a turning mesh
/// can be held against a known answer.
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "cases/scenes/cutter/case_inputs.hpp"
#include "geometry/base/vec3.hpp"

namespace cutterflow::validation {

/// Water between two cylinders about z, one cell high. The mesh inside the interface is the rotor, and turns.
struct AnnulusCase {
    double inner = 0.1, interface = 0.15, outer = 0.2;      ///< radii [m]
    double height = 0.01;                                   ///< [m]
    int radial_cells = 8;                                   ///< of rotor and of stator each
    int rotor_cells_around = 16, stator_cells_around = 20;  ///< of a quarter: the two sides of the interface differ
    double grading = 1.0;                                   ///< cell at the wall over cell at the interface
    double inner_speed = 0.0, outer_speed = 0.0;            ///< of the walls [rad/s]
    double rotor_speed = 0.0;                               ///< of the mesh inside the interface [rad/s]
    double density = 1000.0, viscosity = 1e-3;              ///< [kg/m3], [m2/s]
    double time_step = 1e-3, end_time = 1.0;                ///< [s]
    double write_interval = 1e9;                            ///< [s]
    /// Schemes, solvers and correctors of a study with this convection; none: second order in space and time, two outer correctors.
    std::optional<cases::ConvectionScheme> study{};
    std::function<double(double)> start = [](double) { return 0.0; };  ///< azimuthal velocity at a radius at time 0 [m/s]

    std::size_t cell_count() const { return 4u * static_cast<std::size_t>(radial_cells * (rotor_cells_around + stator_cells_around)); }
};

/// Writes the case into `folder` (created) and makes its mesh with blockMesh.
void write_annulus_case(const std::filesystem::path& folder, const AnnulusCase& annulus);

/// Runs cutterFoam; with several ranks the plane is cut through the axis, so that each rank has its part of the interface. The last time's
/// fields then lie in the case folder as after a run on one rank.
void run_annulus_case(const std::filesystem::path& folder, int ranks = 1);

/// Centres of the cells at a time, in the mesh's order; with their volumes.
struct AnnulusCells {
    std::vector<Vec3> centre;    ///< [m]
    std::vector<double> volume;  ///< [m3]
};
AnnulusCells annulus_cells(const AnnulusCase& annulus, double time);

}  // namespace cutterflow::validation
