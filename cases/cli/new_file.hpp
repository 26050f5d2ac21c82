#pragma once
/// \file Files that a command writes for the user.
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "geometry/base/error.hpp"
#include "geometry/io/read_surface.hpp"

namespace cutterflow::cli {

/// \throws UserError  when there is a file of this name: nothing of the user's is overwritten
inline void require_new_file(const std::filesystem::path& file) {
    if (std::filesystem::exists(file))
        throw UserError(fmt::format("{} is there already", file.string()), "Nothing is overwritten", "Choose another name or remove it");
}

/// Of a file that is written as STL: another ending would name another format, and other programs would not read it.
inline const CLI::Validator k_stl_name(
    [](std::string& name) {
        return geometry::extension_of(name) == ".stl" ? std::string() : name + " does not end with .stl, and an STL file is written";
    },
    "");

/// \throws UserError  when two options name one place: the second would be written over the first
inline void require_different_places(const char* option, const std::string& place, const char* other_option, const std::string& other) {
    namespace fs = std::filesystem;
    if (fs::weakly_canonical(fs::absolute(place)) == fs::weakly_canonical(fs::absolute(other)))
        throw UserError(fmt::format("{} and {} both name {}", option, other_option, place), "One would be written over the other",
                        "Give them different names");
}

}  // namespace cutterflow::cli
