#pragma once
/// \file The files of postProcessing/ (docs/design/001-contracts.md).
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "solver/observe/run_recorder.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

/// Writes rows immediately, into folders named by the start time of this (re)started run. For one rank only.
class CsvRecorder final : public RunRecorder {
public:
    /// \param start_time  of the run [s] \param ranks  of the run, taken for those of a start that this one replaces
    CsvRecorder(const std::filesystem::path& case_folder, const CouplingSettings& settings, double start_time, int ranks = 1);

    /// Further content of cost.json: the active sub-models, and versions by program.
    void describe(std::vector<ModelNote> models, std::map<std::string, std::string> versions);

    /// Files of an earlier start at the same time are replaced; what it took is noted. \throws NotWritten
    void begin() override;
    void event(const RockEvent& event) override;
    void rejected(const RejectedRock& rock) override;
    void account(double time, const AccountTotals& totals) override;
    void gate(const GateRow& row) override;
    void extraction(const ExtractionRow& row) override;
    void contacts(double time, int contacts, double overlap_ratio) override;
    void walls(double time, gsl::span<const WallForce> forces) override;
    void fates(double time, const FateTotals& totals) override;
    void ledger(double time, const RockLedger& ledger) override;
    void outflow(double time, gsl::span<const double> radial_velocity, gsl::span<const double> flux) override;
    void loads(const LoadsRow& row) override;
    void balance(const BalanceRow& row) override;
    void cost(const CostRow& row) override;
    void picture(const RockPicture& picture) override;
    void wall_work(double time, gsl::span<const WallWork> works) override;
    void outcomes(gsl::span<const RockOutcome> outcomes) override;
    void velocity(const VelocitySets& sets, double time) override;
    void finished(const RunCost& cost) override;
    /// Written to standard error and to a file at once.
    void warning(double time, const std::string& text) override;
    void flush() override;

private:
    void write_shapes(const std::vector<ClumpShape>& shapes) const;
    std::filesystem::path folder(const std::string& what) const;
    std::ofstream open(const std::string& what, const std::string& file, const std::string& header) const;
    void keep_pictures_before_start();
    void write_series() const;

    std::filesystem::path root_;
    CouplingSettings settings_;
    std::string start_;
    int ranks_;
    std::ofstream events_, rejected_, account_, gates_, extractions_, contacts_, walls_, fates_, ledger_, outflow_, flux_, loads_, balance_,
        cost_, wall_work_, warnings_;
    std::map<double, std::string> pictures_;  // files of the rock series by time
    std::vector<ModelNote> models_;
    std::map<std::string, std::string> versions_;
};

}  // namespace cutterflow::coupling
