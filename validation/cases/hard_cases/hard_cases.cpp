/// \file The stability matrix: what coupled solvers are known to break at, each
/// in the smallest room that has the difficulty in it.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/testing/ramp_rotor_mesh.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/axis_frame.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/momentum_carried.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/rotor_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr double k_gravity = 9.81;
constexpr double k_volume_limit = 1e-12, k_momentum_limit = 1e-5,
                 k_flow_limit = 1e-6;    // of balance.csv
constexpr double k_rotor_cell = 0.0167;  // [m], the smallest cell of the rotor's mesh
constexpr double k_rotor_rock = 0.02;    // [m]

/// One run and the bounds that it must keep.
struct Cell {
    std::string row, column;
    std::function<void(const fs::path& folder)> prepare;
    double fastest_rock = 0.0;   ///< [m/s]
    double fastest_fluid = 0.0;  ///< [m/s], sum of the components
    double cell_size = 0.0;      ///< [m], smallest
    double overlap = 0.1;        ///< of the radius
    int ranks = 1;
};

struct Outcome {
    std::string ended;  ///< empty: it came to its end
    double core_s = 0.0;
    double rock_speed = 0.0, fluid_speed = 0.0, solid_fraction = 0.0, overlap = 0.0;
    double volume_error = 0.0, momentum_error = 0.0, flow_error = 0.0;
    double carried = 0.0;  ///< median of momentum_carried
    double courant = 0.0;

    double largest_balance_error() const { return largest({volume_error, momentum_error, flow_error}); }
    bool conserves() const {
        return volume_error <= k_volume_limit && momentum_error <= k_momentum_limit && carried <= k_most_carried &&
               flow_error <= k_flow_limit;
    }
    bool is_bounded(const Cell& cell) const {
        return rock_speed <= cell.fastest_rock && fluid_speed <= cell.fastest_fluid && solid_fraction <= 0.7 && overlap <= cell.overlap;
    }
    bool holds(const Cell& cell) const { return ended.empty() && conserves() && is_bounded(cell); }
};

/// Results of balance.csv and the snapshots of rock.
void read_records(const fs::path& folder, double cell_size, Outcome& outcome) {
    const auto balance = read_columns(folder / "postProcessing/balance/0/balance.csv");
    const std::vector<double>& time = balance.at("time_s");
    const std::vector<double>& courant = balance.at("courant_max");
    const std::vector<double>& rocks = balance.at("rocks");
    outcome.solid_fraction = largest(balance.at("solid_fraction_max"));
    outcome.overlap = largest(balance.at("overlap_ratio_max"));
    outcome.volume_error = largest(balance.at("solid_volume_error"));
    outcome.momentum_error = largest(balance.at("momentum_error"));
    outcome.carried = median_carried(balance);
    outcome.courant = largest(courant);
    for (std::size_t i = 1; i < time.size(); ++i) {
        // A row has the Courant number of the step before it.
        const double step = time[i - 1] - (i > 1 ? time[i - 2] : 0.0);
        outcome.fluid_speed = larger(outcome.fluid_speed, courant[i] * cell_size / step);
        if (rocks[i] == rocks[i - 1]) outcome.flow_error = larger(outcome.flow_error, balance.at("flow_balance_error")[i]);
    }
    if (!fs::exists(folder / "postProcessing/rock/vtk")) return;
    for (const RockSnapshot& picture : all_rocks(folder))
        for (const Vec3& velocity : picture.velocity) outcome.rock_speed = larger(outcome.rock_speed, velocity.norm());
}

Outcome run_cell(const Cell& cell, const fs::path& folder) {
    cell.prepare(folder);
    const ChildCommand command = meshing::foam_command(folder, cutter_foam(), {}, cell.ranks);
    const ChildResult result = run_child(command);
    Outcome outcome;
    outcome.core_s = result.core_s;
    if (result.exit_code != 0) {
        outcome.ended = failure_of(command, result).text();
        return outcome;
    }
    read_records(folder, cell.cell_size, outcome);
    return outcome;
}

