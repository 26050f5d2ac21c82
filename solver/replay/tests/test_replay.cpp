#include <cmath>
#include <fstream>
#include <optional>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "solver/ports/recording_summary.hpp"
#include "solver/ports/testing/fake_engines.hpp"
#include "solver/ports/testing/temporary_folder.hpp"
#include "solver/replay/frozen_fluid.hpp"
#include "solver/replay/phase_recorder.hpp"

namespace cutterflow::coupling {
namespace {

using testing::FakeFluid;
using testing::SyntheticMesh;
using testing::TemporaryFolder;

constexpr double k_turn = 2.0 * k_pi;
constexpr int k_blades = 4;
constexpr int k_phases = 24;

/// Ring of turning cells within a ring of still ones. The rotor turns by one radian a second.
SyntheticMesh rings() {
    SyntheticMesh mesh;
    mesh.add_annulus(0.2, 0.4, 2, 24, 0.0, 0.1, 1, true);
    mesh.add_annulus(0.4, 0.6, 2, 24, 0.0, 0.1, 1, false);
    mesh.stator_steel.push_back({Vec3(1.0, 0.0, 0.0), Vec3(1.0, 1.0, 0.0), Vec3(1.0, 0.0, 1.0)});
    return mesh;
}

/// A flow as of `k_blades` equal blades beside something that stands still: at a place of the absolute frame it repeats after a blade.
Vec3 flow_at(const Vec3& place, double angle) {
    const double azimuth = std::atan2(place[1], place[0]);
    return {std::cos(k_blades * (azimuth - angle)), 0.3 + 0.1 * std::sin(azimuth), place[2] + std::sin(k_blades * angle)};
}

/// Sets the fields of a fake as a solver would have them at its time.
void set_flow(FakeFluid& fluid) {
    for (std::size_t c = 0; c < fluid.mesh.size(); ++c) {
        const bool turns = fluid.mesh.in_rotor[c] == 1;
        const Vec3 place = turns ? rotate_about(RotationAxis{}, fluid.time(), fluid.mesh.centres[c]) : fluid.mesh.centres[c];
        fluid.velocity[c] = flow_at(place, fluid.time());
        fluid.acceleration[c] = 10.0 * fluid.velocity[c];
    }
}

RecordSettings one_turn() {
    RecordSettings settings;
    settings.start_time = 1.0;
    settings.end_time = 1.0 + k_turn;
    settings.phases = k_phases;
    settings.blades = k_blades;
    return settings;
}

FakeFluid fake_flow(double step) {
    return FakeFluid(rings(), testing::unit_turn().front(), step);
}

void record(FakeFluid& fluid, PhaseRecorder& recorder, double until) {
    while (fluid.time() < until - 1e-9) {
        fluid.begin_step(1.0, until);
        set_flow(fluid);
        recorder.sample(fluid);
    }
}

/// Largest distance between the replayed and the true velocity over a turn.
double largest_error(const FlowRecording& recording) {
    FrozenFluid frozen(recording, {0.0, k_turn, {}});
    double error = 0.0;
    while (frozen.running()) {
        frozen.begin_step(0.01, k_turn);
        frozen.end_step({}, std::vector<double>(frozen.cells().centres.size(), 1.0), {});
        FakeFluid truth = fake_flow(1.0);
        truth.restart_at(frozen.time());
        set_flow(truth);
        for (std::size_t c = 0; c < truth.mesh.size(); ++c) {
            error = std::max(error, (frozen.fields().velocity[c] - truth.velocity[c]).norm());
            EXPECT_NEAR((frozen.fields().material_acceleration[c] - 10.0 * frozen.fields().velocity[c]).norm(), 0.0,
                        1e-4);  // floats of about 10
        }
    }
    return error;
}

FlowRecording recorded_flow(const RecordSettings& settings) {
    const TemporaryFolder folder;
    FakeFluid fluid = fake_flow(1e-3);
    PhaseRecorder recorder(settings, fluid);
    record(fluid, recorder, settings.end_time);
    EXPECT_TRUE(recorder.is_complete());
    recorder.write(folder.path(), SerialCommunicator());
    return read_recording(folder.path());
}

/// Linear interpolation of a wave of n periods a turn over P phases is off by (n step)^2 / 8 at most, and so is its mean over the hat of
/// a phase, (n step)^2 / 6 in all.
TEST(Replay, plays_the_flow_that_was_recorded_to_second_order_in_the_phase) {
    const double coarse = largest_error(recorded_flow(one_turn()));
    RecordSettings twice = one_turn();
    twice.phases *= 2;
    const double fine = largest_error(recorded_flow(twice));
    // In a turning cell a wave that stands still has k_blades periods a turn beside the one of sin(azimuth).
    const double angle_step = k_blades * k_turn / k_phases;
    EXPECT_LT(coarse, 2.0 * angle_step * angle_step * (1.0 / 8.0 + 1.0 / 12.0));
    EXPECT_GT(coarse / fine, 3.5);
}

TEST(Replay, of_a_uniform_stream_is_exact) {
    const TemporaryFolder folder;
    FakeFluid fluid = fake_flow(2e-3);
    PhaseRecorder recorder(one_turn(), fluid);
    const Vec3 stream(0.25, -0.5, 1.0);
    while (!recorder.is_over(fluid.time())) {
        fluid.begin_step(1.0, 1.0 + k_turn);
        for (Vec3& u : fluid.velocity) u = stream;
        recorder.sample(fluid);
    }
    recorder.write(folder.path(), SerialCommunicator());
    FrozenFluid frozen(read_recording(folder.path()), {0.0, 10.0, {}});
    // A turning cell's mean of a turning vector over the hat of a phase is shorter by (step)^2 / 12, and linear between phases by / 8.
    const double angle_step = k_turn / k_phases;
    for (std::size_t c = 0; c < fluid.mesh.size(); ++c)
        EXPECT_NEAR((frozen.fields().velocity[c] - stream).norm(), 0.0,
                    fluid.mesh.in_rotor[c] == 1 ? stream.norm() * angle_step * angle_step * 5.0 / 24.0 : 1e-6);
}

TEST(Replay, steps_meet_pictures_releases_and_the_end) {
    FrozenFluid frozen(recorded_flow(one_turn()), {0.0, 0.5, 0.2});
    EXPECT_FALSE(frozen.feels_rock());
    std::vector<double> pictures;
    bool met_release = false;
    while (frozen.running()) {
        frozen.begin_step(0.013, frozen.time() < 0.33 - 1e-9 ? 0.33 : 100.0);
        EXPECT_LE(frozen.time_step(), 0.013 + 1e-12);
        met_release = met_release || std::abs(frozen.time() - 0.33) < 1e-9;
        if (frozen.write_if_due()) pictures.push_back(frozen.time());
    }
    EXPECT_TRUE(met_release);
    EXPECT_NEAR(frozen.time(), 0.5, 1e-9);
    ASSERT_EQ(pictures.size(), 2u);
    EXPECT_NEAR(pictures[0], 0.2, 1e-9);
    EXPECT_NEAR(pictures[1], 0.4, 1e-9);
}

TEST(RunClock, begins_at_most_one_step_before_what_lies_within_rounding) {
    const double event = 0.84, longest = 0.01;
    RunClock clock({std::nextafter(event, 0.0), 1.4, {}}, longest);
    EXPECT_EQ(clock.step(), longest) << "what is due within a share of a step is due at once";
    clock.advance(1.0, event);
    EXPECT_GT(clock.step(), 0.0);
    EXPECT_NEAR(clock.time(), event, 1e-12);
    clock.advance(1.0, 10.0);
    EXPECT_NEAR(clock.time(), event + longest, 1e-12);
}

TEST(Replay, keeps_the_void_fraction_of_rock) {
    FrozenFluid frozen(recorded_flow(one_turn()), {0.0, 1.0, {}});
    const std::size_t cells = frozen.cells().centres.size();
    frozen.begin_step(0.01, 1.0);
    frozen.end_step({}, std::vector<double>(cells, 0.75), {});
    EXPECT_EQ(frozen.fields().void_fraction[cells / 2], 0.75);
}

TEST(Recording, is_incomplete_while_a_phase_was_not_seen) {
    FakeFluid fluid = fake_flow(1e-2);
    PhaseRecorder recorder(one_turn(), fluid);
    record(fluid, recorder, 1.0 + 0.8 * k_turn);
    EXPECT_FALSE(recorder.is_complete());
    EXPECT_FALSE(recorder.is_over(fluid.time()));
}

/// One that goes on from what a recorder writes now.
PhaseRecorder resumed(const PhaseRecorder& recorder, const FakeFluid& fluid, const std::filesystem::path& folder) {
    recorder.write(folder, SerialCommunicator());
    PhaseRecorder other(one_turn(), fluid);
    other.restore(folder);
    return other;
}

TEST(Recording, goes_on_from_a_checkpoint_as_if_it_had_not_stopped) {
    const TemporaryFolder half, rest, whole;
    FakeFluid fluid = fake_flow(1e-2);
    PhaseRecorder recorder(one_turn(), fluid);
    record(fluid, recorder, 4.0);
    PhaseRecorder other = resumed(recorder, fluid, half.path());
    FakeFluid again = fake_flow(1e-2);
    again.restart_at(fluid.time());
    record(fluid, recorder, 1.0 + k_turn);
    record(again, other, 1.0 + k_turn);
    recorder.write(whole.path(), SerialCommunicator());
    other.write(rest.path(), SerialCommunicator());
    const FlowRecording a = read_recording(whole.path()), b = read_recording(rest.path());
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.acceleration, b.acceleration);
    EXPECT_EQ(a.weight, b.weight);
}

/// Of a flow whose strength grows by `growth` in a revolution.
std::optional<double> change_of_flow(double growth, Communicator& communicator) {
    FakeFluid fluid = fake_flow(1e-2);
    PhaseRecorder recorder(one_turn(), fluid);
    while (fluid.time() < 1.0 + k_turn - 1e-9) {
        fluid.begin_step(1.0, 1.0 + k_turn);
        set_flow(fluid);
        for (Vec3& u : fluid.velocity) u *= 1.0 + growth * (fluid.time() - 1.0) / k_turn;
        recorder.sample(fluid);
    }
    return recorder.tell_change(communicator);
}

TEST(Recording, tells_how_much_the_flow_changed_over_the_revolution) {
    SerialCommunicator serial;
    const std::optional<double> developed = change_of_flow(0.0, serial), young = change_of_flow(0.25, serial);
    ASSERT_TRUE(developed && young);
    EXPECT_LT(*developed, 0.03) << "the angle of a step";
    EXPECT_NEAR(*young, 0.25 / 1.25, 0.03);
    EXPECT_FALSE(warning_of_change(developed));
    EXPECT_NE(warning_of_change(young).value_or("").find("changed by 20 %"), std::string::npos) << warning_of_change(young).value_or("");
    EXPECT_FALSE(warning_of_change({}));
}

/// Of a developed flow that was recorded until a time and went on after a checkpoint.
std::optional<double> change_after_resuming_at(double time) {
    const TemporaryFolder folder;
    FakeFluid fluid = fake_flow(1e-2);
    PhaseRecorder recorder(one_turn(), fluid);
    record(fluid, recorder, time);
    PhaseRecorder other = resumed(recorder, fluid, folder.path());
    record(fluid, other, 1.0 + k_turn);
    SerialCommunicator serial;
    return other.tell_change(serial);
}

TEST(Recording, says_nothing_of_a_change_only_when_it_was_resumed_in_between) {
    EXPECT_FALSE(change_after_resuming_at(4.0));
    const std::optional<double> before_it_began = change_after_resuming_at(0.5);
    ASSERT_TRUE(before_it_began);
    EXPECT_LT(*before_it_began, 0.03);
}

TEST(Recording, of_another_version_is_told_as_such) {
    const TemporaryFolder folder;
    write_file(folder.path() / "recording.json", "{\"schema\": \"cutterflow.recording/1\"}");
    try {
        read_recording(folder.path());
        FAIL() << "an older recording was read";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("its schema is cutterflow.recording/1"), std::string::npos) << error.what();
    }
}

