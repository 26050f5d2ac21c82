#pragma once
/// \file Progress of a run, read from the solver's log.
#include <filesystem>
#include <string>

#include "cases/study/study.hpp"
#include "geometry/base/progress.hpp"

namespace cutterflow::cases {

/// The simulated time of a log line `Time = 0.123` (OpenFOAM's grammar); none for any other line.
std::optional<double> simulated_time(const std::string& line);

/// Shows revolutions done and time left while the solver writes its log.
class RunProgress {
public:
    explicit RunProgress(const Study& study);
    void take(const std::string& line);
    void finish();

private:
    double end_time_;
    double period_;
    Progress progress_;
};

/// The same of a run without a rotor, in seconds.
class TimeProgress {
public:
    TimeProgress(const std::string& what, double end_time) : end_time_(end_time), progress_(what) {}
    void take(const std::string& line);
    void finish() { progress_.finish(); }

private:
    double end_time_;
    Progress progress_;
};

/// Renames a log of an earlier attempt to the first free `<log>.<n>`, so that a resumed run does not overwrite it.
void keep_older_log(const std::filesystem::path& log);

}  // namespace cutterflow::cases
