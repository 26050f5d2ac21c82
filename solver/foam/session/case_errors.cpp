#include "solver/foam/session/case_errors.hpp"

#include <string>

#include <fmt/format.h>

#include "error.H"

namespace cutterflow::foam {
namespace {

/// OpenFOAM's text without the empty lines around it.
std::string text_of(const Foam::error& error) {
    const std::string text = error.message();
    const auto first = text.find_first_not_of(" \t\n");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

/// "file:line" of the case, as far as OpenFOAM tells it.
std::string where(const Foam::IOerror& error) {
    const std::string file = error.ioFileName();
    const Foam::label line = error.ioStartLineNumber();
    return line > 0 ? fmt::format("{}:{}", file, line) : file;
}

}  // namespace

ErrorsAreThrown::ErrorsAreThrown(ThrownErrors which)
    : content_before_(Foam::FatalIOError.throwExceptions(true)), all_before_(Foam::FatalError.throwing()) {
    if (which == ThrownErrors::all) Foam::FatalError.throwExceptions(true);
}

ErrorsAreThrown::~ErrorsAreThrown() {
    Foam::FatalIOError.throwExceptions(content_before_);
    Foam::FatalError.throwExceptions(all_before_);
}

void rethrow_as_case_error() {
    try {
        throw;
    } catch (const Foam::IOerror& error) {
        throw CaseFileError(Mistake{where(error), "OpenFOAM cannot use what stands here",
                                    "Brackets must be closed, entries complete, and values such as OpenFOAM knows them",
                                    "Correct the file. OpenFOAM says:\n" + text_of(error)});
    } catch (const Foam::error& error) {
        throw CaseFileError(Mistake{"", "OpenFOAM cannot open the case",
                                    "It must hold its mesh (blockMesh makes one in constant/polyMesh) and the files that "
                                    "docs/user/your_own_case.md lists",
                                    "Correct the case. OpenFOAM says:\n" + text_of(error)});
    }
}

}  // namespace cutterflow::foam
