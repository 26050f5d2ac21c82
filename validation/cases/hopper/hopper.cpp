/// Discharge of a flat-bottomed hopper through orifices of five sizes, from one poured bed.
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "cases/runner/machine.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/side_by_side.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/base/statistics/sample.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr double k_diameter = 0.004, k_density = 2500.0, k_gravity = 9.81;      // [m], [kg/m3], [m/s2]
constexpr double k_radius = 0.04, k_fill = 0.1, k_top = 0.24, k_below = -0.04;  // of the cylinder [m]
constexpr double k_modulus = 5e6;                                               // [Pa]
constexpr double k_open = 0.02, k_start = 0.15;                                 // the gate goes; from then on the flow counts [s]
constexpr double k_beverloo = 1.4;                                              // k of the empty annulus
constexpr int k_facets = 96;
constexpr int k_pours = 3;
constexpr double k_orifices[] = {0.024, 0.028, 0.032, 0.036, 0.040}, k_of_stiffness = 0.032;  // [m]

Vec3 on_circle(double radius, int k, double z) {
    const double angle = 2.0 * k_pi * k / k_facets;
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// The strip between two circles about the z axis, as STL.
std::string ring(const Vec3& first, const Vec3& second) {  // radius in x, height in z
    std::string text = "solid ring\n";
    const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const Vec3& p : {a, b, c}) text += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
        text += "endloop\nendfacet\n";
    };
    for (int k = 0; k < k_facets; ++k) {
        const Vec3 a = on_circle(first.x(), k, first.z()), b = on_circle(first.x(), k + 1, first.z());
        const Vec3 c = on_circle(second.x(), k, second.z()), d = on_circle(second.x(), k + 1, second.z());
        if (second.x() > 0.0) facet(a, d, c);
        if (first.x() > 0.0) facet(a, b, d);
    }
    return text + "endsolid ring\n";
}

/// \param rock  further entries of rock \param extra  further sections
void write_case(const fs::path& folder, double modulus, const std::string& rock, const std::string& walls, double end,
                const std::string& extra) {
    write_foam_dictionary(folder, "constant/g", "uniformDimensionedVectorField", "dimensions [0 1 -2 0 0 0 0]; value (0 0 -9.81);");
    write_foam_dictionary(
        folder, "constant/couplingProperties", "dictionary",
        fmt::format(
            "medium none;\nrock {{ {}\ncontact {{ youngsModulus {}; maxSpeed 1; wetRestitution false; timeStepFraction 0.15; pairs {{\n"
            "rock_rock {{ friction 0.3; restitution 0.8; rollingFriction 0.01; }}\n"
            "rock_glass {{ friction 0.3; restitution 0.8; rollingFriction 0.01; }} }} }}\n"
            "walls ( {{ name mantle; file \"geometry/mantle.stl\"; material glass; }} {} );\n"
            "domain {{ type box; lower ({} {} {}); upper ({} {} {}); }} }}\ncheckpoint {{ interval 100; keep 1; }}\n{}",
            rock, modulus, walls, -1.1 * k_radius, -1.1 * k_radius, k_below, 1.1 * k_radius, 1.1 * k_radius, k_top, extra));
    write_file(folder / "geometry/mantle.stl", ring({k_radius, 0, 0}, {k_radius, 0, k_top}));
    write_foam_dictionary(folder, "system/controlDict", "dictionary",
                          fmt::format("application cutterFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {}; deltaT 2e-3; "
                                      "writeControl adjustable; writeInterval 100; runTimeModifiable no;",
                                      end));
}

/// Loosely and at random, as many as fill the cylinder.
std::string feed(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-0.08, 0.08), size(0.95, 1.05), speed(-0.1, 0.1);
    const auto count = static_cast<int>(0.6 * k_pi * k_radius * k_radius * k_fill / sphere_volume(k_diameter));
    std::string text = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s\n";
    int id = 0;
    for (int k = 0; id < count; ++k)
        for (int j = -8; j <= 8; ++j)
            for (int i = -8; i <= 8 && id < count; ++i) {
                const Vec3 place = k_diameter * Vec3(1.22 * i + shift(random), 1.22 * j + shift(random), 0.7 + 1.22 * k + shift(random));
                if (place.head<2>().norm() > k_radius - 0.6 * k_diameter) continue;
                text += fmt::format("{},0,{},{},{},{},{},{},{},-0.5\n", ++id, place.x(), place.y(), place.z(), k_diameter * size(random),
                                    k_density, speed(random), speed(random));
            }
    return text;
}

