/// Studies of scenes with a free surface: kind, template, prediction, results from rows.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cases/runner/surface_stages.hpp"
#include "cases/scenes/free_surface/surface_study.hpp"
#include "cases/scenes/study_kind.hpp"
#include "cases/sweep/surface_sweep.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "postproc/analysis/surface_comparison.hpp"
#include "postproc/analysis/surface_results.hpp"
#include "postproc/pages/free_surface/surface_page.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class SurfaceStudy : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("cutterflow_surface_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        write_file(folder_ / name, text);
        return folder_ / name;
    }
    std::string mistakes_of(const fs::path& study) const {
        try {
            check_surface_study(study);
        } catch (const UserError& error) {
            return error.what();
        }
        return {};
    }
    static std::string replaced(std::string text, const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
        return text;
    }

    fs::path folder_;
};

TEST_F(SurfaceStudy, is_told_by_its_kind_alone) {
    EXPECT_EQ(kind_named_in(write("a.toml", "# kind = \"other\"\n\n  kind = \"free_surface\"\n[domain]\n")), "free_surface");
    EXPECT_EQ(kind_named_in(write("b.toml", "name = \"x\"\n[solid]\nkind = \"free_surface\"\n")), "");
    EXPECT_EQ(kind_named_in(write("c.toml", "[scene]\nkind = \"room\"\n")), "room");
    EXPECT_EQ(kind_named_in(write("d.toml", "[[[no TOML\n")), "");
    EXPECT_EQ(kind_named_in(folder_ / "missing.toml"), "");
}

TEST_F(SurfaceStudy, template_is_valid_and_predicts_its_cost) {
    const SurfaceCheck check = check_surface_study(write("dam.toml", surface_study_template("dam \"1\"")));
    EXPECT_EQ(check.scene.at("name"), "dam \"1\"");
    EXPECT_EQ(check.scene.at("bodies"), 33);
    EXPECT_NEAR(check.prediction.at("water_cells").get<double>(), 66.0 * 120.0, 1.0);
    EXPECT_NEAR(check.prediction.at("particles").get<double>(), 4 * 66.0 * 120.0, 4.0);
    EXPECT_NEAR(check.prediction.at("contact_step_s").get<double>(), 2.9905e-5, 1e-9);
    EXPECT_THAT(to_text(check), AllOf(HasSubstr("33 bodies"), HasSubstr("closer than two cells: ")));
}

TEST_F(SurfaceStudy, every_example_reads) {
    int studies = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples")) {
        const bool scene =
            entry.path().extension() == ".toml" && read_file(entry.path()).find("kind = \"free_surface\"") != std::string::npos;
        if (!scene) continue;
        EXPECT_TRUE(check_surface_study(entry.path()).notes.empty()) << entry.path();
        ++studies;
    }
    EXPECT_EQ(studies, 6);
}

TEST_F(SurfaceStudy, names_mistakes_of_all_sections_at_once) {
    std::string text = surface_study_template("dam");
    text = replaced(text, "gap_m = 0.001 ", "gap_m = 0.0001 ");
    text = replaced(text, "write_interval_s = 0.02", "write_interval_s = 2\nstop_when = \"pipe_empty\"");
    text += "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.0\nfrom_z_m = 0.0\nto_x_m = 0.02\nto_z_m = 0.02\n";
    const std::string mistakes = mistakes_of(write("dam.toml", text));
    EXPECT_THAT(mistakes, HasSubstr("Body 1 at"));
    EXPECT_THAT(mistakes, HasSubstr("stands in a solid"));
    EXPECT_THAT(mistakes, HasSubstr("a quarter of a cell"));
    EXPECT_THAT(mistakes, HasSubstr("pipe_empty"));
    EXPECT_THAT(mistakes, HasSubstr("run.write_interval_s"));
}

