// Soil in the water: its share of the cells, what moves in it, and that it stays where it is while the mesh turns.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "solver/foam/mesh_motion/rigid_rotation.hpp"
#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/soil/soil.hpp"
#include "solver/foam/tests/fluid_run.hpp"

namespace cutterflow::foam {
namespace {

using testing::FluidRun;
namespace fs = std::filesystem;

/// A block about `middle`, turned about z, as STL.
struct Block {
    Vec3 middle, half;
    double turn = 0.0;  // [rad]

    Vec3 corner(int number) const {
        const Vec3 arm = half.cwiseProduct(Vec3(number & 1 ? 1 : -1, number & 2 ? 1 : -1, number & 4 ? 1 : -1));
        return middle +
               Vec3(std::cos(turn) * arm.x() - std::sin(turn) * arm.y(), std::sin(turn) * arm.x() + std::cos(turn) * arm.y(), arm.z());
    }
    /// Outside above 0; exact beside the faces.
    double distance(const Vec3& point) const {
        const Vec3 arm = point - middle;
        const Vec3 own(std::cos(turn) * arm.x() + std::sin(turn) * arm.y(), -std::sin(turn) * arm.x() + std::cos(turn) * arm.y(), arm.z());
        return (own.cwiseAbs() - half).maxCoeff();
    }
};

void write_stl(const fs::path& file, const Block& block, bool open = false) {
    constexpr int faces[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
    std::ofstream stream(file);
    stream << "solid bank\n";
    for (int face = 0; face < (open ? 5 : 6); ++face)
        for (const int first : {1, 2}) {
            stream << "facet normal 0 0 0\nouter loop\n";
            for (const int number : {faces[face][0], faces[face][first], faces[face][first + 1]}) {
                const Vec3 x = block.corner(number);
                stream << fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", x.x(), x.y(), x.z());
            }
            stream << "endloop\nendfacet\n";
        }
    stream << "endsolid bank\n";
}

/// Beside the case; written by every rank, into a file of its own.
coupling::SoilSettings soil_of(const fs::path& folder, const Block& block, double permeability = 0.0) {
    const fs::path file = folder / fmt::format("bank_{}.stl", Foam::Pstream::myProcNo());
    write_stl(file, block);
    return {file, permeability};
}

testing::TinyCase box_case(const std::string& name, const testing::Box& box, double time_step, double end) {
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(box), time_step, end);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*\" { type noSlip; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type zeroGradient; }");
    return tiny;
}

double soil_volume(const Foam::fvMesh& mesh, const Soil& soil) {
    return gSum((mesh.V().field() * soil.share().primitiveField())());
}

/// Half spaces, most of them oblique to the mesh: the error of one is of either sign, and the mean is the exact volume.
TEST(Soil, HasItsVolumeOnAverage) {
    testing::Box box;
    for (int& cells : box.cells) cells = 12;
    FoamSession session(testing::build_case(box_case("soil_volume", box, 0.1, 1.0)));
    const MovingZones zones = read_moving_zones(session.mesh());
    double sum = 0.0, worst = 0.0;
    int count = 0;
    for (const double turn : {0.0, 0.2, 0.4, 0.6, k_pi / 4.0})
        for (const double shift : {0.0, 0.013, 0.029, 0.041, 0.057, 0.071}) {
            // Its edge passes through a point near the box's middle, so that the volume is known by symmetry and a strip.
            const Vec3 normal(-std::sin(turn), std::cos(turn), 0.0);
            const Block block{Vec3(0.5, 0.5, 0.5) + (shift - 2.0) * normal, Vec3(3.0, 2.0, 3.0), turn};
            const Soil soil(session.mesh(), zones, soil_of(session.case_folder(), block));
            const double exact = 0.5 + shift / std::cos(turn);  // of the unit box, while the edge meets its two sides
            const double error = soil_volume(session.mesh(), soil) / exact - 1.0;
            sum += error;
            worst = std::max(worst, std::abs(error));
            ++count;
        }
    EXPECT_LE(std::abs(sum / count), 1e-3);
    EXPECT_LE(worst, 1e-2);
}

TEST(Soil, StandsStillWhileTheMeshTurns) {
    testing::TurningCylinder shape;
    testing::TinyCase tiny = testing::laminar_case("soil_turning", testing::block_mesh(shape), 0.01, 1.0);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\".*ends\" { type slip; } rim { type noSlip; }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type zeroGradient; }");
    tiny.files["constant/dynamicMeshDict"] = testing::turning(7.0);
    FoamSession session(testing::build_case(tiny));
    Foam::dynamicFvMesh& mesh = session.mesh();
    const MovingZones zones = read_moving_zones(mesh);
    RigidRotation rotation(mesh, zones);
    const Block block{Vec3(0.04, 0.4, 0.0), Vec3(0.37, 0.37, 0.5), 0.3};
    Soil soil(mesh, zones, soil_of(session.case_folder(), block));
    const double at_start = soil_volume(mesh, soil);
    for (int step = 0; step < 12; ++step) {
        ++const_cast<Foam::Time&>(mesh.time());
        rotation.move();
        soil.follow_mesh();
        // Fluid far outside, solid far inside, half where the surface passes the centre.
        int inside = 0;
        forAll(mesh.C(), cell) {
            const double d = block.distance(to_vec3(mesh.C()[cell])) / std::cbrt(mesh.V()[cell]);
            const double chi = soil.share()[cell];
            if (d > 1.5) ASSERT_EQ(chi, 0.0);
            if (d < -1.5) ASSERT_EQ(chi, 1.0);
            ASSERT_NEAR(chi, 0.5, 1.7 * std::abs(d) + 0.02) << "falls over about one cell";
            inside += chi > 0.5 && zones.of_cells[static_cast<std::size_t>(cell)] != coupling::k_still_zone;
        }
        EXPECT_GT(returnReduce(inside, Foam::sumOp<Foam::label>()), 100) << "of the turning cells";
        EXPECT_NEAR(soil_volume(mesh, soil) / at_start, 1.0, 0.01);
    }
}

