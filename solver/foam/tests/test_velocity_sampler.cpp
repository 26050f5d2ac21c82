#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/tests/fluid_run.hpp"

#include "dynamicFvMesh.H"
#include "volFields.H"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;

/// A velocity that is linear in space.
Vec3 shear(const Vec3& x) {
    return {1.0 + 2.0 * x.y(), 0.5 - x.z(), 3.0 * x.x()};
}

/// A cylinder with a turning core, its cells given a velocity after a few steps. Outside the interface the mesh stands.
class VelocitySampler : public ::testing::Test {
protected:
    void turn(const std::string& name, const std::string& gradient) {
        testing::TurningCylinder shape;
        testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(shape), 0.01, 0.1);
        tiny.files["constant/dynamicMeshDict"] = testing::turning(k_omega);
        tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*\" { type fixedValue; value uniform (0 0 0); }");
        tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type zeroGradient; }");
        tiny.files["system/fvSchemes"] += "gradSchemes { default " + gradient + "; }\n";
        run.emplace(testing::build_case(tiny), false);
    }

    void step() {
        set([](const Vec3&) { return Vec3::Zero(); });  // at rest, so that the step moves the mesh alone
        run->begin();
        run->end({}, {});
    }

    void set(const std::function<Vec3(const Vec3&)>& velocity) {
        auto& U = run->session().mesh().lookupObjectRef<Foam::volVectorField>("U");
        for (std::size_t i = 0; i < run->cells(); ++i) U[static_cast<Foam::label>(i)] = to_foam(velocity(run->centre(i)));
        for (auto& patch : U.boundaryFieldRef()) {
            if (patch.coupled()) continue;
            for (Foam::label i = 0; i < patch.size(); ++i) patch[i] = to_foam(velocity(to_vec3(patch.patch().Cf()[i])));
        }
        U.correctBoundaryConditions();
    }

    static constexpr double k_omega = 7.0;
    std::optional<FluidRun> run;
};

TEST_F(VelocitySampler, ReproducesALinearVelocityAnywhereOnTheTurnedMesh) {
    turn("sampler", "leastSquares");
    for (int i = 0; i < 4; ++i) step();
    set(shear);

    // The first ones lie on cells' faces and corners, one at the interface, one outside the mesh.
    std::vector<Vec3> points = {{0.0, 0.0, 0.0},   {0.099, 0.01, 0.02},   {0.05, -0.03, 0.049}, {-0.15, 0.1, -0.04},
                                {0.01, 0.19, 0.0}, {-0.07, -0.07, 0.011}, {0.0, 0.0, 0.06}};
    std::vector<Vec3> velocity(points.size());
    run->engine().sample_velocity(points, velocity);
    for (std::size_t i = 0; i < points.size(); ++i) {
        // Between two sliding sides the gradient sees an interpolated neighbour.
        const double tolerance = std::abs(std::hypot(points[i].x(), points[i].y()) - 0.1) < 0.02 ? 5e-3 : 1e-10;
        EXPECT_LE((velocity[i] - shear(points[i])).norm(), tolerance) << "point " << i;
    }
}

TEST_F(VelocitySampler, WatchesPlacesThatTurnWithTheirZone) {
    const auto curved = [](const Vec3& x) { return Vec3(std::sin(20.0 * x.y()), x.x() * x.x() - x.z(), std::cos(15.0 * x.x())); };
    turn("watch", "Gauss linear");
    step();
    coupling::WatchedPlaces places;
    places.points = {{0.05, -0.03, 0.02}, {-0.07, -0.04, 0.011}, {-0.15, 0.1, -0.04}, {0.01, 0.17, 0.0}};
    places.directions = {Vec3::UnitX(), Vec3::UnitY(), Vec3(0.6, 0.0, 0.8), Vec3::UnitZ()};
    places.groups = 2;  // in the core; outside
    run->engine().watch(places);
    for (int i = 0; i < 3; ++i) {
        step();
        set(curved);
        const double angle = k_omega * run->engine().time();
        std::vector<Vec3> points = places.points, directions = places.directions, velocity(4);
        for (std::size_t p = 0; p < 2; ++p) {
            points[p] = rotate_about({}, angle, points[p]);
            directions[p] = rotate_about({}, angle, directions[p]);
        }
        run->engine().sample_velocity(points, velocity);
        const std::vector<double> means = run->engine().watched_means();
        ASSERT_EQ(means.size(), 2u);
        for (std::size_t g = 0; g < 2; ++g) {
            const double expected = 0.5 * (velocity[2 * g].dot(directions[2 * g]) + velocity[2 * g + 1].dot(directions[2 * g + 1]));
            EXPECT_NEAR(means[g], expected, 1e-10) << "group " << g;
        }
    }
}

}  // namespace
}  // namespace cutterflow::foam
