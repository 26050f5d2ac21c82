#include "solver/foam/single_phase/cutter_fluid.hpp"

#include <fmt/format.h>

#include "geometry/base/error.hpp"

#include "zeroGradientFvPatchFields.H"

namespace cutterflow::foam {

using namespace Foam;

void CutterFluid::require_case_for_rock() const {
    std::vector<Mistake> mistakes;
    const word ddt(mesh_.ddtScheme("ddt(" + U_.name() + ')'));
    if (ddt != "Euler") {
        mistakes.push_back({"system/fvSchemes", fmt::format("ddtSchemes default = {}", std::string(ddt)),
                            "With rock the void fraction's rate pairs with an Euler step only", "Set: default Euler;"});
    }
    for (const char* name : {"div(phi,U)", "div(phi,k)", "div(phi,epsilon)", "div(phi,omega)"}) {
        if (!mesh_.schemesDict().subDict("divSchemes").found(name)) continue;
        if (word(mesh_.divScheme(name)) != "bounded") continue;
        mistakes.push_back({"system/fvSchemes", fmt::format("{} is bounded", name),
                            "With rock div(phi) is not zero and a bounded scheme would make it a source", "Leave out the word bounded"});
    }
    forAll(p_.boundaryField(), patch) {
        if (p_.boundaryField()[patch].type() != zeroGradientFvPatchScalarField::typeName) continue;
        mistakes.push_back({time_.timeName() + "/p", fmt::format("patch {} is zeroGradient", std::string(mesh_.boundary()[patch].name())),
                            "Rock beside a patch puts a force on the fluid, which the pressure's gradient there must balance",
                            "Set: type fixedFluxPressure;"});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

}  // namespace cutterflow::foam