// --- Rooms ---

void write_surface(const fs::path& file, const std::vector<std::array<Vec3, 4>>& faces) {
    fs::create_directories(file.parent_path());
    std::ofstream stream(file);
    stream << "solid surface\n";
    for (const auto& f : faces)
        for (const std::array<int, 3>& corners : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
            stream << "facet normal 0 0 0\nouter loop\n";
            for (const int c : corners) stream << fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", f[c].x(), f[c].y(), f[c].z());
            stream << "endloop\nendfacet\n";
        }
    stream << "endsolid surface\n";
    if (!stream) throw std::runtime_error("cannot write " + file.string());
}

constexpr const char* k_sides = "{ name sides; file \"constant/sides.stl\"; rotating false; }";

/// The four upright sides of the box as walls of the DEM, facing inwards.
void write_sides(const fs::path& folder, const BoxCase& box) {
    const Vec3 &a = box.lower, &b = box.upper;
    const std::array<Vec3, 4> corner = {Vec3(a.x(), a.y(), 0), Vec3(b.x(), a.y(), 0), Vec3(b.x(), b.y(), 0), Vec3(a.x(), b.y(), 0)};
    std::vector<std::array<Vec3, 4>> faces;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 &p = corner[i], &q = corner[(i + 1) % 4], low(0, 0, a.z()), high(0, 0, b.z());
        faces.push_back({p + low, p + high, q + high, q + low});
    }
    write_surface(folder / "constant/sides.stl", faces);
}

/// A box about the z axis, its floor at z = 0, of cells of about this size.
BoxCase box_of(double width, double height, double cell_size) {
    BoxCase box;
    const int across = static_cast<int>(std::lround(width / cell_size));
    const int along = static_cast<int>(std::lround(height / cell_size));
    box.lower = Vec3(-0.5 * width, -0.5 * width, 0.0);
    box.upper = Vec3(0.5 * width, 0.5 * width, along * width / across);
    box.cells = {across, across, along};
    return box;
}

/// Speed [m/s] after falling this far without drag, the fluid's inertia
/// included.
double frictionless_speed(double density_ratio, double height) {
    return std::sqrt(2.0 * (density_ratio - 1.0) / (density_ratio + 0.5) * k_gravity * height);
}

Cell box_cell(const std::string& row, const std::string& column, const BoxCase& box, double fastest) {
    return {row, column, [box](const fs::path& folder) { write_box_case(folder, box); }, fastest, 3.0 * fastest, box.cell_size()};
}

std::string feed_text(const std::vector<BoxRock>& rocks) {
    std::string text = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s\n";
    for (const BoxRock& rock : rocks)
        text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", rock.id, rock.time, rock.position.x(), rock.position.y(), rock.position.z(),
                            rock.diameter, rock.density, rock.velocity.x(), rock.velocity.y(), rock.velocity.z());
    return text;
}

cases::CaseInputs rotor_inputs(double end_time) {
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    inputs.times.end = end_time;
    inputs.checkpoint.interval = end_time;
    inputs.times.write_interval = end_time / 8.0;
    inputs.rock.emplace();
    coupling::use_preset(inputs.rock->contact, coupling::k_paper_pairs);
    return inputs;
}

/// Fastest rock [m/s] that set off with a speed of its own: struck by steel at
/// the tip, without loss, and fallen to the floor.
double fastest_at_rotor(double own) {
    const double tip = cases::test::tiny_inputs().rotor.speed * cases::test::k_tiny_rotor_radius;
    return own + 2.0 * tip + frictionless_speed(2.65, 0.2);
}

