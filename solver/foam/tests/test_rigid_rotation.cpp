// The geometry of a mesh that turns in place against OpenFOAM's own.
#include <gtest/gtest.h>

#include <cmath>

#include <fmt/format.h>

#include "solver/foam/mesh_motion/rigid_rotation.hpp"
#include "solver/foam/mesh_motion/sliding_overlap.hpp"
#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/session/foam_session.hpp"
#include "solver/foam/session/pstream_communicator.hpp"
#include "solver/foam/tests/tiny_case.hpp"

#include "cyclicAMIFvPatch.H"
#include "dynamicFvMesh.H"
#include "fvc.H"

namespace cutterflow::foam {
namespace {

constexpr double k_omega = 2.0 * k_pi;  // 60 rpm

/// Values of a field in cells or on inner faces, and then on each patch. (A copy of OpenFOAM's own geometry would still look into the
/// mesh.)
template <class Type>
using Values = std::vector<Foam::Field<Type>>;

template <class Field>
auto values_of(const Field& field) {
    Values<typename Field::value_type> values{field.primitiveField()};
    for (const auto& patch : field.boundaryField()) values.emplace_back(Foam::Field<typename Field::value_type>(patch));
    return values;
}

template <class Type>
double distance(const Foam::Field<Type>& a, const Foam::Field<Type>& b) {
    return a.empty() ? 0.0 : Foam::max(Foam::mag(a - b)());
}

template <class Type>
double distance(const Values<Type>& a, const Values<Type>& b) {
    double worst = 0.0;
    for (std::size_t part = 0; part < a.size(); ++part) worst = std::max(worst, distance(a[part], b[part]));
    return worst;
}

/// What the solver reads from a mesh.
struct Geometry {
    Foam::pointField points, face_centres, face_areas, cell_centres;
    Foam::scalarField volumes;
    Values<Foam::vector> areas, centres, corrections, cells;
    Values<Foam::scalar> sizes, weights, distances, coefficients;
    Values<Foam::scalar> overlap;  ///< of each interface patch: the place of the other side's faces as this side sees it

    explicit Geometry(const Foam::fvMesh& mesh)
        : points(mesh.points()),
          face_centres(mesh.faceCentres()),
          face_areas(mesh.faceAreas()),
          cell_centres(mesh.cellCentres()),
          volumes(mesh.V().field()),
          areas(values_of(mesh.Sf())),
          centres(values_of(mesh.Cf())),
          corrections(values_of(mesh.nonOrthCorrectionVectors())),
          cells(values_of(mesh.C())),
          sizes(values_of(mesh.magSf())),
          weights(values_of(mesh.weights())),
          distances(values_of(mesh.deltaCoeffs())),
          coefficients(values_of(mesh.nonOrthDeltaCoeffs())) {
        for (const Foam::fvPatch& patch : mesh.boundary()) {
            if (!Foam::isA<Foam::cyclicAMIFvPatch>(patch)) continue;
            const auto& side = Foam::refCast<const Foam::cyclicAMIFvPatch>(patch);
            overlap.emplace_back(side.interpolate(Foam::scalarField(side.neighbPatch().Cf().component(0))));
        }
    }
};

struct TurningCase {
    /// \param ends  condition of the velocity at both end planes
    TurningCase(const std::string& name, const std::string& mesh, const std::string& ends = "slip") : session(build(name, mesh, ends)) {}

    static std::filesystem::path build(const std::string& name, const std::string& mesh, const std::string& ends) {
        testing::TinyCase tiny = testing::laminar_case(name, mesh, 1e-3, 1e3);
        tiny.files["constant/dynamicMeshDict"] = testing::turning(k_omega);
        const auto boundary = [&](const std::string& on_ends, const std::string& elsewhere) {
            return fmt::format("\".*_ends\" {{ type {}; }} \"(rim|hub)\" {{ type {}; }}", on_ends, elsewhere);
        };
        tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", boundary(ends, "slip"));
        tiny.files["0/p"] =
            testing::volume_field("[0 2 -2 0 0 0 0]", "0", boundary(ends == "slip" ? "zeroGradient" : ends, "zeroGradient"));
        return testing::build_case(tiny);
    }

    /// Steps of 0.2 to 1.8 ms that do not repeat.
    void step(RigidRotation& rotation, int number) {
        session.time().setDeltaT(1e-3 * (1.0 + 0.8 * std::sin(1.7 * number)), false);
        ++session.time();
        rotation.move();
    }

