// Events, gates, stop rules and the start from another run's rock, with stand-ins for fluid and DEM.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/coupling/coupled_run.hpp"
#include "solver/coupling/dry/no_fluid.hpp"
#include "solver/coupling/tests/coupling_rig.hpp"
#include "solver/physics/catalogue.hpp"
#include "solver/physics/drag.hpp"
#include "solver/ports/testing/fake_engines.hpp"
#include "solver/ports/testing/temporary_folder.hpp"

namespace cutterflow::coupling {
namespace {

using ::testing::ElementsAre;
using testing::FakeDem;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr double k_diameter = 0.01, k_density = 2650.0;
const double k_mass = sphere_mass(k_diameter, k_density);

class Rows final : public SilentRecorder {
public:
    void event(const RockEvent& e) override { events.push_back(e); }
    void account(double, const AccountTotals& totals) override { accounts.push_back(totals); }
    void gate(const GateRow& row) override { crossings.push_back(row); }
    void extraction(const ExtractionRow& row) override { extractions.push_back(row); }
    void picture(const RockPicture& picture) override { frozen.assign(picture.frozen.begin(), picture.frozen.end()); }
    void warning(double, const std::string& text) override { warnings.push_back(text); }

    std::vector<RockEvent> events;
    std::vector<AccountTotals> accounts;
    std::vector<GateRow> crossings;
    std::vector<ExtractionRow> extractions;
    std::vector<int> frozen;
    std::vector<std::string> warnings;
};

struct StillDem : FakeDem {
    StillDem() : FakeDem(ZoneMotion{}, 0.5, 0.0) {}
    std::vector<double> zone_angles() const override { return {}; }
};

/// A row of `count` rocks at x = 0, 1, 2 ... with ids 1, 2, 3 ..., that come in from the last to the first, 1 ms apart.
CouplingSettings row_of_rock(const TemporaryFolder& folder, int count) {
    std::string feed = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n";
    for (int k = 0; k < count; ++k) feed += fmt::format("{},{},{},0,0,{},{}\n", k + 1, 1e-3 * (count - 1 - k), k, k_diameter, k_density);
    CouplingSettings settings;
    settings.has_rock = true;
    settings.has_medium = false;
    settings.rock_feed = folder.write("feed.csv", feed);
    return settings;
}

template <class Dem = StillDem>
struct Bed {
    Bed(const CouplingSettings& settings, const TemporaryFolder& folder, RunRecorder& recorder, double start = 0.0)
        : fluid({start, 1.0, 0.1}, 2e-3), run(settings, FluidProperties{}, fluid, &dem, serial, recorder, folder.path()) {}
    void go_to(double time) {
        while (fluid.time() < time - 1e-9) run.step();
    }
    NoFluid fluid;
    Dem dem;
    SerialCommunicator serial;
    CoupledRun run;
};

OperationSettings at(double time, OperationKind kind, const Region& region) {
    OperationSettings operation;
    operation.kind = kind;
    operation.begin = time;
    operation.region = region;
    return operation;
}

OperationSettings extraction(double begin, double end, double rate, const Region& region = EverywhereRegion{}) {
    OperationSettings operation = at(begin, OperationKind::extract, region);
    operation.end = end;
    operation.rate = rate;
    return operation;
}

TEST(BedOperations, act_at_their_times_on_their_regions_alone) {
    const TemporaryFolder folder;
    CouplingSettings settings = row_of_rock(folder, 6);
    const BoxRegion left{Vec3(-0.5, -1, -1), Vec3(1.5, 1, 1)};
    settings.operations = {at(0.0133, OperationKind::remove, SphereRegion{Vec3(4, 0, 0), 1.2}), at(0.02, OperationKind::freeze, left),
                           at(0.0333, OperationKind::thaw, SphereRegion{Vec3::Zero(), 0.5})};
    Rows rows;
    Bed bed(settings, folder, rows);
    bed.dem.gravity = Vec3(0, 0, -9.81);
    bed.go_to(0.0133);
    EXPECT_EQ(bed.dem.rocks().size(), 6u);
    EXPECT_NEAR(bed.fluid.time(), 0.0133, 1e-12) << "a step ends at the event";
    bed.run.step();
    EXPECT_THAT(bed.dem.rocks().id, ElementsAre(1, 2, 3));
    bed.go_to(0.02);
    bed.run.step();
    EXPECT_THAT(bed.dem.frozen(), ElementsAre(1, 2));
    const Rocks held = bed.dem.rocks();
    bed.go_to(0.0333);
    for (const std::size_t p : {0, 1}) {
        EXPECT_EQ(bed.dem.rocks().position[p], held.position[p]);
        EXPECT_EQ(bed.dem.rocks().velocity[p], Vec3(Vec3::Zero()));
    }
    EXPECT_LT(bed.dem.rocks().position[2].z(), held.position[2].z());
    bed.go_to(0.1);
    EXPECT_THAT(bed.dem.frozen(), ElementsAre(2));
    EXPECT_THAT(rows.frozen, ElementsAre(2)) << "pictures tell";
    EXPECT_NEAR(bed.dem.rocks().velocity[0].z(), -9.81 * (0.1 - 0.0333), 1e-9);
    const AccountTotals& end = rows.accounts.back();
    EXPECT_EQ(end.count[static_cast<std::size_t>(Whereabouts::removed)], 3);
    EXPECT_EQ(end.count[0], 3);
    EXPECT_EQ(std::count_if(rows.events.begin(), rows.events.end(), [](const RockEvent& e) { return e.surface == EventSurface::remove; }),
              3);
}

TEST(BedOperations, tell_of_events_that_find_nothing) {
    const TemporaryFolder folder;
    CouplingSettings settings = row_of_rock(folder, 3);
    const SphereRegion first{Vec3::Zero(), 0.5}, nowhere{Vec3(50, 0, 0), 0.5};
    settings.operations = {at(0.01, OperationKind::freeze, nowhere), at(0.01, OperationKind::remove, nowhere),
                           at(0.02, OperationKind::thaw, first), at(0.03, OperationKind::freeze, first),
                           at(0.04, OperationKind::thaw, first)};
    Rows rows;
    Bed bed(settings, folder, rows);
    bed.go_to(0.05);
    EXPECT_THAT(rows.warnings,
                ElementsAre("events[0] (freeze) finds nothing in its region", "events[1] (remove) finds nothing in its region",
                            "events[2] (thaw) finds nothing in its region"));
}

TEST(BedOperations, extract_whole_rocks_at_a_rate_the_first_that_came_first) {
    const TemporaryFolder folder;
    CouplingSettings settings = row_of_rock(folder, 40);
    const double rate = 100.0 * k_mass;
    settings.operations = {at(0.0, OperationKind::freeze, EverywhereRegion{}), extraction(0.05, 0.305, rate)};
    settings.operations[0].begin = 0.045;
    settings.operations[0].region = SphereRegion{Vec3(39, 0, 0), 0.5};
    Rows rows;
    Bed bed(settings, folder, rows);
    bed.go_to(0.4);
    for (const ExtractionRow& row : rows.extractions) {
        EXPECT_LE(row.extracted, row.due + 1e-12);
        EXPECT_GT(row.extracted, row.due - k_mass);
        EXPECT_FALSE(row.starved);
    }
    EXPECT_NEAR(rows.extractions.back().due, 25.5 * k_mass, 1e-9 * k_mass);
    std::vector<int> out, expected;
    for (const RockEvent& e : rows.events)
        if (e.surface == EventSurface::extract) out.push_back(e.id);
    for (int id = 39; id > 14; --id) expected.push_back(id);  // id 40 came in first, and is held
    EXPECT_EQ(out, expected);
    EXPECT_EQ(bed.dem.rocks().size(), 15u);
}

TEST(BedOperations, tell_of_an_extraction_that_is_starved_and_make_up_for_it) {
    const TemporaryFolder folder;
    CouplingSettings settings = row_of_rock(folder, 3);
    std::ofstream(settings.rock_feed, std::ios::app) << fmt::format("9,0.2,5,0,0,{},{}\n", k_diameter, k_density);
    settings.operations = {extraction(0.0, 0.3, 50.0 * k_mass)};
    Rows rows;
    Bed bed(settings, folder, rows);
    bed.go_to(0.19);
    EXPECT_EQ(bed.dem.rocks().size(), 0u);
    ASSERT_EQ(rows.warnings.size(), 1u);
    EXPECT_THAT(rows.warnings[0], HasSubstr("starved"));
    EXPECT_TRUE(rows.extractions.back().starved);
    bed.go_to(0.21);
    EXPECT_EQ(bed.dem.rocks().size(), 0u) << "rock that comes in is due at once";
    EXPECT_NEAR(rows.extractions.back().extracted, 4.0 * k_mass, 1e-12);
}

/// Takes one rock more out than it is told to; or makes one smaller; or loses one on the way through a checkpoint.
struct GreedyDem final : StillDem {
    void remove(gsl::span<const int> ids) override {
        FakeDem::remove(ids);
        FakeDem::remove(std::vector<int>{rocks_.id.back()});
    }
};
struct GrindingDem final : StillDem {
    DemStep advance(double duration, const HydrodynamicForce& force) override {
        const DemStep step = FakeDem::advance(duration, force);
        if (rocks_.size() == 3) rocks_.diameter[1] *= 0.999;
        return step;
    }
};
struct ForgetfulDem final : StillDem {
    void read_checkpoint(const std::filesystem::path& folder) override {
        FakeDem::read_checkpoint(folder);
        FakeDem::remove(std::vector<int>{2});
    }
};

template <class Dem>
std::string failure_of(const CouplingSettings& settings, const TemporaryFolder& folder) {
    Rows rows;
    Bed<Dem> bed(settings, folder, rows);
    try {
        bed.go_to(0.02);
    } catch (const CheckFailure& failure) {
        return failure.what();
    }
    return "";
}

TEST(Account, catches_engines_that_lose_or_grind_rock) {
    const TemporaryFolder folder;
    CouplingSettings settings = row_of_rock(folder, 3);
    settings.operations = {at(0.01, OperationKind::remove, SphereRegion{Vec3::Zero(), 0.5})};
    EXPECT_EQ(failure_of<StillDem>(settings, folder), "");
    EXPECT_THAT(failure_of<GreedyDem>(settings, folder), HasSubstr("rock 3 of"));
    EXPECT_THAT(failure_of<GrindingDem>(settings, folder), HasSubstr("rock 2 has"));
}

/// A bed that is half done with its events, and its checkpoint.
CouplingSettings busy_bed(const TemporaryFolder& folder) {
    CouplingSettings settings = row_of_rock(folder, 30);
    settings.operations = {at(0.03, OperationKind::remove, SphereRegion{Vec3(2, 0, 0), 1.5}),
                           at(0.04, OperationKind::freeze, SphereRegion{Vec3(29, 0, 0), 0.5}), extraction(0.02, 0.2, 60.0 * k_mass)};
    settings.checkpoint = CheckpointSettings{0.1, 2};
    settings.gates.resize(1);
    settings.gates[0].name = "below";
    settings.gates[0].centre = Vec3(15, 0, -0.1);
    settings.gates[0].radius = 100.0;
    settings.idle = IdleSettings{"below", 0.15};
    return settings;
}

TEST(Account, and_events_go_on_after_a_resume_as_without_one) {
    const TemporaryFolder folder;
    const CouplingSettings settings = busy_bed(folder);
    Rows through, after;
    Bed whole(settings, folder, through);
    whole.dem.gravity = Vec3(0, 0, -9.81);
    while (newest_checkpoint(folder.path()).empty()) whole.run.step();
    const std::filesystem::path checkpoint = folder.path() / "kept";
    std::filesystem::copy(newest_checkpoint(folder.path()), checkpoint, std::filesystem::copy_options::recursive);
    const double saved = whole.fluid.time();
    const std::size_t events_before = through.events.size(), crossings_before = through.crossings.size();
    whole.go_to(0.25);

    Bed resumed(settings, folder, after, saved);
    resumed.dem.gravity = whole.dem.gravity;
    resumed.run.resume(checkpoint);
    resumed.go_to(0.25);
    EXPECT_EQ(resumed.dem.rocks().id, whole.dem.rocks().id);
    EXPECT_EQ(resumed.dem.frozen(), whole.dem.frozen());
    EXPECT_EQ(events_before + after.events.size(), through.events.size());
    EXPECT_GT(after.crossings.size(), 0u);
    EXPECT_EQ(crossings_before + after.crossings.size(), through.crossings.size());
    EXPECT_EQ(after.extractions.back().extracted, through.extractions.back().extracted);
    EXPECT_EQ(after.accounts.back().count, through.accounts.back().count);
    EXPECT_EQ(after.accounts.back().mass, through.accounts.back().mass);
    while (!whole.run.finished()) whole.run.step();
    while (!resumed.run.finished()) resumed.run.step();
    EXPECT_EQ(resumed.fluid.time(), whole.fluid.time());

    Bed<ForgetfulDem> forgetful(settings, folder, after, saved);
    EXPECT_THROW(forgetful.run.resume(checkpoint), CheckFailure);
    CouplingSettings fewer = settings;
    fewer.operations.pop_back();
    Bed other(fewer, folder, after, saved);
    EXPECT_THROW(other.run.resume(checkpoint), UserError);
}

/// A checkpoint's time is a sum of steps: it may lie below that of an event by rounding.
TEST(Account, goes_on_at_an_event_that_is_due_within_rounding) {
    const TemporaryFolder folder;
    CouplingSettings settings = row_of_rock(folder, 3);
    settings.checkpoint = CheckpointSettings{0.1, 2};
    Rows before, after;
    settings.operations = {at(0.5, OperationKind::remove, SphereRegion{Vec3::Zero(), 0.5})};
    Bed whole(settings, folder, before);
    while (newest_checkpoint(folder.path()).empty()) whole.run.step();
    const double saved = whole.fluid.time();

    settings.operations.front().begin = std::nextafter(saved, 1.0);
    Bed resumed(settings, folder, after, saved);
    resumed.run.resume(newest_checkpoint(folder.path()));
    resumed.run.step();
    EXPECT_THAT(resumed.dem.rocks().id, ElementsAre(2, 3)) << "at once";
    EXPECT_NEAR(resumed.fluid.time(), saved + 2e-3, 1e-9) << "after a whole step";
}

TEST(Start, takes_the_rock_of_another_run_with_what_is_frozen) {
    const TemporaryFolder folder;
    CouplingSettings bed_settings = row_of_rock(folder, 5);
    bed_settings.operations = {at(0.01, OperationKind::freeze, SphereRegion{Vec3::Zero(), 0.5})};
    bed_settings.checkpoint = CheckpointSettings{10.0, 1};
    Rows rows;
    Bed bed(bed_settings, folder, rows);
    bed.go_to(0.05);
    bed.run.finish();

    CouplingSettings settings;
    settings.has_rock = true;
    settings.has_medium = false;
    settings.rock_start = newest_checkpoint(folder.path());
    EXPECT_TRUE(check_settings(settings, FluidProperties{}, "here").empty()) << "without a feed";
    const TemporaryFolder other;
    Rows after;
    Bed run(settings, other, after);
    run.run.start_from(settings.rock_start);
    run.go_to(0.02);
    EXPECT_EQ(run.dem.rocks().id, bed.dem.rocks().id);
    EXPECT_THAT(run.dem.frozen(), ElementsAre(1));
    EXPECT_EQ(after.accounts.back().count[0], 5);
    ASSERT_EQ(after.events.size(), 5u);
    EXPECT_EQ(after.events[0].surface, EventSurface::start);
    EXPECT_EQ(after.events[0].time, 0.0);

    settings.rock_feed = other.write("feed.csv", "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n4,1,0,0,1,0.01,2650\n");
    Bed doubled(settings, other, after);
    try {
        doubled.run.start_from(settings.rock_start);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("rock 4 is in"));
    }
}

// Rock of the start, and rock that an event takes out, displaces water without a source; frozen rock drags, and the balance holds.
TEST(BedOperations, in_water_replace_fluid_without_a_source_and_frozen_rock_drags) {
    testing::CouplingRig rig(testing::box(0.1, 0.02), ZoneMotion{}, 1e-3);
    rig.fluid.velocity.assign(rig.fluid.mesh.size(), Vec3(0.2, 0, 0));
    FeedRock rock;
    rock.diameter = 0.02;
    rock.density = k_density;
    for (const int id : {1, 2}) {
        rock.id = id;
        rock.position = Vec3(0.05 * id - 0.08, 0, 0);
        rock.velocity = Vec3::Zero();
        rig.coupling.insert({rock});
    }
    rig.dem.gravity = Vec3(0, 0, -9.81);
    rig.dem.freeze(std::vector<int>{1});
    const Vec3 place = rig.dem.rocks().position[0];
    for (int n = 0; n < 20; ++n) {
        const ExchangeBalance balance = rig.step();
        EXPECT_LE(balance.solid_volume_error, 1e-12);
        EXPECT_LE(balance.deposit_error, 1e-10);
        EXPECT_LE(rig.momentum_errors.error, 1e-9);
    }
    EXPECT_EQ(rig.dem.rocks().position[0], place);
    EXPECT_EQ(rig.dem.rocks().velocity[0], Vec3(Vec3::Zero()));
    EXPECT_GT(rig.dem.rocks().velocity[1].x(), 0.0);
    // Both rocks see nearly the first slip all the time.
    const physics::RockInFluid alone{0.02, testing::k_water.density, testing::k_water.kinematic_viscosity, 1.0, 1.0};
    const double drag = 0.2 * physics::drag_coefficient_per_slip(alone, 0.2, physics::find_drag_law("brown_lawler"),
                                                                 physics::find_hindrance_law(physics::k_no_closure));
    double lost = 0.0;
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c)
        lost += testing::k_water.density * rig.fluid.mesh.volumes[c] *
                (rig.fluid.void_fraction[c] * (0.2 - rig.fluid.velocity[c].x()) - rig.coupling.carry()[c].x());
    EXPECT_NEAR(lost, 20 * 1e-3 * 2.0 * drag, 0.15 * 20 * 1e-3 * 2.0 * drag)
        << "the held rock takes momentum out of the water as the other";

