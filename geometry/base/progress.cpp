#include "geometry/base/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>

namespace cutterflow {
namespace {

constexpr double k_terminal_period_s = 0.2;
constexpr double k_plain_period_s = 60.0;
constexpr double k_plain_step = 0.1;
constexpr double k_fraction_for_eta = 0.005;

}  // namespace

std::string duration_text(double seconds) {
    const auto whole = static_cast<long>(std::llround(std::max(0.0, seconds)));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

Progress::Clock Progress::steady_seconds() {
    return [] { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); };
}

Progress::Progress(std::string what, std::ostream& out, bool terminal, Clock clock)
    : what_(std::move(what)), out_(out), terminal_(terminal), clock_(std::move(clock)), start_s_(clock_()) {}

Progress::Progress(std::string what) : Progress(std::move(what), std::cerr, ::isatty(STDERR_FILENO) == 1) {}

void Progress::update(double fraction, const std::string& note) {
    const double done = std::clamp(fraction, 0.0, 1.0);
    if (start_fraction_ < 0.0) start_fraction_ = done;
    const double now = clock_();
    if (!is_due(done, now)) return;
    shown_s_ = now;
    shown_fraction_ = done;
    const double elapsed = now - start_s_;
    const double advanced = done - start_fraction_;
    std::string text = fmt::format("{}: {:.0f} %", what_, 100.0 * done);
    if (!note.empty()) text += ", " + note;
    text += ", " + duration_text(elapsed);
    if (advanced > k_fraction_for_eta) text += ", done in about " + duration_text(elapsed * (1.0 - done) / advanced);
    show(text);
}

bool Progress::is_due(double fraction, double now) const {
    if (shown_s_ < 0.0) return true;
    if (terminal_) return now - shown_s_ >= k_terminal_period_s;
    return fraction - shown_fraction_ >= k_plain_step || now - shown_s_ >= k_plain_period_s;
}

void Progress::finish(const std::string& note) {
    std::string text = fmt::format("{}: done in {}", what_, duration_text(clock_() - start_s_));
    if (!note.empty()) text += ", " + note;
    show(text);
    if (terminal_) out_ << std::endl;
}

void Progress::show(const std::string& text) {
    if (!terminal_) {
        out_ << text << std::endl;
        return;
    }
    const std::size_t blanks = width_ > text.size() ? width_ - text.size() : 0;
    out_ << '\r' << text << std::string(blanks, ' ') << std::flush;
    width_ = text.size();
}

}  // namespace cutterflow
