#pragma once
/// \file What a recorded flow says of itself, without its fields.
#include <filesystem>
#include <optional>
#include <string>

namespace cutterflow::coupling {

inline constexpr const char* k_recording_summary = "recording.json";
inline constexpr const char* k_recording_schema = "cutterflow.recording/2";
inline constexpr const char* k_recording_remedy = "Record the flow again";

struct RecordingSummary {
    /// Of the flow in the turning zone over a revolution [-]: root mean square of the difference over that of the velocity. None when it is
    /// not known.
    std::optional<double> change{};
    double start = 0.0, end = 0.0;  ///< of the recording [s]
};

/// \throws UserError  when recording.json is missing, cannot be read or was written by another version of the program
RecordingSummary read_recording_summary(const std::filesystem::path& folder);

/// What is to be said of a recorded flow that has not developed; nothing of one that has, or of which it is not known.
std::optional<std::string> warning_of_change(const std::optional<double>& change);

}  // namespace cutterflow::coupling
