#include <gtest/gtest.h>

#include "geometry/base/sphere.hpp"
#include "solver/coupling/tests/coupling_rig.hpp"
#include "solver/replay/frozen_fluid.hpp"

namespace cutterflow::coupling {
namespace {

using testing::FakeDem;
using testing::FakeFluid;
using testing::SyntheticMesh;

constexpr double k_diameter = 0.02;
constexpr double k_step = 1e-3;
const Vec3 k_stream(0.4, -0.1, 0.2);

SyntheticMesh water() {
    return testing::box(0.1, 0.01);
}

FlowRecording uniform_stream(const SyntheticMesh& mesh) {
    FlowRecording recording;
    recording.phases = 2;
    recording.moving = testing::unit_turn();
    recording.steel.resize(2);
    recording.cells = {mesh.ids, mesh.centres, mesh.volumes, mesh.sizes, mesh.in_rotor};
    for (std::vector<double>& weight : recording.weight) weight.assign(2, 1.0);
    for (std::size_t n = 0; n < 2 * mesh.size(); ++n)
        for (int k = 0; k < 3; ++k) recording.velocity.push_back(static_cast<float>(k_stream[k]));
    recording.acceleration.assign(recording.velocity.size(), 0.0F);
    return recording;
}

/// A rock that starts at rest at the origin, followed for `steps`.
struct Follower {
    explicit Follower(FluidEngine& engine)
        : fluid(engine),
          dem(testing::unit_turn().front(), 0.5, testing::k_water.density),
          coupling(testing::settings_with_shell(), testing::k_water, engine, dem, serial) {
        FeedRock rock;
        rock.id = 1;
        rock.diameter = k_diameter;
        rock.density = 2650.0;
        rock.velocity = Vec3::Zero();
        coupling.insert({rock});
    }
    void step() {
        coupling.sample();
        fluid.begin_step(k_step, std::numeric_limits<double>::infinity());
        coupling.move();
        coupling.map();
        fluid.end_step(coupling.void_fraction_old(), coupling.void_fraction_new(), coupling.exchange());
        coupling.book();
    }
    FluidEngine& fluid;
    FakeDem dem;
    SerialCommunicator serial;
    KernelCoupling coupling;
};

TEST(OneWay, rock_moves_in_a_recorded_flow_as_in_the_same_flow_that_a_solver_gives) {
    FakeFluid solved(water(), testing::unit_turn().front(), k_step);
    solved.flow = [](const Vec3&, double) { return k_stream; };
    for (Vec3& u : solved.velocity) u = k_stream;
    FrozenFluid frozen(uniform_stream(water()), {0.0, 1.0, {}});
    Follower in_solved(solved), in_frozen(frozen);
    for (int i = 0; i < 50; ++i) {
        in_solved.step();
        in_frozen.step();
    }
    const Vec3 place = in_frozen.dem.rocks().position[0];
    EXPECT_GT(place.norm(), 1e-3);
    EXPECT_NEAR((place - in_solved.dem.rocks().position[0]).norm(), 0.0, 1e-7 * place.norm());  // floats in the recording
}

TEST(OneWay, void_fraction_is_kept_and_the_flow_is_not_changed) {
    const SyntheticMesh mesh = water();
    FrozenFluid frozen(uniform_stream(mesh), {0.0, 1.0, {}});
    Follower follower(frozen);
    for (int i = 0; i < 10; ++i) follower.step();
    double solid = 0.0;
    for (std::size_t c = 0; c < mesh.size(); ++c) {
        solid += (1.0 - frozen.fields().void_fraction[c]) * mesh.volumes[c];
        EXPECT_NEAR((frozen.fields().velocity[c] - k_stream).norm(), 0.0, 1e-7);
    }
    EXPECT_NEAR(solid, sphere_volume(k_diameter), 1e-12 * sphere_volume(k_diameter) + 1e-18);
}

TEST(OneWay, the_step_follows_the_kernel) {
    FrozenFluid frozen(uniform_stream(testing::box(0.06, 0.004)), {0.0, 1.0, {}});
    Follower follower(frozen);
    for (int i = 0; i < 20; ++i) follower.step();
    const double by_kernel = 0.5 * k_diameter / follower.dem.rocks().velocity[0].norm();  // gamma is 1
    EXPECT_NEAR(follower.coupling.travel_limit(), by_kernel, 1e-9 * by_kernel);
}

}  // namespace
}  // namespace cutterflow::coupling