TEST_F(SurfaceStudy, bodies_of_a_file_go_into_the_run_and_into_sweeps) {
    std::string text = surface_study_template("dam");
    text =
        replaced(text, "layers = 6\nwidest = 6\ncentre_x_m = 0.0335\nlowest_m = 0.001\nclearance_m = 0.001\n", "file = \"in/list.csv\"\n");
    const fs::path study = write("studies/dam.toml", text);
    EXPECT_THAT(mistakes_of(study), HasSubstr("studies/in/list.csv"));
    const std::string list = "x_m,z_m,id\n0.02,0.02,7\n0.04,0.02,3\n";
    write("studies/in/list.csv", list);
    EXPECT_EQ(check_surface_study(study).scene.at("bodies"), 2);

    const SurfaceInputs inputs = surface_inputs(study);
    ASSERT_EQ(inputs.copies.size(), 1u);
    EXPECT_EQ(read_file(inputs.copies.at("bodies_1.csv")), list);
    write("run/bodies_1.csv", list);
    EXPECT_EQ(check_surface_study(write("run/scene.toml", inputs.study)).scene.at("bodies"), 2);

    const auto points = surface_sweep_points(study, key_axes(surface_study_table(), {"contact.friction=0.1,0.2"}, "params"), 1);
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(check_surface_study(write("elsewhere/point.toml", points[1].text)).scene.at("bodies"), 2);
}

TEST_F(SurfaceStudy, check_tells_of_water_without_a_surface) {
    EXPECT_TRUE(check_surface_study(write("dam.toml", surface_study_template("dam"))).notes.empty());
    const std::string lid =
        "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.0\nfrom_z_m = 0.12\nto_x_m = 0.08\nto_z_m = 0.13\n"
        "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.067\nfrom_z_m = 0.0\nto_x_m = 0.08\nto_z_m = 0.12\n";
    const SurfaceCheck check =
        check_surface_study(write("lid.toml", replaced(surface_study_template("lid"), "to_x_m = 0.066", "to_x_m = 0.067") + lid));
    ASSERT_EQ(check.notes.size(), 1u);
    EXPECT_THAT(to_text(check), HasSubstr("closed waters without a surface from 0 s on: 1"));
}

TEST_F(SurfaceStudy, refuses_what_no_memory_holds) {
    const std::string text = replaced(surface_study_template("dam"), "cell_m = 0.001 ", "cell_m = 0.0000001 ");
    EXPECT_THAT(mistakes_of(write("dam.toml", text)), HasSubstr("at most 5e+06"));
}

TEST_F(SurfaceStudy, sweep_sets_the_tables_that_give_a_key_and_pairs_the_seeds) {
    const fs::path example = fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/fall_pipe/perforated.toml";
    const auto points =
        surface_sweep_points(example, key_axes(surface_study_table(), {"solid.hole_m=0,0.002", "contact.friction=0.1"}, "params"), 2);
    ASSERT_EQ(points.size(), 4u);
    EXPECT_EQ(points[1].name, "perforated_hole_m_0_friction_0.1_repeat2");
    const auto values = [&](std::size_t n) { return parse_parameters(surface_study_table(), points[n].text, "point"); };
    EXPECT_EQ(values(2).tables("solid")[0].number("solid.hole_m"), 0.002);
    EXPECT_EQ(values(2).tables("solid")[1].number("solid.hole_m"), 0.0);  // the funnel does not give it
    EXPECT_EQ(values(0).tables("bodies")[0].integer("bodies.seed"), 1);
    EXPECT_EQ(values(1).tables("bodies")[0].integer("bodies.seed"), 2);
    EXPECT_EQ(values(3).tables("bodies")[0].integer("bodies.seed"), 2);
    EXPECT_EQ(values(3).number("contact.friction"), 0.1);
}

