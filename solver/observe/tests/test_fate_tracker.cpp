// Fates on scripted paths about a head whose contour is a cone from 0.2 m at z = -0.4 m to 0.4 m at the ring.
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/observe/head/fate_tracker.hpp"

namespace cutterflow::coupling {
namespace {

constexpr double k_diameter = 0.02;

FateSettings settings() {
    FateSettings s;
    s.contour = "unused";
    s.ring_radius = 0.4;
    s.z_backplate = 0.03;
    s.hysteresis = 0.25;
    s.mouth = {Vec3(0.22, 0.0, 0.05), Vec3::UnitZ(), 0.1, 0.2};
    s.bin_width = 0.03;
    return s;
}

geometry::Contour cone() {
    return geometry::Contour({-0.4, 0.0}, {0.2, 0.4}, 0.4, 0.03);
}

/// One rock and its clock.
struct Script {
    explicit Script(const Vec3& start) : tracker(settings(), cone()) {
        events.push_back(tracker.place(1, k_diameter, 2650.0, start, Vec3::Zero(), {0.0, 0.0}));
        rocks.append({1, start, Vec3::Zero(), Vec3::Zero(), k_diameter, 2650.0});
    }
    void go(const Vec3& to) {
        rocks.position = {to};
        for (const RockEvent& e : tracker.move(rocks, {time, 10.0 * time}, {time + 0.1, 10.0 * (time + 0.1)})) events.push_back(e);
        time += 0.1;
    }
    Fate fate() const { return tracker.fate_of(1); }
    const RockEvent& last() const { return events.back(); }

    FateTracker tracker;
    Rocks rocks;
    std::vector<RockEvent> events;
    double time = 0.0;
};

TEST(Fate, of_rock_that_starts_inside_is_in_cutter) {
    const Script script(Vec3(0.3, 0, -0.05));
    EXPECT_EQ(script.fate(), Fate::in_cutter);
    EXPECT_EQ(script.events.at(0).surface, EventSurface::feed);
}

TEST(Fate, of_rock_that_stays_outside_is_never_entered) {
    Script script(Vec3(0.6, 0, -0.05));
    script.go(Vec3(0.5, 0, -0.2));
    EXPECT_EQ(script.fate(), Fate::never_entered);
    EXPECT_EQ(script.events.size(), 1u);
}

TEST(Fate, is_spilled_once_out_and_the_exit_stands_in_its_bin) {
    Script script(Vec3(0, 0.35, -0.04));
    script.go(Vec3(0, 0.45, -0.04));
    EXPECT_EQ(script.fate(), Fate::spilled);
    ASSERT_EQ(script.events.size(), 2u);
    EXPECT_EQ(script.last().surface, EventSurface::head);
    EXPECT_EQ(script.last().direction, EventDirection::out);
    EXPECT_EQ(script.last().bin, "30-60mm");
    EXPECT_NEAR(script.last().azimuth, 0.5 * k_pi, 1e-12);
    // The event stands where the centre is a quarter diameter beyond the cone, r = 0.38 there, interpolated in the step.
    const double at = 0.38 + 0.005 * std::sqrt(1.25);
    EXPECT_NEAR(script.last().position[1], at, 2e-3);
    EXPECT_NEAR(script.last().time, 0.1 * (script.last().position[1] - 0.35) / 0.1, 1e-12);
    EXPECT_NEAR(script.last().rotor_angle, 10.0 * script.last().time, 1e-12);
    const RockOutcome outcome = script.tracker.outcomes().at(0);
    EXPECT_EQ(outcome.last_exit_bin, "30-60mm");
    EXPECT_EQ(*outcome.first_exit_time, script.last().time);
}

TEST(Fate, does_not_flicker_within_the_hysteresis) {
    Script script(Vec3(0.379, 0, -0.04));
    for (int i = 0; i < 20; ++i) script.go(Vec3(0.38 + (i % 2 == 0 ? 0.004 : -0.004), 0, -0.04));
    EXPECT_EQ(script.events.size(), 1u);
    EXPECT_EQ(script.fate(), Fate::in_cutter);
}

TEST(Fate, of_rock_that_comes_back_is_in_cutter_again_and_its_last_exit_counts) {
    Script script(Vec3(0.35, 0, -0.04));
    script.go(Vec3(0.45, 0, -0.04));
    script.go(Vec3(0.35, 0, -0.04));
    EXPECT_EQ(script.fate(), Fate::in_cutter);
    script.go(Vec3(0.25, 0, -0.2));
    script.go(Vec3(0.45, 0, -0.2));
    EXPECT_EQ(script.fate(), Fate::spilled);
    ASSERT_EQ(script.events.size(), 4u);
    const RockOutcome outcome = script.tracker.outcomes().at(0);
    EXPECT_EQ(outcome.last_exit_bin, "180-210mm");
    EXPECT_EQ(*outcome.first_exit_time, script.events[1].time);
}

TEST(Fate, of_rock_through_the_gap_and_below_the_hub) {
    Script gap(Vec3(0, 0.37, 0.015));
    gap.go(Vec3(0, 0.47, 0.015));
    EXPECT_EQ(gap.tracker.outcomes().at(0).last_exit_bin, "gap");
    Script hub(Vec3(0.05, 0, -0.38));
    hub.go(Vec3(0.05, 0, -0.44));
    EXPECT_EQ(hub.tracker.outcomes().at(0).last_exit_bin, "below_hub");
    EXPECT_EQ(hub.fate(), Fate::spilled);
}

TEST(Fate, of_rock_on_its_way_up_the_pipe_is_in_cutter_until_the_depth_and_then_final) {
    Script script(Vec3(0.22, 0, -0.05));
    script.go(Vec3(0.22, 0.03, 0.04));
    script.go(Vec3(0.22, 0.03, 0.15));
    EXPECT_EQ(script.fate(), Fate::in_cutter);
    EXPECT_EQ(script.events.size(), 1u);
    script.go(Vec3(0.22, 0.03, 0.27));
    EXPECT_EQ(script.fate(), Fate::sucked_up);
    EXPECT_EQ(script.last().surface, EventSurface::mouth);
    EXPECT_EQ(script.last().direction, EventDirection::in);
    EXPECT_NEAR(script.last().position[2], 0.25, 1e-12);
    EXPECT_NEAR(script.last().time, 0.2 + 0.1 * (0.25 - 0.15) / 0.12, 1e-12);
    // Falling back down the pipe and out of the head changes nothing any more.
    script.go(Vec3(0.22, 0, 0.0));
    script.go(Vec3(0.5, 0, 0.0));
    EXPECT_EQ(script.fate(), Fate::sucked_up);
    EXPECT_EQ(script.events.size(), 2u);
}

TEST(Fate, of_rock_that_rises_beside_the_mouth_is_spilled_through_the_gap) {
    Script script(Vec3(-0.2, 0, 0.0));
    script.go(Vec3(-0.2, 0, 0.06));
    EXPECT_EQ(script.fate(), Fate::spilled);
    EXPECT_EQ(script.last().bin, "gap");
}

TEST(Fate, stays_with_rock_that_leaves_the_domain) {
    Script script(Vec3(0.35, 0, -0.04));
    script.go(Vec3(0.45, 0, -0.04));
    const auto events = script.tracker.leave(1, Vec3(2.6, 0, -0.3), Vec3(1, 0, 0), {0.1, 1.0}, {0.2, 2.0});
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].surface, EventSurface::domain);
    EXPECT_EQ(script.fate(), Fate::spilled);
    EXPECT_FALSE(script.tracker.rocks().at(1).in_run);
    EXPECT_EQ(script.tracker.totals().placed.count, 1);
    EXPECT_EQ(script.tracker.outcomes().at(0).position, Vec3(2.6, 0, -0.3));
}

