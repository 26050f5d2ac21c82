#pragma once
/// \file Many points of one study: speeds, discharges, designs, other keys, repeats. A folder of run directories, filled by as many
/// parallel runs as the cores carry.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cases/sweep/key_axes.hpp"

namespace cutterflow::cases {

/// What is varied; an empty list keeps the study's own value.
struct SweepAxes {
    std::vector<double> speeds;        ///< [rpm]
    std::vector<double> discharges;    ///< [m3/s]
    std::vector<std::string> designs;  ///< surfaces of cutters
    RepeatRange repeats = 1;
    std::vector<KeyAxis> keys{};  ///< other keys of the study
};

struct SweepPoint {
    std::string name;           ///< also of its run directory
    std::string text;           ///< of its study file, which is in the sweep's folder
    std::string design;         ///< points of one design share the first stages; empty: it shares none
    std::string start_donor{};  ///< of a repeat: the first one of its setting, whose frozen-rotor flow it takes if that is done; else empty
    std::vector<std::string> shared{"geometry", "mesh"};  ///< stages that points of one design share: what `cutterflow mesh` makes
};

/// Where a sweep keeps the studies of its points, without symbolic links. Their files are named relative to it.
std::filesystem::path studies_folder(const std::filesystem::path& sweep);

/// \throws UserError  for a path that OpenFOAM does not take; when the folder holds something else, a sweep and `resume` is false, or
/// none and `resume` is true
void require_sweep_folder(const std::filesystem::path& folder, bool resume);

/// The points of a sweep. Repeats differ in the seed of the placement and in the rotor's angle at the release, both the same for the same
/// repeat of all points, so that designs are compared in pairs.
/// \param folder  of the sweep
/// \throws UserError  with every mistake of all points that can be found without running them
std::vector<SweepPoint> sweep_points(const std::filesystem::path& study, const SweepAxes& axes, const std::filesystem::path& folder);

/// Where the points run: in this process, in parallel up to the available cores, or by Slurm, each as an element of a job array.
enum class Launcher { local, slurm };

struct SweepSettings {
    std::filesystem::path folder;
    std::filesystem::path program;  ///< cutterflow
    int ranks = 1;                  ///< of each run
    int jobs = 1;                   ///< runs in parallel
    bool resume = false;
    Launcher launcher = Launcher::local;
};

struct SweepOutcome {
    std::vector<std::filesystem::path> done;  ///< run directories
    std::vector<std::string> failed;          ///< message of each failed point
    std::size_t refused = 0;                  ///< failed points that were refused as wrong input
};

/// Runs every point to its report. A failed point is reported; the others continue. Logs of earlier calls are kept. Lines for the user go
/// to `say`.
/// \throws UserError    as require_sweep_folder and FolderLock, and when the folder holds another sweep
/// \throws Interrupted  when the user stops it; finished work is kept, submitted Slurm jobs continue
SweepOutcome run_sweep(const std::vector<SweepPoint>& points, const SweepSettings& settings,
                       const std::function<void(const std::string&)>& say);

/// Writes the studies and `<folder>/sweep.slurm`, the job array of all points that have no report yet, and starts nothing; an earlier
/// script is kept, and the new one is sweep_2.slurm and so on. Each point makes its own mesh. \return the script; empty when nothing is
/// missing
std::filesystem::path emit_slurm(const std::vector<SweepPoint>& points, const SweepSettings& settings);

}  // namespace cutterflow::cases