// Their scatter would be 0, and a difference certain.
TEST_F(SurfaceStudy, sweep_repeats_nothing_that_has_no_jitter) {
    const auto refusal_of = [&](const std::string& text, const std::vector<std::string>& set, int repeats) -> std::string {
        try {
            surface_sweep_points(write("dam.toml", text), key_axes(surface_study_table(), set, "params"), repeats);
        } catch (const UserError& error) {
            return error.what();
        }
        return "";
    };
    const std::string jitter = surface_study_template("dam"), none = replaced(jitter, "jitter_m = 1e-5", "jitter_m = 0.0");
    EXPECT_EQ(refusal_of(jitter, {}, 3), "");
    EXPECT_EQ(refusal_of(none, {}, 1), "");
    EXPECT_THAT(refusal_of(none, {}, 3), AllOf(HasSubstr("dam: 3 repeats"), HasSubstr("jitter of the bodies' places"),
                                               HasSubstr("jitter_m above 0, or run it once")));
    EXPECT_THAT(refusal_of(jitter, {"bodies.jitter_m=0,1e-5"}, 3), AllOf(HasSubstr("dam_jitter_m_0: "), Not(HasSubstr("1e-5: "))));
}

TEST_F(SurfaceStudy, sweep_names_wrong_keys_and_values) {
    const auto text_of = [](const std::function<void()>& act) {
        try {
            act();
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string axes = text_of([] { key_axes(surface_study_table(), {"solid.hole_mm=1", "contact.friction"}, "params"); });
    EXPECT_THAT(axes, HasSubstr("Did you mean solid.hole_m"));
    EXPECT_THAT(axes, HasSubstr("KEY=a,b"));
    const fs::path study = write("dam.toml", surface_study_template("dam"));
    EXPECT_THAT(text_of([&] { surface_sweep_points(study, key_axes(surface_study_table(), {"solid.hole_m=0"}, "params"), 1); }),
                HasSubstr("no table"));
    EXPECT_THAT(text_of([&] { surface_sweep_points(study, key_axes(surface_study_table(), {"contact.friction=much"}, "params"), 1); }),
                HasSubstr("--set contact.friction=much. The value is a number"));
    EXPECT_THAT(text_of([&] { surface_sweep_points(study, key_axes(surface_study_table(), {"contact.gap_m=0.00001"}, "params"), 1); }),
                HasSubstr("quarter of a cell"));
}

/// So that a run goes on after a comment was written, and a message names the key that was changed.
TEST_F(SurfaceStudy, inputs_of_its_case_are_the_values) {
    const RunDirectory directory(folder_ / "run");
    const auto inputs = [&](const std::string& text) {
        const fs::path study = write("dam.toml", text);
        return surface_stages(directory, study, check_surface_study(study), "solver").front().inputs;
    };
    const std::string text = surface_study_template("dam");
    const auto before = inputs(text);
    EXPECT_EQ(inputs("# a comment\n" + text), before);
    EXPECT_EQ(before.at("name"), "\"dam\"");
    EXPECT_EQ(before.count("bodies.1.diameter_m"), 1u);
    auto after = inputs(std::string(text).replace(text.find("\"dam\""), 5, "\"lake\""));
    EXPECT_NE(after.at("name"), before.at("name"));
    after["name"] = before.at("name");
    EXPECT_EQ(after, before);
}

TEST_F(SurfaceStudy, comparison_takes_no_run_twice_and_no_copy) {
    const auto run = [&](const std::string& name, const std::string& manifest) {
        fs::create_directories(folder_ / name);
        write_file(folder_ / name / "manifest.json", manifest);
        return folder_ / name;
    };
    const fs::path first = run("a_repeat1", "{\"finished\": \"12:00\"}"), second = run("a_repeat2", "{\"finished\": \"12:05\"}");
    const fs::path copy = run("b", "{\"finished\": \"12:00\"}");
    const auto compared = [](const std::vector<fs::path>& runs) {
        return postproc::compare_settings(runs, "study.toml", [](const fs::path&) {
            return std::vector<postproc::RunQuantity>{{"q", "q", "-", 1.0}};
        });
    };
    EXPECT_EQ(compared({first, second}).size(), 1u);
    EXPECT_THROW(compared({first, second, first}), UserError);
    EXPECT_THROW(compared({first, folder_ / "a_repeat2/../a_repeat1"}), UserError);
    EXPECT_THROW(compared({first, copy}), UserError);
}

TEST_F(SurfaceStudy, runs_of_one_study_are_repeats_whatever_their_folders_are_called) {
    const auto run = [&](const std::string& folder, const std::string& friction, int seed, const char* name = "x") {
        fs::create_directories(folder_ / folder);
        write_file(folder_ / folder / "study.toml", fmt::format("# made by a sweep\nname = \"{}\"\n\n[contact]\nfriction = {}\n\n[run]\n"
                                                                "seed = {}\nend_s = 1\n",
                                                                name, friction, seed));
        return folder_ / folder;
    };
    const auto compared = [](const std::vector<fs::path>& runs) {
        return postproc::compare_settings(runs, "study.toml", [](const fs::path& of) {
            return std::vector<postproc::RunQuantity>{{"q", "q", "-", of.string().find("/b/") == std::string::npos ? 1.0 : 3.0}};
        });
    };
    const auto a1 = run("a/x_repeat1", "0.4", 1), a2 = run("a/x_repeat2", "0.4", 2), b1 = run("b/x_repeat1", "0.1", 1),
               b2 = run("b/x_repeat2", "0.1", 2);
    const auto two = compared({a1, a2, b1, b2});
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].name, "a/x");
    EXPECT_EQ(two[1].name, "b/x");
    EXPECT_EQ(two[1].repeats, (std::vector<std::string>{"1", "2"}));
    EXPECT_NEAR(two[1].quantities[0].difference.mean, 2.0, 1e-12);
    const auto one = compared({a1, run("c/seed2", "0.4", 2), run("c/other_name", "0.4", 3, "y")});
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0].repeats.size(), 3u);
    EXPECT_THROW(compared({a1, run("c/again", "0.4", 1, "z")}), UserError);
}

