/// \file cutterflow as its users meet it: commands in, messages, exit codes and files out.
#include <unistd.h>

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cases/runner/machine.hpp"
#include "cases/scenes/cutter/case_inputs.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/io/write_stl.hpp"

using namespace cutterflow;
namespace fs = std::filesystem;

namespace {

const fs::path k_cutterflow = fs::path(CUTTERFLOW_BUILD_DIR) / "bin/cutterflow";
const fs::path k_crown = fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/model_cutter/crown.toml";

struct Outcome {
    int code = 0;
    std::string text;
};

void expect_contains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\n lacks: " << part;
}

/// The crown cutter of the example, made once for all tests by the program itself.
const geometry::TriangleSurface& crown() {
    static const geometry::TriangleSurface surface = [] {
        const fs::path file = fs::temp_directory_path() / ("cutterflow_crown_" + std::to_string(::getpid()) + ".stl");
        require_child({{k_cutterflow.string(), "generate-cutter", k_crown.string(), "-o", file.string()}, {}, {}, {}});
        geometry::TriangleSurface read = geometry::welded(geometry::read_surface(file));
        fs::remove(file);
        return read;
    }();
    return surface;
}

geometry::TriangleSurface scaled(const geometry::TriangleSurface& surface, double factor) {
    return geometry::transformed(surface, Eigen::Affine3d(Eigen::Scaling(factor)));
}

geometry::TriangleSurface mirrored(const geometry::TriangleSurface& surface) {
    return geometry::transformed(surface, Eigen::Affine3d(Eigen::Scaling(-1.0, 1.0, 1.0)));
}

geometry::TriangleSurface inside_out(geometry::TriangleSurface surface) {
    for (geometry::Triangle& triangle : surface.triangles) std::swap(triangle[0], triangle[1]);
    return surface;
}

class Cli : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_cli_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    Outcome call(std::vector<std::string> arguments, std::map<std::string, std::string> environment = {}) {
        arguments.insert(arguments.begin(), k_cutterflow.string());
        const fs::path log = folder_ / "output";
        const ChildResult result = run_child({arguments, folder_, log, std::move(environment)});
        Outcome outcome{result.exit_code, read_file(log)};
        fs::remove(log);
        return outcome;
    }

    /// A study of the crown with more lines; `cutter` is written unless it is there.
    std::string study(const std::string& more = {}, const std::string& cutter = "cutter.stl") {
        if (!fs::exists(folder_ / cutter)) geometry::write_stl(crown(), folder_ / cutter);
        write_file(folder_ / "study.toml",
                   "[cutter]\nfile = \"" + cutter + "\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n" + more);
        return "study.toml";
    }

    void stand_in(const std::string& name, const std::string& script) {
        write_file(folder_ / "bin" / name, "#!/bin/sh\n" + script + "\n");
        fs::permissions(folder_ / "bin" / name, fs::perms::owner_all);
    }

    /// `cutterflow mesh` of a cutterflow in a folder of its own, where everything it starts is a stand-in.
    ChildCommand mesh_with_stand_ins() {
        fs::create_directories(folder_ / "bin");
        fs::copy_file(k_cutterflow, folder_ / "bin/cutterflow");
        write_file(folder_ / "share/cutterflow/docs/references.bib", "");  // marks an installation
        for (const char* name : {"blockMesh", "surfaceFeatureExtract", "snappyHexMesh", "topoSet", "createPatch", "checkMesh",
                                 "cutterInterfaceRestore", "cutterMeshProbe"})
            stand_in(name, "exit 0");
        return {{(folder_ / "bin/cutterflow").string(), "mesh", "study.toml", "-o", "runs/a"},
                folder_,
                folder_ / "output",
                {{"PATH", (folder_ / "bin").string() + ":" + std::getenv("PATH")}}};
    }

    void expect_refused(const Outcome& outcome, int code, const std::string& part) {
        EXPECT_EQ(outcome.code, code) << outcome.text;
        expect_contains(outcome.text, part);
        EXPECT_EQ(outcome.text.find("defect"), std::string::npos) << outcome.text;
    }

    fs::path folder_;
};

const char* const k_feed = "[[feed]]\ncount = 20\n[[feed.class]]\ndiameter_m = 0.02\n";

}  // namespace

TEST_F(Cli, explains_itself) {
    const Outcome help = call({"--help"});
    EXPECT_EQ(help.code, 0);
    for (const char* command :
         {"new", "check", "verify", "inspect", "repair", "generate-cutter", "generate-solid", "mesh", "run", "report", "params"}) {
        expect_contains(help.text, command);
        const Outcome of_command = call({command, "--help"});
        EXPECT_EQ(of_command.code, 0) << command;
        expect_contains(of_command.text, "Usage: cutterflow " + std::string(command));
    }
    EXPECT_EQ(call({}).code, 2);
    expect_refused(call({"runn"}), 2, "there is no command runn");
}

TEST_F(Cli, names_the_versions_of_what_it_was_built_with) {
    const Outcome versions = call({"--version"});
    EXPECT_EQ(versions.code, 0);
    EXPECT_EQ(versions.text.rfind("cutterflow  0.2.0\n", 0), 0u) << versions.text;
    for (const char* name : {"OpenFOAM", "LIGGGHTS", "CGAL", "assimp", "Open MPI", "compiler"}) expect_contains(versions.text, name);
}

TEST_F(Cli, says_rule_and_remedy_of_words_it_does_not_understand) {
    study();
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
        {{}, "A subcommand is required"},
        {{"check"}, "study is required"},
        {{"check", "study.toml", "--ranks", "two"}, "two"},
        {{"check", "study.toml", "--ranks"}, "--ranks"},
        {{"check", "study.toml", "second.toml"}, "\"second.toml\" is one word too many"},
        {{"check", "study.toml", "--jsn"}, "cutterflow check has no option --jsn. Its options are --help, --ranks, --json"},
        {{"sweep", "study.toml", "--repeats", "0"}, "--repeats"},
        {{"sweep", "study.toml", "--launcher", "pbs"}, "pbs"},
    };
    for (const auto& [words, part] : wrong) {
        const Outcome outcome = call(words);
        expect_refused(outcome, 2, part);
        expect_contains(outcome.text, " --");
        EXPECT_TRUE(outcome.text.find("The command is written as: cutterflow") != std::string::npos ||
                    outcome.text.find("Its options are") != std::string::npos || outcome.text.find("takes no more") != std::string::npos)
            << outcome.text;
    }
    expect_contains(call({"check", "study.toml", "--jsn"}).text, "Did you mean --json?");
}

TEST_F(Cli, verify_lists_its_cases_and_refuses_others) {
    const Outcome listed = call({"verify", "--list"});
    EXPECT_EQ(listed.code, 0);
    expect_contains(listed.text, "suspension");
    expect_refused(call({"verify", "suspensoin", "-o", "out"}), 2, "there is no verification case suspensoin");
    expect_contains(call({"verify", "suspensoin", "-o", "out"}).text, "Did you mean suspension?");
    expect_refused(call({"verify"}), 2, "verify takes names, --fast or --all");
    write_file(folder_ / "thesis/chapter.tex", "mine");
    expect_refused(call({"verify", "suspension", "-o", "thesis"}), 2, "Nothing is overwritten");
    expect_refused(call({"verify", "suspension", "-o", "my results"}), 2, "OpenFOAM");
}

