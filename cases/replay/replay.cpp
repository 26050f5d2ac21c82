#include "cases/replay/replay.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/replay/repeats.hpp"
#include "cases/replay/rock_study.hpp"
#include "cases/runner/pipeline.hpp"
#include "cases/runner/run_directory.hpp"
#include "cases/runner/solver_run.hpp"
#include "cases/runner/stages.hpp"
#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/scenes/cutter/feed.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/study/feed_keys.hpp"
#include "cases/study/study.hpp"
#include "cases/study/study_shapes.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/side_by_side.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/axial_bins.hpp"
#include "geometry/head/head_names.hpp"
#include "geometry/io/read_surface.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "postproc/run/input_files.hpp"
#include "postproc/run/run_reader.hpp"
#include "solver/ports/recording_summary.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_plan = "plan.json";
constexpr const char* k_fed_until = "fed_until_s";  // in a replay's names::replay, of a cut face

/// Replays have other seeds than the repeats of a sweep, which count up from the study's.
constexpr std::int64_t k_first_seed = 1000;

/// Remedy for what a folder of replays holds.
std::string other_folder(const fs::path& folder) {
    return fmt::format("Name a new folder with -o, or in a sweep move {} away", folder.string());
}

/// What all replays of one recorded flow share.
struct RecordedRun {
    fs::path folder;  ///< absolute
    ParameterValues values;
    std::map<std::string, std::string> files;  ///< that the run was made from, by their content
    RunHead head;
    geometry::TriangleSurface cutter;
};

RecordedRun open_run(const fs::path& run) {
    const RunDirectory directory(run);
    RunHead head = read_run_head(directory);
    const fs::path file = directory.file(names::resolved_study);
    ParameterValues values = study_as_recorded(read_parameters(study_table(), file));
    Mistakes mistakes;
    mistakes.add(check_file_rules(values, file));
    mistakes.refuse();
    // A file that was changed by hand may lack keys.
    values = resolve_study(values, head.size);
    const fs::path folder = fs::absolute(run).lexically_normal();
    const std::map<std::string, std::string> shapes = shape_names(values);
    move_shapes(values, [&](const std::string& path) { return (folder / path_of_shape(shapes.at(path))).string(); });
    const nlohmann::json manifest = read_json_document(directory.file(names::manifest), {{"stages", JsonKind::object, true}},
                                                       "Start again in another directory with -o");
    return {folder, std::move(values), postproc::input_files(manifest), std::move(head),
            geometry::welded(geometry::read_surface(directory.file(names::cutter_surface)))};
}

/// The study of a run, with every key.
std::string study_of(const RecordedRun& run) {
    return plain_toml(study_table(), run.values);
}

/// What tells a study from a changed one: its keys and its shapes.
std::string hash_of(const RecordedRun& run) {
    std::string text = study_of(run);
    for (const auto& [key, hash] : shape_hashes(run.values, run.folder)) text += hash;
    return sha256(text);
}

/// \throws UserError  with every run of water alone
void require_rock(const std::vector<RecordedRun>& runs) {
    Mistakes mistakes;
    for (const RecordedRun& run : runs)
        if (run.values.tables("feed").empty())
            mistakes.add(
                {run.folder.string(), "its study has no [[feed]]", "A replay places a study's rock", "Name a study with rock by --study"});
    mistakes.refuse();
}

/// \param own_rock  whether each run's own rock is replayed
/// \throws UserError  with every override of files that a replay makes anew from the study
void require_no_overrides(const std::vector<RecordedRun>& runs, bool own_rock) {
    std::vector<std::string> files{names::coupling_properties};
    if (own_rock) files.emplace_back(names::rock_feed);
    Mistakes mistakes;
    for (const RecordedRun& run : runs)
        for (const std::string& file : files)
            if (const std::string mine = "overrides/" + file; run.files.count(mine) > 0)
                mistakes.add({(run.folder / mine).string(), "the run took it in place of what its study says",
                              "A replay makes this file from the study: its rock would not be the run's",
                              "Give what it changes as keys of the study and run that, or use coupled runs alone"});
    mistakes.refuse();
}

/// \throws UserError  with every run that is no repeat of the first, or comes twice
void require_repeats(const std::vector<RecordedRun>& runs) {
    std::vector<RepeatedRun> repeats;
    for (const RecordedRun& run : runs) repeats.push_back({run.folder, study_of(run)});
    Mistakes mistakes;
    mistakes.add(check_repeats(repeats));
    mistakes.refuse();
}

