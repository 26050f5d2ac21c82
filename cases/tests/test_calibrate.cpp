/// Calibrations over a stand-in for cutterflow whose runs are known functions of the study, with scatter by the seed.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cases/calibration/calibrate.hpp"
#include "cases/calibration/run_values.hpp"
#include "cases/runner/manifest.hpp"
#include "cases/scenes/free_surface/surface_study.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "cases/sweep/room_sweep.hpp"
#include "cases/sweep/surface_sweep.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A run: angle = 15 + 20 friction - 8 friction^2 (1 more in a study called big), rate = 40 - 25 friction, both with scatter; the density
/// matters to nothing. It costs 36 core seconds. $1 command, $2 study, $4 run directory.
constexpr const char* k_run = R"sh(#!/bin/sh
[ "$1" = run ] || exit 0
[ -f "$4/report/measures.json" ] && exit 0
PLACE
echo "${4##*/}" >> FOLDER/made
mkdir -p "$4/report"
awk -v big="$(case ${4##*/} in (big*) echo 1;; (*) echo 0;; esac)" '
/^\[/ { section = $0 }
section == "[contact]" && $1 == "friction" { mu = $3 }
section == "[[bodies]]" && $1 == "density_kg_m3" { density = $3 }
section == "[[bodies]]" && $1 == "seed" { seed = $3 }
function chance(n,  x) { x = sin(12.9898*seed + 78.233*mu + 0.0371*density + 39.425*n)*43758.5453; return x - int(x) }
END {
  noise = 0.4*(chance(1) + chance(2) + chance(3)) / 1.7
  printf "{\"angle\": {\"value\": %.10g, ", 15 + big + 20*mu - 8*mu*mu + noise
  printf "\"series\": {\"place_m\": [0, 1, 2], \"height_m\": [0, %.10g, 0]}}, ", mu
  printf "\"rate\": {\"value\": %.10g}, \"none\": {\"value\": null}}\n", 40 - 25*mu + 0.5*chance(4)
}' "$2" > "$4/report/measures.json"
stage() { echo "{\"state\": \"done\", \"inputs\": {}, \"outputs\": {}, \"wall_s\": 1.0, \"core_s\": $1, \"finished\": \"\"}"; }
stages="{\"case\": $(stage 6.0), \"run\": $(stage 30.0), \"report\": $(stage 0.0)}"
echo "{\"schema\": \"cutterflow.manifest/1\", \"stages\": $stages, \"versions\": {}}" > "$4/manifest.json"
)sh";

/// Slurm in the search path for as long as the object lives. sbatch takes the elements of an array in turn; squeue answers once none is
/// left.
class SchedulerOfScripts {
public:
    explicit SchedulerOfScripts(const fs::path& folder) : folder_(folder), search_path_(std::getenv("PATH")) {
        const auto stand_in = [&](const char* name, const std::string& script) {
            write_file(folder_ / name, "#!/bin/sh\ncd " + folder_.string() + " || exit 1\n" + script);
            fs::permissions(folder_ / name, fs::perms::owner_all);
        };
        // $1 --parsable, $2 the script
        stand_in("sbatch", R"sh(job=$(($(ls -d job_* 2>/dev/null | wc -l) + 1))
mkdir job_$job
elements() {
  for element in $(seq 0 $(sed -n 's/^#SBATCH --array=0-//p' "$1")); do SLURM_ARRAY_TASK_ID=$element SLURM_ARRAY_JOB_ID=$job sh "$1"; done
  touch job_$job/ended
}
elements "$2" > /dev/null 2>&1 &
echo $job
)sh");
        stand_in("squeue", R"sh(for word in "$@"; do case $word in (--jobs=*) job=${word#--jobs=};; esac; done
[ -d "job_$job" ] || { echo "slurm_load_jobs error: Invalid job id specified" >&2; exit 1; }
until [ -e "job_$job/ended" ]; do sleep 0.02; done
)sh");
        ::setenv("PATH", (folder_.string() + ":" + search_path_).c_str(), 1);
    }
    ~SchedulerOfScripts() { ::setenv("PATH", search_path_.c_str(), 1); }

    std::size_t jobs() const {
        std::size_t count = 0;
        while (fs::exists(folder_ / fmt::format("job_{}", count + 1))) ++count;
        return count;
    }

private:
    fs::path folder_;
    std::string search_path_;
};

double angle(double mu) {
    return 15.0 + 20.0 * mu - 8.0 * mu * mu;
}

