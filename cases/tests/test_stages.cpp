#include "cases/runner/stages.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cases/runner/pipeline.hpp"
#include "cases/runner/run_directory.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "cases/study/study.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/statistics/replaced_starts.hpp"

using namespace cutterflow;
using namespace cutterflow::cases;
namespace fs = std::filesystem;

namespace {

/// Fake stages a -> b -> run -> report that write one file each and note what they did.
class Stages : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_stages_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = fs::path(name) / "run";
    }
    void TearDown() override { fs::remove_all(folder_.parent_path()); }

    Stage stage(const std::string& name, std::vector<std::string> rewrites = {}, bool resumable = false) {
        Stage made{name, {{name + ".key", inputs_.count(name) ? inputs_[name] : "1"}}, std::move(rewrites), resumable, nullptr};
        made.work = [this, name](bool resume) {
            done_.push_back(resume ? name + " resumed" : name);
            write_file(folder_ / (name + ".txt"), "of " + name);
            if (name == "report") write_file(folder_ / "page", "of report");
            if (name == "start") write_file(folder_ / "a.txt", "rewritten");
            if (name == interrupted_) throw Interrupted("stopped");
            return StageOutcome{{name + ".txt"}, 0.5};
        };
        if (name == "report") made.made_again = {"page"};
        return made;
    }

    /// \return what was done in this call
    std::vector<std::string> go(bool resume = false, const std::string& until = "report") {
        done_.clear();
        const RunDirectory directory(folder_);
        Manifest manifest(directory.file("manifest.json"));
        run_stages(directory, manifest, {stage("a"), stage("start", {"a.txt"}), stage("run", {}, true), stage("report")}, until, resume,
                   [](const Stage&, StageEvent, double) {});
        return done_;
    }

    std::string refusal(bool resume = false) {
        try {
            go(resume);
        } catch (const UserError& error) {
            EXPECT_TRUE(done_.empty()) << "nothing is done before all rules are checked";
            return error.what();
        }
        ADD_FAILURE() << "it was not refused";
        return "";
    }

    using Names = std::vector<std::string>;
    fs::path folder_;
    std::map<std::string, std::string> inputs_;
    std::string interrupted_;
    Names done_;
};

void expect_contains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\n lacks: " << part;
}

}  // namespace

TEST_F(Stages, are_done_once_and_in_order) {
    EXPECT_EQ(go(false, "start"), (Names{"a", "start"}));
    EXPECT_EQ(go(), (Names{"run", "report"}));
    EXPECT_EQ(go(), Names{});
    EXPECT_EQ(go(true), Names{});
    const Manifest manifest(folder_ / "manifest.json");
    ASSERT_NE(manifest.find("run"), nullptr);
    EXPECT_EQ(manifest.find("run")->state, StageState::done);
    EXPECT_EQ(manifest.find("run")->core_s, 0.5);
    EXPECT_EQ(manifest.find("run")->outputs.at("run.txt"), sha256("of run"));
    EXPECT_EQ(manifest.find("run")->finished.size(), 20u);
}

TEST_F(Stages, make_a_lost_report_again) {
    go();
    fs::remove(folder_ / "page");
    EXPECT_EQ(go(), Names{"report"});
    write_file(folder_ / "page", "");
    EXPECT_EQ(go(), Names{"report"});
    EXPECT_EQ(read_file(folder_ / "page"), "of report");
    EXPECT_EQ(go(), Names{});
}

/// A kind without the first stages has results, whose stage `run` has the same name.
TEST_F(Stages, of_another_kind_do_not_overwrite_results) {
    {
        const RunDirectory directory(folder_);
        Manifest manifest(directory.file("manifest.json"));
        run_stages(directory, manifest, {stage("start"), stage("run", {}, true)}, "run", false, [](const Stage&, StageEvent, double) {});
    }
    done_.clear();
    for (const bool resume : {false, true}) expect_contains(refusal(resume), "results of another kind of study, which has no stage a");
    EXPECT_EQ(read_file(folder_ / "run.txt"), "of run");
}

TEST_F(Stages, of_another_kind_are_refused_when_they_left_no_results) {
    {
        Manifest manifest(folder_ / "manifest.json");
        manifest.set_kind("cutter");
        manifest.start("mesh", {}, {});
    }
    Manifest manifest(folder_ / "manifest.json");
    EXPECT_NO_THROW(manifest.set_kind("cutter"));
    try {
        manifest.set_kind("room");
        FAIL();
    } catch (const UserError& error) {
        expect_contains(error.what(), "contains work of a study of kind cutter, not room");
    }
}

