/// Rates of feed and extraction with an account by id, packings that are poured and frozen, and water through a frozen one.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/sphere.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr double k_density = 2650.0;  // [kg/m3]

struct Grain {
    double time = 0.0;  // [s]
    Vec3 place, velocity = Vec3::Zero();
};

std::string text(const Vec3& v) {
    return fmt::format("({} {} {})", v.x(), v.y(), v.z());
}

/// A case without a medium. \param domain  the section's inner text \param extra  further sections
void write_dry_case(const fs::path& folder, const std::vector<Grain>& grains, double diameter, double friction, double end,
                    const std::string& domain, const std::string& extra) {
    write_foam_dictionary(folder, "constant/g", "uniformDimensionedVectorField", "dimensions [0 1 -2 0 0 0 0]; value (0 0 -9.81);");
    write_foam_dictionary(folder, "constant/couplingProperties", "dictionary",
                          fmt::format("medium none;\nrock {{ feed \"constant/rockFeed.csv\";\n"
                                      "contact {{ youngsModulus 5e6; maxSpeed 1; wetRestitution false; timeStepFraction 0.15; pairs {{\n"
                                      "rock_rock {{ friction {0}; restitution 0.5; rollingFriction 0; }}\n"
                                      "rock_glass {{ friction {0}; restitution 0.5; rollingFriction 0; }} }} }}\n"
                                      "domain {{ {1} material glass; }} }}\ncheckpoint {{ interval 100; keep 1; }}\n{2}",
                                      friction, domain, extra));
    std::string feed = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s\n";
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const Grain& g = grains[k];
        feed += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", k + 1, g.time, g.place.x(), g.place.y(), g.place.z(), diameter, k_density,
                            g.velocity.x(), g.velocity.y(), g.velocity.z());
    }
    write_file(folder / "constant/rockFeed.csv", feed);
    write_foam_dictionary(folder, "system/controlDict", "dictionary",
                          fmt::format("application cutterFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {}; deltaT 2e-3; "
                                      "writeControl adjustable; writeInterval 100; runTimeModifiable no;",
                                      end));
    run_cutter_foam(folder);
}

/// Grains by id, and their mass.
struct CountedGrains {
    std::vector<int> id;
    double mass = 0.0;  ///< [kg]

    /// The mass is written out: that of the program is held against it.
    void add(int grain, double diameter, double density) {
        id.push_back(grain);
        mass += k_pi / 6.0 * diameter * diameter * diameter * density;
    }
};

/// What the feed's file orders.
CountedGrains ordered(const fs::path& folder) {
    const auto rows = read_columns(folder / "constant/rockFeed.csv");
    CountedGrains grains;
    for (std::size_t k = 0; k < rows.at("id").size(); ++k)
        grains.add(static_cast<int>(rows.at("id")[k]), rows.at("diameter_m")[k], rows.at("density_kg_m3")[k]);
    return grains;
}

/// What the last picture of the DEM shows.
CountedGrains pictured(const fs::path& folder) {
    const RockSnapshot picture = last_rocks(folder);
    CountedGrains grains;
    for (std::size_t k = 0; k < picture.id.size(); ++k) grains.add(picture.id[k], picture.diameter[k], picture.density[k]);
    return grains;
}

/// What passed a surface, by the events.
CountedGrains passed(const fs::path& folder, const std::string& surface) {
    const fs::path file = folder / "postProcessing/rock/0/events.csv";
    const auto numbers = read_columns(file);
    std::istringstream rows(read_file(file));
    std::string row;
    std::getline(rows, row);
    CountedGrains grains;
    for (std::size_t k = 0; std::getline(rows, row); ++k)
        if (row.find("," + surface + ",") != std::string::npos)
            grains.add(static_cast<int>(numbers.at("id")[k]), numbers.at("diameter_m")[k], numbers.at("density_kg_m3")[k]);
    return grains;
}

