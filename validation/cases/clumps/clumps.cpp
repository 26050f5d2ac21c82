/// Clumps: the shapes that `cutterflow clump` makes, their motion in the DEM, a clump that settles in water.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/clump/clump_file.hpp"
#include "geometry/clump/unit_clump.hpp"
#include "geometry/io/write_stl.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/program_run.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/contact_bench.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr const char* k_heap = "heap";
constexpr double k_density = 2650.0;  // [kg/m3]
constexpr int k_directions = 500;     // over half a sphere
constexpr int k_lattice = 300;        // points along each side of a shadow's square
constexpr int k_points = 2'000'000;   // random ones in a solid's box
constexpr int k_shadow_points = 1'000'000;

// --- The judge of shapes. -------------------------------------------------------------------------------------------------------------

struct Sphere {
    Vec3 centre = Vec3::Zero();
    double radius = 0.0;
};

struct Numbers {
    double volume = 0.0;
    Vec3 moments = Vec3::Zero();  ///< principal ones, per density, ascending
    double smallest = 0.0, largest = 0.0;
};

Vec3 direction_of(int k) {
    const double z = (k + 0.5) / k_directions, azimuth = k_pi * (3.0 - std::sqrt(5.0)) * k, across = std::sqrt(1.0 - z * z);
    return {across * std::cos(azimuth), across * std::sin(azimuth), z};
}

struct Flat {
    Vec3 e1, e2;
    explicit Flat(const Vec3& direction) : e1(direction.unitOrthogonal()), e2(direction.cross(e1)) {}
    Eigen::Vector2d operator()(const Vec3& point) const { return {point.dot(e1), point.dot(e2)}; }
};

/// Principal moments from the integrals of 1, x and x x^T.
Vec3 moments_of(double volume, const Vec3& first, const Eigen::Matrix3d& second) {
    const Eigen::Matrix3d covariance = second - first * first.transpose() / volume;
    const Eigen::Matrix3d inertia = covariance.trace() * Eigen::Matrix3d::Identity() - covariance;
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
}

class Random {
public:
    double operator()(double low, double high) { return low + (high - low) * (random_() + 0.5) / (std::mt19937_64::max() + 1.0); }

private:
    std::mt19937_64 random_{20261124};
};

bool is_within(const std::vector<Sphere>& spheres, const Vec3& point) {
    return std::any_of(spheres.begin(), spheres.end(),
                       [&](const Sphere& sphere) { return (point - sphere.centre).squaredNorm() < sphere.radius * sphere.radius; });
}

/// How far from the origin the spheres reach.
double reach_of(const std::vector<Sphere>& spheres) {
    double reach = 0.0;
    for (const Sphere& sphere : spheres) reach = std::max(reach, sphere.centre.norm() + sphere.radius);
    return reach;
}

bool in_shadow(const std::vector<Sphere>& spheres, const Flat& flat, const Eigen::Vector2d& point) {
    return std::any_of(spheres.begin(), spheres.end(),
                       [&](const Sphere& sphere) { return (point - flat(sphere.centre)).squaredNorm() < sphere.radius * sphere.radius; });
}

double shadow_on_lattice(const std::vector<Sphere>& spheres, const Vec3& direction, double reach) {
    const Flat flat(direction);
    const double spacing = 2.0 * reach / k_lattice;
    std::vector<char> dark(static_cast<std::size_t>(k_lattice) * k_lattice, 0);
    for (const Sphere& sphere : spheres) {
        const Eigen::Vector2d centre = flat(sphere.centre);
        const auto index = [&](double x) { return std::clamp(static_cast<int>((x + reach) / spacing), 0, k_lattice - 1); };
        for (int i = index(centre.x() - sphere.radius); i <= index(centre.x() + sphere.radius); ++i)
            for (int j = index(centre.y() - sphere.radius); j <= index(centre.y() + sphere.radius); ++j) {
                const Eigen::Vector2d point(-reach + (i + 0.5) * spacing, -reach + (j + 0.5) * spacing);
                if ((point - centre).squaredNorm() < sphere.radius * sphere.radius) dark[static_cast<std::size_t>(i * k_lattice + j)] = 1;
            }
    }
    return spacing * spacing * static_cast<double>(std::count(dark.begin(), dark.end(), 1));
}