class Calibrate : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_calibrate_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
        for (const char* study : {"heap", "big"}) write_file(folder_ / (std::string(study) + ".toml"), surface_study_template(study));
        set_program("");
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// \param place  what the stand-in does first
    void set_program(const std::string& place) {
        std::string text = k_run;
        text.replace(text.find("PLACE"), 5, place);
        for (std::size_t at = text.find("FOLDER"); at != std::string::npos; at = text.find("FOLDER")) text.replace(at, 6, folder_.string());
        write_file(folder_ / "program", text);
        fs::permissions(folder_ / "program", fs::perms::owner_all);
    }

    static StudyAccess access() {
        return {[](const fs::path& study, const std::vector<KeyAxis>& axes, const RepeatRange& repeats, const fs::path&) {
                    std::vector<std::string> words;
                    for (const KeyAxis& axis : axes) words.push_back(fmt::format("{}={}", axis.key, fmt::join(axis.values, ",")));
                    return surface_sweep_points(study, key_axes(surface_study_table(), words, "cutterflow params --kind free_surface"),
                                                repeats);
                },
                [](const fs::path&) { return std::optional<double>(36.0); },
                [](const fs::path&) {
                    return std::vector<StudyMeasure>{{"angle", true}, {"rate"}, {"none"}};
                }};
    }

    fs::path write(const std::string& text) const {
        write_file(folder_ / "calibration.toml", text);
        return folder_ / "calibration.toml";
    }

    CalibrateSettings settings(bool resume = false, Launcher launcher = Launcher::local) const {
        return {folder_ / "calibration.toml", folder_ / "out", folder_ / "program", 1, 2, resume, launcher, access()};
    }

    postproc::calibration::Outcome run(bool resume = false, Launcher launcher = Launcher::local) {
        const CalibrateSettings how = settings(resume, launcher);
        const CalibrationFile file = begin_calibration(how);
        return run_calibration(file, how, [this](const std::string& line) { lines_ += line + "\n"; });
    }

    std::string refusal(const std::string& text) {
        try {
            read_calibration(write(text), access());
        } catch (const UserError& error) {
            return error.what();
        }
        return {};
    }

    std::size_t made() const {
        const std::string text = fs::exists(folder_ / "made") ? read_file(folder_ / "made") : "";
        return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }

    fs::path folder_;
    std::string lines_;
};

std::string calibration_text(const std::string& head, const std::string& targets) {
    return head + R"(
[budget]
runs = 200
core_h = 10
[[parameter]]
name = "mu"
key = "contact.friction"
range = [0.1, 0.9]
values = [0.1, 0.3, 0.5, 0.7, 0.9]
tolerance = 0.02
[[parameter]]
name = "density"
key = "bodies.density_kg_m3"
range = [2000, 3000]
values = [2000, 2500, 3000]
)" + targets;
}

/// The angle at friction 0.44, off the grid.
std::string angle_target(const std::string& more = "") {
    return fmt::format("[[target]]\nmeasure = \"angle\"\nvalue = {}\ntolerance = 0.3\n{}", angle(0.44), more);
}

const std::string k_rate = "[[target]]\nmeasure = \"rate\"\nvalue = 29.2\ntolerance = 0.5\nheld_out = true\n";

}  // namespace

TEST_F(Calibrate, recovers_a_hidden_value_and_predicts_what_was_held_out) {
    write(calibration_text("study = [\"heap.toml\"]\nrounds = 1", angle_target() + k_rate));
    const auto outcome = run();
    EXPECT_NEAR(outcome.parameters[0], 0.44, 0.03);
    ASSERT_TRUE(outcome.estimate);
    EXPECT_LE(outcome.estimate->intervals[0].low, 0.44);
    EXPECT_GE(outcome.estimate->intervals[0].high, 0.44);
    EXPECT_THAT(outcome.undetermined, ::testing::ElementsAre("density"));
    ASSERT_EQ(outcome.agreements.size(), 2u);
    EXPECT_TRUE(outcome.agreements[1].held_out);
    EXPECT_NEAR(outcome.agreements[1].model[0], 40.0 - 25.0 * 0.44, 0.8);
    EXPECT_GT(outcome.calibration.evaluations.size(), 15u) << "places of the round";
    EXPECT_LE(outcome.calibration.evaluations.size(), 15u + 3u);
    EXPECT_EQ(outcome.calibration.cost.runs, 3u * outcome.calibration.evaluations.size() + 3u) << "and those of the answer";
    EXPECT_EQ(outcome.agreements[1].runs, 3u);
    EXPECT_TRUE(outcome.agreements[1].standard_error);
    for (const auto& evaluation : outcome.calibration.evaluations)
        EXPECT_EQ(evaluation.values.size(), 1u) << "the held-out one is not read";
    EXPECT_NEAR(outcome.calibration.cost.core_h, 0.01 * static_cast<double>(outcome.calibration.cost.runs), 1e-12);
    EXPECT_EQ(made(), outcome.calibration.cost.runs);
}

TEST_F(Calibrate, takes_a_study_in_which_nothing_is_random_once) {
    std::string still = surface_study_template("heap");
    still.replace(still.find("jitter_m = 1e-5"), 15, "jitter_m = 0.0");
    write_file(folder_ / "heap.toml", still);
    const auto text = [](const std::string& repeats) {
        return calibration_text("study = [\"heap.toml\"]\nmethod = \"grid\"\n" + repeats, angle_target());
    };
    EXPECT_THAT(refusal(text("repeats = 3\nrepeats_at_answer = 1")), HasSubstr("3 repeats of a study in which nothing is random"));
    EXPECT_THAT(refusal(text("repeats = 1\nrepeats_at_answer = 2")), HasSubstr("2 repeats of a study in which nothing is random"));
    write(text("repeats = 1\nrepeats_at_answer = 1"));
    const auto outcome = run();
    ASSERT_EQ(outcome.agreements.size(), 1u);
    EXPECT_EQ(outcome.agreements[0].runs, 1u);
}