/// How many ids are not as often in one list as in the others.
std::ptrdiff_t unmatched(const std::vector<int>& in, const std::vector<std::vector<int>>& out) {
    std::map<int, int> balance;
    for (const int id : in) ++balance[id];
    for (const std::vector<int>& ids : out)
        for (const int id : ids) --balance[id];
    return std::count_if(balance.begin(), balance.end(), [](const auto& entry) { return entry.second != 0; });
}

/// By id and by mass, from the feed's file, the events and the last picture of the DEM: none of them is written by the account's code.
void check_account(Verification& verification, const fs::path& folder, double rate) {
    const CountedGrains fed = ordered(folder), came = passed(folder, "feed"), present = pictured(folder), taken = passed(folder, "extract"),
                        left = passed(folder, "domain");
    const std::ptrdiff_t wrong = unmatched(fed.id, {came.id}) + unmatched(fed.id, {present.id, taken.id, left.id});
    verification.at_most(fmt::format("grains that are lost, doubled or of nobody at {:g} kg/s", rate), "-", static_cast<double>(wrong), 0.0,
                         {"exact", "by id: in the feed's file, came in, in the last picture, taken out, left", {}});
    const double digits = 1e-11 * (1.0 + rate);
    verification.at_most(
        fmt::format("mass that is neither in the last picture nor gone at {:g} kg/s", rate), "kg",
        std::abs(fed.mass - present.mass - taken.mass - left.mass), digits,
        {"exact", "of what the feed's file orders; its sizes and density are exact in the 9 digits of pictures and events", {}});
    const auto account = read_columns(folder / "postProcessing/rock/0/account.csv");
    const auto apart = [&](const char* column, double mass) { return std::abs(account.at(column).back() - mass); };
    verification.at_most(
        fmt::format("mass that the account does not hold at {:g} kg/s", rate), "kg",
        largest({apart("placed_kg", fed.mass), apart("in_run_kg", present.mass), apart("extracted_kg", taken.mass),
                 apart("left_domain_kg", left.mass), apart("removed_kg", 0.0), apart("decided_kg", 0.0)}),
        digits, {"exact", "its columns at the end against the feed's file, the last picture and the events; 12 digits are written", {}});
}

void check_rate(Verification& verification, double rate, double diameter) {
    const double mass = sphere_mass(diameter, k_density), side = 12.0 * diameter;
    const int per_layer = 25, in_bed = static_cast<int>(1.3 * rate / mass) + per_layer, fed = static_cast<int>(std::floor(rate / mass));
    const auto place = [&](int k, double base) {
        return Vec3(diameter * (2.0 * (k % 5) - 4.0), diameter * (2.0 * (k / 5 % 5) - 4.0), base + 1.1 * diameter * (k / per_layer));
    };
    std::vector<Grain> grains;
    for (int k = 0; k < in_bed; ++k) grains.push_back({0.0, place(k, 0.6 * diameter)});
    const double top = grains.back().place.z() + 6.0 * diameter;
    for (int k = 0; k < fed; ++k) grains.push_back({(k + 1) * mass / rate, place(k % per_layer, top), Vec3(0, 0, -1.0)});

    const fs::path folder = verification.folder(fmt::format("rate_{:g}", rate));
    const std::string domain = fmt::format("type box; lower {}; upper {}; walls (xMin xMax yMin yMax zMin);",
                                           text(Vec3(-0.5 * side, -0.5 * side, 0.0)), text(Vec3(0.5 * side, 0.5 * side, top + side)));
    const std::string extract =
        fmt::format("events ( {{ do extract; from 0; to 1; rate {}; region {{ type box; lower {}; upper {}; }} }} );", rate,
                    text(Vec3(-side, -side, 0.0)), text(Vec3(side, side, 8.0 * diameter)));
    write_dry_case(folder, grains, diameter, 0.3, 1.01, domain, extract);

    const auto account = read_columns(folder / "postProcessing/rock/0/account.csv");
    const std::string set_up = fmt::format("grains of {:g} mm, {} in the bed", 1e3 * diameter, in_bed);
    const double placed = account.at("placed_kg").back() - in_bed * mass, out = account.at("extracted_kg").back();
    verification.relative(fmt::format("mass fed in 1 s at {:g} kg/s", rate), "kg", placed, rate, 0.01, {"exact", set_up, {}});
    verification.relative(fmt::format("mass extracted in 1 s at {:g} kg/s", rate), "kg", out, rate, 0.01, {"exact", set_up, {}});

    check_account(verification, folder, rate);
}

