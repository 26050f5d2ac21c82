#pragma once
/// \file Names of the cutter scene that two or more layers share: patches, zones, surfaces and point sets of a run directory.
/// docs/design/001-contracts.md describes each file.

namespace cutterflow::names {

// Cell zones and patches of the mesh.
inline constexpr const char* rotor_zone = "rotor";
inline constexpr const char* cutter_patch = "cutter";              ///< rotating steel
inline constexpr const char* backplate_patch = "backplate";        ///< stationary steel behind the ring
inline constexpr const char* suction_pipe_patch = "suction_pipe";  ///< stationary steel of mouth and pipe
inline constexpr const char* outlet_patch = "outlet";              ///< end of the suction pipe
inline constexpr const char* inlet_patch = "inlet";                ///< circumference of the tank
inline constexpr const char* tank_top_patch = "tank_top";
inline constexpr const char* tank_bottom_patch = "tank_bottom";
inline constexpr const char* rotor_interface_patch = "rotor_interface";    ///< cyclicAMI, on the rotor's side
inline constexpr const char* stator_interface_patch = "stator_interface";  ///< cyclicAMI, on the stator's side

// Surfaces and tables of a run directory, relative to it.
inline constexpr const char* cutter_surface = "geometry/cutter.stl";  ///< in metres, in the run's frame
inline constexpr const char* backplate_surface = "geometry/backplate.stl";
inline constexpr const char* suction_pipe_surface = "geometry/suction_pipe.stl";
inline constexpr const char* bank_surface = "geometry/bank.stl";  ///< soil that stands beside the head
inline constexpr const char* contour_table = "geometry/contour.csv";
inline constexpr const char* contour_for_solver = "constant/contour.csv";

// Sets of points at which a run averages the velocity.
inline constexpr const char* axial_plane = "plane_axial";  ///< through the axis and the mouth's centre
inline constexpr const char* plane_under_ring = "plane_under_ring";
inline constexpr const char* adv_set = "adv";  ///< places of measurement

}  // namespace cutterflow::names
