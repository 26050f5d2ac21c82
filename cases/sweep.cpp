#include "cases/sweep.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "cases/manifest.hpp"
#include "cases/run_directory.hpp"
#include "cases/study.hpp"
#include "cases/study_case.hpp"
#include "geometry/base/child_process.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_names.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_studies = "studies";
constexpr const char* k_logs = "logs";

/// OpenFOAM takes few characters in a path.
std::string safe(std::string name) {
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
    return name;
}

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
    int repeat = 0;
};

std::vector<Combination> combinations_of(const SweepAxes& axes) {
    std::vector<Combination> all;
    for (const auto& design : or_own(axes.designs))
        for (const auto& speed : or_own(axes.speeds))
            for (const auto& discharge : or_own(axes.discharges))
                for (int repeat = 0; repeat < axes.repeats; ++repeat) all.push_back({design, speed, discharge, repeat});
    return all;
}

/// "a_60rpm_0.12m3_s": what repeats of a point have in common.
std::string setting_name(const Combination& combination, const std::string& study) {
    std::vector<std::string> parts;
    if (combination.design) parts.push_back(safe(fs::path(*combination.design).stem().string()));
    if (combination.speed) parts.push_back(fmt::format("{:g}rpm", *combination.speed));
    if (combination.discharge) parts.push_back(fmt::format("{:g}m3_s", *combination.discharge));
    if (parts.empty()) parts.push_back(safe(study));
    return fmt::format("{}", fmt::join(parts, "_"));
}

ParameterValues values_of(const Combination& combination, ParameterValues values, const std::string& setting) {
    if (combination.design || combination.speed || combination.discharge)
        values.set("name", fmt::format("{}: {}", values.text("name"), setting));
    if (combination.speed) values.set("rotor.speed_rpm", *combination.speed);
    if (combination.discharge) values.set("suction.discharge_m3_s", *combination.discharge);
    return values;
}

/// A path of the user's (relative to where the command was given) as the studies in the sweep's folder name it.
std::string from_studies(const fs::path& path, const fs::path& folder) {
    return fs::absolute(path).lexically_normal().lexically_relative((fs::absolute(folder) / k_studies).lexically_normal()).string();
}

/// Repeat `index` of `count`: another placement, released at another angle within one passing of a blade.
void vary_release(ParameterValues& values, int index, int count, int blades) {
    for (ParameterValues& feed : values.tables_for_writing("feed")) {
        const double start =
            feed.has("feed.start_revolution") ? feed.number("feed.start_revolution") : values.number("run.flow_revolutions");
        feed.set("feed.seed", feed.integer("feed.seed") + index);
        if (index > 0) feed.set("feed.start_revolution", start + static_cast<double>(index) / (count * blades));
    }
}

/// Reads cutters once each: a sweep names the same design many times.
class Designs {
public:
    const Head& head_of(ParameterValues values, const fs::path& cutter) {
        const std::string file = fs::absolute(cutter).lexically_normal().string();
        auto found = heads_.find(file);
        if (found == heads_.end()) {
            values.set("cutter.file", file);
            found = heads_.emplace(file, *import_study_cutter(values, "").head).first;
        }
        return found->second;
    }

private:
    std::map<std::string, Head> heads_;
};

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

/// Copies what stages wrote in one run directory into another in which they did not begin yet. Whether they fit is judged there, by their
/// inputs, as for every finished stage.
void share_stages(const fs::path& from, const fs::path& to, const std::vector<std::string>& stages) {
    if (fs::exists(to / names::manifest)) return;
    const Manifest donor(from / names::manifest);
    Manifest manifest(to / names::manifest);
    for (const std::string& stage : stages) {
        const StageRecord* record = donor.find(stage);
        if (record == nullptr || record->state != StageState::done) return;
        for (const auto& [file, hash] : record->outputs) {
            fs::create_directories((to / file).parent_path());
            fs::copy_file(from / file, to / file, fs::copy_options::overwrite_existing);
        }
        manifest.start(stage, record->inputs, {});
        manifest.finish(stage, record->outputs, 0.0, 0.0);
    }
}