TEST_F(Cli, verify_refuses_options_that_contradict_each_other) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
        {{"closures", "--all"}, "--all with cases by name"},
        {{"--all", "--pareto", "terminal_speed"}, "--all with --pareto"},
        {{"--fast", "--all"}, "--fast with --all"},
        {{"closures", "--fast", "--long"}, "--fast with --long"},
        {{"--fast", "--pareto", "terminal_speed"}, "--fast with --pareto"},
        {{"--list", "closures"}, "--list with cases by name"},
        {{"--list", "--publish"}, "--list with --publish"},
        {{"--list", "--resume"}, "--list with --resume"},
    };
    for (auto [words, part] : wrong) {
        words.insert(words.begin(), "verify");
        expect_refused(call(words), 2, part);
    }
    EXPECT_FALSE(fs::exists(folder_ / "runs"));
}

TEST_F(Cli, check_refuses_rock_too_fine_or_too_many_and_discharges_that_boil) {
    const auto feed = [](const std::string& amount, const std::string& diameter) {
        return "[[feed]]\n" + amount + "\n[[feed.class]]\ndiameter_m = " + diameter + "\n";
    };
    // 1 kg of 2650 kg/m3 in spheres of 1e-5 m: 6 / (pi 1e-15 2650) = 7.21e11.
    expect_refused(call({"check", study(feed("mass_kg = 1", "1e-5"))}), 2, "feed.mass_kg = 1. It makes 7.21e+11 rocks");
    expect_refused(call({"check", study(feed("count = 20", "1e-5"))}), 2, "places 1.5e-05 m apart");
    expect_refused(call({"check", study(feed("count = 2000000", "0.02"))}), 2, "feed.count = 2e+06. It makes 2e+06 rocks");
    // A mouth of 0.1 m radius: 30 m/s are 0.942 m3/s.
    const auto with_discharge = [&](const std::string& value) {
        study(k_feed);
        std::string text = read_file(folder_ / "study.toml");
        text.replace(text.find("0.12"), 4, value);
        write_file(folder_ / "study.toml", text);
        return call({"check", "study.toml"});
    };
    expect_refused(with_discharge("1.0"), 2, "suction.discharge_m3_s = 1. Through a mouth of radius 0.1 m it flows at 31.83 m/s");
    const Outcome slow = with_discharge("1e-6");
    EXPECT_EQ(slow.code, 0);
    expect_contains(slow.text, "warning: suction.discharge_m3_s = 1e-06 passes the mouth at 3.18e-05 m/s");
}

TEST_F(Cli, new_study_is_commented_complete_and_never_overwrites) {
    geometry::write_stl(crown(), folder_ / "head.stl");
    EXPECT_EQ(call({"new", "--cutter", "head.stl", "mine.toml"}).code, 0);
    EXPECT_EQ(call({"check", "mine.toml"}).code, 0);
    expect_refused(call({"new", "mine.toml"}), 2, "Nothing is overwritten");
    expect_refused(call({"new", "other.toml", "--unit", "parsec"}), 2, "unknown unit");
    expect_refused(call({"new", "other.toml", "--cutter", "nowhere.stl"}), 2, "nowhere.stl does not exist");
    expect_refused(call({"new", "mine.toml/other.toml"}), 2, "cannot");
}

/// To follow what a cutter's reader says would take such a study apart.
TEST_F(Cli, tells_of_which_kind_a_study_may_be_that_names_none) {
    for (const auto& [kind, line] :
         std::map<std::string, std::string>{{"room", "[scene]\nkind = \"room\"\n"}, {"free_surface", "kind = \"free_surface\"\n"}}) {
        EXPECT_EQ(call({"new", kind + ".toml", "--kind", kind}).code, 0);
        std::string text = read_file(folder_ / (kind + ".toml"));
        ASSERT_NE(text.find(line), std::string::npos);
        write_file(folder_ / "none.toml", text.replace(text.find(line), line.size(), ""));
        expect_refused(call({"check", "none.toml"}), 2, "this one reads as one of kind " + kind);
    }
    write_file(folder_ / "empty.toml", "");
    expect_refused(call({"check", "empty.toml"}), 2, "cutter.file is missing");
}

TEST_F(Cli, tells_that_a_calibration_is_no_study) {
    const std::string file = "glass.toml";
    fs::copy_file(fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/calibrate_repose" / file, folder_ / file);
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"check", file}, {"run", file}, {"mesh", file}, {"sweep", file, "--repeats", "2"}}) {
        const Outcome outcome = call(command);
        expect_refused(outcome, 2, "it is a calibration");
        expect_contains(outcome.text, "Use cutterflow calibrate glass.toml");
        EXPECT_EQ(outcome.text.find("unknown"), std::string::npos) << outcome.text;
    }
    EXPECT_FALSE(fs::exists(folder_ / "runs"));
}

TEST_F(Cli, params_lists_every_key) {
    const Outcome text = call({"params"});
    expect_contains(text.text, "speed_rpm");
    const nlohmann::json rows = nlohmann::json::parse(call({"params", "--json"}).text);
    EXPECT_GT(rows.size(), 50u);
    for (const nlohmann::json& row : rows)
        EXPECT_TRUE(row.at("required").get<bool>() || row.contains("default") || row.contains("derived_from")) << row;
}

