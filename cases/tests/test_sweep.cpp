#include "cases/sweep/sweep.hpp"

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cases/runner/run_directory.hpp"
#include "cases/scenes/cutter/study_bank.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/study/study.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/head/crown_cutter.hpp"
#include "geometry/io/write_stl.hpp"

using namespace cutterflow;
using namespace cutterflow::cases;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

class Sweep : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_sweep_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
        static const geometry::TriangleSurface crown = geometry::generate_crown_cutter(
            geometry::read_crown_parameters(fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/model_cutter/crown.toml"));
        for (const char* file : {"a.stl", "b.stl"}) geometry::write_stl(crown, folder_ / file);
        write_file(folder_ / "study.toml",
                   "name = \"head\"\n[cutter]\nfile = \"a.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n"
                   "[run]\nflow_revolutions = 1\n[[feed]]\ncount = 20\nseed = 7\n[[feed.class]]\ndiameter_m = 0.02\n");
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::vector<SweepPoint> points(SweepAxes axes) const { return sweep_points(folder_ / "study.toml", axes, folder_ / "sweep"); }

    /// The file that a point's study names.
    fs::path named_file(const SweepPoint& point, const std::string& key) const {
        const fs::path studies = folder_ / "sweep/studies";
        fs::create_directories(studies);
        return studies / parse_parameters(study_table(), point.text, point.name).text(key);
    }

    /// A sweep over one key, `set` as on the command line, is refused with a message that holds `part`.
    void expect_refused(const std::string& set, const std::string& part) const {
        SweepAxes axes;
        axes.keys = key_axes(study_table(), {set}, "params");
        try {
            points(axes);
            FAIL() << "accepted";
        } catch (const UserError& error) {
            EXPECT_THAT(error.what(), HasSubstr(part));
        }
    }

    /// A stand-in for cutterflow: `script` is given the command, the study, "-o" and the run directory as $1, $2, $3, $4.
    SweepSettings settings(const std::string& script, bool resume = false, int jobs = 2) const {
        write_file(folder_ / "program", "#!/bin/sh\n" + script + "\n");
        fs::permissions(folder_ / "program", fs::perms::owner_all);
        return {folder_ / "sweep", folder_ / "program", 1, jobs, resume};
    }

    SweepOutcome run(const std::vector<SweepPoint>& all, const SweepSettings& how) {
        lines_.clear();
        return run_sweep(all, how, [this](const std::string& line) { lines_.push_back(line); });
    }

    static double release_of(const ParameterValues& study) { return study.tables("feed")[0].number("feed.start_revolution"); }
    double release_of(const SweepPoint& point) const { return release_of(parse_parameters(study_table(), point.text, point.name)); }

    /// The points as programs until 2026-11-29 released them: repeat k of N, on six blades, k/N of a passing after the first revolution.
    std::vector<SweepPoint> released_before(std::vector<SweepPoint> all, int count) const {
        for (std::size_t i = 0; i < all.size(); ++i) {
            ParameterValues values = parse_parameters(study_table(), all[i].text, all[i].name);
            ParameterValues& feed = values.tables_for_writing("feed")[0];
            feed.remove("feed.start_revolution");
            if (const int k = static_cast<int>(i) % count; k > 0)
                feed.set("feed.start_revolution", 1.0 + static_cast<double>(k) / (count * 6));
            all[i].text = commented_toml(study_table(), &values);
        }
        return all;
    }

    fs::path folder_;
    std::vector<std::string> lines_;
};

constexpr const char* k_runs = R"([ "$1" = run ] || exit 0; echo "  run: 50 %, half"; mkdir -p "$4"; echo ran >> "$4/ran")";

}  // namespace

TEST_F(Sweep, names_the_files_of_its_studies_from_where_they_lie) {
    write_file(
        folder_ / "peanut.clump",
        "[[sphere]]\nx_m = 0.0\ny_m = 0.0\nz_m = 0.0\nradius_m = 1.0\n[[sphere]]\nx_m = 1.0\ny_m = 0.0\nz_m = 0.0\nradius_m = 1.0\n");
    write_file(folder_ / "study.toml", read_file(folder_ / "study.toml") + "shape = \"peanut.clump\"\n");
    for (const SweepPoint& point : points({{30, 60}, {}, {}, 1})) {
        EXPECT_THAT(point.text, HasSubstr("file = \"../../a.stl\""));
        EXPECT_THAT(point.text, HasSubstr("shape = \"../../peanut.clump\""));
    }
}

