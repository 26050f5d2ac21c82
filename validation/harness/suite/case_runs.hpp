#pragma once
/// \file The verification suite: finds its cases, starts their programs, keeps and publishes what they found.
/// docs/design/009-verification.md is the contract with the programs.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "validation/harness/suite/case_results.hpp"
#include "validation/harness/suite/effort.hpp"

namespace cutterflow::validation {

/// One folder of validation/cases, from the head of its README.md.
struct VerificationCase {
    std::string name;                   ///< of the folder and of the program
    std::string title;                  ///< the README's first line
    Effort effort = Effort::fast;       ///< the least effort at which it has something to check
    std::vector<std::string> needs;     ///< programs without which it is skipped
    std::vector<std::string> examples;  ///< folders of cases/examples that its program reads
    bool resumes = false;               ///< its program resumes from the files in its folder
};

/// Folders and programs.
struct VerificationPlaces {
    std::filesystem::path cases;     ///< validation/cases
    std::filesystem::path programs;  ///< one program a case
    std::filesystem::path tools;     ///< folder of cutterFoam
    std::filesystem::path kept;      ///< published results, <case>.json
    std::filesystem::path examples;  ///< cases/examples
};

/// All cases, by name. \throws UserError  with every README whose head is wrong
std::vector<VerificationCase> find_verification_cases(const std::filesystem::path& folder);

/// Cases by name. \throws UserError  for unknown names; it lists the known ones
std::vector<VerificationCase> select_cases(const std::vector<VerificationCase>& all, const std::vector<std::string>& names);

struct VerificationSettings {
    std::filesystem::path folder;  ///< receives <case>.json, <case>/ (what the case wrote), <case>.log, the pages
    Effort effort = Effort::standard;
    bool resume = false;  ///< cases finished with the same programs and files and at least this effort are kept; resumable ones are resumed
};

/// Runs cases one after the other; each finished one is kept in the folder at once. A failed case is reported; the others continue.
/// \return results of these cases, in their order
/// A case's folder that holds files of other origin, or changed ones, is renamed before the case is run again; nothing of the user's is
/// deleted.
/// \throws UserError    when the folder holds something else
/// \throws Interrupted  when the user stops it; what is finished is kept
std::vector<VerifiedCase> run_verification(const std::vector<VerificationCase>& cases, const VerificationPlaces& places,
                                           const VerificationSettings& settings, const std::function<void(const std::string&)>& say);

/// The results that lie in a folder as <case>.json, by name of the case; empty when there is no such folder.
std::vector<VerifiedCase> read_verification(const std::filesystem::path& folder);

/// `newer` in the place of what `older` has of the same cases, unless that was run with more effort or later; a later failure always.
/// A case that was stopped is left out. By name.
std::vector<VerifiedCase> merged_verification(const std::vector<VerifiedCase>& older, const std::vector<VerifiedCase>& newer);

}  // namespace cutterflow::validation