TEST_F(Calibrate, searches_between_whole_numbers_on_a_grid_alone) {
    const std::string layers = "[[parameter]]\nkey = \"bodies.layers\"\nrange = [2, 6]\nvalues = [2, 4, 6]\n";
    for (const char* method : {"surface", "bobyqa"})
        EXPECT_THAT(refusal(fmt::format("study = [\"heap.toml\"]\nmethod = \"{}\"\n[budget]\nruns = 200\ncore_h = 10\n", method) + layers +
                            angle_target()),
                    AllOf(HasSubstr("bodies.layers takes whole numbers"), HasSubstr("method = \"grid\"")))
            << method;
    EXPECT_EQ(refusal("study = [\"heap.toml\"]\nmethod = \"grid\"\n[budget]\nruns = 200\ncore_h = 10\n" + layers + angle_target()), "");
}

TEST_F(Calibrate, shares_one_set_of_parameters_between_studies) {
    write(calibration_text(
        "study = [\"heap.toml\", \"big.toml\"]\nmethod = \"grid\"\nrepeats = 2",
        angle_target("study = \"heap\"\n") +
            fmt::format("[[target]]\nmeasure = \"angle\"\nvalue = {}\ntolerance = 0.3\nstudy = \"big\"\n", angle(0.52) + 1.0)));
    const auto outcome = run();
    EXPECT_EQ(outcome.parameters[0], 0.5) << "the best place of the grid";
    EXPECT_EQ(made(), 15u * 2u * 2u + 2u * 3u);
    EXPECT_EQ(outcome.agreements[0].name, "heap: angle");
    EXPECT_EQ(outcome.agreements[1].name, "big: angle");
    EXPECT_NEAR(outcome.agreements[1].model[0] - outcome.agreements[0].model[0], 1.0, 0.8);
}

TEST_F(Calibrate, runs_a_study_of_held_out_targets_at_the_answer_alone_with_new_seeds) {
    write(
        calibration_text("study = [\"heap.toml\", \"big.toml\"]\nmethod = \"grid\"\nrepeats = 2\nrepeats_at_answer = 4",
                         angle_target("study = \"heap\"\n") +
                             fmt::format("[[target]]\nmeasure = \"angle\"\nvalue = {}\ntolerance = 0.3\nstudy = \"big\"\nheld_out = true\n",
                                         angle(0.44) + 1.0)));
    const CalibrationFile file = read_calibration(folder_ / "calibration.toml", access());
    EXPECT_EQ(file.plan.runs, 15u * 2u + 2u * 4u);
    EXPECT_NEAR(*file.plan.core_h, 0.01 * static_cast<double>(file.plan.runs), 1e-12);
    const auto outcome = run();
    EXPECT_EQ(made(), file.plan.runs);
    EXPECT_EQ(outcome.calibration.cost.runs, file.plan.runs);
    ASSERT_EQ(outcome.agreements.size(), 2u);
    for (const auto& agreement : outcome.agreements) EXPECT_EQ(agreement.runs, 4u);
    EXPECT_NEAR(outcome.agreements[1].model[0], angle(outcome.parameters[0]) + 1.0, 0.5);
    const std::string runs = read_file(folder_ / "made");
    for (const char* name : {"big", "heap"}) {
        EXPECT_THAT(runs, HasSubstr("_repeat6\n")) << name;
        EXPECT_THAT(runs, ::testing::Not(HasSubstr("_repeat7\n")));
    }
    EXPECT_THAT(runs, ::testing::Not(::testing::ContainsRegex("big[^\n]*_repeat[12]\n"))) << "those seeds belong to the places";
    // The best place of the grid was chosen by its own runs: the answer's are others.
    const auto best = std::min_element(outcome.objectives.begin(), outcome.objectives.end()) - outcome.objectives.begin();
    EXPECT_EQ(outcome.answer->parameters, outcome.calibration.evaluations[static_cast<std::size_t>(best)].parameters);
    EXPECT_NE(outcome.answer->values[0][0], outcome.calibration.evaluations[static_cast<std::size_t>(best)].values[0][0]);
}

TEST_F(Calibrate, refuses_a_study_without_a_target) {
    EXPECT_THAT(refusal(calibration_text("study = [\"heap.toml\", \"big.toml\"]", angle_target("study = \"heap\"\n"))),
                HasSubstr("big.toml has no target"));
}

TEST_F(Calibrate, makes_no_run_twice_when_resumed) {
    write(calibration_text("study = [\"heap.toml\"]", angle_target()));
    const auto whole = to_json(run());
    const std::size_t runs = made();
    EXPECT_EQ(to_json(run(true)).dump(), whole.dump());
    EXPECT_EQ(made(), runs);
}

