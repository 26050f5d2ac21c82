#include "cases/study/study.hpp"

#include <cmath>
#include <cstdlib>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cases/scenes/study_kind.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"
#include "solver/physics/contact.hpp"

using namespace cutterflow;
using namespace cutterflow::cases;
namespace fs = std::filesystem;

namespace {

const HeadSize k_model{0.40, 0.40, 0.485};

std::string minimal(const std::string& more = {}) {
    return "[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0.12\n" + more;
}

ParameterValues parse(const std::string& text) {
    return parse_parameters(study_table(), text, "study.toml");
}

std::string with_feed(const std::string& feed_keys, const std::string& class_keys = "diameter_m = 0.02\n") {
    return minimal("[[feed]]\n" + feed_keys + "[[feed.class]]\n" + class_keys);
}

class StudyFile : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_study_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        file_ = fs::path(name) / "study.toml";
    }
    void TearDown() override { fs::remove_all(file_.parent_path()); }
    std::vector<Mistake> mistakes_of(const std::string& text) {
        write_file(file_, text);
        try {
            read_study(file_);
        } catch (const UserError& error) {
            return error.mistakes();
        }
        return {};
    }
    fs::path file_;
};

std::vector<Mistake> warnings_of(const std::string& text, const HeadSize& head = k_model) {
    const ParameterValues resolved = resolve_study(parse(text), head);
    return study_warnings(resolved, make_study(resolved, "/tmp"), head);
}

