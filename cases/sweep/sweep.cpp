#include "cases/sweep/sweep.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "cases/runner/manifest.hpp"
#include "cases/runner/run_directory.hpp"
#include "cases/runner/run_progress.hpp"
#include "cases/runner/stages.hpp"
#include "cases/scenes/cutter/checked_study.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/study/study.hpp"
#include "cases/study/study_shapes.hpp"
#include "cases/sweep/slurm.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/stop_signals.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_studies = "studies";
constexpr const char* k_logs = "logs";

/// The values of an axis, or one absent value that keeps the study's.
template <typename T>
std::vector<std::optional<T>> or_own(const std::vector<T>& values) {
    if (values.empty()) return {std::nullopt};
    return {values.begin(), values.end()};
}

/// One point of a sweep; what is absent stays as the study has it.
struct Combination {
    std::optional<std::string> design;
    std::optional<double> speed, discharge;
    std::size_t keys = 0;  ///< index of the setting of other keys
    int repeat = 0;        ///< from 0 on
};

std::vector<Combination> combinations_of(const SweepAxes& axes, std::size_t key_settings) {
    std::vector<Combination> all;
    for (const auto& design : or_own(axes.designs))
        for (const auto& speed : or_own(axes.speeds))
            for (const auto& discharge : or_own(axes.discharges))
                for (std::size_t keys = 0; keys < key_settings; ++keys)
                    for (int repeat = 0; repeat < axes.repeats.count; ++repeat) all.push_back({design, speed, discharge, keys, repeat});
    return all;
}

/// "a_60rpm_0.12m3_s": common part of the names of a point's repeats.
std::string setting_name(const Combination& combination, const std::string& keys, const std::string& study) {
    std::vector<std::string> parts;
    if (combination.design) parts.push_back(safe_name(fs::path(*combination.design).stem().string()));
    if (combination.speed) parts.push_back(fmt::format("{:g}rpm", *combination.speed));
    if (combination.discharge) parts.push_back(fmt::format("{:g}m3_s", *combination.discharge));
    if (parts.empty()) parts.push_back(safe_name(study));
    return fmt::format("{}{}", fmt::join(parts, "_"), keys);
}

ParameterValues values_of(const Combination& combination, ParameterValues values, const std::string& setting, bool has_keys) {
    if (combination.design || combination.speed || combination.discharge || has_keys)
        values.set("name", fmt::format("{}: {}", values.text("name"), setting));
    if (combination.speed) values.set("rotor.speed_rpm", *combination.speed);
    if (combination.discharge) values.set("suction.discharge_m3_s", *combination.discharge);
    return values;
}

/// What tells apart points of one cutter that cannot share geometry and mesh.
std::string shape_of(const ParameterValues& values, const std::vector<KeyAxis>& axes) {
    std::string shape;
    for (const KeyAxis& axis : axes) {
        const Parameter& parameter = *find_key(study_table(), axis.key)->parameter;
        if (parameter.stage == k_geometry_stage || parameter.stage == k_mesh_stage)
            shape += fmt::format("|{}={}", axis.key, toml_text(*values.find(axis.key)));
    }
    return shape;
}

/// \throws UserError  for keys that other options vary
void require_other_keys(const std::vector<KeyAxis>& axes) {
    static const std::map<std::string, std::string> options{
        {"rotor.speed_rpm", "--rpm"}, {"suction.discharge_m3_s", "--discharge"}, {"cutter.file", "--design"},
        {"feed.seed", "--repeats"},   {"feed.start_revolution", "--repeats"},    {"name", "separate studies"}};
    Mistakes mistakes;
    for (const KeyAxis& axis : axes)
        if (const auto option = options.find(axis.key); option != options.end())
            mistakes.add("--set " + axis.key, "The sweep has a way of its own to vary it", "Use " + option->second);
    mistakes.refuse();
}

