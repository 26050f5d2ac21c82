// The coupled run with stand-ins for fluid and DEM: stages, records, stop rule, checkpoint, pure flow.
#include <chrono>
#include <cstring>
#include <fstream>
#include <limits>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/base/statistics/replaced_starts.hpp"
#include "solver/coupling/coupled_run.hpp"
#include "solver/coupling/coupling_methods.hpp"
#include "solver/coupling/dry/no_fluid.hpp"
#include "solver/observe/csv_recorder.hpp"
#include "solver/ports/testing/fake_engines.hpp"
#include "solver/ports/testing/temporary_folder.hpp"
#include "solver/ports/testing/threaded_ranks.hpp"

namespace cutterflow::coupling {
namespace {

using testing::FakeDem;
using testing::FakeFluid;
using testing::SyntheticMesh;
using testing::TemporaryFolder;

const FluidProperties k_water{998.2, 1.0034e-6};

/// Keeps what a run tells.
class MemoryRecorder final : public SilentRecorder {
public:
    void event(const RockEvent& e) override { events.push_back(e); }
    void rejected(const RejectedRock& r) override { rejections.push_back(r); }
    void fates(double time, const FateTotals& totals) override { fate_rows.emplace_back(time, totals); }
    void ledger(double, const RockLedger& ledger) override { ledgers.push_back(ledger); }
    void outflow(double, gsl::span<const double> v, gsl::span<const double>) override { outflow_rows.emplace_back(v.begin(), v.end()); }
    void loads(const LoadsRow& row) override { load_rows.push_back(row); }
    void balance(const BalanceRow& row) override { balance_rows.push_back(row); }
    void cost(const CostRow& row) override { cost_rows.push_back(row); }
    void picture(const RockPicture& p) override { pictures.emplace_back(p.id.begin(), p.id.end()); }
    void outcomes(gsl::span<const RockOutcome> o) override { last_outcomes.assign(o.begin(), o.end()); }
    void velocity(const VelocitySets& sets, double) override {
        last_velocity.clear();
        for (const VelocitySet& set : sets.sets())
            for (std::size_t i = 0; i < set.points.size(); ++i) last_velocity.push_back(set.statistics.average(i).sum);
    }
    void finished(const RunCost& c) override { run_cost = c; }
    void warning(double, const std::string& text) override { warnings.push_back(text); }
    void flush() override { ++flushes; }

    std::vector<RockEvent> events;
    std::vector<RejectedRock> rejections;
    std::vector<std::pair<double, FateTotals>> fate_rows;
    std::vector<RockLedger> ledgers;
    std::vector<std::vector<double>> outflow_rows;
    std::vector<LoadsRow> load_rows;
    std::vector<BalanceRow> balance_rows;
    std::vector<CostRow> cost_rows;
    std::vector<std::vector<int>> pictures;
    std::vector<RockOutcome> last_outcomes;
    std::vector<Vec3> last_velocity;
    std::optional<RunCost> run_cost;
    std::vector<std::string> warnings;
    int flushes = 0;
};

SyntheticMesh head_mesh() {
    SyntheticMesh mesh;
    mesh.add_annulus(0.02, 0.24, 11, 40, -0.25, 0.0, 12, true);
    mesh.add_annulus(0.24, 0.40, 8, 40, -0.25, 0.0, 12, false);
    mesh.add_annulus(0.02, 0.40, 19, 40, -0.40, -0.25, 7, false);
    mesh.add_annulus(0.02, 0.40, 19, 40, 0.0, 0.4, 18, false);
    return mesh;
}

const ZoneMotion k_still{};
ZoneMotion turning() {
    ZoneMotion motion;
    motion.speed = 6.0;
    return motion;
}

CouplingSettings case_settings(const TemporaryFolder& folder, const std::string& feed) {
    CouplingSettings settings;
    settings.has_rock = true;
    settings.rock_feed = folder.write("feed.csv", "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n" + feed);
    FateSettings fates;
    fates.contour = folder.write("contour.csv", "z_m,r_m\n-0.2,0.1\n0,0.2\n");
    fates.ring_radius = 0.2;
    fates.z_backplate = 0.02;
    fates.mouth = {Vec3(0.1, 0.0, 0.03), Vec3::UnitZ(), 0.05, 0.1};
    fates.bin_width = 0.05;
    settings.fates = fates;
    return settings;
}

/// A run on one rank with a uniform flow.
struct Rig {
    Rig(const CouplingSettings& s, const std::filesystem::path& folder, RunRecorder& recorder, const Vec3& flow,
        ZoneMotion motion = turning())
        : fluid(head_mesh(), motion, 4e-3), dem(motion, 0.5, k_water.density) {
        fluid.flow = [flow](const Vec3&, double) { return flow; };
        fluid.velocity.assign(fluid.mesh.size(), flow);
        dem.leaves = [](const Vec3& x) { return x.head<2>().norm() > 0.35 || x[2] > 0.35; };
        run.emplace(s, k_water, fluid, s.has_rock ? &dem : nullptr, serial, recorder, folder);
    }
    FakeFluid fluid;
    FakeDem dem;
    SerialCommunicator serial;
    std::optional<CoupledRun> run;
};

TEST(CoupledRun, ends_when_a_closed_domain_has_water_too_much) {
    for (const double surplus : {1e-9, std::numeric_limits<double>::quiet_NaN()}) {
        const TemporaryFolder folder;
        MemoryRecorder recorder;
        Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n"), folder.path(), recorder, Vec3::Zero());
        rig.fluid.given_loads.domain_surplus = 1e-14;
        rig.run->step();
        rig.fluid.given_loads.domain_surplus = surplus;
        EXPECT_THROW(rig.run->step(), CheckFailure) << surplus;
        EXPECT_FALSE(recorder.balance_rows.back().domain_surplus <= 1e-14) << "the row that tells why is written";
    }
}

/// Lies about the flow through the boundary and the interface. What leaks out through a wall comes in through an open patch, so that both
/// add up to nothing.
TEST(CoupledRun, counts_cells_from_which_walls_take_more_rock_than_they_may) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n"), folder.path(), recorder, Vec3::Zero());
    rig.run->step();
    for (std::size_t c = 0; c < rig.fluid.mesh.size(); ++c) rig.fluid.retreat[c] = 100.0 * rig.fluid.mesh.volumes[c];
    rig.run->step();
    ASSERT_EQ(recorder.balance_rows.size(), 2u);
    EXPECT_EQ(recorder.balance_rows[0].limited.swept_cells, 0);
    EXPECT_GT(recorder.balance_rows[1].limited.swept_cells, 0);
}

TEST(CoupledRun, tells_of_a_wall_that_leaks_and_of_an_interface_that_does_not_close) {
    constexpr double through = 0.1, leak = 2e-3, imbalance = 0.03, mismatch = 0.05;
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n"), folder.path(), recorder, Vec3::Zero());
    FluidLoads& loads = rig.fluid.given_loads;
    loads.through_flow = through;
    rig.run->step();
    loads.boundary_flow = -leak;
    loads.wall_flow = leak;
    rig.run->step();
    loads.wall_flow = 0.0;  // the same flow through the interface alone
    loads.interface_imbalance = imbalance;
    loads.interface_mismatch = mismatch;
    rig.run->step();
    ASSERT_EQ(recorder.balance_rows.size(), 3u);
    const std::vector<BalanceRow>& rows = recorder.balance_rows;
    EXPECT_EQ(rows[0].flow_balance_error, 0.0);
    EXPECT_NEAR(rows[1].flow_balance_error, 2.0 * leak / through, 1e-15);
    EXPECT_EQ(rows[1].interface_imbalance, 0.0);
    EXPECT_NEAR(rows[2].flow_balance_error, leak / through, 1e-15);
    EXPECT_EQ(rows[2].interface_imbalance, imbalance);
    EXPECT_EQ(rows[2].interface_mismatch, mismatch);
}

/// A fluid whose balances all hold while its flow blows up.
TEST(CoupledRun, ends_when_the_fluid_is_faster_than_anything_drives_it) {
    for (const double speed : {31.0, std::numeric_limits<double>::quiet_NaN()}) {
        const TemporaryFolder folder;
        MemoryRecorder recorder;
        CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n");
        settings.largest_speed = 30.0;
        Rig rig(settings, folder.path(), recorder, Vec3::Zero());
        rig.fluid.given_loads.speed_max = 30.0;
        rig.run->step();
        rig.fluid.given_loads.speed_max = speed;
        EXPECT_THROW(rig.run->step(), CheckFailure) << speed;
        EXPECT_FALSE(recorder.balance_rows.back().speed_max <= 30.0) << "the row that tells why is written";
    }
}

TEST(CoupledRun, counts_processor_time_and_no_waiting) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n"), folder.path(), recorder, Vec3::Zero());
    rig.dem.leaves = [](const Vec3&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return false;
    };
    for (int i = 0; i < 3; ++i) rig.run->step();
    rig.run->finish();
    EXPECT_GE(recorder.run_cost->wall, 0.4);
    EXPECT_LE(recorder.run_cost->core, 0.5 * recorder.run_cost->wall);
    EXPECT_GT(recorder.run_cost->core, 0.0);
}

