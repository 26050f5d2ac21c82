#pragma once
/// \file OpenFOAM's fatal errors about a case, as mistakes of its user.
#include <vector>

#include "geometry/base/error.hpp"

namespace cutterflow::foam {

/// What OpenFOAM refuses in a file of the case, with its own text below. It may have struck one rank alone: the others must be stopped.
class CaseFileError : public UserError {
public:
    explicit CaseFileError(const Mistake& mistake) : UserError(std::vector<Mistake>{mistake}) {}
};

/// What OpenFOAM throws instead of ending the program: errors about what a file says, or also those without a file (one is missing).
enum class ThrownErrors { of_file_content, all };

/// OpenFOAM throws these errors as long as this object lives.
class ErrorsAreThrown {
public:
    explicit ErrorsAreThrown(ThrownErrors which);
    ~ErrorsAreThrown();
    ErrorsAreThrown(const ErrorsAreThrown&) = delete;
    ErrorsAreThrown& operator=(const ErrorsAreThrown&) = delete;

private:
    bool content_before_, all_before_;
};

/// Called where an exception is handled: throws CaseFileError for OpenFOAM's, any other one again.
[[noreturn]] void rethrow_as_case_error();

/// Runs `action`. \throws CaseFileError  for those of OpenFOAM's fatal errors
template <class Action>
auto with_case_errors(ThrownErrors which, Action action) {
    const ErrorsAreThrown thrown(which);
    try {
        return action();
    } catch (...) {
        rethrow_as_case_error();
    }
}

}  // namespace cutterflow::foam
