/// Rock on the bank that a head leaves, in the DEM alone, and rock with water on a step of soil that both feel.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/soil/bank.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/contact_bench.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;
using geometry::TriangleSurface;

void write_stl(const fs::path& file, const TriangleSurface& surface) {
    fs::create_directories(file.parent_path());
    std::ofstream stream(file);
    stream << "solid wall\n";
    for (const geometry::Triangle& triangle : surface.triangles) {
        stream << "facet normal 0 0 0\nouter loop\n";
        for (const auto corner : triangle) {
            const Vec3& x = surface.points[corner];
            stream << fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", x.x(), x.y(), x.z());
        }
        stream << "endloop\nendfacet\n";
    }
    stream << "endsolid wall\n";
    if (!stream) throw std::runtime_error("cannot write " + file.string());
}

// --- The bank of a small head ---

constexpr double k_inclination = k_pi / 4.0, k_reach = 0.5, k_tolerance = 1e-4;
constexpr double k_restitution = 0.6, k_rock_density = 2650.0;

geometry::Bank small_bank() {
    constexpr int chords = 12;
    constexpr double radius = 0.2;
    std::vector<double> z, r;
    for (int k = 0; k <= chords; ++k) {
        const double angle = 0.5 * k_pi * k / chords;
        z.push_back(k < chords ? -radius * std::cos(angle) : 0.0);
        r.push_back(radius * std::sin(angle));
    }
    geometry::BankParameters parameters;
    parameters.inclination = k_inclination;
    parameters.cut_height = 0.15;
    parameters.step = 0.08;
    parameters.pick_length = 0.02;
    parameters.clearance = 0.005;
    parameters.segments = 48;
    return {geometry::Contour(z, r, radius, 0.03), parameters};
}

/// Along ahead, up and the swing -> run's frame.
Vec3 in_run_frame(double ahead, double up, double along) {
    const double c = std::cos(k_inclination), s = std::sin(k_inclination);
    return {-s * ahead - c * up, along, -c * ahead + s * up};
}

coupling::DemSettings room_with(const fs::path& wall) {
    coupling::DemSettings settings;
    settings.contact.youngs_modulus = 1e7;
    settings.contact.max_speed = 2.0;
    settings.contact.wet_restitution = false;
    settings.contact.rock_steel = {0.0, 0.97, 0.0};  // of no wall here
    settings.contact.rock_soil.restitution = k_restitution;
    settings.domain = coupling::cylinder_domain(1.0, -1.0, 1.0);
    settings.fluid = {998.2, 1.0034e-6};
    settings.gravity = 9.81 * in_run_frame(0.0, -1.0, 0.0);
    coupling::WallSettings soil{"bank", wall, false};
    soil.material = coupling::k_soil;
    settings.walls = {soil};
    return settings;
}

void add(coupling::Rocks& rocks, const Vec3& position, const Vec3& velocity, double diameter) {
    rocks.append({static_cast<int>(rocks.size()) + 1, position, velocity, Vec3::Zero(), diameter, k_rock_density});
}

void advance(coupling::DemEngine& dem, double duration) {
    constexpr double call = 2e-3;
    for (int i = 0; i < static_cast<int>(std::lround(duration / call)); ++i)
        dem.advance(call, [](std::size_t, const Vec3&) { return Vec3(Vec3::Zero()); });
}

/// Rocks that fall on the bank's top, and into what the swings left.
void let_rock_fall(Verification& verification, const geometry::Bank& bank, const geometry::SolidSearch& soil, const fs::path& wall) {
    constexpr double diameter = 0.02;
    const auto dem = dem_engine(room_with(wall));
    coupling::Rocks rocks;
    for (int i = 0; i < 6; ++i)
        add(rocks, in_run_frame(0.28 + 0.03 * (i % 3), bank.top() + 0.02, -0.1 + 0.1 * (i / 3)), Vec3::Zero(), diameter);
    for (int i = 0; i < 18; ++i)
        add(rocks, in_run_frame(0.12 - 0.05 * (i % 9), bank.top() - 0.02, i < 9 ? -0.12 : -0.3), Vec3::Zero(), diameter);
    const auto inserted = dem->insert(rocks);
    verification.absolute("rocks on the bank: let fall", "-", static_cast<double>(inserted.size()), 24.0, 0.0,
                          {"exact", "all have room", {}});
    advance(*dem, 2.0);
    double nearest = 1.0, fastest = 0.0;
    for (std::size_t p = 0; p < dem->rocks().size(); ++p) {
        const Vec3& at = dem->rocks().position[p];
        if (!at.allFinite()) throw std::runtime_error("a rock is nowhere");
        nearest = std::min(nearest, soil.contains(at) ? 0.0 : soil.nearest(at).distance);
        fastest = larger(fastest, dem->rocks().velocity[p].norm());
    }
    verification.absolute("rocks on the bank: still there", "-", static_cast<double>(dem->rocks().size()), 24.0, 0.0,
                          {"exact", "after 2 s", {}});
    verification.at_least("rocks on the bank: nearest centre to the exact soil", "m", nearest, 0.49 * diameter,
                          {"exact", "radius 10 mm, less overlap and the wall's error", {}});
    verification.at_most("rocks on the bank: fastest", "m/s", fastest, 1e-6, {"exact", "at rest by rolling friction", {}});
}