TEST_F(Sweep, has_a_point_for_every_combination_and_pairs_repeats) {
    const std::vector<SweepPoint> all = points({{30, 60}, {0.1}, {(folder_ / "a.stl").string(), (folder_ / "b.stl").string()}, 2});
    ASSERT_EQ(all.size(), 8u);
    EXPECT_EQ(all[0].name, "a_30rpm_0.1m3_s_repeat1");
    EXPECT_EQ(all[7].name, "b_60rpm_0.1m3_s_repeat2");
    EXPECT_EQ(all[0].design, all[3].design);
    EXPECT_NE(all[0].design, all[4].design);
    for (const SweepPoint& point : all) write_file(folder_ / "sweep/studies" / (point.name + ".toml"), point.text);
    const ParameterValues first = read_study(folder_ / "sweep/studies" / (all[6].name + ".toml"));
    const ParameterValues second = read_study(folder_ / "sweep/studies" / (all[7].name + ".toml"));
    EXPECT_EQ(first.number("rotor.speed_rpm"), 60.0);
    EXPECT_EQ(first.number("suction.discharge_m3_s"), 0.1);
    EXPECT_TRUE(fs::equivalent(folder_ / "sweep/studies" / first.text("cutter.file"), folder_ / "b.stl"));
    EXPECT_EQ(first.tables("feed")[0].integer("feed.seed"), 7);
    EXPECT_EQ(second.tables("feed")[0].integer("feed.seed"), 8);
    // Six blades: the second is released by the golden ratio of a passing later.
    EXPECT_FALSE(first.tables("feed")[0].has("feed.start_revolution"));
    EXPECT_NEAR(release_of(second), 1.0 + 0.5 * (std::sqrt(5.0) - 1.0) / 6.0, 1e-12);
}

TEST_F(Sweep, takes_more_repeats_when_it_is_gone_on_with) {
    run(points({{20}, {}, {}, 3}), settings(k_runs));
    const std::vector<SweepPoint> more = points({{20}, {}, {}, 5});
    run(more, settings(k_runs, true));
    EXPECT_EQ(read_file(folder_ / "sweep/20rpm_repeat3/ran"), "ran\nran\n");
    EXPECT_EQ(read_file(folder_ / "sweep/20rpm_repeat5/ran"), "ran\n");
    // Angles of release stay apart: by the golden ratio, five in a passing are never nearer than 0.14 of it.
    for (std::size_t i = 1; i < more.size(); ++i)
        for (std::size_t j = i + 1; j < more.size(); ++j) EXPECT_GT(std::abs(release_of(more[i]) - release_of(more[j])), 0.14 / 6.0);
}

TEST_F(Sweep, keeps_the_releases_of_a_sweep_of_an_earlier_program) {
    const std::vector<SweepPoint> begun = released_before(points({{30}, {}, {}, 3}), 3);
    run(begun, settings(k_runs));
    const std::vector<SweepPoint> more = points({{20, 30}, {}, {}, 5});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(more[5 + i].text, begun[i].text);
    EXPECT_EQ(release_of(more[2]), release_of(begun[2])) << "the same repeat of a speed that is added is a pair with it";
    EXPECT_NEAR(release_of(more[8]), 1.0 + release_share(3) / 6.0, 1e-12) << "repeats that are added are released as in a new sweep";
    EXPECT_NO_THROW(run(more, settings(k_runs, true)));
    write_file(folder_ / "study.toml", read_file(folder_ / "study.toml") + "density_kg_m3 = 2700\n");
    EXPECT_THROW(run(points({{20, 30}, {}, {}, 5}), settings(k_runs, true)), UserError);
}

// A calibration's runs at its answer have numbers of their own, and angles that none before had.
TEST_F(Sweep, releases_a_repeat_by_its_number_wherever_a_range_begins) {
    const std::vector<SweepPoint> all = points({{20}, {}, {}, {5}}), last = points({{20}, {}, {}, {2, 3}});
    ASSERT_EQ(last.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(last[i].name, all[3 + i].name);
        EXPECT_EQ(last[i].text, all[3 + i].text);
    }
    const std::vector<SweepPoint> begun = released_before(last, 2);
    for (const SweepPoint& point : begun) write_file(folder_ / "sweep/studies" / (point.name + ".toml"), point.text);
    const std::vector<SweepPoint> gone_on = points({{20}, {}, {}, {2, 3}});
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(gone_on[i].text, begun[i].text) << "of an earlier program";
}

