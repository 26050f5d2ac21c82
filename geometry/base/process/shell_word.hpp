#pragma once
/// \file Command lines as text, for messages and for scripts.
#include <string>

namespace cutterflow {

/// Text as one word for sh: unquoted where possible, else in single quotes.
std::string shell_word(const std::string& text);

}  // namespace cutterflow
