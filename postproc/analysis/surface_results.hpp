#pragma once
/// \file What a free-surface run found: events of its bodies, levels, balances.
#include <filesystem>
#include <limits>

#include <nlohmann/json.hpp>

#include "postproc/run/run_table.hpp"

namespace cutterflow::postproc {

inline constexpr double k_never = std::numeric_limits<double>::infinity();

/// Rows of a run, joined over its restarts.
struct SurfaceRows {
    nlohmann::json scene;   ///< scene.json
    Table balance, levels;  ///< every step
    Table bodies;           ///< at outputs; empty without bodies
    Table gauges;           ///< every step and gauge; empty without gauges
    double core_s = 0.0;    ///< of all processes, also of steps that a resumed one computed again
    bool has_bodies() const { return scene.at("bodies").get<int>() > 0; }
    bool has_pipe() const { return !scene.value("pipe", nlohmann::json()).is_null(); }
};

/// \throws UserError  when the folder is no run of a free-surface study or has no rows yet
SurfaceRows read_surface_rows(const std::filesystem::path& run_directory);

struct SurfaceResults {
    double end_s = 0.0, core_s = 0.0;
    double through_walls = 0.0;                        ///< particles that passed a pipe's wall; 0 in runs that did not count them
    double volume_error = 0.0;                         ///< of the occupied volume: the largest of all steps, with its sign
    double arrival_s = k_never;                        ///< a body at the right wall, a contact gap off
    double half_out_s = k_never, all_out_s = k_never;  ///< of the pipe
    double greatest_drop_m = 0.0, drop_at_s = 0.0;     ///< level outside less that in the pipe
    double reversal_s = k_never;                       ///< water first flows up into the mouth after it has flown down
    bool rises_with_bodies = false;                    ///< bodies in the pipe rise in the mean at some time after the reversal
};

/// A column that runs of earlier versions do not have; null then.
const std::vector<double>* counted(const Table& table, const std::string& column);

SurfaceResults surface_results(const SurfaceRows& rows);

/// Times that never came are null.
nlohmann::json to_json(const SurfaceResults& results);

}  // namespace cutterflow::postproc
