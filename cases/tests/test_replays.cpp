// Whose rock may be replayed in a recorded flow.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cases/replay/replayed_settings.hpp"
#include "cases/replay/rock_study.hpp"
#include "cases/runner/pipeline.hpp"
#include "cases/study/study.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/head/crown_cutter.hpp"
#include "geometry/io/write_stl.hpp"

namespace cutterflow::cases {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

ParameterValues study(const std::string& more) {
    return parse_parameters(study_table(),
                            "[cutter]\nfile = \"/head.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n"
                            "mouth_offset_m = 0.22\n" +
                                more,
                            "study.toml");
}

/// Of a study that leaves out the cutter.
std::vector<Mistake> mistakes_of(const ParameterValues& recorded, ParameterValues other) {
    other.remove("cutter.file");
    return check_same_flow({recorded, {}, {}}, other, "other.toml");
}

TEST(SameFlow, other_rock_another_ladder_and_a_longer_run_are_the_same_flow) {
    const ParameterValues other = study(
        "[ladder]\ninclination_deg = 30\n[run]\nmax_revolutions = 5\nmax_courant = 0.5\n[kernel]\ngamma = 2\n"
        "[[feed]]\ncount = 7\n[[feed.class]]\ndiameter_m = 0.002\ndensity_kg_m3 = 1050\n");
    EXPECT_THAT(mistakes_of(study(""), other), ::testing::IsEmpty());
}

TEST(SameFlow, every_key_of_another_flow_is_named) {
    ParameterValues other = study("[fluid]\ndensity_kg_m3 = 1025\n[mesh]\npreset = \"standard\"\n");
    other.set("rotor.speed_rpm", 59.0);
    other.set("suction.mouth_offset_m", 0.22 * (1.0 + 1e-12));  // written as text and read again
    std::string all;
    for (const Mistake& mistake : mistakes_of(study(""), other)) all += mistake.text() + "\n";
    for (const char* part :
         {"rotor.speed_rpm = 59", "fluid.density_kg_m3 = 1025", "mesh.preset = \"standard\"", "as the run recorded it, with 60"})
        EXPECT_THAT(all, ::testing::HasSubstr(part));
    EXPECT_THAT(all, ::testing::Not(::testing::HasSubstr("mouth_offset")));
}

TEST(SameFlow, a_recorded_flow_keeps_its_bank_and_its_hauling) {
    const std::string bank = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n";
    EXPECT_THAT(mistakes_of(study(bank), study(bank)), ::testing::IsEmpty());
    const std::vector<Mistake> mistakes = mistakes_of(study(bank), study(""));
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_THAT(mistakes.front().text(), ::testing::HasSubstr("bank.model = \"none\""));
    EXPECT_EQ(mistakes_of(study(bank), study(bank + "[hauling]\nwater = true\n")).size(), 1u);
}

// Soil stands to one side and is level; only hauled water knows the swing's speed.
TEST(SameFlow, beside_a_bank_swing_and_ladder_belong_to_the_flow) {
    const auto beside_bank = [](const std::string& swing, const std::string& more) {
        return study("[swing]\n" + swing + "[bank]\nmodel = \"wall\"\n" + more);
    };
    const ParameterValues slow = beside_bank("speed_m_min = 6\n", "");
    EXPECT_THAT(mistakes_of(slow, beside_bank("speed_m_min = 12\n", "")), ::testing::IsEmpty());
    const auto other = beside_bank("speed_m_min = 6\ndirection = \"under_cut\"\n", "[ladder]\ninclination_deg = 30\n");
    EXPECT_EQ(mistakes_of(slow, other).size(), 2u);
    const std::string hauling = "[hauling]\nwater = true\n";
    EXPECT_EQ(mistakes_of(beside_bank("speed_m_min = 6\n", hauling), beside_bank("speed_m_min = 12\n", hauling)).size(), 1u);
}

TEST(Replays, of_a_sweep_are_a_table_of_its_settings) {
    ReplayedSetting fed{"45rpm", {}}, batch{"60rpm", {}};
    fed.results.estimate = postproc::estimate_spillage({0.9, 0.94}, {});
    fed.results.fed = postproc::FedReplays{2, 1, 2, 0.85, 0.92, 11.5, 11.25, 0.012, {0.3, 0.2, 0.42, 0.15}};
    fed.results.replays.resize(2);
    for (Replay& replay : fed.results.replays) replay.core_s = 300.0;
    batch.results.estimate = postproc::estimate_spillage({0.97}, {{0.95, 0.96}});
    const std::string half = fmt::format("{:.6g}", *fed.results.estimate.replay_interval);
    EXPECT_EQ(replays_csv({fed, batch}),
              "setting,placements,spillage,half_interval_95,own_half_interval_95,spillage_min,fed_kg_s,hold_up_kg,settled,head_is_full,"
              "spilled_mixing,spilled_"
              "cutting,left_behind,left_behind_cutting,core_s,weakly_coupled\n"
              "45rpm,2,0.92," +
                  half +
                  ",0.012,0.85,11.5,11.25,1,2,0.3,0.2,0.42,0.15,600,\n"
                  "60rpm,1,0.96,,,,,,,,,,,,0,0\n");
}

TEST(Replays, of_a_setting_that_fails_do_not_stop_the_others) {
    const auto replay = [](const std::string& name, const std::vector<fs::path>&) {
        if (name == "a") throw UserError("the folder holds something else", "Nothing is overwritten", "Move it away");
        ReplayResults results;
        results.estimate = postproc::estimate_spillage({0.5}, {{name == "b" ? 0.8 : 0.51, 0.5}});
        return results;
    };
    const ReplayedSettings all = replay_each({{"a", {}}, {"b", {}}, {"c", {}}}, replay);
    ASSERT_EQ(all.settings.size(), 2u) << "rock that changes the flow too much has an answer, which is refused";
    EXPECT_THAT(replays_csv(all.settings), AllOf(HasSubstr("\nb,1,0.8,"), HasSubstr(",0,0\nc,1,0.51,"), HasSubstr(",0,1\n")));
    ASSERT_EQ(all.failures.size(), 2u);
    EXPECT_EQ(all.failures[0].code, ExitCode::user_input);
    EXPECT_THAT(all.failures[0].text, HasSubstr("replays of a: the folder holds something else"));
    EXPECT_EQ(all.failures[1].code, ExitCode::check_failed);
    EXPECT_THROW(
        replay_each({{"a", {}}}, [](const std::string&, const std::vector<fs::path>&) -> ReplayResults { throw Interrupted("stopped"); }),
        Interrupted);
}

TEST(Replays, that_fail_in_one_way_end_the_sweep_that_way) {
    const SweepFailure refused{ExitCode::user_input, "wrong"}, failed{ExitCode::external_program, "broken"},
        strong{ExitCode::check_failed, "too much"};
    EXPECT_NO_THROW(require_no_failures({}));
    EXPECT_THROW(require_no_failures({refused, refused}), UserError);
    EXPECT_THROW(require_no_failures({strong}), CheckFailure);
    EXPECT_THROW(require_no_failures({refused, strong}), ToolError);
    EXPECT_THROW(require_no_failures({failed}), ToolError);
}

TEST(Replays, of_a_run_from_before_the_key_sample_as_that_run) {
    EXPECT_EQ(study_as_recorded(study("")).text("kernel.sampling"), "quadratic");
    EXPECT_EQ(study_as_recorded(study("[kernel]\nsampling = \"gaussian\"\n")).text("kernel.sampling"), "gaussian");
}

TEST(Replays, of_a_run_from_before_unused_keys_were_refused_leave_them_out) {
    const ParameterValues recorded =
        study_as_recorded(study("[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n[[feed]]\nkind = \"cut_face\"\ndepth_to_m = 0.3\n"
                                "[[feed.class]]\ndiameter_m = 0.02\n"));
    EXPECT_FALSE(recorded.tables("feed").at(0).has("feed.depth_to_m"));
    EXPECT_THAT(check_file_rules(recorded, "study.toml"), ::testing::IsEmpty());
}

/// Writes the tables of a replay or a run with two rocks of a kilogram together: one is spilled, the other sucked up.
/// \param spilled  mass of the one [kg]
std::string tables_script(double spilled) {
    const double diameter = 0.1, per_mass = 1.0 / sphere_mass(diameter, 1.0);
    const auto event = [&](const char* time, int id, const char* what, const char* bin, double mass) {
        return fmt::format("{},{},{},0.4,0,0,0,0,0,0,0,0,{},{:.12g},{}\n", time, id, what, diameter, per_mass * mass, bin);
    };
    const std::string events = event("1.1", 1, "head,in", "", spilled) + event("1.2", 2, "head,in", "", 1.0 - spilled) +
                               event("1.3", 1, "head,out", "gap", spilled) + event("1.4", 2, "mouth,in", "", 1.0 - spilled);
    return fmt::format(
        "mkdir -p postProcessing/rock/0 postProcessing/cost/0\n"
        "cat > postProcessing/rock/0/fates.csv <<END\n"
        "time_s,placed_count,placed_kg,sucked_up_count,sucked_up_kg,spilled_count,spilled_kg,in_cutter_count,in_cutter_kg,"
        "never_entered_count,never_entered_kg\n1.5,2,1,1,{},1,{},0,0,0,0\nEND\n"
        "cat > postProcessing/rock/0/events.csv <<END\n"
        "time_s,id,surface,direction,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,rotor_angle_rad,azimuth_rad,axial_m,diameter_m,density_kg_m3,bin\n"
        "{}END\n"
        "echo '{{\"core_s\": 2}}' > postProcessing/cost/0/cost.json\n",
        1.0 - spilled, spilled, events);
}

/// Runs of a crown with a recording that nothing plays.
class RecordedRuns : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        std::string name = (fs::temp_directory_path() / "cutterflow_replays_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        suite_ = name;
        geometry::write_stl(geometry::generate_crown_cutter(geometry::read_crown_parameters(fs::path(CUTTERFLOW_SOURCE_DIR) /
                                                                                            "cases/examples/model_cutter/crown.toml")),
                            suite_ / "crown.stl");
        write_file(suite_ / "study.toml", study_text());
        const RunDirectory directory(suite_ / "geometry_alone");
        Manifest manifest(directory.file(names::manifest));
        Pipeline pipeline(directory, {suite_ / "study.toml", 1, "/bin/false", {}}, [](const std::string&) {});
        run_stages(directory, manifest, pipeline.stages(), "geometry", false, [](const Stage&, StageEvent, double) {});
    }
    static void TearDownTestSuite() { fs::remove_all(suite_); }
    void SetUp() override {
        folder_ = suite_ / ::testing::UnitTest::GetInstance()->current_test_info()->name();
        fs::create_directories(folder_);
    }