TEST(CoupledRun, follows_rock_without_a_head) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder,
                                              "1,0,0.1,0,0.2,0.02,2650\n"
                                              "2,0.05,-0.1,0.02,-0.05,0.02,2700\n");
    settings.fates.reset();
    settings.checkpoint = CheckpointSettings{1.0, 2};
    MemoryRecorder recorder;
    Rig rig(settings, folder.path(), recorder, Vec3(0, 0, 1.0), k_still);
    rig.fluid.writes_fields = true;
    while (rig.fluid.time() < 0.3) rig.run->step();
    EXPECT_FALSE(rig.run->finished());
    rig.run->finish();

    // Two come in, the first leaves upwards; nobody says in which state.
    ASSERT_EQ(recorder.events.size(), 3u);
    EXPECT_EQ(recorder.events[0].surface, EventSurface::feed);
    EXPECT_EQ(recorder.events[1].id, 2);
    const RockEvent& gone = recorder.events[2];
    EXPECT_EQ(gone.surface, EventSurface::domain);
    EXPECT_EQ(gone.direction, EventDirection::out);
    EXPECT_EQ(gone.id, 1);
    EXPECT_GT(gone.position[2], 0.35);
    EXPECT_DOUBLE_EQ(gone.density, 2650.0);
    EXPECT_TRUE(recorder.fate_rows.empty());
    EXPECT_TRUE(recorder.last_outcomes.empty());
    for (const BalanceRow& row : recorder.balance_rows) EXPECT_LT(row.solid_volume_error, 1e-9);

    MemoryRecorder more;
    Rig resumed(settings, folder.path(), more, Vec3(0, 0, 1.0), k_still);
    resumed.fluid.restart_at(rig.fluid.time());
    resumed.run->resume(newest_checkpoint(folder.path()));
    EXPECT_EQ(resumed.dem.rocks().id, (std::vector<int>{2}));

    // Fates cannot begin in the middle of a run.
    CouplingSettings with_fates = case_settings(folder, "1,0,0.1,0,0.2,0.02,2650\n2,0.05,-0.1,0.02,-0.05,0.02,2700\n");
    Rig late(with_fates, folder.path(), more, Vec3(0, 0, 1.0), k_still);
    late.fluid.restart_at(rig.fluid.time());
    EXPECT_THROW(late.run->resume(newest_checkpoint(folder.path())), UserError);
}

TEST(CoupledRun, refuses_fates_about_another_axis_than_z) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "1,0,0.1,0,0.2,0.02,2650\n");
    MemoryRecorder recorder;
    ZoneMotion aside = turning(), tilted = turning();
    aside.axis.origin = Vec3(0.05, 0.0, 0.0);
    tilted.axis.direction = Vec3(0.0, 0.6, 0.8);
    for (const ZoneMotion& motion : {aside, tilted}) EXPECT_THROW(Rig(settings, folder.path(), recorder, Vec3::Zero(), motion), UserError);
    settings.fates.reset();
    for (const ZoneMotion& motion : {aside, tilted}) EXPECT_NO_THROW(Rig(settings, folder.path(), recorder, Vec3::Zero(), motion));
}

TEST(CoupledRun, carries_rock_out_and_up_and_accounts_for_all_of_it) {
    const TemporaryFolder folder;
    // Up through the mouth, up beside it, one that never gets in, one that comes later.
    const CouplingSettings settings = case_settings(folder,
                                                    "1,0,0.1,0,-0.05,0.02,2650\n"
                                                    "2,0,-0.1,0.02,-0.05,0.02,2650\n"
                                                    "3,0,0.3,0,-0.05,0.02,2650\n"
                                                    "4,0.05,0.1,0.01,-0.02,0.02,2650\n");
    MemoryRecorder recorder;
    Rig rig(settings, folder.path(), recorder, Vec3(0, 0, 1.0));
    while (rig.fluid.time() < 0.3) rig.run->step();
    rig.run->finish();

    const FateTotals totals = recorder.fate_rows.back().second;
    EXPECT_EQ(totals.placed.count, 4);
    EXPECT_EQ(totals.of(Fate::sucked_up).count, 2);
    EXPECT_EQ(totals.of(Fate::spilled).count, 1);
    EXPECT_EQ(totals.of(Fate::never_entered).count, 1);
    EXPECT_EQ(recorder.events[0].surface, EventSurface::feed);
    const auto feeds =
        std::count_if(recorder.events.begin(), recorder.events.end(), [](const RockEvent& e) { return e.surface == EventSurface::feed; });
    EXPECT_EQ(feeds, 4);
    ASSERT_EQ(recorder.last_outcomes.size(), 4u);
    EXPECT_EQ(recorder.last_outcomes[1].last_exit_bin, "gap");
    for (const BalanceRow& row : recorder.balance_rows) {
        EXPECT_LE(row.solid_volume_error, 1e-12);
        EXPECT_LE(row.deposit_error, 1e-10);
    }
    EXPECT_EQ(recorder.cost_rows.size(), recorder.balance_rows.size());
    EXPECT_EQ(recorder.run_cost->steps, static_cast<int>(recorder.cost_rows.size()));
    EXPECT_EQ(recorder.run_cost->cells, static_cast<double>(rig.fluid.mesh.size()));
    EXPECT_GE(rig.fluid.time(), 0.3);
}

double mass_of(const Rocks& rocks) {
    double mass = 0.0;
    for (std::size_t p = 0; p < rocks.size(); ++p) mass += sphere_mass(rocks.diameter[p], rocks.density[p]);
    return mass;
}

TEST(CoupledRun, follows_the_rock_of_its_start_and_accounts_for_it) {
    const TemporaryFolder before, folder;
    CouplingSettings first = case_settings(before, "1,0,0.1,0,-0.05,0.02,2650\n2,0,0.3,0,-0.05,0.02,2650\n");
    first.fates.reset();
    first.checkpoint = CheckpointSettings{1.0, 1};
    MemoryRecorder unused, recorder;
    Rig bed(first, before.path(), unused, Vec3::Zero(), k_still);
    bed.run->step();
    bed.run->finish();
    const double at_start = mass_of(bed.dem.rocks());

    for (const char* feed : {"", "3,0.01,-0.1,0.02,-0.05,0.02,2650\n"}) {
        CouplingSettings settings = case_settings(folder, feed);
        settings.rock_start = newest_checkpoint(before.path());
        if (*feed == '\0') settings.rock_feed.clear();
        Rig rig(settings, folder.path(), recorder, Vec3(0, 0, 1.0));
        rig.run->start_from(settings.rock_start);
        EXPECT_EQ(recorder.events.back().surface, EventSurface::start);
        while (rig.fluid.time() < 0.3) rig.run->step();
        EXPECT_NEAR(recorder.ledgers.back().fed, at_start + (*feed == '\0' ? 0.0 : sphere_mass(0.02, 2650.0)), 1e-12);
        EXPECT_GT(recorder.ledgers.back().in_head, 0.0);
        EXPECT_LE(recorder.ledgers.back().error(), 1e-12);
    }
}

TEST(Ledger, with_rock_that_nobody_fed_does_not_hold) {
    RockLedger ledger;
    EXPECT_EQ(ledger.error(), 0.0);
    ledger.in_head = 1e-3;
    EXPECT_GT(ledger.error(), 1.0);
}

TEST(CoupledRun, takes_rock_out_once_it_is_sucked_up) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n2,0,-0.1,0.02,-0.15,0.02,2650\n"), folder.path(), recorder, Vec3(0, 0, 1.0));
    double highest = 0.0;
    while (rig.fluid.time() < 0.25) {
        rig.run->step();
        for (std::size_t p = 0; p < rig.dem.rocks().size(); ++p)
            if (rig.dem.rocks().id[p] == 1) highest = std::max(highest, rig.dem.rocks().position[p][2]);
    }
    EXPECT_GE(highest, 0.13) << "the mouth's depth beyond its lip";
    EXPECT_LE(highest, 0.13 + 2.0 * 4e-3);
    EXPECT_EQ(rig.dem.rocks().id, std::vector<int>{2});
    const RockEvent& last = recorder.events.back();
    EXPECT_EQ(last.id, 1);
    EXPECT_EQ(last.surface, EventSurface::domain);
    EXPECT_EQ(last.direction, EventDirection::out);
    const double volume = sphere_volume(0.02);
    EXPECT_NEAR(recorder.balance_rows.back().exchanged_volume, volume, 1e-15) << "two came in, one left, without a source";
    for (const BalanceRow& row : recorder.balance_rows) EXPECT_LE(row.solid_volume_error, 1e-12);
    EXPECT_EQ(recorder.fate_rows.back().second.of(Fate::sucked_up).count, 1);
    EXPECT_NEAR(recorder.ledgers.back().delivered, sphere_mass(0.02, 2650.0), 1e-12);
}

