#pragma once
/// \file geometry.json and the text of `cutterflow inspect`.
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "geometry/head.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/length_unit.hpp"
#include "geometry/soundness.hpp"

namespace cutterflow {

/// What is known of one surface file. `head` is absent for a surface that is not sound.
struct GeometryInspection {
    std::string file;
    UnitDecision unit;
    SoundnessReport soundness;  ///< in metres, in the file's frame
    std::optional<Head> head;
};

/// Inspects an imported surface; understands it as a head when it is sound.
/// \throws UserError  from understand_head
GeometryInspection inspect_cutter(const ImportedSurface& imported, const std::string& file);

/// geometry.json: `file, unit {name, detected, reason}, surface {...}, defects {...}, sound, head {...}` with units in the keys.
nlohmann::json to_json(const GeometryInspection& inspection);

/// The same for people, a line each.
std::string to_text(const GeometryInspection& inspection);

}  // namespace cutterflow