/// \throws UserError  with every run without a recording that this program reads
void require_recordings(const std::vector<fs::path>& runs, const std::function<void(const std::string&)>& say) {
    Mistakes mistakes;
    for (const fs::path& run : runs) {
        if (fs::exists(run / names::recording)) {
            mistakes.gather([&] {
                if (const auto warning = coupling::warning_of_change(coupling::read_recording_summary(run / names::recording).change))
                    say(fmt::format("warning: {}: {}", run.string(), *warning));
            });
            continue;
        }
        if (!fs::exists(run)) {
            mistakes.add({run.string(), "there is no such folder", "A replay goes on from runs", "Correct the path"});
            continue;
        }
        mistakes.add({run.string(), "there is no recorded flow",
                      "A run records the flow before the rock when run.record_revolutions is above 0",
                      "Set run.record_revolutions = 1 in the study and run it in another directory"});
    }
    mistakes.refuse();
}

/// The study of one replay. \param index  from 1 on; 0 is the run's own placement
ParameterValues values_of(const RecordedRun& run, int index) {
    ParameterValues values = run.values;
    values.remove("report.adv_points");  // a replay averages no water, and the file is relative to the study that names it
    if (index == 0) return values;
    vary_release(values, k_first_seed + index, release_share(index) / run.head.size.blades);
    return values;
}

geometry::Contour contour_of(const RecordedRun& run, const Study& study) {
    return run.head.with_backplate(study.suction.gap);
}

std::vector<PlacedFeed> place_rock(const RecordedRun& run, const Study& study) {
    return place_feeds(study, feed_scene(study, run.head.size, contour_of(run, study), run.cutter));
}