    const double volume = sphere_volume(0.02);
    EXPECT_NEAR(rig.coupling.booked().volume, 2.0 * volume, 1e-15);
    rig.coupling.remove(std::vector<int>{2});
    EXPECT_NEAR(rig.coupling.booked().volume, volume, 1e-15);
    double solid = 0.0;
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) solid += (1.0 - rig.fluid.void_fraction[c]) * rig.fluid.mesh.volumes[c];
    EXPECT_NEAR(solid, volume, 1e-12 * volume);

    const TemporaryFolder folder;
    rig.dem.write_checkpoint(folder.path());
    testing::CouplingRig fresh(testing::box(0.1, 0.02), ZoneMotion{}, 1e-3);
    fresh.dem.start_from(folder.path());
    fresh.coupling.adopt_present_rock();
    EXPECT_NEAR(fresh.coupling.booked().volume, volume, 1e-15);
    EXPECT_EQ(fresh.fluid.void_fraction, rig.fluid.void_fraction);
}

TEST(StopRules, wait_for_rest_events_walls_and_the_hold_time) {
    const TemporaryFolder folder;
    CouplingSettings settings = row_of_rock(folder, 4);
    settings.at_rest = AtRestSettings{1e-6, 0.01, 0.02};
    settings.operations = {at(0.05, OperationKind::remove, SphereRegion{Vec3::Zero(), 0.5})};
    Rows rows;
    Bed bed(settings, folder, rows);  // without gravity: at rest from the start
    bed.dem.gravity = Vec3(0, 0, -1e-9);
    while (!bed.run.finished()) bed.run.step();
    EXPECT_NEAR(bed.fluid.time(), 0.052, 1e-9) << "the step after the event";
    Bed waiting(settings, folder, rows);
    waiting.dem.gravity = Vec3(0, 0, -1e-9);
    waiting.dem.walls_change = 0.1;
    while (!waiting.run.finished()) waiting.run.step();
    EXPECT_NEAR(waiting.fluid.time(), 0.1, 2.1e-3);
    settings.at_rest->from = 0.2;
    Bed growing(settings, folder, rows);  // a flow grows until then
    growing.dem.gravity = Vec3(0, 0, -1e-9);
    while (!growing.run.finished()) growing.run.step();
    EXPECT_NEAR(growing.fluid.time(), 0.2, 2.1e-3);
    Bed falling(settings, folder, rows);
    falling.dem.gravity = Vec3(0, 0, -9.81);
    falling.go_to(0.5);
    EXPECT_FALSE(falling.run.finished());
}

