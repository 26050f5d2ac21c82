#include "solver/foam/single_phase/cutter_fluid.hpp"

#include <fmt/format.h>

#include "geometry/base/error.hpp"

#include "zeroGradientFvPatchFields.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

/// Names of the rotating reference frames that are on.
std::vector<std::string> active_frames(const fvMesh& mesh) {
    IOobject file("MRFProperties", mesh.time().constant(), mesh, IOobject::MUST_READ, IOobject::NO_WRITE, false);
    std::vector<std::string> names;
    if (!file.typeHeaderOk<IOdictionary>(true)) return names;
    for (const entry& zone : IOdictionary(file))
        if (zone.isDict() && zone.dict().lookupOrDefault("active", true)) names.push_back(zone.keyword());
    return names;
}

}  // namespace

void CutterFluid::require_supported_case() const {
    std::vector<Mistake> mistakes;
    for (const std::string& zone : active_frames(mesh_))
        mistakes.push_back({"constant/MRFProperties", zone, "cutterFoam knows no rotating reference frame: a rotor turns with its mesh",
                            "Turn the zone by constant/dynamicMeshDict, or set: active no;"});
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

void CutterFluid::require_case_for_rock() const {
    std::vector<Mistake> mistakes;
    for (const fv::option& source : sources_) {
        if (source.applyToField(U_.name()) < 0) continue;
        mistakes.push_back(
            {"fvOptions",
             fmt::format("{} of type {} acts on {}", std::string(source.name()), std::string(source.type()), std::string(U_.name())),
             "Rock feels the fluid's acceleration as a stress, and a source in the fluid's momentum is none",
             "Leave it out with rock; sources in turbulence fields are taken"});
    }
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