TEST_F(Sweep, varies_any_key_and_shares_the_mesh_where_the_key_leaves_it_as_it_is) {
    SweepAxes axes;
    axes.speeds = {30, 60};
    axes.keys =
        key_axes(study_table(), {"ladder.inclination_deg=30,45", "mesh.preset=draft,standard", "feed.class.diameter_m=0.03"}, "params");
    const std::vector<SweepPoint> all = points(axes);
    ASSERT_EQ(all.size(), 8u);
    EXPECT_EQ(all[0].name, "30rpm_inclination_deg_30_preset_draft_class.diameter_m_0.03");
    const ParameterValues values = parse_parameters(study_table(), all[3].text, "point");
    EXPECT_EQ(values.number("ladder.inclination_deg"), 45.0);
    EXPECT_EQ(values.text("mesh.preset"), "standard");
    EXPECT_EQ(values.tables("feed")[0].tables("feed.class")[0].number("feed.class.diameter_m"), 0.03);
    EXPECT_EQ(all[0].design, all[2].design) << "the inclination only turns gravity";
    EXPECT_NE(all[0].design, all[1].design) << "another mesh";
}

TEST_F(Sweep, has_points_that_find_the_soil_of_the_study) {
    const std::string study = read_file(folder_ / "study.toml");
    const auto write_study = [&](const std::string& file) {
        write_file(folder_ / "study.toml",
                   study.substr(0, study.find("[[feed]]")) + "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n" + file);
    };
    write_study("");
    const ParameterValues values = read_study(folder_ / "study.toml");
    const geometry::Head head = *import_study_cutter(values, folder_).head;
    const Study beside_bank = make_study(resolve_study(values, head_size(head)), folder_);
    geometry::write_stl(bank_surface(beside_bank, head_size(head), head_contour(head, beside_bank.suction.gap)), folder_ / "soil.stl");
    write_study("file = \"soil.stl\"\n");
    EXPECT_TRUE(fs::equivalent(named_file(points({{30}, {}, {}, 1}).at(0), "bank.file"), folder_ / "soil.stl"));
}

TEST_F(Sweep, varies_the_points_of_measurement) {
    for (const char* file : {"near.csv", "far.csv"})
        write_file(folder_ / file,
                   "name,r_m,theta_deg,z_m,frame,u_radial_m_s,u_tangential_m_s,u_axial_m_s\np,0.6,0,-0.1,still,0.1,0.2,0.3\n");
    SweepAxes axes;
    axes.keys =
        key_axes(study_table(), {"report.adv_points=" + (folder_ / "near.csv").string() + "," + (folder_ / "far.csv").string()}, "params");
    const std::vector<SweepPoint> all = points(axes);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_TRUE(fs::equivalent(named_file(all[0], "report.adv_points"), folder_ / "near.csv"));
    EXPECT_TRUE(fs::equivalent(named_file(all[1], "report.adv_points"), folder_ / "far.csv"));
    expect_refused("report.adv_points=absent.csv", "absent.csv");
}

// A study's ".." leaves what a symbolic link leads to, not the link.
TEST_F(Sweep, has_points_that_find_the_cutter_from_below_a_symbolic_link) {
    fs::create_directories(folder_ / "disk/deep/runs");
    fs::create_directory_symlink(folder_ / "disk/deep/runs", folder_ / "runs");
    const fs::path sweep = folder_ / "runs/sweep";
    const SweepPoint point = sweep_points(folder_ / "study.toml", {{30}, {}, {}, 1}, sweep).at(0);
    const fs::path file = sweep / "studies" / (point.name + ".toml");
    write_file(file, point.text);
    EXPECT_TRUE(fs::exists(file.parent_path() / read_study(file).text("cutter.file"))) << point.text;
}

