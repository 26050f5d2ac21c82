/// Volume, energy, front and cost of a dam break, beside interIsoFoam on the same cells.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "geometry/base/process/child_process.hpp"
#include "solver/free_surface/output/scene_gauges.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/reference_table.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::free_surface;
using validation::Effort;
using validation::larger;
using validation::Verification;

constexpr double k_width = 0.05715, k_gravity = 9.81;
constexpr int k_tank_widths = 5, k_tank_heights = 4;
constexpr double k_front_end = 0.36;  // [s]: the front has reached the far wall before

SceneSettings dam(int cells) {
    SceneSettings scene;
    scene.tank.cells = {k_tank_widths * cells, 1, k_tank_heights * cells};
    scene.tank.cell = k_width / cells;
    scene.tank.depth = 0.01;
    scene.gravity = Vec3(0, 0, -k_gravity);
    scene.water.kinematic_viscosity = 0.0;
    scene.water.filled = {{Vec3(0, -1, 0), Vec3(k_width, 1, 2.0 * k_width)}};
    scene.run.volume_limit = 1.0;  // the case judges it
    return scene;
}

/// Where the fraction in the lowest row falls through 1/2 for the last time, in cells from the left wall.
double front_of(const std::vector<double>& row) {
    double front = 0.0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (row[i] < 0.5) continue;
        const double next = i + 1 < row.size() ? row[i + 1] : 0.0;
        front = static_cast<double>(i) + 0.5 + (next < 0.5 ? (row[i] - 0.5) / (row[i] - next) : 0.5);
    }
    return std::min(front, static_cast<double>(row.size()));
}

struct Front {
    std::vector<double> time{0.0}, place{k_width};  // [s], [m]
    double core_s = 0.0;                            // until k_front_end
    void add(double when, double where) {
        time.push_back(when);
        place.push_back(where);
    }
    double at(double when) const {
        for (std::size_t n = 1; n < time.size(); ++n) {
            if (time[n] < when) continue;
            const double share = (when - time[n - 1]) / (time[n] - time[n - 1]);
            return place[n - 1] + share * (place[n] - place[n - 1]);
        }
        return place.back();
    }
};

constexpr std::array<double, 2> k_depths = {0.1, 0.2};  // widths of the column: how deep the water is where its front is looked for

struct Fall {
    Front front;
    std::array<Front, 2> deep;       // where the water is of each of k_depths
    double worst = 0.0, last = 0.0;  // of the occupied volume, shares lost
    double energy_rise = 0.0, energy_left = 1.0;
    double level = 0.0;  // mean [m]
};

/// Mean level in a column of cells [m].
std::vector<double> levels(const SurfaceRun& run) {
    const StaggeredGrid& grid = run.grid();
    std::vector<double> level(grid.cells(0), 0.0);
    grid.for_each_cell([&](int cell, int i, int, int) { level[i] += grid.spacing() * std::min(1.0, run.water().fraction[cell]); });
    return level;
}

Fall fall(const SceneSettings& scene, double end) {
    SurfaceRun run(scene, nullptr);
    Fall result;
    const double start = run.energy();
    double lowest = start;
    const std::clock_t began = std::clock();
    while (run.time() < end) {
        const StepReport& report = run.step(end - run.time());
        const double lost = 1.0 - report.occupied_volume / run.initial_volume();
        if (std::isnan(lost) || std::abs(lost) > std::abs(result.worst)) result.worst = lost;
        result.last = lost;
        const double energy = run.energy();
        result.energy_rise = larger(result.energy_rise, (energy - lowest) / start);
        lowest = std::min(lowest, energy);
        result.energy_left = energy / start;
        if (run.time() > k_front_end) continue;
        std::vector<double> row;
        for (int i = 0; i < run.grid().cells(0); ++i) row.push_back(run.water().fraction[run.grid().at(i, 0, 0)]);
        result.front.add(run.time(), front_of(row) * run.grid().spacing());
        const std::vector<double> level = levels(run);
        for (std::size_t n = 0; n < k_depths.size(); ++n) {
            row = level;
            for (double& share : row) share *= 0.5 / (k_depths[n] * k_width);
            result.deep[n].add(run.time(), front_of(row) * run.grid().spacing());
        }
        result.front.core_s = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
    }
    const std::vector<double> level = levels(run);
    for (const double one : level) result.level += one / static_cast<double>(level.size());
    return result;
}

