#pragma once
/// \file The shapes that classes of rock of a cutter's study name.
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "cases/study/shape_file.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// Names of a study's shapes in its case, by their paths in the study: the file's name without its ending, other characters than letters,
/// digits and '_' replaced, with a number where files of several folders have one name.
std::map<std::string, std::string> shape_names(const ParameterValues& study);

/// The shapes of a study, read: by their paths in it. \param folder  of the study
/// \throws UserError  with every shape that is missing or no clump
std::map<std::string, ShapeFile> read_shapes(const ParameterValues& study, const std::filesystem::path& folder);

/// SHA-256 of the files of a study's shapes, by what a stage calls such an input: "feed[1].class[2].shape".
std::map<std::string, std::string> shape_hashes(const ParameterValues& study, const std::filesystem::path& folder);

/// Names other paths for the shapes. \param path_of  the new path, from the old one
void move_shapes(ParameterValues& study, const std::function<std::string(const std::string&)>& path_of);

}  // namespace cutterflow::cases