/// Wall at y = 1 that moves along x over soil up to `top`: u = (y - top)/(1 - top). \return L2 error over the water
double couette_error(const std::string& name, int cells, double top, double time_step) {
    testing::Box box;
    box.cells[0] = box.cells[2] = 2;
    box.upper[0] = box.upper[2] = 2.0 / cells;
    box.cells[1] = cells;
    box.periodic_x = true;
    testing::TinyCase tiny = box_case(name, box, time_step, 2.5);
    tiny.files["constant/transportProperties"] = "transportModel Newtonian; nu 0.2; rho 1000;";
    tiny.files["0/U"] = testing::volume_field(
        "[0 1 -1 0 0 0 0]", "(0 0 0)", "y_min { type noSlip; } \"z_.*\" { type slip; } y_max { type fixedValue; value uniform (1 0 0); }");
    const fs::path folder = testing::build_case(tiny);
    FluidRun run(folder, false, {}, soil_of(folder, {Vec3(0.0, top - 5.0, 0.0), Vec3(9.0, 5.0, 9.0)}));
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
    }
    double square = 0.0, count = 0.0;
    for (std::size_t i = 0; i < run.cells(); ++i) {
        const double y = run.centre(i).y();
        if (y < top) continue;
        square += (run.engine().fields().velocity[i] - Vec3((y - top) / (1.0 - top), 0.0, 0.0)).squaredNorm();
        count += 1.0;
    }
    const double shear = 1000.0 * 0.2 / (1.0 - top) * 4.0 / (cells * cells);
    EXPECT_NEAR(run.engine().loads().soil_force->x() / shear, 1.0, 0.6 / cells / (1.0 - top)) << "drag of the soil";
    return std::sqrt(run.total(square) / run.total(count));
}

/// While the viscosity reaches over a cell in a step the profile is exact wherever the surface lies in its cell; in shorter steps the
/// surface is off by a third of a cell at most.
TEST(Soil, BoundsASteadyShearFlow) {
    if (PstreamCommunicator().size() > 1) GTEST_SKIP() << "serial: the meshes are tiny";
    for (const double share : {0.0, 0.25, 0.5, 0.75}) {
        const double top = 0.25 + share / 8.0;
        EXPECT_LE(couette_error(fmt::format("soil_couette_{}", share), 8, top, 0.3), 3e-3) << share;
        EXPECT_LE(couette_error(fmt::format("soil_couette_short_{}", share), 8, top, 0.004), 0.33 / 8.0) << share;
    }
    const double coarse = couette_error("soil_couette_8", 8, 0.25 + 0.25 / 8.0, 0.004);
    const double fine = couette_error("soil_couette_16", 16, 0.25 + 0.25 / 16.0, 0.001);
    EXPECT_LE(fine, 0.55 * coarse) << "first order";
    EXPECT_GT(coarse, 1e-3);
}