constexpr double k_diameter = 0.002;
constexpr double k_box_height = 60.0;  // [diameters]
constexpr double k_pour_end = 3.0;     // [s], by which it must rest

/// A poured bed and the block that is cut out of it, in diameters.
struct Bed {
    double half_box, half_block, block_low, block_high;
    int grains_across, layers;  ///< of the loose lattice it begins as
};
constexpr Bed k_small_bed{7.0, 5.0, 4.0, 15.0, 11, 35};
// Rock is laid on cells with sigma = 1.5 diameters, and finds its void fraction over no more: both together reach at most 3 sqrt(2) sigma.
constexpr double k_felt = 6.4;
constexpr Bed k_wide_bed{10.0, 9.0, 4.0, 20.0, 16, 40};

std::string bed_domain(const Bed& bed) {
    const double d = k_diameter;
    return fmt::format("type box; lower {}; upper {}; walls (xMin xMax yMin yMax zMin);", text(d * Vec3(-bed.half_box, -bed.half_box, 0.0)),
                       text(d * Vec3(bed.half_box, bed.half_box, k_box_height)));
}

/// Solid share 0.3: a lattice of 1.2 diameters whose places are shifted at random.
std::vector<Grain> loose_grains(const Bed& bed) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.099, 0.099), speed(-0.1, 0.1);
    std::vector<Grain> grains;
    const double middle = 0.5 * (bed.grains_across - 1);
    for (int k = 0; k < bed.layers; ++k)
        for (int j = 0; j < bed.grains_across; ++j)
            for (int i = 0; i < bed.grains_across; ++i) {
                const Vec3 place(1.2 * (i - middle), 1.2 * (j - middle), 0.7 + 1.2 * k);
                grains.push_back({0.0, k_diameter * (place + Vec3(shift(random), shift(random), shift(random))),
                                  Vec3(speed(random), speed(random), -0.3)});
            }
    return grains;
}

/// Share of the space within bounds [diameters] that spheres fill, by voxels of a twentieth of a diameter.
double solid_share(const std::vector<Vec3>& centres, const Vec3& low, const Vec3& high) {
    constexpr int per_diameter = 20;
    const Eigen::Array3i n = ((high - low) * per_diameter).array().round().cast<int>();
    std::vector<bool> solid(static_cast<std::size_t>(n.x()) * n.y() * n.z(), false);
    for (const Vec3& centre : centres) {
        const Vec3 c = (centre / k_diameter - low) * per_diameter;  // in voxels
        const double r = 0.5 * per_diameter;
        Eigen::Array3i first = (c.array() - r).floor().cast<int>().max(0), last = (c.array() + r).ceil().cast<int>().min(n);
        for (int k = first.z(); k < last.z(); ++k)
            for (int j = first.y(); j < last.y(); ++j)
                for (int i = first.x(); i < last.x(); ++i)
                    if ((Vec3(i + 0.5, j + 0.5, k + 0.5) - c).norm() < r)
                        solid[(static_cast<std::size_t>(k) * n.y() + j) * n.x() + i] = true;
    }
    return static_cast<double>(std::count(solid.begin(), solid.end(), true)) / static_cast<double>(solid.size());
}