TEST(StopRules, measure_energy_without_spin_over_weight_times_diameter) {
    coupling::Rocks rocks;
    rocks.append({1, Vec3::Zero(), Vec3(0.3, 0, 0), Vec3(0, 10, 0), 0.01, 2650.0});
    rocks.append({2, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0.02, 1000.0});
    const Restlessness both = restlessness(rocks, {}, 9.81);
    EXPECT_NEAR(both.energy, 0.5 * 0.5 * 0.09 / (9.81 * 0.01), 1e-12);
    EXPECT_NEAR(both.speed, 0.3 / std::sqrt(9.81 * 0.01), 1e-12);
    EXPECT_EQ(restlessness(rocks, {1}, 9.81).energy, 0.0);
}

/// Rows `id,time_s,x_m,diameter_m,vx_m_s` of rock without a medium, at y = z = 0.
CouplingSettings moving_rock(const TemporaryFolder& folder, const std::vector<std::string>& rows) {
    std::string feed = "id,time_s,x_m,diameter_m,vx_m_s,y_m,z_m,density_kg_m3,vy_m_s,vz_m_s\n";
    for (const std::string& row : rows) feed += row + ",0,0,2650,0,0\n";
    CouplingSettings settings;
    settings.has_rock = true;
    settings.has_medium = false;
    settings.rock_feed = folder.write("moving.csv", feed);
    return settings;
}