/// Values of a quantity by the runs' folders.
class SettingsOfRuns : public SurfaceStudy {
protected:
    fs::path run(const std::string& folder, double value, const std::string& study) {
        fs::create_directories(folder_ / folder);
        write_file(folder_ / folder / "study.toml", study);
        values_[folder_ / folder] = value;
        return folder_ / folder;
    }
    std::vector<postproc::SettingResults> compared(const std::vector<fs::path>& runs) {
        return postproc::compare_settings(runs, "study.toml", [&](const fs::path& of) {
            const double value = values_.at(of);
            return std::vector<postproc::RunQuantity>{{"q", "quantity", "s", value, false, std::isfinite(value) ? "" : "no crossing"}};
        });
    }
    std::map<fs::path, double> values_;
};

TEST_F(SettingsOfRuns, take_a_time_in_the_name_for_no_number_of_a_repeat) {
    const auto found = compared({run("dam_repeat20261124153000", 1.0, "friction = 0.1\n"), run("dam_repeat2", 1.0, "friction = 0.2\n")});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].name, "dam_repeat20261124153000");
    EXPECT_EQ(found[1].name, "dam");
}

TEST_F(SettingsOfRuns, are_those_of_their_studies_however_seeds_and_numbers_are_written) {
    const auto study = [](const char* seeds) { return std::string("name = 'x'\n[contact]\nfriction = 0.10\n") + seeds; };
    const auto found = compared({run("a", 1.0, study("[[bodies]]\nseed=1\n[[bodies]]\n  seed = 1\n")),
                                 run("b", 2.0, study("[[bodies]]\n\tseed = 2 # the second\n[[bodies]]\nseed = 1\n")),
                                 run("c", 4.0, "name=\"y\"\ncontact.friction = 0.1\n[[bodies]]\nseed = 1\n[[bodies]]\nseed = 2\n")});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].repeats, (std::vector<std::string>{"1, 1", "2, 1", "1, 2"}));
    EXPECT_THROW(compared({folder_ / "a", run("d", 1.0, study("[[bodies]]\nseed = 1\n[[bodies]]\nseed = 1\n"))}), UserError);
    try {
        compared({folder_ / "a", run("e", 1.0, "friction = = 1\n")});
        FAIL() << "no TOML";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr((folder_ / "e" / "study.toml").string() + ": a study cannot be read as TOML"));
    }
}

