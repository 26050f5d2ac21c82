// Tasks that run side by side.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/side_by_side.hpp"
#include "geometry/base/process/stop_signals.hpp"

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

TEST(SideBySide, runs_no_more_at_a_time_than_there_may_be_children) {
    std::mutex mutex;
    std::size_t running = 0, most = 0;
    side_by_side(600, 600, [&](std::size_t) {
        {
            const std::lock_guard<std::mutex> lock(mutex);
            most = std::max(most, ++running);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        const std::lock_guard<std::mutex> lock(mutex);
        --running;
    });
    EXPECT_LE(most, cutterflow::k_most_children);
    EXPECT_GT(most, cutterflow::k_most_children / 4);
}

// The second child begins when no other runs any more.
TEST(SideBySide, does_not_forget_a_stop_signal_between_two_children) {
    std::atomic<bool> has_stopped{false};
    const auto task = [&](std::size_t i) {
        if (i == 1) {
            while (!has_stopped) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            cutterflow::run_child({{"sleep", "20"}, {}, {}, {}});
            return;
        }
        const auto stop = [](const std::string&) { std::raise(SIGINT); };
        EXPECT_THROW(cutterflow::run_child({{"sh", "-c", "trap 'exit 0' INT; echo ready; while :; do sleep 0.05; done"}, {}, {}, {}}, stop),
                     cutterflow::Interrupted);
        has_stopped = true;
    };
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THROW(side_by_side(2, 2, task), cutterflow::Interrupted);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
}

TEST(SideBySide, is_stopped_by_a_signal_while_no_child_runs) {
    std::atomic<int> begun{0};
    EXPECT_THROW(side_by_side(10, 1,
                              [&](std::size_t) {
                                  ++begun;
                                  std::raise(SIGTERM);
                              }),
                 cutterflow::Interrupted);
    EXPECT_EQ(begun, 1);
}