double random_shadow(const std::vector<Sphere>& spheres, const Vec3& direction, double reach) {
    const Flat flat(direction);
    Random random;
    int hits = 0;
    for (int k = 0; k < k_shadow_points; ++k) {
        const double x = random(-reach, reach), y = random(-reach, reach);
        hits += in_shadow(spheres, flat, {x, y}) ? 1 : 0;
    }
    return 4.0 * reach * reach * hits / k_shadow_points;
}

/// Of the union of the spheres, from random points.
Numbers judged(const std::vector<Sphere>& spheres) {
    const double reach = reach_of(spheres);
    Random random;
    Numbers numbers;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    const double share = 8.0 * reach * reach * reach / k_points;
    for (int k = 0; k < k_points; ++k) {
        const double x = random(-reach, reach), y = random(-reach, reach), z = random(-reach, reach);
        const Vec3 point(x, y, z);
        if (!is_within(spheres, point)) continue;
        numbers.volume += share;
        first += share * point;
        second += share * point * point.transpose();
    }
    numbers.moments = moments_of(numbers.volume, first, second);
    Vec3 smallest_along = direction_of(0), largest_along = direction_of(0);
    double smallest = 1e300, largest = 0.0;
    for (int k = 0; k < k_directions; ++k) {
        const double area = shadow_on_lattice(spheres, direction_of(k), reach);
        if (area < smallest) smallest_along = direction_of(k);
        if (area > largest) largest_along = direction_of(k);
        smallest = std::min(smallest, area);
        largest = std::max(largest, area);
    }
    numbers.smallest = random_shadow(spheres, smallest_along, reach);
    numbers.largest = random_shadow(spheres, largest_along, reach);
    return numbers;
}

// --- Rocks as surfaces. ---------------------------------------------------------------------------------------------------------------

/// Points of a sphere on the six sides of a cube of an odd number of cells: none lies in a plane of symmetry. `place` moves them.
template <class Place>
geometry::TriangleSurface on_sphere(const Place& place) {
    constexpr int n = 19;
    geometry::TriangleSurface surface;
    for (int side = 0; side < 6; ++side) {
        const auto corner = [&](int i, int j) {
            const double u = std::tan(0.25 * k_pi * (-1.0 + 2.0 * i / n)), v = std::tan(0.25 * k_pi * (-1.0 + 2.0 * j / n));
            Vec3 on_cube;
            on_cube[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
            on_cube[(side / 2 + 1) % 3] = u;
            on_cube[(side / 2 + 2) % 3] = side % 2 == 0 ? v : -v;
            return Vec3(place(Vec3(on_cube.normalized())));
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const auto at = static_cast<std::uint32_t>(surface.points.size());
                for (const Vec3& point : {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)})
                    surface.points.push_back((1e12 * point).array().round().matrix() * 1e-12);
                surface.triangles.push_back({at, at + 1, at + 2});
                surface.triangles.push_back({at, at + 2, at + 3});
            }
    }
    return geometry::welded(surface);
}

geometry::TriangleSurface ellipsoid() {
    return on_sphere([](const Vec3& n) { return Vec3(0.02 * n.cwiseProduct(Vec3(1.0, 0.75, 0.5))); });
}

/// Edges rounded by a quarter of its smallest length.
geometry::TriangleSurface rounded_box() {
    const Vec3 half = 0.02 * Vec3(1.0, 0.7, 0.5);
    const double round = 0.5 * half.z();
    return on_sphere([&](const Vec3& n) {
        Vec3 point;
        for (int i = 0; i < 3; ++i) point[i] = std::copysign(half[i] - round, n[i]) + round * n[i];
        return point;
    });
}

geometry::TriangleSurface lump() {
    Random random;
    std::vector<Vec3> waves;
    std::vector<double> phases;
    for (int k = 0; k < 8; ++k) {
        const double x = random(-1.0, 1.0), y = random(-1.0, 1.0), z = random(-1.0, 1.0);
        waves.push_back(2.5 * Vec3(x, y, z).normalized());
        phases.push_back(random(0.0, 2.0 * k_pi));
    }
    return on_sphere([=](const Vec3& n) {
        double radius = 1.0;
        for (std::size_t k = 0; k < waves.size(); ++k) radius += 0.06 * std::sin(waves[k].dot(n) + phases[k]);
        return Vec3(0.02 * radius * n.cwiseProduct(Vec3(1.0, 0.85, 0.65)));
    });
}

