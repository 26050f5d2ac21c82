// Whatever the study's check accepts, the solver accepts: over the bounds and the choices of every key.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "cases/scenes/cutter/study_case.hpp"
#include "cases/study/study.hpp"
#include "cases/study/study_section.hpp"

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

TEST(StudySpelling, of_the_solvers_keys_has_words_apart_and_the_unit_behind) {
    EXPECT_EQ(snake_case("minWidthInCells"), "min_width_in_cells");
    EXPECT_EQ(k_contact_section.key_of(coupling::setting_table<coupling::ContactSettings>().front()), "rock.youngs_modulus_pa");
}

}  // namespace
}  // namespace cutterflow::cases
