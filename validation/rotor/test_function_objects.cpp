/// OpenFOAM's function objects on cutterFoam: what forces, forceCoeffs, yPlus, wallShearStress and turbulenceFields say is what they say on
/// OpenFOAM's own pimpleFoam, on a small rotor with a sliding interface and without rock.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/file_content.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/rotor_case.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr double k_time_step = 4e-3, k_end = 0.04;  // [s]
/// cutterFoam closes the flux through the sliding interface and pimpleFoam does not, which shakes its axial force by a part in a hundred of
/// the force of little suction. (Without that closure the programs agree to 1e-10 in every quantity below.)
constexpr double k_discharge = 0.1;  // [m3/s]
constexpr double k_agreement = 0.01;

const char* const k_functions = R"(
functions
{
    forces
    {
        type forces; libs (forces);
        patches (cutter backplate); rho rhoInf; rhoInf 1000; CofR (0 0 0); pitchAxis (0 1 0);
    }
    forceCoeffs
    {
        type forceCoeffs; libs (forces);
        patches (cutter backplate); rho rhoInf; rhoInf 1000; CofR (0 0 0); liftDir (0 1 0); dragDir (1 0 0); pitchAxis (0 0 1);
        magUInf 1; lRef 0.3; Aref 0.09;
    }
    yPlus { type yPlus; libs (fieldFunctionObjects); writeControl timeStep; }
    wallShearStress { type wallShearStress; libs (fieldFunctionObjects); writeControl timeStep; }
    turbulenceFields { type turbulenceFields; libs (fieldFunctionObjects); fields (k epsilon nut nuEff R devReff); }
    means
    {
        type volFieldValue; libs (fieldFunctionObjects); writeControl timeStep; writeFields no; regionType all; operation volAverage;
        fields (turbulenceProperties:k turbulenceProperties:epsilon turbulenceProperties:nut turbulenceProperties:nuEff
            turbulenceProperties:R turbulenceProperties:devReff);
    }
}
)";

void append(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::app) << text;
}

/// cutterFoam gives a wall that turns the pressure's gradient of fixedFluxPressure and pimpleFoam does not.
void give_walls_no_pressure_gradient(const fs::path& pressure) {
    std::string text = read_file(pressure);
    const std::string condition = "fixedFluxPressure";
    for (std::size_t at = text.find(condition); at != std::string::npos; at = text.find(condition, at))
        text.replace(at, condition.size(), "zeroGradient");
    write_file(pressure, text);
}

/// The rotor in water at rest, with a fixed time step, second order in time (cutterFoam turns the forces of an Euler step) and loops that
/// converge, so that both programs solve the same equations.
fs::path rotor(const std::string& name) {
    const fs::path folder = scratch_folder(name);
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    inputs.discharge = k_discharge;
    write_rotor_case(folder, inputs, "");
    append(folder / "system/controlDict",
           fmt::format("endTime {}; deltaT {}; adjustTimeStep no; writeControl timeStep; writeInterval 1000;\n{}", k_end, k_time_step,
                       k_functions));
    append(folder / "system/fvSolution",
           "PIMPLE { nOuterCorrectors 8; nCorrectors 2; turbOnFinalIterOnly no; }\n"
           "solvers { \"(p|pFinal)\" { tolerance 1e-10; relTol 0; } \"(U|k|epsilon)\" { tolerance 1e-10; relTol 0; } "
           "\"(U|k|epsilon)Final\" { tolerance 1e-10; } }\n");
    give_walls_no_pressure_gradient(folder / "0/p");
    append(folder / "system/fvSchemes", "ddtSchemes { default backward; }\n");
    return folder;
}

/// The numbers of the rows of the last time in a function object's table; each row begins with the time and may go on with a name.
std::vector<std::vector<double>> last_rows(const fs::path& file) {
    std::ifstream stream(file);
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(stream, line);) {
        if (line.empty() || line[0] == '#') continue;
        for (char& c : line)
            if (c == '(' || c == ')') c = ' ';
        std::istringstream words(line);
        std::vector<double> row;
        for (std::string word; words >> word;) {
            char* end = nullptr;
            const double value = std::strtod(word.c_str(), &end);
            if (*end == '\0') row.push_back(value);
        }
        if (!rows.empty() && rows.back().front() != row.front()) rows.clear();
        rows.push_back(row);
    }
    return rows;
}

/// A named group of columns that are compared by the length of the difference of their vectors.
struct Quantity {
    std::string object, file;
    std::string name;
    std::size_t first, count;  ///< columns; column 0 is the time
};

const std::vector<Quantity> k_quantities = {
    {"forces", "force.dat", "force", 1, 3},
    {"forces", "force.dat", "pressure force", 4, 3},
    {"forces", "force.dat", "viscous force", 7, 3},
    {"forces", "moment.dat", "moment", 1, 3},
    {"forces", "moment.dat", "pressure moment", 4, 3},
    {"forces", "moment.dat", "viscous moment", 7, 3},
    {"forceCoeffs", "coefficient.dat", "coefficients", 1, 12},
    {"yPlus", "yPlus.dat", "y+ min, max, mean", 1, 3},
    {"wallShearStress", "wallShearStress.dat", "least wall shear stress", 1, 3},
    {"wallShearStress", "wallShearStress.dat", "largest wall shear stress", 4, 3},
    {"means", "volFieldValue.dat", "mean k", 1, 1},
    {"means", "volFieldValue.dat", "mean epsilon", 2, 1},
    {"means", "volFieldValue.dat", "mean nut", 3, 1},
    {"means", "volFieldValue.dat", "mean nuEff", 4, 1},
    {"means", "volFieldValue.dat", "mean R", 5, 6},
    {"means", "volFieldValue.dat", "mean devReff", 11, 6},
};

double length(const std::vector<double>& v) {
    double sum = 0.0;
    for (const double x : v) sum += x * x;
    return std::sqrt(sum);
}

TEST(FunctionObjects, say_on_cutter_foam_what_they_say_on_pimple_foam) {
    const fs::path ours = rotor("functions_cutterFoam"), theirs = rotor("functions_pimpleFoam");
    run_cutter_foam(ours);
    run_in_case(theirs, {"pimpleFoam"});
    for (const Quantity& quantity : k_quantities) {
        const auto file = [&](const fs::path& folder) { return folder / "postProcessing" / quantity.object / "0" / quantity.file; };
        const auto rows = last_rows(file(ours)), expected = last_rows(file(theirs));
        ASSERT_FALSE(expected.empty()) << quantity.name;
        ASSERT_EQ(rows.size(), expected.size()) << quantity.name;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            ASSERT_NEAR(expected[r].front(), k_end, 1e-9);
            ASSERT_EQ(rows[r].size(), expected[r].size());
            ASSERT_GE(rows[r].size(), quantity.first + quantity.count) << quantity.name;
            std::vector<double> value, difference;
            for (std::size_t c = quantity.first; c < quantity.first + quantity.count; ++c) {
                value.push_back(expected[r][c]);
                difference.push_back(rows[r][c] - expected[r][c]);
            }
            ASSERT_GT(length(value), 0.0) << quantity.name;
            const double apart = length(difference) / length(value);
            fmt::print("{:<26} {:>12.5g} of pimpleFoam, apart by {:.2e}\n", quantity.name, length(value), apart);
            EXPECT_LE(apart, k_agreement) << quantity.name;
        }
    }
}

}  // namespace
}  // namespace cutterflow::validation
