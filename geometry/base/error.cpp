#include "geometry/base/error.hpp"

#include <algorithm>
#include <set>

namespace cutterflow {
namespace {

void append_sentence(std::string& text, const std::string& sentence) {
    if (sentence.empty()) return;
    if (!text.empty()) text += ' ';
    text += sentence;
    const char last = sentence.back();
    if (last != '.' && last != '?' && last != '!') text += '.';
}

std::string join(const std::vector<Mistake>& mistakes) {
    std::string text;
    for (const Mistake& mistake : mistakes) {
        if (!text.empty()) text += '\n';
        text += mistake.text();
    }
    return text;
}

/// One that several checks found is told once.
std::vector<Mistake> told_once(std::vector<Mistake> mistakes) {
    std::set<std::string> told;
    mistakes.erase(std::remove_if(mistakes.begin(), mistakes.end(), [&](const Mistake& one) { return !told.insert(one.text()).second; }),
                   mistakes.end());
    return mistakes;
}

}  // namespace

std::string Mistake::text() const {
    std::string sentences;
    append_sentence(sentences, what);
    append_sentence(sentences, rule);
    append_sentence(sentences, remedy);
    return where.empty() ? sentences : where + ": " + sentences;
}

UserError::UserError(std::vector<Mistake> mistakes)
    : Failure(ExitCode::user_input, join(told_once(mistakes))), mistakes_(told_once(std::move(mistakes))) {}

ToolError::ToolError(const std::vector<Mistake>& mistakes) : Failure(ExitCode::external_program, join(mistakes)) {}

UserError::UserError(std::string what, std::string rule, std::string remedy)
    : UserError(std::vector<Mistake>{{"", std::move(what), std::move(rule), std::move(remedy)}}) {}

}  // namespace cutterflow