/// Of a closed surface, from its tetrahedra with the origin, and from its triangles' shadows on a lattice.
Numbers numbers_of(const geometry::TriangleSurface& surface) {
    Numbers numbers;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    double reach = 0.0;
    for (const Vec3& point : surface.points) reach = std::max(reach, 1.01 * point.norm());
    for (const geometry::Triangle& t : surface.triangles) {
        const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
        const double volume = a.dot(b.cross(c)) / 6.0;
        const Vec3 sum = a + b + c;
        numbers.volume += volume;
        first += 0.25 * volume * sum;
        second += 0.05 * volume * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
    }
    numbers.moments = moments_of(numbers.volume, first, second);
    numbers.smallest = 1e300;
    const double spacing = 2.0 * reach / k_lattice;
    for (int k = 0; k < k_directions; ++k) {
        const Flat flat(direction_of(k));
        std::vector<char> dark(static_cast<std::size_t>(k_lattice) * k_lattice, 0);
        for (const geometry::Triangle& t : surface.triangles) {
            std::array<Eigen::Vector2d, 3> p;
            for (std::size_t c = 0; c < 3; ++c) p[c] = (flat(surface.points[t[c]]).array() + reach) / spacing - 0.5;
            const auto side = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to, double x, double y) {
                return (to.x() - from.x()) * (y - from.y()) - (to.y() - from.y()) * (x - from.x());
            };
            const double turn = side(p[0], p[1], p[2].x(), p[2].y()) > 0.0 ? 1.0 : -1.0;
            const auto [x0, x1] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
            const auto [y0, y1] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
            for (int i = static_cast<int>(std::ceil(x0)); i <= x1; ++i)
                for (int j = static_cast<int>(std::ceil(y0)); j <= y1; ++j)
                    if (turn * side(p[0], p[1], i, j) >= 0.0 && turn * side(p[1], p[2], i, j) >= 0.0 &&
                        turn * side(p[2], p[0], i, j) >= 0.0)
                        dark[static_cast<std::size_t>(i * k_lattice + j)] = 1;
        }
        const double area = spacing * spacing * static_cast<double>(std::count(dark.begin(), dark.end(), 1));
        numbers.smallest = std::min(numbers.smallest, area);
        numbers.largest = std::max(numbers.largest, area);
    }
    return numbers;
}

/// The file's own numbers, without the program's reader.
std::vector<Sphere> spheres_of_file(const fs::path& file) {
    std::vector<Sphere> spheres;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        if (line == "[[sphere]]") spheres.emplace_back();
        const auto equals = line.find(" = ");
        if (spheres.empty() || equals == std::string::npos || line.front() == '#') continue;
        const std::string key = line.substr(0, equals);
        const double value = std::strtod(line.c_str() + equals + 3, nullptr);
        if (key == "radius_m")
            spheres.back().radius = value;
        else
            spheres.back().centre[key.front() - 'x'] = value;
    }
    return spheres;
}

void compare(Verification& verification, const std::string& name, const Numbers& clump, const Numbers& rock, double tolerance,
             const About& about) {
    verification.relative(name + ": volume", "m3", clump.volume, rock.volume, tolerance, about);
    for (int k = 0; k < 3; ++k)
        verification.relative(fmt::format("{}: principal moment {}", name, k + 1), "m5", clump.moments[k], rock.moments[k], tolerance,
                              about);
    verification.relative(name + ": smallest shadow", "m2", clump.smallest, rock.smallest, tolerance, about);
    verification.relative(name + ": largest shadow", "m2", clump.largest, rock.largest, tolerance, about);
}