nlohmann::json optional_json(const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

/// The study of a replay that ends as long after its release as the run, and with it the feed of a cut face: were that to end with the
/// run, more would be delivered in the replay's last revolutions than is fed.
Study study_of_replay(const RecordedRun& run, ParameterValues values) {
    const auto start = [](const ParameterValues& study) { return study.tables("feed").front().number("feed.start_revolution"); };
    values.set("run.max_revolutions", values.number("run.max_revolutions") + start(values) - start(run.values));
    return make_study(values, run.folder);
}

/// The rock of another study in a run's flow; how much of it has a place is said.
void take_study(RecordedRun& run, const fs::path& file, const std::function<void(const std::string&)>& say) {
    run.values = read_rock_study({run.values, run.files, run.head.size}, file);
    for (const std::string& line : feed_lines(place_rock(run, make_study(run.values, run.folder))))
        say(fmt::format("{}: {}", file.string(), line));
}

/// What makes a replay's folder one that reports and comparisons read: its study, its rock, and whose flow it goes through.
/// \param fed_until  end of the feed [s]; none: not known
void describe_replay(const RecordedRun& run, const ParameterValues& values, const Study& study, const std::vector<PlacedFeed>& feeds,
                     const std::optional<double>& fed_until, const fs::path& folder) {
    const coupling::RecordingSummary recording = coupling::read_recording_summary(run.folder / names::recording);
    write_file(folder / names::resolved_study,
               "# Every key of the study as it was replayed. Written by cutterflow: change the study, not this file.\n\n" +
                   commented_toml(study_table(), &values));
    write_file(folder / names::feed_report, feed_json(feeds, study));
    nlohmann::json files = nlohmann::json::array();
    for (const auto& [name, hash] : shape_hashes(values, run.folder)) files.push_back({{"input", name}, {"sha256", hash}});
    nlohmann::json replay{{"schema", postproc::k_replay_schema},
                          {"run", run.folder.string()},
                          {"flow_start_s", recording.start},
                          {"flow_end_s", recording.end},
                          {"flow_change", optional_json(recording.change)},
                          {"files", files}};
    if (fed_until) replay[k_fed_until] = *fed_until;
    write_file(folder / names::replay, replay.dump(2) + "\n");
}

/// The case of a replay: the run's steel and contour, its own rock. It has no mesh. \param folder  of the replay
void write_replay(const RecordedRun& run, const ParameterValues& values, const fs::path& folder) {
    const Study study = study_of_replay(run, values);
    const geometry::Contour contour = contour_of(run, study);
    CaseInputs inputs = case_inputs_of(study, run.head.size, contour, 1);
    inputs.record.reset();
    inputs.replay = run.folder / names::recording;
    for (coupling::WallSettings& wall : inputs.rock->walls) wall.file = run.folder / wall.file;
    write_replay_case(folder, inputs);
    const std::vector<PlacedFeed> feeds = place_rock(run, study);
    write_file(folder / names::rock_feed, rock_feed_csv(feeds));
    const std::optional<double> fed_until = study.is_fed_by_cutting() ? std::optional(study.feeds.front().end) : std::nullopt;
    describe_replay(run, values, study, feeds, fed_until, folder);
}

/// \throws UserError  when a finished replay went through another flow than its run has recorded
void require_its_flow(const RecordedRun& run, const fs::path& folder) {
    const fs::path file = folder / names::replay;
    const nlohmann::json replay =
        read_json_document(file, {{"flow_end_s", JsonKind::number, true}, {"flow_change", JsonKind::number_or_null, true}},
                           other_folder(folder.parent_path()));
    const coupling::RecordingSummary recording = coupling::read_recording_summary(run.folder / names::recording);
    if (replay.at("flow_end_s") == recording.end && replay.at("flow_change") == optional_json(recording.change)) return;
    throw UserError({{file.string(), fmt::format("{} has recorded another flow since", run.folder.string()),
                      "The replays of a folder are samples of one flow", other_folder(folder.parent_path())}});
}

/// Replays of before their folders told what they are are described now; others are held against their flow.
void describe_finished(const RecordedRun& run, const ParameterValues& values, const fs::path& folder) {
    if (fs::exists(folder / names::replay)) {
        require_its_flow(run, folder);
        return;
    }
    const Study study = make_study(values, run.folder);
    describe_replay(run, values, study, place_rock(run, study), {}, folder);
}

/// Whether an earlier program made a replay whose feed ended with the run, up to the passing of a blade before the replay.
bool ends_unfed(const RecordedRun& run, const ParameterValues& values, const fs::path& folder) {
    const ParameterValues &feed = values.tables("feed").front(), &of_run = run.values.tables("feed").front();
    if (feed.text("feed.kind") != k_cut_face || feed.number("feed.duration_s") > 0.0 ||
        feed.number("feed.start_revolution") == of_run.number("feed.start_revolution"))
        return false;
    return !read_json_document(folder / names::replay, {{k_fed_until, JsonKind::number}}, "Start again in another folder")
                .contains(k_fed_until);
}

/// Written when a replay came to its end.
fs::path cost_file(const fs::path& folder) {
    return folder / "postProcessing" / "cost" / "0" / "cost.json";
}

postproc::RockAnswer answer_of(const fs::path& folder, const RecordedRun& run) {
    const Study study = make_study(run.values, run.folder);
    return postproc::rock_answer(folder, study.is_fed_by_cutting(), study.period(), run.head.size.blades);
}

/// Of a run whose flow is replayed: its replay goes on to the end, so the run has to have ended as well.
postproc::RockAnswer coupled_answer(const RecordedRun& run) {
    if (stages_are_done(run.folder, {"run"})) return answer_of(run.folder, run);
    postproc::RockAnswer none;
    none.reason = "it has not ended";
    return none;
}

std::optional<postproc::Exits> exits_of(const fs::path& folder, const RecordedRun& run) {
    const Study study = make_study(run.values, run.folder);
    const auto bins = geometry::axial_bins(contour_of(run, study), study.report.bin_width);
    return postproc::exits_of(
        postproc::evaluate_spillage(postproc::read_fates(folder), postproc::read_events(folder), bins, study.period(), true));
}

void evaluate(const fs::path& folder, const RecordedRun& run, Replay& replay) {
    const postproc::RockAnswer answer = answer_of(folder, run);
    if (!answer.spillage)
        throw CheckFailure({folder.string(), answer.reason,
                            "Spillage is told once rock has left the head, of a head that is fed over whole revolutions once it has filled",
                            "Raise run.max_revolutions"});
    replay.spillage = *answer.spillage;
    replay.undecided = answer.undecided;
    replay.fed = answer.fed;
    replay.exits = exits_of(folder, run);
    replay.core_s =
        read_json_document(cost_file(folder), {{"core_s", JsonKind::number, true}}, "Start again in another folder").at("core_s");
}

/// Runs replays on as many cores as there are jobs.
class Replays {
public:
    Replays(const ReplaySettings& settings, const std::vector<RecordedRun>& runs) : settings_(settings), runs_(runs) {
        for (std::size_t r = 0; settings.study.empty() && r < runs.size(); ++r) add(r, 0);
        for (int index = 1; index <= settings.count; ++index) add(0, index);
    }

    /// Replays of earlier programs whose feed ended before them.
    std::size_t unfed() const { return unfed_; }

    std::vector<Replay> take_all() {
        side_by_side(tasks_.size(), settings_.jobs, [this](std::size_t n) {
            take(n);
            tell_progress();
        });
        progress_.finish();
        return replays_;
    }

private:
    struct Task {
        std::size_t run;
        ParameterValues values;
    };

    void add(std::size_t run, int index) {
        tasks_.push_back({run, values_of(runs_[run], index)});
        const ParameterValues& feed = tasks_.back().values.tables("feed").front();
        Replay replay;
        replay.name = index == 0 ? fmt::format("pair_{}", run + 1) : fmt::format("replay_{:03d}", index);
        replay.run = runs_[run].folder;
        replay.is_pair = index == 0;
        replay.seed = feed.integer("feed.seed");
        replay.start_revolution = feed.number("feed.start_revolution");
        replays_.push_back(replay);
    }

    void tell_progress() {
        const std::lock_guard<std::mutex> lock(mutex_);
        ++done_;
        progress_.update(static_cast<double>(done_) / static_cast<double>(tasks_.size()), fmt::format("{} of {}", done_, tasks_.size()));
    }

    void take(std::size_t n) {
        const fs::path folder = settings_.folder / replays_[n].name;
        const RecordedRun& run = runs_[tasks_[n].run];
        const bool is_finished = fs::exists(cost_file(folder));
        {
            const std::lock_guard<std::mutex> lock(mutex_);  // the placement of rock is not made for threads
            (is_finished ? describe_finished : write_replay)(run, tasks_[n].values, folder);
        }
        if (!is_finished)
            run_own_solver(meshing::foam_command(folder, settings_.solver.string()));
        else if (ends_unfed(run, tasks_[n].values, folder))
            ++unfed_;
        evaluate(folder, run, replays_[n]);
    }

    const ReplaySettings& settings_;
    const std::vector<RecordedRun>& runs_;
    std::vector<Task> tasks_;
    std::vector<Replay> replays_;
    std::mutex mutex_;
    std::size_t done_ = 0;
    std::atomic<std::size_t> unfed_{0};
    Progress progress_{"replays"};
};

/// What the replays of a folder are made of: the runs, the file of another study's rock, what each study says and each recording.
nlohmann::json plan_of(const ReplaySettings& settings, const std::vector<RecordedRun>& runs) {
    nlohmann::json plan;
    for (const RecordedRun& run : runs) {
        plan["runs"].push_back(run.folder.string());
        plan["studies_sha256"].push_back(hash_of(run));
        plan["recordings_sha256"].push_back(sha256_of_file(run.folder / names::recording / coupling::k_recording_summary));
    }
    if (!settings.study.empty()) plan["runs"].push_back(fs::absolute(settings.study).lexically_normal().string());
    return plan;
}

/// \throws UserError  when the folder's replays are of other runs or studies. A plan of an earlier program tells no study and no recording:
/// those of runs do not change, another study's rock may have
void require_same_plan(const fs::path& file, const nlohmann::json& plan, const ReplaySettings& settings) {
    const nlohmann::json found = read_json_document(
        file, {{"runs/*", JsonKind::text, true}, {"studies_sha256/*", JsonKind::text}, {"recordings_sha256/*", JsonKind::text}},
        other_folder(settings.folder));
    if (found.at("runs") != plan.at("runs"))
        throw UserError(
            {{file.string(), "the folder holds replays of other runs", "Results belong to their runs", other_folder(settings.folder)}});
    if (found.contains("recordings_sha256") && found.at("recordings_sha256") != plan.at("recordings_sha256"))
        throw UserError({{file.string(), "a run has recorded another flow since the folder's replays were begun",
                          "The replays of a folder are samples of one flow", other_folder(settings.folder)}});
    const char* rule = "The replays of a folder are samples of one study";
    if (!found.contains("studies_sha256")) {
        if (settings.study.empty()) return;
        throw UserError(
            {{file.string(), fmt::format("an earlier program wrote it, which did not note what {} says", settings.study.string()), rule,
              "To replay its rock again: " + other_folder(settings.folder)}});
    }
    if (found.at("studies_sha256") != plan.at("studies_sha256"))
        throw UserError({{file.string(),
                          fmt::format("{} has changed since the folder's replays were begun",
                                      settings.study.empty() ? "the study of a run" : settings.study.string()),
                          rule, "Undo the change, or: " + other_folder(settings.folder)}});
}

/// \throws UserError  when the folder holds something else, replays of something else, or an interrupted call and `resume` is false
void require_folder(const ReplaySettings& settings, const nlohmann::json& plan) {
    const bool is_there = holds_files(settings.folder);
    if (is_there && !holds_replays(settings.folder))
        throw UserError(
            {{settings.folder.string(), "the folder holds something else", "Nothing is overwritten", other_folder(settings.folder)}});
    if (is_there && !settings.resume)
        throw UserError({{settings.folder.string(), "the folder holds replays", "Results are kept",
                          "Add --resume to go on, or name a new folder with -o"}});
    if (!is_there && settings.resume)
        throw UserError(
            {{settings.folder.string(), "there is nothing to resume", "--resume goes on with a folder of replays", "Leave --resume out"}});
    if (is_there) require_same_plan(settings.folder / k_plan, plan, settings);
}

/// Bound, interval of the run itself, hold-up, what was found and losses; empty for a batch.
std::string fed_columns(const std::optional<postproc::FedHead>& fed) {
    if (!fed) return ",,,,,,,,";
    const Production& production = fed->production;
    const std::string interval = production.share ? fmt::format("{:.6g}", production.share->half_interval) : "";
    return fmt::format("{:.6g},{},{:.6g},{},{},{}", production.spillage_min, interval, production.held, production.is_steady ? 1 : 0,
                       fed->is_full ? 1 : 0, loss_columns(fed->losses));
}

/// Null for batches.
nlohmann::json fed_json(const std::optional<postproc::FedReplays>& fed) {
    if (!fed) return nullptr;
    return {{"fed_kg_s", fed->fed},
            {"hold_up_kg", fed->held},
            {"settled", fed->steady},
            {"head_is_full", fed->full},
            {"spilled_mixing", fed->losses.mixing},
            {"spilled_cutting", fed->losses.cutting},
            {"left_behind", fed->losses.left_behind},
            {"left_behind_cutting", optional_json(fed->losses.left_behind_cutting)},
            {"spillage_min", fed->spillage_min}};
}

void write_results(const fs::path& folder, const ReplayResults& results) {
    std::string csv =
        "name,run,same_placement_as_run,seed,start_revolution,spillage,undecided,core_s,spillage_min,half_interval_95,hold_up_kg,"
        "is_steady,head_is_full,spilled_mixing,spilled_cutting,left_behind,left_behind_cutting\n";
    for (const Replay& replay : results.replays)
        csv += fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.4g},{}\n", replay.name, replay.run.string(), replay.is_pair ? 1 : 0,
                           replay.seed, replay.start_revolution, replay.spillage, replay.undecided, replay.core_s, fed_columns(replay.fed));
    write_file(folder / "replays.csv", csv);
    if (!results.exits.empty()) write_file(folder / "exits.csv", postproc::exits_csv(results.exits));
    const postproc::ReplayEstimate& estimate = results.estimate;
    const nlohmann::json json{{"schema", "cutterflow.replays/1"},
                              {"spillage", estimate.spillage},
                              {"half_interval_95", optional_json(estimate.interval)},
                              {"replays",
                               {{"count", estimate.replays.count},
                                {"mean", estimate.replays.mean},
                                {"half_interval_95", optional_json(estimate.replay_interval)}}},
                              {"corrections",
                               {{"count", estimate.corrections.count},
                                {"mean", estimate.corrections.mean},
                                {"half_interval_95", optional_json(estimate.correction_interval)}}},
                              {"fed", fed_json(results.fed)},
                              {"core_s", cost_of(results.replays)}};
    write_file(folder / "replays.json", json.dump(2) + "\n");
}

}  // namespace

