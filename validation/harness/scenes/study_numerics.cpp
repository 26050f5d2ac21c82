#include "validation/harness/scenes/study_numerics.hpp"

#include <fmt/format.h>

#include "cases/scenes/cutter/flow_dictionaries.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "validation/harness/scenes/box_case.hpp"

namespace cutterflow::validation {
namespace {

void write_periodic_field(const std::filesystem::path& case_folder, const std::string& name, const std::string& dimensions, double value) {
    write_foam_dictionary(case_folder, "0/" + name, "volScalarField",
                          fmt::format("dimensions {};\ninternalField uniform {};\nboundaryField\n{{\n    #includeEtc "
                                      "\"caseDicts/setConstraintTypes\"\n}}",
                                      dimensions, value));
}

}  // namespace

void use_study_numerics(const std::filesystem::path& case_folder) {
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    inputs.rock.emplace();
    for (const cases::FoamFile& file : cases::run_system_files(inputs))
        if (file.path != "system/controlDict") write_foam_dictionary(case_folder, file.path, file.foam_class, file.contents.text());
    for (const char* key : {"PIMPLE/pRefCell", "PIMPLE/pRefValue"})
        run_in_case(case_folder, {"foamDictionary", "-entry", key, "-set", "0", "system/fvSolution"});
}

void use_study_turbulence(const std::filesystem::path& case_folder, double speed, double length) {
    const cases::Turbulence level = cases::turbulence_of(speed, length);
    write_periodic_field(case_folder, "k", "[0 2 -2 0 0 0 0]", level.k);
    write_periodic_field(case_folder, "epsilon", "[0 2 -3 0 0 0 0]", level.epsilon);
    write_periodic_field(case_folder, "nut", "[0 2 -1 0 0 0 0]", level.eddy_viscosity());
    write_foam_dictionary(case_folder, "constant/turbulenceProperties", "dictionary",
                          "simulationType RAS;\nRAS { RASModel realizableKE; turbulence on; printCoeffs off; }");
}

}  // namespace cutterflow::validation