TEST_F(Calibrate, by_a_scheduler_is_that_of_this_machine) {
    // One run of the grid fails: its repeat is left out.
    set_program(R"(case $4 in *friction_0.3_*3000_repeat2) exit 3;; esac)");
    write(calibration_text("study = [\"heap.toml\"]\nrounds = 1", angle_target() + k_rate));
    const auto local = run();
    const std::size_t made_here = made();
    fs::remove_all(folder_ / "out");
    fs::remove(folder_ / "made");
    lines_.clear();

    const SchedulerOfScripts scheduler(folder_ / "scheduler");
    const auto scheduled = run(false, Launcher::slurm);
    EXPECT_GT(scheduled.calibration.evaluations.size(), 15u) << "the grid and places of a round";
    EXPECT_EQ(scheduled.calibration.cost.failed_runs, 1u);
    EXPECT_THAT(lines_, AllOf(HasSubstr("job 1: run of 45 point(s)"), HasSubstr("repeat2: its job ended without a report")));
    EXPECT_EQ(to_json(scheduled).dump(), to_json(local).dump());
    EXPECT_EQ(scheduler.jobs(), 3u) << "the grid, the round, the answer";
    EXPECT_EQ(made(), made_here) << "every run was made once";
}

TEST_F(Calibrate, optimiser_goes_on_where_it_was) {
    write(calibration_text("study = [\"heap.toml\"]\nmethod = \"bobyqa\"\nevaluations = 12\nrepeats = 2", angle_target()));
    set_program("[ $(cat FOLDER/made 2>/dev/null | wc -l) -lt 11 ] || exit 3");
    EXPECT_THROW(run(), ToolError) << "killed in the sixth evaluation";
    const std::size_t before = made();
    EXPECT_GE(before, 11u);
    set_program("");
    const auto resumed = run(true);
    EXPECT_EQ(made(), resumed.calibration.cost.runs) << "every run was made once";
    EXPECT_LE(resumed.calibration.evaluations.size(), 12u);
    fs::remove_all(folder_ / "out");
    fs::remove(folder_ / "made");
    const auto whole = run();
    EXPECT_EQ(to_json(whole).dump(), to_json(resumed).dump());
    EXPECT_NEAR(whole.parameters[0], 0.44, 0.05);
}

TEST_F(Calibrate, optimiser_tells_that_its_evaluations_are_used_up) {
    write(calibration_text("study = [\"heap.toml\"]\nmethod = \"bobyqa\"\nevaluations = 6\nrepeats = 1", angle_target()));
    const auto outcome = run();
    EXPECT_EQ(outcome.calibration.evaluations.size(), 6u);
    EXPECT_EQ(outcome.calibration.ended, "its evaluations are used up");
}

TEST_F(Calibrate, leaves_out_runs_that_fail_and_places_without_any) {
    set_program(R"(case $4 in *friction_0.3_*3000_repeat2|*friction_0.5_*2000_*) exit 3;; esac)");
    write(calibration_text("study = [\"heap.toml\"]\nmethod = \"grid\"", angle_target()));
    const auto outcome = run();
    EXPECT_EQ(outcome.calibration.evaluations.size(), 14u);
    EXPECT_EQ(outcome.calibration.cost.failed_runs, 4u);
    EXPECT_EQ(outcome.calibration.cost.runs, 45u + 3u);
    EXPECT_THAT(lines_, HasSubstr("left out: angle has no value in "));
    std::size_t with_two = 0;
    for (const auto& evaluation : outcome.calibration.evaluations)
        if (evaluation.values[0].size() == 2) ++with_two;
    EXPECT_EQ(with_two, 1u);
}

TEST_F(Calibrate, is_refused_when_no_place_has_values) {
    write(calibration_text("study = [\"heap.toml\"]\nmethod = \"grid\"\nrepeats = 1",
                           "[[target]]\nmeasure = \"none\"\nvalue = 1\ntolerance = 1\n"));
    try {
        run();
        FAIL() << "accepted";
    } catch (const CheckFailure& failure) {
        EXPECT_THAT(failure.what(), HasSubstr("no place has values of all targets; at the last one none has no value in"));
    }
    set_program("exit 3");
    fs::remove_all(folder_ / "out");
    EXPECT_THROW(run(), ToolError);
}

TEST_F(Calibrate, refuses_parameters_of_one_table_grids_of_one_value_and_studies) {
    EXPECT_THAT(refusal(calibration_text("study = [\"heap.toml\"]\nmethod = \"grid\"", angle_target()) +
                        "[[parameter]]\nname = \"one\"\nkey = \"contact.restitution\"\nrange = [0.1, 0.5]\nvalues = [0.2]\n"),
                HasSubstr("one has 1 value. A grid compares values"));
    EXPECT_THAT(refusal("[scene]\nkind = \"room\"\n"), HasSubstr("it is a study of kind \"room\""));
}

TEST_F(Calibrate, stops_when_its_core_hours_are_spent) {
    std::string text = calibration_text("study = [\"heap.toml\"]\nrounds = 5", angle_target());
    text.replace(text.find("core_h = 10"), 11, "core_h = 0.66");
    // 15 places of 3 runs are 0.45 core hours, 15 more of the rounds 0.45, the answer 0.03: refused as a plan.
    EXPECT_THAT(refusal(text), AllOf(HasSubstr("about 0.93 core hours"), HasSubstr("budget.core_h is 0.66")));
    StudyAccess cheap = access();
    cheap.predicted_core_s = [](const fs::path&) { return std::optional<double>(); };  // as cutters: known only when they run
    CalibrateSettings how = settings();
    how.access = cheap;
    const CalibrationFile file = begin_calibration(how);
    const auto outcome = run_calibration(file, how, [](const std::string&) {});
    EXPECT_EQ(outcome.calibration.ended, "the budget is spent");
    EXPECT_GE(outcome.calibration.cost.core_h, 0.66);
    EXPECT_LT(outcome.calibration.cost.core_h, 0.66 + 0.09 + 0.03) << "no round is begun once it is spent, the answer is run";
}