TEST(Fate, of_rock_that_leaves_through_the_pipe_is_sucked_up) {
    Script script(Vec3(0.22, 0, 0.0));
    script.tracker.leave(1, Vec3(0.22, 0.01, 0.2), Vec3(0, 0, 2), {0.0, 0.0}, {0.1, 1.0});
    EXPECT_EQ(script.fate(), Fate::sucked_up);
}

TEST(Fates, add_up_to_the_placed_rock_in_count_and_mass) {
    FateTracker tracker(settings(), cone());
    const Vec3 starts[] = {Vec3(0.3, 0, -0.05), Vec3(0.6, 0, 0), Vec3(0.1, 0, -0.2), Vec3(0.22, 0, 0.3), Vec3(-0.3, 0, -0.01)};
    Rocks rocks;
    int id = 0;
    for (const Vec3& x : starts) {
        ++id;
        tracker.place(id, 0.01 * id, 2000.0 + 100.0 * id, x, Vec3::Zero(), {});
        rocks.id.push_back(id);
        rocks.position.push_back(x + Vec3(0, id % 2 == 1 ? 0.5 : 0.0, 0));
        rocks.velocity.push_back(Vec3::Zero());
    }
    tracker.move(rocks, {0.0, 0.0}, {0.1, 0.0});
    const FateTotals totals = tracker.totals();
    int count = 0;
    double mass = 0.0;
    for (const Fate fate : k_fates) {
        count += totals.of(fate).count;
        mass += totals.of(fate).mass;
    }
    EXPECT_EQ(count, 5);
    EXPECT_EQ(totals.placed.count, 5);
    EXPECT_NEAR(mass, totals.placed.mass, 1e-15 * mass);
    EXPECT_EQ(totals.of(Fate::sucked_up).count, 1);
    EXPECT_EQ(totals.of(Fate::never_entered).count, 1);
    EXPECT_EQ(totals.of(Fate::spilled).count, 3);
    const double sucked = 2400.0 * k_pi / 6.0 * 64e-6;
    EXPECT_NEAR(totals.of(Fate::sucked_up).mass, sucked, 1e-12);
    EXPECT_NEAR(totals.undecided(), totals.of(Fate::never_entered).mass / totals.placed.mass, 1e-12);
}

