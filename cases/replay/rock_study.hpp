#pragma once
/// \file Another study's rock in a recorded flow.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cases/study/study.hpp"

namespace cutterflow::cases {

/// What a flow was, or will be, recorded of.
struct ReplayedFlow {
    ParameterValues values;                    ///< of its study
    std::map<std::string, std::string> files;  ///< SHA-256 of those that its study names, by key: "cutter.file"
    HeadSize head;
};

/// Of a study that has not run yet. \param folder  to which its files are relative
ReplayedFlow planned_flow(const ParameterValues& values, const std::filesystem::path& folder, const HeadSize& head);

/// Keys of `study` that differ from the flow's although the flow depends on them: what a run settles by its geometry and its mesh,
/// sections rotor, suction, fluid, bank and hauling, with a bank the swing's direction and the ladder, with hauled water its speed. Files
/// are compared by their content. \param file  of the study, for messages; the files that it names are relative to it
std::vector<Mistake> check_same_flow(const ReplayedFlow& flow, const ParameterValues& study, const std::filesystem::path& file);

/// A study of which all that belongs to the flow may be left out, with every key.
/// \throws UserError  with every key of another flow and every mistake beside that head
ParameterValues read_rock_study(const ReplayedFlow& flow, const std::filesystem::path& file);

}  // namespace cutterflow::cases
