// When a fed run may end: by the report's own interval, asked once per revolution.
#include <cmath>
#include <optional>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "solver/observe/head/production_watch.hpp"

namespace cutterflow::coupling {
namespace {

constexpr double k_revolution = 1.0, k_step = 0.01;

/// 10 kg/s are fed in rocks of 20 g; six of ten rocks that leave the head are delivered. `stuck` of what is fed stays in it.
struct Head {
    explicit Head(double stuck_share = 0.0) : stuck(stuck_share) {}
    RockLedger next() {
        ledger.fed += 10.0 * k_step;
        const double out = std::max(0.0, (1.0 - stuck) * ledger.fed - ledger.delivered - ledger.spilled()) * k_step / 0.5;
        ledger.delivered += leaving(0.6 * out);
        ledger.spilled_mixing += leaving(0.3 * out);
        ledger.spilled_cutting += leaving(0.1 * out);
        ledger.in_head = ledger.fed - ledger.delivered - ledger.spilled();
        return ledger;
    }
    double leaving(double mean) { return 0.02 * static_cast<double>(std::poisson_distribution<int>(mean / 0.02)(generator)); }
    double stuck;
    RockLedger ledger;
    std::mt19937_64 generator{11};
};

/// Time at which the watch ends the run; none by `last` [s]. The series goes to `seen`.
std::optional<double> end_of(ProductionWatch& watch, Head head, double last, ProductionSeries& seen) {
    for (int step = 1; step * k_step <= last; ++step) {
        const double time = step * k_step;
        const RockLedger ledger = head.next();
        watch.add(time, ledger);
        seen.time.push_back(time);
        seen.fed.push_back(ledger.fed);
        seen.delivered.push_back(ledger.delivered);
        seen.spilled.push_back(ledger.spilled());
        seen.held.push_back(ledger.held());
        if (watch.is_known()) return time;
    }
    return std::nullopt;
}

TEST(ProductionWatch, ends_a_run_at_the_first_revolution_after_which_the_report_is_sure_enough) {
    constexpr double target = 0.03;
    ProductionWatch watch(k_revolution, target);
    ProductionSeries series;
    const std::optional<double> end = end_of(watch, Head(), 200.0, series);
    ASSERT_TRUE(end);
    const std::optional<Production> production = production_of(series, k_revolution);
    ASSERT_TRUE(production && production->share);
    EXPECT_LE(production->share->half_interval, target);
    EXPECT_TRUE(production->is_steady);
    EXPECT_GE(*end, 3.0 + 8.0) << "start-up and eight batches";
    // Not a revolution earlier.
    const auto kept = static_cast<std::size_t>(std::lround((*end - k_revolution) / k_step));
    for (auto* column : {&series.time, &series.fed, &series.delivered, &series.spilled, &series.held}) column->resize(kept);
    const std::optional<Production> before = production_of(series, k_revolution);
    EXPECT_FALSE(before && before->share && before->is_steady && before->share->half_interval <= target);
}

TEST(ProductionWatch, takes_longer_for_a_narrower_interval) {
    ProductionSeries series;
    ProductionWatch wide(k_revolution, 0.06), narrow(k_revolution, 0.01);
    const std::optional<double> early = end_of(wide, Head(), 400.0, series), late = end_of(narrow, Head(), 400.0, series);
    ASSERT_TRUE(early && late);
    // Rocks of 20 g leave one by one, 6 kg/s of them to the mouth: in T seconds the share scatters by sqrt(6 * 0.02 / T) / 10, and 1.98
    // of that are 0.06 after 1.3 s, less than eight batches take, and 0.01 after 47 s. The interval itself scatters.
    EXPECT_LE(*early, 3.0 + 8.0 + 4.0);
    EXPECT_NEAR(*late, 3.0 + 47.0, 0.4 * 47.0);
}

TEST(ProductionWatch, ends_no_run_whose_head_fills_up) {
    ProductionSeries series;
    ProductionWatch watch(k_revolution, 0.2);
    EXPECT_FALSE(end_of(watch, Head(0.2), 60.0, series));
}

TEST(ProductionWatch, goes_on_to_the_bit_from_its_file) {
    ProductionWatch whole(k_revolution, 0.03), first(k_revolution, 0.03), second(k_revolution, 0.03);
    Head head, same;
    for (int step = 1; step <= 777; ++step) {
        whole.add(step * k_step, head.next());
        first.add(step * k_step, same.next());
    }
    std::stringstream file;
    first.write(file);
    ASSERT_TRUE(second.restore(file));
    for (int step = 778; step <= 4000; ++step) {
        whole.add(step * k_step, head.next());
        second.add(step * k_step, same.next());
        ASSERT_EQ(whole.is_known(), second.is_known()) << step;
    }
    EXPECT_TRUE(whole.is_known());
    std::ostringstream a, b;
    whole.write(a);
    second.write(b);
    EXPECT_EQ(a.str(), b.str());
}

TEST(ProductionWatch, that_knew_enough_knows_it_from_its_file) {
    constexpr double target = 0.03;
    ProductionWatch watch(k_revolution, target), resumed(k_revolution, target), later(k_revolution, target);
    ProductionSeries series;
    const std::optional<double> end = end_of(watch, Head(), 200.0, series);
    ASSERT_TRUE(end);
    std::stringstream file;
    watch.write(file);
    ASSERT_TRUE(resumed.restore(file));
    EXPECT_TRUE(resumed.is_known());
    resumed.add(*end + k_step, Head().next());  // within the revolution after it
    std::stringstream next;
    resumed.write(next);
    ASSERT_TRUE(later.restore(next));
    EXPECT_TRUE(later.is_known());
}

TEST(ProductionWatch, refuses_a_file_that_is_cut_short) {
    ProductionWatch watch(k_revolution, 0.03), other(k_revolution, 0.03);
    watch.add(0.1, Head().next());
    std::ostringstream file;
    watch.write(file);
    for (const std::string& text : {std::string(), file.str().substr(0, 20), file.str() + "12345678"}) {
        std::istringstream cut(text);
        EXPECT_FALSE(other.restore(cut)) << text.size();
    }
}

}  // namespace
}  // namespace cutterflow::coupling
