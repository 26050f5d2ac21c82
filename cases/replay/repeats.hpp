#pragma once
/// \file Runs whose replays stand for one answer are repeats of one study.
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/base/error.hpp"

namespace cutterflow::cases {

/// A run, and its study with every key.
struct RepeatedRun {
    std::filesystem::path folder;  ///< whose manifest.json tells the content of the study's files
    std::string study;             ///< TOML
};

/// What keeps runs from being repeats of the first one's study, which differ by name and release alone: one mistake per run with the keys
/// and values in which it differs, and one per run that comes twice, by its path or by its release.
/// \throws UserError  when a study or a manifest cannot be read
std::vector<Mistake> check_repeats(const std::vector<RepeatedRun>& runs);

}  // namespace cutterflow::cases