    static std::string study_text(double rpm = 60.0, int seed = 7, double start = 1.0, const std::string& name = "head") {
        return fmt::format(
            "name = \"{}\"\n[cutter]\nfile = \"crown.stl\"\n[rotor]\nspeed_rpm = {}\n[suction]\ndischarge_m3_s = 0.12\n"
            "[run]\nflow_revolutions = 1\n[[feed]]\ncount = 20\nseed = {}\nstart_revolution = {}\n[[feed.class]]\ndiameter_m = 0.02\n",
            name, rpm, seed, start);
    }

    /// Of a head that is fed from its second revolution to its end, in the last of two seconds.
    static std::string fed_study_text() {
        return "name = \"fed\"\n[cutter]\nfile = \"crown.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n"
               "[swing]\ndirection = \"over_cut\"\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n"
               "[run]\nflow_revolutions = 1\nmax_revolutions = 2\n[[feed]]\nkind = \"cut_face\"\n[[feed.class]]\ndiameter_m = 0.02\n";
    }

    /// A stand-in for cutterFoam, which is called in the replay's folder.
    fs::path program(const std::string& script) const {
        write_file(folder_ / "program", "#!/bin/sh\n" + script + "\n");
        fs::permissions(folder_ / "program", fs::perms::owner_all);
        return folder_ / "program";
    }

