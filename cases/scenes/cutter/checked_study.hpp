#pragma once
/// \file A study and its head: whether all of it has a place, and what is odd about it.
#include <filesystem>
#include <optional>
#include <vector>

#include "cases/scenes/cutter/feed.hpp"
#include "cases/study/study.hpp"
#include "geometry/head/contour.hpp"
#include "geometry/head/geometry_report.hpp"

namespace cutterflow::cases {

/// A study whose bank, rock and points have a place.
struct PlacedStudy {
    Study study;
    HeadSize size;
    geometry::Contour contour;
    std::vector<PlacedFeed> feeds;
};

/// \pre check_study finds no mistake \param folder  of the study, to which the names of its files are relative
/// \param feeds_are_sound  else rock is not placed
/// \throws UserError  with every mistake of the bank, of the points of velocities and, unless the bank has some, of the places of rock
PlacedStudy place_study(const ParameterValues& resolved, const geometry::Head& head, const std::filesystem::path& folder,
                        bool feeds_are_sound = true);

/// What a head and its study may be run with in spite of.
std::vector<Mistake> head_warnings(const ParameterValues& resolved, const PlacedStudy& placed, const geometry::Head& head);

/// \throws UserError  with every mistake of a study that can be seen without reading its cutter: those of its text, of the files
/// that it names, and of its rules as far as they do not need a value that is wrong or missing
void require_study_file(const std::filesystem::path& file);

/// A study without a mistake, and its cutter.
struct CheckedStudy {
    ParameterValues resolved;
    geometry::GeometryInspection inspection;
    PlacedStudy placed;
};

/// \throws UserError  as require_study_file, and with what is wrong with the cutter or with the study beside it
CheckedStudy read_checked_study(const std::filesystem::path& file);

}  // namespace cutterflow::cases
