#pragma once
/// \file Pictures of the head with its rock coloured by fate.
#include <string>
#include <vector>

#include "postproc/draw/page.hpp"
#include "postproc/draw/triangle_surface.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {

/// The head from the side, gravity down.
struct HeadPicture {
    std::string markup;  ///< the picture, which turns in a live page
    int rocks_shown = 0;
    int rocks_outside_view = 0;  ///< they lie farther away
};

/// Draws the surfaces of the run (cutter turned to the run's last rotor angle; backplate and suction pipe transparent) and the rocks of
/// final.csv, when there are any, with the sense of rotation.
/// \param name  of the picture, for the file beside a still page
/// \throws UserError  when a surface of the run is missing or broken
HeadPicture draw_head_from_side(const RunData& run, Page& page, const std::string& name);

/// The same as an <svg> element, from the hub along the axis, lowest side down and without backplate and pipe.
std::string draw_head_from_hub(const RunData& run, const Page& page, const std::string& name);

/// The steel of the head alone, from the side and from the hub, as an <svg> element each. \param colours  of its triangles
std::string draw_painted_head(const RunData& run, const TriangleSurface& steel, const std::vector<Colour>& colours, const Page& page,
                              const std::string& name);

}  // namespace cutterflow::postproc
