#pragma once
/// \file Pictures of the head with its rock coloured by fate.
#include <string>

#include <nlohmann/json.hpp>

#include "postproc/draw/head_view.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {

/// Picture as an <svg> element that holds a PNG, with the sense of rotation drawn in.
struct HeadPicture {
    std::string side_view;   ///< from the side, gravity down
    std::string axial_view;  ///< from the hub along the axis, lowest side down
    nlohmann::json view;     ///< the same from the side, to be turned (head_view.hpp)
    int rocks_shown = 0;
    int rocks_outside_view = 0;  ///< of the side view: they lie farther away
};

/// Draws the surfaces of the run (cutter turned to the run's last rotor angle; backplate and suction pipe transparent) and the rocks of
/// final.csv, when there are any.
/// \param surfaces  of the page that will show `view`; those of the run are added
/// \throws UserError  when a surface of the run is missing or broken
HeadPicture draw_head(const RunData& run, ViewSurfaces& surfaces);

}  // namespace cutterflow::postproc
