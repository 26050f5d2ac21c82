/// Rolling friction through the engine: onset, acceleration and rest on a tilted plate, gears, a plate that turns, two ranks.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/sphere.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/contact_bench.hpp"
#include "validation/harness/scenes/rolling_trials.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_gravity = 9.81;  // [m/s2]
constexpr const char* k_heap = "heap";

std::unique_ptr<coupling::DemEngine> engine_of(const coupling::DemSettings& settings) {
    return dem_engine(settings);
}

Vec3 no_force(std::size_t, const Vec3&) {
    return Vec3::Zero();
}

void check_plates(Verification& verification) {
    const auto check = [&](double diameter, double youngs_modulus) {
        Plate plate;
        plate.diameter = diameter;
        plate.youngs_modulus = youngs_modulus;
        check_onset(verification, engine_of, plate);
        check_descent(verification, engine_of, plate);
    };
    for (const double youngs_modulus : {1e6, 5e6, 1e8, 1e9}) check(0.004, youngs_modulus);
    for (const double diameter : {0.001, 0.03}) check(diameter, 5e6);
    check(0.001, 1e9);
    if (verification.wants(Effort::standard)) check(0.03, 1e6);
    Plate slippery;
    slippery.friction = 0.15;
    check_onset(verification, engine_of, slippery);
    Plate constant;
    constant.law = "constant";
    check_descent(verification, engine_of, constant);
}

/// A sphere rests on a slope of 8 degrees while plate and load turn together by 90 degrees about the slope's direction.
double drift_on_turning_plate(const std::filesystem::path& stl) {
    constexpr double turn_rate = 1.0, diameter = 0.004, density = 828.0, half = 0.05;  // [rad/s], [m], [kg/m3], [m]
    constexpr double slope = 8.0 * k_pi / 180.0, settling = 0.5, call = 1e-4;
    write_file(stl, fmt::format("solid plate\n"
                                "facet normal 0 0 1\nouter loop\nvertex {0} {0} 0\nvertex {1} {0} 0\nvertex {1} {1} 0\nendloop\nendfacet\n"
                                "facet normal 0 0 1\nouter loop\nvertex {0} {0} 0\nvertex {1} {1} 0\nvertex {0} {1} 0\nendloop\nendfacet\n"
                                "endsolid plate\n",
                                -half, half));
    coupling::DemSettings settings = plate_dem(Plate{}, 0.0, 0.0);
    settings.gravity.setZero();
    settings.domain = coupling::cylinder_domain(0.2, -0.2, 0.2);
    settings.walls = {{"plate", stl, true}};
    coupling::ZoneMotion turning;
    turning.axis = {Vec3::Zero(), Vec3::UnitX()};
    turning.speed = turn_rate;
    const auto engine = dem_engine(settings, {turning});

    const Vec3 load = k_gravity * sphere_mass(diameter, density) * Vec3(std::sin(slope), 0.0, -std::cos(slope));
    const Vec3 start(0.0, 0.0, 0.5 * diameter * (1.0 + 1e-7)), spin = turn_rate * Vec3::UnitX();
    coupling::Rocks sphere;
    sphere.append({1, start, spin.cross(start), spin, diameter, density});
    engine->insert(sphere);
    double time = 0.0;
    const auto turn_until = [&](double end) {
        for (; time < end; time += call) {
            const Vec3 now = rotate_about(turning.axis, turn_rate * (time + 0.5 * call), load);
            engine->advance(call, [&](std::size_t, const Vec3&) { return now; });
        }
        return rotate_about(turning.axis, -turn_rate * time, engine->rocks().position[0]);
    };
    const Vec3 before = turn_until(settling);
    const Vec3 way = turn_until(settling + 0.5 * k_pi / turn_rate) - before;
    return std::abs(way.x()) / diameter;
}

void check_turning_plate(Verification& verification) {
    verification.at_most("way of a resting sphere down the slope while plate and load turn by 90 degrees, over its diameter", "-",
                         drift_on_turning_plate(verification.folder("plate.stl")), 1e-6,
                         {"exact", "on 8 degrees; the spring's own give is 4e-5", {}});
}

/// 48 rocks that fall on each other and a floor, and what their velocities and spins are when most touch.
void run_heap(const std::filesystem::path& file) {
    const SingleProcess mpi;
    Plate rock;
    coupling::DemSettings settings = plate_dem(rock, 0.0, 0.0);
    settings.domain.lower = rock.diameter * Vec3(-10.0, -5.0, 0.0);  // two ranks meet at x = 0
    settings.domain.upper = rock.diameter * Vec3(10.0, 5.0, 5.0);
    coupling::Rocks rocks;
    for (int k = 0; k < 48; ++k) {
        const Vec3 place(1.03 * (k % 4) + 0.2 * (k / 16) - 1.6, 1.02 * (k / 4 % 4) - 1.5, 0.51 + 1.01 * (k / 16));
        const Vec3 velocity(0.05 * std::sin(k), 0.05 * std::cos(k), -0.1);
        rocks.append({k + 1, rock.diameter * place, velocity, Vec3::Zero(), rock.diameter, rock.density});
    }
    const auto engine = engine_of(settings);
    engine->insert(rocks);
    const coupling::DemStep step = engine->advance(0.05, no_force);
    nlohmann::json state{{"contacts", step.contacts}, {"values", nlohmann::json::array()}};
    for (std::size_t k = 0; k < engine->rocks().size(); ++k)
        for (const Vec3& vector : {engine->rocks().position[k], Vec3(rock.diameter * engine->rocks().angular_velocity[k])})
            for (const double value : vector) state["values"].push_back(value);
    if (is_first_process()) write_file(file, state.dump());
}

nlohmann::json heap_on(const std::filesystem::path& folder, int ranks) {
    std::filesystem::create_directories(folder);
    const std::filesystem::path file = folder / "heap.json";
    const std::filesystem::path program = installation().verification / "rolling";
    require_child(meshing::foam_command(folder, program.string(), {k_heap, file.string()}, ranks));
    return nlohmann::json::parse(read_file(file));
}

/// Before MPI starts in this program.
void check_ranks(Verification& verification) {
    const nlohmann::json one = heap_on(verification.folder("one_rank"), 1), two = heap_on(verification.folder("two_ranks"), 2);
    verification.at_least("contacts in the heap", "-", one.at("contacts"), 15.0, {"exact", "48 rocks, 0.05 s", {}});
    double apart = one.at("values").size() == two.at("values").size() ? 0.0 : 1.0;
    for (std::size_t k = 0; k < std::min(one.at("values").size(), two.at("values").size()); ++k)
        apart = larger(apart, std::abs(one["values"][k].get<double>() - two["values"][k].get<double>()));
    verification.at_most("places and spins on one and on two ranks, apart", "m, m/s", apart, 1e-10,
                         {"exact", "spins times the diameter", {}});
}

void run(Verification& verification) {
    check_ranks(verification);
    const SingleProcess mpi;
    check_plates(verification);
    for (const char* law : {"spring", "constant"}) check_gears(verification, engine_of, law);
    check_turning_plate(verification);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 2 && std::string(argv[1]) == k_heap) {
        run_heap(argv[2]);
        return 0;
    }
    return verify(argc, argv, run);
}