/// Rock that comes from a cut face around the head, one each 5 ms, some of it into places that are taken.
CouplingSettings fed_settings(const TemporaryFolder& folder) {
    std::string feed;
    for (int i = 0; i < 40; ++i) {
        const double azimuth = 0.9 * i;
        feed += fmt::format("{},{},{},{},{},0.02,2650\n", i + 1, 0.005 * i, 0.17 * std::cos(azimuth), 0.17 * std::sin(azimuth), -0.02);
    }
    CouplingSettings settings = case_settings(folder, feed);
    settings.queue = QueueSettings{0.01, 0.05, 0.1};
    settings.fates->cutting = CuttingSettings{0.1, Vec3(0, -1, 0), 0.25};
    return settings;
}

/// A flow out of the head on one side, to its mouth on the other.
Vec3 through_the_head(const Vec3& x, double) {
    return x[1] < 0.0 ? Vec3(0, -1.5, 0) : Vec3(10.0 * (0.1 - x[0]), -10.0 * x[1], 1.0);
}

TEST(Ledger, closes_at_every_step_of_a_feed_with_every_way_out) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(fed_settings(folder), folder.path(), recorder, Vec3::Zero());
    rig.fluid.flow = through_the_head;
    rig.dem.is_taken = [](const Vec3& x) { return x[0] < -0.12; };
    while (rig.fluid.time() < 0.4) rig.run->step();
    for (const RockLedger& ledger : recorder.ledgers) EXPECT_LE(ledger.error(), 1e-12);
    const RockLedger& end = recorder.ledgers.back();
    const double one = sphere_mass(0.02, 2650.0);
    EXPECT_NEAR(end.fed, 40.0 * one, 1e-10);
    EXPECT_GE(end.owed, 0.5 * one);
    EXPECT_GE(end.delivered, 0.5 * one);
    EXPECT_GE(end.left_behind(), 0.5 * one);
    const double followed = end.in_head + end.spilled_mixing + end.spilled_cutting + end.on_bed;
    EXPECT_GE(mass_of(rig.dem.rocks()), followed - 1e-12) << "what is done with leaves with the next packet";
    EXPECT_EQ(
        std::count_if(recorder.events.begin(), recorder.events.end(), [](const RockEvent& e) { return e.surface == EventSurface::feed; }),
        std::lround(40.0 - end.owed / one));
}

TEST(Ledger, keeps_the_cause_of_what_is_left_behind) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    // The flow goes along -y: rock 1 leaves from where it was cut, rocks 2 and 3 through the head.
    CouplingSettings settings =
        case_settings(folder, "1,0,0,-0.17,-0.02,0.02,2650\n2,0,0.08,0.15,-0.02,0.02,2650\n3,0,-0.1,0.13,-0.02,0.02,2650\n");
    settings.queue = QueueSettings{0.01, 0.05, 0.1};
    settings.fates->cutting = CuttingSettings{0.1, Vec3(0, -1, 0), 0.25};
    settings.checkpoint = CheckpointSettings{0.04, 2};
    Rig rig(settings, folder.path(), recorder, Vec3(0, -1.5, 0));
    while (rig.fluid.time() < 0.6) rig.run->step();
    const double one = sphere_mass(0.02, 2650.0);
    const RockLedger& end = recorder.ledgers.back();
    EXPECT_NEAR(end.left_behind_cutting, one, 1e-12);
    EXPECT_NEAR(end.left_behind_mixing, 2.0 * one, 1e-12);
    for (const RockLedger& ledger : recorder.ledgers) EXPECT_LE(ledger.error(), 1e-12);

    MemoryRecorder after;
    Rig resumed(settings, folder.path(), after, Vec3(0, -1.5, 0));
    const std::filesystem::path checkpoint = newest_checkpoint(folder.path());
    resumed.fluid.restart_at(read_state(checkpoint).time);
    resumed.run->resume(checkpoint);
    resumed.run->step();
    EXPECT_NEAR(after.ledgers.back().left_behind_cutting, one, 1e-12);
    EXPECT_NEAR(after.ledgers.back().left_behind_mixing, 2.0 * one, 1e-12);
}

/// Takes one rock more out than it is told to.
class GreedyDem final : public FakeDem {
public:
    using FakeDem::FakeDem;
    void remove(gsl::span<const int> ids) override {
        FakeDem::remove(ids);
        if (rocks_.size() > 0) FakeDem::remove(std::vector<int>{rocks_.id.front()});
    }
};

TEST(Ledger, catches_an_engine_that_loses_a_rock) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    FakeFluid fluid(head_mesh(), turning(), 4e-3);
    fluid.flow = through_the_head;
    GreedyDem dem(turning(), 0.5, k_water.density);
    SerialCommunicator serial;
    CoupledRun run(fed_settings(folder), k_water, fluid, &dem, serial, recorder, folder.path());
    const auto to_the_end = [&] {
        while (fluid.time() < 0.4) run.step();
    };
    EXPECT_THROW(to_the_end(), CheckFailure);
    ASSERT_GE(recorder.ledgers.size(), 2u);
    EXPECT_LE((recorder.ledgers.end() - 2)->error(), 1e-12) << "up to the step before it closed";
    const RockLedger& broken = recorder.ledgers.back();
    EXPECT_NEAR(broken.error() * broken.fed, sphere_mass(0.02, 2650.0), 1e-12) << "one rock is missing";
}

TEST(CoupledRun, releases_rock_at_its_own_time) {
    // Steps of 4 ms; the release falls between two of them.
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n2,0.0413,-0.1,0,-0.05,0.02,2650\n"), folder.path(), recorder, Vec3::Zero());
    while (rig.fluid.time() < 0.06) rig.run->step();
    ASSERT_EQ(recorder.events.size(), 2u);
    EXPECT_NEAR(recorder.events[1].time, 0.0413, 1e-12);
}

TEST(CoupledRun, follows_the_order_of_its_stages) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n"), folder.path(), recorder, Vec3::Zero());
    rig.run->step();
    rig.run->step();
    EXPECT_EQ(rig.fluid.log, "reset begin end begin end ");  // nothing is reset while no rock comes or goes
    EXPECT_LT(rig.fluid.travel_limits.back(), 1.0);
}

TEST(CoupledRun, without_rock_is_the_fluid_alone_with_its_outflow) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "");
    settings.has_rock = false;
    settings.outflow = OutflowSettings{0.015, 0.0};
    MemoryRecorder recorder;
    Rig rig(settings, folder.path(), recorder, Vec3::Zero());
    rig.fluid.flow = [](const Vec3& x, double) -> Vec3 { return 2.0 * Vec3(x[0], x[1], 0.0); };
    rig.fluid.given_loads.torque_pressure = -3.0;
    rig.fluid.given_loads.torque_viscous = -1.0;
    rig.fluid.given_loads.through_flow = 0.1;  // no patch is named as the outlet
    rig.fluid.given_loads.boundary_flow = 1e-9;
    rig.run->step();
    rig.run->finish();
    EXPECT_EQ(rig.fluid.log, "begin end ");
    EXPECT_EQ(rig.fluid.travel_limits.back(), std::numeric_limits<double>::infinity());
    EXPECT_TRUE(recorder.fate_rows.empty());
    EXPECT_NEAR(recorder.load_rows[0].power, 4.0 * 6.0, 1e-12);
    EXPECT_NEAR(recorder.balance_rows[0].flow_balance_error, 1e-8, 1e-15);
    // Radial velocity 2 r at r = contour + offset: gap (0.215), four bands of the cone, below the hub.
    ASSERT_EQ(recorder.outflow_rows[0].size(), 6u);
    EXPECT_NEAR(recorder.outflow_rows[0][0], 2.0 * 0.215, 1e-12);
    EXPECT_NEAR(recorder.outflow_rows[0][1], 2.0 * (0.1875 + 0.015 * 2.0 / std::sqrt(5.0)), 1e-9);
    EXPECT_GT(recorder.outflow_rows[0][5], 0.0);
}

TEST(CoupledRun, samples_the_outflow_from_the_step_before_its_start) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "");
    settings.has_rock = false;
    MemoryRecorder recorder;
    settings.outflow = OutflowSettings{0.015, 0.01};
    Rig rig(settings, folder.path(), recorder, Vec3::Zero());
    for (int i = 0; i < 4; ++i) rig.run->step();
    EXPECT_EQ(recorder.outflow_rows.size(), 3u);  // at 8, 12 and 16 ms
}

