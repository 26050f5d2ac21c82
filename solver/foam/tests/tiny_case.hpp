#pragma once
/// \file Small OpenFOAM cases that tests write, mesh and open.
#include <filesystem>
#include <map>
#include <string>

namespace cutterflow::foam::testing {

/// A case as text. Keys of `files` are paths within the case; a value is the file's body without header.
struct TinyCase {
    std::string name;
    std::map<std::string, std::string> files;
};

/// A cylinder about z, centred on the origin: cell zone `rotor` (an O-grid) inside radius_interface, stator around it, coupled by
/// cyclicAMI. Patches: rotor_ends, stator_ends (both end planes), rim.
struct TurningCylinder {
    double radius_interface = 0.1;
    double radius = 0.2;
    double height = 0.1;
    int cells_around_quarter = 8;  ///< of the rotor's side of the interface; also across the core
    int stator_cells_around_quarter = 8;
    int cells_in_rotor_ring = 4;
    int cells_in_stator = 8;
    int cells_high = 8;
};
std::string block_mesh(const TurningCylinder& shape);

/// An annulus about z between `radius_hub` and `radius`, otherwise as TurningCylinder. Further patch: hub.
struct TurningAnnulus {
    double radius_hub = 0.05;
    double radius_interface = 0.075;
    double radius = 0.1;
    double height = 0.01;
    int cells_around_quarter = 16;
    int stator_cells_around_quarter = 16;
    int cells_in_rotor = 8;
    int cells_in_stator = 8;
    int cells_high = 1;
    bool plane = false;  ///< the ends are of type empty; needs cells_high 1
};
std::string block_mesh(const TurningAnnulus& shape);

/// A box from `lower` to `upper`, no zones. Patches: x_min, x_max, y_min, y_max, z_min, z_max. With `periodic_x` x_min and x_max are
/// cyclic; with `duct` they are named inlet and outlet and are no walls.
struct Box {
    double lower[3] = {0.0, 0.0, 0.0};
    double upper[3] = {1.0, 1.0, 1.0};
    int cells[3] = {10, 10, 10};
    bool periodic_x = false;
    bool duct = false;
};
std::string block_mesh(const Box& shape);

/// Three rings about z from 0.05 to 0.2 m that slide on each other at 0.1 and 0.15 m; nothing turns. Patches: hub, rim, ends, and the
/// interfaces near_1, far_1, near_2, far_2.
struct ThreeRings {
    double height = 0.05;
    int cells_around_quarter[3] = {4, 7, 5};  ///< of each ring
};
std::string block_mesh(const ThreeRings& shape);

/// constant/dynamicMeshDict of a rotor about z [rad/s].
std::string turning(double omega);

/// A patch field and the fields' files: internal value and boundary in one string each.
std::string volume_field(const std::string& dimensions, const std::string& internal, const std::string& boundary);

/// A laminar case with tight linear solvers, Euler, linear schemes and a fixed time step. U and p are still to be given.
TinyCase laminar_case(const std::string& name, const std::string& block_mesh, double time_step, double end_time);

/// Replaces the laminar model by realizable k-epsilon with wall functions on every patch (patches must be walls).
void make_turbulent(TinyCase& tiny, double k, double epsilon);

/// Writes the case below the build folder, meshes it and decomposes it when there are several ranks. Collective.
/// \return its folder
std::filesystem::path build_case(const TinyCase& tiny);

}  // namespace cutterflow::foam::testing
