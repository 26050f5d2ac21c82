#pragma once
/// \file A cylinder of water with a turning zone in it, for BoxCase: the simplest room in which rock can pass a sliding interface.
#include <string>

namespace cutterflow::validation {

/// A closed cylinder about z, centred on the origin. The mesh inside radius_interface (an O-grid) is the rotor. Patches: rim, ends.
struct TankMesh {
    double radius_interface = 0.08;
    double radius = 0.16;
    double height = 0.10;
    int cells_around_quarter = 10;         ///< of the rotor's side of the interface; also across the O-grid's core
    int stator_cells_around_quarter = 12;  ///< of the stator's side, as the rotor's when there is no interface
    int cells_in_rotor_ring = 4;           ///< along the radius
    int cells_in_stator = 9;               ///< along the radius
    int cells_high = 11;
    bool interface = true;  ///< false: one mesh without a sliding interface
};

/// system/blockMeshDict.
std::string block_mesh(const TankMesh& tank);

/// constant/dynamicMeshDict of the rotor at a speed [rad/s].
std::string turning(double speed);

}  // namespace cutterflow::validation