    fs::path run(const std::string& name, const std::string& study) const {
        const fs::path folder = folder_ / name;
        fs::copy(suite_ / "geometry_alone", folder, fs::copy_options::recursive);
        const ParameterValues values = parse_parameters(study_table(), study, name);
        write_file(folder / names::resolved_study, commented_toml(study_table(), &values));
        write_file(folder / names::recording / "recording.json",
                   R"({"schema": "cutterflow.recording/2", "change": 0.01, "start_s": 0.0, "end_s": 1.0})");
        return folder;
    }

    /// The solver fails, so that a call which is not refused ends with ToolError.
    ReplaySettings settings(const std::vector<fs::path>& runs, const fs::path& study = {}) const {
        return {runs, study, 1, folder_ / "replays", "/bin/false", 1, fs::exists(folder_ / "replays")};
    }

    static std::string refusal(const ReplaySettings& settings) {
        try {
            run_replays(settings, [](const std::string&) {});
        } catch (const UserError& error) {
            return error.what();
        } catch (const ToolError&) {
            return "not refused";
        }
        return "done";
    }

    inline static fs::path suite_;
    fs::path folder_;
};

TEST_F(RecordedRuns, of_other_settings_are_refused_with_every_key_that_differs) {
    const fs::path first = run("30rpm", study_text(30)), repeat = run("30rpm_repeat2", study_text(30, 8, 1.05, "second")),
                   fast = run("90rpm", study_text(90)), coarse = run("coarse", study_text(30) + "density_kg_m3 = 2000\n");
    EXPECT_THAT(refusal(settings({first, fast, repeat, coarse})),
                AllOf(HasSubstr("90rpm: "), HasSubstr("rotor.speed_rpm = 90 (the first run has 30)"),
                      HasSubstr("coarse: feed[1].class[1].density_kg_m3 = 2000 (the first run has 2650)"),
                      ::testing::Not(HasSubstr("repeat2")), ::testing::Not(HasSubstr("seed = "))));
    EXPECT_EQ(refusal(settings({first, repeat})), "not refused");
}

