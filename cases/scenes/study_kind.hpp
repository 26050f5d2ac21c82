#pragma once
/// \file Which kind of study a file is.
#include <filesystem>
#include <string>

namespace cutterflow::cases {

/// The text of a study's key `kind`, or of `scene.kind`; empty when it names none, is missing or no TOML.
std::string kind_named_in(const std::filesystem::path& study);

}  // namespace cutterflow::cases