bool any_contains(const std::vector<Mistake>& mistakes, const std::string& part) {
    for (const Mistake& mistake : mistakes)
        if (mistake.text().find(part) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_F(StudyFile, two_mistakes_are_both_reported_with_their_lines) {
    const std::vector<Mistake> mistakes =
        mistakes_of("[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = 60\n[suction]\ndischarge_m3_s = 0\nmouth_radius = 0.1\n");
    ASSERT_EQ(mistakes.size(), 2u);
    EXPECT_EQ(mistakes[0].where, file_.string() + ":6");
    EXPECT_TRUE(any_contains(mistakes, "suction.discharge_m3_s = 0 is too low. It must be 1e-06 to 100 m3/s"));
    EXPECT_TRUE(any_contains(mistakes, "Did you mean suction.mouth_radius_m?"));
}

TEST_F(StudyFile, keys_that_became_those_of_pairs_are_refused_with_their_successors) {
    const std::vector<Mistake> mistakes = mistakes_of(minimal("[rock]\nfriction = 0.3\nrestitution = 0.9\n"));
    ASSERT_EQ(mistakes.size(), 2u);
    EXPECT_TRUE(any_contains(mistakes, "key rock.friction is unknown"));
    EXPECT_TRUE(any_contains(mistakes, "Did you mean rock.friction_rock and rock.friction_steel and rock.friction_soil?"));
    EXPECT_TRUE(any_contains(mistakes, "Did you mean rock.restitution_rock and rock.restitution_steel and rock.restitution_soil?"));
}

TEST_F(StudyFile, a_feeds_quantity_is_given_once_and_its_rock_sinks) {
    EXPECT_TRUE(mistakes_of(with_feed("count = 3\n")).empty());
    EXPECT_TRUE(any_contains(mistakes_of(with_feed("count = 3\nmass_kg = 1\n")), "both count and mass_kg"));
    EXPECT_TRUE(any_contains(mistakes_of(with_feed("seed = 3\n")), "neither count nor mass_kg"));
    EXPECT_TRUE(any_contains(mistakes_of(minimal("[[feed]]\ncount = 3\n")), "no class of rock"));
    EXPECT_TRUE(any_contains(mistakes_of(with_feed("count = 3\nduration_s = 2\n")), "A batch is released at once"));
    EXPECT_TRUE(any_contains(mistakes_of(with_feed("count = 3\n", "diameter_m = 0.02\ndensity_kg_m3 = 900\n")), "denser than the fluid"));
    EXPECT_TRUE(any_contains(mistakes_of(with_feed("count = 3\nstart_revolution = 9\n")), "released before run.max_revolutions = 9"));
    EXPECT_TRUE(any_contains(mistakes_of(with_feed("count = 3\n") + "[run]\nflow_revolutions = 9\n"), "no rock is ever released"));
}

/// A feed from a cut face, without a bank.
std::string with_cut_face(const std::string& keys) {
    return minimal("[run]\nflow_revolutions = 1\nmax_revolutions = 4\n[[feed]]\nkind = \"cut_face\"\n" + keys);
}

TEST_F(StudyFile, mistakes_of_a_cut_face_are_told_at_once) {
    const std::vector<Mistake> mistakes = mistakes_of(
        with_cut_face("count = 3\nduration_s = 4\nsize_law = \"rosin_rammler\"\nsize_d63_m = 0.02\n[[feed.class]]\ndiameter_m = 0.02\n"));
    EXPECT_TRUE(any_contains(mistakes, "feed.kind = \"cut_face\". Rock comes from a cut face only where the head cuts a bank"));
    EXPECT_TRUE(any_contains(mistakes, "The quantity of rock from a cut face follows from swing, bank and soil"));
    EXPECT_TRUE(any_contains(mistakes, "The feed would end at 5 s, after the run's end at 4 s"));
    EXPECT_TRUE(any_contains(mistakes, "Its sizes are given once"));
    for (const char* key : {"feed.size_spread", "feed.size_min_m", "feed.size_max_m"})
        EXPECT_TRUE(any_contains(mistakes, std::string("It needs ") + key)) << key;
    EXPECT_FALSE(any_contains(mistakes, "It needs feed.size_d63_m"));
    EXPECT_EQ(mistakes.size(), 7u);
    const std::string bank = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n", rock = "[[feed.class]]\ndiameter_m = 0.02\n";
    EXPECT_TRUE(mistakes_of(with_cut_face(rock) + bank).empty());
    EXPECT_TRUE(any_contains(mistakes_of(with_cut_face(rock) + "[swing]\nspeed_m_min = 0\n[bank]\nmodel = \"wall\"\n"),
                             "swing.speed_m_min = 0. A head that does not swing cuts nothing"));
    EXPECT_TRUE(any_contains(mistakes_of(with_cut_face(rock + "[[feed]]\ncount = 3\n" + rock) + bank), "one cut face"));
}

TEST_F(StudyFile, keys_that_a_feed_does_not_use_are_refused) {
    const std::string bank = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n", rock = "[[feed.class]]\ndiameter_m = 0.02\n";
    const std::vector<Mistake> of_cut_face =
        mistakes_of(with_cut_face("azimuth_width_deg = 90\nradius_from_m = 0.1\nradius_to_m = 0.2\ndepth_to_m = 0.3\nsize_d63_m = 0.02\n"
                                  "size_classes = 3\n" +
                                  rock) +
                    bank);
    EXPECT_EQ(of_cut_face.size(), 6u);
    EXPECT_TRUE(any_contains(of_cut_face,
                             "study.toml:12: feed.azimuth_width_deg = 90. It places a batch; rock from a cut face comes in where the "
                             "blades cut. Remove it, or set feed.kind = \"batch\""));
    EXPECT_TRUE(any_contains(of_cut_face, "feed.size_d63_m = 0.02. It belongs to a law of sizes, and feed.size_law = \"classes\""));
    const std::vector<Mistake> of_batch =
        mistakes_of(with_feed("count = 3\ndisintegration = 0.5\nvelocity_share = 1\nsize_min_m = 0.01\nsize_spread = 1\n"));
    EXPECT_EQ(of_batch.size(), 4u);
    EXPECT_TRUE(any_contains(of_batch, "feed.disintegration = 0.5. It belongs to rock from a cut face, and feed.kind = \"batch\""));
    const std::string bounds = "size_spread = 1\nsize_min_m = 0.01\nsize_max_m = 0.04\nsize_d63_m = 0.02\nsize_d50_m = 0.02\n";
    for (const auto& [law, key] : {std::pair{"rosin_rammler", "feed.size_d50_m"}, std::pair{"log_normal", "feed.size_d63_m"}}) {
        const std::vector<Mistake> of_law = mistakes_of(with_cut_face(std::string("size_law = \"") + law + "\"\n" + bounds) + bank);
        ASSERT_EQ(of_law.size(), 1u) << law;
        EXPECT_TRUE(any_contains(of_law, key)) << of_law.front().text();
    }
}

// As files have them that the program writes: with every default, and lengths only where they are used.
TEST_F(StudyFile, defaults_of_another_feed_say_nothing) {
    const std::string bank = "[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n", rock = "[[feed.class]]\ndiameter_m = 0.02\n";
    EXPECT_TRUE(mistakes_of(with_cut_face("azimuth_width_deg = 120\n" + rock) + bank).empty());
    for (const std::string& study : {with_feed("count = 3\n"), with_cut_face(rock) + bank}) {
        const ParameterValues resolved = resolve_study(parse(study), k_model);
        EXPECT_TRUE(mistakes_of(commented_toml(study_table(), &resolved)).empty());
    }
}

TEST_F(StudyFile, sizes_of_a_cut_face_lie_within_their_bounds) {
    EXPECT_TRUE(any_contains(mistakes_of(with_cut_face("size_min_m = 0.01\n[[feed.class]]\ndiameter_m = 0.005\n")),
                             "Rock is not finer than feed.size_min_m = 0.01 m"));
    const std::string law = "size_law = \"log_normal\"\nsize_d50_m = 0.02\nsize_spread = 0.5\n";
    EXPECT_TRUE(any_contains(mistakes_of(with_cut_face(law + "size_min_m = 0.05\nsize_max_m = 0.04\n")),
                             "It must be more than feed.size_min_m = 0.05 m"));
    EXPECT_TRUE(any_contains(mistakes_of(with_cut_face(law + "size_min_m = 0.2\nsize_max_m = 0.4\n")), "a hundredth is needed"));
    EXPECT_TRUE(any_contains(mistakes_of(with_cut_face("")), "Its sizes are [[feed.class]] tables or a feed.size_law"));
    EXPECT_TRUE(any_contains(mistakes_of(with_feed("count = 3\nduration_s = 1\n")), "A batch is released at once"));
    EXPECT_TRUE(any_contains(mistakes_of(with_feed("count = 3\nsize_law = \"log_normal\"\n")), "laws are for rock from a cut face"));
}

// A value out of bounds beside broken rules: all are told, and none that needs the value.
TEST_F(StudyFile, a_wrong_value_does_not_hide_rules_between_others) {
    const std::vector<Mistake> mistakes =
        mistakes_of(with_feed("count = 0\nduration_s = 2\ndisintegration = 0.5\n", "diameter_m = 0.02\ndensity_kg_m3 = 900\n") +
                    "[[feed]]\nstart_revolution = 9\n[[feed.class]]\ndiameter_m = -1\n[bank]\nmodel = \"wall\"\nstep_m = 0.1\n[swing]\n"
                    "speed_m_min = -6\n");
    for (const char* part : {"feed.count = 0 is too low", "A batch is released at once", "It belongs to rock from a cut face",
                             "denser than the fluid", "feed 2 has neither count nor mass_kg", "released before run.max_revolutions = 9",
                             "feed.class.diameter_m = -1", "swing.speed_m_min = -6"})
        EXPECT_TRUE(any_contains(mistakes, part)) << part;
    EXPECT_EQ(mistakes.size(), 8u);
    const std::vector<Mistake> no_speed = mistakes_of(
        "[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = 0\n[suction]\ndischarge_m3_s = 0.12\n[[feed]]\nkind = \"cut_face\"\n"
        "count = 3\nduration_s = 9\nclass = 3\n[bank]\nmodel = \"cliff\"\nstep_m = 1\n");
    EXPECT_EQ(no_speed.size(), 4u) << "speed, class, model, count";
}

TEST_F(StudyFile, the_template_reads_back) {
    EXPECT_TRUE(mistakes_of(study_template("my study", "Cutter Head (rev B).STL", "mm")).empty());
    const ParameterValues values = read_study(file_);
    EXPECT_EQ(values.text("cutter.file"), "Cutter Head (rev B).STL");
    EXPECT_EQ(values.text("cutter.unit"), "mm");
    EXPECT_EQ(values.text("name"), "my study");
    EXPECT_FALSE(values.has("tank.radius_m")) << "derived lengths stay derived";
    ASSERT_EQ(values.tables("feed").size(), 1u);
}

TEST(Study, defaults_follow_the_ring_radius) {
    const ParameterValues values = parse(with_feed("count = 3\n"));
    const HeadSize large{3.0 * k_model.ring_radius, 3.0 * k_model.tip_radius, 3.0 * k_model.depth};
    const ParameterValues small_head = resolve_study(values, k_model);
    const ParameterValues large_head = resolve_study(values, large);
    int followed = 0;
    for (const Parameter& parameter : study_table()) {
        if (parameter.repeated || parameter.unit != "m" || parameter.default_value || !small_head.has(parameter.key))
            continue;  // an instrument's lengths have no default without its points
        EXPECT_NEAR(large_head.number(parameter.key), 3.0 * small_head.number(parameter.key), 1e-12) << parameter.key;
        ++followed;
    }
    EXPECT_EQ(followed, 11);
    EXPECT_NEAR(large_head.tables("feed")[0].number("feed.depth_to_m"), 3.0 * 0.485, 1e-12);
    EXPECT_TRUE(check_study(small_head, k_model).empty());
    EXPECT_TRUE(check_study(large_head, large).empty());
}

TEST(Study, the_model_cutters_tank_is_that_of_the_experiment) {
    const ParameterValues resolved = resolve_study(parse(minimal()), k_model);
    const Study study = make_study(resolved, "/tmp");
    EXPECT_NEAR(2.0 * study.tank.radius, 5.0, 1e-12);
    EXPECT_NEAR(study.tank.height, 1.31, 1e-12);
    EXPECT_NEAR(study.water(k_model).z_min, -0.875, 1e-12);
    EXPECT_NEAR(study.water(k_model).z_max, 0.435, 1e-12);
    EXPECT_NEAR(study.report.bin_width, 0.03, 1e-12);
}

TEST(Study, is_in_si_units_and_radians) {
    const Study study = make_study(resolve_study(parse(with_feed("count = 5\nstart_revolution = 1.5\nazimuth_width_deg = 90\n") +
                                                       "[ladder]\ninclination_deg = 30\n[swing]\ndirection = \"under_cut\"\n"),
                                                 k_model),
                                   "/folder");
    EXPECT_NEAR(study.rotation_speed, 2.0 * k_pi, 1e-12);
    EXPECT_NEAR(study.period(), 1.0, 1e-12);
    EXPECT_NEAR(study.end_time(), 9.0, 1e-12);
    EXPECT_NEAR(study.inclination, k_pi / 6.0, 1e-12);
    EXPECT_EQ(study.cutter.file, "/folder/c.stl");
    ASSERT_EQ(study.feeds.size(), 1u);
    EXPECT_EQ(study.feeds[0].count, 5);
    EXPECT_FALSE(study.feeds[0].mass.has_value());
    EXPECT_NEAR(study.feeds[0].start, 1.5, 1e-12);
    EXPECT_NEAR(study.feeds[0].azimuth_width, k_pi / 2.0, 1e-12);
    EXPECT_NEAR(study.feeds[0].azimuth_centre, k_pi / 2.0, 1e-12);
    EXPECT_EQ(study.feeds[0].classes[0].density, 2650.0);
}

TEST(Study, a_left_handed_rotor_turns_the_other_way) {
    const Study study = make_study(resolve_study(parse("[rotor]\nspeed_rpm = 30\ndirection = \"left_handed\"\n[cutter]\nfile = \"c.stl\"\n"
                                                       "[suction]\ndischarge_m3_s = 0.1\n"),
                                                 k_model),
                                   "/");
    EXPECT_NEAR(study.rotation_speed, -k_pi, 1e-12);
    EXPECT_NEAR(study.period(), 2.0, 1e-12);
}

// At the bank's azimuth phi (0 lowest) a blade's velocity is omega x r: its downward part is omega (z x r) . x_down = -omega r sin(phi).
TEST(Study, blades_go_down_at_the_bank_when_over_cutting_and_up_when_under_cutting) {
    for (const char* rotor : {"right_handed", "left_handed"}) {
        const double omega = std::string(rotor) == "right_handed" ? 1.0 : -1.0;
        const auto downward = [&](const char* swing) { return -omega * std::sin(bank_azimuth_deg(swing, rotor) * k_pi / 180.0); };
        EXPECT_NEAR(downward("over_cut"), 1.0, 1e-12) << rotor;
        EXPECT_NEAR(downward("under_cut"), -1.0, 1e-12) << rotor;
    }
}

TEST(Study, pairs_of_materials_come_from_the_preset_where_the_file_is_silent) {
    const auto contact = [](const std::string& rock) {
        return make_study(resolve_study(parse(minimal("[rock]\n" + rock)), k_model), "/tmp").contact;
    };
    const coupling::ContactSettings gravel = contact(""), paper = contact("preset = \"paper\"\n"),
                                    mixed = contact("preset = \"paper\"\nfriction_steel = 0.4\nrolling_friction_rock = 0.3\n");
    EXPECT_EQ(gravel.rock_rock.friction, 0.5);
    EXPECT_EQ(gravel.rock_steel.friction, 0.35);
    EXPECT_EQ(gravel.rock_steel.rolling_friction, 0.1);
    EXPECT_EQ(gravel.rock_soil.friction, 0.6);
    EXPECT_EQ(gravel.rock_soil.rolling_friction, 0.15);
    for (const coupling::PairSettings& pair : {paper.rock_rock, paper.rock_steel, paper.rock_soil}) {
        EXPECT_EQ(pair.friction, 0.15);
        EXPECT_EQ(pair.restitution, 0.97);
        EXPECT_EQ(pair.rolling_friction, 0.0);
    }
    EXPECT_EQ(mixed.rock_steel.friction, 0.4);
    EXPECT_EQ(mixed.rock_rock.friction, 0.15);
    EXPECT_EQ(mixed.rock_rock.rolling_friction, 0.3);
    EXPECT_EQ(mixed.rock_steel.rolling_friction, 0.0);
    EXPECT_EQ(gravel.rolling_law, "spring");
}

TEST(Study, default_stiffness_keeps_the_overlap_at_tip_speed) {
    const ParameterValues resolved = resolve_study(parse(with_feed("count = 3\n")), k_model);
    const double modulus = resolved.number("rock.youngs_modulus_pa");
    const double radius = 0.01;
    const double volume = 4.0 / 3.0 * k_pi * radius * radius * radius;
    const physics::Impact impact{volume * (2650.0 + 0.5 * 998.2), radius, modulus / (2.0 - 0.24 * 0.24 - 0.27 * 0.27), 2.0 * k_pi * 0.4};
    EXPECT_NEAR(physics::hertz_largest_overlap(impact) / radius, 0.05, 1e-9);
    const ParameterValues given = resolve_study(parse(minimal("[rock]\nyoungs_modulus_pa = 1e7\n")), k_model);
    EXPECT_EQ(given.number("rock.youngs_modulus_pa"), 1e7);
    const std::string feed = "[[feed]]\ncount = 5\n[[feed.class]]\ndiameter_m = 0.02\n";
    const auto warnings = [&](const std::string& rock) { return warnings_of(minimal(rock + feed)); };
    EXPECT_FALSE(any_contains(warnings(""), "overlaps steel"));
    // Overlap goes with E^(-2/5).
    const std::string share = fmt::format("overlaps steel by {:.0f} %", 5.0 * std::pow(modulus / 1e7, 0.4));
    EXPECT_TRUE(any_contains(warnings("[rock]\nyoungs_modulus_pa = 1e7\n"), share)) << share;
}

TEST(Study, warns_of_floating_soil_and_of_runs_too_short_for_an_interval) {
    const auto warnings = [](const std::string& keys) {
        return warnings_of(
            minimal("[swing]\nspeed_m_min = 6\n[bank]\nmodel = \"wall\"\n[[feed]]\nkind = \"cut_face\"\nsize_law = "
                    "\"log_normal\"\nsize_d50_m = 0.02\nsize_spread = 0.5\nsize_min_m = 0.01\nsize_max_m = 0.03\n" +
                    keys));
    };
    // A revolution takes a second: 3 s of start-up and 8 batches of one after the first revolution.
    EXPECT_TRUE(any_contains(warnings("[run]\nflow_revolutions = 1\nmax_revolutions = 11.9\n"),
                             "Rock comes for 10.9 s; spillage has an interval after 11 s"));
    EXPECT_FALSE(any_contains(warnings("[run]\nflow_revolutions = 1\nmax_revolutions = 12\n"), "has an interval"));
    EXPECT_TRUE(any_contains(warnings("duration_s = 4\n[run]\nflow_revolutions = 1\nmax_revolutions = 12\n"), "Rock comes for 4 s"));
    EXPECT_TRUE(any_contains(warnings("[soil]\ngrain_density_kg_m3 = 900\n"), "soil.grain_density_kg_m3 = 900. Rock by a size_law"));
    EXPECT_FALSE(any_contains(warnings("[soil]\ngrain_density_kg_m3 = 1100\n"), "floats"));
}

TEST(Study, of_a_larger_head_follows_froude) {
    const double scale = 4.0;
    // Length, time and stiffness of the default at the larger head over those at the model.
    const std::map<std::string, double> factors = {
        {"m", scale}, {"s", std::sqrt(scale)}, {"m3/s", std::pow(scale, 2.5)}, {"rpm", 1.0 / std::sqrt(scale)}, {"Pa", scale}};
    const auto resolved = [](double rpm, double discharge, double diameter, const HeadSize& head) {
        return resolve_study(parse(fmt::format("[cutter]\nfile = \"c.stl\"\n[rotor]\nspeed_rpm = {}\n[suction]\ndischarge_m3_s = {}\n"
                                               "[[feed]]\ncount = 3\n[[feed.class]]\ndiameter_m = {}\n",
                                               rpm, discharge, diameter)),
                             head);
    };
    const ParameterValues small = resolved(60.0, 0.12, 0.02, k_model);
    const ParameterValues large = resolved(60.0 / std::sqrt(scale), 0.12 * std::pow(scale, 2.5), 0.02 * scale,
                                           {scale * k_model.ring_radius, scale * k_model.tip_radius, scale * k_model.depth});
    int lengths = 0;
    const auto compare = [&](const ParameterValues& a, const ParameterValues& b, bool repeated, const std::string& prefix) {
        for (const Parameter& parameter : study_table()) {
            if (parameter.kind != ParameterKind::number || parameter.repeated != repeated || parameter.key.rfind(prefix, 0) != 0 ||
                !a.has(parameter.key))
                continue;
            const auto factor = factors.find(parameter.unit);
            const double expected = (factor == factors.end() ? 1.0 : factor->second) * a.number(parameter.key);
            EXPECT_NEAR(b.number(parameter.key), expected, 1e-12 * std::abs(expected)) << parameter.key;
            lengths += parameter.unit == "m";
        }
    };
    compare(small, large, false, "");
    compare(small.tables("feed").at(0), large.tables("feed").at(0), true, "feed.");
    EXPECT_GE(lengths, 12);
}

TEST(Study, refuses_sizes_that_contradict_each_other) {
    const auto mistakes = [](const std::string& keys) { return check_study(resolve_study(parse(minimal(keys)), k_model), k_model); };
    EXPECT_TRUE(any_contains(mistakes("mouth_radius_m = 0.19\n"), "must lie inside the ring"));
    EXPECT_TRUE(any_contains(mistakes("backplate_radius_m = 0.31\n"), "must carry the pipe"));
    EXPECT_TRUE(any_contains(mistakes("[tank]\nheight_m = 0.9\n"), "Make the tank higher"));
    EXPECT_TRUE(any_contains(mistakes("[tank]\nradius_m = 0.5\n"), "1.5 times the radius of head (0.4 m)"));
    EXPECT_EQ(mistakes("mouth_offset_m = 0.31\n")[0].where, "study.toml:7") << "the key that the file gives";
    EXPECT_TRUE(any_contains(mistakes("[report]\noutflow_start_s = 9\n"), "The run ends at 9 s"));
    EXPECT_TRUE(
        any_contains(mistakes("[[feed]]\ncount = 1\ndepth_to_m = 0.6\n[[feed.class]]\ndiameter_m = 0.02\n"), "The head ends 0.485 m"));
    EXPECT_EQ(mistakes("mouth_radius_m = 0.19\n[tank]\nheight_m = 0.9\n[report]\noutflow_start_s = 9\n").size(), 4u)
        << "ring and backplate, tank, report";
    EXPECT_EQ(mistakes("mouth_radius_m = 0.19\n")[0].where, "study.toml:7");
}

TEST(Study, sizes_beside_a_refused_value_are_checked_without_it) {
    const ParameterValues values =
        parse_with_mistakes(study_table(),
                            minimal("mouth_radius_m = -1\n[tank]\nheight_m = 0.9\n[rock]\npreset = \"sand\"\n[swing]\ndirection = "
                                    "\"up\"\n[[feed]]\ncount = 1\ndepth_to_m = 0.6\nradius_from_m = -1\n[[feed.class]]\ndiameter_m = 3\n"),
                            "study.toml")
            .values;
    const std::vector<Mistake> mistakes = check_study(resolve_study(values, k_model), k_model);
    EXPECT_EQ(mistakes.size(), 2u);
    EXPECT_TRUE(any_contains(mistakes, "Make the tank higher"));
    EXPECT_TRUE(any_contains(mistakes, "Rock must be smaller than the head"));
}

TEST(Study, refuses_values_that_no_dredger_has) {
    const auto one = [](const std::string& text, const std::string& key) {
        try {
            parse(text);
            ADD_FAILURE() << text;
        } catch (const UserError& error) {
            EXPECT_EQ(error.mistakes().size(), 1u) << error.what();
            EXPECT_TRUE(any_contains(error.mistakes(), key)) << error.what();
        }
    };
    for (const char* diameter : {"1e300", "1e-300", "11", "9e-6"})
        one(with_feed("count = 3\n", std::string("diameter_m = ") + diameter + "\n"), "feed.class.diameter_m");
    for (const char* density : {"99", "30001", "1e300"})
        one(with_feed("count = 3\n", std::string("diameter_m = 0.02\ndensity_kg_m3 = ") + density + "\n"), "feed.class.density_kg_m3");
    for (const char* line :
         {"density_kg_m3 = 0.09", "density_kg_m3 = 20001", "kinematic_viscosity_m2_s = 9e-9", "kinematic_viscosity_m2_s = 2"})
        one(minimal(std::string("[fluid]\n") + line + "\n"), "fluid.");
    for (const char* line : {"max_revolutions = 1e-300", "max_revolutions = 10001", "max_courant = 1e-9", "flow_revolutions = 1e300"})
        one(minimal(std::string("[run]\n") + line + "\n"), "run.");
    one(minimal("[scale]\nlength_ratio = 1e-300\n"), "scale.length_ratio");
    one(minimal("[tank]\nheight_m = 1e300\n"), "tank.height_m");
    one(minimal("[report]\noutflow_offset_m = 1e300\n"), "report.outflow_offset_m");
    one("cutter.file = \"c.stl\"\nrotor.speed_rpm = 1e-300\nsuction.discharge_m3_s = 0.12\n", "rotor.speed_rpm");
    one("cutter.file = \"\"\nrotor.speed_rpm = 60\nsuction.discharge_m3_s = 0.12\n", "cutter.file");
}

TEST(Study, records_whole_revolutions_before_the_rock) {
    const auto mistakes = [](const std::string& text) { return check_study(resolve_study(parse(text), k_model), k_model); };
    const std::string feed = with_feed("count = 3\n");
    EXPECT_TRUE(mistakes(feed + "[run]\nrecord_revolutions = 1\n").empty());
    EXPECT_TRUE(any_contains(mistakes(feed + "[run]\nrecord_revolutions = 0.5\n"), "all its phases in one revolution"));
    EXPECT_TRUE(any_contains(mistakes(feed + "[run]\nrecord_revolutions = 7\n"), "at most the flow before the rock"));
    EXPECT_TRUE(any_contains(mistakes(minimal("[run]\nrecord_revolutions = 1\n")), "A recording ends where rock comes in"));
}

TEST(Study, refuses_sizes_out_of_proportion_to_the_head) {
    const auto only = [](const std::string& keys, const std::string& rule) {
        const std::vector<Mistake> mistakes = check_study(resolve_study(parse(minimal(keys)), k_model), k_model);
        EXPECT_EQ(mistakes.size(), 1u) << keys;
        EXPECT_TRUE(any_contains(mistakes, rule)) << keys;
    };
    const auto none = [](const std::string& keys) {
        EXPECT_TRUE(check_study(resolve_study(parse(minimal(keys)), k_model), k_model).empty()) << keys;
    };
    only("[tank]\nradius_m = 20.1\n", "at most 50 ring radii, 20 m");
    only("[tank]\nheight_m = 20.1\n", "at most 50 ring radii, 20 m");
    none("[tank]\nradius_m = 20\nheight_m = 20\n");
    only("backplate_thickness_m = 3.9e-4\n", "0.0004 m, thick");
    only("pipe_wall_m = 1e-300\n", "0.0004 m, thick");
    none("backplate_thickness_m = 4.1e-4\npipe_wall_m = 4.1e-4\n");
    only("[report]\nbin_width_m = 4.8e-4\n", "at most 1000 are counted");
    none("[report]\nbin_width_m = 4.9e-4\n");
    only("[report]\noutflow_offset_m = 2.2\n", "the water ends at tank.radius_m = 2.5");  // 0.40 + 2.2 > 2.5
    only("[run]\nwrite_interval_s = 8.9e-4\n", "at most 10000");                          // of 9 s
    only("[run]\ncheckpoint_interval_s = 1e-300\n", "at most 10000");
    none("[run]\nwrite_interval_s = 9.1e-4\n");
    // A rock of 20 mm and 2650 kg/m3 has 11.1 g.
    only("[[feed]]\nmass_kg = 0.005\n[[feed.class]]\ndiameter_m = 0.02\n", "less than half a rock");
    none("[[feed]]\nmass_kg = 0.006\n[[feed.class]]\ndiameter_m = 0.02\n");
    only("[[feed]]\ncount = 1\n[[feed.class]]\ndiameter_m = 0.8\n", "whose diameter is 0.8 m");
}

TEST(Study, warns_of_rock_that_meets_a_flow_which_remembers_its_start) {
    const auto warnings = [](const std::string& text) { return warnings_of(text); };
    const char* warning = "start_revolution = 5.5. For some 6 revolutions the flow remembers the frozen rotor";
    EXPECT_TRUE(any_contains(warnings(with_feed("count = 3\n") + "[run]\nflow_revolutions = 5.5\n"), warning));
    EXPECT_TRUE(any_contains(warnings(with_feed("count = 3\nstart_revolution = 5.5\n")), warning));
    EXPECT_FALSE(any_contains(warnings(with_feed("count = 3\n")), "remembers"));
    EXPECT_FALSE(any_contains(warnings(minimal("[run]\nflow_revolutions = 1\n")), "remembers"));
}

TEST(Study, develops_the_flow_in_longer_steps_until_a_revolution_before_it_is_looked_at) {
    const auto end = [](const std::string& text) {  // the period is 1 s
        return make_study(resolve_study(parse(text), k_model), "/tmp").development_end();
    };
    const std::string feed = with_feed("count = 3\n");
    EXPECT_NEAR(end(feed), 5.0, 1e-12);
    EXPECT_NEAR(end(feed + "[run]\nrecord_revolutions = 1\n"), 4.0, 1e-12);
    EXPECT_NEAR(end(feed + "[run]\nflow_revolutions = 0.5\n"), 0.0, 1e-12);
    EXPECT_NEAR(end(with_feed("count = 3\nstart_revolution = 3\n")), 2.0, 1e-12);
    EXPECT_NEAR(end(feed + "[report]\noutflow_start_s = 2.5\n"), 1.5, 1e-12);
    EXPECT_NEAR(end(minimal()), 5.0, 1e-12);
    EXPECT_NEAR(end(minimal("[run]\nmax_revolutions = 4\n")), 1.0, 1e-12);  // averaged from half of it on
}

TEST(Study, warns_of_rock_larger_than_a_third_of_the_passage) {
    const auto warnings = [](const std::string& diameter) {
        return warnings_of(with_feed("count = 3\n", "diameter_m = " + diameter + "\n"));
    };
    EXPECT_TRUE(any_contains(warnings("0.07"), "third of the smallest passage (0.2 m, the suction mouth)"));
    EXPECT_FALSE(any_contains(warnings("0.066"), "third of the smallest passage"));
    HeadSize narrow = k_model;
    narrow.passage = 0.15;
    EXPECT_TRUE(any_contains(warnings_of(with_feed("count = 3\n", "diameter_m = 0.055\n"), narrow),
                             "third of the smallest passage (0.15 m, between the blades)"));
}

TEST(Study, warns_of_kernels_that_average_over_mouth_or_gap) {
    const auto warnings = [](const std::string& keys, const std::string& diameter) {
        return warnings_of(keys + with_feed("count = 3\n", "diameter_m = " + diameter + "\n"));
    };
    // mouth radius 0.1 m, gap 0.03 m
    const std::string shell = "[kernel]\nsampling = \"quadratic\"\n";
    EXPECT_TRUE(any_contains(warnings(shell, "0.026"), "suction.mouth_radius_m = 0.1. It is 3.8 times the kernel width"));
    EXPECT_TRUE(any_contains(warnings(shell, "0.02"), "suction.mouth_radius_m = 0.1. It is 5 times the kernel width"));
    EXPECT_TRUE(any_contains(warnings(shell, "0.02"), "suction.gap_m = 0.03. It is 1.5 times the kernel width"));
    EXPECT_FALSE(any_contains(warnings("", "0.02"), "suction.mouth_radius_m"));
    EXPECT_TRUE(any_contains(warnings("", "0.02"), "are spread past the opening. Compare with kernel.gamma = 0.5"));
    EXPECT_FALSE(any_contains(warnings_of(minimal()), "times the kernel width")) << "there is no rock";
    // Draft cells of 0.387 x 0.075 x 0.4 m make the kernel of small rock 17.4 mm wide.
    EXPECT_TRUE(
        any_contains(warnings(shell, "0.00425"), "suction.mouth_radius_m = 0.1. It is 5.7 times the kernel width in cells of 0.012 m"));
    EXPECT_TRUE(any_contains(warnings("", "0.0075"), "suction.gap_m = 0.03. It is 1.7 times the kernel width in cells of 0.012 m"));
    EXPECT_TRUE(any_contains(warnings("", "0.0075"), "Compare with smaller cells"));
    const std::string fine = "[mesh]\npreset = \"paper\"\n";
    EXPECT_FALSE(any_contains(warnings(fine + shell, "0.004"), "suction.mouth_radius_m"));
    EXPECT_TRUE(any_contains(warnings(fine + shell, "0.006"), "suction.gap_m = 0.03. It is 5 times the kernel width of rock of 0.006 m"));
    EXPECT_FALSE(any_contains(warnings(fine, "0.006"), "times the kernel width"));
}

TEST(Study, warns_of_a_drag_that_counts_other_rock_twice_or_not_at_all) {
    const auto warnings = [](const std::string& closures, const std::string& feed) {
        const std::string rock = with_feed(feed + "count = 3\n", "diameter_m = 0.004\n");
        return warnings_of(rock + "[mesh]\npreset = \"paper\"\n[closures]\n" + closures);  // cells in which its kernel is narrow
    };
    EXPECT_TRUE(warnings("", "").empty());
    EXPECT_TRUE(any_contains(warnings("drag_modifier = 3\n", ""), "counts it twice"));
    EXPECT_TRUE(any_contains(warnings("drag_modifier = 3\ndrag = \"gidaspow\"\nhindrance = \"none\"\n", ""), "counts it twice"));
    EXPECT_TRUE(warnings("drag_modifier = 3\nhindrance = \"none\"\n", "").empty());
    EXPECT_TRUE(any_contains(warnings("hindrance = \"none\"\n", ""), "the drag of a single rock is too small"));
    EXPECT_TRUE(warnings("hindrance = \"none\"\n", "spacing_diameters = 2.5\n").empty()) << "a solid fraction of 0.034";
}

TEST(Study, resolved_values_read_back_as_the_same_study) {
    const ParameterValues resolved = resolve_study(
        parse(with_feed("mass_kg = 4.08\n", "diameter_m = 0.02\n[[feed.class]]\ndiameter_m = 0.01\nmass_share = 2\n")), k_model);
    const ParameterValues again = parse(commented_toml(study_table(), &resolved));
    for (const Parameter& parameter : study_table()) {
        if (parameter.repeated) continue;
        ASSERT_EQ(again.has(parameter.key), resolved.has(parameter.key)) << parameter.key;
        if (again.has(parameter.key)) {
            EXPECT_TRUE(*again.find(parameter.key) == *resolved.find(parameter.key)) << parameter.key;
        }
    }
    ASSERT_EQ(again.tables("feed").size(), 1u);
    EXPECT_EQ(again.tables("feed")[0].tables("feed.class").size(), 2u);
    EXPECT_EQ(again.tables("feed")[0].number("feed.mass_kg"), 4.08);
}

TEST(Study, every_example_reads) {
    int studies = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples")) {
        if (entry.path().extension() != ".toml" || entry.path().filename().string().rfind("study", 0) != 0) continue;
        if (!kind_named_in(entry.path()).empty()) continue;
        const ParameterValues values = read_study(entry.path());
        EXPECT_TRUE(check_study(resolve_study(values, k_model), k_model).empty()) << entry.path();
        ++studies;
    }
    EXPECT_GE(studies, 1);
}

TEST(Study, the_demo_is_the_reference_experiments_batch) {
    const fs::path file = fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/model_cutter/study.toml";
    const Study study = make_study(resolve_study(read_study(file), k_model), file.parent_path());
    ASSERT_EQ(study.feeds.size(), 1u);
    EXPECT_EQ(study.feeds[0].count, 368);
    EXPECT_NEAR(study.feeds[0].spacing * study.feeds[0].classes[0].diameter, 0.03, 1e-12);
    EXPECT_NEAR(study.feeds[0].start, study.period(), 1e-12);
    EXPECT_NEAR(study.end_time(), 2.0, 1e-12);
    EXPECT_NEAR(study.suction.discharge, 0.12, 1e-12);
}

TEST(Study, every_key_is_documented) {
    for (const Parameter& parameter : study_table()) {
        EXPECT_GT(parameter.help.size(), 10u) << parameter.key;
        EXPECT_EQ(parameter.help.back(), '.') << parameter.key;
        EXPECT_NE(parameter.optional, parameter.derived_from.empty()) << parameter.key;
    }
}

TEST(Study, the_manual_page_is_that_of_the_table) {
    EXPECT_EQ(read_file(fs::path(CUTTERFLOW_SOURCE_DIR) / "docs/user/study_file.md"), study_manual_page())
        << "build the target update_manual";
}
