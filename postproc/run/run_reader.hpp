#pragma once
/// \file What a run directory holds, read for the report. Which file has what: docs/design/001-contracts.md.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/head/axial_bins.hpp"
#include "geometry/head/contour.hpp"
#include "postproc/run/adv_points.hpp"
#include "postproc/run/run_table.hpp"

namespace cutterflow::postproc {

/// The study's values that the report computes with or shows; SI units.
struct OperatingPoint {
    std::string study_name;
    double speed_rpm = 0.0;  ///< of the rotor, > 0
    std::string rotor_direction;
    double discharge = 0.0;     ///< of the mixture [m3/s], > 0
    double mouth_radius = 0.0;  ///< [m], > 0
    double mouth_offset = 0.0;  ///< of the mouth's centre from the rotor's axis [m]
    double mouth_azimuth_deg = 0.0;
    double inclination_deg = 0.0;
    double fluid_density = 0.0;             ///< [kg/m3], > 0
    double outflow_start = 0.0;             ///< start of the averaging window of outflow and loads [s]
    double length_ratio = 1.0;              ///< prototype length over model length, > 0
    std::string swing_direction;            ///< may be empty
    std::string mesh_preset;                ///< may be empty
    bool fed_by_cutting = false;            ///< rock comes all the time, from a cut face
    bool has_bank = false;                  ///< soil stands beside the head
    bool bank_of_file = false;              ///< and is the user's own: cut_height is what the swing cuts and not its top
    double swing_speed = 0.0;               ///< [m/s]; 0: not given
    double in_situ_density = 0.0;           ///< dry grains per volume of soil, rho_grain (1 - n) [kg/m3]; 0: not given
    double grain_density = 0.0;             ///< of the soil [kg/m3]; 0: not given
    double bulking = 1.5;                   ///< volume of loose rock over that of soil
    double cut_height = 0.0, step = 0.0;    ///< of the bank [m]; 0: not given
    double standing_out = 0.0;              ///< of picks and clearance beyond the contour [m]
    double spill_layer = 0.0;               ///< that the swing before left [m]
    double rock_share = 1.0;                ///< of what is cut; the rest are fines, which are not followed
    bool hauls = false;                     ///< the run's frame travels with the head
    std::optional<double> specific_energy;  ///< of cutting [J/m3]
    double revolution_s() const { return 60.0 / speed_rpm; }
    double angular_speed() const { return rpm_to_rad_s(speed_rpm); }  ///< [rad/s], > 0
};

/// Rock of one size in a feed.
struct RockClass {
    double diameter = 0.0;  ///< [m]
    double density = 0.0;   ///< [kg/m3]
    double count = 0.0;
    std::optional<double> settling_velocity;  ///< of a single rock in still water [m/s]
};

/// Content of feed.json, summed over the feeds.
struct FeedSummary {
    std::int64_t requested = 0;
    std::int64_t rejected = 0;
    std::vector<std::string> reasons;
    std::vector<RockClass> classes;
    double left_share = 0.0;                             ///< of the mass: loose rock that the swing before left
    std::vector<double> layer_thickness, layer_section;  ///< of layers that a swing may leave [m], and what the next takes of each [m2]
};

/// Tables of the rock; present once rock was put in.
struct RockTables {
    Table events;
    Table fates;
    Table ledger;       ///< where all rock that was due is; empty in a run of before there was one
    Table final_state;  ///< one row per rock, as of the last checkpoint or of the end
    std::size_t rejected_in_run = 0;
};

inline constexpr const char* k_replay_schema = "cutterflow.replay/1";

/// Follows the name of a setting whose rock goes through a recorded flow.
inline constexpr const char* k_replayed = ", replayed";

/// The flow that the rock of a replay goes through and does not change.
struct RecordedFlow {
    std::filesystem::path run;       ///< that recorded it
    double start = 0.0, end = 0.0;   ///< of the recording, in that run's time [s]
    std::optional<double> change{};  ///< of the flow in the turning zone in the recorded revolution [-], where it is known
};

struct RunData {
    std::filesystem::path directory;
    OperatingPoint operating_point;
    geometry::Contour contour;
    std::vector<geometry::AxialBin> bins;
    std::optional<FeedSummary> feed;  ///< none: a pure flow run
    std::optional<RockTables> rock;
    Table outflow;       ///< radial velocities; may be empty
    Table outflow_flux;  ///< of the same bins, outwards [m3/s]; empty in runs of earlier programs
    Table loads;
    Table balance;
    Table cost;
    Table plane_axial, plane_under_ring;                    ///< mean velocity on planes; empty when the run did not sample them
    nlohmann::json geometry, mesh, manifest, cost_summary;  ///< objects, empty when the file is absent
    int blades = 1;                                         ///< of the cutter; 1 when unknown
    AdvProbe adv_probe;                                     ///< with which the run sampled its places of measurement, if it has any
    bool finished = false;                                  ///< the run came to its end
    std::map<std::string, std::string> setting{};           ///< as StudySetting::values
    std::string release{};                                  ///< as StudySetting::release
    int seed = 0;                                           ///< of the first feed
    nlohmann::json prediction{};                            ///< of the run's cost, before it; empty when the file is absent
    std::optional<double> core_s{};                         ///< of the solver in all starts, as solver_core_seconds
    std::vector<std::string> warnings{};                    ///< of the solver, as first_warnings
    std::optional<RecordedFlow> flow{};                     ///< of a replay, which has rock: all but rock, feed and cost is then that run's

    /// Largest radius of the head's contour [m].
    double tip_radius() const { return *std::max_element(contour.radius().begin(), contour.radius().end()); }
    /// Of the cutter and of what stands around it.
    const std::filesystem::path& geometry_directory() const { return flow ? flow->run : directory; }
};

/// fates.csv of a run or a replay, joined over its restarts; empty when no rock was put in. \throws UserError  as read_table
Table read_fates(const std::filesystem::path& run_directory);

/// events.csv of a run or a replay, likewise.
Table read_events(const std::filesystem::path& run_directory);

/// Column of ledger.csv: of left_behind_kg, what was never taken in. Runs of earlier programs have none.
inline constexpr const char* k_left_behind_cutting = "left_behind_cutting_kg";

/// Columns of balance.csv that runs of earlier programs do not have: how often the coupling fell back on a bound.
inline constexpr const char* k_swept_limited_cells = "swept_limited_cells";
inline constexpr const char* k_wake_limited_rocks = "wake_limited_rocks";
inline constexpr const char* k_hidden_rocks = "hidden_rocks";
inline constexpr const char* k_cramped_rocks = "cramped_rocks";

/// ledger.csv of a run or a replay, likewise.
Table read_ledger(const std::filesystem::path& run_directory);

/// Reads a run directory, finished or not, or the folder of a replay.
/// \throws UserError  when it is not a run directory, nothing was computed yet, or a file breaks its contract
RunData read_run(const std::filesystem::path& run_directory);

}  // namespace cutterflow::postproc