/// A duct from (0, 0, 0) to (1, 0.25, 0.25) with a pressure difference and soil from x = 0.4 to 0.6.
/// \param velocity  of the soil along the duct [m/s] \param drop  of pressure along the duct [m2/s2] \return mean velocity [m/s]
double flow_through_plug(const std::string& name, double permeability, double time_step, double velocity = 0.0, double drop = 1.0) {
    testing::Box box;
    box.cells[0] = 20;
    box.cells[1] = box.cells[2] = 5;
    box.upper[1] = box.upper[2] = 0.25;
    box.duct = true;
    testing::TinyCase tiny = box_case(name, box, time_step, 20.0 * time_step);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)", "\"[yz]_.*\" { type slip; } \".*let\" { type zeroGradient; }");
    tiny.files["0/p"] =
        testing::volume_field("[0 2 -2 0 0 0 0]", "0",
                              fmt::format("\"[yz]_.*\" {{ type zeroGradient; }} inlet {{ type fixedValue; value uniform {}; }} "
                                          "outlet {{ type fixedValue; value uniform 0; }}",
                                          drop));
    tiny.files["constant/transportProperties"] = "transportModel Newtonian; nu 1e-3; rho 1000;";
    const fs::path folder = testing::build_case(tiny);
    coupling::SoilSettings soil = soil_of(folder, {Vec3(0.5, 0.0, 0.0), Vec3(0.1, 2.0, 2.0)}, permeability);
    soil.velocity = Vec3(velocity, 0.0, 0.0);
    FluidRun run(folder, false, {"outlet", {}}, soil);
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
    }
    EXPECT_LE(run.engine().loads().continuity_error, 1e-9);
    return run.engine().loads().outlet_flow.value() / (0.25 * 0.25);
}

TEST(Soil, LetsWaterThroughByDarcysLaw) {
    // K/nu = 0.02 s over 0.2 m: 0.1 m/s.
    EXPECT_NEAR(flow_through_plug("soil_darcy", 2e-5, 0.1), 0.1, 1e-3);
}

TEST(Soil, OfNoPermeabilityIsTight) {
    // A thousandth of what the pressure would move in a step: 1e-3 * 0.01 s * 1 m2/s2 / 0.2 m = 5e-5 m/s, where free water would have 1.4.
    EXPECT_NEAR(flow_through_plug("soil_tight", 0.0, 0.01), 5e-5, 1e-5);
}

/// Soil that flows through its surface brings its volume into the water, also against a pressure.
TEST(SoilOnTheMove, BringsItsVolumeIntoTheWater) {
    // 0.1 m/s, less the thousandth that a pressure difference moves through a tight plug in a step.
    EXPECT_NEAR(flow_through_plug("soil_pushes", 0.0, 0.01, 0.1, 0.0), 0.1, 1e-4);
    EXPECT_NEAR(flow_through_plug("soil_pushes_against", 0.0, 0.01, 0.1, -1.0), 0.1 - 5e-5, 2e-4);
    EXPECT_NEAR(flow_through_plug("soil_lies", 0.0, 0.01, 0.0, 0.0), 0.0, 1e-9) << "soil at rest brings nothing";
}

