#pragma once
#include <string>

namespace cutterflow::geometry {

/// What is wrong with the layout of a PLY file (its content is given), in words: no header, an unknown type, fewer data than the header
/// announces. Empty when nothing is. assimp reads past the end of a truncated binary PLY, so that this comes before it.
std::string ply_defect(const std::string& content);

}  // namespace cutterflow::geometry