TEST_F(RecordedRuns, of_water_alone_need_a_study_with_rock) {
    const std::string study = study_text(), rock = study.substr(study.find("[[feed]]"));
    const fs::path water = run("water", study.substr(0, study.find("[[feed]]")));
    EXPECT_THAT(refusal(settings({water})), AllOf(HasSubstr("water: its study has no [[feed]]"), HasSubstr("--study")));
    write_file(folder_ / "rock.toml", rock);
    EXPECT_EQ(refusal(settings({water}, folder_ / "rock.toml")), "not refused");
}

// The coupled run and the replay of its rock would differ by the override.
TEST_F(RecordedRuns, with_an_override_of_rock_or_coupling_are_refused) {
    const auto run_with = [&](const std::string& file) {
        const fs::path folder = run(fs::path(file).stem().string(), study_text());
        Manifest manifest(folder / names::manifest);
        manifest.start("case", {{"overrides/" + file, sha256("mine")}}, {});
        manifest.finish("case", {}, 1.0, 1.0);
        return folder;
    };
    const fs::path feed = run_with("constant/rockFeed.csv"), coupling = run_with("constant/couplingProperties"),
                   scheme = run_with("system/fvSchemes");
    EXPECT_THAT(refusal(settings({feed})), HasSubstr("overrides/constant/rockFeed.csv: the run took it"));
    EXPECT_THAT(refusal(settings({coupling})), HasSubstr("overrides/constant/couplingProperties: the run took it"));
    EXPECT_EQ(refusal(settings({scheme})), "not refused");
    write_file(folder_ / "rock.toml", "[[feed]]\ncount = 10\n[[feed.class]]\ndiameter_m = 0.01\n");
    ReplaySettings other = settings({feed}, folder_ / "rock.toml");
    other.folder = folder_ / "other_rock";
    other.resume = false;
    EXPECT_EQ(refusal(other), "not refused");
}