TEST_F(Cli, check_predicts_what_a_run_costs) {
    study(k_feed);
    const Outcome outcome = call({"check", "study.toml", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const nlohmann::json prediction = nlohmann::json::parse(outcome.text).at("prediction");
    EXPECT_GE(prediction.at("cells").get<double>(), 40000.0);
    EXPECT_LE(prediction.at("cells").get<double>(), 70000.0);
    EXPECT_EQ(prediction.at("rocks"), 20);
    EXPECT_NEAR(prediction.at("tip_speed_m_s").get<double>(), 2.51, 0.03);
    // A 20 mm rock of 2650 kg/m3 in the Newton regime: w = sqrt(4 g d (s-1) / (3 Cd)), Cd about 0.45.
    EXPECT_NEAR(prediction.at("settling_velocity_m_s")[0].get<double>(), 0.99, 0.08);
    EXPECT_LT(prediction.at("time_step_with_rock_s").get<double>(), prediction.at("time_step_s").get<double>());
    // Resident set of cutterFoam on such a mesh: 446 MB.
    EXPECT_NEAR(prediction.at("run_memory_bytes").get<double>() / 446e6, 1.0, 0.15);
    const double hours = prediction.at("core_hours").get<double>();
    EXPECT_GT(hours, 0.02);
    EXPECT_LT(hours, 20.0);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2) << "check writes nothing";
    study("[[feed]]\ncount = 220\n[[feed.class]]\ndiameter_m = 0.02\n");
    const nlohmann::json more = nlohmann::json::parse(call({"check", "study.toml", "--json"}).text).at("prediction");
    // Kernels of 20 mm in cells of 0.387 x 0.075 x 0.4 m: 20 kB for 1.5 cells, by the cube.
    EXPECT_NEAR((more.at("run_memory_bytes").get<double>() - prediction.at("run_memory_bytes").get<double>()) / 200.0,
                20e3 * std::pow(20.0 / 11.61 / 1.5, 3), 1e3);
}

// Core seconds per step of docs/results/step_cost.md: the draft mesh of this cutter on the machine undisturbed.
TEST_F(Cli, check_predicts_the_core_time_of_steps_on_one_and_two_ranks) {
    study("[[feed]]\ncount = 368\n[[feed.class]]\ndiameter_m = 0.02\n");
    const std::map<int, std::pair<double, double>> measured{{1, {0.359, 0.506}}, {2, {0.516, 0.672}}};
    for (const auto& [ranks, core_s] : measured) {
        if (ranks > cases::available_cores()) continue;
        const Outcome outcome = call({"check", "study.toml", "--json", "--ranks", std::to_string(ranks)});
        ASSERT_EQ(outcome.code, 0) << outcome.text;
        const nlohmann::json p = nlohmann::json::parse(outcome.text).at("prediction");
        const double per_step = 3600.0 / p.at("machine_slowness").get<double>();  // core seconds of the reference machine; period 1 s
        EXPECT_NEAR(per_step * p.at("core_hours_per_revolution").get<double>() * p.at("time_step_s").get<double>() / core_s.first, 1.0,
                    0.15);
        EXPECT_NEAR(per_step * p.at("core_hours_per_revolution_with_rock").get<double>() * p.at("time_step_with_rock_s").get<double>() /
                        core_s.second,
                    1.0, 0.15);
        const double first = p.at("first_release_s").get<double>(), development = p.at("development_end_s").get<double>();
        EXPECT_GT(development, 0.0);
        EXPECT_NEAR(
            (first - development * (1.0 - 1.0 / cases::k_development_step_ratio)) * p.at("core_hours_per_revolution").get<double>() +
                (p.at("revolutions").get<double>() - first) * p.at("core_hours_per_revolution_with_rock").get<double>(),
            p.at("core_hours").get<double>(), 1e-9);
    }
}

TEST_F(Cli, judges_a_run_directory_where_it_is_and_says_that_there_is_nothing_to_resume) {
    study(k_feed);
    fs::create_directories(folder_ / "my runs");
    const Outcome outside = call({"run", "study.toml", "-o", "my runs/../runs/a", "--ranks", "1000", "--resume"});
    expect_refused(outside, 2, "--ranks 1000");
    EXPECT_EQ(outside.text.find("has ' ' in its path"), std::string::npos) << outside.text;
    expect_contains(outside.text, "there is no run in my runs/../runs/a to resume: it begins");
    expect_refused(call({"run", "study.toml", "-o", "my runs/a"}), 2, "has ' ' in its path");
}

/// Every rock is mapped and touched; a modulus 10,000 times as large needs 100 times as many steps of the contacts.
TEST_F(Cli, check_predicts_what_many_and_stiff_rocks_cost) {
    const auto cost = [&](const char* feed, const char* rest) {
        study(std::string("[[feed]]\n") + feed + "[[feed.class]]\ndiameter_m = 0.02\n" + rest);
        const Outcome outcome = call({"check", "study.toml", "--json"});
        EXPECT_EQ(outcome.code, 0) << outcome.text;
        return nlohmann::json::parse(outcome.text).at("prediction");
    };
    const auto seconds = [](const nlohmann::json& p) {  // of a step with rock
        return 3600.0 / p.at("machine_slowness").get<double>() * p.at("core_hours_per_revolution_with_rock").get<double>() *
               p.at("time_step_with_rock_s").get<double>();
    };
    const nlohmann::json few = cost("count = 20\n", ""), many = cost("count = 420\n", "");
    const auto steps_of = [](const nlohmann::json& p) {
        return p.at("time_step_with_rock_s").get<double>() / p.at("contact_step_s").get<double>();
    };
    const double added = 400.0 * (0.12e-3 + 0.65e-6 * steps_of(many));
    EXPECT_NEAR(seconds(many) - seconds(few), added, 0.05 * added);
    const nlohmann::json stiff = cost("count = 420\n", "[rock]\nyoungs_modulus_pa = 1e11\n");
    const double steps = steps_of(stiff) - steps_of(many);
    EXPECT_GT(steps, 1000.0);
    EXPECT_NEAR(seconds(stiff) - seconds(many), 420.0 * 0.65e-6 * steps, 0.1 * 420.0 * 0.65e-6 * steps);
    EXPECT_GT(stiff.at("mesh_core_s").get<double>(), 5.0);
    EXPECT_GT(stiff.at("start_core_s").get<double>(), 15.0);
}

TEST_F(Cli, a_name_with_spaces_and_brackets_is_a_name_like_any_other) {
    study("", "Cutter Head (rev B).STL");
    EXPECT_EQ(call({"check", "study.toml"}).code, 0);
    const Outcome outcome = call({"inspect", "Cutter Head (rev B).STL", "--contour", "my contour.csv"});
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(read_file(folder_ / "my contour.csv").substr(0, 8), "z_m,r_m\n");
    expect_refused(call({"inspect", "Cutter Head (rev B).STL", "--contour", "Cutter Head (rev B).STL"}), 2, "Nothing is overwritten");
}

TEST_F(Cli, refuses_surfaces_that_bound_no_solid) {
    geometry::TriangleSurface open = crown();
    open.triangles.erase(open.triangles.begin() + 100);
    geometry::write_stl(open, folder_ / "open.stl");
    geometry::write_stl(inside_out(crown()), folder_ / "inside_out.stl");
    // The same head a second time, shifted: its surface cuts itself.
    const geometry::TriangleSurface twice =
        geometry::joined({crown(), geometry::transformed(crown(), Eigen::Affine3d(Eigen::Translation3d(0.03, 0.01, 0.02)))});
    geometry::write_stl(twice, folder_ / "twice.stl");
    write_file(folder_ / "text.stl", "no surface at all");
    for (const auto& [file, part] : std::map<std::string, std::string>{{"open.stl", "open"},
                                                                       {"inside_out.stl", "inside"},
                                                                       {"twice.stl", "intersect"},
                                                                       {"text.stl", "text.stl"},
                                                                       {"missing.stl", "missing.stl"}}) {
        expect_refused(call({"inspect", file}), 2, part);
        write_file(folder_ / "bad.toml", "[cutter]\nfile = \"" + file + "\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n");
        expect_refused(call({"check", "bad.toml"}), 2, part);
    }
}

TEST_F(Cli, repairs_a_cutter_that_a_study_has_refused) {
    geometry::TriangleSurface open = crown();
    open.triangles.erase(open.triangles.begin() + 100);
    std::swap(open.triangles[7][0], open.triangles[7][1]);
    study();
    geometry::write_stl(scaled(open, 1000.0), folder_ / "cutter.stl");
    const std::string before = read_file(folder_ / "cutter.stl");
    expect_refused(call({"check", "study.toml"}), 2, "cutterflow repair");
    const Outcome repaired = call({"repair", "cutter.stl", "-o", "sound.stl", "--report", "repair.json"});
    ASSERT_EQ(repaired.code, 0) << repaired.text;
    expect_contains(repaired.text, "unit mm told from the size");
    EXPECT_EQ(read_file(folder_ / "cutter.stl"), before);
    const nlohmann::json report = nlohmann::json::parse(read_file(folder_ / "repair.json"));
    std::map<std::string, int> counts;
    for (const nlohmann::json& step : report.at("steps")) counts[step.at("name")] = step.at("count");
    EXPECT_EQ(counts.at("fill holes"), 1);
    EXPECT_EQ(counts.at("orient faces"), 1);
    EXPECT_NEAR(report.at("after").at("volume_m3").get<double>() / geometry::volume_of(crown()), 1.0, 1e-4);
    expect_refused(call({"repair", "cutter.stl", "-o", "sound.stl"}), 2, "Nothing is overwritten");
    study("", "sound.stl");
    EXPECT_EQ(call({"check", "study.toml"}).code, 0);
}

TEST_F(Cli, writes_no_file_over_another_of_the_same_command) {
    study();
    expect_refused(call({"repair", "cutter.stl", "-o", "a.stl", "--report", "./a.stl"}), 2, "--output and --report both name a.stl");
    EXPECT_FALSE(fs::exists(folder_ / "a.stl"));
    expect_refused(call({"inspect", "cutter.stl", "-o", "a", "--contour", "a"}), 2, "--output and --contour both name a");
}

TEST_F(Cli, names_the_option_or_key_that_is_empty) {
    expect_refused(call({"run", "study.toml", "-o", ""}), 2, "--output: \"\" is empty");
    expect_refused(call({"new", ""}), 2, "study: \"\" is empty");
    write_file(folder_ / "study.toml", "cutter.file = \"\"\nrotor.speed_rpm = 60\nsuction.discharge_m3_s = 0.12\n");
    expect_refused(call({"check", "study.toml"}), 2, "study.toml:1: cutter.file = \"\" is empty");
}

TEST_F(Cli, check_names_mistakes_of_files_rules_and_sizes_together) {
    const std::string feed = "[[feed]]\ncount = 2\nmass_kg = 1\n[[feed.class]]\ndiameter_m = 0.02\n";
    const Outcome sizes = call({"check", study("mouth_radius_m = 0.19\n[report]\nadv_points = \"absent.csv\"\n" + feed)});
    expect_refused(sizes, 2, "both count and mass_kg");
    expect_contains(sizes.text, "absent.csv");
    expect_contains(sizes.text, "The mouth must lie inside the ring");
    study("[report]\nadv_points = \"absent.csv\"\n" + feed);
    fs::remove(folder_ / "cutter.stl");
    const Outcome files = call({"check", "study.toml"});
    expect_refused(files, 2, "both count and mass_kg");
    expect_contains(files.text, "absent.csv");
    expect_contains(files.text, "cutter.file = \"cutter.stl\"");
}

TEST_F(Cli, check_tells_broken_rules_of_feeds_and_banks_and_goes_no_further) {
    const std::string swing = "[swing]\nspeed_m_min = 1.8\n", bank = "[bank]\nmodel = \"wall\"\n",
                      cut_face = "[[feed]]\nkind = \"cut_face\"\n", rock = "[[feed.class]]\ndiameter_m = 0.03\n";
    expect_refused(call({"check", study(swing + bank + cut_face)}), 2, "feed 1 has no class of rock");
    expect_refused(call({"check", study("[[feed]]\ncount = 10\n")}), 2, "feed 1 has no class of rock");
    expect_refused(call({"check", study(swing + cut_face + rock)}), 2, "Rock comes from a cut face only where the head cuts a bank");
    for (const char* far : {"clearance_m = 3\n", "pick_length_m = 100\n"})
        expect_refused(call({"check", study(swing + bank + far + cut_face + rock)}), 2, "Soil begins nearer to the head than 0.5 times");
}

TEST_F(Cli, repair_says_where_it_cannot_and_shows_the_faces) {
    geometry::TriangleSurface half{crown().points, {}};
    for (const geometry::Triangle& t : crown().triangles)
        if (geometry::centroid_of(crown(), t).x() > 0.0) half.triangles.push_back(t);
    geometry::write_stl(half, folder_ / "half.stl");
    const Outcome outcome = call({"repair", "half.stl", "-o", "sound.stl"});
    expect_refused(outcome, 2, "a hole of");
    expect_contains(outcome.text, "Open it in ParaView");
    EXPECT_FALSE(fs::exists(folder_ / "sound.stl"));
    const std::string faces = read_file(folder_ / "sound.bad_faces.vtp");
    expect_contains(faces, "<VTKFile type=\"PolyData\"");
    expect_contains(faces, "Name=\"source_face\"");
    call({"repair", "half.stl", "-o", "sound.stl"});
    EXPECT_TRUE(fs::exists(folder_ / "sound.bad_faces.2.vtp"));
}

TEST_F(Cli, inspect_writes_a_page_with_pictures_for_heads_and_for_what_is_none) {
    geometry::write_stl(crown(), folder_ / "head.stl");
    EXPECT_EQ(call({"inspect", "head.stl", "-o", "page"}).code, 0);
    const std::string page = read_file(folder_ / "page/index.html");
    std::size_t pictures = 0;
    for (std::size_t at = page.find("data:image/png"); at != std::string::npos; at = page.find("data:image/png", at + 1)) ++pictures;
    EXPECT_EQ(pictures, 3u);
    EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org")) << "the page needs no network";
    EXPECT_EQ(nlohmann::json::parse(read_file(folder_ / "page/inspection.json")).at("head").at("blades"), 6);
    expect_refused(call({"inspect", "head.stl", "-o", "page"}), 2, "Nothing is overwritten");
    geometry::TriangleSurface open = crown();
    open.triangles.erase(open.triangles.begin() + 100);
    geometry::write_stl(open, folder_ / "open.stl");
    expect_refused(call({"inspect", "open.stl", "-o", "open_page"}), 2, "open edge(s)");
    expect_contains(read_file(folder_ / "open_page/index.html"), "cutterflow repair open.stl");
}

TEST_F(Cli, generate_solid_writes_solids_of_known_volume_and_inspect_shows_them_as_no_heads) {
    const std::map<std::string, std::vector<std::string>> sizes{
        {"pipe", {"--inner-radius-m", "0.1", "--wall-m", "0.02", "--length-m", "0.5"}},
        {"box", {"--x-m", "0.3", "--y-m", "0.2", "--z-m", "0.1"}},
        {"funnel", {"--inlet-radius-m", "0.3", "--outlet-radius-m", "0.1", "--height-m", "0.3", "--wall-m", "0.02"}},
        {"backplate",
         {"--radius-m", "0.4", "--thickness-m", "0.02", "--gap-m", "0.03", "--mouth-radius-m", "0.1", "--mouth-offset-m", "0.22",
          "--mouth-azimuth-deg", "90", "--pipe-wall-m", "0.01", "--pipe-length-m", "0.3"}}};
    // pi w (2 r + w) l; x y z; pi w (r + q + w) h; plate without the mouth, and the pipe on it.
    const std::map<std::string, double> volumes{{"pipe", k_pi * 0.02 * 0.22 * 0.5},
                                                {"box", 0.006},
                                                {"funnel", k_pi * 0.02 * 0.42 * 0.3},
                                                {"backplate", k_pi * (0.15 * 0.02 + 0.0021 * 0.3)}};
    for (const auto& [solid, options] : sizes) {
        const std::string file = solid + ".stl";
        std::vector<std::string> arguments{"generate-solid", solid, "--edge-m", "0.05", "-o", file};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome made = call(arguments);
        ASSERT_EQ(made.code, 0) << made.text;
        expect_refused(call(arguments), 2, "Nothing is overwritten");
        // A funnel is as round as a head without blades; the others lack an axis, or a hub's end.
        const bool round = solid == "funnel";
        const Outcome inspected = call({"inspect", file, "-o", solid});
        expect_refused(inspected, round ? 0 : 2, round ? "blades       0" : file + ": ");
        const nlohmann::json report = nlohmann::json::parse(read_file(folder_ / solid / "inspection.json"));
        EXPECT_TRUE(report.at("sound").get<bool>()) << solid;
        EXPECT_NEAR(report.at("surface").at("volume_m3").get<double>() / volumes.at(solid), 1.0, 0.005) << solid;
        const std::string page = read_file(folder_ / solid / "index.html");
        EXPECT_EQ(page.find("Not a cutter head") == std::string::npos, round) << solid;
        expect_contains(page, "data:image/png");
    }
    expect_refused(call({"generate-solid", "box", "--x-m", "0", "--y-m", "1", "--z-m", "1", "--edge-m", "1", "-o", "flat.stl"}), 2,
                   "length along x = 0 m. It must be above 0");
    const Outcome huge = call({"generate-solid", "box", "--x-m", "1e39", "--y-m", "1", "--z-m", "2e6", "--edge-m", "1", "-o", "box.ply"});
    for (const char* part : {"1e39 is not a length of at most 1e6 m", "2e6 is not a length", "box.ply does not end with .stl"})
        expect_refused(huge, 2, part);
    write_file(folder_ / "study.toml", "[cutter]\nfile = \"box.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n");
    expect_refused(call({"check", "study.toml"}), 2, "box.stl: ");
}

TEST_F(Cli, names_all_missing_and_wrong_options_of_a_solid_at_once) {
    const std::map<std::string, std::vector<std::string>> options{
        {"box", {"--x-m", "--y-m", "--z-m"}},
        {"pipe", {"--inner-radius-m", "--wall-m", "--length-m"}},
        {"funnel", {"--inlet-radius-m", "--outlet-radius-m", "--height-m", "--wall-m"}},
        {"backplate",
         {"--radius-m", "--thickness-m", "--gap-m", "--mouth-radius-m", "--mouth-offset-m", "--pipe-wall-m", "--pipe-length-m"}}};
    for (const auto& [solid, names] : options) {
        const Outcome outcome = call({"generate-solid", solid, "--edge-m", "fine", "--colour", "red"});
        expect_refused(outcome, 2, "cutterflow generate-solid " + solid + " has no option --colour");
        for (const std::string& name : names) expect_contains(outcome.text, name + " is required");
        for (const char* part : {"--output is required", "fine", "See cutterflow generate-solid "}) expect_contains(outcome.text, part);
    }
    expect_refused(call({"generate-solid"}), 2, "The command is written as: cutterflow generate-solid COMMAND");
}

TEST_F(Cli, refuses_millimetres_taken_as_metres_and_tells_them_when_not_said) {
    geometry::write_stl(scaled(crown(), 1000.0), folder_ / "cutter.stl");
    expect_refused(call({"check", study("", "cutter.stl")}), 0, "mm");
    write_file(folder_ / "study.toml",
               "[cutter]\nfile = \"cutter.stl\"\nunit = \"m\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n");
    expect_refused(call({"check", "study.toml"}), 2, "mm");
}

TEST_F(Cli, reports_all_mistakes_of_a_study_at_once) {
    write_file(
        folder_ / "study.toml",
        "[cutter]\nfile = \"cutter.stl\"\n[rotor]\nspeed_rpm = \"fast\"\ndirektion = \"left_handed\"\n[suction]\ndischarge_m3_s = 0\n");
    const Outcome outcome = call({"check", "study.toml"});
    expect_refused(outcome, 2, "study.toml:4: rotor.speed_rpm");
    expect_contains(outcome.text, "study.toml:5: key rotor.direktion is unknown");
    expect_contains(outcome.text, "Did you mean rotor.direction?");
    expect_contains(outcome.text, "study.toml:7: suction.discharge_m3_s = 0 is too low. It must be 1e-06 to 100 m3/s");
    expect_contains(outcome.text, "cutter.file = \"cutter.stl\". There is no file");
    expect_refused(call({"check", "nowhere.toml", "--ranks", "0"}), 2, "cannot read nowhere.toml");
    expect_contains(call({"check", "nowhere.toml", "--ranks", "0"}).text, "--ranks 0");
}

TEST_F(Cli, names_unknown_keys_beside_mistakes_of_rules_and_sizes) {
    const Outcome outcome = call({"check", study("mouth_radius_m = 0.3\nmouth_radios_m = 0.1\n[[feed]]\ncount = 2\n")});
    expect_refused(outcome, 2, "Did you mean suction.mouth_radius_m?");
    expect_contains(outcome.text, "feed 1 has no class of rock");
    expect_contains(outcome.text, "must lie inside the ring");
}

TEST_F(Cli, refuses_sizes_that_cannot_be_meshed) {
    expect_refused(call({"check", study("gap_m = 0.002\n")}), 2, "gap");
    expect_refused(call({"check", study("mouth_radius_m = 0.3\n")}), 2, "must lie inside the ring");
    expect_refused(call({"check", study("[tank]\nheight_m = 0.5\n")}), 2, "Make the tank higher");
}

TEST_F(Cli, names_the_line_of_a_cutter_file_that_is_not_there) {
    study();
    write_file(folder_ / "study.toml",
               "[cutter]\nfile = \"heads/revision_b.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n");
    const std::string message = "study.toml:2: cutter.file = \"heads/revision_b.stl\". There is no file /";
    const Outcome outcome = call({"check", "study.toml"});
    expect_refused(outcome, 2, message);
    expect_contains(outcome.text, "the path is relative to the study file");
    EXPECT_EQ(run_child(mesh_with_stand_ins()).exit_code, 2);
    expect_contains(read_file(folder_ / "output"), message);
}

TEST_F(Cli, refuses_a_head_larger_than_the_tank_and_a_mouth_outside_the_ring) {
    expect_refused(
        call({"check", study("[tank]\nradius_m = 0.3\n")}), 2,
        "study.toml:8: tank.radius_m = 0.3. It must be at least 1.5 times the radius of head (0.4 m) and backplate (0.4 m), 0.6 m");
    expect_refused(call({"check", study("[tank]\nheight_m = 0.4\n")}), 2,
                   "study.toml:8: tank.height_m = 0.4. Bed clearance, head, gap and backplate take");
    expect_refused(
        call({"check", study("mouth_offset_m = 0.45\n")}), 2,
        "study.toml:7: suction.mouth_offset_m = 0.45. The mouth must lie inside the ring: mouth_offset_m + mouth_radius_m = 0.55");
}

TEST_F(Cli, refuses_a_feed_region_without_water_and_warns_of_one_too_small) {
    // 5 mm of the ring's height at its radius: nothing but steel and gap narrower than a rock.
    expect_refused(call({"check", study("[[feed]]\ncount = 5\ndepth_from_m = 0.0\ndepth_to_m = 0.005\nazimuth_width_deg = "
                                        "1\n[[feed.class]]\ndiameter_m = 0.1\n")}),
                   2, "feed");
    // Beside points outside the water and an unknown key all is told at once.
    write_file(folder_ / "points.csv",
               "name,r_mm,theta_deg,z_mm,frame,u_radial_cm_s,u_tangential_cm_s,u_axial_cm_s\nfar,90000,0,0,still,1,1,1\n");
    const Outcome all = call({"check", study("[report]\nadv_points = \"points.csv\"\n[[feed]]\ncolour = 1\ncount = 5\ndepth_to_m = 0.005\n"
                                             "azimuth_width_deg = 1\n[[feed.class]]\ndiameter_m = 0.1\n")});
    expect_refused(all, 2, "colour");
    expect_contains(all.text, "lies outside the water");
    expect_contains(all.text, "feed 1");
    const Outcome crowded = call({"check", study("[[feed]]\ncount = 5000\n[[feed.class]]\ndiameter_m = 0.02\n")});
    EXPECT_EQ(crowded.code, 0);
    expect_contains(crowded.text, "no free place left");
}

TEST_F(Cli, warns_of_a_rotor_that_carries_rock_away_and_of_rock_that_may_block) {
    EXPECT_EQ(call({"check", study("[ladder]\ninclination_deg = 15\n")}).text.find("warning"), std::string::npos);
    // At 45 degrees, the default, the crown's blades are flatter than the ladder.
    expect_contains(call({"check", study()}).text, "warning: ladder.inclination_deg = 45 with blades that are flatter over 100 %");
    const Outcome away = call({"check", study("[swing]\ndirection = \"under_cut\"\n", "cutter.stl")});
    EXPECT_EQ(away.text.find("carry rock away"), std::string::npos);
    geometry::write_stl(mirrored(crown()), folder_ / "mirror.stl");
    const Outcome mirror = call({"check", study("", "mirror.stl")});
    EXPECT_EQ(mirror.code, 0);
    expect_contains(mirror.text, "warning: rotor.direction = \"right_handed\" makes the blades carry rock away from the suction side");
    expect_contains(call({"check", study("[[feed]]\ncount = 1\n[[feed.class]]\ndiameter_m = 0.08\n")}).text,
                    "third of the smallest passage");
}

TEST_F(Cli, names_a_bank_without_a_swing_with_all_other_mistakes) {
    study("mouth_radius_m = 3\n[bank]\nmodel = \"wall\"\n[[feed]]\n[[feed.class]]\ndiameter_m = 0.02\n");
    for (const char* command : {"check", "run", "mesh"}) {
        const Outcome outcome = call({command, "study.toml"});
        expect_refused(outcome, 2, "swing.speed_m_min is missing. Add swing.speed_m_min");
        expect_contains(outcome.text, "feed 1 has neither count nor mass_kg");
    }
    expect_contains(call({"check", "study.toml"}).text, "suction.mouth_radius_m = 3. The mouth must lie inside the ring");
}

TEST_F(Cli, names_mistakes_beside_the_head_with_those_of_the_text) {
    study("mouth_radius_m = 3\n[tank]\nbed_clearance_m = -1\n");
    const Outcome outcome = call({"check", "study.toml"});
    expect_refused(outcome, 2, "tank.bed_clearance_m = -1");
    expect_contains(outcome.text, "suction.mouth_radius_m = 3. The mouth must lie inside the ring");
    EXPECT_EQ(outcome.text.find("tank.height_m"), std::string::npos) << outcome.text;
    write_file(folder_ / "study.toml",
               "[cutter]\nfile = \"cutter.stl\"\nunit = \"furlong\"\n[rotor]\nspeed_rpm = 60\n[suction]\n"
               "discharge_m3_s = 0.12\nmouth_radius_m = 3\n");
    const Outcome without_unit = call({"check", "study.toml"});
    expect_refused(without_unit, 2, "cutter.unit = \"furlong\" is no choice");
    EXPECT_EQ(without_unit.text.find("mouth"), std::string::npos) << without_unit.text;
}

TEST_F(Cli, names_all_mistakes_of_a_cut_face_at_once) {
    study(
        "mouth_radius_m = 3\n[swing]\nspeed_m_min = 6\n[bank]\nstep_m = 2\n"
        "[[feed]]\nkind = \"cut_face\"\nduration_s = 9\nsize_law = \"log_normal\"\nsize_d50_m = 0.02\n");
    const Outcome outcome = call({"check", "study.toml"});
    expect_refused(outcome, 2, "Rock comes from a cut face only where the head cuts a bank. Set bank.model = \"wall\"");
    for (const char* part :
         {"swing.speed_m_min = 6. It belongs to a bank", "bank.step_m = 2. It belongs to a bank", "It needs feed.size_spread",
          "It needs feed.size_min_m", "It needs feed.size_max_m", "feed.duration_s = 9. The feed would end at",
          "suction.mouth_radius_m = 3. The mouth must lie inside the ring"})
        expect_contains(outcome.text, part);
    // What needs the head's geometry, too: the bank is checked beside a feed that is wrong.
    study(
        "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\ncut_height_m = 9\n[[feed]]\nkind = \"cut_face\"\nsize_law = \"log_normal\"\n");
    const Outcome beside = call({"check", "study.toml"});
    expect_refused(beside, 2, "bank.cut_height_m = 9. The head with picks and clearance is");
    expect_contains(beside.text, "It needs feed.size_d50_m");
}

TEST_F(Cli, checks_points_of_measurement_against_water_and_steel) {
    const std::string header = call({"report", "--adv-template"}).text;
    write_file(folder_ / "points.csv", header);
    EXPECT_EQ(call({"check", study("[report]\nadv_points = \"points.csv\"\n")}).code, 0);
    // The tank's radius is 2.5 m; the hub turns about the axis; a blade's tip passes a still point and leaves water behind it.
    write_file(folder_ / "points.csv", header +
                                           "C1,2600,0,-60,still,,,\nC2,100,0,900,still,,,\nC3,5,0,-440,still,,,\nC4,5,0,-440,rotating,,,\n"
                                           "C5,250,0,-150,still,,,\nC6,300,180,40,still,,,\n");
    const Outcome outcome = call({"check", "study.toml"});
    expect_refused(outcome, 2, "point C1 (r = 2.6 m, theta = 0 deg, z = -0.06 m) lies outside the water");
    for (const char* part : {"point C2 (r = 0.1 m", "point C3", "point C4", "point C6", "lies inside steel"})
        expect_contains(outcome.text, part);
    EXPECT_EQ(outcome.text.find("point A1 ("), std::string::npos) << outcome.text;
    EXPECT_EQ(outcome.text.find("point C5 ("), std::string::npos) << outcome.text;
    expect_refused(call({"report"}), 2, "report without a run directory");
    expect_refused(call({"check", study("[report]\nadv_points = \"nowhere.csv\"\n")}), 2, "nowhere.csv");
}

// The bank stands at azimuth -90 degrees, beside and below the head.
TEST_F(Cli, checks_points_of_measurement_against_soil) {
    const std::string header = call({"report", "--adv-template"}).text,
                      keys = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n[report]\nadv_points = \"points.csv\"\n";
    write_file(folder_ / "points.csv", header + "S1,600,-90,-400,still,,,\nS2,600,-90,-400,rotating,,,\nS3,600,90,-400,still,,,\n");
    const Outcome outcome = call({"check", study(keys)});
    expect_refused(outcome, 2, "point S1 (r = 0.6 m, theta = -90 deg, z = -0.4 m) lies inside soil");
    for (const char* part : {"point S2 (", "point S3 (", "inside steel"}) EXPECT_EQ(outcome.text.find(part), std::string::npos) << part;
}

TEST_F(Cli, refuses_names_that_are_too_long_for_the_system) {
    const std::string name(300, 'n');
    study();
    for (const auto& arguments : std::vector<std::vector<std::string>>{
             {"run", "study.toml", "-o", name}, {"check", name}, {"compare", name, "b"}, {"new", name + ".toml"}}) {
        const Outcome outcome = call(arguments);
        expect_refused(outcome, 2, "The name of a file or folder has at most 255 bytes");
        EXPECT_EQ(outcome.text.find("filesystem error"), std::string::npos) << outcome.text;
    }
}

TEST_F(Cli, names_all_mistakes_of_a_comparison_at_once) {
    fs::create_directories(folder_ / "a");
    write_file(folder_ / "excel.csv", "speed_rpm;spillage\n60;0.3\n");
    const Outcome outcome = call({"compare", "a", "./a", "--measured", "excel.csv", "none.csv", "-o", "page", "--static", "page"});
    expect_refused(outcome, 2, "./a is the same run as a");
    for (const char* part : {"excel.csv:1: the header \"speed_rpm;spillage\" has no comma. Columns are separated by commas",
                             "there is no file none.csv", "--output and --static both name page"})
        expect_contains(outcome.text, part);
}

TEST_F(Cli, names_all_mistakes_of_a_repair_and_of_a_report_at_once) {
    write_file(folder_ / "there.stl", "mine");
    write_file(folder_ / "there.json", "mine");
    const Outcome repair = call({"repair", "none.stl", "-o", "there.stl", "--report", "there.json", "--unit", "furlong"});
    expect_refused(repair, 2, "there.stl is there already");
    for (const char* part : {"there.json is there already", "none.stl", "furlong"}) expect_contains(repair.text, part);
    const Outcome report = call({"report", "no_run", "--adv", "no.csv"});
    expect_refused(report, 2, "no.csv");
    expect_contains(report.text, "no_run");
}

TEST_F(Cli, names_all_mistakes_of_commands_on_surfaces_at_once) {
    write_file(folder_ / "there.stl", "mine");
    write_file(folder_ / "there.csv", "mine");
    write_file(folder_ / "crown.toml", "[ring]\nradius_m = -1\n");
    const Outcome inspected = call({"inspect", "none.stl", "--contour", "there.csv", "-o", "there.csv", "--unit", "furlong"});
    expect_refused(inspected, 2, "there.csv is there already");
    for (const char* part : {"none.stl", "furlong", "--output and --contour both name there.csv"}) expect_contains(inspected.text, part);
    const Outcome crown = call({"generate-cutter", "crown.toml", "-o", "there.stl"});
    expect_refused(crown, 2, "there.stl is there already");
    expect_contains(crown.text, "crown.toml:");
    const Outcome clump = call({"clump", "none.stl", "-o", "there.csv"});
    expect_refused(clump, 2, "there.csv is there already");
    expect_contains(clump.text, "none.stl");
    const Outcome box = call({"generate-solid", "box", "--x-m", "0", "--y-m", "1", "--z-m", "1", "--edge-m", "1", "-o", "there.stl"});
    expect_refused(box, 2, "there.stl is there already");
    expect_contains(box.text, "length along x = 0 m");
}

TEST_F(Cli, says_that_a_resumed_run_begins_only_where_it_does) {
    write_file(folder_ / "used/notes.txt", "mine");
    const Outcome outcome = call({"run", study(), "-o", "used", "--resume"});
    expect_refused(outcome, 2, "used contains files but no manifest.json");
    EXPECT_EQ(outcome.text.find("it begins"), std::string::npos) << outcome.text;
}

TEST_F(Cli, names_the_size_of_a_crown_that_is_wrong) {
    const auto outcome_with = [&](const std::string& key, const std::string& value) {
        std::string crown_file = read_file(k_crown);
        const std::size_t at = crown_file.find("\n" + key) + 1;
        crown_file.replace(at, crown_file.find('\n', at) - at, key + " = " + value);
        write_file(folder_ / "crown.toml", crown_file);
        return call({"generate-cutter", "crown.toml", "-o", "made.stl"});
    };
    expect_refused(outcome_with("edge_length_m", "50"), 2, "surface.edge_length_m = 50. Edges longer than hub.radius_m");
    const Outcome flat = outcome_with("depth_m", "0.001");
    expect_refused(flat, 2, "hub.depth_m = 0.001. The hub's rim must lie below the ring");
    EXPECT_EQ(flat.text.find("= -"), std::string::npos) << "a bound below 0: " << flat.text;
}

// A micrometre of soil in a day.
TEST_F(Cli, warns_of_a_cut_that_gives_no_rock) {
    const Outcome outcome = call({"check", study("[swing]\nspeed_m_min = 1e-9\n[bank]\nmodel = \"wall\"\n[[feed]]\nkind = \"cut_face\"\n"
                                                 "[[feed.class]]\ndiameter_m = 0.03\n")});
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    expect_contains(outcome.text, "warning: not one rock comes from 6 to 9 s");
}

TEST_F(Cli, names_the_value_of_a_sweep_that_is_no_number) {
    const Outcome outcome = call({"sweep", study(), "--rpm", "20,x,-3"});
    expect_refused(outcome, 2, "x is not a number above 0");
    expect_contains(outcome.text, "-3 is not a number above 0");
    EXPECT_EQ(call({"sweep", study(), "--discharge", "nan"}).code, 2);
    expect_refused(call({"sweep", study(), "--design", "a.stl,b.stl"}), 2, "--design b.stl does not exist");
    expect_refused(call({"sweep", study(), "--rpm", "30", "--emit", "slurm", "--ranks", "0"}), 2, "--ranks 0");
    expect_refused(call({"sweep", study(), "--rpm", "30", "--emit", "slurm", "-o", "my sweep"}), 2, "OpenFOAM");
}

TEST_F(Cli, names_all_wrong_options_of_a_sweep_at_once) {
    study();
    const Outcome words = call({"sweep", "--rpm", "x", "--discharge", "-1", "--repeats", "0", "--launcher", "pbs", "--sped=3"});
    expect_refused(words, 2, "study is required");
    for (const char* part : {"x is not a number above 0", "-1 is not a number above 0", "--repeats", "pbs", "no option --sped"})
        expect_contains(words.text, part);
    write_file(folder_ / "study.toml", "cutter.file = \"cutter.stl\"\nrotor.speed_rpm = -1\nsuction.discharge_m3_s = 0.12\n");
    const Outcome values =
        call({"sweep", "study.toml", "--ranks", "0", "-o", "my sweep", "--design", "absent.stl", "--speed", "3", "--resume"});
    expect_refused(values, 2, "--ranks 0");
    for (const char* part : {"OpenFOAM", "--design absent.stl does not exist", "a sweep over --speed", "rotor.speed_rpm = -1"})
        expect_contains(values.text, part);
    EXPECT_FALSE(fs::exists(folder_ / "my sweep"));
}

TEST_F(Cli, goes_on_with_a_bed_that_was_interrupted) {
    const Outcome outcome = call({"mesh", study(), "--ranks", "1000", "--resume"});
    expect_refused(outcome, 2, "1000");
    EXPECT_EQ(outcome.text.find("--resume"), std::string::npos) << outcome.text;
}

TEST_F(Cli, looks_at_rock_to_be_replayed_before_a_sweep_runs) {
    study("[run]\nrecord_revolutions = 1\n[[feed]]\ncount = 5\n[[feed.class]]\ndiameter_m = 0.02\n");
    write_file(folder_ / "rock.toml", "[rotor]\nspeed_rpm = 50\n[swing]\ndirection = \"under_cut\"\n");
    const Outcome options = call({"sweep", "study.toml", "--repeats", "2", "--replay-study", "rock.toml", "-o", "sweep"});
    expect_refused(options, 2, "--replay-study without --replay");
    expect_contains(options.text, "--replay-study with --repeats 2");
    const Outcome rock = call({"sweep", "study.toml", "--rpm", "45", "--replay", "3", "--replay-study", "rock.toml", "-o", "sweep"});
    expect_refused(rock, 2, "rotor.speed_rpm = 50. A replay takes the flow as the run recorded it, with 45");
    expect_contains(rock.text, "no [[feed]]");
    expect_refused(call({"sweep", "study.toml", "--replay", "3", "--replay-study", "none.toml", "-o", "sweep"}), 2, "none.toml");
    write_file(folder_ / "other.stl", "another cutter");
    write_file(folder_ / "rock.toml", "[cutter]\nfile = \"other.stl\"\n[[feed]]\ncount = 5\n[[feed.class]]\ndiameter_m = 0.02\n");
    expect_refused(call({"sweep", "study.toml", "--replay", "3", "--replay-study", "rock.toml", "-o", "sweep"}), 2, "other content");
    EXPECT_FALSE(fs::exists(folder_ / "sweep"));
}

TEST_F(Cli, names_a_calibration_without_a_folder_beside_the_mistakes_of_its_file) {
    write_file(folder_ / "calibration.toml", "study = [\"absent.toml\"]\n[budget]\nruns = 0\n");
    const Outcome outcome = call({"calibrate", "calibration.toml"});
    expect_refused(outcome, 2, "calibrate without -o");
    for (const char* part : {"absent.toml does not exist", "calibration.toml:3: budget.runs = 0 is too low", "budget.core_h is missing"})
        expect_contains(outcome.text, part);
    const Outcome plan = call({"calibrate", "calibration.toml", "--plan"});
    expect_refused(plan, 2, "absent.toml does not exist");
    expect_contains(plan.text, "budget.runs = 0 is too low");
}

TEST_F(Cli, refuses_a_sweep_over_what_it_does_not_vary) {
    const Outcome outcome = call({"sweep", study(), "--speed", "30,60", "--discharges", "0.1"});
    expect_refused(outcome, 2, "a sweep over --speed. A sweep varies --rpm, --discharge, --design, --set, --repeats");
    expect_contains(outcome.text, "Did you mean --discharge?");
    EXPECT_FALSE(fs::exists(folder_ / "runs"));
}

TEST_F(Cli, refuses_machines_that_cannot_run_it) {
    study();
    const std::string too_many = std::to_string(cases::available_cores() + 1);
    expect_refused(call({"run", "study.toml", "--ranks", too_many}), 2, "Use --ranks " + std::to_string(cases::available_cores()));
    expect_refused(call({"run", "study.toml", "--ranks", "0"}), 2, "--ranks 0");
    expect_refused(call({"mesh", "study.toml"}, {{"WM_PROJECT_VERSION", "v2206"}}), 2, "OpenFOAM v2206");
    const Outcome bare = call({"mesh", "study.toml"}, {{"PATH", folder_.string()}});
    expect_refused(bare, 3, "snappyHexMesh was not found");
    expect_contains(bare.text, "package openfoam");
    const Outcome both = call({"run", study(k_feed), "--start-from", "no_run", "--ranks", "0"}, {{"PATH", folder_.string()}});
    expect_refused(both, 2, "no_run");
    expect_contains(both.text, "--ranks 0");
    expect_contains(bare.text, "./bootstrap");
    EXPECT_FALSE(fs::exists(folder_ / "runs"));
}

TEST_F(Cli, refuses_run_directories_that_openfoam_cannot_take_or_that_are_in_use_by_others) {
    study();
    expect_refused(call({"mesh", "study.toml", "-o", "my runs/1"}), 2, "OpenFOAM");
    EXPECT_FALSE(fs::exists(folder_ / "my runs"));
    write_file(folder_ / "thesis/chapter.tex", "mine");
    expect_refused(call({"mesh", "study.toml", "-o", "thesis"}), 2, "nothing is overwritten");
    EXPECT_EQ(read_file(folder_ / "thesis/chapter.tex"), "mine");
    expect_refused(call({"report", "thesis"}), 2, "thesis");
}

TEST_F(Cli, generate_cutter_writes_a_head_that_inspect_understands) {
    ASSERT_EQ(call({"generate-cutter", k_crown.string(), "-o", "crown.stl"}).code, 0);
    expect_refused(call({"generate-cutter", k_crown.string(), "-o", "crown.stl"}), 2, "Nothing is overwritten");
    const Outcome outcome = call({"inspect", "crown.stl", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const nlohmann::json report = nlohmann::json::parse(outcome.text);
    EXPECT_EQ(report.at("head").at("blades"), 6);
    EXPECT_NEAR(report.at("head").at("ring_radius_m").get<double>(), 0.40, 2e-3);
    EXPECT_NEAR(report.at("head").at("lowest_z_m").get<double>(), -0.485, 2e-3);
    write_file(folder_ / "crown.toml", "[ring]\nradius_m = -1\n");
    expect_refused(call({"generate-cutter", "crown.toml", "-o", "bad.stl"}), 2, "crown.toml:2: ring.radius_m = -1");
    EXPECT_FALSE(fs::exists(folder_ / "bad.stl"));
}

TEST_F(Cli, an_interrupt_stops_the_program_under_way_and_says_how_to_go_on) {
    study();
    const ChildCommand command = mesh_with_stand_ins();
    stand_in("blockMesh", "trap 'echo > ../../../blockMesh.stopped; exit 0' INT; kill -INT $PPID; while :; do sleep 0.05; done");
    EXPECT_EQ(run_child(command).exit_code, 130);
    EXPECT_TRUE(fs::exists(folder_ / "blockMesh.stopped"));
    const std::string text = read_file(folder_ / "output");
    expect_contains(text, "blockMesh was stopped by Ctrl-C (SIGINT)");
    expect_contains(text, "resume with: cutterflow mesh study.toml -o runs/a --ranks 1");
    const nlohmann::json stages = nlohmann::json::parse(read_file(folder_ / "runs/a/manifest.json")).at("stages");
    EXPECT_EQ(stages.at("geometry").at("state"), "done");
    EXPECT_EQ(stages.at("mesh").at("state"), "started");

    stand_in("blockMesh", "echo 'the disk is full'; exit 1");
    const ChildResult failed = run_child(command);
    EXPECT_EQ(failed.exit_code, 3);
    const std::string failure = read_file(folder_ / "output");
    expect_contains(failure, "geometry: already done");
    expect_contains(failure, "the disk is full");
    expect_contains(failure, "log.blockMesh");
}

TEST_F(Cli, generated_files_changed_by_hand_stop_the_command) {
    study();
    const ChildCommand command = mesh_with_stand_ins();
    stand_in("blockMesh", "exit 1");
    EXPECT_EQ(run_child(command).exit_code, 3);
    write_file(folder_ / "runs/a/geometry/contour.csv", "z_m,r_m\n-1,0\n0,1\n");
    EXPECT_EQ(run_child(command).exit_code, 2);
    const std::string text = read_file(folder_ / "output");
    expect_contains(text, "runs/a/geometry/contour.csv: this generated file was changed by hand");
    EXPECT_EQ(read_file(folder_ / "runs/a/geometry/contour.csv"), "z_m,r_m\n-1,0\n0,1\n");
}