TEST_F(Calibrate, stops_its_grid_when_its_core_hours_are_spent) {
    std::string text = calibration_text("study = [\"heap.toml\"]\nmethod = \"grid\"", angle_target());
    text.replace(text.find("core_h = 10"), 11, "core_h = 0.2");
    EXPECT_THAT(refusal(text), HasSubstr("about 0.48 core hours")) << "15 places of 0.03, and the answer";
    CalibrateSettings how = settings();
    how.access.predicted_core_s = [](const fs::path&) { return std::optional<double>(); };
    // All points are of one cutter: the first one makes the mesh.
    how.access.points = [points = how.access.points](const fs::path& study, const std::vector<KeyAxis>& axes, const RepeatRange& repeats,
                                                     const fs::path& folder) {
        std::vector<SweepPoint> all = points(study, axes, repeats, folder);
        for (SweepPoint& point : all) {
            point.design = "cutter";
            point.shared = {"case"};
        }
        return all;
    };
    const auto outcome = run_calibration(begin_calibration(how), how, [](const std::string&) {});
    EXPECT_EQ(outcome.calibration.ended, "the budget is spent");
    EXPECT_EQ(outcome.calibration.evaluations.size(), 7u) << "a place at a time: two jobs, three runs; 7 cost 0.21 h";
    EXPECT_NEAR(outcome.calibration.cost.core_h, 7 * 0.03 + 0.03, 1e-9);
    EXPECT_EQ(outcome.calibration.cost.runs, 7u * 3u + 3u) << "a run from which others take the mesh counts once";
    std::size_t meshes = 0;
    for (const auto& log : fs::directory_iterator(folder_ / "out/runs/logs"))
        if (log.path().string().find(".mesh.log") != std::string::npos) ++meshes;
    EXPECT_EQ(meshes, 1u);
}

TEST_F(Calibrate, goes_on_from_places_that_leave_the_scatter_unknown) {
    write(R"(
study = ["heap.toml"]
repeats = 1
rounds = 1
[budget]
runs = 20
core_h = 10
[[parameter]]
key = "contact.friction"
range = [0.1, 0.9]
values = [0.1, 0.5, 0.9]
tolerance = 0.8
)" + angle_target());
    const auto outcome = run();
    EXPECT_GT(outcome.calibration.evaluations.size(), 3u) << "three places of one run have no interval, though 0.8 is all of the range";
    EXPECT_NE(outcome.interval(0), nullptr);
    EXPECT_EQ(outcome.calibration.ended, "every interval is within its tolerance") << "since the last round";
}

TEST_F(Calibrate, takes_a_profile_from_a_file) {
    write_file(folder_ / "heap.csv", "x_m,height_m\n0.2,0.088\n1,0.44\n1.9,0.044\n");
    write(calibration_text("study = [\"heap.toml\"]\nmethod = \"surface\"\nrounds = 0\nrepeats = 1",
                           "[[target]]\nmeasure = \"angle\"\nprofile = \"heap.csv\"\ntolerance = 0.01\n"));
    const auto outcome = run();
    EXPECT_EQ(outcome.calibration.ended, "the grid is done") << "no round was asked for";
    EXPECT_EQ(outcome.agreements[0].target.size(), 100u);
    EXPECT_NEAR(outcome.parameters[0], 0.44, 0.005);
    EXPECT_LT(*outcome.agreements[0].relative_error, 0.01);
}

TEST_F(Calibrate, tells_what_is_wrong_with_a_profile_s_file) {
    const auto with = [&](const std::string& csv) {
        write_file(folder_ / "p.csv", csv);
        return refusal(
            calibration_text("study = [\"heap.toml\"]", "[[target]]\nmeasure = \"angle\"\nprofile = \"p.csv\"\ntolerance = 1\n"));
    };
    EXPECT_EQ(with("x_m,height_m\n0,0.02\n0.03,0.01\n"), "");
    EXPECT_THAT(with("x,h\n0,0.02\n0.03,0.01\n"),
                AllOf(HasSubstr("p.csv:1: column 'x_m' is missing"), HasSubstr("column 'height_m' is missing")));
    EXPECT_THAT(with("x_m,height_m\n0,high\n0.03,0.01\n0.02,0.01\n"),
                AllOf(HasSubstr("p.csv:2: height_m = 'high'"), HasSubstr("p.csv:4: x_m = 0.02 after 0.03. Places of a profile increase")));
    EXPECT_THAT(with("x_m,height_m\n0,0.02\n"), HasSubstr("the profile has 1 line(s). A profile has two or more places"));
    EXPECT_THAT(with(""), HasSubstr("is empty"));
}