/// A path of the user's (relative to where the command was given) as the studies in the sweep's folder name it. A file that is a symbolic
/// link is named, not what it leads to; folders are not, as ".." leaves what a link leads to.
std::string from_studies(const fs::path& path, const fs::path& folder) {
    const fs::path file = fs::absolute(path);
    return (fs::weakly_canonical(file.parent_path()) / file.filename()).lexically_relative(studies_folder(folder)).string();
}

/// Keys of a study that name files, beside the cutter's.
std::vector<std::string> other_files(const ParameterValues& values) {
    std::vector<std::string> keys;
    for (const Parameter& parameter : study_table())
        if (parameter.kind == ParameterKind::path && parameter.key != "cutter.file" && values.has(parameter.key))
            keys.push_back(parameter.key);
    return keys;
}

/// Reads cutters once each: a sweep names the same design many times.
class Designs {
public:
    const geometry::Head& head_of(ParameterValues values, const fs::path& cutter) {
        const std::string file = fs::absolute(cutter).lexically_normal().string();
        auto found = heads_.find(file);
        if (found == heads_.end()) {
            values.set("cutter.file", file);
            found = heads_.emplace(file, *import_study_cutter(values, "").head).first;
        }
        return found->second;
    }

private:
    std::map<std::string, geometry::Head> heads_;
};

/// A point of a sweep before its repeat's seed and release are set.
struct UnplacedPoint {
    std::string setting;  ///< common part of the names of its repeats
    std::string name;
    fs::path cutter;
    std::size_t keys = 0;  ///< as Combination::keys
    int repeat = 0;        ///< as the study counts them, from 0 on
    ParameterValues values;
};

std::vector<UnplacedPoint> unplaced_points(const fs::path& study, const SweepAxes& axes, const std::string& own_cutter,
                                           const std::vector<KeySetting>& settings) {
    std::vector<UnplacedPoint> points;
    for (const Combination& combination : combinations_of(axes, settings.size())) {
        if (combination.design && !fs::exists(*combination.design)) continue;
        const KeySetting& keys = settings[combination.keys];
        UnplacedPoint point;
        point.setting = point.name = setting_name(combination, keys.name, study.stem().string());
        point.cutter = combination.design.value_or((study.parent_path() / own_cutter).string());
        point.keys = combination.keys;
        point.repeat = axes.repeats.first + combination.repeat;
        if (axes.repeats.are_numbered()) point.name += fmt::format("_repeat{}", point.repeat + 1);
        point.values = values_of(combination, keys.values, point.setting, !axes.keys.empty());
        points.push_back(std::move(point));
    }
    return points;
}

/// When the repeats of a sweep are released. Repeat n of a point is released later than the study by a share of a blade's passing that n
/// alone makes, so that more repeats can be added. A sweep that was begun before 2026-11-30 keeps its releases: k/N of a passing for
/// repeat k, from 0 on, of N.
class Releases {
public:
    /// \param first  of the sweep's repeats
    explicit Releases(int first) : first_(first) {}

    /// Looks at a study that is there: by which rule its repeat is released. \param own  the study before its release is varied
    void keep(const fs::path& file, const ParameterValues& own, int repeat, int blades) {
        const ReadParameters begun = parse_with_mistakes(study_table(), read_file(file), file.string());
        if (!begun.mistakes.empty() || begun.values.tables("feed").empty() || own.tables("feed").empty()) return;
        const double start = begin_of(own), begun_at = begin_of(begun.values);
        const double count = repeat > first_ ? std::round((repeat - first_) / (blades * (begun_at - start))) : 1.0;
        if (!(count >= 1.0 && count <= k_most_repeats)) return;
        const int n = static_cast<int>(count);
        if (start + later_of(repeat, n, blades) == begun_at) counts_[repeat] = n;
    }

    /// [revolutions]
    double later(int repeat, int blades) const {
        const auto found = counts_.find(repeat);
        return found == counts_.end() ? release_share(repeat) / blades : later_of(repeat, found->second, blades);
    }

private:
    static constexpr double k_most_repeats = 100.0;

