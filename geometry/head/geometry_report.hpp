#pragma once
/// \file geometry.json and the text of `cutterflow inspect`.
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "geometry/head/head.hpp"
#include "geometry/io/length_unit.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::geometry {

/// What is known of one surface file. `head` is absent for a surface that is not sound, and for a sound one that is no head.
struct GeometryInspection {
    std::string file;
    UnitDecision unit;
    SoundnessReport soundness;  ///< in metres, in the file's frame
    std::optional<Head> head;
    std::vector<Mistake> no_head{};  ///< why a sound surface is no head
};

/// Inspects an imported surface; understands it as a head when it is sound.
GeometryInspection inspect_cutter(const ImportedSurface& imported, const std::string& file);

/// \throws UserError  with every defect of a surface that is not sound, or why a sound one is no head
void require_head(const GeometryInspection& inspection);

/// geometry.json: `file, unit {name, detected, reason}, surface {...}, defects {...}, sound, head {...}` with units in the keys; `no_head`
/// states why a sound surface is not a head.
nlohmann::json to_json(const GeometryInspection& inspection);

/// The same for people, a line each.
std::string to_text(const GeometryInspection& inspection);

}  // namespace cutterflow::geometry