TEST(Calming, slows_down_rock_that_is_calm_and_leaves_faster_rock_alone) {
    constexpr double time = 0.05;
    const TemporaryFolder folder;
    const auto speeds_at_end = [&](double speed) {
        CouplingSettings settings =
            moving_rock(folder, {fmt::format("1,0,0,0.01,{}", speed), fmt::format("2,0,1,0.02,{}", -0.5 * speed), "3,0,2,0.01,0"});
        settings.calming = CalmingSettings{0.01, time};
        Rows rows;
        Bed bed(settings, folder, rows);
        bed.go_to(0.1);
        EXPECT_NEAR(bed.dem.rocks().velocity[1].x() / bed.dem.rocks().velocity[0].x(), -0.5, 1e-9) << "whatever its mass";
        return bed.dem.rocks().velocity[0].x() / speed * std::exp(bed.fluid.time() / time);
    };
    EXPECT_NEAR(speeds_at_end(0.01), 1.0, 1e-3) << "root mean square of three rocks 0.0065 m/s";
    EXPECT_NEAR(speeds_at_end(0.02), std::exp(0.1 / time), 1e-9) << "0.013 m/s";
}

TEST(Calming, counts_rock_that_is_not_frozen) {
    const TemporaryFolder folder;
    const auto speed_at_end = [&](const std::vector<OperationSettings>& operations) {
        CouplingSettings settings = moving_rock(folder, {"1,0,0,0.01,0", "2,0,1,0.01,0", "3,0,2,0.01,0", "4,0.02,3,0.01,0.1"});
        settings.calming = CalmingSettings{0.06, 0.05};
        settings.operations = operations;
        Rows rows;
        Bed bed(settings, folder, rows);
        bed.go_to(0.05);
        return bed.dem.rocks().velocity.back().x();
    };
    EXPECT_LT(speed_at_end({}), 0.09) << "0.05 m/s over four rocks";
    EXPECT_EQ(speed_at_end({at(0.01, OperationKind::freeze, BoxRegion{Vec3(-0.5, -0.5, -0.5), Vec3(2.5, 0.5, 0.5)})}), 0.1)
        << "0.1 m/s of the one that is not frozen";
}