TEST(CoupledRun, stops_when_little_enough_is_undecided_and_every_feed_is_in) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "1,0,0.1,0,0.0,0.02,2650\n2,0.15,0.1,0,0.0,0.02,2650\n");
    settings.stop = StopSettings{0.05};
    MemoryRecorder recorder;
    Rig rig(settings, folder.path(), recorder, Vec3(0, 0, 2.0));
    int steps = 0;
    bool first_decided_early = false;
    while (!rig.run->finished() && ++steps < 1000) {
        rig.run->step();
        if (rig.fluid.time() < 0.14 && recorder.fate_rows.back().second.undecided() == 0.0) first_decided_early = true;
    }
    EXPECT_TRUE(first_decided_early);
    EXPECT_EQ(recorder.fate_rows.back().second.of(Fate::sucked_up).count, 2);
    EXPECT_LT(rig.fluid.time(), 0.4);
}

/// A feed that goes on: half of it is carried to the mouth, half is thrown out.
CouplingSettings endless_settings(const TemporaryFolder& folder, int rocks) {
    std::string feed;
    for (int i = 0; i < rocks; ++i) feed += fmt::format("{},{},0.1,{},-0.02,0.02,2650\n", i + 1, 0.06 * i, i % 2 == 0 ? 0.05 : -0.05);
    CouplingSettings settings = case_settings(folder, feed);
    settings.queue = QueueSettings{0.01, 0.05, 0.1};
    settings.fates->cutting = CuttingSettings{0.1, Vec3(0, -1, 0), 0.25};
    settings.stop = StopSettings{0.0, 0.05};
    return settings;
}

/// Time at which the run ended, 0 when it did not by 20 s.
double end_of(const CouplingSettings& settings, const std::filesystem::path& folder) {
    MemoryRecorder recorder;
    FakeFluid fluid(head_mesh(), turning(), 0.02);
    fluid.flow = through_the_head;
    FakeDem dem(turning(), 0.5, k_water.density);
    SerialCommunicator serial;
    CoupledRun run(settings, k_water, fluid, &dem, serial, recorder, folder);
    while (!run.finished() && fluid.time() < 20.0) run.step();
    return run.finished() ? fluid.time() : 0.0;
}

TEST(CoupledRun, ends_a_feed_once_its_production_is_known) {
    const TemporaryFolder folder;
    CouplingSettings settings = endless_settings(folder, 400);
    const double end = end_of(settings, folder.path());
    // Start-up takes 3 s, eight batches of a revolution follow.
    const double revolution = 2.0 * k_pi / turning().speed;
    EXPECT_GE(end, 3.0 + 8.0 * revolution);
    EXPECT_LE(end, 15.0);
    settings.stop->target_half_width = 0.0;
    EXPECT_EQ(end_of(settings, folder.path()), 0.0) << "without a target it goes on";
}

TEST(CoupledRun, needs_a_turning_zone_to_know_production) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    EXPECT_THROW(Rig(endless_settings(folder, 1), folder.path(), recorder, Vec3::Zero(), k_still), UserError);
}

TEST(CoupledRun, records_rejected_rock_and_pictures_at_field_writes) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n2,0,0.1,0,-0.05,0.02,2650\n"), folder.path(), recorder, Vec3::Zero());
    rig.dem.refuses = [](int id) { return id == 2; };
    rig.fluid.writes_fields = true;
    rig.run->step();
    ASSERT_EQ(recorder.rejections.size(), 1u);
    EXPECT_EQ(recorder.rejections[0].id, 2);
    ASSERT_EQ(recorder.pictures.size(), 1u);
    EXPECT_EQ(recorder.pictures[0], std::vector<int>{1});
    EXPECT_EQ(recorder.fate_rows.back().second.placed.count, 1);
}

TEST(CoupledRun, warns_once_of_a_closure_outside_its_range) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n2,0,0.1,0,-0.1,0.02,2650\n"), folder.path(), recorder, Vec3::Zero());
    rig.run->step();
    EXPECT_TRUE(recorder.warnings.empty());
    // 12 m/s of slip over 20 mm: Re = 2.4e5.
    rig.fluid.velocity.assign(rig.fluid.mesh.size(), Vec3(0, 0, 12.0));
    rig.run->step();
    rig.fluid.velocity.assign(rig.fluid.mesh.size(), Vec3(0, 0, 12.0));
    rig.run->step();
    ASSERT_EQ(recorder.warnings.size(), 2u);
    EXPECT_NE(recorder.warnings[0].find("brown_lawler is used at Re = 2."), std::string::npos) << recorder.warnings[0];
    EXPECT_NE(recorder.warnings[1].find("di_felice is used at Re_p"), std::string::npos) << recorder.warnings[1];
}

TEST(CoupledRun, refuses_engines_that_disagree_about_the_rotor) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    Rig rig(case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n"), folder.path(), recorder, Vec3::Zero());
    rig.run->step();
    rig.dem.angle_error = 1e-6;
    EXPECT_THROW(rig.run->step(), CheckFailure);
}

TEST(CoupledRun, names_mistakes_of_settings_and_files_at_once) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,-0.02,2650\n0,0,0.1,0,-0.05,0.02,2650\n");
    settings.kernel.gamma = -1.0;
    MemoryRecorder recorder;
    try {
        Rig rig(settings, folder.path(), recorder, Vec3::Zero());
        FAIL();
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 3u) << error.what();
    }
}

/// State of a run, to the bit.
std::vector<double> state_of(Rig& rig) {
    std::vector<double> state;
    for (const Vec3& x : rig.dem.rocks().position) state.insert(state.end(), x.data(), x.data() + 3);
    for (const Vec3& v : rig.dem.rocks().velocity) state.insert(state.end(), v.data(), v.data() + 3);
    for (const Vec3& u : rig.fluid.velocity) state.insert(state.end(), u.data(), u.data() + 3);
    state.insert(state.end(), rig.fluid.void_fraction.begin(), rig.fluid.void_fraction.end());
    return state;
}

/// A run and the same one resumed from a checkpoint of it. \param prepare  both
void expect_same_to_the_bit(CouplingSettings settings, const TemporaryFolder& folder, const std::function<void(Rig&)>& prepare) {
    settings.checkpoint = CheckpointSettings{0.04, 2};
    MemoryRecorder through;
    Rig whole(settings, folder.path(), through, Vec3(0, 0, 1.0));
    prepare(whole);
    // What OpenFOAM would have written with the checkpoint.
    std::vector<Vec3> velocity, acceleration;
    std::vector<double> void_fraction;
    double saved_time = 0.0, saved_step = 0.0;
    std::filesystem::path checkpoint;
    std::size_t events_at_checkpoint = 0;
    while (whole.fluid.time() < 0.2) {
        whole.run->step();
        if (checkpoint.empty() && !newest_checkpoint(folder.path()).empty()) {
            checkpoint = folder.path() / "kept";
            std::filesystem::copy(newest_checkpoint(folder.path()), checkpoint, std::filesystem::copy_options::recursive);
            velocity = whole.fluid.velocity;
            acceleration = whole.fluid.acceleration;
            void_fraction = whole.fluid.void_fraction;
            saved_time = whole.fluid.time();
            saved_step = whole.fluid.time_step();
            events_at_checkpoint = through.events.size();
        }
    }
    ASSERT_FALSE(checkpoint.empty());
    ASSERT_GT(saved_time, 0.03);

    MemoryRecorder after;
    Rig resumed(settings, folder.path(), after, Vec3(0, 0, 1.0));
    prepare(resumed);
    resumed.fluid.velocity = velocity;
    resumed.fluid.acceleration = acceleration;
    resumed.fluid.void_fraction = void_fraction;
    resumed.fluid.restart_at(saved_time, saved_step);
    resumed.run->resume(checkpoint);
    while (resumed.fluid.time() < 0.2) resumed.run->step();

    const std::vector<double> expected = state_of(whole), found = state_of(resumed);
    ASSERT_EQ(expected.size(), found.size());
    EXPECT_EQ(std::memcmp(expected.data(), found.data(), expected.size() * sizeof(double)), 0);
    // No event is lost or told twice.
    ASSERT_EQ(events_at_checkpoint + after.events.size(), through.events.size());
    for (std::size_t i = 0; i < after.events.size(); ++i) {
        EXPECT_EQ(after.events[i].time, through.events[events_at_checkpoint + i].time);
        EXPECT_EQ(after.events[i].id, through.events[events_at_checkpoint + i].id);
    }
    EXPECT_EQ(after.balance_rows.back().exchanged_volume, through.balance_rows.back().exchanged_volume);
    EXPECT_EQ(after.fate_rows.back().second.placed.count, through.fate_rows.back().second.placed.count);
    const RockLedger& ledger = after.ledgers.back();
    EXPECT_EQ(ledger.fed, through.ledgers.back().fed);
    EXPECT_NEAR(ledger.owed, through.ledgers.back().owed, 1e-15);
    EXPECT_NEAR(ledger.delivered, through.ledgers.back().delivered, 1e-15);
    EXPECT_NEAR(ledger.spilled_cutting, through.ledgers.back().spilled_cutting, 1e-15);
    for (const RockLedger& one : after.ledgers) EXPECT_LE(one.error(), 1e-12);
}

