// Every closure of the catalogue: finite in its range, cited, found by name.
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "solver/physics/catalogue.hpp"

namespace cutterflow::physics {
namespace {

class EveryClosure : public ::testing::TestWithParam<Closure> {};

TEST_P(EveryClosure, is_finite_and_but_for_lift_positive_over_its_range) {
    const Closure& closure = GetParam();
    constexpr int n = 7;
    int points = 1;
    for (std::size_t i = 0; i < closure.ranges.size(); ++i) points *= n;
    for (int point = 0; point < points; ++point) {
        std::vector<double> arguments;
        int rest = point;
        for (const ClosureRange& range : closure.ranges) {
            arguments.push_back(range.minimum + (range.maximum - range.minimum) * (rest % n) / (n - 1.0));
            rest /= n;
        }
        const double value = closure.evaluate(arguments);
        EXPECT_TRUE(std::isfinite(value)) << closure.name;
        if (closure.kind != ClosureKind::lift) EXPECT_GE(value, 0.0) << closure.name;
    }
}

TEST_P(EveryClosure, cites_an_entry_of_the_bibliography) {
    std::ifstream file(CUTTERFLOW_SOURCE_DIR "/docs/references.bib");
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_NE(text.str().find("{" + std::string(GetParam().citation) + ","), std::string::npos) << GetParam().citation;
}

TEST_P(EveryClosure, is_found_by_its_name) {
    EXPECT_EQ(find_closure(GetParam().kind, GetParam().name).equation, GetParam().equation);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryClosure, ::testing::ValuesIn(catalogue()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Catalogue, names_the_known_ones_when_asked_for_another) {
    try {
        find_drag_law("stokes");
        FAIL();
    } catch (const std::out_of_range& error) {
        EXPECT_NE(std::string(error.what()).find("brown_lawler"), std::string::npos);
    }
}

TEST(Catalogue, knows_what_lies_outside_a_range) {
    const Closure& hindrance = find_closure(ClosureKind::hindrance, "di_felice");
    EXPECT_EQ(hindrance.outside({0.9, 1e3}), nullptr);
    EXPECT_EQ(hindrance.outside({0.2, 1e3})->argument, "void_fraction");
    EXPECT_EQ(hindrance.outside({0.9, 3e5})->argument, "Re_p");
    EXPECT_EQ(hindrance.outside({0.9, std::nan("")})->argument, "Re_p");
}

TEST(Catalogue, hands_out_the_functions_themselves) {
    EXPECT_EQ(find_drag_law("brown_lawler"), &brown_lawler_drag_coefficient);
    EXPECT_EQ(find_hindrance_law("di_felice"), &di_felice_factor);
    EXPECT_EQ(find_hindrance_law("none"), &no_hindrance);
    EXPECT_EQ(find_lift_law("mei"), &mei_lift_coefficient);
    EXPECT_EQ(find_lift_law("none"), nullptr);
}

TEST(Catalogue, hands_a_drag_law_its_numbers_by_name) {
    EXPECT_DOUBLE_EQ(find_closure(ClosureKind::drag, "gidaspow").evaluate({50.0, 0.6}), gidaspow_drag_coefficient({50.0, 0.6}));
    EXPECT_DOUBLE_EQ(find_closure(ClosureKind::drag, "haider_levenspiel").evaluate({50.0, 0.8}),
                     haider_levenspiel_drag_coefficient({50.0, 1.0, 0.8}));
}

TEST(Catalogue, offers_none_where_a_closure_may_be_left_out) {
    EXPECT_EQ(closure_choices(ClosureKind::lift), (std::vector<std::string>{"mei", "none"}));
    EXPECT_EQ(closure_choices(ClosureKind::drag), closure_names(ClosureKind::drag));
}

TEST(Catalogue, knows_which_drag_laws_hold_the_void_fraction) {
    EXPECT_TRUE(drag_law_holds_void_fraction("gidaspow"));
    EXPECT_TRUE(drag_law_holds_void_fraction("koch_hill"));
    for (const char* name : {"brown_lawler", "schiller_naumann", "haider_levenspiel", "unknown"})
        EXPECT_FALSE(drag_law_holds_void_fraction(name)) << name;
}

TEST(Catalogue, names_every_number_that_a_law_of_rock_asks_for) {
    for (const Closure& closure : catalogue())
        if (closure.kind == ClosureKind::drag || closure.kind == ClosureKind::hindrance || closure.kind == ClosureKind::lift)
            for (const ClosureRange& range : closure.ranges) EXPECT_NO_THROW(RockNumbers{}.named(range.argument)) << range.argument;
    EXPECT_THROW(RockNumbers{}.named("St"), std::out_of_range);
}

}  // namespace
}  // namespace cutterflow::physics
