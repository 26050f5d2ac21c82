#pragma once
/// \file Progress of a long job: one line that is rewritten on a terminal, a plain line at intervals elsewhere.
#include <chrono>
#include <functional>
#include <ostream>
#include <string>

namespace cutterflow {

/// "42 s", "3 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);

/// Shows the progress of a job and its expected end, extrapolated from the pace since the start.
class Progress {
public:
    using Clock = std::function<double()>;  ///< seconds from any origin

    /// \param what      name of the job
    /// \param out       where lines go
    /// \param terminal  `out` is a terminal: one line is rewritten; otherwise a line per tenth, and one per minute
    Progress(std::string what, std::ostream& out, bool terminal, Clock clock = steady_seconds());
    /// To standard error.
    explicit Progress(std::string what);

    /// \param fraction  done of the whole, 0 to 1; \param note  what is known beyond it ("0.42 of 2 revolutions"), may be empty
    void update(double fraction, const std::string& note = {});
    /// Ends the line. Without it the last state stays on the screen.
    void finish(const std::string& note = {});

    static Clock steady_seconds();

private:
    bool is_due(double fraction, double now) const;
    void show(const std::string& text);

    std::string what_;
    std::ostream& out_;
    bool terminal_;
    Clock clock_;
    double start_s_;
    double start_fraction_ = -1.0;  // a resumed job does not start at 0
    double shown_s_ = -1.0;
    double shown_fraction_ = -1.0;
    std::size_t width_ = 0;
};

}  // namespace cutterflow