Vec3 around(double radius, double azimuth_deg, double z) {
    const double azimuth = azimuth_deg * k_pi / 180.0;
    return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

/// Rock in the gap ahead of a lump of steel and in its lee.
std::vector<BoxRock> rock_between_blades() {
    std::vector<BoxRock> rocks;
    for (int i = 0; i < 20; ++i)
        rocks.push_back({i + 1, 0.0, around(0.1275, 66.0 + 26.0 * (i % 4), -0.2 + 0.045 * (i / 4)), k_rotor_rock, 2650, Vec3::Zero()});
    return rocks;
}

Cell rotor_cell(const std::string& row, const std::string& column, const cases::CaseInputs& inputs, const std::vector<BoxRock>& rocks,
                double fastest) {
    return {row,     column,        [inputs, rocks](const fs::path& folder) {
            write_rotor_case(folder, inputs, feed_text(rocks)); },
            fastest, 3.0 * fastest, k_rotor_cell};
}

// --- Rows of the matrix ---

std::vector<Cell> rock_to_cell() {
    std::vector<Cell> cells;
    for (const double ratio : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0}) {
        const double diameter = 0.010, dx = diameter / ratio;
        // Rock of 2 to 10 cells gets no more water than its kernel needs.
        BoxCase box = box_of(std::max(0.024, 8.0 * dx), std::max(0.040, 8.0 * dx), dx);
        box.rocks = {{1, 0.0, Vec3(0.0007, -0.0011, 2.0 * diameter), diameter, 2650, Vec3(0, 0, -0.5)}};
        box.time_step = std::min(1e-3, 0.25 * dx / 0.6);
        box.end_time = 0.06;
        box.write_interval = 0.01;
        cells.push_back(box_cell("rock over cell, d/dx", fmt::format("{}", ratio), box, 0.5 + frictionless_speed(2.65, 2.0 * diameter)));
    }
    return cells;
}

std::vector<Cell> density_ratio() {
    std::vector<Cell> cells;
    for (const double ratio : {1.05, 2.0, 5.0, 8.0}) {
        BoxCase box = box_of(0.06, 0.10, 0.005);
        box.rocks = {{1, 0.0, Vec3(0.0007, -0.0011, 0.05), 0.010, ratio * box.density, Vec3::Zero()}};
        box.time_step = 1e-3;
        box.end_time = 0.3;
        box.write_interval = 0.02;
        cells.push_back(box_cell("rock density over water's", fmt::format("{}", ratio), box, frictionless_speed(ratio, 0.045)));
    }
    return cells;
}

/// Hexagonally packed layers with a little room, which fall together.
std::vector<BoxRock> packed_layers(const BoxCase& box, double diameter, double height) {
    std::vector<BoxRock> rocks;
    const double a = 1.02 * diameter, layer = a * std::sqrt(2.0 / 3.0), line = a * std::sqrt(0.75);
    const double margin = 0.51 * diameter;
    for (int k = 0; margin + k * layer < height; ++k)
        for (int j = 0; box.lower.y() + margin + (j + (k % 2) / 3.0) * line <= box.upper.y() - margin; ++j)
            for (int i = 0;; ++i) {
                const double x = box.lower.x() + margin + (i + 0.5 * ((j + k) % 2)) * a;
                if (x > box.upper.x() - margin) break;
                rocks.push_back({static_cast<int>(rocks.size()) + 1, 0.0,
                                 Vec3(x, box.lower.y() + margin + (j + (k % 2) / 3.0) * line, margin + k * layer), diameter, 2650,
                                 Vec3::Zero()});
            }
    return rocks;
}

std::vector<Cell> dense_pile() {
    std::vector<Cell> cells;
    for (const double ratio : {0.5, 1.0, 2.0}) {
        BoxCase box = box_of(0.08, 0.12, 0.010 / ratio);
        box.rocks = packed_layers(box, 0.010, 0.07);
        box.walls = k_sides;
        box.time_step = 1e-3;
        box.end_time = 0.2;
        box.write_interval = 0.02;
        Cell cell = box_cell("dense pile on a plate, d/dx", fmt::format("{}", ratio), box, frictionless_speed(2.65, 0.07));
        cell.prepare = [box](const fs::path& folder) {
            write_box_case(folder, box);
            write_sides(folder, box);
        };
        cells.push_back(cell);
    }
    return cells;
}