TEST_F(Sweep, refuses_keys_that_other_options_vary_and_values_out_of_bounds) {
    const auto text_of = [&](const std::vector<std::string>& words) {
        SweepAxes axes;
        try {
            axes.keys = key_axes(study_table(), words, "params");
            points(axes);
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string ways = text_of({"rotor.speed_rpm=30", "cutter.file=b.stl"});
    EXPECT_THAT(ways, HasSubstr("Use --rpm"));
    EXPECT_THAT(ways, HasSubstr("Use --design"));
    EXPECT_THAT(text_of({"ladder.inclination_deg=300"}), HasSubstr("ladder.inclination_deg"));
    EXPECT_THAT(text_of({"ladder.inclination=30"}), HasSubstr("Did you mean ladder.inclination_deg?"));
}

TEST_F(Sweep, reports_the_mistakes_of_all_points_before_anything_runs) {
    try {
        points({{60, 6000}, {}, {(folder_ / "a.stl").string(), (folder_ / "absent.stl").string()}, 1});
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("6000"));
        EXPECT_THAT(error.what(), HasSubstr("absent.stl"));
    }
    EXPECT_THROW(points({{60, 60}, {}, {}, 1}), UserError);  // two points of one name
    EXPECT_FALSE(fs::exists(folder_ / "sweep"));
}

TEST_F(Sweep, refuses_a_point_whose_bank_the_head_cannot_cut) {
    const std::string study = read_file(folder_ / "study.toml");
    write_file(folder_ / "study.toml", "name = \"head\"\n" + study.substr(study.find("[cutter]")) +
                                           "[swing]\ndirection = \"over_cut\"\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n");
    expect_refused("bank.cut_height_m=45", "study_cut_height_m_45: bank.cut_height_m = 45. The head with picks");
}

TEST_F(Sweep, refuses_a_point_whose_feed_does_not_use_a_key) {
    write_file(folder_ / "study.toml",
               "name = \"head\"\n[cutter]\nfile = \"a.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n"
               "[[feed]]\nkind = \"batch\"\ncount = 20\nazimuth_width_deg = 30\n[[feed.class]]\ndiameter_m = 0.02\n");
    expect_refused("feed.kind=batch,cut_face", "study_kind_cut_face: feed.azimuth_width_deg = 30. It places a batch");
}

TEST_F(Sweep, repeats_no_water_alone) {
    const std::string study = read_file(folder_ / "study.toml");
    write_file(folder_ / "study.toml", study.substr(0, study.find("[[feed]]")));
    EXPECT_EQ(points({{}, {}, {}, 1}).size(), 1u);
    try {
        points({{}, {}, {}, 2});
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("2 repeats of a study in which nothing is random"));
    }
}

TEST_F(Sweep, ends_with_wrong_input_when_that_is_all_that_failed) {
    const std::string refuse = "; case $4 in *30rpm) exit 2;; *45rpm) exit CODE;; esac";
    const auto outcome_with = [&](const std::string& code) {
        std::string script = k_runs + refuse;
        script.replace(script.find("CODE"), 4, code);
        fs::remove_all(folder_ / "sweep");
        return run(points({{20, 30, 45}, {}, {}, 1}), settings(script));
    };
    EXPECT_EQ(outcome_with("2").refused, 2u);
    EXPECT_EQ(outcome_with("3").refused, 1u);
}

TEST_F(Sweep, goes_on_past_a_point_that_fails) {
    const SweepOutcome outcome =
        run(points({{20, 30, 45}, {}, {}, 1}), settings(std::string(k_runs) + "; case $4 in *30rpm) echo broken; exit 3;; esac"));
    EXPECT_THAT(outcome.done, ElementsAre(folder_ / "sweep/20rpm", folder_ / "sweep/45rpm"));
    ASSERT_EQ(outcome.failed.size(), 1u);
    EXPECT_THAT(outcome.failed[0], HasSubstr("exit code 3"));
    EXPECT_THAT(outcome.failed[0], HasSubstr("broken"));
    EXPECT_TRUE(fs::exists(folder_ / "sweep/logs/30rpm.run.log"));
}

TEST_F(Sweep, is_gone_on_with_when_asked_and_only_as_the_same_sweep) {
    const auto all = points({{20, 30}, {}, {}, 1});
    run(all, settings(k_runs));
    EXPECT_THROW(run(all, settings(k_runs)), UserError);
    run(points({{20, 30, 45}, {}, {}, 1}), settings(k_runs, true));
    EXPECT_EQ(read_file(folder_ / "sweep/20rpm/ran"), "ran\nran\n");
    EXPECT_EQ(read_file(folder_ / "sweep/45rpm/ran"), "ran\n");
    write_file(folder_ / "study.toml", read_file(folder_ / "study.toml") + "density_kg_m3 = 2700\n");
    EXPECT_THROW(run(points({{20, 30}, {}, {}, 1}), settings(k_runs, true)), UserError);
}

