#pragma once
/// \file Reads what can be read of a file with mistakes, so that they are reported beside those that are found later.
#include <string>
#include <vector>

#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow {

struct ReadParameters {
    ParameterValues values;  ///< without those that are wrong
    std::vector<Mistake> mistakes;
    bool complete = true;  ///< no value is wrong or missing; unknown keys may be there
};

/// \throws UserError  when the text is not TOML
ReadParameters parse_with_mistakes(const ParameterTable& table, const std::string& toml, const std::string& name);

/// The text of one key ("scene.kind") of a file whose table is not known yet; none when it is no text, not there, or the file no TOML.
std::optional<std::string> text_of_key(const std::string& toml, const std::string& key);

}  // namespace cutterflow
