#include <gtest/gtest.h>

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

TEST(VelocitySampler, ReproducesALinearVelocityAnywhereOnTheTurnedMesh) {
    testing::TurningCylinder shape;
    testing::TinyCase tiny = testing::laminar_case("sampler", testing::block_mesh(shape), 0.01, 0.1);
    tiny.files["constant/dynamicMeshDict"] = testing::turning(7.0);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*\" { type fixedValue; value uniform (0 0 0); }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type zeroGradient; }");
    tiny.files["system/fvSchemes"] += "gradSchemes { default leastSquares; }\n";
    FluidRun run(testing::build_case(tiny), false);
    for (int step = 0; step < 4; ++step) {
        run.begin();
        run.end({}, {});
    }
    auto& U = run.session().mesh().lookupObjectRef<Foam::volVectorField>("U");
    for (std::size_t i = 0; i < run.cells(); ++i) U[static_cast<Foam::label>(i)] = to_foam(shear(run.centre(i)));
    for (auto& patch : U.boundaryFieldRef()) {
        if (patch.coupled()) continue;
        for (Foam::label i = 0; i < patch.size(); ++i) patch[i] = to_foam(shear(to_vec3(patch.patch().Cf()[i])));
    }
    U.correctBoundaryConditions();

    // The first ones lie on cells' faces and corners, one at the interface, one outside the mesh.
    std::vector<Vec3> points = {{0.0, 0.0, 0.0},   {0.099, 0.01, 0.02},   {0.05, -0.03, 0.049}, {-0.15, 0.1, -0.04},
                                {0.01, 0.19, 0.0}, {-0.07, -0.07, 0.011}, {0.0, 0.0, 0.06}};
    std::vector<Vec3> velocity(points.size());
    run.engine().sample_velocity(points, velocity);
    for (std::size_t i = 0; i < points.size(); ++i) {
        // Between two sliding sides the gradient sees an interpolated neighbour.
        const double tolerance = std::abs(std::hypot(points[i].x(), points[i].y()) - 0.1) < 0.02 ? 5e-3 : 1e-10;
        EXPECT_LE((velocity[i] - shear(points[i])).norm(), tolerance) << "point " << i;
    }
}

}  // namespace
}  // namespace cutterflow::foam
