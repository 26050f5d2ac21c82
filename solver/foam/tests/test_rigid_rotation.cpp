// The geometry of a mesh that turns in place against OpenFOAM's own, and the flow in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "solver/foam/mesh_motion/rigid_rotation.hpp"
#include "solver/foam/mesh_motion/sliding_overlap.hpp"
#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/session/foam_session.hpp"
#include "solver/foam/session/pstream_communicator.hpp"
#include "solver/foam/tests/fluid_run.hpp"

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
    explicit TurningCase(const std::filesystem::path& folder) : session(folder) {}

    /// \param ends  condition of the velocity at both end planes
    static std::filesystem::path build(const std::string& name, const std::string& mesh, const std::string& ends = "slip") {
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
    void step(RigidRotation& rotation, int number) { step_by(rotation, 1e-3 * (1.0 + 0.8 * std::sin(1.7 * number))); }

    void step_by(RigidRotation& rotation, double duration) {
        session.time().setDeltaT(duration, false);
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

void expect_equal(TurningCase& turning, const Geometry& a, const Geometry& b) {
    // Lengths are up to 0.2 m, areas up to 2e-4 m2, volumes up to 5e-6 m3, distances of cells at least 1 mm.
    EXPECT_LE(turning.largest(distance(a.points, b.points)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(a.face_centres, b.face_centres)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(a.face_areas, b.face_areas)), 1e-13 * 2e-4);
    EXPECT_LE(turning.largest(distance(a.cell_centres, b.cell_centres)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(a.volumes, b.volumes)), 1e-13 * 5e-6);
    EXPECT_LE(turning.largest(distance(a.areas, b.areas)), 1e-13 * 2e-4);
    EXPECT_LE(turning.largest(distance(a.centres, b.centres)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(a.cells, b.cells)), 1e-13 * 0.2);
    EXPECT_LE(turning.largest(distance(a.sizes, b.sizes)), 1e-13 * 2e-4);
    EXPECT_LE(turning.largest(distance(a.corrections, b.corrections)), 1e-13);
    EXPECT_LE(turning.largest(distance(a.weights, b.weights)), 1e-13);
    EXPECT_LE(turning.largest(distance(a.distances, b.distances)), 1e-13 / 1e-3);
    EXPECT_LE(turning.largest(distance(a.coefficients, b.coefficients)), 1e-13 / 1e-3);
    EXPECT_LE(turning.largest(distance(a.overlap, b.overlap)), 1e-13);
}

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

    expect_equal(turning, turned, updated);
}

TEST(RigidRotation, EqualsAFullUpdate) {
    TurningCase cylinder(TurningCase::build("rigid_rotation", testing::block_mesh(testing::TurningCylinder())));
    expect_a_full_update_after_500_uneven_steps(cylinder);
}

TEST(RigidRotation, EqualsAFullUpdateOfAPlaneMesh) {
    testing::TurningAnnulus shape;
    shape.plane = true;
    TurningCase annulus(TurningCase::build("rigid_rotation_plane", testing::block_mesh(shape), "empty"));
    expect_a_full_update_after_500_uneven_steps(annulus);
}

/// A mesh that is read at an angle goes on turning from angle 0, as the one that was not stopped.
TEST(RigidRotation, ContinuesFromAnAngle) {
    constexpr int k_before = 25, k_after = 10;
    constexpr double k_even_step = 4e-3;  // [s]: the name of the folder is its time
    const std::filesystem::path folder = TurningCase::build("rigid_rotation_restart", testing::block_mesh(testing::TurningCylinder()));
    const auto last_steps = [](TurningCase& turning, RigidRotation& rotation) {
        for (int number = 0; number < k_after; ++number) turning.step(rotation, number);
        return Geometry(turning.session.mesh());
    };
    std::optional<Geometry> uninterrupted;
    {
        TurningCase turning(folder);
        const MovingZones zones = read_moving_zones(turning.session.mesh());
        RigidRotation rotation(turning.session.mesh(), zones);
        for (int number = 0; number < k_before; ++number) turning.step_by(rotation, k_even_step);
        turning.session.time().writeNow();
        uninterrupted = last_steps(turning, rotation);
    }
    TurningCase turning(folder);
    const MovingZones zones = read_moving_zones(turning.session.mesh());
    EXPECT_NEAR(zones.motion.front().angle(turning.session.time().value()), k_omega * k_before * k_even_step, 1e-12);
    RigidRotation rotation(turning.session.mesh(), zones);
    ASSERT_TRUE(rotation.is_rigid());
    expect_equal(turning, last_steps(turning, rotation), *uninterrupted);
}

enum class GeometryOfSteps { turned, recomputed };

/// Velocities [m/s] after two steps of water that flows across a turning cylinder between end planes, past rock, with limited gradients and
/// convection of second order. The rim is open: of a closed room four ranks' linear solver stops at 1e-10 m/s. The recomputed geometry is
/// OpenFOAM's own of the moved points, with the overlap and the mesh flux of the turned one: OpenFOAM's swept volumes are those of chords,
/// not of arcs.
std::vector<Vec3> velocities_after_two_steps(const std::string& name, GeometryOfSteps geometry) {
    testing::TurningCylinder shape;
    shape.cells_around_quarter = 4;
    shape.stator_cells_around_quarter = 5;
    shape.cells_in_rotor_ring = 2;
    shape.cells_in_stator = 4;
    shape.cells_high = 4;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(shape), 2e-3, 4e-3);
    tiny.files["constant/dynamicMeshDict"] = testing::turning(k_omega);
    tiny.files["0/U"] =
        testing::volume_field("[0 1 -1 0 0 0 0]", "(0.7 -0.3 0.2)",
                              "\".*_ends\" { type noSlip; } rim { type pressureInletOutletVelocity; value $internalField; }");
    tiny.files["0/p"] = testing::volume_field(
        "[0 2 -2 0 0 0 0]", "0", "\".*_ends\" { type fixedFluxPressure; value $internalField; } rim { type fixedValue; value uniform 0; }");
    tiny.files["system/fvSchemes"] +=
        "gradSchemes { grad(U) cellLimited Gauss linear 1; } divSchemes { div(phi,U) Gauss linearUpwindV grad(U); }\n";
    testing::FluidRun run(testing::build_case(tiny), true);
    Foam::dynamicFvMesh& mesh = run.session().mesh();
    const MovingZones zones = read_moving_zones(mesh);
    SlidingOverlap overlap(mesh, zones, 0.0);
    while (run.engine().running()) {
        run.begin();
        if (geometry == GeometryOfSteps::recomputed) {
            const Foam::surfaceScalarField flux("flux", mesh.phi());
            overlap.take();  // the fluid has seen it in this step
            mesh.update();
            overlap.put_back();
            overlap.set(zones.motion.front().angle(run.engine().time()));
            mesh.surfaceInterpolation::movePoints();
            mesh.setPhi() == flux;
        }
        const auto fraction =
            run.evaluate([](const Vec3& x) { return 1.0 - 0.4 * std::exp(-0.5 * (x - Vec3(0.05, 0.02, 0.0)).squaredNorm() / 4e-4); });
        std::fill(run.inertia.begin(), run.inertia.end(), 0.2);
        run.end(fraction, fraction);
    }
    const auto velocity = run.engine().fields().velocity;
    return {velocity.begin(), velocity.end()};
}