TEST_F(SettingsOfRuns, tell_how_many_repeats_have_a_value) {
    std::vector<fs::path> runs;
    for (int n = 1; n <= 4; ++n)
        runs.push_back(run(fmt::format("a{}", n), n == 2 ? std::nan("") : n, fmt::format("friction = 0.1\nseed = {}\n", n)));
    const auto found = compared(runs);
    EXPECT_THAT(postproc::setting_comparison_text(found), HasSubstr("3 of 4 repeats have a value (no crossing)"));
    const auto json = postproc::setting_comparison_json(found, "x/1");
    EXPECT_EQ(json["settings"][0]["q"]["repeats_with_a_value"], 3);
    EXPECT_EQ(json["settings"][0]["q"]["reason"], "no crossing");
    EXPECT_TRUE(json["settings"][0]["q"]["value"]["mean"].is_null()) << "a mean of those that have one would be another quantity";
    EXPECT_THAT(read_file(postproc::write_setting_comparison(found, "x/1", folder_ / "page")), HasSubstr("3 of 4 repeats have a value"));
}

/// Means 2 and 12, variance 1 of three values each: Welch's half interval is t(0.975, 4) sqrt(2/3).
TEST_F(SettingsOfRuns, with_other_seeds_differ_as_independent_samples) {
    std::vector<fs::path> runs;
    for (int n = 1; n <= 3; ++n) runs.push_back(run(fmt::format("a{}", n), n, fmt::format("friction = 0.1\nseed = {}\n", n)));
    for (int n = 1; n <= 3; ++n) runs.push_back(run(fmt::format("b{}", n), 10 + n, fmt::format("friction = 0.2\nseed = {}\n", n + 1)));
    const auto welch = compared(runs)[1].quantities[0].difference;
    EXPECT_DOUBLE_EQ(welch.mean, 10.0);
    EXPECT_NEAR(welch.half, 2.776445 * std::sqrt(2.0 / 3.0), 1e-5);
    runs[3] = run("b1", 13.0, "friction = 0.2\nseed = 3\n");
    runs[5] = run("b3", 11.0, "friction = 0.2\nseed = 1\n");
    runs[4] = run("b2", 12.0, "friction = 0.2\nseed = 2\n");
    const auto pairs = compared(runs)[1].quantities[0].difference;
    EXPECT_DOUBLE_EQ(pairs.mean, 10.0);
    EXPECT_NEAR(pairs.half, 0.0, 1e-12) << "the same seeds, in another order";
    runs.pop_back();
    EXPECT_TRUE(std::isnan(compared(runs)[1].quantities[0].difference.half)) << "two do not determine the scatter";
    EXPECT_DOUBLE_EQ(compared(runs)[1].quantities[0].difference.mean, 10.5);
}