TEST(StopRules, end_a_run_whose_gate_is_idle) {
    const TemporaryFolder folder;
    CouplingSettings settings = row_of_rock(folder, 2);
    settings.gates.resize(1);
    settings.gates[0].name = "below";
    settings.gates[0].centre = Vec3(0, 0, -0.05);
    settings.gates[0].radius = 0.5;
    settings.gates[0].normal = Vec3(0, 0, -1);
    settings.idle = IdleSettings{"below", 0.2};
    Rows rows;
    Bed bed(settings, folder, rows);
    bed.dem.gravity = Vec3(0, 0, -9.81);
    while (!bed.run.finished()) bed.run.step();
    ASSERT_EQ(rows.crossings.size(), 1u) << "the other falls beside the disc";
    EXPECT_EQ(rows.crossings[0].id, 1);
    EXPECT_EQ(rows.crossings[0].sense, 1);
    EXPECT_EQ(rows.crossings[0].mass, k_mass);
    const double fallen = 0.001 + std::sqrt(2.0 * 0.05 / 9.81);
    EXPECT_NEAR(rows.crossings[0].time, fallen, 1e-4);
    EXPECT_NEAR(bed.fluid.time(), fallen + 0.2, 2.1e-3);
}

TEST(StopRules, end_a_run_when_the_mean_rate_over_a_window_is_below_a_value) {
    StopRules rules({}, {}, BelowSettings{"out", 0.5, 2.0}, 1.0);
    EXPECT_FALSE(rules.below(2.9)) << "the run has not lasted for a window";
    EXPECT_TRUE(rules.below(3.0)) << "nothing has passed";
    for (int k = 0; k <= 40; ++k) rules.note_crossing(1.0 + 0.1 * k, "out", 0.1);  // 1 kg/s until 5 s
    rules.note_crossing(5.0, "elsewhere", 9.0);
    EXPECT_FALSE(rules.below(5.0));
    EXPECT_FALSE(rules.below(5.9)) << "1.1 kg in the last two seconds";
    EXPECT_TRUE(rules.below(6.15)) << "0.9 kg";
    EXPECT_LE(rules.state().passed.size(), 21u) << "what is older than the window is forgotten";
    StopRules resumed({}, {}, BelowSettings{"out", 0.5, 2.0}, 5.5);
    resumed.restore(rules.state());
    EXPECT_FALSE(resumed.below(5.9));
    EXPECT_TRUE(resumed.below(6.15));
    StopRules of_earlier_version({}, {}, BelowSettings{"out", 0.5, 2.0}, 5.5);
    of_earlier_version.restore({{}, 5.0, {}});
    EXPECT_FALSE(of_earlier_version.below(6.15)) << "it has counted since 5.5 s";
    EXPECT_TRUE(of_earlier_version.below(7.5));
    for (int k = 0; k < 20; ++k) rules.note_crossing(7.05 + 0.1 * k, "out", k % 2 == 0 ? 1.0 : -1.0);
    EXPECT_TRUE(rules.below(9.0)) << "rock that goes to and fro is no rate";
}