struct Throw {
    Vec3 before, after, place;
};

/// Along the swing at the cut face, without weight.
Throw throw_at_face(const fs::path& wall) {
    coupling::DemSettings settings = room_with(wall);
    settings.gravity.setZero();
    settings.contact.rock_soil.friction = 0.0;
    const auto dem = dem_engine(settings);
    coupling::Rocks rocks;
    add(rocks, in_run_frame(0.155, -0.11, 0.0), Vec3(0.0, 1.0, 0.0), 0.01);
    dem->insert(rocks);
    Throw thrown{rocks.velocity[0], rocks.velocity[0], rocks.position[0]};
    for (int i = 0; i < 200; ++i) {
        advance(*dem, 2e-3);
        const Vec3 now = dem->rocks().velocity.at(0);
        if (now == thrown.before) thrown.place = dem->rocks().position[0];
        thrown.after = now;
    }
    return thrown;
}

void throw_rock(Verification& verification, const geometry::SolidSearch& soil, const TriangleSurface& exact, const TriangleSurface& wall,
                const fs::path& file) {
    const Throw thrown = throw_at_face(file);
    const Vec3 change = thrown.after - thrown.before, normal = change.normalized();
    verification.relative("rock thrown at the cut face: restitution", "-", -thrown.after.dot(normal) / thrown.before.dot(normal),
                          k_restitution, 0.01, {"exact", "the soil's; steel has 0.97", {}});
    // Where it turned round, within the way of a call.
    const Vec3 right = geometry::area_vector(exact, exact.triangles[soil.nearest(thrown.place).triangle]).normalized();
    verification.at_most(
        "rock thrown at the cut face: angle between impulse and the exact soil's normal", "deg",
        std::acos(std::min(1.0, normal.dot(right))) * 180.0 / k_pi, 0.1,
        {"exact", "within a facet of the face; across an edge, where facets meet at 7.5 degrees, it would be up to half of that", {}});

    TriangleSurface broken{wall.points, {}};
    for (const geometry::Triangle& triangle : wall.triangles)
        if ((geometry::centroid_of(wall, triangle) - thrown.place).norm() > 0.04) broken.triangles.push_back(triangle);
    const fs::path hole = file.parent_path() / "with_hole.stl";
    write_stl(hole, broken);
    const Throw through = throw_at_face(hole);
    verification.absolute("rock thrown at a hole in the bank: its velocity changes by", "m/s", (through.after - through.before).norm(), 0.0,
                          1e-9, {"exact", "nothing else stops it: it flies on into the soil", {}});
    verification.absolute("rock thrown at a hole in the bank: ends in the soil", "-", soil.contains(through.place) ? 1.0 : 0.0, 1.0, 0.0,
                          {"exact", "the comparison with the exact soil finds a bank that does not hold", {}});
}

void rock_on_the_bank(Verification& verification) {
    const geometry::Bank bank = small_bank();
    const TriangleSurface exact = bank.soil(k_reach), wall = bank.wall({k_reach, k_tolerance, 0.05});
    const fs::path file = verification.folder("bank") / "bank.stl";
    write_stl(file, wall);
    verification.report("bank for the DEM: triangles", "-", static_cast<double>(wall.triangles.size()), {}, {"exact", "", {}});
    verification.at_most("bank for the DEM: distance to the exact soil, both ways", "m", bank.wall_error(wall, exact, k_reach, 0.0025),
                         2.0 * k_tolerance, {"exact", "points 2.5 mm apart", {}});
    const geometry::SolidSearch soil(exact);
    const SingleProcess process;
    let_rock_fall(verification, bank, soil, file);
    throw_rock(verification, soil, exact, wall, file);
}

// --- A step of soil in a box of water ---

constexpr double k_cell = 0.01, k_width = 0.12, k_face = 0.0465, k_top = 0.063, k_diameter = 0.01;

/// The step: up to the face along x and to the top along z, beyond the box elsewhere.
TriangleSurface step() {
    TriangleSurface block;
    for (int i = 0; i < 8; ++i)
        block.points.emplace_back((i & 1) != 0 ? k_face : -0.05, (i & 2) != 0 ? k_width + 0.05 : -0.05, (i & 4) != 0 ? k_top : -0.05);
    block.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return block;
}