TEST(Recording, of_two_ranks_is_joined) {
    const TemporaryFolder folder;
    const FlowRecording whole = recorded_flow(one_turn());
    // The cells dealt out to two ranks, alternately.
    for (std::size_t rank = 0; rank < 2; ++rank) {
        FlowRecording part = whole;
        part.cells = {};
        part.velocity.clear();
        part.acceleration.clear();
        for (std::size_t c = rank; c < whole.cells.size(); c += 2) {
            part.cells.ids.push_back(whole.cells.ids[c]);
            part.cells.centres.push_back(whole.cells.centres[c]);
            part.cells.volumes.push_back(whole.cells.volumes[c]);
            part.cells.sizes.push_back(whole.cells.sizes[c]);
            part.cells.zone.push_back(whole.cells.zone[c]);
        }
        for (std::size_t phase = 0; phase < static_cast<std::size_t>(whole.phases); ++phase)
            for (std::size_t c = rank; c < whole.cells.size(); c += 2)
                for (std::size_t k = 0; k < 3; ++k) {
                    part.velocity.push_back(whole.velocity[3 * (c + whole.cells.size() * phase) + k]);
                    part.acceleration.push_back(whole.acceleration[3 * (c + whole.cells.size() * phase) + k]);
                }
        write_recording(folder.path(), part, static_cast<int>(rank), 2);
    }
    const FlowRecording joined = read_recording(folder.path());
    ASSERT_EQ(joined.cells.size(), whole.cells.size());
    EXPECT_EQ(joined.steel[0].size(), 1u);
    for (std::size_t c = 0; c < joined.cells.size(); ++c) {
        const auto id = static_cast<std::size_t>(joined.cells.ids[c]);
        EXPECT_EQ(joined.cells.centres[c], whole.cells.centres[id]);
        for (std::size_t phase = 0; phase < static_cast<std::size_t>(whole.phases); ++phase)
            EXPECT_EQ(joined.velocity[3 * (c + joined.cells.size() * phase)], whole.velocity[3 * (id + whole.cells.size() * phase)]);
    }
}

TEST(Recording, that_is_damaged_is_refused_with_its_file) {
    const TemporaryFolder folder;
    write_recording(folder.path(), recorded_flow(one_turn()), 0, 1);
    std::filesystem::resize_file(folder.path() / "cells.0", 1000);
    try {
        read_recording(folder.path());
        FAIL() << "a truncated file was read";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("cells.0"), std::string::npos) << error.what();
    }
}

TEST(Recording, needs_one_turning_zone) {
    FakeFluid fluid = fake_flow(1e-2);
    fluid.moving.clear();
    EXPECT_THROW(PhaseRecorder(one_turn(), fluid), UserError);
}

}  // namespace
}  // namespace cutterflow::coupling
