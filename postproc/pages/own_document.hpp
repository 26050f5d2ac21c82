#pragma once
/// \file Nothing of the user's is overwritten: pages go to a new or empty folder, or replace an earlier version of themselves.
#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "postproc/draw/page.hpp"

namespace cutterflow::postproc {

/// \param document  JSON file of the folder by which pages of the same command are recognised
/// \param is_own    whether its content, an object, says that they show the same runs
/// \throws UserError  when the folder holds anything else
inline void require_own_document(const std::filesystem::path& folder, const std::filesystem::path& document,
                                 const std::function<bool(const nlohmann::json&)>& is_own) {
    namespace fs = std::filesystem;
    constexpr const char* rule = "Pages replace nothing but an earlier version of themselves";
    if (fs::exists(folder) && !fs::is_directory(folder))
        throw UserError(fmt::format("{} is no folder", folder.string()), rule, "Name another folder");
    require_own_folder(folder, document);
    const fs::path file = folder / document;
    if (!fs::exists(file)) return;
    const nlohmann::json content = nlohmann::json::parse(read_file(file), nullptr, false);
    if (!content.is_object() || !is_own(content))
        throw UserError(fmt::format("{} was not written there by this command from the same runs", file.string()), rule,
                        "Name another folder, or remove this one yourself");
}

}  // namespace cutterflow::postproc