/// Into the folder pour_<number>. \return the bed
fs::path pour(const Verification& verification, int number) {
    const fs::path folder = verification.folder(fmt::format("pour_{}", number));
    write_case(folder, k_modulus, "feed \"constant/rockFeed.csv\";", "{ name plate; file \"geometry/plate.stl\"; material glass; }", 5.0,
               "stop { atRest { energy 1e-6; speed 0.02; } }");
    write_file(folder / "geometry/plate.stl", ring({0, 0, 0}, {k_radius, 0, 0}));
    write_file(folder / "constant/rockFeed.csv", feed(static_cast<unsigned>(3 + number)));
    run_cutter_foam(folder);
    return fs::absolute(newest_checkpoint(folder));
}

/// Of the poured bed above the orifices, 3 diameters from mantle and floor and 5 below the fill, by voxels of a twentieth of a diameter
/// [kg/m3].
double bulk_density(const fs::path& poured) {
    constexpr double voxel = k_diameter / 20.0, low = 3.0 * k_diameter, high = k_fill - 5.0 * k_diameter, reach = k_radius - low;
    const auto is_core = [&](const Vec3& at) { return at.head<2>().norm() < reach && at.z() > low && at.z() < high; };
    const RockSnapshot bed = last_rocks(poured);
    double mass = 0.0;
    for (std::size_t n = 0; n < bed.position.size(); ++n) {
        const double radius = 0.5 * bed.diameter[n];
        const Eigen::Array3i first = ((bed.position[n].array() - radius) / voxel).floor().cast<int>(),
                             last = ((bed.position[n].array() + radius) / voxel).ceil().cast<int>();
        for (int k = first.z(); k < last.z(); ++k)
            for (int j = first.y(); j < last.y(); ++j)
                for (int i = first.x(); i < last.x(); ++i) {
                    const Vec3 at = voxel * Vec3(i + 0.5, j + 0.5, k + 0.5);
                    if ((at - bed.position[n]).norm() < radius && is_core(at)) mass += bed.density[n] * voxel * voxel * voxel;
                }
    }
    return mass / (k_pi * reach * reach * (high - low));
}

struct Line {
    double slope = 0.0;
};

/// Least squares of the mass that has crossed over the times of the crossings, between two of them.
Line line_through(const std::vector<double>& time, const std::vector<double>& mass, std::size_t first, std::size_t last) {
    double n = 0, st = 0, sm = 0, stt = 0, stm = 0;
    for (std::size_t k = first; k < last; ++k) n += 1, st += time[k], sm += mass[k], stt += time[k] * time[k], stm += time[k] * mass[k];
    return {(n * stm - st * sm) / (n * stt - st * st)};
}

struct Discharge {
    double rate = 0.0;          ///< [kg/s]
    double unsteadiness = 0.0;  ///< difference of the two halves over their mean
};

/// An orifice below a bed.
struct Opening {
    int pour = 0;
    double orifice = 0.0, modulus = k_modulus;
};

Discharge discharge(const Verification& verification, const fs::path& bed, const Opening& opening) {
    const double orifice = opening.orifice, modulus = opening.modulus;
    const fs::path folder = verification.folder(fmt::format("orifice_{:g}mm_{:g}_pour_{}", 1e3 * orifice, modulus, opening.pour));
    write_case(
        folder, modulus, fmt::format("start \"{}\";", bed.string()),
        fmt::format("{{ name floor; file \"geometry/floor.stl\"; material glass; }} {{ name lid; file \"geometry/lid.stl\"; material "
                    "glass; removedAt {}; }}",
                    k_open),
        4.0,
        fmt::format("gates ( {{ name outlet; centre (0 0 -0.01); normal (0 0 -1); radius {}; }} );\n"
                    "stop {{ idle {{ gate outlet; duration 0.3; }} }}",
                    k_radius));
    write_file(folder / "geometry/floor.stl", ring({0.5 * orifice, 0, 0}, {k_radius, 0, 0}));
    write_file(folder / "geometry/lid.stl", ring({0, 0, 0}, {0.5 * orifice, 0, 0}));
    run_cutter_foam(folder);
    const auto gates = read_columns(folder / "postProcessing/rock/0/gates.csv");
    std::vector<std::pair<double, double>> rows;
    for (std::size_t k = 0; k < gates.at("time_s").size(); ++k)
        rows.emplace_back(gates.at("time_s")[k], gates.at("mass_kg")[k] * gates.at("direction")[k]);
    std::sort(rows.begin(), rows.end());
    const double filled = read_columns(folder / "postProcessing/rock/0/account.csv").at("placed_kg").front();
    const double until = filled * (1.0 - orifice / k_fill);  // the head is one orifice high
    std::vector<double> time, mass;
    double sum = 0.0;
    for (const auto& [t, m] : rows) {
        sum += m;
        if (t < k_open + k_start || sum > until) continue;
        time.push_back(t);
        mass.push_back(sum);
    }
    const std::size_t n = time.size();
    const double first = line_through(time, mass, 0, n / 2).slope, second = line_through(time, mass, n / 2, n).slope;
    return {line_through(time, mass, 0, n).slope, 2.0 * std::abs(first - second) / (first + second)};
}