void write(const std::filesystem::path& file, const std::string& kind, const std::string& object, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class " << kind << ";\n    object " << object << ";\n}\n"
                        << text;
}

/// The peer's case on the same cells; walls slip, the top is open, air as light as stock tutorials have it.
void write_peer(const std::filesystem::path& folder, int cells) {
    const double x = k_tank_widths * k_width, z = k_tank_heights * k_width;
    write(
        folder / "system/blockMeshDict", "dictionary", "blockMeshDict",
        fmt::format(
            "convertToMeters 1;\nvertices ((0 0 0) ({0} 0 0) ({0} 0.01 0) (0 0.01 0) (0 0 {1}) ({0} 0 {1}) ({0} 0.01 {1}) (0 0.01 {1}));\n"
            "blocks (hex (0 1 2 3 4 5 6 7) ({2} 1 {3}) simpleGrading (1 1 1));\nedges ();\nboundary (\n"
            "walls {{ type wall; faces ((0 3 2 1) (0 4 7 3) (1 2 6 5)); }}\natmosphere {{ type patch; faces ((4 5 6 7)); }}\n"
            "sides {{ type empty; faces ((0 1 5 4) (3 7 6 2)); }}\n);\n",
            x, z, k_tank_widths * cells, k_tank_heights * cells));
    write(folder / "system/setFieldsDict", "dictionary", "setFieldsDict",
          fmt::format("defaultFieldValues ( volScalarFieldValue alpha.water 0 );\nregions ( boxToCell {{ box (-1 -1 -1) ({} 1 {}); "
                      "fieldValues ( volScalarFieldValue alpha.water 1 ); }} );\n",
                      k_width, 2.0 * k_width));
    write(folder / "system/controlDict", "dictionary", "controlDict",
          fmt::format("application interIsoFoam;\nstartFrom startTime;\nstartTime 0;\nstopAt endTime;\nendTime {};\ndeltaT 1e-4;\n"
                      "writeControl adjustableRunTime;\nwriteInterval 0.01;\nwriteFormat ascii;\nwritePrecision 7;\ntimeFormat "
                      "general;\ntimePrecision 8;\n"
                      "adjustTimeStep yes;\nmaxCo 0.25;\nmaxAlphaCo 0.25;\nmaxDeltaT 1;\n",
                      k_front_end));
    write(folder / "system/fvSchemes", "dictionary", "fvSchemes",
          "ddtSchemes { default Euler; }\ngradSchemes { default Gauss linear; }\n"
          "divSchemes { div(rhoPhi,U) Gauss linearUpwind grad(U); div(phi,alpha) Gauss vanLeer; div(phirb,alpha) Gauss linear; "
          "div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear; }\nlaplacianSchemes { default Gauss linear corrected; }\n"
          "interpolationSchemes { default linear; }\nsnGradSchemes { default corrected; }\n");
    write(folder / "system/fvSolution", "dictionary", "fvSolution",
          "solvers {\n\"alpha.water.*\" { nAlphaCorr 1; nAlphaSubCycles 1; cAlpha 1; isoFaceTol 1e-6; surfCellTol 1e-6; nAlphaBounds 3; "
          "snapTol 1e-12; clip true; "
          "MULESCorr yes; nLimiterIter 3; solver smoothSolver; smoother symGaussSeidel; tolerance 1e-8; relTol 0; }\n"
          "\"pcorr.*\" { solver PCG; preconditioner DIC; tolerance 1e-5; relTol 0; }\np_rgh { solver PCG; preconditioner DIC; tolerance "
          "1e-7; relTol 0.05; }\n"
          "p_rghFinal { $p_rgh; relTol 0; }\nU { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-6; relTol 0; }\n}\n"
          "PIMPLE { momentumPredictor no; nOuterCorrectors 1; nCorrectors 3; nNonOrthogonalCorrectors 0; }\n");
    write(folder / "constant/g", "uniformDimensionedVectorField", "g",
          fmt::format("dimensions [0 1 -2 0 0 0 0];\nvalue (0 0 -{});\n", k_gravity));
    write(folder / "constant/turbulenceProperties", "dictionary", "turbulenceProperties", "simulationType laminar;\n");
    write(folder / "constant/transportProperties", "dictionary", "transportProperties",
          "phases (water air);\nwater { transportModel Newtonian; nu 1e-06; rho 1000; }\nair { transportModel Newtonian; nu 1.48e-05; rho "
          "1; }\nsigma 0;\n");
    write(folder / "0/U", "volVectorField", "U",
          "dimensions [0 1 -1 0 0 0 0];\ninternalField uniform (0 0 0);\nboundaryField { walls { type slip; } atmosphere { type "
          "pressureInletOutletVelocity; "
          "value uniform (0 0 0); } sides { type empty; } }\n");
    write(folder / "0/p_rgh", "volScalarField", "p_rgh",
          "dimensions [1 -1 -2 0 0 0 0];\ninternalField uniform 0;\nboundaryField { walls { type fixedFluxPressure; value uniform 0; } "
          "atmosphere { type "
          "totalPressure; p0 uniform 0; } sides { type empty; } }\n");
    write(folder / "0/alpha.water", "volScalarField", "alpha.water",
          "dimensions [0 0 0 0 0 0 0];\ninternalField uniform 0;\nboundaryField { walls { type zeroGradient; } atmosphere { type "
          "inletOutlet; inletValue "
          "uniform 0; value uniform 0; } sides { type empty; } }\n");
}