/// A stream that fills a cylinder of turning mesh, and a block in it. \return largest deviation from the stream over its speed
double disturbance_of_a_stream(const std::string& name, const Vec3& of_block) {
    const Vec3 stream(0.2, -0.1, 0.0);
    testing::TurningCylinder shape;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(shape), 0.004, 0.08);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0.2 -0.1 0)",
                                              "\".*ends\" { type slip; } rim { type fixedValue; value uniform (0.2 -0.1 0); }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type zeroGradient; }");
    tiny.files["constant/dynamicMeshDict"] = testing::turning(7.0);
    const fs::path folder = testing::build_case(tiny);
    coupling::SoilSettings soil = soil_of(folder, {Vec3(0.09, 0.03, 0.0), Vec3(0.05, 0.04, 0.5), 0.3});
    soil.velocity = of_block;
    FluidRun run(folder, false, {}, soil);
    double worst = 0.0;
    while (run.engine().running()) {
        run.begin();
        run.end({}, {});
        for (const Vec3& u : run.engine().fields().velocity) worst = std::max(worst, (u - stream).norm() / stream.norm());
    }
    return run.largest(worst);
}

/// In the frame of the soil the water is at rest, whatever mesh turns through its surface.
TEST(SoilOnTheMove, DoesNotDisturbAStreamThatItMovesWith) {
    EXPECT_LE(disturbance_of_a_stream("soil_in_stream", Vec3(0.2, -0.1, 0.0)), 1e-6);
    EXPECT_GE(disturbance_of_a_stream("soil_against_stream", Vec3::Zero()), 0.5) << "a block at rest does";
}

TEST(Soil, IsNoSteel) {
    testing::Box box;
    for (int& cells : box.cells) cells = 4;
    const fs::path folder = testing::build_case(box_case("soil_hides", box, 0.1, 1.0));
    FluidRun run(folder, false, {}, soil_of(folder, {Vec3(0.5, 0.2, 0.5), Vec3(0.3, 0.1, 0.3)}));
    EXPECT_EQ(run.engine().steel().of_zone.at(0).size(), 6u * 16u * 2u);
    EXPECT_EQ(run.engine().steel().soil.size(), 12u);
}

template <class Action>
std::string refusal(Action action) {
    try {
        action();
    } catch (const UserError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Soil, IsRefusedWhenItsSurfaceSaysNothing) {
    testing::Box box;
    for (int& cells : box.cells) cells = 3;
    const fs::path folder = testing::build_case(box_case("soil_refused", box, 0.1, 1.0));
    const fs::path open = folder / fmt::format("open_{}.stl", Foam::Pstream::myProcNo());
    write_stl(open, {Vec3(0.5, 0.2, 0.5), Vec3(0.3, 0.1, 0.3)}, true);
    EXPECT_NE(refusal([&] { FluidRun(folder, false, {}, coupling::SoilSettings{open, 0.0}); }).find("4 edges are open"), std::string::npos);
    EXPECT_NE(refusal([&] {
                  FluidRun(folder, false, {}, coupling::SoilSettings{folder / "none.stl", 0.0});
              }).find("there is no such file"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                  FluidRun(folder, false, {}, soil_of(folder, {Vec3(500, 200, 500), Vec3(300, 100, 300)}));
              }).find("no cell lies in it"),
              std::string::npos);
}

/// Rock that drives water over soil: what the water says it received of rock is what rock gave, and soil's part is from outside.
TEST(Soil, TakesMomentumThatIsNotTheRocks) {
    testing::Box box;
    for (int& cells : box.cells) cells = 8;
    for (double& upper : box.upper) upper = 0.16;
    box.periodic_x = true;
    testing::TinyCase tiny = box_case("soil_momentum", box, 1e-3, 0.03);
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    const fs::path folder = testing::build_case(tiny);
    FluidRun run(folder, true, {}, soil_of(folder, {Vec3(0.08, 0.0, 0.08), Vec3(1.0, 0.047, 1.0)}));
    const std::vector<double> solid =
        run.evaluate([](const Vec3& x) { return 0.1 * std::exp(-(x - Vec3(0.08, 0.07, 0.08)).squaredNorm() / 1e-3); });
    std::vector<double> open(solid);
    for (double& fraction : open) fraction = 1.0 - fraction;
    const auto sum = [&](const std::function<Vec3(std::size_t)>& value) {
        Vec3 total = Vec3::Zero();
        for (std::size_t c = 0; c < run.cells(); ++c) total += run.engine().cells().volumes[c] * value(c);
        return Vec3(run.total(total.x()), run.total(total.y()), run.total(total.z()));
    };
    Vec3 given, received, gained, outside, on_soil;
    for (int step = 0; run.engine().running(); ++step) {
        for (std::size_t c = 0; c < run.cells(); ++c) {
            run.source[c] = 10.0 * solid[c] * Vec3(1.0, -0.4, 0.2);
            run.drag_rate[c] = 20.0 * solid[c];
        }
        run.begin();
        const auto u = run.engine().fields().velocity;
        const std::vector<Vec3> old(u.begin(), u.end());
        run.end(open, open);
        const auto now = run.engine().fields().velocity;
        given = sum([&](std::size_t c) { return Vec3(run.source[c] - run.drag_rate[c] * (now[c] - old[c])); });
        received = sum([&](std::size_t c) { return run.engine().received()[c]; });
        gained = sum([&](std::size_t c) { return Vec3(open[c] * (now[c] - old[c]) / run.engine().time_step()); });
        outside = run.engine().loads().boundary_impulse / (1000.0 * run.engine().time_step());
        on_soil = run.engine().loads().soil_force.value() / 1000.0;
        if (step > 0) EXPECT_LE((gained - outside - received).norm(), 1e-9 * received.norm());
    }
    EXPECT_LE((received - given).norm(), 0.02 * given.norm());
    EXPECT_GT(on_soil.x(), 0.05 * given.x()) << "enough to be seen if it were counted as the rocks'";
}

