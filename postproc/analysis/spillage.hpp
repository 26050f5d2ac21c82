#pragma once
/// \file Spillage: fates, ratios with their bounds, axial bins of the last exit.
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/head/axial_bins.hpp"
#include "postproc/run/run_table.hpp"

namespace cutterflow::postproc {

struct RockAmount {
    int count = 0;
    double mass = 0.0;  ///< [kg]
};

/// The four fates at one time. They add up to `placed`.
struct Fates {
    double time = 0.0;  ///< [s]
    RockAmount placed, sucked_up, spilled, in_cutter, never_entered;
};

/// Row of fates.csv.
/// \throws CheckFailure  when the four counts do not add up to placed, or their masses to 1e-6 of it
Fates fates_at(const Table& fates, std::size_t row);

/// Ratios by mass. Each is absent when undefined; `reason` gives the reason.
struct SpillageRatios {
    std::optional<double> ratio;      ///< spilled / (spilled + sucked_up)
    std::optional<double> ratio_min;  ///< spilled / placed: as if all undecided rock were sucked up
    std::optional<double> ratio_max;  ///< 1 - sucked_up / placed: as if all undecided rock were spilled
    std::optional<double> undecided;  ///< ratio_max - ratio_min; exactly 0 when all rock is decided
    std::string reason;
};

SpillageRatios ratios_of(const Fates& fates);

/// State of one rock up to some time, from the events.
struct RockHistory {
    double mass = 0.0;       ///< [kg]
    double volume = 0.0;     ///< [m3]
    bool sucked_up = false;  ///< final
    bool outside = false;    ///< its last crossing of the head's boundary led out
    std::string last_exit_bin;
    double last_exit_time = 0.0, last_exit_azimuth = 0.0;  ///< [s], [rad] as below; of a rock that left the head
    std::optional<double> first_exit_azimuth;              ///< [rad], in [0, 2 pi), 0 lowest; of the first crossing that led out
    bool is_spilled() const { return outside && !sucked_up; }
};

/// Reads events in time order and keeps what is known of each rock.
class RockHistories {
public:
    /// Takes in the events up to `time` [s] that were not taken in yet.
    void advance(const Table& events, double time);
    const std::map<int, RockHistory>& rocks() const { return rocks_; }
    int sucked_up() const { return sucked_up_; }
    int spilled() const { return spilled_; }
    std::optional<double> feed_start() const { return feed_start_; }  ///< time of the first event of the feed [s]

private:
    void take(const Table& events, std::size_t row);
    std::map<int, RockHistory> rocks_;
    std::size_t next_ = 0;
    int sucked_up_ = 0;
    int spilled_ = 0;
    std::optional<double> feed_start_;
};

struct BinSpillage {
    geometry::AxialBin bin;
    RockAmount spilled;
};

/// Spilled rock by the bin of its last exit; all bins. \throws CheckFailure  when rock left through a bin that is none of `bins`
std::vector<BinSpillage> bin_spilled_rock(const std::map<int, RockHistory>& rocks, const std::vector<geometry::AxialBin>& bins);

/// Share of the placed rock from which on a bin counts as open to rock.
inline constexpr double k_open_to_rock = 0.01;

/// Name of the uppermost bin below the ring plane through which k_open_to_rock or more of the rock left; where there is none, of the bin at
/// the ring plane. A ring's own steel closes the bins that it reaches over, so that this is the first below its underside.
/// \param share_through  of the placed rock, through the bin of a name
std::string top_bin(const std::vector<geometry::AxialBin>& bins, const std::function<double(const std::string&)>& share_through);

/// Ratios when a given time has passed since the first rock came in.
struct RatiosAt {
    double since_feed = 0.0;  ///< revolutions or seconds
    double time = 0.0;        ///< of the row that was used [s]
    Fates fates;
    SpillageRatios ratios;
};

struct Spillage {
    Fates fates;  ///< at the last time that fates and events agree on
    SpillageRatios ratios;
    std::vector<BinSpillage> bins;            ///< of the last exit; all bins, adding up to fates.spilled
    std::vector<RatiosAt> at_revolutions;     ///< after 1, 2, 3 ... revolutions since the first rock
    std::vector<RatiosAt> at_seconds;         ///< after 1, 2, 3 ... seconds
    std::vector<double> first_exit_azimuths;  ///< [rad] of every rock that left the head and was not sucked up, by id
    double feed_start = 0.0;                  ///< [s]
    double sucked_volume = 0.0;               ///< of sucked up rock [m3]
};

/// Fates and ratios when `since_feed` [s] have passed since the first rock: those of the last row before. \pre fates has such a row
RatiosAt ratios_after(const Table& fates, double feed_start, double since_feed);

/// Evaluates fates.csv and events.csv (neither empty of columns; fates with rows).
/// \param revolution  time of one revolution [s] > 0
/// \param finished    the run came to its end: then the last row of fates and the events must agree
/// \throws CheckFailure  when counts do not add up, or fates and events contradict each other
Spillage evaluate_spillage(const Table& fates, const Table& events, const std::vector<geometry::AxialBin>& bins, double revolution,
                           bool finished);

}  // namespace cutterflow::postproc
