/// A tenth of the axis study: three of its roughest heads, two of them with picks.
#include <gtest/gtest.h>

#include "validation/studies/heads/axis_check.hpp"

namespace cutterflow::validation {
namespace {

class FamilyAxis : public ::testing::TestWithParam<int> {};

TEST_P(FamilyAxis, is_found_within_a_tenth_of_a_degree_and_a_thousandth_of_the_radius) {
    const AxisCheck check = check_axis(GetParam());
    EXPECT_TRUE(check.passed()) << table_header() << '\n' << table_row(GetParam(), check);
}

INSTANTIATE_TEST_SUITE_P(Heads, FamilyAxis, ::testing::Values(3, 7, 11));

}  // namespace
}  // namespace cutterflow::validation