BoxCase box_with_step(bool with_wall) {
    BoxCase box;
    box.lower = Vec3::Zero();
    box.upper = Vec3(k_width, k_width, k_width);
    box.cells.fill(static_cast<int>(std::lround(k_width / k_cell)));
    box.end_time = 0.6;
    box.time_step = 1e-3;
    box.write_interval = 0.02;
    box.rocks = {{1, 0.0, Vec3(0.021, 0.061, 0.085), k_diameter, k_rock_density, Vec3::Zero()},
                 {2, 0.0, Vec3(0.081, 0.031, 0.042), k_diameter, k_rock_density, Vec3(-0.8, 0.0, 0.0)},
                 {3, 0.0, Vec3(0.054, 0.089, 0.1), k_diameter, k_rock_density, Vec3::Zero()}};
    if (with_wall) box.walls = "{ name bank; file \"constant/bank.stl\"; rotating false; material soil; }";
    box.contact =
        "youngsModulus 1e8; poissonRock 0.24; poissonSteel 0.27; wetRestitution true; timeStepFraction 0.1; maxSpeed 1.5; "
        "pairs { rock_soil { friction 0.6; restitution 0.3; rollingFriction 0.15; } }";
    box.extra = "soil { surface \"constant/bank.stl\"; permeability 0; }";
    return box;
}

fs::path run_step(Verification& verification, bool with_wall) {
    const fs::path folder = verification.folder(with_wall ? "step" : "step_without_wall");
    write_box_case(folder, box_with_step(with_wall));
    write_stl(folder / "constant/bank.stl", step());
    run_cutter_foam(folder);
    return folder;
}

double largest_error(const fs::path& folder, const char* column) {
    return largest(read_columns(folder / "postProcessing/balance/0/balance.csv").at(column));
}

/// Largest solid fraction of cells whose centres lie in the soil, over all written times.
double solid_in_soil(const fs::path& folder) {
    const BoxCase box = box_with_step(true);
    const int n = box.cells[0];
    double most = 0.0;
    int written = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (!fs::exists(entry.path() / "voidFraction") || entry.path().filename() == "0") continue;
        const std::vector<double> open = read_scalar_field(entry.path() / "voidFraction", box.cell_count());
        for (std::size_t cell = 0; cell < open.size(); ++cell) {
            const double x = (static_cast<double>(cell % n) + 0.5) * k_cell, z = (static_cast<double>(cell / n / n) + 0.5) * k_cell;
            if (x < k_face && z < k_top) most = larger(most, 1.0 - open[cell]);
        }
        ++written;
    }
    if (written < 10) throw std::runtime_error("the run wrote no void fractions");
    return most;
}

/// Largest distance by which a rock is nearer to the step than its radius [m].
double largest_overlap(const fs::path& folder) {
    double overlap = 0.0;
    for (const RockSnapshot& picture : all_rocks(folder))
        for (const Vec3& at : picture.position) {
            const double beside = at.x() - k_face, above = at.z() - k_top;
            const double distance = beside > 0.0 && above > 0.0 ? std::hypot(beside, above) : std::max(beside, above);
            overlap = larger(overlap, 0.5 * k_diameter - distance);
        }
    return overlap;
}

void rock_and_water_on_a_step(Verification& verification) {
    const fs::path felt = run_step(verification, true), ignored = run_step(verification, false);
    const About balance{"exact", "12^3 cells of 10 mm, 3 rocks of 10 mm", {}};
    verification.at_most("step of soil in water: momentum_error", "-", largest_error(felt, "momentum_error"), 1e-7, balance);
    verification.at_most("step of soil in water: solid_volume_error", "-", largest_error(felt, "solid_volume_error"), 1e-12, balance);
    verification.at_most("step of soil in water: largest solid fraction in soil", "-", solid_in_soil(felt), 0.0, balance);
    verification.at_most("step of soil in water: deepest overlap of a rock", "m", largest_overlap(felt), 0.02 * k_diameter, balance);
    const RockSnapshot end = last_rocks(felt);
    verification.absolute("step of soil in water: height of the rock on it", "m", end.position.at(0).z() - k_top, 0.5 * k_diameter,
                          0.01 * k_diameter, {"exact", "the others have sunk to the floor beside it", {}});
    verification.at_most("step of soil in water: speed of the rock on it", "m/s", end.velocity.at(0).norm(), 1e-3, {"exact", "", {}});
    verification.at_least("the same without its wall in the DEM: largest solid fraction in soil", "-", solid_in_soil(ignored), 0.01,
                          {"exact", "rock sinks into soil that the water alone feels: the check must find it", {}});
    verification.report("the same without its wall in the DEM: momentum_error", "-", largest_error(ignored, "momentum_error"), {}, balance);
}

void run(Verification& verification) {
    rock_and_water_on_a_step(verification);  // before MPI is there
    rock_on_the_bank(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