TEST_F(RecordedRuns, come_once_each) {
    const fs::path first = run("a", study_text()), copy = run("b", study_text());
    EXPECT_THAT(refusal(settings({first, copy})), AllOf(HasSubstr("is the same run as"), HasSubstr("feed.seed")));
    EXPECT_THAT(refusal(settings({first, first})), HasSubstr("is the same run as"));
}

TEST_F(RecordedRuns, of_another_cutter_under_the_same_name_are_refused) {
    const fs::path first = run("a", study_text()), other = run("b", study_text(60, 8));
    std::string manifest = read_file(other / names::manifest);
    const std::string hash = sha256_of_file(suite_ / "crown.stl");
    ASSERT_NE(manifest.find(hash), std::string::npos);
    write_file(other / names::manifest, manifest.replace(manifest.find(hash), hash.size(), sha256("another cutter")));
    EXPECT_THAT(refusal(settings({first, other})), HasSubstr("cutter, SHA-256 = "));
}

// A study names its cutter relative to itself, and the run's own may lie elsewhere.
TEST_F(RecordedRuns, take_rock_of_studies_that_name_the_same_cutter_by_any_path) {
    const fs::path recorded = run("a", study_text());
    const auto refusal_of = [&](const std::string& cutter) {
        std::string rock = study_text(60, 8, 1.2);
        rock.replace(rock.find("crown.stl"), 9, cutter);
        write_file(folder_ / "rock.toml", rock);
        fs::remove_all(folder_ / "replays");
        return refusal(settings({recorded}, folder_ / "rock.toml"));
    };
    fs::copy_file(suite_ / "crown.stl", folder_ / "copy.stl");
    write_file(folder_ / "other.stl", "another cutter");
    EXPECT_EQ(refusal_of("../crown.stl"), "not refused");
    EXPECT_EQ(refusal_of("copy.stl"), "not refused");
    EXPECT_THAT(refusal_of("other.stl"), AllOf(HasSubstr("cutter.file = \"other.stl\""), HasSubstr("had other content")));
    EXPECT_THAT(refusal_of("absent.stl"), HasSubstr("absent.stl"));
}

TEST_F(RecordedRuns, take_rock_that_fits_the_head_and_say_how_much_has_a_place) {
    const fs::path recorded = run("a", study_text());
    const auto write_rock = [&](const std::string& quantity, double diameter) {
        write_file(folder_ / "rock.toml",
                   fmt::format("[run]\nrecord_revolutions = 20\n[[feed]]\n{}\n[[feed.class]]\ndiameter_m = {}\n", quantity, diameter));
    };
    write_rock("count = 2000000000", 0.02);
    EXPECT_THAT(refusal(settings({recorded}, folder_ / "rock.toml")), HasSubstr("rock.toml:4: feed.count = 2e+09"));
    write_rock("count = 10", 2.0);
    EXPECT_THAT(refusal(settings({recorded}, folder_ / "rock.toml")), HasSubstr("smaller than the head"));
    write_rock("count = 20", 0.02);
    std::string said;
    EXPECT_THROW(run_replays(settings({recorded}, folder_ / "rock.toml"), [&](const std::string& line) { said += line + "\n"; }),
                 ToolError);
    EXPECT_THAT(said, HasSubstr("rock.toml: 20 rocks requested, 20 placed"));
}

