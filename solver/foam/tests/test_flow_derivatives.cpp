// Vorticity and stress divergence of flows that central differences resolve exactly.
#include <gtest/gtest.h>

#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/tests/fluid_run.hpp"

#include "dynamicFvMesh.H"
#include "volFields.H"

namespace cutterflow::foam {
namespace {

TEST(FlowDerivatives, AreThoseOfAParabolicShearFlow) {
    testing::Box box;
    testing::TinyCase tiny = testing::laminar_case("parabola", testing::block_mesh(box), 1e-3, 1.0);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*\" { type zeroGradient; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    testing::FluidRun run(testing::build_case(tiny), true);
    auto& velocity = run.session().mesh().lookupObjectRef<Foam::volVectorField>("U");
    forAll(velocity, i) {
        const Foam::vector& x = velocity.mesh().C()[i];
        velocity[i] = Foam::vector(2.0 * x.z() * x.z() - 3.0 * x.y(), 0.0, 0.0);
    }
    velocity.correctBoundaryConditions();
    const auto curl = run.engine().vorticity();
    const auto stress = run.engine().stress_divergence();
    const double nu = run.engine().fluid_properties().kinematic_viscosity;
    int inside = 0;
    for (std::size_t i = 0; i < run.cells(); ++i) {
        const Vec3 x = run.centre(i);
        if ((x.array() < 0.2).any() || (x.array() > 0.8).any()) continue;
        ++inside;
        EXPECT_LE((curl[i] - Vec3(0.0, 4.0 * x.z(), 3.0)).norm(), 1e-10);
        EXPECT_LE((stress[i] - Vec3(4.0 * nu, 0.0, 0.0)).norm(), 1e-9 * nu);
    }
    EXPECT_GT(run.total(inside), 0);
}

}  // namespace
}  // namespace cutterflow::foam