std::string loss_columns(const postproc::Losses& losses) {
    const std::string never_in = losses.left_behind_cutting ? fmt::format("{:.6g}", *losses.left_behind_cutting) : "";
    return fmt::format("{:.6g},{:.6g},{:.6g},{}", losses.mixing, losses.cutting, losses.left_behind, never_in);
}

double cost_of(const std::vector<Replay>& replays) {
    return std::accumulate(replays.begin(), replays.end(), 0.0, [](double sum, const Replay& replay) { return sum + replay.core_s; });
}

bool holds_replays(const fs::path& folder) {
    return fs::exists(folder / k_plan);
}

ParameterValues study_as_recorded(ParameterValues study) {
    if (study.where("kernel.sampling").empty()) study.set("kernel.sampling", std::string(coupling::k_quadratic_sampling));
    for (ParameterValues& feed : study.tables_for_writing("feed"))
        for (const auto& [key, mistake] : keys_in_vain(feed, study_table())) feed.remove(key);
    return study;
}

bool is_weakly_coupled(const postproc::ReplayEstimate& estimate) {
    return std::abs(estimate.corrections.mean) <= postproc::largest_correction(estimate);
}

void require_weak_coupling(const postproc::ReplayEstimate& estimate, const std::string& replays) {
    if (is_weakly_coupled(estimate)) return;
    throw CheckFailure({replays,
                        fmt::format("coupled runs spill {:+.1f} points against replays, which spill {:.1f} %",
                                    100.0 * estimate.corrections.mean, 100.0 * estimate.replays.mean),
                        fmt::format("Replays stand for coupled runs while rock changes spillage by at most {:.2g} points: 5, and a quarter "
                                    "of the share that is delivered or spilled, whichever is least",
                                    100.0 * postproc::largest_correction(estimate)),
                        "Use coupled runs (cutterflow sweep --repeats), or put in less rock"});
}