/// Pours, and cuts a frozen block out of what rests. \return the checkpoint
fs::path pour(Verification& verification, const Bed& bed, double friction) {
    const fs::path poured = verification.folder(fmt::format("pour_{:g}", friction));
    write_dry_case(poured, loose_grains(bed), k_diameter, friction, k_pour_end, bed_domain(bed),
                   "stop { atRest { energy 1e-6; speed 0.01; hold 0.02; } }");
    const auto account = read_columns(poured / "postProcessing/rock/0/account.csv");
    const double rest = account.at("time_s").back();
    verification.at_most(
        fmt::format("time until the bed rests, friction {:g}", friction), "s", rest, k_pour_end - 0.01,
        {"exact", fmt::format("{} grains; energy 1e-6 m g d, speed 0.01 sqrt(g d)", account.at("placed_count").back()), {}});

    const fs::path cut = verification.folder(fmt::format("block_{:g}", friction));
    const double d = k_diameter;
    std::string events = "events ( { do freeze; at 0; region { type everything; } }";
    const auto remove = [&](const Vec3& point, const Vec3& normal) {
        events += fmt::format(" {{ do remove; at 0.002; region {{ type halfSpace; point {}; normal {}; }} }}", text(point), text(normal));
    };
    for (const int axis : {0, 1})
        for (const double sign : {-1.0, 1.0}) remove(sign * d * bed.half_block * Vec3::Unit(axis), sign * Vec3::Unit(axis));
    remove(Vec3(0, 0, d * bed.block_low), -Vec3::UnitZ());
    remove(Vec3(0, 0, d * bed.block_high), Vec3::UnitZ());
    const std::string contact = fmt::format(
        "contact {{ youngsModulus 5e6; maxSpeed 1; wetRestitution false; pairs {{ rock_rock {{ friction {0}; restitution 0.5; "
        "rollingFriction 0; }} rock_glass {{ friction {0}; restitution 0.5; rollingFriction 0; }} }} }}",
        friction);
    write_foam_dictionary(cut, "constant/g", "uniformDimensionedVectorField", "dimensions [0 1 -2 0 0 0 0]; value (0 0 -9.81);");
    write_foam_dictionary(cut, "constant/couplingProperties", "dictionary",
                          fmt::format("medium none;\nrock {{ start \"{}\"; {} domain {{ {} material glass; }} }}\n{} );\n"
                                      "checkpoint {{ interval 100; keep 1; }}",
                                      fs::absolute(newest_checkpoint(poured)).string(), contact, bed_domain(bed), events));
    write_foam_dictionary(cut, "system/controlDict", "dictionary",
                          "application cutterFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 0.006; deltaT 2e-3; "
                          "writeControl adjustable; writeInterval 0.002; runTimeModifiable no;");
    run_cutter_foam(cut);
    const std::vector<RockSnapshot> pictures = all_rocks(cut);
    const Vec3 low(3.0 - bed.half_box, 3.0 - bed.half_box, 4.0), high(bed.half_box - 3.0, bed.half_box - 3.0, 14.0);
    const double share = solid_share(pictures.front().position, low, high);
    verification.absolute(fmt::format("solid share of the poured bed, friction {:g}", friction), "-", share, 0.62, 0.02,
                          {"exact",
                           "estimate without a source in references.bib: random packings of spheres, loose to dense, 0.60 to 0.64; core, 3 "
                           "diameters from the walls",
                           {}});
    return newest_checkpoint(cut);
}

/// Means over the block's core.
struct Core {
    double void_fraction = 0.0, superficial = 0.0, gradient = 0.0;
};

/// \param low, high  of the core [m]
Core core_of(const BoxCase& box, const fs::path& fields, const Vec3& low, const Vec3& high) {
    const auto alpha = read_scalar_field(fields / "voidFraction", box.cell_count()), p = read_scalar_field(fields / "p", box.cell_count());
    const auto u = read_vector_field(fields / "U", box.cell_count());
    const double dx = (box.upper.z() - box.lower.z()) / box.cells[2];
    Core core;
    double n = 0.0, sz = 0.0, sp = 0.0, szz = 0.0, szp = 0.0;
    std::size_t cell = 0;
    for (int k = 0; k < box.cells[2]; ++k)
        for (int j = 0; j < box.cells[1]; ++j)
            for (int i = 0; i < box.cells[0]; ++i, ++cell) {
                const Vec3 centre = box.lower + dx * (Vec3(i, j, k) + Vec3::Constant(0.5));
                if ((centre.array() < low.array()).any() || (centre.array() > high.array()).any()) continue;
                const double z = centre.z();
                core.void_fraction += alpha[cell];
                core.superficial += alpha[cell] * u[cell].z();
                n += 1.0, sz += z, sp += p[cell], szz += z * z, szp += z * p[cell];
            }
    core.void_fraction /= n;
    core.superficial /= n;
    core.gradient = (n * szp - sz * sp) / (n * szz - sz * sz);
    return core;
}

