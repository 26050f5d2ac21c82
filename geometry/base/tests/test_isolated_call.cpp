#include "geometry/base/process/isolated_call.hpp"

#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include <gtest/gtest.h>

using namespace cutterflow;

TEST(IsolatedCall, returns_the_bytes_of_the_work_whatever_their_number) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{1000000}}) {
        const IsolatedResult result = call_isolated([size] { return std::string(size, '\0'); }, 10.0);
        EXPECT_EQ(result.death, "");
        EXPECT_EQ(result.bytes, std::string(size, '\0'));
    }
}

TEST(IsolatedCall, survives_the_death_of_the_work_and_says_how_it_ended) {
    const auto death = [](void (*work)(), double limit_s) {
        return call_isolated(
                   [work] {
                       work();
                       return std::string();
                   },
                   limit_s)
            .death;
    };
    EXPECT_NE(death([] { std::raise(SIGKILL); }, 10.0), "");
    EXPECT_NE(death([] { std::abort(); }, 10.0).find("signal 6"), std::string::npos);
    EXPECT_NE(death([] { throw std::runtime_error("no"); }, 10.0).find("code 1"), std::string::npos);
    EXPECT_EQ(death(
                  [] {
                      for (volatile bool go_on = true; go_on;) {
                      }
                  },
                  1.0),
              "was stopped after 1 s of core time");
}

TEST(IsolatedCall, leaves_the_memory_of_the_caller_alone) {
    int value = 1;
    call_isolated(
        [&value] {
            value = 2;
            return std::string();
        },
        10.0);
    EXPECT_EQ(value, 1);
}