TEST(StageInputs, hold_every_key_of_the_study_once_and_in_the_stage_that_its_row_names) {
    const fs::path folder = fs::temp_directory_path();
    const std::string surface = fmt::format("cutterflow_stage_inputs_{}.stl", ::getpid());
    write_file(folder / surface, "solid");
    ParameterValues values, feed, rock;
    std::map<std::string, std::string> stage_of;
    for (const Parameter& parameter : study_table()) {
        if (parameter.key == "report.adv_points") continue;  // counts by the content of its file
        const bool of_class = parameter.key.rfind("feed.class.", 0) == 0, of_feed = parameter.key.rfind("feed.", 0) == 0;
        ParameterValues& place = of_class ? rock : of_feed ? feed : values;
        const bool is_file = parameter.kind == ParameterKind::path;  // counts by its content
        place.set(parameter.key, is_file ? surface : std::string("given"));
        const std::string name = parameter.key.substr(parameter.key.rfind('.') + 1);
        stage_of[of_class ? "feed[1].class[1]." + name : of_feed ? "feed[1]." + name : parameter.key] = parameter.stage;
    }
    feed.tables_for_writing("feed.class").push_back(rock);
    values.tables_for_writing("feed").push_back(feed);
    std::map<std::string, std::string> found;
    for (const std::string stage : {k_geometry_stage, k_mesh_stage, k_case_stage, k_report_stage})
        for (const auto& [key, value] : stage_inputs(values, folder, stage)) EXPECT_TRUE(found.emplace(key, stage).second) << key;
    EXPECT_EQ(found, stage_of);
    EXPECT_EQ(found.at("suction.mouth_radius_m"), "geometry");
    EXPECT_EQ(found.at("suction.discharge_m3_s"), "case");
    EXPECT_EQ(found.at("mesh.preset"), "mesh");
    EXPECT_EQ(found.at("scale.length_ratio"), "report");

    const auto case_inputs = [&] { return stage_inputs(values, folder, k_case_stage); };
    const auto before = case_inputs();
    write_file(folder / surface, "another solid");
    EXPECT_NE(case_inputs().at("bank.file"), before.at("bank.file"));
    fs::remove(folder / surface);
}

TEST(StageInputs, of_a_room_belong_to_the_stage_that_every_row_names) {
    std::map<std::string, std::string> stage_of;
    for (const Parameter& parameter : room_table()) stage_of[parameter.key] = parameter.stage;
    for (const auto& [key, stage] : stage_of)
        EXPECT_TRUE(stage == room_stage::k_geometry || stage == room_stage::k_bed || stage == room_stage::k_mesh ||
                    stage == room_stage::k_case || stage == room_stage::k_report)
            << key << ": " << stage;
    const std::map<std::string, std::string> expected{{"name", "report"},
                                                      {"room.size_m", "bed"},
                                                      {"room.tilt_deg", "case"},
                                                      {"room.refine.box.lower_m", "mesh"},
                                                      {"kernel.gamma", "case"},
                                                      {"solid.inner_radius_m", "geometry"},
                                                      {"solid.material", "bed"},
                                                      {"solid.velocity_m_s", "case"},
                                                      {"solid.turn_rpm", "case"},
                                                      {"boundary.flow", "mesh"},
                                                      {"boundary.grains", "bed"},
                                                      {"contact.friction", "bed"},
                                                      {"dem.time_step_fraction", "bed"},
                                                      {"grains.class.mass_share", "bed"},
                                                      {"prepare.region.sphere.radius_m", "bed"},
                                                      {"event.rate_kg_s", "case"},
                                                      {"measure.what", "report"},
                                                      {"measure.seed_m", "report"},
                                                      {"measure.gate.disc_m", "case"},
                                                      {"measure.upstream_m", "case"},
                                                      {"run.end_s", "case"},
                                                      {"run.seed", "bed"}};
    for (const auto& [key, stage] : expected) EXPECT_EQ(stage_of.at(key), stage) << key;
}

TEST_F(Stages, changed_inputs_redo_what_follows_while_there_are_no_results) {
    go(false, "start");
    inputs_["a"] = "2";
    EXPECT_EQ(go(false, "start"), (Names{"a", "start"}));
    inputs_["start"] = "2";
    EXPECT_EQ(go(false, "start"), Names{"start"});
}