TEST_F(Calibrate, refuses_a_profile_of_a_measure_that_has_none_before_any_run) {
    write_file(folder_ / "p.csv", "x_m,height_m\n0,0.02\n0.03,0.01\n");
    const std::string text =
        calibration_text("study = [\"heap.toml\"]", "[[target]]\nmeasure = \"rate\"\nprofile = \"p.csv\"\ntolerance = 1\n");
    const std::string told = refusal(text);
    EXPECT_THAT(told, AllOf(HasSubstr("rate of " + (folder_ / "heap.toml").string() + " has no profile"),
                            HasSubstr("Its measures with a profile are angle")));
    EXPECT_THAT(told, ::testing::ContainsRegex("calibration.toml:[0-9]+: rate of"));
    StudyAccess without = access();
    without.measures = [](const fs::path&) { return std::vector<StudyMeasure>{}; };
    try {
        read_calibration(folder_ / "calibration.toml", without);
        FAIL() << "a number of results.json has no profile";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("has no profile. Heights of a profile are compared"));
    }
}

// Heights of a bed between two walls are measured at the middles of its columns, half a column from the walls.
TEST_F(Calibrate, a_profile_reaches_to_the_sides_of_its_end_columns) {
    write_file(folder_ / "run/report/measures.json",
               R"({"bed": {"value": 0.1, "series": {"place_m": [0.05, 0.15, 0.25], "height_m": [0.1, 0.2, 0.3]}}})");
    const auto heights = [&](const std::vector<double>& places) { return run_values(folder_ / "run", {0, "bed", places}); };
    EXPECT_THAT(heights({0.0, 0.05, 0.1, 0.15, 0.25, 0.3}),
                ::testing::Pointwise(::testing::DoubleNear(1e-12), {0.1, 0.1, 0.15, 0.2, 0.3, 0.3}));
    EXPECT_THAT(heights({-0.01, 0.31}), ::testing::Each(0.0));
}

TEST_F(Calibrate, a_profile_that_a_run_could_not_measure_has_no_values) {
    write_file(folder_ / "run/report/measures.json",
               R"({"line": {"value": null, "series": null, "detail": {"reason": "the picture at 2 s has no grains"}}})");
    EXPECT_TRUE(run_values(folder_ / "run", {0, "line", {0.1, 0.2}}).empty());
    EXPECT_THAT(missing_reason(folder_ / "run", {0, "line", {0.1, 0.2}}), HasSubstr("no grains"));
}

