#include "geometry/base/progress.hpp"

#include <sstream>

#include <gtest/gtest.h>

using namespace cutterflow;

TEST(Progress, writes_durations_as_people_do) {
    EXPECT_EQ(duration_text(0.4), "0 s");
    EXPECT_EQ(duration_text(59.6), "1 min 00 s");
    EXPECT_EQ(duration_text(185.0), "3 min 05 s");
    EXPECT_EQ(duration_text(7800.0), "2 h 10 min");
}

TEST(Progress, tells_the_time_left_from_the_pace_since_the_start) {
    double now = 100.0;
    std::ostringstream out;
    Progress progress("mesh", out, true, [&] { return now; });
    progress.update(0.0);
    now = 110.0;
    progress.update(0.25, "12 of 48");
    EXPECT_NE(out.str().find("mesh: 25 %, 12 of 48, 10 s, done in about 30 s"), std::string::npos) << out.str();
}

TEST(Progress, judges_a_resumed_job_by_what_it_did_itself) {
    double now = 0.0;
    std::ostringstream out;
    Progress progress("run", out, true, [&] { return now; });
    progress.update(0.5);
    now = 10.0;
    progress.update(0.75);
    EXPECT_NE(out.str().find("done in about 10 s"), std::string::npos) << out.str();
}

TEST(Progress, writes_plain_lines_at_every_tenth_and_every_minute) {
    double now = 0.0;
    std::ostringstream out;
    Progress progress("run", out, false, [&] { return now; });
    for (int i = 0; i <= 50; ++i) {
        progress.update(0.005 * i);
        now += 0.1;
    }
    now = 200.0;
    progress.update(0.251);
    progress.finish();
    const std::string text = out.str();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5) << text;  // 0 %, 10 %, 20 %, after a minute, done
    EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Progress, clears_the_rest_of_a_longer_line_on_a_terminal) {
    double now = 0.0;
    std::ostringstream out;
    Progress progress("run", out, true, [&] { return now; });
    progress.update(0.1, "a long note about the step");
    const std::size_t first = out.str().size();
    now = 1.0;
    progress.update(0.1);
    EXPECT_EQ(out.str().size(), 2 * first);
}