    double largest(double value) {
        communicator.max({&value, 1});
        return value;
    }

    FoamSession session;
    PstreamCommunicator communicator;
};

void expect_a_full_update_after_500_uneven_steps(TurningCase& turning) {
    Foam::dynamicFvMesh& mesh = turning.session.mesh();
    const MovingZones zones = read_moving_zones(mesh);
    RigidRotation rotation(mesh, zones);
    ASSERT_TRUE(rotation.is_rigid());
    SlidingOverlap overlap(mesh, zones, 0.0);
    ASSERT_EQ(overlap.size(), 1u);
    for (int number = 0; number < 500; ++number) turning.step(rotation, number);
    const Geometry turned(mesh);
    mesh.update();
    overlap.set(zones.motion.front().angle(turning.session.time().value()));
    mesh.surfaceInterpolation::movePoints();  // OpenFOAM's own weights and distances, with that overlap
    const Geometry updated(mesh);

    // Lengths are up to 0.2 m, areas up to 2e-4 m2, volumes up to 5e-6 m3, distances of cells at least 1 mm.
    EXPECT_LE(turning.largest(distance(turned.points, updated.points)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(turned.face_centres, updated.face_centres)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(turned.face_areas, updated.face_areas)), 1e-13 * 2e-4);
    EXPECT_LE(turning.largest(distance(turned.cell_centres, updated.cell_centres)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(turned.volumes, updated.volumes)), 1e-13 * 5e-6);
    EXPECT_LE(turning.largest(distance(turned.areas, updated.areas)), 1e-13 * 2e-4);
    EXPECT_LE(turning.largest(distance(turned.centres, updated.centres)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(turned.cells, updated.cells)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(turned.sizes, updated.sizes)), 1e-13 * 2e-4);
    EXPECT_LE(turning.largest(distance(turned.corrections, updated.corrections)), 1e-13);
    EXPECT_LE(turning.largest(distance(turned.weights, updated.weights)), 1e-13);
    EXPECT_LE(turning.largest(distance(turned.distances, updated.distances)), 1e-13 / 1e-3);
    EXPECT_LE(turning.largest(distance(turned.coefficients, updated.coefficients)), 1e-13 / 1e-3);
    EXPECT_LE(turning.largest(distance(turned.overlap, updated.overlap)), 1e-13);
}

TEST(RigidRotation, EqualsAFullUpdate) {
    TurningCase cylinder("rigid_rotation", testing::block_mesh(testing::TurningCylinder()));
    expect_a_full_update_after_500_uneven_steps(cylinder);
}

TEST(RigidRotation, EqualsAFullUpdateOfAPlaneMesh) {
    testing::TurningAnnulus shape;
    shape.plane = true;
    TurningCase annulus("rigid_rotation_plane", testing::block_mesh(shape), "empty");
    expect_a_full_update_after_500_uneven_steps(annulus);
}

/// Volume is neither swept into a cell nor out of it; a face sweeps what OpenFOAM's swept volumes say in the limit of a short step.
TEST(RigidRotation, SweepsNoVolumeIntoACell) {
    TurningCase turning("rigid_rotation_flux", testing::block_mesh(testing::TurningCylinder()));
    Foam::dynamicFvMesh& mesh = turning.session.mesh();
    const MovingZones zones = read_moving_zones(mesh);
    RigidRotation rotation(mesh, zones);
    turning.step(rotation, 0);
    turning.step(rotation, 1);
    const Foam::surfaceScalarField rate("rate", mesh.phi());
    const Foam::scalarField gain(Foam::fvc::surfaceIntegrate(rate)().primitiveField());
    EXPECT_LE(turning.largest(Foam::max(Foam::mag(gain)())), 1e-12 * k_omega);

    constexpr double k_step = 1e-3;
    turning.session.time().setDeltaT(k_step, false);
    ++turning.session.time();
    mesh.update();
    const double largest = turning.largest(Foam::max(Foam::mag(mesh.phi().primitiveField())()));
    const double error = turning.largest(distance(values_of(rate), values_of(mesh.phi())));
    EXPECT_GT(largest, 1e-6);
    EXPECT_LE(error / largest, 0.5 * std::pow(k_omega * k_step, 2));  // chords of the points' arcs
}

}  // namespace
}  // namespace cutterflow::foam
