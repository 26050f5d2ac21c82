#include <gtest/gtest.h>
#include <sched.h>

#include "cases/runner/machine.hpp"

namespace cutterflow::cases {
namespace {

/// A batch system, or taskset, may give a job fewer cores than the machine has.
TEST(Machine, counts_the_cores_that_it_may_use) {
    cpu_set_t before;
    ASSERT_EQ(::sched_getaffinity(0, sizeof before, &before), 0);
    EXPECT_EQ(available_cores(), CPU_COUNT(&before));
    int first = 0;
    while (!CPU_ISSET(first, &before)) ++first;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    ASSERT_EQ(::sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(available_cores(), 1);
    ::sched_setaffinity(0, sizeof before, &before);
}

}  // namespace
}  // namespace cutterflow::cases
