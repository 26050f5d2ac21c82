#pragma once
/// \file Files that a command writes for the user.
#include <filesystem>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::cli {

/// \throws UserError  when there is a file of this name: nothing of the user's is overwritten
inline void require_new_file(const std::filesystem::path& file) {
    if (std::filesystem::exists(file))
        throw UserError(fmt::format("{} is there already", file.string()), "Nothing is overwritten", "Choose another name or remove it");
}

}  // namespace cutterflow::cli