constexpr double k_squeezed_modulus = 1e8;  // [Pa]

/// Overlap over the radius at each of the two contacts of a rock in a gap of a
/// share of its diameter.
double overlap_in_gap(double share) {
    return 1.0 - share;
}

/// Speed [m/s] of a rock that leaves such a gap with the energy of its contacts
/// [Hertz], and twice the tip's.
double fastest_squeezed(double diameter, double density, double share) {
    const double radius = 0.5 * diameter, overlap = overlap_in_gap(share) * radius;
    const double reduced_modulus = k_squeezed_modulus / (2.0 * (1.0 - 0.27 * 0.27));
    const double energy = 2.0 * 8.0 / 15.0 * reduced_modulus * std::sqrt(radius) * std::pow(overlap, 2.5);
    const double mass = k_pi / 6.0 * std::pow(diameter, 3) * (density + 0.5 * 998.2);
    const double tip = cases::test::tiny_inputs().rotor.speed * cases::test::k_tiny_rotor_radius;
    return std::sqrt(2.0 * energy / mass) + 2.0 * tip;
}

/// A ramp on the rotor under the backplate: the gap narrows from 1.5 to 0.9
/// rock diameters over 60 degrees. It is a wall of the DEM alone.
std::vector<Cell> squeezed_rock() {
    constexpr double share = 0.9, start_deg = 60.0, span_deg = 60.0;
    constexpr int pieces = 24;
    std::vector<std::array<Vec3, 4>> ramp;
    const auto height = [&](int i) { return cases::test::k_tiny_z_max - k_rotor_rock * (share + 0.6 * i / pieces); };
    const auto angle = [&](int i) { return start_deg + span_deg * i / pieces; };
    for (int i = 0; i < pieces; ++i)
        ramp.push_back({around(0.105, angle(i), height(i)), around(0.145, angle(i), height(i)), around(0.145, angle(i + 1), height(i + 1)),
                        around(0.105, angle(i + 1), height(i + 1))});
    cases::CaseInputs inputs = rotor_inputs(0.4);
    inputs.rock->walls.push_back({"ramp", "constant/ramp.stl", true});
    inputs.rock->contact.youngs_modulus = k_squeezed_modulus;
    inputs.rock->contact.max_speed = 6.0;
    // Light, so that it stays under the backplate; ahead of the ramp.
    const double density = 1050.0;
    const std::vector<BoxRock> rocks = {
        {1, 0.0, around(0.125, 110.0, cases::test::k_tiny_z_max - 0.55 * k_rotor_rock), k_rotor_rock, density, Vec3::Zero()}};

    Cell cell = rotor_cell(
        "rock squeezed between a turning wall of the DEM and "
        "the backplate, cells of a rock's size",
        fmt::format("gap {} d", share), inputs, rocks, fastest_squeezed(k_rotor_rock, density, share));
    cell.prepare = [inputs, rocks, ramp](const fs::path& folder) {
        write_rotor_case(folder, inputs, feed_text(rocks));
        write_surface(folder / "constant/ramp.stl", ramp);
    };
    cell.overlap = 1.5 * overlap_in_gap(share);
    return {cell};
}

std::vector<Cell> interface_crossing(const std::string& row, int count) {
    std::vector<Cell> cells;
    for (const double speed : {0.1, 0.5, 1.0, 2.0, 4.0}) {
        cases::CaseInputs inputs = rotor_inputs(std::max(0.1, std::min(0.8, 0.08 / speed)));
        inputs.times.first_time_step = std::min(1e-3, 1e-3 / speed);
        std::vector<BoxRock> rocks;
        for (int i = 0; i < count; ++i) {
            const double azimuth = 360.0 * (i / 2) / std::max(1, count / 2) + 3.0;
            rocks.push_back({i + 1, 0.0, around(0.178, azimuth, -0.1 - 0.06 * (i % 2)), k_rotor_rock, 2650, around(speed, azimuth, 0.0)});
        }
        cells.push_back(rotor_cell(row, fmt::format("{}", speed), inputs, rocks, fastest_at_rotor(speed)));
    }
    return cells;
}