// A run keeps its own copy of a file under a name of the program's, and a file may be edited where it is.
TEST_F(SurfaceStudy, runs_with_other_content_of_a_file_are_other_settings) {
    const auto run = [&](const std::string& folder, const std::string& content, int seed) {
        write(folder + "/study.toml", fmt::format("[[solid]]\nfile = \"surface_1.stl\"\n[run]\nseed = {}\n", seed));
        write(folder + "/manifest.json",
              fmt::format(R"({{"stages": {{"case": {{"inputs": {{"solid.1.file": "{}"}}, "at": "{}"}}}}}})", sha256(content), folder));
        return folder_ / folder;
    };
    const auto names_of = [](const std::vector<fs::path>& runs) {
        std::vector<std::string> names;
        for (const auto& setting : postproc::compare_settings(runs, "study.toml", [](const fs::path&) {
                 return std::vector<postproc::RunQuantity>{{"q", "q", "-", 1.0}};
             }))
            names.push_back(setting.name);
        return names;
    };
    EXPECT_THAT(names_of({run("of/ramp", "a", 1), run("of/ramp2", "b", 1), run("of/ramp2_repeat2", "b", 2)}), ElementsAre("ramp", "ramp2"));
    EXPECT_THAT(names_of({run("of/x_repeat1", "a", 1), run("of/x_repeat2", "b", 2)}),
                ElementsAre("of/x, solid.1.file " + sha256("a").substr(0, 8), "of/x, solid.1.file " + sha256("b").substr(0, 8)));
    EXPECT_THROW(names_of({run("of/ramp", "a", 1), run("of/again", "a", 1)}), UserError);
}

TEST_F(SurfaceStudy, comparison_names_every_run_that_is_not_there_and_every_one_that_measures_something_else) {
    const auto told = [](const std::vector<fs::path>& runs, const std::function<std::string(const fs::path&)>& key) {
        std::vector<std::string> whats;
        try {
            postproc::compare_settings(runs, "study.toml", [&](const fs::path& run) {
                return std::vector<postproc::RunQuantity>{{key(run), "q", "-", 1.0}};
            });
        } catch (const UserError& error) {
            for (const Mistake& mistake : error.mistakes()) whats.push_back(mistake.what);
        }
        return whats;
    };
    const auto missing = [](const fs::path& run) -> std::string { throw UserError(run.string() + " is no run", "", ""); };
    EXPECT_THAT(told({"a", "b"}, missing), ElementsAre("a is no run", "b is no run"));
    EXPECT_THAT(told({"a", "b", "c"}, [](const fs::path& run) { return run == "a" ? "force" : "mass"; }),
                ElementsAre("b measures something else than a", "c measures something else than a"));
}

TEST(RepeatMean, has_students_interval_and_none_for_what_never_came) {
    const postproc::RepeatMean mean = postproc::repeat_mean({1.0, 2.0, 3.0, 4.0, 5.0});
    EXPECT_DOUBLE_EQ(mean.mean, 3.0);
    EXPECT_NEAR(mean.half, 2.776445 * std::sqrt(2.5 / 5.0), 1e-5);
    EXPECT_TRUE(std::isnan(postproc::repeat_mean({1.0, 2.0}).half)) << "two do not determine the scatter";
    EXPECT_DOUBLE_EQ(postproc::repeat_mean({1.0, 2.0}).mean, 1.5);
    EXPECT_NEAR(postproc::repeat_mean({1.0, 2.0, 3.0}).half, 4.302653 / std::sqrt(3.0), 1e-5);
    EXPECT_TRUE(std::isnan(postproc::repeat_mean({1.0, postproc::k_never}).mean));
}

TEST(RepeatMean, tells_settings_apart_where_the_interval_leaves_0_out) {
    EXPECT_EQ(postproc::verdict_of({0.3, 0.2}), "higher");
    EXPECT_EQ(postproc::verdict_of({-0.3, 0.2}), "lower");
    EXPECT_EQ(postproc::verdict_of({-0.3, 0.3}), "not told apart");
    EXPECT_EQ(postproc::verdict_of({0.3, std::nan("")}), "no interval");
}