/// Water stirred by a rock's force beside a sliding interface. \return largest error of the balance of momentum of a step over what the
/// water received in it
double worst_balance_at_interface(const std::string& name, const std::optional<Block>& block) {
    testing::TurningAnnulus shape;
    shape.height = 0.05;
    shape.cells_high = 3;
    shape.cells_around_quarter = shape.stator_cells_around_quarter = 10;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(shape), 1e-3, 0.02);
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)",
                                              "\".*ends\" { type slip; } rim { type noSlip; } "
                                              "hub { type movingWallVelocity; value uniform (0 0 0); }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    tiny.files["constant/dynamicMeshDict"] = testing::turning(20.0);
    const fs::path folder = testing::build_case(tiny);
    std::optional<coupling::SoilSettings> soil;
    if (block) soil = soil_of(folder, *block);
    FluidRun run(folder, true, {}, soil);
    const auto sum = [&](const std::function<Vec3(std::size_t)>& value) {
        Vec3 total = Vec3::Zero();
        for (std::size_t c = 0; c < run.cells(); ++c) total += run.engine().cells().volumes[c] * value(c);
        return Vec3(run.total(total.x()), run.total(total.y()), run.total(total.z()));
    };
    const auto solid_at = [&](const Vec3& x) { return 0.1 * std::exp(-(x - Vec3(0.06, 0.04, 0.025)).squaredNorm() / 2e-4); };
    const auto momentum = [&] { return sum([&](std::size_t c) { return Vec3(run.engine().fields().velocity[c]); }); };
    const std::vector<double> open(run.cells(), 1.0);
    double worst = 0.0;
    for (int step = 0; run.engine().running(); ++step) {
        const Vec3 before = momentum();
        run.begin();
        for (std::size_t c = 0; c < run.cells(); ++c) run.source[c] = 50.0 * solid_at(run.centre(c)) * Vec3(1.0, -0.4, 0.2);
        run.end(open, open);
        const coupling::FluidLoads loads = run.engine().loads();
        const Vec3 outside = (loads.boundary_impulse + loads.interface_impulse + loads.replaced_momentum + loads.turned_momentum) / 1000.0;
        const Vec3 received = run.engine().time_step() * sum([&](std::size_t c) { return run.engine().received()[c]; });
        if (step > 0) worst = std::max(worst, (momentum() - before - outside - received).norm() / received.norm());
    }
    return worst;
}

/// Beside soil the two sides of the interface have pressures of their own: all of it is accounted for.
TEST(Soil, AcrossAnInterfaceKeepsTheBalanceOfMomentum) {
    const double without = worst_balance_at_interface("interface_alone", {});
    const double with = worst_balance_at_interface("soil_interface", Block{Vec3(0.077, 0.0, 0.0), Vec3(0.012, 0.009, 1.0)});
    EXPECT_LE(without, 1e-8);
    EXPECT_LE(with, 1e-5);  // what the pressure leaves of continuity, which is not the rock's; the plain pressure's error is of order 0.1
}