/// One rock from a cut face at the cone, a little within it.
struct CutRock {
    CutRock() : tracker(with_cutting(), cone()) {
        tracker.place(1, k_diameter, 2650.0, start, Vec3::Zero(), {});
        rocks.append({1, start, Vec3::Zero(), Vec3::Zero(), k_diameter, 2650.0});
    }
    static FateSettings with_cutting() {
        FateSettings s = settings();
        s.cutting = CuttingSettings{0.3, Vec3(0, -1, 0), 0.6};
        return s;
    }
    RockPlace at(const Vec3& place) {
        rocks.position = {place};
        tracker.move(rocks, {time, 0.0}, {time + 0.1, 0.0});
        time += 0.1;
        return tracker.rocks().at(1).place();
    }
    double distance(const Vec3& place) const { return tracker.signed_distance(place); }

    const Vec3 start = Vec3(0, 0.36 - 0.55 * k_diameter * std::sqrt(1.25), -0.08);  // 0.55 d within the cone, r = 0.36 there
    FateTracker tracker;
    Rocks rocks;
    double time = 0.0;
};

TEST(CutRock, that_leaves_from_where_it_was_cut_is_spilled_by_cutting) {
    CutRock rock;
    ASSERT_NEAR(rock.distance(rock.start), -0.55 * k_diameter, 1e-9);
    EXPECT_EQ(rock.at(rock.start + Vec3(0, -0.004, 0)), RockPlace::in_head) << "less than the hysteresis deeper";
    EXPECT_EQ(rock.at(Vec3(0, 0.40, -0.08)), RockPlace::spilled_cutting);
    EXPECT_EQ(rock.at(rock.start), RockPlace::in_head);
    EXPECT_EQ(rock.at(Vec3(0, 0.30, -0.08)), RockPlace::in_head);
    EXPECT_EQ(rock.at(Vec3(0, 0.40, -0.08)), RockPlace::spilled_mixing) << "it has been in the head's flow meanwhile";
}

TEST(CutRock, that_is_far_off_or_behind_is_left_behind_for_good) {
    CutRock far;
    EXPECT_EQ(far.at(Vec3(0, 0.60, -0.08)), RockPlace::spilled_cutting);
    EXPECT_TRUE(far.tracker.finished().empty());
    EXPECT_EQ(far.at(Vec3(0, 0.80, -0.08)), RockPlace::left_behind_cutting) << "it keeps its cause";
    EXPECT_EQ(far.tracker.finished(), std::vector<int>{1});
    CutRock behind;
    EXPECT_EQ(behind.at(Vec3(0, 0, -0.08)), RockPlace::in_head);
    EXPECT_EQ(behind.at(Vec3(0, -0.59, -0.08)), RockPlace::spilled_mixing) << "its way led through the head";
    EXPECT_EQ(behind.at(Vec3(0, -0.61, -0.08)), RockPlace::left_behind_mixing);
    EXPECT_EQ(behind.at(Vec3(0, -0.30, -0.08)), RockPlace::left_behind_mixing) << "final";
}

TEST(Ledger, has_every_rock_in_one_place) {
    CutRock rock;
    for (const Vec3& place : {Vec3(0, 0.30, -0.08), Vec3(0, 0.42, -0.08), Vec3(0, 0.9, 0), Vec3(0.22, 0, 0.3)}) {
        rock.at(place);
        const RockLedger ledger =
            ledger_of(rock.tracker.rocks(), rock.rocks, 3.0 * sphere_mass(k_diameter, 2650.0), 2.0 * sphere_mass(k_diameter, 2650.0));
        EXPECT_LE(ledger.error(), 1e-15);
    }
    const RockLedger lost = ledger_of(rock.tracker.rocks(), Rocks(), sphere_mass(k_diameter, 2650.0), 0.0);
    EXPECT_NEAR(lost.error(), 1.0, 1e-15) << "the DEM has no such rock";
    EXPECT_EQ(RockLedger().error(), 0.0);
}

TEST(Undecided, is_everything_while_nothing_is_placed) {
    EXPECT_EQ(FateTotals().undecided(), 1.0);
}

}  // namespace
}  // namespace cutterflow::coupling
