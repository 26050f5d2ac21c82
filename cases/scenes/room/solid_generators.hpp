#pragma once
/// \file Solids that a room's study describes by a few sizes instead of a file.
#include <optional>
#include <string>
#include <vector>

#include "cases/scenes/room/room_scene.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

struct GeneratedSolid {
    geometry::TriangleSurface surface;  ///< closed, outward [m], in the room
    double thinnest = 0.0;              ///< its thinnest wall [m]
    std::optional<Bore> bore;           ///< of a straight round hole
    std::optional<double> opening;      ///< of a floor or a spout through which grains fall: a diameter or a width [m]
};

/// One word of `solid.generate`.
struct SolidGenerator {
    const char* name;
    const char* help;
    std::vector<const char*> keys;      ///< of [[solid]], without the section; all must be there
    std::vector<const char*> may_have;  ///< may be there besides
    /// \pre every key is there \throws UserError  with every size that has no meaning
    GeneratedSolid (*make)(const ParameterValues& solid);
};

const std::vector<SolidGenerator>& solid_generators();
const SolidGenerator* find_solid_generator(const std::string& name);

/// Rows of every key that a generator has, for the table of the study.
ParameterTable solid_size_rows();

}  // namespace cutterflow::cases
