#pragma once
/// \file Command lines as text: for the user to paste, and for scripts that a shell is to read.
#include <string>

namespace cutterflow {

/// A word as sh reads it, whatever it holds: bare where it can be, else in single quotes.
std::string shell_word(const std::string& text);

}  // namespace cutterflow
