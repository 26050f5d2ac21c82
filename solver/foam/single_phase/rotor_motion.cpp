#include "solver/foam/single_phase/rotor_motion.hpp"

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/head/head_names.hpp"
#include "solver/foam/session/foam_conversions.hpp"

#include "Function1.H"
#include "IOdictionary.H"
#include "dynamicFvMesh.H"

namespace cutterflow::foam {
namespace {

const char* const k_rule = "cutterFoam turns cell zone rotor by one rotatingMotion of constant omega";
const char* const k_remedy =
    "Use dynamicFvMesh dynamicMotionSolverFvMesh; motionSolver solidBody; cellZone rotor; solidBodyMotionFunction rotatingMotion; with "
    "origin, axis and omega [rad/s], or staticFvMesh for a rotor at rest";

void require(bool holds, const std::string& what) {
    if (!holds) throw UserError("constant/dynamicMeshDict: " + what, k_rule, k_remedy);
}

void require_word(const Foam::dictionary& dict, const Foam::word& key, const Foam::word& expected) {
    const Foam::word found = dict.lookupOrDefault<Foam::word>(key, "none");
    require(found == expected, fmt::format("{} = {}", std::string(key), std::string(found)));
}

coupling::RotorMotion read_rotating_motion(const Foam::dictionary& dict) {
    const auto omega = Foam::Function1<Foam::scalar>::New("omega", dict);
    require(omega->type() == "constant", fmt::format("omega is of type {}", std::string(omega->type())));
    coupling::RotorMotion motion;
    motion.axis.origin = to_vec3(dict.get<Foam::vector>("origin"));
    motion.axis.direction = to_vec3(dict.get<Foam::vector>("axis")).normalized();
    motion.speed = omega->value(0.0);
    return motion;
}

}  // namespace

coupling::RotorMotion read_rotor_motion(const Foam::dynamicFvMesh& mesh) {
    if (!mesh.dynamic()) return {};
    const Foam::IOdictionary dict(
        Foam::IOobject("dynamicMeshDict", mesh.time().constant(), mesh, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false));
    require_word(dict, "dynamicFvMesh", "dynamicMotionSolverFvMesh");
    require_word(dict, dict.found("motionSolver") ? "motionSolver" : "solver", "solidBody");
    const Foam::dictionary& body = dict.optionalSubDict("solidBodyCoeffs");
    require_word(body, "cellZone", names::rotor_zone);
    require_word(body, "solidBodyMotionFunction", "rotatingMotion");
    return read_rotating_motion(body.optionalSubDict("rotatingMotionCoeffs"));
}

}  // namespace cutterflow::foam
