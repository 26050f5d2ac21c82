// Whatever the study's check accepts, the solver accepts: over the bounds and the choices of every key.
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <gtest/gtest.h>

#include "cases/scenes/cutter/study_case.hpp"
#include "cases/scenes/room/room_study.hpp"
#include "cases/study/study.hpp"
#include "cases/study/study_section.hpp"
#include "geometry/base/parameters/parameter_words.hpp"

namespace cutterflow::cases {
namespace {

const HeadSize k_head{0.40, 0.40, 0.485};

geometry::Contour contour() {
    return geometry::Contour({-0.485, -0.2, 0.0}, {0.15, 0.38, 0.40}, 0.40, 0.03);
}

ParameterValues plain_study() {
    return parse_parameters(study_table(), R"(
cutter.file = "cutter.stl"
rotor.speed_rpm = 60
suction.discharge_m3_s = 0.12
swing.speed_m_min = 6
bank.model = "wall"
closures.hindrance = "none"
[[feed]]
count = 5
[[feed.class]]
diameter_m = 0.02
)",
                            "study.toml");
}

/// Both bounds of a parameter, or what is nearest to them, and points between them and beyond an open end.
std::vector<double> numbers_of(const Parameter& parameter) {
    const double most = parameter.maximum.value_or(1e6), least = parameter.minimum.value_or(-1e6);
    const double first = parameter.minimum_excluded ? std::nextafter(least, most) : least;
    std::vector<double> numbers{first, most, 0.5 * (first + most), first + 1e-6 * (most - first), most - 1e-6 * (most - first)};
    for (const double value : {1e-9, 1e-6, 1e-3, 0.1, 0.3, 0.5, 0.9, 1.0, 2.0, 10.0, 1e3})
        if (value > least && value <= most) numbers.push_back(value);
    return numbers;
}

std::vector<ParameterValue> values_of(const Parameter& parameter) {
    std::vector<ParameterValue> values;
    switch (parameter.kind) {
        case ParameterKind::number:
            for (const double number : numbers_of(parameter)) values.emplace_back(number);
            break;
        case ParameterKind::integer:
            for (const double number : numbers_of(parameter)) values.emplace_back(static_cast<std::int64_t>(std::ceil(number)));
            break;
        case ParameterKind::choice:
            for (const std::string& choice : parameter.choices) values.emplace_back(choice);
            break;
        case ParameterKind::boolean:
            values = {true, false};
            break;
        case ParameterKind::text:
        case ParameterKind::path:
        case ParameterKind::numbers:
        case ParameterKind::texts:
            break;
    }
    return values;
}

/// As `cutterflow check` sees it: every value by its row, then the rules across keys, first those of the file.
bool is_accepted(const Parameter& parameter, const ParameterValues& study) {
    return !value_mistake(parameter, *study.find(parameter.key)) && check_file_rules(study, "study.toml").empty() &&
           check_study(resolve_study(study, k_head), k_head).empty();
}

std::string texts_of(const std::vector<Mistake>& mistakes) {
    std::string text;
    for (const Mistake& mistake : mistakes) text += mistake.text() + "\n";
    return text;
}

class EveryKey : public ::testing::TestWithParam<Parameter> {};

TEST_P(EveryKey, is_accepted_by_the_solver_when_the_study_is) {
    const Parameter& parameter = GetParam();
    int accepted = 0;
    for (const ParameterValue& value : values_of(parameter)) {
        ParameterValues study = plain_study();
        study.set(parameter.key, value);
        if (!is_accepted(parameter, study)) continue;
        ++accepted;
        const CaseInputs inputs = case_inputs_of(make_study(resolve_study(study, k_head), "/tmp"), k_head, contour(), 2);
        EXPECT_EQ(texts_of(check_case_inputs(inputs)), "") << parameter.key << " = " << toml_text(value);
    }
    EXPECT_GT(accepted, 0);
}

std::vector<Parameter> keys() {
    std::vector<Parameter> keys;
    for (const Parameter& parameter : study_table())
        if (!parameter.repeated && !values_of(parameter).empty()) keys.push_back(parameter);
    return keys;
}

std::string test_name(const ::testing::TestParamInfo<Parameter>& info) {
    std::string name = info.param.key;
    for (char& letter : name)
        if (letter == '.') letter = '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Study, EveryKey, ::testing::ValuesIn(keys()), test_name);

/// A value of every setting that a study gives reaches the solver's struct, and one step outside the bounds is refused by both.
template <class Settings>
void expect_one_rule(const StudySection<Settings>& section, Settings CaseInputs::*member) {
    for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>()) {
        if (!section.offers(setting)) continue;
        const std::string key = section.key_of(setting);
        const auto& table = study_table();
        const auto row = std::find_if(table.begin(), table.end(), [&](const Parameter& parameter) { return parameter.key == key; });
        ASSERT_NE(row, table.end()) << key;
        for (const ParameterValue& value : values_of(*row)) {
            ParameterValues study = plain_study();
            study.set(key, value);
            const CaseInputs inputs = case_inputs_of(make_study(resolve_study(study, k_head), "/tmp"), k_head, contour(), 1);
            EXPECT_EQ(setting.value_in(inputs.*member), value) << key;
        }
        for (const auto& [bound, outwards] : {std::pair(setting.parameter.minimum, -1.0), std::pair(setting.parameter.maximum, 1.0)}) {
            if (!bound) continue;
            const double outside = std::nextafter(*bound, outwards * std::numeric_limits<double>::infinity());
            Settings settings;
            setting.assign(settings, outside);
            EXPECT_EQ(coupling::setting_mistakes(settings, "section", "file").size(), 1u) << key << " = " << outside;
            EXPECT_TRUE(value_mistake(*row, outside)) << key << " = " << outside;
        }
    }
}

TEST(Settings, of_kernel_and_closures_have_one_rule_in_study_and_solver) {
    expect_one_rule(k_kernel_section, &CaseInputs::kernel);
    expect_one_rule(k_closure_section, &CaseInputs::closures);
}

TEST(Settings, narrower_than_the_kernel_can_be_are_refused_by_the_study) {
    for (const char* line : {"kernel.gamma = 0.3", "kernel.min_width_in_cells = 0.7"}) {
        const std::string study = "cutter.file = \"a.stl\"\nrotor.speed_rpm = 60\nsuction.discharge_m3_s = 0.1\n" + std::string(line);
        EXPECT_THROW(parse_parameters(study_table(), study, "study.toml"), UserError) << line;
    }
}

TEST(Settings, that_count_the_void_fraction_twice_are_named_with_the_word_that_was_given) {
    ParameterValues study = plain_study();
    study.set("closures.drag", std::string("gidaspow"));
    study.set("closures.hindrance", std::string("di_felice"));
    const std::vector<Mistake> mistakes = check_study(resolve_study(study, k_head), k_head);
    ASSERT_EQ(mistakes.size(), 1u);
    EXPECT_EQ(mistakes[0].what, "closures.hindrance = \"di_felice\"");
}

TEST(Settings, of_maps_that_a_turning_mesh_cannot_have_are_refused_by_the_study) {
    ParameterValues study = plain_study();
    study.set("kernel.map", std::string("cluster"));
    study.set("kernel.cluster_size_m", 0.06);
    const std::vector<Mistake> mistakes = check_study(resolve_study(study, k_head), k_head);
    ASSERT_EQ(mistakes.size(), 2u);
    EXPECT_EQ(mistakes[0].what, "kernel.map = \"cluster\"");
    EXPECT_EQ(mistakes[1].what, "kernel.cluster_size_m = 0.06");
    study = plain_study();
    study.set("kernel.map", std::string("centroid"));
    EXPECT_TRUE(check_study(resolve_study(study, k_head), k_head).empty());
}

TEST(StudySpelling, of_the_solvers_keys_has_words_apart_and_the_unit_behind) {
    EXPECT_EQ(snake_case("minWidthInCells"), "min_width_in_cells");
    EXPECT_EQ(k_contact_section.key_of(coupling::setting_table<coupling::ContactSettings>().front()), "rock.youngs_modulus_pa");
}

// ---- rooms ----

ParameterValues plain_room() {
    return parse_parameters(room_table(), R"(
[room]
size_m = [0.1, 0.1, 0.16]
[[material]]
name = "glass"
youngs_modulus_pa = 5e6
[[contact]]
pair = ["glass", "glass"]
friction = 0.3
restitution = 0.9
[[contact]]
pair = ["glass", "steel"]
friction = 0.3
restitution = 0.9
[[grains]]
name = "beads"
material = "glass"
density_kg_m3 = 2500
diameter_m = 0.004
[[event]]
do = "feed"
grains = "beads"
from_s = 0
to_s = 1
rate_kg_s = 0.01
region = { box = { lower_m = [-0.04, -0.04, 0.1], upper_m = [0.04, 0.04, 0.15] } }
[run]
end_s = 4
)",
                            "room.toml");
}