TEST_F(Stages, results_are_not_overwritten_by_a_changed_study) {
    go();
    inputs_["a"] = "2";
    const std::string text = refusal();
    expect_contains(text, "a.key (1 -> 2)");
    expect_contains(text, "-o");
    refusal(true);
    inputs_["a"] = "1";
    inputs_["report"] = "2";
    EXPECT_EQ(go(), Names{"report"}) << "a changed report costs nothing of the run";
}

TEST_F(Stages, an_interrupted_stage_begins_anew_and_a_resumable_one_goes_on_when_asked) {
    interrupted_ = "start";
    EXPECT_THROW(go(), Interrupted);
    EXPECT_EQ(done_, (Names{"a", "start"}));
    interrupted_ = "run";
    EXPECT_THROW(go(), Interrupted);
    EXPECT_EQ(done_, (Names{"start", "run"}));
    interrupted_.clear();
    expect_contains(refusal(), "--resume");
    EXPECT_EQ(go(true), (Names{"run resumed", "report"}));
}

TEST_F(Stages, a_process_killed_in_the_middle_leaves_a_manifest_that_says_so) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        const RunDirectory directory(folder_);
        Manifest manifest(directory.file("manifest.json"));
        Stage endless = stage("run", {}, true);
        endless.work = [](bool) -> StageOutcome {
            ::raise(SIGKILL);
            return {};
        };
        run_stages(directory, manifest, {stage("a"), stage("start", {"a.txt"}), endless, stage("report")}, "report", false,
                   [](const Stage&, StageEvent, double) {});
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    expect_contains(refusal(), "the stage run");
    EXPECT_EQ(go(true), (Names{"run resumed", "report"}));
}

TEST_F(Stages, a_run_that_begins_anew_keeps_the_users_folders) {
    const Names of_the_run{"0.25", "1e-05", "3", "processor0", "processor11", "postProcessing", "checkpoints"};
    const Names of_others{"0",   "0.orig", "constant", "2026-11-29", "1.2.3",     "e",          "-",
                          "...", "nan",    "inf",      "0x10",       "processor", "processor_0"};
    for (const Names& folders : {of_the_run, of_others})
        for (const std::string& name : folders) fs::create_directories(folder_ / name / "kept");
    remove_unfinished_run(folder_);
    for (const std::string& name : of_the_run) EXPECT_FALSE(fs::exists(folder_ / name)) << name;
    for (const std::string& name : of_others) EXPECT_TRUE(fs::exists(folder_ / name / "kept")) << name;
}

TEST_F(Stages, a_run_that_begins_anew_notes_what_it_took_before) {
    const auto killed_after = [&](double step_s) {
        for (const char* folder : {"processor0", "processor1", "processor2"}) fs::create_directories(folder_ / folder);
        write_file(folder_ / "postProcessing/cost/0/cost.csv", fmt::format("time_s,step_s,fluid_s\n0.1,{0},1\n0.2,{0},1\n0.3,", step_s));
    };
    killed_after(2.0);
    remove_unfinished_run(folder_);
    EXPECT_FALSE(fs::exists(folder_ / "postProcessing"));
    EXPECT_NEAR(replaced_core_seconds(folder_), 3 * 2 * 2.0, 1e-12);
    killed_after(0.5);
    remove_unfinished_run(folder_);
    remove_unfinished_run(folder_);
    EXPECT_NEAR(replaced_core_seconds(folder_), 3 * 2 * 2.5, 1e-12);
}

TEST_F(Stages, one_that_fails_notes_what_its_programs_took) {
    const RunDirectory directory(folder_);
    Manifest manifest(directory.file("manifest.json"));
    Stage failing = stage("a");
    failing.work = [this](bool) -> StageOutcome {
        require_child({{"sh", "-c", "i=0; while [ $i -lt 100000 ]; do i=$((i + 1)); done; exit 1"}, {}, folder_ / "a.log", {}});
        return {};
    };
    EXPECT_THROW(run_stages(directory, manifest, {failing}, "a", false, [](const Stage&, StageEvent, double) {}), ToolError);
    const Manifest read(directory.file("manifest.json"));
    EXPECT_EQ(read.find("a")->state, StageState::started);
    EXPECT_GT(read.core_s(), 0.01);
    EXPECT_LE(read.core_s(), read.find("a")->wall_s + 0.02) << "one program";
}