TEST_F(RecordedRuns, take_no_rock_beside_soil_of_another_file) {
    const std::string bank = "[bank]\nmodel = \"wall\"\n", swing = "[swing]\nspeed_m_min = 6\n";
    const fs::path recorded = run("a", study_text() + swing + bank);
    write_file(folder_ / "soil.stl", "soil");
    write_file(folder_ / "rock.toml", swing + bank + "file = \"soil.stl\"\n[[feed]]\ncount = 10\n[[feed.class]]\ndiameter_m = 0.01\n");
    EXPECT_THAT(refusal(settings({recorded}, folder_ / "rock.toml")), AllOf(HasSubstr("soil.stl"), HasSubstr("without such a file")));
}

std::string peanut(double apart) {
    return fmt::format(
        "[[sphere]]\nx_m = 0.0\ny_m = 0.0\nz_m = 0.0\nradius_m = 1.0\n[[sphere]]\nx_m = {}\ny_m = 0.0\nz_m = 0.0\nradius_m = 1.0\n", apart);
}

// The file that the run's study named may be gone.
TEST_F(RecordedRuns, of_clumps_replay_the_shapes_of_the_run) {
    const fs::path recorded = run("a", study_text() + "shape = \"gone/peanut.clump\"\n");
    write_file(recorded / "constant/shapes/peanut.clump", peanut(1.0));
    ASSERT_EQ(refusal(settings({recorded})), "not refused");
    const fs::path folder = folder_ / "replays/pair_1";
    EXPECT_EQ(read_file(folder / "constant/shapes/peanut.clump"), peanut(1.0));
    EXPECT_THAT(read_file(folder / names::rock_feed), HasSubstr(",peanut\n"));
    EXPECT_THAT(read_file(folder / names::coupling_properties), HasSubstr("constant/shapes/peanut.clump"));
    EXPECT_THAT(read_file(folder / names::replay), AllOf(HasSubstr("feed[1].class[1].shape"), HasSubstr(sha256(peanut(1.0)))));
}

TEST_F(RecordedRuns, replay_clumps_of_another_study_and_tell_when_they_change) {
    const fs::path recorded = run("a", study_text()), rock = folder_ / "rock.toml";
    write_file(rock, "[[feed]]\ncount = 10\n[[feed.class]]\ndiameter_m = 0.01\nshape = \"peanut.clump\"\n");
    EXPECT_THAT(refusal(settings({recorded}, rock)), HasSubstr("There is no file " + (folder_ / "peanut.clump").string()));
    write_file(folder_ / "peanut.clump", peanut(1.0));
    ASSERT_EQ(refusal(settings({recorded}, rock)), "not refused");
    EXPECT_EQ(read_file(folder_ / "replays/replay_001/constant/shapes/peanut.clump"), peanut(1.0));
    write_file(folder_ / "peanut.clump", peanut(1.2));
    EXPECT_THAT(refusal(settings({recorded}, rock)), HasSubstr("has changed since the folder's replays were begun"));
}

// A finished replay is not made again, so that rock of both studies would count as one sample.
TEST_F(RecordedRuns, are_not_gone_on_with_by_rock_that_has_changed) {
    const fs::path recorded = run("a", study_text()), rock = folder_ / "rock.toml";
    const auto write_rock = [&](int count, const char* comment) {
        write_file(rock, fmt::format("{}\n[[feed]]\ncount = {}\n[[feed.class]]\ndiameter_m = 0.01\n", comment, count));
    };
    write_rock(10, "");
    ASSERT_EQ(refusal(settings({recorded}, rock)), "not refused");
    write_rock(10, "# the same rock");
    EXPECT_EQ(refusal(settings({recorded}, rock)), "not refused");
    write_rock(11, "");
    EXPECT_THAT(refusal(settings({recorded}, rock)),
                AllOf(HasSubstr("rock.toml has changed"), HasSubstr("samples of one study"), HasSubstr("a new folder with -o")));
}