/// The first `count` values of a field that OpenFOAM wrote as text.
std::vector<double> first_values(const std::filesystem::path& file, int count) {
    std::ifstream stream(file);
    std::string word;
    while (stream >> word && word != "List<scalar>") {
    }
    char bracket = 0;
    int size = 0;
    stream >> size >> bracket;
    std::vector<double> values(static_cast<std::size_t>(count), 0.0);
    for (double& value : values) stream >> value;
    if (!stream) throw std::runtime_error(fmt::format("{} holds fewer than {} values", file.string(), count));
    return values;
}

Front peer_front(Verification& verification, int cells) {
    const auto folder = verification.folder(fmt::format("interIsoFoam_{}", cells));
    write_peer(folder, cells);
    const auto run = [&](const std::string& program) {
        return require_child(
            {{program, "-case", folder.string()}, {}, folder / ("log." + program), {{"WM_PROJECT_DIR", "/usr/share/openfoam"}}});
    };
    run("blockMesh");
    run("setFields");
    Front front;
    front.core_s = run("interIsoFoam").core_s;
    for (int n = 1; n <= std::lround(k_front_end / 0.01); ++n) {
        const std::string name = fmt::format("{:g}", 0.01 * n);
        front.add(0.01 * n, front_of(first_values(folder / name / "alpha.water", k_tank_widths * cells)) * k_width / cells);
    }
    return front;
}

void compare_with_peer(Verification& verification, const Front& ours, const Front& peer, int cells) {
    double apart = 0.0;
    for (std::size_t n = 0; n < peer.time.size(); ++n) {
        if (peer.place[n] > (k_tank_widths - 0.2) * k_width) break;  // it meets the far wall
        apart = larger(apart, std::abs(ours.at(peer.time[n]) - peer.place[n]));
    }
    verification.at_most(fmt::format("distance of the front to interIsoFoam's, {} cells a width", cells), "cells",
                         apart / (k_width / cells), 1.5,
                         {"exact", "stock solver of OpenFOAM 1912 on the same cells; largest until the far wall", {}});
    verification.report("core seconds for 0.36 s", "s", ours.core_s, {}, {"exact", "8,000 cells, Courant number 0.5, one core", {}});
    verification.report("core seconds of interIsoFoam for 0.36 s", "s", peer.core_s, {},
                        {"exact", "8,000 cells, Courant number 0.25, one core", {}});
    verification.at_least("core seconds of interIsoFoam over ours", "-", peer.core_s / ours.core_s, 10.0,
                          {"exact", "in one run of this case", {}});
}