TEST(StopRules, end_a_run_below_a_rate_at_the_step_at_which_the_window_has_passed) {
    const TemporaryFolder folder;
    CouplingSettings settings = row_of_rock(folder, 2);
    settings.gates.resize(1);
    settings.gates[0].name = "under";
    settings.gates[0].centre = Vec3(0, 0, -0.05);
    settings.gates[0].radius = 0.5;
    settings.gates[0].normal = Vec3(0, 0, 1);  // against the fall: the rate is negative
    settings.below = BelowSettings{"under", 0.5 * k_mass / 0.2, 0.2};
    Rows rows;
    Bed bed(settings, folder, rows);
    bed.dem.gravity = Vec3(0, 0, -9.81);
    while (!bed.run.finished()) bed.run.step();
    EXPECT_NEAR(bed.fluid.time(), 0.001 + std::sqrt(2.0 * 0.05 / 9.81) + 0.2, 2.1e-3);
}

TEST(BedOperations, are_refused_with_all_their_mistakes) {
    CouplingSettings settings;
    settings.has_rock = true;
    settings.has_medium = false;
    settings.rock_feed = "feed.csv";
    settings.operations = {at(-1.0, OperationKind::remove, SphereRegion{Vec3::Zero(), 0.0}), extraction(1.0, 0.5, 0.0),
                           at(0.0, OperationKind::thaw, BoxRegion{Vec3::Ones(), Vec3::Zero()})};
    settings.gates.resize(2);
    settings.gates[0].name = settings.gates[1].name = "a";
    settings.gates[0].radius = 1.0;
    settings.gates[1].rectangle = BoxRegion{Vec3::Zero(), Vec3::Ones()};
    settings.idle = IdleSettings{"b", -1.0};
    std::string all;
    for (const Mistake& mistake : check_settings(settings, FluidProperties{}, "here")) all += mistake.text() + "\n";
    for (const char* what : {"events[0] (remove).at = -1", "events[0] (remove).region.radius = 0", "events[1] (extract).rate = 0",
                             "events[1] (extract).to = 0.5", "events[2] (thaw).region: a box without room", "gates.a is defined twice",
                             "gates.a.lower and .upper: no rectangle", "stop.idle.gate = b", "stop.idle.duration = -1"})
        EXPECT_THAT(all, HasSubstr(what));
    settings = CouplingSettings();
    settings.operations = {at(0.0, OperationKind::remove, EverywhereRegion{})};
    EXPECT_THAT(check_settings(settings, testing::k_water, "here").at(0).what, HasSubstr("section events without section rock"));
}

}  // namespace
}  // namespace cutterflow::coupling
