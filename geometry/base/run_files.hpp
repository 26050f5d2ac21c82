#pragma once
/// \file Files of a run directory that two or more layers share, relative to it. docs/design/001-contracts.md describes their content.

namespace cutterflow::names {

inline constexpr const char* resolved_study = "study.resolved.toml";
inline constexpr const char* manifest = "manifest.json";
inline constexpr const char* geometry_report = "geometry/geometry.json";
inline constexpr const char* mesh_report = "mesh.json";
inline constexpr const char* prediction = "prediction.json";
inline constexpr const char* feed_report = "feed.json";
inline constexpr const char* rock_feed = "constant/rockFeed.csv";
inline constexpr const char* coupling_properties = "constant/couplingProperties";
inline constexpr const char* sample_points = "constant/samples";  ///< folder of <set>.csv, points at which velocity is averaged
inline constexpr const char* checkpoints = "checkpoints";
inline constexpr const char* dem_state = "dem.json";     ///< of a checkpoint: what the DEM adds to its restart file
inline constexpr const char* recording = "recording";    ///< folder of the flow by rotor phase
inline constexpr const char* replay = "replay.json";     ///< of a replay: the run whose flow its rock goes through
inline constexpr const char* warnings = "warnings.txt";  ///< of one start, beside cost.csv: a line each
inline constexpr const char* results_json = "report/results.json";
inline constexpr const char* report_page = "report/index.html";
inline constexpr const char* adv_json = "report/adv.json";  ///< measured and computed velocities
inline constexpr const char* adv_page = "report/adv.html";

}  // namespace cutterflow::names