ParameterValues room_with(const Parameter& parameter, const ParameterValue& value) {
    ParameterValues study = plain_room();
    const std::string array = parameter_words::enclosing_array(room_table(), parameter.key);
    (array.empty() ? study : study.tables_for_writing(array).front()).set(parameter.key, value);
    return study;
}

/// The scene of a study that the check accepts.
std::optional<RoomScene> accepted_room(const Parameter& parameter, const ParameterValue& value) {
    if (value_mistake(parameter, value)) return std::nullopt;
    try {
        return room_scene(room_with(parameter, value), "/tmp");
    } catch (const UserError&) {
        return std::nullopt;
    }
}

/// What the solver says of the scene's settings.
std::vector<Mistake> solver_mistakes(const RoomScene& scene) {
    coupling::DemSettings dem;
    dem.contact = scene.contact;
    for (const RoomPair& pair : scene.pairs)
        (pair.other == scene.grain_material ? dem.contact.rock_rock : dem.contact.rock_steel) = pair.settings;
    dem.domain.lower = scene.lower();
    dem.domain.upper = scene.upper();
    dem.fluid = {scene.medium.density, scene.medium.kinematic_viscosity};
    coupling::CouplingSettings settings;
    settings.has_rock = true;
    settings.has_medium = scene.medium.present();
    settings.rock_feed = "rockFeed.csv";
    settings.kernel = scene.kernel;
    settings.closures = scene.closures;
    settings.checkpoint = coupling::CheckpointSettings{scene.run.checkpoint_interval};
    std::vector<Mistake> mistakes = coupling::check_settings(settings, dem.fluid, "");
    for (Mistake& mistake : coupling::check_settings(dem, "")) mistakes.push_back(std::move(mistake));
    return mistakes;
}