/// A pipe with four bodies: rows of two processes, the later from 0.2 s on.
void write_rows(const fs::path& run) {
    const auto put = [&](const std::string& name, const std::string& text) {
        fs::create_directories((run / name).parent_path());
        write_file(run / name, text);
    };
    put("scene.json", R"({"name": "pipe", "width_m": 0.3, "height_m": 0.2, "cell_m": 0.1, "columns": 3, "rows": 2, "end_s": 0.4,
        "bodies": 4, "diameter_m": 0.01, "contact_gap_m": 0.001, "pipe": {"bottom_m": 0.04}})");
    const std::string levels =
        "time_s,level_m,level_in_pipe_m,mouth_flow_m3_s,hole_flow_m3_s,volume_in_pipe_m3,bodies_in_pipe,rise_in_pipe_m_s,mean_x_m,"
        "mean_z_m,farthest_x_m\n";
    put("postProcessing/levels/0/levels.csv",
        levels +
            "0.1,0.12,0.12,-1e-4,0,1e-4,4,-0.1,0.1,0.1,0.15\n0.2,0.14,0.08,-1e-4,0,1e-4,2,-0.2,0.1,0.1,0.15\n0.3,9,0,0,0,0,0,0,0,0,0\n");
    put("postProcessing/levels/0.2/levels.csv",
        levels + "0.3,0.15,0.05,1e-4,0,1e-4,1,0.05,0.1,0.1,0.299\n0.4,0.14,0.1,1e-4,0,1e-4,0,0,0.1,0.1,0.28\n");
    const std::string balance =
        "time_s,volume_error,energy_j,pushed_out,pressure_iterations,enclosed_waters,through_walls,core_s,pressure_impulse_error_n_s,"
        "body_impulse_error,gap_impulse_n_s,deepest_m\n";
    put("postProcessing/balance/0/balance.csv",
        balance +
            "0.1,0.001,5,1,20,0,1,1,1e-12,2e-11,0.25,1e-4\n0.2,-0.004,4,2,22,0,2,3,3e-12,1e-11,0.5,7e-4\n"
            "0.3,0,4,2,22,0,9,4.5,0,0,0,0\n");
    put("postProcessing/balance/0.2/balance.csv",
        balance + "0.3,0.002,3,1,20,1,0,1.5,1e-12,1e-11,0,0\n0.4,0,3,1,20,0,4,2.5,1e-12,1e-11,0.25,0\n");
    put("postProcessing/bodies/0/bodies.csv",
        "time_s,id,x_m,z_m,spin_y_rad_s\n0,1,0.1,0.1,0\n0,2,0.2,0.1,0\n0.1,1,0.1,0.1,0\n0.1,2,0.2,0.1,31.415927\n");
    put("postProcessing/gauges/0/gauges.csv", "time_s,gauge,level_m,pressure_pa\n0.1,far wall,0.1,\n0.1,foot,0.1,900\n0.3,foot,0,0\n");
    put("postProcessing/gauges/0.2/gauges.csv", "time_s,gauge,level_m,pressure_pa\n0.3,far wall,0.12,\n0.3,foot,0.12,1100\n");
}

TEST_F(SurfaceStudy, results_join_restarts_and_find_the_events_of_a_pipe) {
    write_rows(folder_);
    const postproc::SurfaceResults results = postproc::surface_results(postproc::read_surface_rows(folder_));
    EXPECT_DOUBLE_EQ(results.half_out_s, 0.2);
    EXPECT_DOUBLE_EQ(results.all_out_s, 0.4);
    EXPECT_DOUBLE_EQ(results.arrival_s, 0.3);
    EXPECT_DOUBLE_EQ(results.volume_error, -0.004);
    EXPECT_NEAR(results.greatest_drop_m, 0.1, 1e-12);
    EXPECT_DOUBLE_EQ(results.drop_at_s, 0.3);
    EXPECT_DOUBLE_EQ(results.reversal_s, 0.3);
    EXPECT_TRUE(results.rises_with_bodies);
    EXPECT_DOUBLE_EQ(results.core_s, 7.0) << "4.5 s of the first process, which came to 0.3 s, and 2.5 s of the second";
    EXPECT_DOUBLE_EQ(results.through_walls, 7.0);
    const postproc::Table gauges = postproc::read_surface_rows(folder_).gauges;
    ASSERT_EQ(gauges.rows(), 4u);
    EXPECT_EQ(gauges.text("gauge")[3], "foot");
    EXPECT_DOUBLE_EQ(gauges.number("pressure_pa")[3], 1100.0);
    EXPECT_TRUE(std::isnan(gauges.number("pressure_pa")[2]));
}