/// Every orifice below the first pour; that of the stiffness below all pours, with the whole modulus and with half of it.
std::vector<Opening> openings() {
    std::vector<Opening> all;
    for (const double orifice : k_orifices) all.push_back({0, orifice});
    for (int pour = 0; pour < k_pours; ++pour) {
        if (pour > 0) all.push_back({pour, k_of_stiffness});
        all.push_back({pour, k_of_stiffness, 0.5 * k_modulus});
    }
    return all;
}

/// \param bulk  density of the bed [kg/m3]
void check_law(Verification& verification, const std::vector<Opening>& all, const std::vector<Discharge>& flows, double bulk) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, sc = 0;
    for (std::size_t i = 0; i < std::size(k_orifices); ++i) {
        const double orifice = all[i].orifice, size = orifice - k_beverloo * k_diameter, x = std::log(size), y = std::log(flows[i].rate);
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
        const double constant = flows[i].rate / (bulk * std::sqrt(k_gravity) * std::pow(size, 2.5));
        sc += constant;
        const std::string name = fmt::format("discharge through {:g} mm", 1e3 * orifice);
        verification.report(name, "kg/s", flows[i].rate, 0.58 * flows[i].rate / constant,
                            {"Beverloo1961", "with C = 0.58 and the bed's density as measured", {}});
        verification.at_most(name + ": difference of its halves", "-", flows[i].unsteadiness, 0.05,
                             {"Beverloo1961", "head above one orifice", {}});
    }
    verification.absolute("exponent of the discharge over D - 1.4 d", "-", (n * sxy - sx * sy) / (n * sxx - sx * sx), 2.5, 0.2,
                          {"Beverloo1961", "five orifices, 24 to 40 mm, grains of 4 mm", {}});
    verification.report("solid share of the poured bed", "-", bulk / k_density, 0.6,
                        {"exact", "core, 3 diameters from mantle and floor; the reference was taken for it until 2026-11-28", {}});
    verification.absolute("C of Beverloo's law", "-", sc / n, 0.60, 0.05,
                          {"Beverloo1961", "0.55 to 0.65 for spheres; with the bed's density as measured", {}});
}

/// In pairs of one bed.
void check_stiffness(Verification& verification, const std::vector<Opening>& all, const std::vector<Discharge>& flows) {
    const auto rate = [&](int pour, double modulus) {
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i].pour == pour && all[i].orifice == k_of_stiffness && all[i].modulus == modulus) return flows[i].rate;
        throw std::logic_error("no such opening");
    };
    std::vector<double> changes;
    for (int pour = 0; pour < k_pours; ++pour) changes.push_back(rate(pour, 0.5 * k_modulus) / rate(pour, k_modulus) - 1.0);
    const Sample change = sample_of(changes);
    const std::string note = fmt::format("stiffness must not matter; {} pours", change.count);
    verification.at_most("change of the discharge through 32 mm with half of Young's modulus", "-", std::abs(change.mean), 0.02,
                         {"exact", note, {}});
    verification.at_most("its standard error", "-", standard_error(change), 0.01, {"exact", note, {}});
}

void run(Verification& verification) {
    std::vector<fs::path> beds(k_pours);
    side_by_side(beds.size(), cases::available_cores(), [&](std::size_t i) { beds[i] = pour(verification, static_cast<int>(i)); });
    const std::vector<Opening> all = openings();
    std::vector<Discharge> flows(all.size());
    side_by_side(all.size(), cases::available_cores(),
                 [&](std::size_t i) { flows[i] = discharge(verification, beds[static_cast<std::size_t>(all[i].pour)], all[i]); });
    check_law(verification, all, flows, bulk_density(verification.folder("pour_0")));
    check_stiffness(verification, all, flows);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