// A second call that is refused leaves the plan of the first alone; one that was ended before its plan leaves a folder to begin in.
TEST_F(RecordedRuns, are_replayed_by_one_call_at_a_time) {
    const fs::path recorded = run("a", study_text());
    const ReplaySettings first = settings({recorded});
    fs::create_directories(first.folder);
    {
        const FolderLock lock(first.folder);
        EXPECT_THAT(refusal(first), HasSubstr("is in use by another process"));
        EXPECT_FALSE(holds_replays(first.folder));
    }
    EXPECT_EQ(refusal(first), "not refused");
    EXPECT_TRUE(holds_replays(first.folder));
    write_file(folder_ / "others/notes.txt", "of the user");
    EXPECT_THAT(refusal({{recorded}, {}, 1, folder_ / "others", "/bin/false", 1, true}),
                AllOf(HasSubstr("something else"), HasSubstr("move " + (folder_ / "others").string() + " away")));
}

// A run that was made again under its old path may have another flow; earlier programs noted it in each finished replay alone.
TEST_F(RecordedRuns, are_not_gone_on_with_in_another_flow) {
    const fs::path recorded = run("a", study_text());
    const auto record = [&](double end) {
        write_file(recorded / names::recording / "recording.json",
                   fmt::format(R"({{"schema": "cutterflow.recording/2", "change": 0.01, "start_s": 0.0, "end_s": {}}})", end));
    };
    const auto replay = [&] {
        return run_replays({{recorded}, {}, 2, folder_ / "replays", program(tables_script(0.6)), 1, holds_replays(folder_ / "replays")},
                           [](const std::string&) {});
    };
    const auto expect_refused = [&] {
        try {
            replay();
            ADD_FAILURE() << "gone on with";
        } catch (const UserError& error) {
            EXPECT_THAT(error.what(), AllOf(HasSubstr("recorded another flow since"), HasSubstr("Name a new folder with -o")));
        }
    };
    replay();
    EXPECT_NO_THROW(replay());
    record(2.0);
    expect_refused();
    const fs::path plan = folder_ / "replays/plan.json";
    write_file(plan, fmt::format(R"({{"runs": ["{}"]}})", recorded.string()));
    expect_refused();
    record(1.0);
    EXPECT_NO_THROW(replay());
}

TEST_F(RecordedRuns, of_an_earlier_program_are_gone_on_with_where_no_rock_can_have_changed) {
    const fs::path recorded = run("a", study_text()), rock = folder_ / "rock.toml";
    write_file(rock, "[[feed]]\ncount = 10\n[[feed.class]]\ndiameter_m = 0.01\n");
    const fs::path plan = folder_ / "replays" / "plan.json";
    write_file(plan, fmt::format(R"({{"runs": ["{}"]}})", recorded.string()));
    EXPECT_EQ(refusal(settings({recorded})), "not refused");
    write_file(plan, fmt::format(R"({{"runs": ["{}", "{}"]}})", recorded.string(), rock.string()));
    EXPECT_THAT(refusal(settings({recorded}, rock)), AllOf(HasSubstr("an earlier program"), HasSubstr("a new folder with -o")));
}

// The file of the points is relative to the study, which may be gone.
TEST_F(RecordedRuns, with_measured_velocities_are_replayed_without_them) {
    const fs::path recorded = run("a", study_text() + "[report]\nadv_points = \"points.csv\"\n");
    EXPECT_EQ(refusal(settings({recorded})), "not refused");
    EXPECT_FALSE(read_parameters(study_table(), folder_ / "replays/pair_1" / names::resolved_study).has("report.adv_points"));
}

