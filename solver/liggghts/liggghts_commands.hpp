#pragma once
/// \file LIGGGHTS' input commands as text, from typed values. Lengths in m, times in s.
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::liggghts::commands {

/// [m]
struct SimulationBox {
    Vec3 low, high;
};

/// Units, particle kind and communication; before the box exists.
std::vector<std::string> basics();
/// Types: rock that moves, rock that is frozen.
std::vector<std::string> create_box(const SimulationBox& box);
std::string read_restart(const std::filesystem::path& file);
std::string write_restart(const std::filesystem::path& file);
/// Of rock pairs. LIGGGHTS does not check for lost rock; the engine does and reports it.
std::vector<std::string> contact_model();
std::string timestep(double seconds);
std::string run(int steps, bool set_up);
/// No contacts between particles of that type.
std::string no_contacts_within(int type);
/// Neighbour lists that hold until a rock moved half of `skin`; bins of `bin_size`.
std::vector<std::string> neighbours(double skin, double bin_size);

/// One property per rock with `columns` >= 2 values, 0 at the start, kept in restart files.
std::string rock_property(const std::string& name, int columns);
/// \param axis  0 x, 1 y, 2 z: normal of the plane
std::string plane_wall(const std::string& id, int axis, double position);
/// A fix without effect that keeps a place in the list of fixes.
std::string placeholder(const std::string& id);

}  // namespace cutterflow::liggghts::commands