/// Two spheres of radius r, their centres c apart: each half is a sphere less a cap.
void check_dumbbell(Verification& verification) {
    const double r = 0.01, c = 0.012;
    geometry::Clump clump;
    clump.balls = {{Vec3(-0.5 * c, 0.0, 0.0), r}, {Vec3(0.5 * c, 0.0, 0.0), r}};
    const double volume = 8.0 / 3.0 * k_pi * r * r * r - k_pi * (4.0 * r + c) * (2.0 * r - c) * (2.0 * r - c) / 12.0;
    const double lens = 2.0 * r * r * std::acos(0.5 * c / r) - 0.5 * c * std::sqrt(4.0 * r * r - c * c);
    // Of the half x > 0, slices of radius^2 = r^2 - t^2, t = x - c/2 from -c/2 to r: integrals of rho^4 and of x^2 rho^2.
    double fourth = 0.0, along = 0.0;
    constexpr int slices = 100000;
    for (int k = 0; k < slices; ++k) {
        const double step = (r + 0.5 * c) / slices, t = -0.5 * c + (k + 0.5) * step, square = r * r - t * t, x = t + 0.5 * c;
        fourth += 2.0 * step * square * square;
        along += 2.0 * step * square * x * x;
    }
    const Numbers closed{volume, Vec3(0.5 * k_pi * fourth, k_pi * (0.25 * fourth + along), k_pi * (0.25 * fourth + along)), k_pi * r * r,
                         2.0 * k_pi * r * r - lens};
    const geometry::ClumpProperties found = geometry::clump_properties(clump);
    const Numbers numbers{found.volume, found.principal_moments, found.shadow.smallest, found.shadow.largest};
    compare(verification, "dumbbell", numbers, closed, 0.002, {"exact", "radius 10 mm, centres 12 mm apart", {}});
}

/// Makes the rock's clump by the program. \return the clump file
fs::path check_rock(Verification& verification, const std::string& name, const geometry::TriangleSurface& surface) {
    const fs::path folder = verification.folder(name);
    fs::create_directories(folder);
    geometry::write_stl(surface, folder / "rock.stl");
    run_cutterflow(folder, {"clump", "rock.stl", "--spheres", "12", "-o", "rock.clump"});
    compare(verification, name, judged(spheres_of_file(folder / "rock.clump")), numbers_of(surface), 0.02,
            {"exact", "12 spheres; random points on their union against the STL", {}});
    return folder / "rock.clump";
}

// --- Motion. --------------------------------------------------------------------------------------------------------------------------

Vec3 no_force(std::size_t, const Vec3&) {
    return Vec3::Zero();
}

struct Body {
    coupling::ClumpShape shape;
    double diameter = 0.02;

    double mass() const { return sphere_mass(diameter, k_density); }
    Eigen::Matrix3d inertia(const Eigen::Quaterniond& orientation) const {
        const Eigen::Matrix3d turn = orientation.toRotationMatrix() * shape.clump.axes;
        return k_density * std::pow(diameter, 5) * turn * shape.clump.moments.asDiagonal() * turn.transpose();
    }
    double energy(const coupling::Rock& rock) const {
        return 0.5 * mass() * rock.velocity.squaredNorm() +
               0.5 * rock.angular_velocity.dot(inertia(rock.orientation) * rock.angular_velocity);
    }
    Vec3 angular_momentum(const coupling::Rock& rock) const { return inertia(rock.orientation) * rock.angular_velocity; }
    coupling::Rock at(int id, const Vec3& place) const {
        coupling::Rock rock;
        rock.id = id;
        rock.position = place;
        rock.diameter = diameter;
        rock.density = k_density;
        rock.shape = 0;
        rock.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7 * id, Vec3(std::sin(id), 0.5, std::cos(id)).normalized()));
        return rock;
    }
};

coupling::DemSettings room_of(const Body& body, bool floor, double restitution, double friction) {
    coupling::DemSettings settings = dry_room(0.5, floor, {1e7, 0.24, k_density}, restitution, friction, 2.0);
    settings.shapes = {body.shape};
    return settings;
}

coupling::Rocks only(const coupling::Rock& rock) {
    coupling::Rocks rocks;
    rocks.append(rock);
    return rocks;
}

