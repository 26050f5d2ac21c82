// The queue of rock that is to come in: what is due when, where it goes in, and that none is lost.
#include <gtest/gtest.h>

#include "geometry/base/sphere.hpp"
#include "solver/coupling/feed/feed_queue.hpp"

namespace cutterflow::coupling {
namespace {

constexpr double k_speed = -5.0;  // [rad/s]
constexpr double k_blade_passing = 0.2;
constexpr double k_tolerance = 1e-6;
const QueueSettings k_queue{0.01, k_blade_passing, 0.2};

ZoneMotion rotor() {
    ZoneMotion motion;
    motion.speed = k_speed;
    return motion;
}

FeedRock rock(int id, double time, double azimuth = 0.0) {
    return {id, time, Vec3(0.4 * std::cos(azimuth), 0.4 * std::sin(azimuth), -0.1), 0.02, 2650.0, Vec3(0.0, -1.0, 0.0)};
}

double azimuth_of(const FeedRock& rock) {
    return std::atan2(rock.position[1], rock.position[0]);
}

std::vector<bool> everywhere(const std::vector<FeedRock>& rocks) {
    return std::vector<bool>(rocks.size(), true);
}
std::vector<bool> nowhere(const std::vector<FeedRock>& rocks) {
    return std::vector<bool>(rocks.size(), false);
}

TEST(Batch, goes_in_at_its_time_and_place_and_what_has_no_room_stays_owed) {
    FeedQueue feed({rock(1, 0.5), rock(2, 0.5), rock(3, 0.7)}, std::nullopt, rotor());
    EXPECT_EQ(feed.next_release(), 0.5);
    EXPECT_TRUE(feed.next_packet(0.4, k_tolerance, everywhere).empty());
    const auto in = feed.next_packet(0.5, k_tolerance, [](const auto& rocks) {
        std::vector<bool> room;
        for (const FeedRock& one : rocks) room.push_back(one.id != 2);
        return room;
    });
    ASSERT_EQ(in.size(), 1u);
    EXPECT_EQ(in[0].position, rock(1, 0.5).position);
    ASSERT_EQ(feed.newly_waiting().size(), 1u);
    EXPECT_EQ(feed.newly_waiting()[0].id, 2);
    EXPECT_EQ(feed.next_release(), 0.7);
    EXPECT_FALSE(feed.all_in());
    EXPECT_EQ(feed.next_packet(0.7, k_tolerance, everywhere).size(), 1u);
    EXPECT_TRUE(feed.all_in()) << "the second one is not tried again";
    const double mass = sphere_mass(0.02, 2650.0);
    EXPECT_NEAR(feed.fed_mass(), 3.0 * mass, 1e-12);
    EXPECT_NEAR(feed.owed_mass(), mass, 1e-12);
}

TEST(Queue, takes_packets_and_never_cuts_a_step) {
    FeedQueue feed({rock(1, 0.001), rock(2, 0.004), rock(3, 0.009), rock(4, 0.012)}, k_queue, rotor());
    EXPECT_EQ(feed.next_release(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> sizes;
    for (int step = 1; step <= 20; ++step) {
        const double time = 1.5e-3 * step;
        feed.collect_due(time, k_tolerance);
        if (feed.packet_is_due(time, k_tolerance)) sizes.push_back(feed.next_packet(time, k_tolerance, everywhere).size());
    }
    // At 1.5 ms the first one, at 12 ms the other three, at 22.5 ms nothing is left.
    EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 3, 0}));
}

TEST(Queue, place_and_velocity_turn_with_the_rotor_while_rock_waits_for_its_packet) {
    FeedQueue feed({rock(1, 0.1, 0.3)}, k_queue, rotor());
    const auto in = feed.next_packet(0.104, k_tolerance, everywhere);
    ASSERT_EQ(in.size(), 1u);
    EXPECT_NEAR(azimuth_of(in[0]), 0.3 + k_speed * 0.004, 1e-12);
    EXPECT_NEAR(in[0].position[2], -0.1, 1e-15);
    EXPECT_NEAR((*in[0].velocity - Vec3(-std::sin(0.02), -std::cos(0.02), 0.0)).norm(), 0.0, 1e-12);
}

TEST(Queue, goes_ahead_by_whole_diameters_where_a_place_is_taken) {
    FeedQueue feed({rock(1, 0.0)}, k_queue, rotor());
    const double step = 0.02 / 0.4;
    const auto taken = [&](const std::vector<FeedRock>& rocks) {
        std::vector<bool> room;
        for (const FeedRock& one : rocks) room.push_back(azimuth_of(one) < -2.5 * step);
        return room;
    };
    const auto in = feed.next_packet(0.0, k_tolerance, taken);
    ASSERT_EQ(in.size(), 1u);
    EXPECT_NEAR(azimuth_of(in[0]), -3.0 * step, 1e-12) << "ahead is where the rotor goes, here to negative azimuths";
}

TEST(Queue, goes_to_its_further_places_before_it_goes_ahead) {
    FeedRock one = rock(1, 0.0);
    one.elsewhere = {{Vec3(0.3, 0.0, -0.1), Vec3(0.0, -0.75, 0.0)}, {Vec3(0.2, 0.0, -0.1), Vec3(0.0, -0.5, 0.0)}};
    for (const double innermost : {0.45, 0.35, 0.25}) {
        FeedQueue feed({one}, k_queue, rotor());
        const auto in = feed.next_packet(0.0, k_tolerance, [&](const std::vector<FeedRock>& rocks) {
            std::vector<bool> room;
            for (const FeedRock& asked : rocks) room.push_back(asked.position.norm() < innermost);
            return room;
        });
        ASSERT_EQ(in.size(), 1u);
        EXPECT_NEAR(azimuth_of(in[0]), 0.0, 1e-12);
        EXPECT_NEAR(in[0].position.head<2>().norm(), innermost - 0.05, 1e-12);
        EXPECT_NEAR(in[0].velocity->norm(), 2.5 * (innermost - 0.05), 1e-12) << "each place has its velocity";
    }
    FeedQueue feed({one}, k_queue, rotor());
    int asked = 0;
    const auto in = feed.next_packet(0.0, k_tolerance, [&](const std::vector<FeedRock>& rocks) {
        ++asked;
        return std::vector<bool>(rocks.size(), azimuth_of(rocks.back()) < -1e-9);
    });
    ASSERT_EQ(in.size(), 1u);
    EXPECT_EQ(asked, 4) << "its three places, then the first one a diameter ahead";
    EXPECT_NEAR(azimuth_of(in[0]), -0.02 / 0.4, 1e-12);
}

TEST(Queue, does_not_go_farther_ahead_than_its_reach_and_comes_back_at_the_next_blade) {
    FeedQueue feed({rock(1, 0.0, 0.5)}, k_queue, rotor());
    int tried = 0;
    double farthest = 0.0;
    const auto full = [&](const std::vector<FeedRock>& rocks) {
        for (const FeedRock& one : rocks) farthest = std::max(farthest, std::abs(azimuth_of(one) - 0.5));
        ++tried;
        return nowhere(rocks);
    };
    EXPECT_TRUE(feed.next_packet(0.0, k_tolerance, full).empty());
    EXPECT_EQ(tried, 5);  // 0 to 4 times 0.05 rad
    EXPECT_NEAR(farthest, 0.2, 1e-9);
    EXPECT_GT(feed.owed_mass(), 0.0);
    EXPECT_FALSE(feed.all_in());
    EXPECT_TRUE(feed.next_packet(0.1, k_tolerance, everywhere).empty()) << "its blade has passed";
    const auto in = feed.next_packet(k_blade_passing + 0.002, k_tolerance, everywhere);
    ASSERT_EQ(in.size(), 1u);
    EXPECT_NEAR(azimuth_of(in[0]), 0.5 + k_speed * 0.002, 1e-12) << "at its first place, ahead of the next blade";
    EXPECT_EQ(feed.owed_mass(), 0.0);
}

TEST(Queue, of_long_packets_comes_back_at_the_next_blade_too) {
    FeedQueue feed({rock(1, 0.0, 0.5)}, QueueSettings{0.5, k_blade_passing, 0.2}, rotor());
    for (const double time : {0.0, 0.5, 1.0, 1.5}) EXPECT_TRUE(feed.next_packet(time, k_tolerance, nowhere).empty());
    const auto in = feed.next_packet(2.1, k_tolerance, everywhere);
    ASSERT_EQ(in.size(), 1u);
    // Due at 1.6 s, the first multiple of the blade passing after the last try.
    EXPECT_NEAR(std::remainder(azimuth_of(in[0]) - (0.5 + k_speed * (2.1 - 1.6)), 2.0 * k_pi), 0.0, 1e-9);
}

TEST(Queue, owes_what_waits_and_goes_on_where_it_was) {
    std::vector<FeedRock> rocks;
    for (int i = 0; i < 50; ++i) rocks.push_back(rock(i + 1, 0.004 * i, 0.1 * i));
    const auto every_third = [](const std::vector<FeedRock>& asked) {
        std::vector<bool> room;
        for (const FeedRock& one : asked) room.push_back(one.id % 3 != 0);
        return room;
    };
    FeedQueue whole(rocks, k_queue, rotor()), resumed(rocks, k_queue, rotor());
    double placed = 0.0;
    std::vector<FeedRock> last, last_resumed;
    for (int step = 0; step < 100; ++step) {
        const double time = 0.002 * step;
        if (step == 60) resumed.restore(whole.state());
        whole.collect_due(time, k_tolerance);
        if (whole.packet_is_due(time, k_tolerance)) {
            last = whole.next_packet(time, k_tolerance, every_third);
            for (const FeedRock& one : last) placed += sphere_mass(one.diameter, one.density);
        }
        EXPECT_NEAR(whole.fed_mass(), placed + whole.owed_mass(), 1e-12 * (1.0 + placed));
        if (step < 60) continue;
        resumed.collect_due(time, k_tolerance);
        if (resumed.packet_is_due(time, k_tolerance)) last_resumed = resumed.next_packet(time, k_tolerance, every_third);
        EXPECT_EQ(resumed.fed_mass(), whole.fed_mass());
        EXPECT_NEAR(resumed.owed_mass(), whole.owed_mass(), 1e-15);
    }
    ASSERT_EQ(last.size(), last_resumed.size());
    ASSERT_FALSE(last.empty());
    for (std::size_t i = 0; i < last.size(); ++i) EXPECT_EQ(last[i].position, last_resumed[i].position);
    EXPECT_GT(whole.owed_mass(), 0.0);
}

}  // namespace
}  // namespace cutterflow::coupling