// Later releases end later. A replay is of the run's study all the same, so that replays are repeats of one setting.
TEST_F(RecordedRuns, of_a_cut_face_are_fed_until_they_end) {
    const fs::path recorded = run("fed", fed_study_text());
    ReplaySettings both = settings({recorded});
    both.jobs = 2;  // the pair's solver fails when the other's case is about to be written
    ASSERT_EQ(refusal(both), "not refused");
    const auto last_release = [](const fs::path& folder) {
        std::istringstream lines(read_file(folder / names::rock_feed));
        std::string line;
        std::getline(lines, line);
        double last = 0.0;
        while (std::getline(lines, line)) last = std::max(last, std::stod(line.substr(line.find(',') + 1)));
        return last;
    };
    const fs::path replay = folder_ / "replays/replay_001";
    const std::string control = read_file(replay / "system/controlDict"), key = "endTime ";
    const double end = std::stod(control.substr(control.find(key) + key.size()));
    EXPECT_GT(end, 2.0 + 0.05) << "of a run of two seconds";
    EXPECT_LT(last_release(replay), end);
    EXPECT_GT(last_release(replay), end - 0.03);
    EXPECT_NEAR(last_release(replay) - last_release(folder_ / "replays/pair_1"), end - 2.0, 0.03);
    EXPECT_EQ(read_parameters(study_table(), replay / names::resolved_study).number("run.max_revolutions"), 2.0);
}

// A run that was stopped has answered for a part of its time, its replay for all of it.
TEST_F(RecordedRuns, correct_when_they_have_ended) {
    const fs::path stopped = run("stopped", study_text()), ended = run("ended", study_text(60, 8));
    for (const fs::path& folder : {stopped, ended}) {
        ASSERT_EQ(run_child({{program(tables_script(0.7)).string()}, folder, {}, {}}).exit_code, 0);
        Manifest manifest(folder / names::manifest);
        manifest.start("run", {}, {});
        if (folder == ended) manifest.finish("run", {}, 1.0, 1.0);
    }
    std::string said;
    const ReplayResults results = run_replays({{stopped, ended}, {}, 2, folder_ / "replays", program(tables_script(0.6)), 1, false},
                                              [&](const std::string& line) { said += line + "\n"; });
    ASSERT_EQ(results.pairs.size(), 1u);
    EXPECT_NEAR(results.pairs.front().coupled, 0.7, 1e-9);
    EXPECT_NEAR(results.estimate.spillage, 0.7, 1e-9);
    EXPECT_THAT(said, HasSubstr("stopped corrects nothing: it has not ended"));
}

// Pairs are of a coupled run and the replay of its placement.
TEST(Replays, are_refused_where_rock_changes_the_flow) {
    const auto estimate = [](double spilled, double correction) {
        return postproc::estimate_spillage({spilled - 0.001, spilled + 0.001}, {{spilled + correction, spilled}, {0.6 + correction, 0.6}});
    };
    EXPECT_NO_THROW(require_weak_coupling(postproc::estimate_spillage({0.5, 0.52}, {}), "replays"));
    EXPECT_NO_THROW(require_weak_coupling(estimate(0.5, 0.049), "replays"));
    struct Case {
        double spilled, correction;
        const char *says, *rule;
    };
    for (const Case& strong :
         {Case{0.5, 0.07, "+7.0 points", "at most 5 points"}, Case{0.5, -0.07, "-7.0 points", "at most 5 points"},
          Case{0.98, -0.02, "-2.0 points", "at most 0.5 points"}, Case{0.02, 0.02, "+2.0 points", "at most 0.5 points"}}) {
        try {
            require_weak_coupling(estimate(strong.spilled, strong.correction), "replays");
            FAIL() << strong.spilled << " " << strong.correction;
        } catch (const CheckFailure& failure) {
            EXPECT_THAT(failure.what(), AllOf(HasSubstr(strong.says), HasSubstr(strong.rule), HasSubstr("coupled")));
        }
    }
    EXPECT_NO_THROW(require_weak_coupling(estimate(0.98, -0.004), "replays"));
}

}  // namespace
}  // namespace cutterflow::cases
