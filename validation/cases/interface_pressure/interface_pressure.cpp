/// A rock moved through the sliding interface displaces its volume and no more.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/harness/continuity_log.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/tank_mesh.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_diameter = 0.02, k_speed = 0.5;
/// In it the interface, at 0.754 m/s, turns by a quarter of the kernel width, which is the rock's diameter: 0.43 cells, of the fine mesh
/// 0.86.
constexpr double k_longest_step = 6.5e-3;
constexpr double k_setting_off = 0.015;  // [s] in which the impulse of setting off in water at rest dies out

const char* const k_functions = R"(
    pressure { type fieldMinMax; libs ("libfieldFunctionObjects.so"); fields (p); location no; }
    speed { type fieldMinMax; libs ("libfieldFunctionObjects.so"); fields (U); location no; }
    inflow { type surfaceFieldValue; libs ("libfieldFunctionObjects.so"); regionType patch; name stator_interface; operation weightedSum;
             weightField voidFraction; fields (phi); writeFields no; }
    fluid { type volFieldValue; libs ("libfieldFunctionObjects.so"); regionType cellZone; name rotor; operation volIntegrate;
            fields (voidFraction); writeFields no; }
)";

/// \param fineness  1: cells of about 12 mm; 2: half of it
BoxCase tank(int fineness, double time_step, double from, double to) {
    TankMesh mesh;
    mesh.radius_interface = 0.12;
    mesh.radius = 0.24;
    mesh.height = 0.16;
    mesh.cells_around_quarter = 14 * fineness;
    mesh.stator_cells_around_quarter = 16 * fineness;
    mesh.cells_in_rotor_ring = 6 * fineness;
    mesh.cells_in_stator = 13 * fineness;
    mesh.cells_high = 14 * fineness;
    BoxCase room;
    room.mesh = block_mesh(mesh);
    room.motion = turning(rpm_to_rad_s(60.0));
    room.functions = k_functions;
    room.sides = BoxSides::open_top;  // in a closed room the interface's own imbalance would be spread over all cells
    room.lower = Vec3(-mesh.radius, -mesh.radius, -0.5 * mesh.height);
    room.upper = Vec3(mesh.radius, mesh.radius, 0.5 * mesh.height);
    room.gravity = Vec3::Zero();
    room.closures = "drag brown_lawler; hindrance none; addedMass 0; dragModifier 1e-12;";
    room.time_step = time_step;
    const double speed = to > from ? k_speed : 0.0;
    room.end_time = to > from ? std::round((to - from) / speed / time_step) * time_step : 30 * time_step;
    room.rocks = {{1, 0.0, Vec3(from, 0.003, 0.001), k_diameter, 1e9, Vec3(speed, 0.0, 0.0)}};
    return room;
}

std::filesystem::path move(const Verification& verification, const std::string& name, const BoxCase& room) {
    const auto folder = verification.folder(name);
    write_box_case(folder, room);
    run_cutter_foam(folder);
    return folder;
}

/// Largest range of pressure [m2/s2] between two times.
double pressure_range(const std::filesystem::path& folder, double from, double to) {
    std::vector<double> ranges;
    for (const auto& row : read_function_object(folder, "pressure"))
        if (row.at(0) >= from && row[0] <= to) ranges.push_back(row.at(2) - row.at(1));
    return largest(ranges);
}

/// Fluid that flowed into the turning zone over rock that left it [-].
double displaced_ratio(const std::filesystem::path& folder, double time_step) {
    const auto inflow = read_function_object(folder, "inflow"), fluid = read_function_object(folder, "fluid");
    double into = 0.0;
    for (std::size_t i = 1; i < inflow.size(); ++i) into += inflow[i].at(1) * time_step;
    return into / (fluid.back().at(1) - fluid.front().at(1));
}

/// Largest sum over the cells of |d(alpha)/dt + div(alpha u)| V at the end of a step, over the volume rate that the rock displaces [-].
double continuity_error(const std::filesystem::path& folder, double time_step, const BoxCase& room) {
    const double volume = k_pi * room.upper.x() * room.upper.x() * (room.upper.z() - room.lower.z());
    return read_continuity(folder / "log.cutterFoam").largest_local * volume / time_step / (k_speed * k_pi / 4.0 * k_diameter * k_diameter);
}

void cross(Verification& verification, int fineness, double dt) {
    const bool whole = dt > 5e-4;  // shorter steps are looked at in the middle of the zone and at the interface only
    const std::string with = fmt::format("{}time step {:g} s", fineness > 1 ? "cells of 6 mm, " : "", dt);
    const std::string name = fmt::format("{}{:g}", fineness > 1 ? "fine_" : "", dt);
    const BoxCase before = tank(fineness, dt, 0.02, 0.045);
    const BoxCase crossing = whole ? tank(fineness, dt, 0.055, 0.185) : tank(fineness, dt, 0.105, 0.13);
    const auto inside = move(verification, "inside_" + name, before);
    const auto through = move(verification, "through_" + name, crossing);
    const double range = pressure_range(inside, k_setting_off, 1.0);
    const double at_interface = whole ? pressure_range(through, 0.09, 0.16) : pressure_range(through, k_setting_off, 1.0);
    verification.at_most("pressure range at the crossing over that before, " + with, "-", at_interface / range, 1.1,
                         {"exact", fmt::format("before {:.4g} m2/s2, at the crossing {:.4g}", range, at_interface)});
    if (whole)
        verification.absolute("displaced volume flux, " + with, "-", displaced_ratio(through, dt), 1.0, 1e-3,
                              {"exact", "fluid into the zone over rock out of it, whole crossing"});
    verification.at_most("continuity error, " + with, "-", continuity_error(through, dt, crossing), 1e-7,
                         {"exact", "sum of |cell residual| over the rock's displaced rate"});
}

void run(Verification& verification) {
    const auto rest = move(verification, "rest", tank(1, 1e-3, 0.11, 0.11));
    std::vector<double> speeds;
    for (const auto& row : read_function_object(rest, "speed")) speeds.push_back(row.at(2));
    verification.at_most("velocity around rock at rest in the turning zone", "m/s", largest(speeds), 1e-10,
                         {"exact", "30 steps of 1e-3 s at 60 rpm"});
    for (const double dt : {k_longest_step, 1e-3, 5e-4, 2e-4}) cross(verification, 1, dt);
    cross(verification, 2, k_longest_step);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