TEST_F(Stages, files_changed_by_hand_are_named_and_kept) {
    go(false, "start");
    write_file(folder_ / "start.txt", "mine");
    const std::string text = refusal();
    expect_contains(text, (folder_ / "start.txt").string());
    expect_contains(text, "changed by hand");
    expect_contains(text, "overrides/start.txt");
    EXPECT_EQ(read_file(folder_ / "start.txt"), "mine");
    fs::remove(folder_ / "start.txt");
    expect_contains(refusal(), "was removed");
}

TEST_F(Stages, a_file_that_a_later_stage_rewrites_is_not_taken_for_a_change_by_hand) {
    go(false, "start");
    EXPECT_EQ(read_file(folder_ / "a.txt"), "rewritten");
    EXPECT_EQ(go(false, "start"), Names{});
}

TEST_F(Stages, refuses_directories_that_are_no_runs_and_paths_that_openfoam_cannot_take) {
    write_file(folder_ / "thesis.tex", "mine");
    expect_contains(refusal(), "nothing is overwritten");
    fs::remove(folder_ / "thesis.tex");
    write_file(folder_ / "overrides/system/fvSolution", "mine");
    EXPECT_EQ(go(false, "a"), Names{"a"});
    const fs::path good = folder_;
    for (const char* name : {"run 1", "run(1)", "run'1"}) {
        folder_ = good.parent_path() / name;
        expect_contains(refusal(), "OpenFOAM");
        EXPECT_FALSE(fs::exists(folder_));
    }
    folder_ = good / "manifest.json" / "below";
    expect_contains(refusal(), "cannot be a run directory");
    folder_ = good;
    for (const auto& [content, why] : {std::pair{"{}", "a value is missing or of another kind"},
                                       {"{\"schema\": \"cutterflow.mani", "it is cut off or damaged"},
                                       {"{\"schema\": 3}", "its schema is 3"}}) {
        write_file(folder_ / "manifest.json", content);
        expect_contains(refusal(), why);
        EXPECT_EQ(refusal().find("json.exception"), std::string::npos) << refusal();
    }
}

// Also of a run that is only read, as by a replay: no option names its folder.
TEST_F(Stages, a_folder_that_cannot_be_locked_is_told) {
    fs::create_directories(folder_ / ".lock");  // not even root opens it for writing
    expect_contains(refusal(), "Make it writable, or copy it to a place that is");
    EXPECT_EQ(refusal().find("-o"), std::string::npos) << refusal();
}

TEST_F(Stages, one_process_at_a_time_works_in_a_run_directory_and_its_children_count) {
    {
        const RunDirectory directory(folder_);
        expect_contains(refusal(), "in use");
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            ::execlp("sleep", "sleep", "0.5", static_cast<char*>(nullptr));
            ::_exit(127);
        }
    }
    expect_contains(refusal(), "in use");
    ::wait(nullptr);
    EXPECT_EQ(go(false, "a"), Names{"a"});
}

// A part of them would keep the other directory from taking the rest later.
TEST_F(Stages, are_shared_together_or_not_at_all) {
    const fs::path other = folder_.parent_path() / "other";
    interrupted_ = "start";
    EXPECT_THROW(go(), Interrupted);
    EXPECT_FALSE(stages_are_done(folder_, {"a", "start"}));
    share_stages(folder_, other, {"a", "start"});
    EXPECT_FALSE(fs::exists(other));
    interrupted_.clear();
    go(false, "start");
    EXPECT_TRUE(stages_are_done(folder_, {"a", "start"}));
    share_stages(folder_, other, {"a", "start"});
    EXPECT_TRUE(stages_are_done(other, {"a", "start"}));
    EXPECT_EQ(read_file(other / "start.txt"), "of start");
}

TEST_F(Stages, overrides_are_copied_over_the_case) {
    const RunDirectory directory(folder_);
    write_file(folder_ / "system/fvSolution", "generated");
    write_file(folder_ / "overrides/system/fvSolution", "mine");
    write_file(folder_ / "overrides/constant/deep/er", "new");
    EXPECT_EQ(directory.overrides(), (Names{"constant/deep/er", "system/fvSolution"}));
    Names copied;
    for (const std::string& file : directory.apply_overrides(directory.overrides())) copied.push_back(file);
    EXPECT_EQ(copied, directory.overrides());
    EXPECT_EQ(read_file(folder_ / "system/fvSolution"), "mine");
    EXPECT_EQ(read_file(folder_ / "constant/deep/er"), "new");
}