TEST_F(SurfaceStudy, comparison_names_a_run_that_has_not_come_to_its_end) {
    const auto text = [&](const std::string& state) {
        write_file(folder_ / "a/manifest.json", fmt::format(R"({{"stages": {{"run": {{"state": "{}"}}}}}})", state));
        return postproc::setting_comparison_text(postproc::compare_surface_runs({folder_ / "a"}));
    };
    write_rows(folder_ / "a");
    std::string scene = read_file(folder_ / "a/scene.json");
    write_file(folder_ / "a/scene.json", scene.replace(scene.find("\"end_s\": 0.4"), 12, "\"end_s\": 0.9"));
    EXPECT_THAT(text("started"), HasSubstr("/a is not finished: it has come to 0.4 of 0.9 s"));
    EXPECT_THAT(text("done"), Not(HasSubstr("not finished"))) << "a stop rule has ended it";
}

TEST_F(SurfaceStudy, pictures_of_the_page_have_a_bar_of_length_and_a_scale_of_speeds) {
    write_rows(folder_);
    const auto array = [](const std::string& name, const std::string& values) {
        return "<DataArray type=\"Float64\" Name=\"" + name + "\" format=\"ascii\">\n" + values + "\n</DataArray>\n";
    };
    write("postProcessing/water/vtk/water_0.100000.vti", array("water_fraction", "1 1 0 0 0 0") + array("open_volume", "1 1 1 1 1 1") +
                                                             array("velocity_m_s", "0 0 0 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0"));
    const std::string without = read_file(postproc::write_surface_report(folder_));
    EXPECT_THAT(without, HasSubstr(">50 mm</text>"));
    EXPECT_THAT(without, HasSubstr(">1</text>"));
    EXPECT_THAT(without, HasSubstr(">2 m/s and more</text>"));
    write("postProcessing/bodies/vtk/bodies_0.100000.vtp", array("radius_m", "0.02 0.04") + array("Points", "0.1 0 0.1 0.2 0 0.1"));
    const std::string with = read_file(postproc::write_surface_report(folder_));
    EXPECT_NE(with, without);
    EXPECT_THAT(without, Not(HasSubstr("class=\"spin\"")));
    // A spin that grows from 0 to 10 pi within 0.1 s turns the second body by a quarter, clockwise.
    EXPECT_THAT(with, HasSubstr("d=\"M186.7,186.3 l0.0,-37.3M373.3,186.3 l74.7,0.0\""));
}

TEST_F(SurfaceStudy, page_shows_the_answers_without_any_picture_written) {
    write_rows(folder_);
    const std::string page = read_file(postproc::write_surface_report(folder_));
    EXPECT_THAT(page, HasSubstr("all bodies out of the pipe"));
    EXPECT_THAT(page, HasSubstr("0.400 s"));
    EXPECT_THAT(page, HasSubstr("-0.40 %"));
    EXPECT_THAT(page, HasSubstr("Level at the gauges"));
    EXPECT_THAT(page, HasSubstr("through the pipe's wall"));
    EXPECT_THAT(page, HasSubstr("steps with closed water"));
    EXPECT_THAT(page, HasSubstr("Pressure at the gauges"));
    EXPECT_THAT(page, AllOf(HasSubstr("0.7 mm"), HasSubstr("3e-12 N s"), HasSubstr("2e-11"), HasSubstr("1 N s")));
    EXPECT_THAT(page, AllOf(HasSubstr("not available here"), HasSubstr("lower end at 40 mm"), HasSubstr("it slips")));
    EXPECT_THAT(read_file(folder_ / "report/results.json"), HasSubstr("\"half_out_s\": 0.2"));
}

}  // namespace
}  // namespace cutterflow::cases