    double later_of(int repeat, int count, int blades) const { return static_cast<double>(repeat - first_) / (count * blades); }
    static double begin_of(const ParameterValues& study) { return start_revolution(study, study.tables("feed").front()); }

    int first_;
    std::map<int, int> counts_;  // repeats of a sweep of an earlier program, by repeat
};

Releases releases_of(const std::vector<UnplacedPoint>& points, int first, const fs::path& folder, Designs& designs) {
    Releases releases(first);
    for (const UnplacedPoint& point : points) {
        const fs::path file = studies_folder(folder) / (point.name + ".toml");
        if (!fs::exists(file)) continue;
        try {
            releases.keep(file, point.values, point.repeat, designs.head_of(point.values, point.cutter).symmetry.blade_count);
        } catch (const UserError&) {
            // A cutter that cannot be read is told with its points, a study that is no TOML with those that have changed.
        }
    }
    return releases;
}

/// What is wrong with a design is wrong at each of its points.
void add_once(const Mistake& mistake, std::vector<Mistake>& all) {
    const bool known = std::any_of(all.begin(), all.end(), [&](const Mistake& other) { return other.text() == mistake.text(); });
    if (!known) all.push_back(mistake);
}

void check_names(const std::vector<SweepPoint>& points) {
    std::map<std::string, int> count;
    for (const SweepPoint& point : points) ++count[point.name];
    std::vector<Mistake> mistakes;
    for (const auto& [name, times] : count)
        if (times > 1)
            mistakes.push_back({"", fmt::format("{} points are called {}", times, name), "Each point of a sweep differs from all others",
                                "Name each value once, and give designs different file names"});
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

/// Writes the studies, or finds them as they are.
void write_studies(const std::vector<SweepPoint>& points, const SweepSettings& settings) {
    require_sweep_folder(settings.folder, settings.resume);
    const fs::path studies = settings.folder / k_studies;
    std::vector<Mistake> mistakes;
    std::vector<const SweepPoint*> added;
    for (const SweepPoint& point : points) {
        const fs::path file = studies / (point.name + ".toml");
        if (!fs::exists(file))
            added.push_back(&point);
        else if (read_file(file) != point.text)
            mistakes.push_back({file.string(), "the study of this point has changed", "A point's results belong to its study",
                                "Name another folder with -o, or undo the change"});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    for (const SweepPoint* point : added) write_file(studies / (point->name + ".toml"), point->text);
}

/// Share done from a line "run: 42 %, ..."; nothing for other lines.
std::optional<double> share_of(const std::string& line) {
    const std::string start = "  run: ";
    const std::size_t percent = line.find(" %");
    if (line.rfind(start, 0) != 0 || percent == std::string::npos) return std::nullopt;
    return std::strtod(line.c_str() + start.size(), nullptr) / 100.0;
}

/// `cutterflow mesh` or `cutterflow run` of a point.
ChildCommand command_of(const SweepSettings& settings, const SweepPoint& point, const std::string& what) {
    ChildCommand command;
    command.arguments = {settings.program.string(),
                         what,
                         (settings.folder / k_studies / (point.name + ".toml")).string(),
                         "-o",
                         (settings.folder / point.name).string(),
                         "--ranks",
                         std::to_string(settings.ranks)};
    command.arguments.emplace_back("--resume");
    if (what == "run" && !point.start_donor.empty() && fs::is_directory(settings.folder / point.start_donor))
        command.arguments.insert(command.arguments.end(), {"--start-from", (settings.folder / point.start_donor).string()});
    command.log = settings.folder / k_logs / fmt::format("{}.{}.log", point.name, what);
    return command;
}

/// The first point of each design makes the mesh; the others get a copy.
std::map<std::string, std::string> mesh_donors(const std::vector<SweepPoint>& points) {
    std::map<std::string, std::string> donors;
    for (const SweepPoint& point : points)
        if (!point.design.empty()) donors.emplace(point.design, point.name);
    return donors;
}

/// Points that have to make a mesh for others, or to finish it.
std::vector<SweepPoint> points_to_mesh(const std::vector<SweepPoint>& points, const SweepSettings& settings) {
    const auto donors = mesh_donors(points);
    std::vector<SweepPoint> to_mesh;
    for (const SweepPoint& point : points)
        if (!point.design.empty() && donors.at(point.design) == point.name && !stages_are_done(settings.folder / point.name, point.shared))
            to_mesh.push_back(point);
    return to_mesh;
}

void share_meshes(const std::vector<SweepPoint>& points, const SweepSettings& settings) {
    const auto donors = mesh_donors(points);
    for (const SweepPoint& point : points) {
        if (point.design.empty()) continue;
        const std::string& donor = donors.at(point.design);
        if (donor != point.name) share_stages(settings.folder / donor, settings.folder / point.name, point.shared);
    }
}

/// How far the points of a sweep are, all together.
class SweepProgress {
public:
    explicit SweepProgress(std::size_t points) : shares_(points, 0.0) {}
    void note(std::size_t point, std::optional<double> share) {
        if (!share) return;
        shares_[point] = *share;
        double sum = 0.0;
        for (const double value : shares_) sum += value;
        const auto done = std::count(shares_.begin(), shares_.end(), 1.0);
        progress_.update(sum / static_cast<double>(shares_.size()), fmt::format("{} of {} points", done, shares_.size()));
    }
    void finish() { progress_.finish(); }

private:
    std::vector<double> shares_;
    Progress progress_{"sweep"};
};

/// The points on this machine's cores.
class LocalRuns {
public:
    LocalRuns(const std::vector<SweepPoint>& points, const SweepSettings& settings, const std::function<void(const std::string&)>& say)
        : points_(points), settings_(settings), say_(say), order_(points.size()), progress_(points.size()) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        // First repeats first: the others find their start done.
        std::stable_partition(order_.begin(), order_.end(), [&](std::size_t i) { return points_[i].start_donor.empty(); });
    }

    SweepOutcome take_all() {
        const StopSignals signals;
        for (const SweepPoint& point : points_to_mesh(points_, settings_)) {
            say_(fmt::format("{}: mesh", point.name));
            run_child(command_of(settings_, point, "mesh"));  // on failure the point's own run reports the reason
        }
        share_meshes(points_, settings_);
        std::vector<std::thread> workers;
        for (std::size_t job = 0; job < std::min(static_cast<std::size_t>(settings_.jobs), k_most_children); ++job)
            workers.emplace_back([this] { work(); });
        for (std::thread& worker : workers) worker.join();
        if (interrupted_) throw Interrupted(fmt::format("{}; {} of {} points are done", *interrupted_, finished_, points_.size()));
        signals.require_none();
        progress_.finish();
        SweepOutcome outcome;
        for (std::size_t i = 0; i < points_.size(); ++i)
            if (failures_.count(i) == 0) outcome.done.push_back(settings_.folder / points_[i].name);
        for (const auto& [index, text] : failures_) outcome.failed.push_back(text);
        outcome.refused = refused_;
        return outcome;
    }

private:
    void work() {
        for (std::size_t n = next_++; n < points_.size(); n = next_++) {
            const std::size_t i = order_[n];
            {
                const std::lock_guard<std::mutex> lock(mutex_);
                if (interrupted_) return;
                say_(fmt::format("{}: begins", points_[i].name));
            }
            take(i);
        }
    }

    void take(std::size_t i) {
        const ChildCommand command = command_of(settings_, points_[i], "run");
        try {
            keep_older_log(command.log);
            const ChildResult result = run_child(command, [&](const std::string& line) { note(i, share_of(line)); });
            const std::lock_guard<std::mutex> lock(mutex_);
            if (result.exit_code == 0) {
                ++finished_;
                say_(fmt::format("{}: done in {}", points_[i].name, duration_text(result.wall_s)));
            } else {
                failures_[i] = failure_of(command, result).text();
                refused_ += result.exit_code == static_cast<int>(ExitCode::user_input) ? 1 : 0;
                say_(fmt::format("{}: failed, the sweep continues; see {}", points_[i].name, command.log.string()));
            }
        } catch (const Interrupted& stop) {
            const std::lock_guard<std::mutex> lock(mutex_);
            interrupted_ = stop.what();
            return;
        } catch (const std::exception& error) {
            const std::lock_guard<std::mutex> lock(mutex_);
            failures_[i] = fmt::format("{}: {}", points_[i].name, error.what());
        }
        note(i, 1.0);
    }

    void note(std::size_t i, std::optional<double> share) {
        const std::lock_guard<std::mutex> lock(mutex_);
        progress_.note(i, share);
    }

    const std::vector<SweepPoint>& points_;
    const SweepSettings& settings_;
    const std::function<void(const std::string&)>& say_;
    std::vector<std::size_t> order_;  // in which points are taken
    std::atomic<std::size_t> next_{0};
    std::mutex mutex_;
    std::map<std::size_t, std::string> failures_;
    std::size_t refused_ = 0;
    std::optional<std::string> interrupted_;
    std::size_t finished_ = 0;
    SweepProgress progress_;
};

/// Whether the last stage is done. The run directory shows the result of a job; a scheduler forgets it.
bool has_report(const fs::path& run) {
    if (!fs::exists(run / names::manifest)) return false;
    const Manifest manifest(run / names::manifest);
    const StageRecord* report = manifest.find("report");
    return report != nullptr && report->state == StageState::done;
}

std::vector<SweepPoint> without_report(const std::vector<SweepPoint>& points, const SweepSettings& settings) {
    std::vector<SweepPoint> missing;
    for (const SweepPoint& point : points)
        if (!has_report(settings.folder / point.name)) missing.push_back(point);
    return missing;
}

/// "mesh.slurm", or with a number when that is taken: its user may have changed the script of an earlier start.
fs::path free_script(const fs::path& folder, const std::string& what) {
    fs::path script = folder / (what + ".slurm");
    for (int i = 2; fs::exists(script); ++i) script = folder / fmt::format("{}_{}.slurm", what, i);
    return script;
}

/// What tells the job of a sweep to a later call.
fs::path job_file(const SweepSettings& settings) {
    return settings.folder / "slurm.job";
}

/// Writes the job array that takes `points` through `what`. \param by_user  submitted by the user: the job notes itself
/// \return the script, a new one
fs::path write_slurm_script(const std::vector<SweepPoint>& points, const SweepSettings& settings, const std::string& what, bool by_user) {
    SweepSettings absolute = settings;  // the working directory of a job is not defined
    absolute.folder = fs::absolute(settings.folder).lexically_normal();
    std::vector<SlurmTask> tasks;
    for (const SweepPoint& point : points) {
        if (what == "run" && !point.start_donor.empty()) fs::create_directories(absolute.folder / point.start_donor);
        const ChildCommand command = command_of(absolute, point, what);
        tasks.push_back({command.arguments, command.log});
    }
    fs::create_directories(absolute.folder / k_logs);
    const fs::path script = free_script(settings.folder, what == "run" ? "sweep" : "mesh");
    write_file(script, slurm_script(fmt::format("cutterflow_{}", safe_name(absolute.folder.filename().string())), tasks, settings.ranks,
                                    by_user ? job_file(absolute) : fs::path()));
    return script;
}

/// The points as elements of a job array.
class SlurmRuns {
public:
    SlurmRuns(const std::vector<SweepPoint>& points, const SweepSettings& settings, const std::function<void(const std::string&)>& say)
        : points_(points), settings_(settings), say_(say), progress_(points.size()) {}

    SweepOutcome take_all() {
        require_programs({"sbatch", "squeue"});
        wait_for_earlier_job();
        take(points_to_mesh(points_, settings_), "mesh");
        share_meshes(points_, settings_);
        take(without_report(points_, settings_), "run");
        progress_.finish();
        SweepOutcome outcome;
        for (const SweepPoint& point : points_) {
            if (has_report(settings_.folder / point.name))
                outcome.done.push_back(settings_.folder / point.name);
            else
                outcome.failed.push_back(failure_text(point));
        }
        return outcome;
    }

private:
    /// The process that submitted a job may have ended while the job is still running.
    void wait_for_earlier_job() {
        if (!fs::exists(job_file(settings_))) return;
        const SlurmJob job = slurm_job(read_file(job_file(settings_)));
        say_(fmt::format("waiting for job {}, submitted earlier, if it is still running", job.number));
        wait(job);
    }

    void take(const std::vector<SweepPoint>& points, const std::string& what) {
        if (points.empty()) return;
        for (const SweepPoint& point : points) keep_older_log(command_of(settings_, point, what).log);
        const SlurmJob job = submit_to_slurm(write_slurm_script(points, settings_, what, false));
        write_file(job_file(settings_), job.text());
        say_(fmt::format("job {}: {} of {} point(s); {} ends it", job.number, what, points.size(), job.cancel()));
        wait(job);
    }

    void wait(const SlurmJob& job) {
        try {
            wait_for_slurm(job, [this] { look(); });
        } catch (const Interrupted&) {
            throw Interrupted(fmt::format("the waiting for job {} was stopped, the job continues ({} ends it)", job.number, job.cancel()));
        }
    }

    void look() {
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const fs::path log = command_of(settings_, points_[i], "run").log;
            if (has_report(settings_.folder / points_[i].name))
                progress_.note(i, 1.0);
            else if (fs::exists(log))
                progress_.note(i, last_share(read_file(log)));
        }
    }

    static std::optional<double> last_share(const std::string& log) {
        std::istringstream lines(log);
        std::optional<double> share;
        for (std::string line; std::getline(lines, line);)
            if (const auto found = share_of(line)) share = std::min(*found, 0.999);
        return share;
    }

    std::string failure_text(const SweepPoint& point) const {
        const fs::path log = command_of(settings_, point, "run").log;
        if (!fs::exists(log)) return fmt::format("{}: its job ended before it began", point.name);
        return fmt::format("{}: its job ended without a report (cancelled, out of time or memory, or failed); see {}", point.name,
                           log.string());
    }

    const std::vector<SweepPoint>& points_;
    const SweepSettings& settings_;
    const std::function<void(const std::string&)>& say_;
    SweepProgress progress_;
};

}  // namespace

