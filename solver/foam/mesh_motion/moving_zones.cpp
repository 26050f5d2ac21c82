#include "solver/foam/mesh_motion/moving_zones.hpp"

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "solver/foam/session/foam_conversions.hpp"

#include "Function1.H"
#include "IOdictionary.H"
#include "cellSet.H"
#include "dynamicFvMesh.H"

namespace cutterflow::foam {
namespace {

const char* const k_file = "constant/dynamicMeshDict";
const char* const k_rule = "cutterFoam turns one zone of the mesh by rotatingMotion of constant omega";
const char* const k_remedy =
    "Use dynamicFvMesh dynamicMotionSolverFvMesh; motionSolver solidBody; cellZone <name>; solidBodyMotionFunction rotatingMotion; with "
    "origin, axis and omega [rad/s], or staticFvMesh for a mesh that stands still";

void require(bool holds, const std::string& what) {
    if (!holds) throw UserError(std::string(k_file) + ": " + what, k_rule, k_remedy);
}

void require_word(const Foam::dictionary& dict, const Foam::word& key, const Foam::word& expected) {
    const Foam::word found = dict.lookupOrDefault<Foam::word>(key, "none");
    require(found == expected, fmt::format("{} = {}", std::string(key), std::string(found)));
}

coupling::ZoneMotion read_rotating_motion(const Foam::dictionary& dict) {
    const auto omega = Foam::Function1<Foam::scalar>::New("omega", dict);
    require(omega->type() == "constant", fmt::format("omega is of type {}", std::string(omega->type())));
    const Foam::vector axis = dict.get<Foam::vector>("axis");
    require(Foam::mag(axis) > 0.0, "axis has no length");
    coupling::ZoneMotion motion;
    motion.axis.origin = to_vec3(dict.get<Foam::vector>("origin"));
    motion.axis.direction = to_vec3(axis).normalized();
    motion.speed = omega->value(0.0);
    return motion;
}

/// Cells that turn, and what they are called. OpenFOAM takes "none" for no zone or set.
Foam::labelList moving_cells(const Foam::dynamicFvMesh& mesh, const Foam::dictionary& body, std::string& name) {
    const Foam::word zone = body.lookupOrDefault<Foam::word>("cellZone", "none");
    const Foam::word set = body.lookupOrDefault<Foam::word>("cellSet", "none");
    if (zone != "none") {
        name = zone;
        const Foam::label number = mesh.cellZones().findZoneID(zone);
        if (number < 0) {
            std::string known;
            for (const Foam::word& other : mesh.cellZones().names()) known += (known.empty() ? "" : ", ") + other;
            throw UserError(fmt::format("{}: the mesh has no cellZone {}", k_file, name),
                            "Cell zones are: " + (known.empty() ? "none" : known), "Name one of them, or make the zone with topoSet");
        }
        return mesh.cellZones()[number];
    }
    if (set != "none") {
        name = set;
        return Foam::cellSet(mesh, set).sortedToc();
    }
    name = "the whole mesh";
    return Foam::identity(mesh.nCells());
}

}  // namespace

MovingZones read_moving_zones(const Foam::dynamicFvMesh& mesh) {
    MovingZones zones;
    zones.of_cells.assign(static_cast<std::size_t>(mesh.nCells()), 0);
    if (!mesh.dynamic()) return zones;
    const Foam::IOdictionary dict(
        Foam::IOobject("dynamicMeshDict", mesh.time().constant(), mesh, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false));
    require_word(dict, "dynamicFvMesh", "dynamicMotionSolverFvMesh");
    require_word(dict, dict.found("motionSolver") ? "motionSolver" : "solver", "solidBody");
    const Foam::dictionary& body = dict.optionalSubDict("solidBodyCoeffs");
    require_word(body, "solidBodyMotionFunction", "rotatingMotion");
    coupling::ZoneMotion motion = read_rotating_motion(body.optionalSubDict("rotatingMotionCoeffs"));
    for (const Foam::label cell : moving_cells(mesh, body, motion.name)) zones.of_cells[static_cast<std::size_t>(cell)] = 1;
    zones.motion.push_back(std::move(motion));
    return zones;
}

}  // namespace cutterflow::foam
