// Every closure of the catalogue: finite in its range, cited, found by name.
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "solver/physics/catalogue.hpp"

namespace cutterflow::physics {
namespace {

class EveryClosure : public ::testing::TestWithParam<Closure> {};

TEST_P(EveryClosure, is_finite_and_positive_over_its_range) {
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
        EXPECT_GE(value, 0.0) << closure.name;
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
}

}  // namespace
}  // namespace cutterflow::physics