fs::path studies_folder(const fs::path& sweep) {
    return fs::weakly_canonical(fs::absolute(sweep)) / k_studies;
}

void require_sweep_folder(const fs::path& folder, bool resume) {
    require_openfoam_path(fs::absolute(folder));
    const bool begun = fs::exists(folder / k_studies);
    if (resume && !begun)
        throw UserError(fmt::format("{} holds no sweep", folder.string()), "--resume goes on with a sweep that was begun",
                        "Correct the folder given with -o, or leave --resume out");
    if (begun && !resume)
        throw UserError(fmt::format("{} already contains a sweep", folder.string()), "Its runs are kept",
                        "Add --resume to continue it, or name another folder with -o");
    if (!begun && holds_files(folder))
        throw UserError(fmt::format("{} already contains something else", folder.string()), "Nothing is overwritten",
                        "Name another folder with -o");
}

std::vector<SweepPoint> sweep_points(const fs::path& study, const SweepAxes& axes, const fs::path& folder) {
    Mistakes early;
    for (const std::string& design : axes.designs)
        early.require(fs::exists(design), fmt::format("--design {} does not exist", design), "Its path is relative to the current folder",
                      "Check the path");
    early.gather([&] { require_other_keys(axes.keys); });
    ParameterValues base;
    std::vector<KeySetting> settings;
    if (!early.gather([&] {
            base = read_study(study);
            settings = key_settings(study_table(), base, axes.keys);
            require_random(!base.tables("feed").empty(), axes.repeats.count, study.string(), "placement and release of their rock",
                           "Give the study a [[feed]]");
        }))
        early.refuse();
    std::vector<Mistake> mistakes = early.take();
    std::vector<SweepPoint> points;
    Designs designs;
    std::set<std::pair<std::string, std::size_t>> placed;
    const std::vector<UnplacedPoint> unplaced = unplaced_points(study, axes, base.text("cutter.file"), settings);
    const Releases releases = releases_of(unplaced, axes.repeats.first, folder, designs);
    for (const auto& [setting, name, cutter, keys, repeat, own] : unplaced) {
        ParameterValues values = own;
        try {
            const geometry::Head& head = designs.head_of(values, cutter);
            vary_release(values, repeat, releases.later(repeat, head.symmetry.blade_count));
            const ParameterValues placed_here = values;
            values.set("cutter.file", from_studies(cutter, folder));
            const auto beside_study = [&](const std::string& path) { return from_studies(study.parent_path() / path, folder); };
            for (const std::string& key : other_files(values)) values.set(key, beside_study(values.text(key)));
            move_shapes(values, beside_study);
            const std::string text = commented_toml(study_table(), &values);
            parse_parameters(study_table(), text, name);  // bounds of what the axes set
            points.push_back({name, text, cutter.lexically_normal().string() + shape_of(values, axes.keys),
                              repeat > axes.repeats.first ? fmt::format("{}_repeat{}", setting, axes.repeats.first + 1) : std::string()});
            const ParameterValues resolved = resolve_study(placed_here, head_size(head));
            std::vector<Mistake> wrong = check_file_rules(placed_here, name);
            for (const std::string& key : other_files(placed_here))
                if (const auto missing = missing_file(placed_here, key.c_str(), study.parent_path())) wrong.push_back(*missing);
            const std::vector<Mistake> beside_head = check_study(resolved, head_size(head));
            wrong.insert(wrong.end(), beside_head.begin(), beside_head.end());
            for (Mistake mistake : wrong) {
                mistake.where = name;
                add_once(mistake, mistakes);
            }
            // Speeds and discharges hardly move rock or bank: one placement of each design and setting of keys.
            if (wrong.empty() && placed.emplace(cutter.string(), keys).second) place_study(resolved, head, study.parent_path());
        } catch (const UserError& error) {
            for (Mistake mistake : error.mistakes()) {
                if (mistake.where.empty()) mistake.where = name;
                add_once(of_point(std::move(mistake), name), mistakes);
            }
        }
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    check_names(points);
    return points;
}

namespace {

/// One process at a time works in a sweep's folder.
FolderLock locked(const SweepSettings& settings) {
    require_sweep_folder(settings.folder, settings.resume);
    fs::create_directories(settings.folder);
    return FolderLock(settings.folder);
}

}  // namespace

SweepOutcome run_sweep(const std::vector<SweepPoint>& points, const SweepSettings& settings,
                       const std::function<void(const std::string&)>& say) {
    const FolderLock lock = locked(settings);
    write_studies(points, settings);
    if (settings.launcher == Launcher::slurm) return SlurmRuns(points, settings, say).take_all();
    return LocalRuns(points, settings, say).take_all();
}

fs::path emit_slurm(const std::vector<SweepPoint>& points, const SweepSettings& settings) {
    const FolderLock lock = locked(settings);
    write_studies(points, settings);
    const std::vector<SweepPoint> missing = without_report(points, settings);
    return missing.empty() ? fs::path() : write_slurm_script(missing, settings, "run", true);
}

}  // namespace cutterflow::cases
