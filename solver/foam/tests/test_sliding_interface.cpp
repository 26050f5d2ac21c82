// What the two sides of sliding interfaces disagree by, in sum and face by face.
#include <cmath>

#include <gtest/gtest.h>

#include "solver/foam/mesh_motion/overlap_flux.hpp"
#include "solver/foam/mesh_motion/sliding_interface.hpp"
#include "solver/foam/tests/fluid_run.hpp"

#include "dynamicFvMesh.H"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;

constexpr int k_around = 32;  // faces on either side
constexpr double k_omega = 2.0 * k_pi;

/// A cylinder that turns by half a face of its interface, with a uniform flow.
testing::TinyCase turning_by_half_a_face(const std::string& name) {
    const double time = k_pi / k_around / k_omega;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(testing::TurningCylinder()), time / 8, time);
    tiny.files["constant/dynamicMeshDict"] = testing::turning(k_omega);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0.7 -0.3 0.2)", "\".*\" { type fixedValue; value $internalField; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    return tiny;
}

/// The same cylinder with water that is thrown against its boundary.
testing::TinyCase thrown_water(const std::string& name) {
    testing::TinyCase tiny = turning_by_half_a_face(name);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0.7 -0.3 0.2)", "\".*\" { type fixedValue; value uniform (0 0 0); }");
    return tiny;
}

/// Water that is thrown from a hub against a rim, through two interfaces.
testing::TinyCase rings(const std::string& name) {
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(testing::ThreeRings()), 1e-3, 0.02);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0.7 -0.3 0)",
                                              "hub { type fixedValue; value uniform (0.5 0.2 0); } rim { type noSlip; }\n"
                                              "ends { type slip; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type zeroGradient; }");
    return tiny;
}

/// Through face f of a regular polygon a uniform flow is proportional to cos(a_f - a_u). Half a face further two faces overlap it in equal
/// parts, and carry [cos(a_f - a_u + h/2) + cos(a_f - a_u - h/2)]/2 = cos(a_f - a_u) cos(h/2) with h = 2 pi/N.
TEST(InterfaceMismatch, is_that_of_two_polygons) {
    FluidRun run(testing::build_case(turning_by_half_a_face("mismatch_of_polygons")), false);
    const Foam::fvMesh& mesh = run.session().mesh();
    const auto mismatch = [&] {
        const InterfaceFlow flow = interface_flow(
            Foam::surfaceScalarField(mesh.Sf() & Foam::dimensionedVector("u", Foam::dimVelocity, Foam::vector(0.7, -0.3, 0.2))));
        EXPECT_LE(flow.imbalance, 1e-12 * flow.gross);
        return flow.mismatch / (0.5 * flow.gross);
    };
    EXPECT_LE(mismatch(), 1e-9);
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
    }
    const double expected = 1.0 - std::cos(k_pi / k_around);
    EXPECT_NEAR(mismatch(), expected, 0.01 * expected);
}

/// The solver's fluxes are one for each part.
TEST(InterfaceMismatch, is_rounding_in_a_flow) {
    FluidRun run(testing::build_case(thrown_water("mismatch_of_a_flow")), false);
    double imbalance = 0.0, mismatch = 0.0;
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
        imbalance = std::max(imbalance, run.engine().loads().interface_imbalance);
        mismatch = std::max(mismatch, run.engine().loads().interface_mismatch);
    }
    EXPECT_GE(run.deviation(Vec3(0.7, -0.3, 0.2)), 0.1);
    EXPECT_LE(imbalance, 1e-12);
    EXPECT_GT(mismatch, 0.0);
    EXPECT_LE(mismatch, 1e-12);
}

/// Both sides have their own numbers for a part: the mismatch sees what one of them says, and what its face says of their sum.
TEST(InterfaceMismatch, shows_a_part_that_has_two_fluxes) {
    FluidRun run(testing::build_case(turning_by_half_a_face("mismatch_of_parts")), false);
    Foam::fvMesh& mesh = run.session().mesh();
    const MovingZones zones = read_moving_zones(run.session().mesh());
    SlidingOverlap overlap(mesh, zones, 0.0);
    overlap.set(0.4 * 2.0 * k_pi / k_around);
    OverlapFlux parts(mesh);
    parts.couple(overlap);
    ASSERT_EQ(parts.sides().size(), 2u);
    Foam::surfaceScalarField flux("flux", 0.0 * mesh.magSf());
    for (PartFluxes& part : parts.sides()) {
        part.flux = part.side.area() & Foam::vector(0.7, -0.3, 0.2);
        flux.boundaryFieldRef()[part.side.patch()] = part.side.sum(part.flux);
    }
    const auto mismatch = [&] {
        const InterfaceFlow flow = interface_flow(flux, &parts);
        return flow.mismatch / (0.5 * flow.gross);
    };
    EXPECT_LE(mismatch(), 1e-14);
    PartFluxes& liar = parts.sides().front();
    const Foam::scalarField honest(liar.flux);
    liar.flux *= 1.1;
    EXPECT_NEAR(mismatch(), 0.05, 1e-3);  // of the faces of one side out of two
    liar.flux = honest;
    forAll(honest, k) liar.flux[k] += (k % 2 == 0 ? 0.1 : -0.1) * Foam::mag(honest[k]);
    EXPECT_GT(mismatch(), 0.01);
    liar.flux = honest;
    flux.boundaryFieldRef()[liar.side.patch()] *= 1.1;
    EXPECT_NEAR(mismatch(), 0.05, 3e-3);
}