/// Distance of a front to the measured one after the shift in time that makes the largest error least.
struct ExperimentError {
    double shift = 0.0;        // in T = t sqrt(2 g/a)
    double largest = 0.0;      // of all places, shares
    double after_first = 0.0;  // of all but the first
};

ExperimentError error_of(const Front& front, const validation::ReferenceTable& table) {
    const double unit = std::sqrt(k_width / (2.0 * k_gravity));
    const auto largest = [&](double shift, std::size_t from) {
        double error = 0.0;
        for (std::size_t n = from; n < table.rows(); ++n) {
            const double place = front.at(std::max(0.0, table.at("time")[n] - shift) * unit) / k_width;
            error = larger(error, std::abs(place / table.at("front")[n] - 1.0));
        }
        return error;
    };
    ExperimentError best{0.0, largest(0.0, 0), 0.0};
    for (double shift = 0.0; shift < 0.6; shift += 0.005) {
        if (largest(shift, 0) < best.largest) best = {shift, largest(shift, 0), largest(shift, 1)};
    }
    return best;
}

void compare_with_experiment(Verification& verification, const Fall& fallen, const Front* peer, int cells) {
    const validation::ReferenceTable table =
        validation::read_reference(validation::case_file("dam_break/front.csv"), {{"time", "-"}, {"front", "-"}});
    const std::string mesh = fmt::format(", {} cells a width", cells);
    const ExperimentError error = error_of(fallen.front, table);
    verification.at_most("error of the front after one shift in time" + mesh, "-", error.largest, 0.04,
                         {table.source, "largest of 15 places after the shift that makes it least", {}});
    verification.at_most("shift in time of the measured front" + mesh, "-", error.shift, 0.35,
                         {table.source, "in T = t sqrt(2 g/a): the diaphragm", {}});
    verification.report("error of the front at the other 14 places" + mesh, "-", error.after_first, {}, {table.source, "same shift", {}});
    for (std::size_t n = 0; n < k_depths.size(); ++n) {
        const ExperimentError deep = error_of(fallen.deep[n], table);
        verification.report(fmt::format("error of the place where the water is {:g} widths deep", k_depths[n]) + mesh, "-", deep.largest,
                            {},
                            {table.source, fmt::format("after a shift of {:.3g} in T: the tongue before it is thinner", deep.shift), {}});
    }
    if (!peer) return;
    verification.report("error of interIsoFoam's front after one shift in time" + mesh, "-", error_of(*peer, table).largest, {},
                        {table.source, "the same measure: the method is not what fails", {}});
}

void check_fall(Verification& verification, int cells, double volume_limit) {
    const Fall fallen = fall(dam(cells), 1.0);
    const std::string mesh = fmt::format("{} cells a width", cells);
    verification.at_most("occupied volume lost or won in 1 s, " + mesh, "-", std::abs(fallen.worst), volume_limit,
                         {"exact", "largest of all steps", {}});
    verification.at_most("rise of the energy over its lowest, " + mesh, "-", fallen.energy_rise, 0.005,
                         {"exact", "share of that at the start", {}});
    verification.at_least("energy left after 1 s, " + mesh, "-", fallen.energy_left, 0.30, {"exact", "0.2 is still water", {}});
    SceneSettings without = dam(cells);
    without.run.even_out = false;
    verification.at_least("occupied volume lost without the even-out, " + mesh, "-", fall(without, 1.0).worst, 0.08,
                          {"exact", "shown to fail: the measure sees water that clumps", {}});
    if (cells == 20) {
        const Front peer = peer_front(verification, cells);
        compare_with_peer(verification, fallen.front, peer, cells);
        if (verification.wants(Effort::standard)) compare_with_experiment(verification, fallen, &peer, cells);
        const Fall still = fall(dam(cells), 5.0);
        verification.relative("level after 5 s", "m", still.level, 0.4 * k_width, 0.015, {"exact", "volume over the tank's plan", {}});
    } else {
        compare_with_experiment(verification, fallen, nullptr, cells);
    }
}