TEST(RigidRotation, FlowsAsAFullUpdateDoes) {
    const std::vector<Vec3> turned = velocities_after_two_steps("rigid_rotation_flow", GeometryOfSteps::turned);
    const std::vector<Vec3> updated = velocities_after_two_steps("rigid_rotation_full_flow", GeometryOfSteps::recomputed);
    ASSERT_EQ(turned.size(), updated.size());
    double difference = 0.0, change = 0.0;
    for (std::size_t i = 0; i < turned.size(); ++i) {
        difference = std::max(difference, (turned[i] - updated[i]).norm());
        change = std::max(change, (turned[i] - Vec3(0.7, -0.3, 0.2)).norm());
    }
    PstreamCommunicator communicator;
    communicator.max({&difference, 1});
    communicator.max({&change, 1});
    EXPECT_GT(change, 0.1);
    EXPECT_LE(difference, 1e-12);
    RecordProperty("difference", fmt::format("{:.3g}", difference));
}

/// Volume is neither swept into a cell nor out of it; a face sweeps what OpenFOAM's swept volumes say in the limit of a short step.
TEST(RigidRotation, SweepsNoVolumeIntoACell) {
    TurningCase turning(TurningCase::build("rigid_rotation_flux", testing::block_mesh(testing::TurningCylinder())));
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