TEST(CouplingMethods, tell_their_models_and_without_a_medium_have_none) {
    const auto models_of = [](const CouplingSettings& settings) {
        std::string all;
        for (const ModelNote& note : coupling_method(settings).models(settings)) all += note.name + "\n";
        return all;
    };
    CouplingSettings settings;
    settings.closures.drag = "gidaspow";
    settings.closures.hindrance = "none";
    const std::string models = models_of(settings);
    EXPECT_NE(models.find("mapping: Gaussian"), std::string::npos) << models;
    EXPECT_NE(models.find("drag: gidaspow"), std::string::npos) << models;
    EXPECT_EQ(models.find("hindrance"), std::string::npos) << models;
    settings.kernel.map = k_centroid_map;
    EXPECT_EQ(models_of(settings).find("mapping: a rock is in the cell of its centre"), 0u) << models_of(settings);
    settings.has_medium = false;
    EXPECT_EQ(models_of(settings), "");
}

TEST(CouplingMethods, tell_whether_water_in_soil_rests_or_moves_with_it) {
    EXPECT_EQ(soil_model({"bank.stl", 0.0, Vec3::Zero()}).why, "section soil; water is at rest in it");
    EXPECT_EQ(soil_model({"bank.stl", 0.0, Vec3(0, -0.03, 0.04)}).why, "section soil; water in it moves with it, at 0.05 m/s");
}

/// Rock without a medium: three rocks on their ways, one of which comes in between two pictures.
struct DryRig {
    DryRig(const TemporaryFolder& folder, RunRecorder& recorder, double start) : fluid({start, 0.1, 0.025}, 2e-3) {
        CouplingSettings settings;
        settings.has_rock = true;
        settings.has_medium = false;
        settings.checkpoint = CheckpointSettings{0.05, 2};
        settings.rock_feed = folder.write("feed.csv",
                                          "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s\n"
                                          "2,0,0,0,1,0.01,2650,0,0,0\n1,0,0.1,0,2,0.02,2650,1,0,3\n3,0.0333,0.2,0,1,0.01,1500,0,0,0\n");
        dem.gravity = k_gravity;
        run.emplace(settings, FluidProperties{}, fluid, &dem, serial, recorder, folder.path());
    }
    void go_to_the_end() {
        while (fluid.running()) run->step();
    }
    inline static const Vec3 k_gravity{0.0, 0.0, -9.81};

    /// Its walls do not turn.
    struct StillDem final : FakeDem {
        StillDem() : FakeDem(k_still, 0.5, 0.0) {}
        std::vector<double> zone_angles() const override { return {}; }
    };
    NoFluid fluid;
    StillDem dem;
    SerialCommunicator serial;
    std::optional<CoupledRun> run;
};

TEST(WithoutAMedium, rock_falls_freely_from_its_time_to_the_end) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    DryRig rig(folder, recorder, 0.0);
    rig.go_to_the_end();
    EXPECT_NEAR(rig.fluid.time(), 0.1, 1e-12);
    const Rocks& rocks = rig.dem.rocks();
    ASSERT_EQ(rocks.id, (std::vector<int>{1, 2, 3}));
    const auto expect_place = [&](std::size_t p, const Vec3& start, const Vec3& velocity, double release) {
        const double way = 0.1 - release;
        EXPECT_LT((rocks.position[p] - (start + way * velocity + 0.5 * way * way * DryRig::k_gravity)).norm(), 1e-12) << rocks.id[p];
        EXPECT_LT((rocks.velocity[p] - (velocity + way * DryRig::k_gravity)).norm(), 1e-12) << rocks.id[p];
    };
    expect_place(0, Vec3(0.1, 0, 2), Vec3(1, 0, 3), 0.0);
    expect_place(1, Vec3(0, 0, 1), Vec3::Zero(), 0.0);
    expect_place(2, Vec3(0.2, 0, 1), Vec3::Zero(), 0.0333);
    EXPECT_EQ(recorder.pictures.size(), 4u);
    EXPECT_EQ(recorder.events.size(), 3u);
    EXPECT_TRUE(recorder.balance_rows.empty());
    EXPECT_TRUE(recorder.load_rows.empty());
}

TEST(WithoutAMedium, resumes_to_the_bit) {
    const TemporaryFolder folder;
    MemoryRecorder through, after;
    DryRig whole(folder, through, 0.0);
    while (newest_checkpoint(folder.path()).empty()) whole.run->step();
    const std::filesystem::path checkpoint = folder.path() / "kept";
    std::filesystem::copy(newest_checkpoint(folder.path()), checkpoint, std::filesystem::copy_options::recursive);
    const double saved = whole.fluid.time();
    EXPECT_NEAR(saved, 0.05, 2e-3);
    EXPECT_EQ(read_state(checkpoint).time, saved);
    whole.go_to_the_end();

    DryRig resumed(folder, after, saved);
    resumed.run->resume(checkpoint);
    resumed.go_to_the_end();
    ASSERT_EQ(resumed.dem.rocks().id, whole.dem.rocks().id);
    for (std::size_t p = 0; p < 3; ++p) {
        EXPECT_EQ(resumed.dem.rocks().position[p], whole.dem.rocks().position[p]);
        EXPECT_EQ(resumed.dem.rocks().velocity[p], whole.dem.rocks().velocity[p]);
    }
    EXPECT_TRUE(after.events.empty());
}

/// A flow before its rock comes, whose rotor turns once in the recording.
struct RecordedRig {
    RecordedRig(const TemporaryFolder& folder, const std::optional<RecordSettings>& record, double start = 0.0)
        : rig(settings(folder, record), folder.path(), recorder, Vec3(0.0, 0.0, 1.0)) {
        if (start > 0.0) rig.fluid.restart_at(start);
    }
    static CouplingSettings settings(const TemporaryFolder& folder, const std::optional<RecordSettings>& record) {
        CouplingSettings settings = case_settings(folder, "1,100,0.1,0,-0.05,0.02,2650\n");
        settings.record = record;
        settings.checkpoint = CheckpointSettings{0.5, 1};
        return settings;
    }
    void go_to(double time) {
        while (rig.fluid.time() < time) rig.run->step();
    }
    MemoryRecorder recorder;
    Rig rig;
};

const double k_one_turn = 2.0 * k_pi / std::abs(turning().speed);

TEST(Recording, of_a_run_from_the_beginning_takes_the_place_of_an_earlier_one) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "recording");
    folder.write("recording/of_another_flow", "");
    RecordedRig run(folder, RecordSettings{0.1, 0.2 + k_one_turn, 6, 1});
    run.go_to(0.1);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "recording/of_another_flow")) << "until there is a new one";
    run.go_to(0.25 + k_one_turn);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "recording/of_another_flow")) << run.rig.fluid.time();
    EXPECT_TRUE(run.recorder.warnings.empty()) << run.recorder.warnings.front();
    EXPECT_EQ(read_recording(folder.path() / "recording").phases, 6);
}

/// Steps of one length add up to a little less than their number of times.
TEST(Recording, ends_with_the_run_whose_last_step_ends_a_rounding_early) {
    const TemporaryFolder folder;
    const double step = 4e-3;
    int steps = static_cast<int>(k_one_turn / step) + 2;
    const auto reached = [&](int count) {
        double time = 0.0;
        for (int n = 0; n < count; ++n) time += step;
        return time;
    };
    while (reached(steps) >= step * steps) ++steps;
    RecordedRig run(folder, RecordSettings{0.0, step * steps, 6, 1});
    for (int n = 0; n < steps; ++n) run.rig.run->step();
    ASSERT_LT(run.rig.fluid.time(), step * steps);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "recording"));
}

TEST(Recording, that_is_asked_for_later_begins_later) {
    const TemporaryFolder folder;
    RecordedRig first(folder, {});
    first.go_to(0.6);
    const std::filesystem::path checkpoint = newest_checkpoint(folder.path());
    const double saved = read_state(checkpoint).time;
    RecordedRig late(folder, RecordSettings{0.2, 0.3 + k_one_turn, 6, 1}, saved);
    EXPECT_THROW(late.rig.run->resume(checkpoint), UserError);
    RecordedRig in_time(folder, RecordSettings{0.7, 0.8 + k_one_turn, 6, 1}, saved);
    in_time.rig.run->resume(checkpoint);
    in_time.go_to(0.85 + k_one_turn);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "recording"));
}