void flow_through(Verification& verification, const Bed& bed, const fs::path& block, double inflow) {
    const double d = k_diameter;
    BoxCase box;
    box.lower = d * Vec3(-bed.half_block, -bed.half_block, bed.block_low - 6.0);
    box.upper = d * Vec3(bed.half_block, bed.half_block, bed.block_high + 6.0);
    for (int axis = 0; axis < 3; ++axis) box.cells[axis] = static_cast<int>(std::lround((box.upper - box.lower)[axis] / d));
    box.sides = BoxSides::duct;
    box.inflow = inflow;
    box.time_step = 2e-3;
    box.end_time = 0.2;
    box.write_interval = 0.1;
    const fs::path folder = verification.folder(fmt::format("water_{:g}", inflow));
    write_box_case(folder, box);
    write_foam_dictionary(
        folder, "constant/couplingProperties", "dictionary",
        fmt::format("rock {{ start \"{}\"; contact {{ youngsModulus 5e6; maxSpeed 1; pairs {{ rock_rock {{ friction 0.6; restitution 0.5; "
                    "rollingFriction 0; }} rock_glass {{ friction 0.6; restitution 0.5; rollingFriction 0; }} }} }}\n"
                    "domain {{ {} material glass; }} }}\nclosures {{ drag gidaspow; hindrance none; addedMass 0.5; }}\n"
                    "kernel {{ gamma 1; minWidthInCells 1.5; maxSolidFraction 0.9; }}\n",
                    fs::absolute(block).string(), bed_domain(bed)));
    run_cutter_foam(folder);
    const double half = bed.half_block - k_felt;
    const Core core = core_of(box, folder / fmt::format("{:g}", box.end_time), d * Vec3(-half, -half, bed.block_low + k_felt),
                              d * Vec3(half, half, bed.block_high - k_felt));
    const double a = core.void_fraction, s = 1.0 - a, u = core.superficial;
    const double ergun = box.density * (150.0 * box.viscosity * s * s / (a * a * a * d * d) * u + 1.75 * s / (a * a * a * d) * u * u);
    const std::string seen = fmt::format("core: void fraction {:.4f}, superficial velocity {:.5f} m/s", a, u);
    verification.relative(fmt::format("pressure gradient through the frozen bed at {:g} m/s", inflow), "Pa/m", -core.gradient * box.density,
                          ergun, 0.03, {"Ergun1952", seen, {}});
    verification.absolute(fmt::format("void fraction of the frozen bed at {:g} m/s", inflow), "-", a, 0.40, 0.03, {"exact", seen, {}});
    const std::vector<RockSnapshot> pictures = all_rocks(folder);
    double moved = 0.0;
    for (std::size_t k = 0; k < pictures.back().position.size(); ++k)
        moved = largest({moved, (pictures.back().position[k] - pictures.front().position[k]).norm(), pictures.back().velocity[k].norm()});
    verification.at_most(fmt::format("way and speed of {} frozen grains at {:g} m/s", pictures.back().position.size(), inflow), "m, m/s",
                         moved, 0.0, {"exact", "2650 kg/m3, 0.1 s apart", {}});
}

void run(Verification& verification) {
    check_rate(verification, 0.01, 0.003);
    check_rate(verification, 0.1, 0.006);
    check_rate(verification, 1.0, 0.012);
    pour(verification, k_small_bed, 0.1);
    const fs::path block = pour(verification, k_wide_bed, 0.6);
    flow_through(verification, k_wide_bed, block, 0.01);
    flow_through(verification, k_wide_bed, block, 0.1);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