/// k and epsilon as soil may leave them, epsilon nearer to nothing than k: an eddy viscosity of 9,000 m2/s, which would tie all the soil's
/// cells together.
TEST(Soil, HasNoEddyViscosity) {
    testing::Box box;
    for (int& cells : box.cells) cells = 8;
    testing::TinyCase tiny = box_case("soil_eddies", box, 1e-3, 1.0);
    testing::make_turbulent(tiny, 0.01, 1e-9);
    const fs::path folder = testing::build_case(tiny);
    FluidRun run(folder, false, {}, soil_of(folder, {Vec3(0.5, 0.25, 0.5), Vec3(1.0, 0.25, 1.0)}));
    const auto& eddy_viscosity = run.session().mesh().lookupObject<Foam::volScalarField>("nut");
    const auto& share = run.session().mesh().lookupObject<Foam::volScalarField>("soil");
    const auto largest_where = [&](bool in_soil) {
        double largest = 0.0;
        forAll(share, cell) if ((share[cell] >= 1.0) == in_soil) largest = std::max(largest, eddy_viscosity[cell]);
        return run.largest(largest);
    };
    EXPECT_EQ(largest_where(true), 0.0) << "at the start";
    EXPECT_GT(largest_where(false), 100.0);
    for (int i = 0; i < 2; ++i) {
        run.begin();
        run.end({}, {});
        EXPECT_EQ(largest_where(true), 0.0);
    }
}

/// Water stirred round past a block that stands across the sliding interface.
TEST(Soil, IsTheSameAfterARestart) {
    testing::TurningAnnulus shape;
    shape.height = 0.05;
    shape.cells_high = 3;
    shape.cells_around_quarter = shape.stator_cells_around_quarter = 10;
    testing::TinyCase tiny = testing::laminar_case("soil_restart", testing::block_mesh(shape), 1e-3, 10.0);
    testing::make_turbulent(tiny, 0.01, 0.1);
    for (const char* field : {"0/k", "0/epsilon", "0/nut"}) {
        std::string& text = tiny.files[field];
        text.insert(text.rfind('}'), "\".*ends\" { type zeroGradient; }\n");
    }
    tiny.files["0/nut"].replace(tiny.files["0/nut"].find("{ type zeroGradient; }"), 22, "{ type calculated; value uniform 0; }");
    tiny.files["0/U"] = testing::volume_field("[0 1 -1 0 0 0 0]", "(0 0 0)",
                                              "\".*ends\" { type slip; } rim { type noSlip; } "
                                              "hub { type movingWallVelocity; value uniform (0 0 0); }");
    tiny.files["0/p"] = testing::volume_field("[0 2 -2 0 0 0 0]", "0", "\".*\" { type fixedFluxPressure; value $internalField; }");
    tiny.files["constant/dynamicMeshDict"] = testing::turning(20.0);
    const fs::path folder = testing::build_case(tiny);
    const coupling::SoilSettings soil = soil_of(folder, {Vec3(0.077, 0.0, 0.0), Vec3(0.012, 0.009, 1.0)});
    const auto step = [](FluidRun& run) {
        run.begin();
        run.end({}, {});
    };
    std::vector<Vec3> expected;
    Vec3 force;
    {
        FluidRun run(folder, false, {}, soil);
        for (int i = 0; i < 6; ++i) step(run);
        run.engine().write_now();
        step(run);
        expected.assign(run.engine().fields().velocity.begin(), run.engine().fields().velocity.end());
        force = run.engine().loads().soil_force.value();
    }
    FluidRun resumed(folder, false, {}, soil);
    EXPECT_GT(resumed.engine().time(), 0.0);
    step(resumed);
    double worst = 0.0, fastest = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        worst = std::max(worst, (resumed.engine().fields().velocity[i] - expected[i]).norm());
        fastest = std::max(fastest, expected[i].norm());
    }
    EXPECT_LE(resumed.largest(worst), 1e-11);
    EXPECT_GT(resumed.largest(fastest), 0.01);
    EXPECT_GT(force.norm(), 0.0);
    EXPECT_NEAR((resumed.engine().loads().soil_force.value() - force).norm() / force.norm(), 0.0, 1e-8);
}

}  // namespace
}  // namespace cutterflow::foam