TEST(Checkpoint, of_another_angle_is_refused) {
    const TemporaryFolder folder;
    RecordedRig first(folder, {});
    first.go_to(0.6);
    const std::filesystem::path checkpoint = newest_checkpoint(folder.path());
    ZoneMotion faster = turning();
    faster.speed *= 1.5;
    MemoryRecorder recorder;
    Rig other(RecordedRig::settings(folder, {}), folder.path(), recorder, Vec3::Zero(), faster);
    other.fluid.restart_at(read_state(checkpoint).time);
    try {
        other.run->resume(checkpoint);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("the rotor stood at"), std::string::npos) << error.what();
    }
}

/// As when a run was killed after its last checkpoint.
TEST(WithoutAMedium, resumes_at_its_end_without_a_step) {
    const TemporaryFolder folder;
    MemoryRecorder through, after;
    DryRig whole(folder, through, 0.0);
    whole.go_to_the_end();
    whole.run->finish();
    const std::filesystem::path checkpoint = newest_checkpoint(folder.path());
    ASSERT_EQ(read_state(checkpoint).time, whole.fluid.time());
    DryRig resumed(folder, after, whole.fluid.time());
    resumed.run->resume(checkpoint);
    resumed.go_to_the_end();
    resumed.run->finish();
    EXPECT_TRUE(after.pictures.empty()) << "the last picture has forces that the checkpoint has not";
    EXPECT_EQ(resumed.dem.rocks().id, whole.dem.rocks().id);
}

TEST(WithoutAMedium, an_engine_that_loses_a_rock_ends_the_run) {
    const TemporaryFolder folder;
    MemoryRecorder recorder;
    struct Thief final : FakeDem {
        Thief() : FakeDem(k_still, 0.5, 0.0) {}
        std::vector<double> zone_angles() const override { return {}; }
        DemStep advance(double duration, const HydrodynamicForce& force) override {
            const DemStep step = FakeDem::advance(duration, force);
            const std::vector<int> first{rocks_.id.front()};
            remove(first);
            return step;
        }
    } dem;
    NoFluid fluid({0.0, 0.1, {}}, 2e-3);
    SerialCommunicator serial;
    CouplingSettings settings;
    settings.has_rock = true;
    settings.has_medium = false;
    settings.rock_feed =
        folder.write("feed.csv", "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n1,0,0,0,1,0.01,2650\n2,0,1,0,1,0.01,2650\n");
    CoupledRun run(settings, FluidProperties{}, fluid, &dem, serial, recorder, folder.path());
    EXPECT_THROW(run.step(), CheckFailure);
}

TEST(WithoutAMedium, what_needs_a_flow_is_refused_all_at_once) {
    CouplingSettings settings;
    settings.has_medium = false;
    settings.fates.emplace();
    settings.outflow.emplace();
    settings.velocity.emplace();
    settings.record.emplace();
    settings.replay = "somewhere";
    settings.patches.outlet = "top";
    settings.soil.emplace();
    std::string all;
    for (const Mistake& mistake : check_settings(settings, FluidProperties{}, "here")) all += mistake.text() + "\n";
    for (const char* what : {"medium none without section rock", "section fates with medium none", "section outflow with medium none",
                             "section velocity with medium none", "section record with medium none", "section replay with medium none",
                             "section patches with medium none", "section soil with medium none"})
        EXPECT_NE(all.find(what), std::string::npos) << what << " is not in\n" << all;
    settings = CouplingSettings();
    settings.has_medium = false;
    settings.has_rock = true;
    settings.rock_feed = "feed.csv";
    EXPECT_TRUE(check_settings(settings, FluidProperties{}, "here").empty());
}

TEST(Checkpoint, resumes_to_the_bit) {
    const TemporaryFolder folder;
    const std::string feed =
        "1,0,0.1,0,-0.05,0.02,2650\n2,0,-0.1,0.02,-0.05,0.02,2650\n3,0.03,0.12,0.03,-0.1,0.02,2650\n4,0.08,-0.05,0.1,-0.1,0.02,2650\n";
    expect_same_to_the_bit(case_settings(folder, feed), folder, [](Rig& rig) {
        rig.fluid.flow = nullptr;
        rig.dem.gravity = Vec3(2.0, 0.0, -9.0);
    });
}

TEST(Checkpoint, resumes_a_feed_to_the_bit) {
    const TemporaryFolder folder;
    CouplingSettings settings = fed_settings(folder);
    settings.stop = StopSettings{0.0, 0.03};
    expect_same_to_the_bit(settings, folder, [](Rig& rig) {
        rig.fluid.flow = through_the_head;
        rig.dem.is_taken = [](const Vec3& x) { return x[0] < -0.12; };
    });
}

TEST(Checkpoint, carries_the_sums_of_velocity) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "");
    settings.has_rock = false;
    settings.velocity =
        VelocitySettings{0.01, 3.0, 6, {{"adv", folder.write("adv.csv", "x_m,y_m,z_m,rotating\n0.1,0,-0.1,0\n0,0.1,-0.1,1\n"), 4}}};
    settings.checkpoint = CheckpointSettings{0.1, 100};
    const auto flow = [](const Vec3& x, double time) -> Vec3 { return {std::sin(20.0 * time) * x[1], 1.0 + time, x[0]}; };
    MemoryRecorder whole_recorder, recorder;
    Rig whole(settings, folder.path(), whole_recorder, Vec3::Zero());
    whole.fluid.flow = flow;
    std::filesystem::path checkpoint;
    double saved_time = 0.0;
    while (whole.fluid.time() < 1.3) {
        whole.run->step();
        if (saved_time > 0.5 || newest_checkpoint(folder.path()).empty()) continue;
        checkpoint = newest_checkpoint(folder.path());
        saved_time = std::stod(checkpoint.filename());
    }
    whole.run->finish();
    Rig resumed(settings, folder.path(), recorder, Vec3::Zero());
    resumed.fluid.flow = flow;
    resumed.fluid.restart_at(saved_time);
    ASSERT_TRUE(std::filesystem::exists(checkpoint / "velocity.sums"));
    resumed.run->resume(checkpoint);
    while (resumed.fluid.time() < 1.3) resumed.run->step();
    resumed.run->finish();
    ASSERT_EQ(whole_recorder.last_velocity.size(), 2u);
    // The times of both runs are sums of the same steps but for the name of the checkpoint, which has six digits.
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR((whole_recorder.last_velocity[i] - recorder.last_velocity[i]).norm(), 0.0, 1e-5);
    EXPECT_GT(whole_recorder.last_velocity[0].norm(), 1.0);

    std::filesystem::remove(checkpoint / "velocity.sums");
    Rig without(settings, folder.path(), recorder, Vec3::Zero());
    without.fluid.restart_at(saved_time);
    EXPECT_THROW(without.run->resume(checkpoint), UserError);
}

TEST(Checkpoint, keeps_the_newest_and_leaves_no_part_behind) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n");
    settings.checkpoint = CheckpointSettings{0.01, 2};
    MemoryRecorder recorder;
    Rig rig(settings, folder.path(), recorder, Vec3::Zero(), k_still);
    std::filesystem::create_directories(folder.path() / "checkpoints/0.004.part");  // of a run that was killed
    while (rig.fluid.time() < 0.06) rig.run->step();
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "checkpoints")) names.push_back(entry.path().filename());
    EXPECT_EQ(names.size(), 2u);
    for (const std::string& name : names) EXPECT_EQ(name.find("part"), std::string::npos);
    EXPECT_NEAR(std::stod(newest_checkpoint(folder.path()).filename()), rig.fluid.time(), 0.011);
}

TEST(Checkpoint, takes_precedence_over_later_times) {
    const TemporaryFolder folder;
    for (const char* name :
         {"0", "0.25", "0.3", "1e-05", "constant", "checkpoints/0.25", "checkpoints/0.4.part", "processor0/0.25", "processor0/0.31"})
        std::filesystem::create_directories(folder.path() / name);
    EXPECT_EQ(times_after_checkpoint(folder.path()).size(), 2u);
    drop_times_after_checkpoint(folder.path());
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "0.3"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "processor0/0.31"));
    for (const char* name : {"0", "0.25", "1e-05", "constant", "processor0/0.25"})
        EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
    std::filesystem::remove_all(folder.path() / "checkpoints");
    EXPECT_TRUE(times_after_checkpoint(folder.path()).empty());
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
}