/// Writes the studies, or finds them as they are.
void write_studies(const std::vector<SweepPoint>& points, const SweepSettings& settings) {
    const fs::path studies = settings.folder / k_studies;
    if (!fs::exists(studies)) {
        if (fs::exists(settings.folder) && !fs::is_empty(settings.folder))
            throw UserError(fmt::format("{} holds something else already", settings.folder.string()), "Nothing is overwritten",
                            "Name another folder with -o");
        for (const SweepPoint& point : points) write_file(studies / (point.name + ".toml"), point.text);
        return;
    }
    if (!settings.resume)
        throw UserError(fmt::format("{} holds a sweep already", settings.folder.string()), "Its runs are kept",
                        "Add --resume to go on with it, or name another folder with -o");
    std::vector<Mistake> mistakes;
    for (const SweepPoint& point : points) {
        const fs::path file = studies / (point.name + ".toml");
        if (!fs::exists(file))
            write_file(file, point.text);  // points may be added
        else if (read_file(file) != point.text)
            mistakes.push_back({file.string(), "the study of this point is another", "A point's results belong to its study",
                                "Name another folder with -o, or change the study back"});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

/// Share done as "run: 42 %, ..." tells it; nothing for other lines.
std::optional<double> share_of(const std::string& line) {
    const std::string start = "  run: ";
    const std::size_t percent = line.find(" %");
    if (line.rfind(start, 0) != 0 || percent == std::string::npos) return std::nullopt;
    return std::strtod(line.c_str() + start.size(), nullptr) / 100.0;
}

class Runs {
public:
    Runs(const std::vector<SweepPoint>& points, const SweepSettings& settings, const std::function<void(const std::string&)>& say)
        : points_(points), settings_(settings), say_(say), shares_(points.size(), 0.0) {}

    SweepOutcome take_all() {
        make_meshes();
        std::vector<std::thread> workers;
        for (int job = 0; job < settings_.jobs; ++job) workers.emplace_back([this] { work(); });
        for (std::thread& worker : workers) worker.join();
        if (interrupted_) throw Interrupted(*interrupted_);
        progress_.finish();
        SweepOutcome outcome;
        for (std::size_t i = 0; i < points_.size(); ++i)
            if (failures_.count(i) == 0) outcome.done.push_back(settings_.folder / points_[i].name);
        for (const auto& [index, text] : failures_) outcome.failed.push_back(text);
        return outcome;
    }

private:
    /// The first point of each design makes the mesh; the others get a copy.
    void make_meshes() {
        std::map<std::string, std::string> donors;
        for (const SweepPoint& point : points_) {
            const auto [donor, first] = donors.emplace(point.design, point.name);
            if (first && !fs::exists(settings_.folder / point.name)) {
                say_(fmt::format("{}: mesh", point.name));
                const ChildCommand command = command_of(point, "mesh");
                run_child(command);  // when it fails, the point's own run will say why
            } else if (!first) {
                share_stages(settings_.folder / donor->second, settings_.folder / point.name, {"geometry", "mesh"});
            }
        }
    }

    ChildCommand command_of(const SweepPoint& point, const std::string& what) const {
        const fs::path run = settings_.folder / point.name;
        ChildCommand command;
        command.arguments = {settings_.program.string(),
                             what,
                             (settings_.folder / k_studies / (point.name + ".toml")).string(),
                             "-o",
                             run.string(),
                             "--ranks",
                             std::to_string(settings_.ranks)};
        if (what == "run") command.arguments.emplace_back("--resume");
        command.log = settings_.folder / k_logs / fmt::format("{}.{}.log", point.name, what);
        return command;
    }

    void work() {
        for (std::size_t i = next_++; i < points_.size(); i = next_++) {
            {
                const std::lock_guard<std::mutex> lock(mutex_);
                if (interrupted_) return;
                say_(fmt::format("{}: begins", points_[i].name));
            }
            take(i);
        }
    }

    void take(std::size_t i) {
        const ChildCommand command = command_of(points_[i], "run");
        try {
            const ChildResult result = run_child(command, [&](const std::string& line) { note(i, share_of(line)); });
            const std::lock_guard<std::mutex> lock(mutex_);
            if (result.exit_code == 0) {
                say_(fmt::format("{}: done in {}", points_[i].name, duration_text(result.wall_s)));
            } else {
                failures_[i] = failure_of(command, result).text();
                say_(fmt::format("{}: failed, the others go on; see {}", points_[i].name, command.log.string()));
            }
        } catch (const Interrupted& stop) {
            const std::lock_guard<std::mutex> lock(mutex_);
            interrupted_ = stop.what();
        } catch (const std::exception& error) {
            const std::lock_guard<std::mutex> lock(mutex_);
            failures_[i] = fmt::format("{}: {}", points_[i].name, error.what());
        }
        note(i, 1.0);
    }

    void note(std::size_t i, std::optional<double> share) {
        if (!share) return;
        const std::lock_guard<std::mutex> lock(mutex_);
        shares_[i] = *share;
        double sum = 0.0;
        for (const double value : shares_) sum += value;
        const auto done = std::count(shares_.begin(), shares_.end(), 1.0);
        progress_.update(sum / static_cast<double>(points_.size()), fmt::format("{} of {} points", done, points_.size()));
    }

    const std::vector<SweepPoint>& points_;
    const SweepSettings& settings_;
    const std::function<void(const std::string&)>& say_;
    std::atomic<std::size_t> next_{0};
    std::mutex mutex_;
    std::vector<double> shares_;
    std::map<std::size_t, std::string> failures_;
    std::optional<std::string> interrupted_;
    Progress progress_{"sweep"};
};

}  // namespace

std::vector<SweepPoint> sweep_points(const fs::path& study, const SweepAxes& axes, const fs::path& folder) {
    const ParameterValues base = read_study(study);
    std::vector<SweepPoint> points;
    std::vector<Mistake> mistakes;
    Designs designs;
    for (const Combination& combination : combinations_of(axes)) {
        const fs::path cutter = combination.design.value_or((study.parent_path() / base.text("cutter.file")).string());
        std::string name = setting_name(combination, study.stem().string());
        ParameterValues values = values_of(combination, base, name);
        if (axes.repeats > 1) name += fmt::format("_repeat{}", combination.repeat + 1);
        try {
            const Head& head = designs.head_of(values, cutter);
            vary_release(values, combination.repeat, axes.repeats, head.symmetry.blade_count);
            values.set("cutter.file", from_studies(cutter, folder));
            const std::string text = commented_toml(study_table(), &values);
            parse_parameters(study_table(), text, name);  // bounds of what the axes set
            points.push_back({name, text, cutter.lexically_normal().string()});
            for (Mistake mistake : check_study(resolve_study(values, head_size(head)), head_size(head))) {
                mistake.where = name;
                add_once(mistake, mistakes);
            }
        } catch (const UserError& error) {
            for (const Mistake& mistake : error.mistakes()) add_once(mistake, mistakes);
        }
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    check_names(points);
    return points;
}

SweepOutcome run_sweep(const std::vector<SweepPoint>& points, const SweepSettings& settings,
                       const std::function<void(const std::string&)>& say) {
    write_studies(points, settings);
    return Runs(points, settings, say).take_all();
}

}  // namespace cutterflow::cases
