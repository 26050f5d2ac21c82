#pragma once
/// \file Steel with a colour for each triangle.
#include <vector>

#include "postproc/draw/rendering.hpp"

namespace cutterflow::postproc {

/// Picture of a scene whose steel has colours of its own. \param colours  of its triangles; a few dozen different ones at most
Image render_painted(const HeadScene& scene, const std::vector<Colour>& colours, const View& view);

}  // namespace cutterflow::postproc
