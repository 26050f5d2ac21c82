#include "cases/scenes/cutter/start_flow.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace cutterflow::cases {
namespace {

TEST(Monitor, drifts_by_its_range_over_the_last_fifty_iterations) {
    std::vector<double> history(100);
    std::iota(history.begin(), history.end(), 0.0);
    const Monitor monitor = monitor_of(history);
    EXPECT_EQ(monitor.last, 99.0);
    EXPECT_EQ(monitor.drift, 49.0);
}

TEST(Monitor, does_not_take_an_oscillation_for_convergence) {
    std::vector<double> history;
    for (int i = 0; i < 60; ++i) history.push_back(i % 2 == 0 ? 1.0 : -1.0);
    EXPECT_EQ(monitor_of(history).drift, 2.0);
}

TEST(Monitor, of_a_short_history_uses_all_of_it) {
    EXPECT_EQ(monitor_of({3.0, 1.0, 2.0}).drift, 2.0);
}

TEST(StartFlowReport, says_how_far_pressure_and_torque_moved) {
    StartFlowReport report;
    report.iterations = 250;
    report.outlet_pressure = {-20.0, 0.1};
    report.torque = {-50.0, 1.0};
    report.flow_imbalance = 3e-4;
    EXPECT_EQ(
        report.text(),
        "250 iterations; over the last 50 the outlet pressure moved by 0.5 % (-20 m2/s2) and the torque by 2 % (-50 N m); flow imbalance "
        "3.0e-04 of the discharge");
}

}  // namespace
}  // namespace cutterflow::cases