void check_tumbling(Verification& verification, const Body& body) {
    constexpr double spin = 60.0, turn = 2.0 * k_pi / spin;
    const auto engine = dem_engine(room_of(body, false, 0.9, 0.5));
    coupling::Rock rock = body.at(1, Vec3(0.1, 0.05, 0.02));
    const Vec3 middle = rock.orientation * Vec3(body.shape.clump.axes.col(1));
    rock.angular_velocity = spin * (middle + 1e-3 * Vec3(1.0, -2.0, 1.5));
    engine->insert(only(rock));
    const double energy = body.energy(rock);
    const Vec3 momentum = body.angular_momentum(rock);
    double energy_error = 0.0, momentum_error = 0.0;
    int flips = 0, contacts = 0;
    double side = 1.0;
    const fs::path checkpoint = verification.folder("mid_tumble");
    fs::create_directories(checkpoint);
    for (int call = 0; call < 1000; ++call) {
        if (call == 500) engine->write_checkpoint(checkpoint);
        contacts += engine->advance(0.1 * turn, no_force).contacts;
        const coupling::Rock now = engine->rocks().at(0);
        energy_error = larger(energy_error, std::abs(body.energy(now) / energy - 1.0));
        momentum_error = larger(momentum_error, (body.angular_momentum(now) - momentum).norm() / momentum.norm());
        const double along = (now.orientation * Vec3(body.shape.clump.axes.col(1))).dot(momentum.normalized());
        if (side * along < -0.9) {
            side = -side;
            ++flips;
        }
    }
    verification.at_most("100 free turns: angular momentum, relative change", "-", momentum_error, 1e-10, {"exact", "60 rad/s", {}});
    verification.at_most("100 free turns: energy, relative change", "-", energy_error, 1e-6, {"exact", "60 rad/s", {}});
    verification.at_least("100 free turns about the middle axis: flips", "-", flips, 2.0, {"exact", "started 0.3 % beside the axis", {}});
    verification.at_most("100 free turns: contacts of the body with itself", "-", contacts, 0.0, {"exact", "12 spheres that overlap", {}});

    const auto resumed = dem_engine(room_of(body, false, 0.9, 0.5));
    resumed->read_checkpoint(checkpoint);
    for (int call = 500; call < 1000; ++call) resumed->advance(0.1 * turn, no_force);
    const coupling::Rock a = engine->rocks().at(0), b = resumed->rocks().at(0);
    verification.at_most("resumed in mid-tumble: places of the spheres, apart", "m",
                         (a.position - b.position).norm() + body.diameter * a.orientation.angularDistance(b.orientation), 1e-12,
                         {"exact", "50 turns later", {}});
}

void check_bounce(Verification& verification, const Body& body) {
    double worst = 0.0, least_change = 1e300;
    for (int id = 1; id <= 8; ++id) {
        const auto engine = dem_engine(room_of(body, true, 1.0, 0.0));
        coupling::Rock rock = body.at(id, Vec3(0.0, 0.0, 0.04));
        rock.velocity = Vec3(0.3, -0.1, -1.5);
        rock.angular_velocity = Vec3(10.0, 20.0, -5.0);
        engine->insert(only(rock));
        for (int call = 0; call < 60; ++call) engine->advance(1e-3, no_force);
        const coupling::Rock after = engine->rocks().at(0);
        worst = larger(worst, std::abs(body.energy(after) / body.energy(rock) - 1.0));
        least_change = std::min(least_change, after.velocity.z() - rock.velocity.z());
    }
    verification.at_most("frictionless elastic bounce: energy, relative change", "-", worst, 1e-3,
                         {"exact", "the worst of 8 orientations at 1.5 m/s", {}});
    verification.at_least("frictionless elastic bounce: change of the vertical speed", "m/s", least_change, 0.5, {"exact", "", {}});
}

Body body_of(const fs::path& file) {
    return {{"lump", geometry::unit_clump(geometry::read_clump(file))}};
}

