// Tasks that run side by side.
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/base/process/side_by_side.hpp"

using cutterflow::side_by_side;

TEST(SideBySide, does_every_task_once) {
    std::vector<std::atomic<int>> calls(100);
    side_by_side(calls.size(), 4, [&](std::size_t i) { ++calls[i]; });
    for (const std::atomic<int>& one : calls) EXPECT_EQ(one, 1);
    side_by_side(0, 4, [](std::size_t) { FAIL(); });
}

TEST(SideBySide, passes_on_a_failure_and_begins_nothing_more) {
    std::atomic<int> begun{0};
    std::atomic<bool> fails{false};
    const auto task = [&](std::size_t i) {
        ++begun;
        if (i == 0) {
            fails = true;
            throw std::runtime_error("the first");
        }
        while (!fails) std::this_thread::yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));  // until the failure is known
    };
    try {
        side_by_side(100000, 4, task);
        FAIL() << "the failure was lost";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "the first");
    }
    EXPECT_LT(begun, 1000) << "as many as there are jobs";
}