ReplayResults run_replays(const ReplaySettings& settings, const std::function<void(const std::string&)>& say) {
    require_openfoam_path(fs::absolute(settings.folder));
    require_recordings(settings.runs, say);
    std::vector<RecordedRun> runs;
    for (const fs::path& run : settings.runs) runs.push_back(open_run(run));
    if (!settings.study.empty() && runs.size() > 1)
        throw UserError(fmt::format("--study with {} runs", runs.size()), "Another study's rock is replayed in one flow", "Name one run");
    require_repeats(runs);
    require_no_overrides(runs, settings.study.empty());
    if (!settings.study.empty()) take_study(runs.front(), settings.study, say);
    require_rock(runs);
    const nlohmann::json plan = plan_of(settings, runs);
    require_folder(settings, plan);
    fs::create_directories(settings.folder);
    const FolderLock lock(settings.folder);
    require_folder(settings, plan);  // another call may have worked there since
    const auto write_plan = [&] { write_file(settings.folder / k_plan, plan.dump(2) + "\n"); };
    if (!holds_replays(settings.folder)) write_plan();

    ReplayResults results;
    Replays replays(settings, runs);
    results.replays = replays.take_all();
    write_plan();  // an earlier program's says less; now its replays were held against their flow
    if (replays.unfed() > 0)
        say(
            fmt::format("warning: {} of these replays are an earlier program's, whose feed ended up to the passing of a blade before them: "
                        "they deliver 1 to 2 % more of what is fed than they should. Replay again in a new folder",
                        replays.unfed()));
    std::vector<double> spillage;
    std::vector<postproc::FedHead> fed;
    for (const Replay& replay : results.replays) {
        if (replay.is_pair) continue;
        spillage.push_back(replay.spillage);
        if (replay.fed) fed.push_back(*replay.fed);
        if (replay.exits) results.exits.push_back(*replay.exits);
    }
    for (std::size_t r = 0; settings.study.empty() && r < runs.size(); ++r) {
        const postproc::RockAnswer coupled = coupled_answer(runs[r]);
        if (coupled.spillage)
            results.pairs.push_back({*coupled.spillage, results.replays[r].spillage});
        else
            say(fmt::format("{} corrects nothing: {}", runs[r].folder.string(), coupled.reason));
    }
    if (!fed.empty()) results.fed = postproc::fed_replays_of(fed);
    results.estimate = postproc::estimate_spillage(spillage, results.pairs);
    write_results(settings.folder, results);
    return results;
}

}  // namespace cutterflow::cases