/// 16 clumps that fall on each other and a floor, and where they are when most touch.
void run_heap(const fs::path& clump, const fs::path& result) {
    const SingleProcess mpi;
    const Body body = body_of(clump);
    coupling::DemSettings settings = room_of(body, true, 0.6, 0.5);
    settings.gravity = Vec3(0.0, 0.0, -9.81);
    settings.domain = coupling::DomainSettings();
    settings.domain.lower = Vec3(-0.2, -0.1, 0.0);  // two ranks meet at x = 0
    settings.domain.upper = Vec3(0.2, 0.1, 0.2);
    settings.domain.make_wall(coupling::DomainSide::z_min);
    coupling::Rocks rocks;
    for (int k = 0; k < 16; ++k) {
        coupling::Rock rock = body.at(k + 1, Vec3(0.033 * (k % 4) - 0.05, 0.033 * (k / 4 % 2) - 0.015, 0.02 + 0.033 * (k / 8)));
        rock.velocity = Vec3(0.05 * std::sin(k), 0.05 * std::cos(k), -0.3);
        rocks.append(rock);
    }
    const auto engine = dem_engine(settings);
    engine->insert(rocks);
    int contacts = 0;
    for (int call = 0; call < 300; ++call) contacts = engine->advance(1e-3, no_force).contacts;
    nlohmann::json state{{"rocks", engine->rocks().size()}, {"contacts", contacts}, {"values", nlohmann::json::array()}};
    for (std::size_t k = 0; k < engine->rocks().size(); ++k) {
        const coupling::Rock rock = engine->rocks().at(k);
        for (const Vec3& end : {rock.position, Vec3(rock.position + rock.diameter * (rock.orientation * Vec3(Vec3::UnitX())))})
            for (const double value : end) state["values"].push_back(value);
    }
    if (is_first_process()) write_file(result, state.dump());
}

nlohmann::json heap_on(const fs::path& folder, const fs::path& clump, int ranks) {
    fs::create_directories(folder);
    const fs::path file = folder / "heap.json", program = installation().verification / "clumps";
    require_child(meshing::foam_command(folder, program.string(), {k_heap, clump.string(), file.string()}, ranks));
    return nlohmann::json::parse(read_file(file));
}

/// Before MPI starts in this program.
void check_ranks(Verification& verification, const fs::path& clump) {
    const nlohmann::json one = heap_on(verification.folder("one_rank"), clump, 1),
                         two = heap_on(verification.folder("two_ranks"), clump, 2);
    verification.at_least("contacts in the heap", "-", one.at("contacts"), 16.0,
                          {"exact", "16 clumps of 12 spheres, 0.3 s after they were thrown", {}});
    double apart = one.at("values").size() == two.at("values").size() && one.at("rocks") == 16 ? 0.0 : 1.0;
    for (std::size_t k = 0; k < std::min(one.at("values").size(), two.at("values").size()); ++k)
        apart = larger(apart, std::abs(one["values"][k].get<double>() - two["values"][k].get<double>()));
    verification.at_most("heap on one and on two ranks, apart", "m", apart, 1e-8, {"exact", "centres, and points a diameter aside", {}});
}

// --- In water. ------------------------------------------------------------------------------------------------------------------------

/// Acceleration [m/s2] of a rock that falls at `speed`: weight, buoyancy, Haider and Levenspiel's drag on d^2 pi/4, added mass 1/2.
double fall_acceleration(double diameter, double sphericity, double speed) {
    constexpr double water = 998.2, viscosity = 1.0034e-6;
    const double re = std::max(speed * diameter / viscosity, 1e-9);
    const double a = 8.1716 * std::exp(-4.0655 * sphericity), b = 0.0964 + 0.5565 * sphericity;
    const double c = 73.69 * std::exp(-5.0748 * sphericity), d = 5.378 * std::exp(6.2122 * sphericity);
    const double drag = 24.0 / re * (1.0 + a * std::pow(re, b)) + c / (1.0 + d / re);
    return ((k_density - water) * 9.81 - 0.75 / diameter * water * drag * speed * speed) / (k_density + 0.5 * water);
}

/// What postProcessing/rock/shapes.json gives of the first shape, for a rock of that diameter.
std::vector<Sphere> spheres_in_the_dem(const fs::path& folder, double diameter) {
    const auto shapes = nlohmann::json::parse(read_file(folder / "postProcessing/rock/shapes.json"));
    std::vector<Sphere> spheres;
    for (const nlohmann::json& ball : shapes.at(0).at("spheres_over_diameter")) {
        const nlohmann::json& centre = ball.at("centre");
        const Vec3 place(centre.at(0).get<double>(), centre.at(1).get<double>(), centre.at(2).get<double>());
        spheres.push_back({diameter * place, diameter * ball.at("radius").get<double>()});
    }
    return spheres;
}

