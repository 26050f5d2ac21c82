#pragma once
/// \file The kinds of failure and their exit codes. Messages contain what, value, rule, remedy, in that order.
#include <stdexcept>
#include <string>
#include <vector>

namespace cutterflow {

enum class ExitCode : int { done = 0, defect = 1, user_input = 2, external_program = 3, check_failed = 4, interrupted = 130 };

/// One mistake: what is wrong and its value, the rule it breaks, what to do.
/// Printed as "<what>. <rule>. <remedy>."; `where` (file:line, may be empty) goes in front.
struct Mistake {
    std::string where;
    std::string what;
    std::string rule;
    std::string remedy;
    std::string text() const;
};

/// Any failure that the program explains to its user.
class Failure : public std::runtime_error {
public:
    Failure(ExitCode code, const std::string& text) : std::runtime_error(text), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// The user's input is wrong (exit code 2). Carries every mistake that was found, not the first alone.
class UserError : public Failure {
public:
    explicit UserError(std::vector<Mistake> mistakes);
    UserError(std::string what, std::string rule, std::string remedy);
    const std::vector<Mistake>& mistakes() const { return mistakes_; }

private:
    std::vector<Mistake> mistakes_;
};

/// A child program failed (exit code 3); the text names its log.
class ToolError : public Failure {
public:
    explicit ToolError(const Mistake& mistake) : ToolError(std::vector<Mistake>{mistake}) {}
    explicit ToolError(const std::vector<Mistake>& mistakes);
};

/// A gate was not passed (exit code 4): mesh quality, conservation, a watertight solid.
class CheckFailure : public Failure {
public:
    explicit CheckFailure(const Mistake& mistake) : Failure(ExitCode::check_failed, mistake.text()) {}
};

}  // namespace cutterflow
