#pragma once
/// \file toml++, which asserts on some malformed files ("[[[a]]]"): an assertion that fails throws here. Include it from here alone.
#include <stdexcept>

namespace cutterflow {

/// What toml++ takes for granted does not hold: the text is no TOML.
class TomlAssertion : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

[[noreturn]] inline void refuse_toml(const char* expression) {
    throw TomlAssertion(expression);
}

}  // namespace cutterflow

#define TOML_ASSERT(expression) ((expression) ? static_cast<void>(0) : ::cutterflow::refuse_toml(#expression))
#include <toml++/toml.h>
