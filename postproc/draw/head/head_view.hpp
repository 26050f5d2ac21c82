#pragma once
/// \file The head with its rock as data for page.js, which turns it with the mouse.
#include <vector>

#include <nlohmann/json.hpp>

#include "postproc/draw/rendering.hpp"

namespace cutterflow::postproc {

/// Surfaces that the views of a page show, each once however many views show it. A surface is an IndexedSurface: `low` [m], `step` [m],
/// `points` and `triangles` as base64 of little-endian numbers of 16 and 32 bits.
class ViewSurfaces {
public:
    /// Number of a surface on the page, from 0.
    std::size_t number_of(const TriangleSurface& surface);

    /// As page.js reads them; empty without surfaces.
    std::string markup() const;

private:
    std::vector<nlohmann::json> surfaces_;
};

/// Scene and first view: `steel` (number of the surface), `steel_angle` [rad], `ghosts` and `soil` (numbers), `rocks` ([{colour, spheres:
/// [[x, y, z, radius], ...]}]), `centre`, `up`, `towards`, `height_m`, `aspect`.
nlohmann::json head_view(const HeadScene& scene, const View& view, ViewSurfaces& surfaces);

}  // namespace cutterflow::postproc
