#pragma once
/// \file A study of kind "room": its keys, a template, and its reading into a scene.
#include <filesystem>
#include <string>
#include <vector>

#include "cases/scenes/room/room_scene.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// Stages of a room's run that depend on keys.
namespace room_stage {
inline constexpr const char* k_geometry = "geometry";
inline constexpr const char* k_bed = "bed";
inline constexpr const char* k_mesh = "mesh";  ///< of a room with a medium
inline constexpr const char* k_case = "case";
inline constexpr const char* k_report = "report";
}  // namespace room_stage

/// Every key of such a study.
const ParameterTable& room_table();

/// A study that runs as it is: a heap below a lifted tube.
std::string room_template(const std::string& name);

/// The scene of a study's values. Files are named relative to `folder`.
/// \throws UserError  with every mistake: what, value, rule, remedy
RoomScene room_scene(const ParameterValues& values, const std::filesystem::path& folder);

/// \throws UserError  with every mistake of the file
RoomScene read_room(const std::filesystem::path& study);

/// The values of a study whose files are named by absolute paths, so that it may be written elsewhere.
ParameterValues read_placed_room(const std::filesystem::path& study);

}  // namespace cutterflow::cases