/// What one side adds and takes away in turn is nothing in sum.
TEST(InterfaceMismatch, shows_a_lie_that_the_sum_does_not) {
    FluidRun run(testing::build_case(turning_by_half_a_face("mismatch_of_a_lie")), false);
    const Foam::fvMesh& mesh = run.session().mesh();
    const InterfacePair pair = interface_pairs(mesh).at(0);
    Foam::surfaceScalarField flux("flux", mesh.magSf());
    flux.boundaryFieldRef()[pair.neighbour] *= -1.0;
    const InterfaceFlow honest = interface_flow(flux);
    EXPECT_LE(honest.mismatch, 1e-6 * honest.gross);
    const Foam::vectorField normal(mesh.boundary()[pair.owner].nf());
    forAll(normal, i) {
        const bool odd = std::fmod(std::floor((std::atan2(normal[i].y(), normal[i].x()) + k_pi) * k_around / (2.0 * k_pi)), 2.0) == 1.0;
        flux.boundaryFieldRef()[pair.owner][i] *= odd ? 1.1 : 0.9;
    }
    const InterfaceFlow lie = interface_flow(flux);
    EXPECT_LE(lie.imbalance, 1e-6 * lie.gross);
    EXPECT_NEAR(lie.gross, honest.gross, 1e-6 * honest.gross);
    EXPECT_NEAR(lie.mismatch / (0.5 * lie.gross), 0.1, 1e-3);
}

/// One side of the interface says that a hundredth less flows out of it than comes in at the other.
TEST(InterfaceImbalance, shows_an_interface_that_does_not_close) {
    constexpr double lost = 0.01;
    FluidRun run(testing::build_case(turning_by_half_a_face("interface_that_leaks")), false);
    run.begin();
    run.end({}, {});
    const Foam::fvMesh& mesh = run.session().mesh();
    const InterfacePair pair = interface_pairs(mesh).at(0);
    EXPECT_LE(run.engine().loads().interface_imbalance, 1e-5);
    Foam::surfaceScalarField flux("flux", mesh.lookupObject<Foam::surfaceScalarField>("phi"));
    const InterfaceFlow honest = interface_flow(flux);
    double missing = 0.0;
    for (double& of_face : flux.boundaryFieldRef()[pair.owner]) {
        if (of_face <= 0.0) continue;
        missing += lost * of_face;
        of_face *= 1.0 - lost;
    }
    missing = run.total(missing);
    EXPECT_NEAR(missing, 0.25 * lost * honest.gross, 0.01 * lost * honest.gross);  // half of the flow of either side goes out
    const InterfaceFlow lie = interface_flow(flux);
    EXPECT_NEAR(lie.net, -missing, 1e-3 * missing);
    EXPECT_NEAR(lie.imbalance, missing, 1e-3 * missing);
}

/// What one interface has too much does not make up for what another lacks.
TEST(InterfaceImbalance, adds_up_interfaces_one_by_one) {
    FluidRun run(testing::build_case(rings("two_interfaces_that_leak")), false);
    const Foam::fvMesh& mesh = run.session().mesh();
    const std::vector<InterfacePair> pairs = interface_pairs(mesh);
    ASSERT_EQ(pairs.size(), 2u);
    Foam::surfaceScalarField flux("flux", mesh.magSf());
    for (const InterfacePair& pair : pairs) flux.boundaryFieldRef()[pair.neighbour] *= -1.0;
    const auto net_of = [&](const InterfacePair& pair) {
        return Foam::gSum(flux.boundaryField()[pair.owner]) + Foam::gSum(flux.boundaryField()[pair.neighbour]);
    };
    const double honest[] = {net_of(pairs[0]), net_of(pairs[1])};  // polygons of other numbers of faces differ in area
    const double gained = 0.1 * Foam::gSum(flux.boundaryField()[pairs[0].owner]);
    flux.boundaryFieldRef()[pairs[0].owner] *= 1.1;
    flux.boundaryFieldRef()[pairs[1].owner] *= 1.0 - gained / Foam::gSum(flux.boundaryField()[pairs[1].owner]);
    const InterfaceFlow lie = interface_flow(flux);
    EXPECT_NEAR(lie.net, honest[0] + honest[1], 1e-12 * lie.gross);
    EXPECT_NEAR(lie.imbalance, std::abs(honest[0] + gained) + std::abs(honest[1] - gained), 1e-12 * lie.gross);
    EXPECT_GT(lie.imbalance, 10.0 * std::abs(lie.net));
}

/// What the first lacks is not put into the second.
TEST(SlidingInterfaces, are_each_closed_on_their_own) {
    FluidRun run(testing::build_case(rings("two_interfaces")), false);
    const Foam::fvMesh& mesh = run.session().mesh();
    ASSERT_EQ(interface_pairs(mesh).size(), 2u);
    double worst = 0.0;
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
        const auto& flux = mesh.lookupObject<Foam::surfaceScalarField>("phi").boundaryField();
        if (run.engine().time() < 0.01) continue;
        for (const InterfacePair& pair : interface_pairs(mesh)) {
            const double net = Foam::gSum(flux[pair.owner]) + Foam::gSum(flux[pair.neighbour]);
            worst = std::max(worst, std::abs(net) / Foam::gSum(Foam::mag(flux[pair.owner])));
        }
    }
    EXPECT_LE(worst, 1e-5);  // what the pressure changes in a step is left; 2e-4 with one difference for both
    EXPECT_LE(run.engine().loads().interface_imbalance, 1e-5);
}

}  // namespace
}  // namespace cutterflow::foam
