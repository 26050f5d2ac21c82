/// \file cutterMeshProbe: figures of a rotor mesh that checkMesh does not report: volumes of the zones, areas of the patches, cell sizes,
/// and the weights of the sliding interface at given rotor angles.
///
/// For the weights it turns the rotor's points about the z axis and lets the cyclicAMI patches recompute them, as a moving-mesh run would.
/// A weight is the part of a face that the other side covers; the interpolation divides by it, so that a weight away from 1 is a wrong
/// flux and a weight near 0 a division by zero.
#include "SubField.H"
#include "Time.H"
#include "argList.H"
#include "cyclicAMIPolyPatch.H"
#include "polyMesh.H"
#include "processorPolyPatch.H"
#include "transform.H"

#include <fstream>
#include <nlohmann/json.hpp>

#include "geometry/head/head_names.hpp"

namespace {

using namespace Foam;
using nlohmann::json;

const cyclicAMIPolyPatch& interface_patch(const polyMesh& mesh, const char* name) {
    const label index = mesh.boundaryMesh().findPatchID(name);
    if (index < 0 || !isA<cyclicAMIPolyPatch>(mesh.boundaryMesh()[index]))
        FatalErrorInFunction << "The mesh has no cyclicAMI patch " << name << exit(FatalError);
    return refCast<const cyclicAMIPolyPatch>(mesh.boundaryMesh()[index]);
}

labelList rotor_points(const polyMesh& mesh) {
    const label index = mesh.cellZones().findZoneID(cutterflow::names::rotor_zone);
    if (index < 0) FatalErrorInFunction << "The mesh has no cellZone " << cutterflow::names::rotor_zone << exit(FatalError);
    labelHashSet points;
    for (const label cell : mesh.cellZones()[index]) points.insert(mesh.cellPoints(cell));
    return points.sortedToc();
}

json zones_report(const polyMesh& mesh) {
    json report = json::object();
    for (const cellZone& zone : mesh.cellZones()) {
        const scalarField volumes(mesh.cellVolumes(), zone);
        report[zone.name()] = {{"cells", returnReduce(zone.size(), sumOp<label>())}, {"volume_m3", gSum(volumes)}};
    }
    return report;
}

/// Faces, area and the mean size of the cells behind the faces, per patch.
json patches_report(const polyMesh& mesh) {
    json report = json::object();
    for (const polyPatch& patch : mesh.boundaryMesh()) {
        const label faces = returnReduce(patch.size(), sumOp<label>());
        if (faces == 0 || isA<processorPolyPatch>(patch)) continue;
        const scalarField area(mag(patch.faceAreas()));
        const scalarField volumes(mesh.cellVolumes(), patch.faceCells());
        const scalar size = gSum(cbrt(mag(volumes))) / faces;
        report[patch.name()] = {{"faces", faces}, {"area_m2", gSum(area)}, {"cell_size_mean_m", size}, {"type", patch.type()}};
    }
    return report;
}

/// Range and area-weighted mean of one side's weights.
json weights_report(const cyclicAMIPolyPatch& patch, const scalarField& weights) {
    const scalarField area(mag(patch.faceAreas()));
    return {{"min", gMin(weights)}, {"max", gMax(weights)}, {"mean", gSum(weights * area) / gSum(area)}};
}

json interface_report(const polyMesh& mesh) {
    const auto& rotor = interface_patch(mesh, cutterflow::names::rotor_interface_patch);
    const auto& stator = interface_patch(mesh, cutterflow::names::stator_interface_patch);
    const auto& ami = rotor.owner() ? rotor.AMI() : stator.AMI();
    return {{"rotor", weights_report(rotor, rotor.owner() ? ami.srcWeightsSum() : ami.tgtWeightsSum())},
            {"stator", weights_report(stator, rotor.owner() ? ami.tgtWeightsSum() : ami.srcWeightsSum())}};
}

}  // namespace

int main(int argc, char* argv[]) {
    argList::addNote(
        "Zones, patches and cell sizes of a rotor mesh, and the weights of its interface while the cell zone rotor turns about z.");
    argList::noFunctionObjects();
    argList::addOption("angles", "list", "rotor angles in radians, such as '(0 0.01 0.02)'");
    argList::addOption("output", "file", "JSON file to write");
    argList args(argc, argv);
    const scalarList angles = args.opt<scalarList>("angles");

    Time run_time(Time::controlDictName, args);
    polyMesh mesh(IOobject(polyMesh::defaultRegion, run_time.timeName(), run_time, IOobject::MUST_READ));

    json report = {{"cells", returnReduce(mesh.nCells(), sumOp<label>())},
                   {"volume_min_m3", gMin(mesh.cellVolumes())},
                   {"volume_max_m3", gMax(mesh.cellVolumes())},
                   {"zones", zones_report(mesh)},
                   {"patches", patches_report(mesh)},
                   {"interface", json::array()}};
    const pointField start = mesh.points();
    const labelList turning = rotor_points(mesh);
    for (const scalar angle : angles) {
        const tensor turn = Rz(angle);
        pointField points = start;
        for (const label point : turning) points[point] = transform(turn, start[point]);
        mesh.movePoints(points);
        json position = interface_report(mesh);
        position["angle_rad"] = angle;
        report["interface"].push_back(position);
    }

    if (Pstream::master()) {
        std::ofstream file(args.opt<fileName>("output"));
        file << report.dump(1) << '\n';
        file.close();
        if (!file) FatalErrorInFunction << "Cannot write " << args.opt<fileName>("output") << exit(FatalError);
    }
    Info << "End" << endl;
    return 0;
}