std::vector<Cell> courant_number() {
    // Courant numbers of about 0.5, 1, 2 and 5 once the water turns.
    std::vector<Cell> cells;
    for (const double step : {0.008, 0.016, 0.032, 0.08}) {
        cases::CaseInputs inputs = rotor_inputs(0.5);
        Cell cell =
            rotor_cell("fixed step with 20 rocks, ms", fmt::format("{}", 1e3 * step), inputs, rock_between_blades(), fastest_at_rotor(0.0));
        cell.prepare = [prepare = cell.prepare, step](const fs::path& folder) {
            prepare(folder);
            run_in_case(folder, {"foamDictionary", "-entry", "adjustTimeStep", "-set", "no", "system/controlDict"});
            run_in_case(folder, {"foamDictionary", "-entry", "deltaT", "-set", fmt::format("{}", step), "system/controlDict"});
        };
        cells.push_back(cell);
    }
    return cells;
}

std::vector<Cell> impulsive_start() {
    return {rotor_cell("start from rest", "20 rocks at full speed of the rotor", rotor_inputs(0.5), rock_between_blades(),
                       fastest_at_rotor(0.0))};
}

std::vector<Cell> no_rock() {
    cases::CaseInputs inputs = rotor_inputs(0.3);
    inputs.rock.reset();
    return {rotor_cell("no rock", "flow alone", inputs, {}, fastest_at_rotor(0.0))};
}

std::vector<Cell> batch() {
    BoxCase box = box_of(0.25, 0.24, 0.02);
    for (int i = 0; i < 368; ++i) {
        const Vec3 position = Vec3(i % 8 - 3.5, (i / 8) % 8 - 3.5, i / 64 + 0.5) * 0.03;
        box.rocks.push_back({i + 1, 0.02, position, 0.02, 2650, Vec3::Zero()});
    }
    box.walls = k_sides;
    box.time_step = 2e-3;
    box.end_time = 0.3;
    box.write_interval = 0.03;
    Cell cell = box_cell("368 rocks in one step", "20 mm, 30 mm apart", box, frictionless_speed(2.65, 0.18));
    cell.prepare = [box](const fs::path& folder) {
        write_box_case(folder, box);
        write_sides(folder, box);
    };
    return {cell};
}

BoxCase small_box() {
    BoxCase box = box_of(0.06, 0.10, 0.005);
    box.time_step = 1e-3;
    box.end_time = 0.1;
    box.write_interval = 0.01;
    return box;
}

// --- Rows that check more than stability ---

/// Runs the cells of a row, adds them to the table and holds the number of
/// those that hold against their number.
class Matrix {
public:
    explicit Matrix(Verification& verification) : verification_(verification) {}

