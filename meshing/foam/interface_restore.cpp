/// \file cutterInterfaceRestore: puts the points of the sliding interface back to where blockMesh made them.
///
/// snappyHexMesh lets the points of every patch that it does not snap slip along that patch while it relaxes the mesh. On the interface,
/// a millimetre of that between faces that lay on each other is enough for weights of 0.8 to 1.2. The background mesh is read as the
/// region `background`; an interface patch is restored when it still has the faces and points that it has there.
#include "SubField.H"
#include "Time.H"
#include "argList.H"
#include "matchPoints.H"
#include "polyMesh.H"

#include <fstream>
#include <nlohmann/json.hpp>

namespace {

using namespace Foam;

const polyPatch& patch_of(const polyMesh& mesh, const word& name) {
    const label index = mesh.boundaryMesh().findPatchID(name);
    if (index < 0) FatalErrorInFunction << "The mesh " << mesh.name() << " has no patch " << name << exit(FatalError);
    return mesh.boundaryMesh()[index];
}

/// A fraction below one half of the shortest edge at each point: within it, a drifted point has one candidate only.
scalarField match_distance(const polyPatch& patch) {
    scalarField distance(patch.nPoints(), GREAT);
    for (const edge& e : patch.edges()) {
        const scalar reach = 0.45 * e.mag(patch.localPoints());
        distance[e.start()] = min(distance[e.start()], reach);
        distance[e.end()] = min(distance[e.end()], reach);
    }
    return distance;
}

/// Overwrites the patch's points in `points`. Says whether the patch still has the faces of the background and could be restored, and the
/// largest drift that was undone [m]. A patch that has not is left alone: the caller's gate reads why.
nlohmann::json restore(const polyPatch& drifted, const polyPatch& original, pointField& points) {
    nlohmann::json report = {{"faces", drifted.size()}, {"background_faces", original.size()}, {"restored", false}, {"drift_max_m", 0.0}};
    if (drifted.size() != original.size() || drifted.nPoints() != original.nPoints()) return report;
    labelList original_of;
    if (!matchPoints(drifted.localPoints(), original.localPoints(), match_distance(drifted), false, original_of)) return report;
    scalar drift = 0;
    forAll(original_of, i) {
        point& p = points[drifted.meshPoints()[i]];
        const point& target = original.localPoints()[original_of[i]];
        drift = max(drift, mag(p - target));
        p = target;
    }
    report["restored"] = true;
    report["drift_max_m"] = drift;
    return report;
}

}  // namespace

int main(int argc, char* argv[]) {
    argList::addNote("Puts the points of the given patches back to where they are in the region background.");
    argList::noFunctionObjects();
    argList::noParallel();
    argList::addOption("patches", "list", "patches of both meshes, such as '(rotor_side stator_side)'");
    argList::addOption("output", "file", "JSON file to write");
    argList args(argc, argv);

    Time run_time(Time::controlDictName, args);
    polyMesh mesh(IOobject(polyMesh::defaultRegion, run_time.constant(), run_time, IOobject::MUST_READ));
    const polyMesh background(IOobject("background", run_time.constant(), run_time, IOobject::MUST_READ));

    pointField points = mesh.points();
    nlohmann::json report;
    for (const word& name : args.opt<wordList>("patches")) report[name] = restore(patch_of(mesh, name), patch_of(background, name), points);
    mesh.movePoints(points);
    mesh.setInstance(run_time.constant());
    mesh.removeFiles(run_time.constant());
    if (!mesh.write()) FatalErrorInFunction << "Cannot write the mesh" << exit(FatalError);

    std::ofstream file(args.opt<fileName>("output"));
    file << report.dump(1) << '\n';
    file.close();
    if (!file) FatalErrorInFunction << "Cannot write " << args.opt<fileName>("output") << exit(FatalError);
    Info << "End" << endl;
    return 0;
}