void check_settling(Verification& verification, const fs::path& clump, const Numbers& rock, double surface_area) {
    constexpr double diameter = 0.01, fall = 14.0, ratio = 0.5, half = 16.0;
    const double sphericity = std::cbrt(36.0 * k_pi * rock.volume * rock.volume) / surface_area;
    double terminal = 0.0;
    for (double step = 1.0; step > 1e-9; step *= 0.5)
        while (fall_acceleration(diameter, sphericity, terminal + step) > 0.0) terminal += step;
    BoxCase box;
    const int across = static_cast<int>(2.0 * half * ratio), along = 22;
    box.lower = Vec3(-half, -half, 0.0) * diameter;
    box.upper = Vec3(half, half, along / ratio) * diameter;
    box.cells = {across, across, along};
    box.closures = "drag haider_levenspiel; hindrance di_felice; addedMass 0.5; sphericity 1;";
    box.shapes = "lump { file \"constant/lump.clump\"; }";
    const Vec3 place(0.13 * diameter, -0.21 * diameter, box.upper.z() - 15.0 * diameter);
    box.rocks = {{1, 0.0, place, diameter, k_density, Vec3(0.0, 0.0, -0.95 * terminal), "lump"}};
    const double step = 0.4 * diameter / terminal, steps = std::ceil(fall * diameter / terminal / step);
    box.time_step = std::round(1e7 * fall * diameter / terminal / steps) * 1e-7;
    box.end_time = steps * box.time_step;
    const fs::path folder = verification.folder("settling");
    write_box_case(folder, box);
    fs::copy_file(clump, folder / "constant/lump.clump");
    run_cutter_foam(folder);
    double speed = 0.95 * terminal;
    constexpr int k_steps = 100000;
    for (int k = 0; k < k_steps; ++k) {
        const double dt = box.end_time / k_steps, middle = speed + 0.5 * dt * fall_acceleration(diameter, sphericity, speed);
        speed += dt * fall_acceleration(diameter, sphericity, middle);
    }
    verification.relative("settling clump: speed", "m/s", -last_rocks(folder).velocity.at(0).z(), speed, 0.014,
                          {"HaiderLevenspiel1989", fmt::format("10 mm, sphericity {:.3f}, terminal {:.4f} m/s", sphericity, terminal), {}});
    const auto balance = read_columns(folder / "postProcessing/balance/0/balance.csv");
    const std::vector<double>& error = balance.at("solid_volume_error");
    verification.at_most("settling clump: solid volume on the mesh less that of the rock, relative", "-", largest(error), 1e-12,
                         {"exact", "every step", {}});
    verification.relative("settling clump: volume of its spheres' union in the DEM", "m3",
                          judged(spheres_in_the_dem(folder, diameter)).volume, sphere_volume(diameter), 0.005,
                          {"exact", "the spheres that the run tells, by random points, against the sphere of its diameter", {}});
    geometry::Clump scaled;
    for (const geometry::Ball& ball : geometry::unit_clump(geometry::read_clump(clump)).balls)
        scaled.balls.push_back({diameter * ball.centre, diameter * ball.radius});
    verification.relative("settling clump: the program's own volume of the union, by which it scales", "m3",
                          geometry::union_mass_properties(scaled).volume, sphere_volume(diameter), 1e-7,
                          {"exact", "holds the scaling alone; the row above judges the volume", {}});
}

double surface_area_of(const geometry::TriangleSurface& surface) {
    double area = 0.0;
    for (const geometry::Triangle& t : surface.triangles)
        area += 0.5 * (surface.points[t[1]] - surface.points[t[0]]).cross(surface.points[t[2]] - surface.points[t[0]]).norm();
    return area;
}

void run(Verification& verification) {
    check_dumbbell(verification);
    check_rock(verification, "ellipsoid", ellipsoid());
    check_rock(verification, "rounded_box", rounded_box());
    const geometry::TriangleSurface rock = lump();
    const fs::path clump = check_rock(verification, "lump", rock);
    check_ranks(verification, clump);
    check_settling(verification, clump, numbers_of(rock), surface_area_of(rock));
    const SingleProcess mpi;
    const Body body = body_of(clump);
    check_tumbling(verification, body);
    check_bounce(verification, body);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 3 && std::string(argv[1]) == k_heap) {
        run_heap(argv[2], argv[3]);
        return 0;
    }
    return verify(argc, argv, run);
}
