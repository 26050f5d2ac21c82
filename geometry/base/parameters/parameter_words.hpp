#pragma once
/// \file Keys and descriptions of parameters, shared by what reads and lists them.
#include <string>
#include <vector>

#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::parameter_words {

std::string section_of(const std::string& key);  ///< "feed.class" of "feed.class.share", empty without a dot
std::string name_of(const std::string& key);     ///< "share"
std::string join(const std::vector<std::string>& words, const char* separator);

/// Sections in the order of their first key; arrays of tables are sections that repeat.
std::vector<std::string> sections_of(const ParameterTable& table);
bool is_repeated_section(const ParameterTable& table, const std::string& section);
/// The innermost array of tables that a key stands in, or empty.
std::string enclosing_array(const ParameterTable& table, const std::string& key);

std::string kind_text(ParameterKind kind);
bool has_unit(const Parameter& parameter);
std::string with_unit(const Parameter& parameter, const std::string& text);
std::string kind_with_unit(const Parameter& parameter);  ///< "a number in rpm"

/// The allowed range in words: "above 0 m", "0 to 120 rpm"; empty without bounds.
std::string bounds_text(const Parameter& parameter);

/// Text in double quotes, as TOML escapes it.
std::string quoted(const std::string& text);

}  // namespace cutterflow::parameter_words
