#pragma once
#include <cstddef>
#include <optional>
#include <string>

namespace cutterflow::geometry {

struct PlyDefect {
    std::string what;
    std::size_t line = 0;  ///< of the file, from 1; 0: the file as a whole, or binary data
};

/// What is wrong with the layout of a PLY file (its content is given): no header, a line of the header that is none, an unknown type, fewer
/// data than the header announces, a face without points. Nothing when it is sound.
std::optional<PlyDefect> ply_defect(const std::string& content);

}  // namespace cutterflow::geometry
