#pragma once
/// \file From a study and its cutter to what geometry and the case builder work with.
#include <filesystem>
#include <optional>
#include <string>

#include "cases/scenes/cutter/case_inputs.hpp"
#include "cases/study/study.hpp"
#include "geometry/head/contour.hpp"
#include "geometry/head/geometry_report.hpp"
#include "geometry/head/stationary_steel.hpp"

namespace cutterflow::cases {

/// That the file which a key names is missing; none without the key.
std::optional<Mistake> missing_file(const ParameterValues& values, const char* key, const std::filesystem::path& study_folder);

/// \throws UserError  with the line of the study that names a missing cutter file
void require_cutter_file(const ParameterValues& values, const std::filesystem::path& study_folder);

/// The study's cutter, read and understood.
/// \throws UserError  when the file is no surface, its size implausible, the surface no sound solid, or no head
geometry::GeometryInspection import_study_cutter(const ParameterValues& values, const std::filesystem::path& study_folder);

HeadSize head_size(const geometry::Head& head);

geometry::Contour head_contour(const geometry::Head& head, double z_backplate);

/// Backplate and suction pipe of a study, the pipe standing out above the water.
geometry::StationarySteelParameters stationary_steel_of(const Study& study, const HeadSize& head);

/// Warns of a rotor that carries rock away from the suction side, or whose blades push along the axis in neither sense.
std::vector<Mistake> carrying_warnings(const Study& study, const geometry::Head& head);

/// Warns of blades that are flatter than the ladder over most of their height: gravity draws rock to the hub.
std::vector<Mistake> blade_warnings(const Study& study, const geometry::Head& head);

/// The case of a study. \param ranks  of the run
CaseInputs case_inputs_of(const Study& study, const HeadSize& head, const geometry::Contour& contour, int ranks);

}  // namespace cutterflow::cases