class EveryRoomKey : public ::testing::TestWithParam<Parameter> {};

TEST_P(EveryRoomKey, is_accepted_by_the_solver_when_the_study_is) {
    int accepted = 0;
    for (const ParameterValue& value : values_of(GetParam())) {
        const std::optional<RoomScene> scene = accepted_room(GetParam(), value);
        if (!scene) continue;
        ++accepted;
        EXPECT_EQ(texts_of(solver_mistakes(*scene)), "") << GetParam().key << " = " << toml_text(value);
    }
    EXPECT_GT(accepted, 0);
}

/// Those of solids, boundaries and steps stand for geometry and times, of which the solver has no bounds of its own.
std::vector<Parameter> room_keys() {
    std::vector<Parameter> keys;
    for (const Parameter& parameter : room_table())
        for (const char* section : {"room", "material", "contact", "dem", "grains", "run", "kernel", "closures"})
            if (parameter_words::section_of(parameter.key) == section && !values_of(parameter).empty()) keys.push_back(parameter);
    return keys;
}

INSTANTIATE_TEST_SUITE_P(Room, EveryRoomKey, ::testing::ValuesIn(room_keys()), test_name);

TEST(Settings, of_contacts_have_the_solvers_bounds_in_rooms) {
    using Contact = StudySection<coupling::ContactSettings>;
    using Pair = StudySection<coupling::PairSettings>;
    const std::map<std::string, Parameter> solver{{"material.youngs_modulus_pa", Contact::row("youngsModulus")},
                                                  {"material.poisson", Contact::row("poissonRock")},
                                                  {"contact.friction", Pair::row("friction")},
                                                  {"contact.rolling", Pair::row("rollingFriction")},
                                                  {"contact.restitution", Pair::row("restitution")},
                                                  {"dem.rolling_law", Contact::row("rollingLaw")},
                                                  {"dem.time_step_fraction", Contact::row("timeStepFraction")},
                                                  {"dem.max_speed_m_s", Contact::row("maxSpeed")}};
    std::size_t compared = 0;
    for (const Parameter& row : room_table()) {
        const auto found = solver.find(row.key);
        if (found == solver.end()) continue;
        ++compared;
        EXPECT_EQ(row.minimum, found->second.minimum) << row.key;
        EXPECT_EQ(row.minimum_excluded, found->second.minimum_excluded) << row.key;
        EXPECT_EQ(row.maximum, found->second.maximum) << row.key;
        EXPECT_EQ(row.choices, found->second.choices) << row.key;
    }
    EXPECT_EQ(compared, solver.size());
}

}  // namespace
}  // namespace cutterflow::cases