// A column 0.6 m wide and 0.3 m high in a tank of 1.61 m, a sensor 3 mm above the floor in the far wall.
constexpr double k_high = 0.3, k_wide = 0.6, k_far_wall = 1.61, k_sensor = 0.003, k_pressure_cell = 0.01;
constexpr double k_still_from = 30.0, k_still_to = 42.0;  // [s]: about four periods of the slowest wave

struct WallPressure {
    double before = 0.0;   // largest while the front is two cells and more away [Pa]
    double arrival = 0.0;  // of the front at the wall [s]
    double peak = 0.0;     // [Pa]
    double mean = 0.0;     // from k_still_from to k_still_to [Pa]
};

WallPressure wall_pressure() {
    SceneSettings scene;
    scene.tank.cell = k_pressure_cell;
    scene.tank.cells = {static_cast<int>(std::lround(k_far_wall / k_pressure_cell)), 1, 60};
    scene.tank.depth = 0.15;
    scene.gravity = Vec3(0, 0, -k_gravity);
    scene.water.filled = {{Vec3(0, -1, 0), Vec3(k_wide, 1, k_high)}};
    SurfaceRun run(scene, nullptr);
    const Gauge sensor{"far wall", k_far_wall, 0.0, k_sensor};
    const int columns = run.grid().cells(0);
    WallPressure found;
    while (run.time() < k_still_to) {
        const double step = run.step(k_still_to - run.time()).step, pressure = read_gauge(run, sensor).pressure;
        found.peak = larger(found.peak, pressure);
        if (run.time() > k_still_from) found.mean += pressure * step / (k_still_to - k_still_from);
        if (found.arrival > 0.0) continue;
        std::vector<double> row;
        for (int i = 0; i < columns; ++i) row.push_back(run.water().fraction[run.grid().at(i, 0, 0)]);
        const double front = front_of(row);
        if (front < columns - 2.0) found.before = larger(found.before, std::abs(pressure));
        if (front > columns - 0.5) found.arrival = run.time();
    }
    return found;
}

void check_wall_pressure(Verification& verification) {
    const WallPressure found = wall_pressure();
    const double unit = 1000.0 * k_gravity * k_high, level = k_high * k_wide / k_far_wall;
    const std::string where = " at a sensor 3 mm high in the far wall";
    verification.at_most("pressure before the front arrives" + where, "Pa", found.before, 0.0,
                         {"exact", "front two cells and more away; column 0.6 m x 0.3 m, tank of 1.61 m, cells of 10 mm", {}});
    verification.relative("mean pressure of still water" + where, "Pa", found.mean, 1000.0 * k_gravity * (level - k_sensor), 0.05,
                          {"exact", "30 to 42 s; the lowest centre of a cell is 2 mm higher than the sensor: 1.8 %", {}});
    verification.report("arrival of the front at the far wall, t sqrt(g/H)", "-", found.arrival * std::sqrt(k_gravity / k_high), {},
                        {"exact", "no measured record is available here", {}});
    verification.report("largest pressure over rho g H" + where, "-", found.peak / unit, {},
                        {"exact", "of single steps; no measured record is available here", {}});
}

void run(Verification& verification) {
    check_fall(verification, 20, 0.01);
    if (verification.wants(Effort::standard)) check_wall_pressure(verification);
    if (verification.wants(Effort::standard)) check_fall(verification, 40, 0.01);
}

}  // namespace

int main(int argc, char** argv) {
    return validation::verify(argc, argv, run);
}