/// A run of one rock up to its first checkpoint.
struct RunWithCheckpoint {
    RunWithCheckpoint() {
        settings.checkpoint = CheckpointSettings{0.01, 2};
        Rig rig(settings, folder.path(), recorder, Vec3::Zero());
        while (newest_checkpoint(folder.path()).empty()) rig.run->step();
        checkpoint = newest_checkpoint(folder.path());
        time = rig.fluid.time();
    }
    void resume_at(double start) {
        Rig fresh(settings, folder.path(), recorder, Vec3::Zero());
        fresh.fluid.restart_at(start);
        fresh.run->resume(checkpoint);
    }

    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n");
    MemoryRecorder recorder;
    std::filesystem::path checkpoint;
    double time = 0.0;
};

TEST(Checkpoint, of_another_time_or_mesh_is_refused) {
    RunWithCheckpoint run;
    EXPECT_THROW(run.resume_at(0.0), UserError);
    EXPECT_NO_THROW(run.resume_at(run.time));
    std::filesystem::resize_file(run.checkpoint / "carry.0", 100);
    EXPECT_THROW(run.resume_at(run.time), UserError);
}

/// Tables of a start at the same time are replaced once nothing can refuse the new one.
TEST(Checkpoint, that_is_refused_leaves_the_tables_of_the_run) {
    RunWithCheckpoint run;
    const auto events = run.folder.path() / "postProcessing/rock/0/events.csv";
    {
        CsvRecorder recorder(run.folder.path(), run.settings, 0.0);
        Rig rig(run.settings, run.folder.path(), recorder, Vec3::Zero());
        rig.run->step();
        rig.run->finish();
    }
    const std::string before = text_of(events);
    EXPECT_EQ(std::count(before.begin(), before.end(), '\n'), 2);
    CsvRecorder recorder(run.folder.path(), run.settings, 0.0);
    Rig rig(run.settings, run.folder.path(), recorder, Vec3::Zero());
    EXPECT_THROW(rig.run->resume(run.checkpoint), UserError);
    EXPECT_EQ(text_of(events), before);
}

TEST(Checkpoint, whose_carry_counts_more_cells_than_it_holds_is_refused) {
    const TemporaryFolder folder;
    const std::vector<std::int64_t> cells{1};
    for (const std::uint64_t count : {std::uint64_t{1}, std::uint64_t{1} << 59, ~std::uint64_t{0}}) {
        std::ofstream(folder.path() / "carry.0", std::ios::binary).write(reinterpret_cast<const char*>(&count), sizeof count);
        EXPECT_THROW(read_carry(folder.path(), 1, cells), UserError) << count;
    }
}

TEST(Checkpoint, of_carried_momentum_that_is_no_number_is_refused) {
    const TemporaryFolder folder;
    const std::vector<std::int64_t> cells{1, 2};
    const std::vector<Vec3> carry{Vec3::Zero(), Vec3(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0)};
    write_carry(folder.path(), 0, cells, carry);
    EXPECT_THROW(read_carry(folder.path(), 1, cells), UserError);
}

/// Without a check nlohmann's conversion to int of each of these is undefined or gives another number.
TEST(Checkpoint, whose_state_holds_numbers_that_int_cannot_is_refused_with_all_of_them) {
    const TemporaryFolder folder;
    RunState state;
    state.feed.placed = {1, 2};
    state.rocks[2].id = 2;
    state.rocks[2].last_exit_bin = 3;
    write_state(folder.path(), state);
    EXPECT_EQ(read_state(folder.path()).rocks.at(2).last_exit_bin, 3u);
    nlohmann::json document = nlohmann::json::parse(std::ifstream(folder.path() / "state.json"));
    document["ranks"] = 1e300;
    document["feed"]["placed"][1] = 4294967297;
    document["rocks"][0]["id"] = 2.5;
    document["rocks"][0]["last_exit_bin"] = -1;
    std::ofstream(folder.path() / "state.json") << document.dump();
    try {
        read_state(folder.path());
        FAIL();
    } catch (const UserError& error) {
        ASSERT_EQ(error.mistakes().size(), 4u) << error.what();
        EXPECT_EQ(error.mistakes()[0].what, "ranks = 1e+300");
        EXPECT_NE(error.mistakes()[0].remedy.find("Remove this checkpoint folder"), std::string::npos);
    }
}

TEST(Checkpoint, whose_account_has_rock_at_an_unknown_place_is_refused) {
    const TemporaryFolder folder;
    RunState state;
    state.account = {{1, 0.5, 0, Whereabouts::decided}};
    write_state(folder.path(), state);
    EXPECT_EQ(read_state(folder.path()).account->front().where, Whereabouts::decided);
    nlohmann::json document = nlohmann::json::parse(std::ifstream(folder.path() / "state.json"));
    document["account"]["where"][0] = k_whereabouts.size();
    std::ofstream(folder.path() / "state.json") << document.dump();
    EXPECT_THROW(read_state(folder.path()), UserError);
}

TEST(Checkpoint, whose_rock_left_through_a_bin_that_the_head_has_not_is_refused) {
    RunWithCheckpoint run;
    RunState state = read_state(run.checkpoint);
    state.rocks.at(1).last_exit_bin = 0;
    write_state(run.checkpoint, state);
    EXPECT_NO_THROW(run.resume_at(run.time));
    state.rocks.at(1).last_exit_bin = 100000;
    write_state(run.checkpoint, state);
    EXPECT_THROW(run.resume_at(run.time), UserError);
}

TEST(Checkpoint, is_written_and_read_by_every_rank) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n");
    settings.checkpoint = CheckpointSettings{0.01, 1};
    const SyntheticMesh whole = head_mesh();
    testing::ThreadedRanks(2).run([&](Communicator& communicator) {
        const auto mine = [&](std::size_t c) { return static_cast<int>(c % 2) == communicator.rank(); };
        SilentRecorder recorder;
        FakeFluid fluid(whole.part(mine), turning(), 4e-3), again(whole.part(mine), turning(), 4e-3);
        FakeDem dem(turning(), 0.5, k_water.density), dem_again(turning(), 0.5, k_water.density);
        CoupledRun run(settings, k_water, fluid, &dem, communicator, recorder, folder.path());
        for (int n = 0; n < 4; ++n) run.step();
        run.finish();
        again.restart_at(fluid.time());
        CoupledRun resumed(settings, k_water, again, &dem_again, communicator, recorder, folder.path());
        resumed.resume(newest_checkpoint(folder.path()));
        EXPECT_EQ(dem_again.rocks().id, dem.rocks().id);
    });
}

TEST(Checkpoint, is_read_on_another_number_of_ranks) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n");
    settings.checkpoint = CheckpointSettings{0.01, 1};
    const SyntheticMesh whole = head_mesh();
    double stopped_at = 0.0;
    testing::ThreadedRanks(2).run([&](Communicator& communicator) {
        const auto mine = [&](std::size_t c) { return static_cast<int>(c % 2) == communicator.rank(); };
        SilentRecorder recorder;
        FakeFluid fluid(whole.part(mine), turning(), 4e-3);
        FakeDem dem(turning(), 0.5, k_water.density);
        dem.gravity = Vec3(0, 0, -9.81);
        CoupledRun run(settings, k_water, fluid, &dem, communicator, recorder, folder.path());
        for (int n = 0; n < 4; ++n) run.step();
        run.finish();
        if (communicator.rank() == 0) stopped_at = fluid.time();
    });
    const auto checkpoint = newest_checkpoint(folder.path());
    const std::vector<Vec3> alone = read_carry(checkpoint, 2, whole.ids);
    double largest = 0.0;
    for (const Vec3& momentum : alone) largest = std::max(largest, momentum.norm());
    EXPECT_GT(largest, 0.0);
    testing::ThreadedRanks(3).run([&](Communicator& communicator) {
        const SyntheticMesh part = whole.part([&](std::size_t c) { return static_cast<int>(c / 7 % 3) == communicator.rank(); });
        const std::vector<Vec3> mine = read_carry(checkpoint, 2, part.ids);
        for (std::size_t c = 0; c < part.size(); ++c) EXPECT_EQ(mine[c], alone[static_cast<std::size_t>(part.ids[c])]);
        SilentRecorder recorder;
        FakeFluid fluid(part, turning(), 4e-3);
        FakeDem dem(turning(), 0.5, k_water.density);
        fluid.restart_at(stopped_at);
        CoupledRun resumed(settings, k_water, fluid, &dem, communicator, recorder, folder.path());
        resumed.resume(checkpoint);
        EXPECT_EQ(dem.rocks().id, std::vector<int>{1});
    });
}

