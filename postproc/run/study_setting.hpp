#pragma once
/// \file What of a study makes runs repeats of one setting, and what tells such repeats apart.
#include <map>
#include <string>

namespace cutterflow::postproc {

struct StudySetting {
    /// By key, as "feed[1].class[2].diameter_m": the study without its name, what repeats vary (seed and time of release) and what changes
    /// no result, files by their content. Equal for repeats, however their values are written.
    std::map<std::string, std::string> values;
    std::string release;  ///< seed and time of release of each feed, which distinguish repeats; empty without rock
};

/// Every value of a study by its path, however it is written. \param where  the study stands, for messages
/// \throws UserError  when the text is not TOML
std::map<std::string, std::string> study_values(const std::string& toml, const std::string& where);

/// \param toml  a study with every key, as runs keep it
/// \param files  of the run, as input_files; one that is not among them is told by its name in the study
/// \throws UserError  when the text is not TOML
StudySetting study_setting(const std::string& toml, const std::map<std::string, std::string>& files);

}  // namespace cutterflow::postproc