// The first point's manifest is there from the mesh's beginning on.
TEST_F(Sweep, finishes_a_mesh_that_was_interrupted_and_shares_it) {
    const auto all = points({{20, 30}, {}, {}, 1});
    const std::string mesh = R"(if [ "$1" = mesh ]; then mkdir -p "$4"; echo "$@" >> "$4/meshed"; echo of > "$4/mesh.txt"
cat > "$4/manifest.json" <<END
{"schema": "cutterflow.manifest/1", "stages": {
"geometry": {"state": "done", "inputs": {}, "outputs": {}, "wall_s": 1, "core_s": 1, "finished": ""},
"mesh": {"state": "STATE", "inputs": {}, "outputs": {"mesh.txt": "0"}, "wall_s": 1, "core_s": 1, "finished": ""}}, "versions": {}}
END
fi
)";
    const auto with_mesh = [&](const std::string& state, bool resume) {
        std::string script = mesh + k_runs;
        script.replace(script.find("STATE"), 5, state);
        run(all, settings(script, resume));
    };
    with_mesh("started", false);
    EXPECT_FALSE(fs::exists(folder_ / "sweep/30rpm/manifest.json"));
    with_mesh("done", true);
    EXPECT_THAT(read_file(folder_ / "sweep/20rpm/meshed"), HasSubstr("--resume"));
    EXPECT_TRUE(fs::exists(folder_ / "sweep/30rpm/mesh.txt"));
    EXPECT_FALSE(fs::exists(folder_ / "sweep/30rpm/meshed"));
    const std::string meshed = read_file(folder_ / "sweep/20rpm/meshed");
    with_mesh("done", true);
    EXPECT_EQ(read_file(folder_ / "sweep/20rpm/meshed"), meshed) << "a finished mesh is not made again";
}

TEST_F(Sweep, is_not_begun_by_asking_to_go_on_with_it) {
    EXPECT_THROW(run(points({{20, 30}, {}, {}, 1}), settings(k_runs, true)), UserError);
    EXPECT_FALSE(fs::exists(folder_ / "sweep"));
}

TEST_F(Sweep, keeps_the_logs_of_an_earlier_call) {
    const auto all = points({{20}, {}, {}, 1});
    run(all, settings(std::string(k_runs) + "; echo the first; exit 3"));
    run(all, settings(std::string(k_runs) + "; echo the second", true));
    EXPECT_THAT(read_file(folder_ / "sweep/logs/20rpm.run.log.1"), HasSubstr("the first"));
    EXPECT_THAT(read_file(folder_ / "sweep/logs/20rpm.run.log"), HasSubstr("the second"));
}

TEST_F(Sweep, works_alone_in_its_folder) {
    const auto all = points({{20}, {}, {}, 1});
    fs::create_directories(folder_ / "sweep");
    {
        const FolderLock other(folder_ / "sweep");
        try {
            run(all, settings(k_runs));
            ADD_FAILURE() << "ran beside another";
        } catch (const UserError& error) {
            EXPECT_THAT(error.what(), HasSubstr("in use by another process"));
        }
        EXPECT_FALSE(fs::exists(folder_ / "sweep/studies"));
    }
    EXPECT_EQ(run(all, settings(k_runs)).done.size(), 1u) << "a folder with the lock of one that has ended is empty";
}

TEST_F(Sweep, runs_as_many_at_a_time_as_it_is_told) {
    // Each point waits for the other: they end only when both run at once.
    const std::string meet =
        std::string(k_runs) +
        R"(; n=0; while [ $(ls -d "$4"/../*rpm | wc -l) -lt 2 ]; do sleep 0.05; n=$((n+1)); [ $n -lt 200 ] || exit 3; done)";
    EXPECT_TRUE(run(points({{20, 30}, {}, {}, 1}), settings(meet)).failed.empty());
}

TEST_F(Sweep, stops_all_its_runs_when_interrupted) {
    const auto all = points({{20, 30, 45}, {}, {}, 1});
    const auto how = settings(
        R"([ "$1" = run ] || exit 0; mkdir -p "$4"; trap 'touch "$4/stopped"; exit 130' INT; touch "$4/began"; while :; do sleep 0.05; done)");
    std::thread stopper([this] {
        while (!fs::exists(folder_ / "sweep/20rpm/began") || !fs::exists(folder_ / "sweep/30rpm/began"))
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        ::kill(::getpid(), SIGINT);
    });
    try {
        run(all, how);
        ADD_FAILURE() << "the sweep went on";
    } catch (const Interrupted& stop) {
        EXPECT_THAT(stop.what(), HasSubstr("Ctrl-C (SIGINT); 0 of 3 points are done"));
    }
    stopper.join();
    EXPECT_TRUE(fs::exists(folder_ / "sweep/20rpm/stopped"));
    EXPECT_TRUE(fs::exists(folder_ / "sweep/30rpm/stopped"));
    EXPECT_FALSE(fs::exists(folder_ / "sweep/45rpm"));
}