TEST(CsvRecorder, has_tables_as_far_as_its_pictures) {
    const TemporaryFolder folder;
    CsvRecorder recorder(folder.path(), case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n"), 0.0);
    recorder.begin();
    const auto rejected = folder.path() / "postProcessing/rock/0/rejected.csv";
    recorder.rejected({7, 0.25, "no_room"});
    recorder.picture({});
    EXPECT_NE(text_of(rejected).find("7,0.25,no_room"), std::string::npos);
}

TEST(CsvRecorder, leaves_pictures_that_it_replaces_out_of_the_series_at_once) {
    const TemporaryFolder folder;
    const CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n");
    const double resumed_at = 0.2512336;  // less than the name of its picture
    const auto picture_at = [](CsvRecorder& recorder, double time) {
        RockPicture picture;
        picture.time = time;
        recorder.picture(picture);
    };
    CsvRecorder killed(folder.path(), settings, 0.0);
    killed.begin();
    for (const double time : {0.125, resumed_at, 0.375}) picture_at(killed, time);
    CsvRecorder resumed(folder.path(), settings, resumed_at);
    resumed.begin();
    const auto has = [&](const char* name) {
        return text_of(folder.path() / "postProcessing/rock/rocks.pvd").find(name) != std::string::npos;
    };
    EXPECT_TRUE(has("rocks_0.125.vtp"));
    EXPECT_TRUE(has("rocks_0.251234.vtp"));
    EXPECT_FALSE(has("rocks_0.375.vtp"));
    picture_at(resumed, 0.5);
    EXPECT_TRUE(has("rocks_0.5.vtp"));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "postProcessing/rock/vtk/rocks_0.375.vtp"));
}

// Killed twice before a checkpoint; what 2 ranks took in two steps of 1.5 s counts once.
TEST(CsvRecorder, notes_what_a_start_took_whose_tables_it_replaces) {
    const TemporaryFolder folder;
    const CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n");
    const auto cost = folder.path() / "postProcessing/cost/0.5";
    {
        CsvRecorder killed(folder.path(), settings, 0.5, 2);
        killed.begin();
        CostRow row;
        row.step = 1.5;
        killed.cost(row);
        killed.cost(row);
        killed.flush();
    }
    EXPECT_EQ(replaced_core_seconds(folder.path()), 0.0) << "its tables are there";
    for (int starts = 0; starts < 2; ++starts) CsvRecorder(folder.path(), settings, 0.5, 2).begin();
    EXPECT_NEAR(replaced_core_seconds(folder.path()), 2 * 2 * 1.5, 1e-12);
    folder.write("postProcessing/cost/0.5/cost.json", R"({"core_s": 4.5})");
    CsvRecorder(folder.path(), settings, 0.5, 2).begin();
    EXPECT_NEAR(replaced_core_seconds(folder.path()), 2 * 2 * 1.5 + 4.5, 1e-12);
    EXPECT_FALSE(std::filesystem::exists(cost / "cost.json")) << "this start has not come to its end";
}

TEST(CsvRecorder, keeps_the_warnings_of_a_start_that_is_killed) {
    const TemporaryFolder folder;
    CsvRecorder recorder(folder.path(), case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n"), 0.5);
    recorder.begin();
    recorder.warning(0.75, "events[0] (remove) finds nothing in its region");
    EXPECT_EQ(text_of(folder.path() / "postProcessing/cost/0.5/warnings.txt"),
              "time 0.75 s: events[0] (remove) finds nothing in its region\n");
}

TEST(CsvRecorder, writes_the_files_of_the_contract) {
    const TemporaryFolder folder;
    CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n2,0,-0.1,0.02,-0.05,0.02,2650\n");
    settings.outflow = OutflowSettings{0.015, 0.0};
    settings.velocity = VelocitySettings{0.0, 1.0, 6, {{"adv", folder.write("adv.csv", "x_m,y_m,z_m,rotating\n0.1,0,-0.1,0\n"), 2}}};
    {
        CsvRecorder recorder(folder.path(), settings, 0.0);
        recorder.describe({{"brown_lawler", "rock"}}, {{"cutterflow", "0.1"}});
        Rig rig(settings, folder.path(), recorder, Vec3(0, 0, 1.0));
        rig.dem.refuses = [](int id) { return id == 2; };
        rig.fluid.writes_fields = true;
        for (int n = 0; n < 5; ++n) rig.run->step();
        rig.run->finish();
    }
    const auto root = folder.path() / "postProcessing";
    const auto lines = [&](const std::string& file) {
        const std::string text = text_of(root / file);
        return std::count(text.begin(), text.end(), '\n');
    };
    EXPECT_EQ(lines("rock/0/events.csv"), 2);
    EXPECT_EQ(lines("rock/0/fates.csv"), 6);
    EXPECT_EQ(lines("rock/0/rejected.csv"), 2);
    EXPECT_EQ(lines("rock/0/final.csv"), 2);
    EXPECT_EQ(lines("outflow/0/contour_velocity.csv"), 6);
    EXPECT_EQ(lines("outflow/0/contour_flux.csv"), 6);
    EXPECT_EQ(lines("velocity/0/adv.csv"), 2);
    EXPECT_EQ(lines("velocity/0/adv_phases.csv"), 3);
    EXPECT_EQ(lines("loads/0/loads.csv"), 6);
    EXPECT_EQ(lines("balance/0/balance.csv"), 6);
    EXPECT_EQ(lines("cost/0/cost.csv"), 6);
    EXPECT_EQ(text_of(root / "outflow/0/contour_velocity.csv").rfind("time_s,gap,0-50mm,50-100mm,100-150mm,150-200mm,below_hub\n", 0), 0u);
    const std::string event = text_of(root / "rock/0/events.csv");
    EXPECT_NE(event.find("\n0,1,feed,in,0.1,0,-0.05,0,0,1,0,0,-0.05,0.02,2650,\n"), std::string::npos) << event;
    const auto cost = nlohmann::json::parse(text_of(root / "cost/0/cost.json"));
    EXPECT_EQ(cost["steps"], 5);
    EXPECT_EQ(cost["models"][0]["name"], "brown_lawler");
    double shares = 0.0;
    for (const auto& share : cost["share"]) shares += share.get<double>();
    EXPECT_NEAR(shares, 1.0, 1e-12);
    EXPECT_NE(text_of(root / "rock/rocks.pvd").find("file=\"vtk/rocks_"), std::string::npos);
    const std::string every_line = text_of(root / "balance/0/balance.csv");
    const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    std::istringstream rows(every_line);
    std::string header, row;
    std::getline(rows, header);
    EXPECT_NE(header.find(",overfull_cells,swept_limited_cells,wake_limited_rocks,hidden_rocks,cramped_rocks,"), std::string::npos);
    while (std::getline(rows, row)) EXPECT_EQ(commas(row), commas(header));
}

// A triangle of 0.02 m2 and one without area.
TEST(CsvRecorder, writes_the_work_of_rock_on_walls_at_every_picture) {
    const TemporaryFolder folder;
    const CouplingSettings settings = case_settings(folder, "1,0,0.1,0,-0.05,0.02,2650\n");
    const SteelTriangle triangle{Vec3(0, 0, 0), Vec3(0.2, 0, 0), Vec3(0, 0.2, 0)}, line{Vec3(0, 0, 0), Vec3(0.2, 0, 0), Vec3(0.1, 0, 0)};
    {
        CsvRecorder recorder(folder.path(), settings, 0.0);
        Rig rig(settings, folder.path(), recorder, Vec3(0, 0, 1.0));
        rig.fluid.writes_fields = true;
        for (int n = 1; n <= 3; ++n) {
            rig.dem.works = {{"head", 0.001, {triangle, line}, {0.5 * n, 0.25}, {0.1 * n, 0.0}}, {"plate", 0.0, {line}, {0.0}, {0.0}}};
            rig.run->step();
        }
        rig.run->finish();
    }
    const auto root = folder.path() / "postProcessing/rock";
    EXPECT_EQ(text_of(root / "0/wall_work.csv"),
              "time_s,wall,impact_j,sliding_j,since_s\n"
              "0.004,head,0.75,0.1,0.001\n0.004,plate,0,0,0\n"
              "0.008,head,1.25,0.2,0.001\n0.008,plate,0,0,0\n"
              "0.012,head,1.75,0.3,0.001\n0.012,plate,0,0,0\n");
    const std::string surface = text_of(root / "wall_work_head.vtp");
    for (const char* part : {"NumberOfPolys=\"2\"", "Name=\"impact_j_m2\" NumberOfComponents=\"1\" format=\"ascii\">\n75\n0\n</DataArray>",
                             "Name=\"sliding_j_m2\" NumberOfComponents=\"1\" format=\"ascii\">\n15\n0\n</DataArray>",
                             "\n0 0 0\n0.2 0 0\n0 0.2 0\n", "\n0 1 2\n3 4 5\n", "\n3\n6\n"})
        EXPECT_NE(surface.find(part), std::string::npos) << part << '\n' << surface;
    EXPECT_TRUE(std::filesystem::exists(root / "wall_work_plate.vtp"));
}

}  // namespace
}  // namespace cutterflow::coupling
