#include "solver/foam/mesh_motion/moving_zones.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "solver/foam/session/foam_conversions.hpp"

#include "Function1.H"
#include "IOdictionary.H"
#include "bitSet.H"
#include "cellSet.H"
#include "dynamicMotionSolverFvMesh.H"
#include "points0MotionSolver.H"

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

/// Points may lie this share of the zone's radius off: files hold six digits and more.
constexpr double k_place_tolerance = 1e-4;

/// Rock, walls and recordings turn with the zone by its angle at the present time; a mesh that stands at another one would be off for the
/// whole run. Collective.
void require_at_its_angle(const Foam::dynamicFvMesh& mesh, const coupling::ZoneMotion& motion, const Foam::labelList& cells) {
    const auto& solver = Foam::refCast<const Foam::dynamicMotionSolverFvMesh>(mesh).motion();
    const Foam::pointField& start = Foam::refCast<const Foam::points0MotionSolver>(solver).points0();
    const double time = mesh.time().value(), angle = motion.angle(time);
    Foam::bitSet turning(mesh.nPoints());
    for (const Foam::label cell : cells)
        for (const Foam::label face : mesh.cells()[cell]) turning.set(mesh.faces()[face]);
    double offset = 0.0, radius = 0.0;  // largest [m]
    for (const Foam::label point : turning.sortedToc()) {
        const Vec3 there = to_vec3(start[point]);
        offset = std::max(offset, (rotate_about(motion.axis, angle, there) - to_vec3(mesh.points()[point])).norm());
        radius = std::max(radius, motion.axis.direction.cross(there - motion.axis.origin).norm());
    }
    Foam::reduce(offset, Foam::maxOp<Foam::scalar>());
    Foam::reduce(radius, Foam::maxOp<Foam::scalar>());
    if (offset <= k_place_tolerance * radius) return;
    throw UserError(fmt::format("at time {:.9g} s the mesh of zone {} stands {:.3g} m beside where omega = {:.6g} rad/s turns it", time,
                                motion.name, offset, motion.speed),
                    "A zone has turned by omega times the time, from where it stands in constant/polyMesh",
                    "Start at time 0, or from a time folder that was reached with this omega and holds polyMesh/points");
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
    const Foam::labelList cells = moving_cells(mesh, body, motion.name);
    require_at_its_angle(mesh, motion, cells);
    for (const Foam::label cell : cells) zones.of_cells[static_cast<std::size_t>(cell)] = 1;
    zones.motion.push_back(std::move(motion));
    return zones;
}

}  // namespace cutterflow::foam