    void run(const Cell& cell) {
        const Outcome outcome = run_cell(cell, folder_of(cell));
        const bool holds = outcome.holds(cell);
        rows_.push_back({cell.row, cell.column,
                         holds                   ? "stable"
                         : outcome.ended.empty() ? "out of bounds"
                                                 : "ended",
                         fmt::format("{:.1e}", outcome.largest_balance_error()), fmt::format("{:.1e}", outcome.carried),
                         fmt::format("{:.2f} of {:.2f}", outcome.rock_speed, cell.fastest_rock),
                         fmt::format("{:.3f}", outcome.solid_fraction), fmt::format("{:.3f} of {:.3f}", outcome.overlap, cell.overlap),
                         fmt::format("{:.2f}", outcome.courant), fmt::format("{:.1f}", outcome.core_s)});
        fmt::print("{}\n", fmt::join(rows_.back(), " | "));
        std::fflush(stdout);
        ++count_[cell.row];
        if (holds) ++held_[cell.row];
        if (!holds) said_[cell.row] += fmt::format("{}: {} ", cell.column, outcome.ended.empty() ? rows_.back()[2] : outcome.ended);
        verification_.table({"Stability matrix", k_header, rows_});
    }
    /// \return whether all hold
    bool run(const std::vector<Cell>& cells) {
        for (const Cell& cell : cells) run(cell);
        const std::string row = cells.front().row;
        verification_.absolute(row + ": cells that hold", "-", held_[row], count_[row], 0.0, {"exact", said_[row], {}});
        return held_[row] == count_[row];
    }
    fs::path folder_of(const Cell& cell) const {
        std::string name = cell.row + "_" + cell.column;
        std::replace_if(
            name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
        return verification_.folder(name);
    }

private:
    inline static const std::vector<std::string> k_header = {"what",
                                                             "value",
                                                             "outcome",
                                                             "largest balance error",
                                                             "momentum owed, median",
                                                             "rock speed, m/s",
                                                             "solid fraction",
                                                             "overlap over radius",
                                                             "Courant",
                                                             "core s"};
    Verification& verification_;
    std::vector<std::vector<std::string>> rows_;
    std::map<std::string, int> count_, held_;
    std::map<std::string, std::string> said_;
};

void overlapping_pair(Verification& verification, Matrix& matrix) {
    BoxCase box = small_box();
    for (int i = 0; i < 2; ++i) box.rocks.push_back({i + 1, 0.0, Vec3(0.0007, -0.0011 + 0.005 * i, 0.05), 0.010, 2650, Vec3::Zero()});
    const Cell cell = box_cell("two rocks released overlapping", "by half a diameter", box, frictionless_speed(2.65, 0.045));
    if (!matrix.run(std::vector<Cell>{cell})) return;
    const auto rejected = read_columns(matrix.folder_of(cell) / "postProcessing/rock/0/rejected.csv");
    verification.absolute("two rocks released overlapping: rejected, with the reason", "-", static_cast<double>(rejected.at("id").size()),
                          1.0, 0.0, {"exact", "the second one is told in rejected.csv and does not enter", {}});
}

/// Rock of four cells and more under a backplate at rest, on a turning ramp:
/// both are steel of the mesh, and the DEM's walls are its patches.
void rock_between_steel(Verification& verification, Matrix& matrix) {
    namespace test = cases::test;
    constexpr double density = 1050.0,
                     azimuth_deg = 82.5;  // light as above; the gap there is 1.15 diameters
    cases::CaseInputs inputs = rotor_inputs(0.4);
    inputs.rock->contact.youngs_modulus = k_squeezed_modulus;
    inputs.rock->contact.max_speed = 6.0;
    const double middle = 0.5 * (test::k_ramp_hub_radius + test::k_ramp_radius);
    const double height = test::k_tiny_z_max - 0.5 * test::ramp_gap(azimuth_deg) * test::k_ramp_rock;
    const std::vector<BoxRock> rocks = {{1, 0.0, around(middle, azimuth_deg, height), test::k_ramp_rock, density, Vec3::Zero()}};
    const std::string row =
        "rock of four cells squeezed between steel of the "
        "mesh that turns and steel at rest";
    const double fastest = fastest_squeezed(test::k_ramp_rock, density, test::k_ramp_narrow);
    Cell cell{row, fmt::format("gap {} d", test::k_ramp_narrow), {}, fastest, 3.0 * fastest, test::k_ramp_smallest_cell};
    cell.prepare = [inputs, rocks](const fs::path& folder) {
        write_rotor_case(folder, inputs, feed_text(rocks), test::write_ramp_block_mesh);
    };
    cell.overlap = 1.5 * overlap_in_gap(test::k_ramp_narrow);
    if (!matrix.run(std::vector<Cell>{cell})) return;
    const auto balance = read_columns(matrix.folder_of(cell) / "postProcessing/balance/0/balance.csv");
    verification.absolute(row + ": rocks at the end", "-", balance.at("rocks").back(), 1.0, 0.0, {"exact", "none is lost", {}});
    verification.at_least(row + ": largest overlap over what the gap lacks", "-",
                          largest(balance.at("overlap_ratio_max")) / overlap_in_gap(test::k_ramp_narrow), 0.8,
                          {"exact", "half of it at either contact: the rock was in the narrowest gap", {}});
    verification.at_most(row + ": solid fraction", "-", largest(balance.at("solid_fraction_max")), 0.7,
                         {"exact", "kernel.maxSolidFraction; the kernel ends at both faces of steel", {}});
    verification.at_most(row + ": momentum_error", "-", largest(balance.at("momentum_error")), k_momentum_limit,
                         {"exact", "one rock of 1,050 kg/m3, pressure to 2e-8 as shipped", {}});
}

void rank_corner(Verification& verification, Matrix& matrix) {
    std::vector<Cell> cells;
    for (const int ranks : {1, 4}) {
        BoxCase box = small_box();
        box.rocks = {{1, 0.0, Vec3(0.0, 0.0, 0.06), 0.010, 2650, Vec3(0, 0, -0.3)}};
        Cell cell =
            box_cell("rock on the corner of four ranks", fmt::format("{} rank(s)", ranks), box, 0.3 + frictionless_speed(2.65, 0.055));
        cell.ranks = ranks;
        cell.prepare = [box, ranks](const fs::path& folder) {
            write_box_case(folder, box);
            if (ranks > 1) decompose(folder, {2, 2, 1});
        };
        cells.push_back(cell);
    }
    if (!matrix.run(cells)) return;
    const auto end = [&](const Cell& cell) { return last_rocks(matrix.folder_of(cell)).position.at(0); };
    verification.at_most("rock on the corner of four ranks: distance from the run on one", "m", (end(cells[1]) - end(cells[0])).norm(),
                         1e-8, {"exact", "falls along the edge that the four share, 0.04 m", {}});
}

/// Of the written states the largest difference of water and rock that is still
/// there from the volume of the box, over it.
double volume_missed(const fs::path& folder, const BoxCase& box, const std::map<std::string, std::vector<double>>& balance,
                     double rock_volume) {
    const double whole = (box.upper - box.lower).prod(), of_cell = whole / static_cast<double>(box.cell_count());
    const std::vector<double>&time = balance.at("time_s"), &rocks = balance.at("rocks");
    std::vector<double> missed;
    for (std::size_t i = 0; i < time.size(); ++i) {
        const fs::path alpha = folder / fmt::format("{:g}", time[i]) / "voidFraction";
        if (!fs::exists(alpha)) continue;
        double filled = rocks[i] * rock_volume;
        for (const double share : read_scalar_field(alpha, box.cell_count())) filled += share * of_cell;
        missed.push_back(std::abs(filled / whole - 1.0));
    }
    return largest(missed);
}

constexpr const char* k_outflow =
    "outflow { type surfaceFieldValue; libs (\"libfieldFunctionObjects.so\"); "
    "regionType patch; name top; operation weightedSum; "
    "weightField voidFraction; fields (phi); writeFields no; }";

/// Volume of water that has flowed out through the top until the end of a run
/// [m3].
double flowed_out(const fs::path& folder, double end) {
    double volume = 0.0, time = 0.0;
    for (const std::vector<double>& row : read_function_object(folder, "outflow")) {
        volume += row.at(1) * (row.at(0) - time);
        time = row[0];
    }
    if (std::abs(time - end) > 1e-9) throw std::runtime_error(folder.string() + " does not have the outflow of all steps");
    return volume;
}

void through_the_outlet(Verification& verification, Matrix& matrix) {
    BoxCase box = small_box();
    box.sides = BoxSides::open_top;
    box.rock_leaves_at_top = true;
    box.functions = k_outflow;
    box.rocks = {{1, 0.0, Vec3(0.0007, -0.0011, 0.06), 0.010, 2650, Vec3(0, 0, 1.5)}};
    const Cell cell = box_cell("rock leaves through the outlet", "at 1.5 m/s", box, 1.5);
    if (!matrix.run(std::vector<Cell>{cell})) return;
    const auto balance = read_columns(matrix.folder_of(cell) / "postProcessing/balance/0/balance.csv");
    const double volume = k_pi / 6.0 * std::pow(0.010, 3);
    verification.absolute("rock leaves through the outlet: rocks left", "-", balance.at("rocks").back(), 0.0, 0.0, {"exact", "", {}});
    verification.at_most(
        "rock leaves through the outlet: fluid booked too much or too little, "
        "over the rock's volume",
        "-", std::abs(balance.at("exchanged_volume_m3").back()) / volume, 1e-9,
        {"exact",
         "fluid that made room for it at the start has come back; of the "
         "program's book alone",
         {}});
    const fs::path folder = matrix.folder_of(cell);
    verification.at_most(
        "rock leaves through the outlet: water and rock that is still there, "
        "less the box's volume, over it",
        "-", volume_missed(folder, box, balance, volume), 1e-12,
        {"exact", "from the written void fractions, every 10 ms; the largest", {}});
    verification.at_most(
        "rock leaves through the outlet: water that flowed through the top in "
        "the whole run, over the rock's volume",
        "-", std::abs(flowed_out(folder, box.end_time)) / volume, 1e-6,
        {"exact",
         "phi times the void fraction, every step; nothing flows, as water makes "
         "room at the release and takes the rock's place "
         "at the departure without a flow",
         {}});
}

/// The rotor beside its bank, towards which it travels, with 16 rocks nearly as
/// light as water: the scene of validation/rotor/test_cut_face.cpp, but that
/// all rock comes at once.
void write_travelling_head(const fs::path& folder) {
    constexpr double begin = 0.1, radius = 0.1275, density = 1010.0;
    cases::CaseInputs inputs = rotor_inputs(begin + 0.3);
    inputs.rock.emplace();
    inputs.rock->density = density;
    std::vector<BoxRock> rocks;
    for (int i = 0; i < 16; ++i) {
        const double azimuth = 102.0 + 26.0 * (i % 4);  // between the lumps of steel at that time
        rocks.push_back({i + 1, begin, around(radius, azimuth, -0.2 + 0.045 * (i / 4)), 0.008, density,
                         around(0.5 * inputs.rotor.speed * radius, azimuth + 90.0, 0.0)});
    }
    write_rotor_beside_bank(folder, inputs, feed_text(rocks));
}

void travelling_head(Verification& verification) {
    const fs::path folder = verification.folder("head_that_travels");
    write_travelling_head(folder);
    run_cutter_foam(folder);
    const auto balance = read_columns(folder / "postProcessing/balance/0/balance.csv");
    verification.at_most("head that travels past its bank: momentum_error", "-", largest(balance.at("momentum_error")), k_momentum_limit,
                         {"exact",
                          "16 rocks of 1,010 kg/m3, pressure to 2e-8 as shipped. The balance is "
                          "relative to the rocks' small weight under water",
                          {}});
    verification.at_most("head that travels past its bank: momentum_carried, median of the steps with rock", "-", median_carried(balance),
                         k_most_carried, {"exact", "less than a step's exchange is owed where the water takes two thirds of it", {}});
}

void run(Verification& verification) {
    if (!verification.wants(Effort::standard)) return;
    Matrix matrix(verification);
    matrix.run(rock_to_cell());
    matrix.run(density_ratio());
    matrix.run(dense_pile());
    matrix.run(squeezed_rock());
    rock_between_steel(verification, matrix);
    matrix.run(interface_crossing("one rock across the interface, m/s", 1));
    matrix.run(interface_crossing("50 rocks across the interface, m/s", 50));
    matrix.run(courant_number());
    matrix.run(impulsive_start());
    matrix.run(batch());
    matrix.run(no_rock());
    overlapping_pair(verification, matrix);
    rank_corner(verification, matrix);
    through_the_outlet(verification, matrix);
    travelling_head(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
