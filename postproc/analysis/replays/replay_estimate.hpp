#pragma once
/// \file Spillage from many replays of one recorded flow and a few coupled runs.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/statistics/sample.hpp"
#include "postproc/analysis/results.hpp"

namespace cutterflow::postproc {

/// What became of the rock of a coupled run or of a replay.
struct RockAnswer {
    /// Of a batch spilled / (spilled + sucked up), of a feed from a cut face 1 - delivered/fed in its window; nothing while it cannot be
    /// told
    std::optional<double> spillage;
    std::string reason;          ///< why not
    double undecided = 0.0;      ///< share of the placed mass
    std::optional<FedHead> fed;  ///< of a head that is fed from a cut face
};

/// \param folder  of the run or the replay, with its fates and its ledger \param revolution  of the rotor [s]
RockAnswer rock_answer(const std::filesystem::path& folder, bool is_fed_by_cutting, double revolution, int blades);

/// What replays of a head that is fed all the time say beside their spillage, which is 1 - delivered/fed in the window of each.
struct FedReplays {
    std::size_t count = 0, steady = 0;  ///< steady: hold-up has settled; in the others spillage is one bound, spilled/fed the other
    std::size_t full = 0;               ///< in which the head was full
    double spillage_min = 0.0, spillage_max = 0.0;  ///< of spilled/fed and 1 - delivered/fed, means
    double fed = 0.0, held = 0.0;                   ///< mean rate [kg/s] and mean hold-up [kg]
    std::optional<double> own_interval;             ///< largest half 95 % interval that a replay has by its own batches of revolutions
    Losses losses;                                  ///< means
};

/// \pre a replay
FedReplays fed_replays_of(const std::vector<FedHead>& heads);

/// A coupled run and the replay of the same rock in the flow that it recorded before the rock came in.
struct ReplayPair {
    double coupled = 0.0;  ///< spillage, as RockAnswer
    double replayed = 0.0;
};

/// E[S] = E[S_replayed] + E[S_coupled - S_replayed], each mean over its own placements of rock. It is unbiased whatever the recorded flow
/// leaves out, because the second mean holds just that; its variance is small because both of a pair have the same placement. [Giles2015]
/// Half the 95 % interval is the root of the sum of squares of both means' own: it holds the truth at least that often, however few pairs
/// there are and whichever mean scatters more. [Banerjee1960]
struct ReplayEstimate {
    Sample replays;      ///< S_replayed, other placements than those of the pairs
    Sample corrections;  ///< S_coupled - S_replayed
    double spillage = 0.0;
    std::optional<double> replay_interval;      ///< half the 95 % interval of the replays' mean; of two or more
    std::optional<double> correction_interval;  ///< the same of the corrections
    std::optional<double> interval;             ///< of `spillage`; with two or more of both
};

/// \pre a replay; without pairs `spillage` is the replays' mean
ReplayEstimate estimate_spillage(const std::vector<double>& replays, const std::vector<ReplayPair>& pairs);

/// Largest mean correction with which replays may stand for coupled runs [-]: 0.05, and where a head delivers or spills little a quarter of
/// that.
double largest_correction(const ReplayEstimate& estimate);

/// Lines for the user. \param fed  of replays of a head that is fed all the time
std::string replay_text(const ReplayEstimate& estimate, const std::optional<FedReplays>& fed);

}  // namespace cutterflow::postproc
