#pragma once
/// \file The head with its rock as data for page.js, which turns it with the mouse.
#include <nlohmann/json.hpp>

#include "postproc/rendering.hpp"

namespace cutterflow::postproc {

/// Scene and first view: `steel`, `ghosts` (surfaces), `rocks` ([{colour, spheres: [[x, y, z, radius], ...]}]), `centre`, `up`,
/// `towards`, `height_m`, `aspect`. A surface is an IndexedSurface: `low` [m], `step` [m], `points` and `triangles` as base64 of
/// little-endian numbers of 16 and 32 bits.
nlohmann::json head_view(const Scene& scene, const View& view);

}  // namespace cutterflow::postproc
