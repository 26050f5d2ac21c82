#pragma once
/// \file manifest.json of a run directory: which stage is done, from what, what it wrote. It is what a repeated or resumed run trusts.
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cutterflow::cases {

enum class StageState { started, done };

/// One stage of a run directory.
struct StageRecord {
    StageState state = StageState::started;
    std::map<std::string, std::string> inputs;   ///< name -> value, or SHA-256 of a file
    std::map<std::string, std::string> outputs;  ///< path relative to the run directory -> SHA-256
    double wall_s = 0.0;
    double core_s = 0.0;
    std::string finished;  ///< UTC, ISO 8601; empty while started
};

/// The file, kept in memory and written whole at each change.
class Manifest {
public:
    /// Reads the file, or begins an empty one when there is none. \throws UserError  when it is there and not readable as a manifest
    explicit Manifest(std::filesystem::path file);

    bool empty() const { return records_.empty(); }
    const StageRecord* find(const std::string& stage) const;
    /// Core seconds of all stages.
    double core_s() const;

    /// Notes that a stage begins. `dropped`: later stages, whose records are no longer true.
    void start(const std::string& stage, std::map<std::string, std::string> inputs, const std::vector<std::string>& dropped);
    /// Notes what a stage took that was begun and did not come to its end.
    void note_cost(const std::string& stage, double wall_s, double core_s);
    void finish(const std::string& stage, std::map<std::string, std::string> outputs, double wall_s, double core_s);
    /// \throws UserError  when the directory has work of another kind of study
    void set_kind(const std::string& kind);
    void set_versions(std::map<std::string, std::string> versions);

private:
    void write() const;

    std::filesystem::path file_;
    std::map<std::string, StageRecord> records_;
    std::map<std::string, std::string> versions_;
    std::string kind_;  // of the study; empty in manifests of earlier versions
};

/// Core seconds of all stages that a run directory noted, the one that failed too, of the solver in all its starts; shared stages count in
/// the run that made them. 0 without a manifest.
double run_core_s(const std::filesystem::path& run_directory);

}  // namespace cutterflow::cases