TEST_F(Calibrate, reads_measures_or_results_and_names_the_nearest) {
    write_file(folder_ / "run/report/results.json", R"({"rock": {"mass_kg": 2.5, "gone": null, "name": "x"}, "production": null})");
    const auto text_of = [&](const std::string& measure) {
        try {
            run_values(folder_ / "run", {0, measure, {}});
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(run_values(folder_ / "run", {0, "rock.mass_kg", {}}), std::vector<double>{2.5});
    EXPECT_TRUE(run_values(folder_ / "run", {0, "rock.gone", {}}).empty());
    EXPECT_TRUE(run_values(folder_ / "run", {0, "production.share", {}}).empty());
    EXPECT_THAT(text_of("rock.mass"), HasSubstr("mass_kg"));
    EXPECT_THAT(text_of("rock.name"), HasSubstr("A target is a number"));
    write_file(folder_ / "run/report/measures.json", R"({"removed": {"value": 0.9}})");
    EXPECT_EQ(run_values(folder_ / "run", {0, "removed", {}}), std::vector<double>{0.9});
    EXPECT_THAT(text_of("remove"), HasSubstr("Did you mean removed?"));
    EXPECT_EQ(run_core_s(folder_ / "run"), 0.0);
}

// A bed, and a run of two starts of which the manifest knows the second.
TEST_F(Calibrate, counts_what_interrupted_runs_took) {
    const auto stage = [](double core_s) {
        return fmt::format(R"({{"state": "done", "inputs": {{}}, "outputs": {{}}, "wall_s": 1.0, "core_s": {}, "finished": ""}})", core_s);
    };
    write_file(folder_ / "run/manifest.json",
               fmt::format(R"({{"kind": "room", "schema": "cutterflow.manifest/1", "versions": {{}}, "stages": {{"bed": {}, "run": {}}}}})",
                           stage(2.0), stage(3.0)));
    write_file(folder_ / "run/postProcessing/cost/0/cost.csv", "time_s,step_s\n0.1,4\n0.2,1\n");
    write_file(folder_ / "run/postProcessing/cost/0.2/cost.json", R"({"ranks": 1, "core_s": 3.0})");
    EXPECT_NEAR(run_core_s(folder_ / "run"), 2.0 + 5.0 + 3.0, 1e-12);
    write_file(folder_ / "run/replaced_starts.csv", "start_s,core_s\n0.2,7\n0.2,4\n");
    EXPECT_NEAR(run_core_s(folder_ / "run"), 2.0 + 5.0 + 3.0 + 11.0, 1e-12);
    fs::remove(folder_ / "run/postProcessing/cost/0.2/cost.json");
    EXPECT_NEAR(run_core_s(folder_ / "run"), 2.0 + 3.0 + 11.0, 1e-12) << "the last attempt's, while no start came to its end";
}

TEST_F(Calibrate, reports_all_mistakes_at_once) {
    const std::string text = refusal(R"(
study = ["heap.toml", "absent.toml"]
methods = "grid"
[budget]
runs = 5
core_h = 1
[[parameter]]
key = "contact.friction"
range = [0.9, 0.1]
[[parameter]]
name = "mu"
key = "contact.friction"
range = [0.1, 0.5]
values = [0.1, 0.6]
[[target]]
measure = "angle"
value = 20
profile = "absent.csv"
tolerance = 1
[[target]]
measure = "angle"
study = "heaps"
tolerance = 1
held_out = true
weight = 2
)");
    EXPECT_THAT(text, HasSubstr("absent.toml does not exist"));
    EXPECT_THAT(text, AllOf(HasSubstr("key methods is unknown"), HasSubstr("Did you mean method?")));
    EXPECT_THAT(text, HasSubstr("range of contact.friction is 0.9 to 0.1: it is empty"));
    EXPECT_THAT(text, HasSubstr("mu = 0.6 is outside of its range, 0.1 to 0.5"));
    EXPECT_THAT(text, HasSubstr("mu has 2 value(s)"));
    EXPECT_THAT(text, HasSubstr("contact.friction is varied twice"));
    EXPECT_THAT(text, HasSubstr("names no study"));
    EXPECT_THAT(text, HasSubstr("has a value and a profile"));
    EXPECT_THAT(text, HasSubstr("absent.csv does not exist"));
    EXPECT_THAT(text, HasSubstr("Did you mean heap?"));
    EXPECT_THAT(text, HasSubstr("has the weight 2 in the objective"));
}

TEST_F(Calibrate, refuses_keys_that_nothing_looks_at) {
    const auto with = [&](const std::string& head, const std::string& target) {
        return refusal("\nstudy = [\"heap.toml\"]\n" + head +
                       "\n[budget]\nruns = 50\ncore_h = 1\n[[parameter]]\nkey = \"contact.friction\"\n" +
                       "range = [0.1, 0.9]\n[[target]]\nmeasure = \"angle\"\nvalue = 20\ntolerance = 1\n" + target);
    };
    EXPECT_THAT(with("method = \"grid\"\nrounds = 2\nevaluations = 9", ""),
                AllOf(HasSubstr("rounds is given with method = \"grid\""), HasSubstr("evaluations is given with method = \"grid\"")));
    EXPECT_THAT(with("method = \"bobyqa\"\nrounds = 2", ""), HasSubstr("rounds is given with method = \"bobyqa\""));
    EXPECT_THAT(with("evaluations = 9", "lowest_m = 0.1\n"),
                AllOf(HasSubstr("evaluations is given with method = \"surface\""), HasSubstr("has a value and lowest_m")));
}

TEST_F(Calibrate, reports_wrong_values_beside_missing_studies_and_empty_ranges) {
    write_file(folder_ / "bad.toml", "kind = \"free_surface\"\n");
    const std::string text = refusal(R"(
study = ["heap.toml", "absent.toml", "bad.toml"]
method = "gird"
objective = "squared"
repeats = 0
[budget]
runs = -1
[[parameter]]
key = "contact.friction"
range = [0.9, 0.1]
[[parameter]]
name = "five"
key = 5
range = [1, 1]
[[parameter]]
key = "bodies.density_kg_m3"
range = [2000, 1e9]
[[parameter]]
key = "contact.fricton"
range = [0.1, 0.9]
[[parameter]]
key = "contact.theta"
[[target]]
value = "high"
study = "heaps"
tolerance = 1
[[target]]
measure = "angel"
study = "heap"
tolerance = 0
held_out = "no"
)");
    for (const char* part : {"method = \"gird\" is no choice",
                             "objective = \"squared\" is no choice",
                             "repeats = 0 is too low",
                             "budget.runs = -1 is too low",
                             "budget.core_h is missing",
                             "parameter.key = 5 has the wrong type",
                             "parameter.range is missing",
                             "target.measure is missing",
                             "target.value = ",
                             "target.tolerance = 0",
                             "target.held_out = ",
                             "absent.toml does not exist",
                             "bad.toml: domain.width_m is missing",
                             "range of contact.friction is 0.9 to 0.1: it is empty",
                             "range of five is 1 to 1",
                             "5 [[parameter]]",
                             "target.study = \"heaps\" is no study",
                             "has no measure angel",
                             "Did you mean contact.friction?",
                             "the target heap: angel has no value"})
        EXPECT_THAT(text, HasSubstr(part));
    EXPECT_THAT(text, ::testing::Not(HasSubstr("no [[target]] is fitted")));
    EXPECT_THAT(text, ::testing::Not(HasSubstr("quadratic")));
    // A range is wrong at its own place, not in a study that is nowhere.
    EXPECT_THAT(text, HasSubstr("calibration.toml:17: " + (folder_ / "heap.toml").string() + ": parameter bodies.density_kg_m3 = "));
}

TEST_F(Calibrate, refuses_held_out_targets_in_the_objective_unknown_names_and_plans_over_the_budget) {
    const std::string head = "study = [\"heap.toml\"]";
    EXPECT_THAT(refusal(calibration_text(head, angle_target() + angle_target("held_out = true\n"))),
                AllOf(HasSubstr("the held-out target angle is in the objective as well"), HasSubstr("never enters the objective")));
    EXPECT_THAT(refusal(calibration_text(head, k_rate)), HasSubstr("no [[target]] is fitted"));
    EXPECT_THAT(refusal(calibration_text(head, "[[target]]\nmeasure = \"angles\"\nvalue = 20\ntolerance = 1\n")),
                HasSubstr("Did you mean angle?"));
    EXPECT_THAT(
        refusal(calibration_text(head + "\nobjective = \"relative_error\"", "[[target]]\nmeasure = \"angle\"\nvalue = 0\ntolerance = 1\n")),
        HasSubstr("A relative error divides by the target"));
    std::string text = calibration_text(head, angle_target());
    text.replace(text.find("contact.friction"), 16, "contact.fricton");
    EXPECT_THAT(refusal(text),
                AllOf(HasSubstr("parameter contact.fricton: there is no such key"), HasSubstr("Did you mean contact.friction?")));
    text = calibration_text(head, angle_target());
    text.replace(text.find("range = [2000, 3000]"), 20, "range = [-100, 3000]");
    EXPECT_THAT(refusal(text), HasSubstr("bodies.density_kg_m3"));
    text = calibration_text(head, angle_target());
    text.replace(text.find("runs = 200"), 10, "runs = 60");
    EXPECT_THAT(refusal(text),
                AllOf(HasSubstr("the plan takes 66 runs: 21 places of 3, and 3 at the answer"), HasSubstr("budget.runs is 60")));
    EXPECT_THAT(refusal(calibration_text(head + "\nmethod = \"bobyqa\"", angle_target())), "") << "30 places of 3 runs";
    EXPECT_THAT(refusal(calibration_text(head, "")), HasSubstr("no [[target]] is fitted"));
    EXPECT_THAT(refusal(calibration_text("study = \"heap.toml\"", angle_target())), HasSubstr("It must be a list of texts"));
    text = calibration_text(head, angle_target());
    text.replace(text.find("range = [0.1, 0.9]"), 18, "range = [0.1]");
    EXPECT_THAT(refusal(text), HasSubstr("It must be a list of 2 numbers"));
}

TEST_F(Calibrate, refuses_two_of_one_name) {
    const std::string head = "study = [\"heap.toml\"]";
    EXPECT_THAT(refusal(calibration_text(head, angle_target() + angle_target())), HasSubstr("two targets are called angle"));
    EXPECT_EQ(refusal(calibration_text(head, angle_target() + angle_target("name = \"angle of another day\"\n"))), "");
    std::string text = calibration_text(head, angle_target());
    text.replace(text.find("name = \"density\""), 16, "name = \"mu\"");
    EXPECT_THAT(refusal(text), HasSubstr("two parameters are called mu"));
}

TEST_F(Calibrate, goes_on_with_its_own_file_alone) {
    const std::string text = calibration_text("study = [\"heap.toml\"]\nmethod = \"grid\"\nrepeats = 1", angle_target());
    write(text);
    EXPECT_THROW(begin_calibration(settings(true)), UserError) << "nothing to resume";
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    run();
    EXPECT_THROW(run(), UserError) << "begun, and no --resume";
    std::string other = text;
    other.replace(other.find("tolerance = 0.02"), 16, "tolerance = 0.03");
    write(other);
    try {
        run(true);
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("only its budget may change"));
    }
    std::string richer = text;
    richer.replace(richer.find("core_h = 10"), 11, "core_h = 20");
    write(richer);
    EXPECT_NO_THROW(run(true));
    write_file(folder_ / "other/notes.txt", "mine");
    CalibrateSettings how = settings();
    how.folder = folder_ / "other";
    EXPECT_THROW(begin_calibration(how), UserError);
    EXPECT_EQ(read_file(folder_ / "other/notes.txt"), "mine");
}

TEST_F(Calibrate, every_example_reads) {
    const StudyAccess rooms{[](const fs::path& study, const std::vector<KeyAxis>& axes, const RepeatRange& repeats, const fs::path&) {
                                std::vector<std::string> words;
                                for (const KeyAxis& axis : axes)
                                    words.push_back(fmt::format("{}={}", axis.key, fmt::join(axis.values, ",")));
                                return room_sweep_points(study, read_placed_room(study),
                                                         key_axes(room_table(), words, "cutterflow params --kind room"), repeats, 1);
                            },
                            [](const fs::path&) { return std::optional<double>(); },
                            [](const fs::path& study) {
                                std::vector<StudyMeasure> measures;
                                const ParameterValues values = read_parameters(room_table(), study);
                                for (const ParameterValues& measure : values.tables("measure"))
                                    measures.push_back({measure.text("measure.name")});
                                return measures;
                            }};
    const fs::path examples = fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/calibrate_repose";
    const CalibrationFile glass = read_calibration(examples / "glass.toml", rooms);
    EXPECT_EQ(glass.plan.runs, 9u * 2u + 3u * 3u);
    EXPECT_EQ(glass.targets.fitted.size(), 2u);
    EXPECT_EQ(glass.targets.held_out.size(), 1u);
    EXPECT_EQ(read_calibration(examples / "rounded.toml", rooms).targets.held_out.size(), 2u);
}

}  // namespace cutterflow::cases
