#pragma once
/// \file Pictures of a room's grains and solids.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/base/vec3.hpp"
#include "postproc/analysis/measures/measure_source.hpp"
#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {

/// Travels of a solid of room.json; earlier versions wrote one without a list.
std::vector<nlohmann::json> travels_of(const nlohmann::json& solid);

/// Where a point of a solid of room.json is at a time [s]. \param given  where the solid's file has it [m]
Vec3 moved_point(const nlohmann::json& solid, double time, const Vec3& given);

/// At the start, in the middle and at the end of the run: from the side, and cut by the plane y = 0; markup.
std::string room_pictures(const Page& page, const nlohmann::json& room, const MeasureSource& source);

}  // namespace cutterflow::postproc
