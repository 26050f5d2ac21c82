#include "solver/foam/mesh_motion/sliding_overlap.hpp"

#include <optional>

#include "solver/foam/mesh_motion/edit.hpp"
#include "solver/foam/session/foam_conversions.hpp"

#include "fvMesh.H"
#include "mapDistribute.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

/// The overlap that a patch keeps.
struct OpenPatch : cyclicAMIPolyPatch {
    static autoPtr<AMIPatchToPatchInterpolation>& overlap_of(const cyclicAMIPolyPatch& patch) { return edit(patch.*(&OpenPatch::AMIPtr_)); }
};

const cyclicAMIPolyPatch& patch_of(const fvMesh& mesh, label patch) {
    return refCast<const cyclicAMIPolyPatch>(mesh.boundaryMesh()[patch]);
}

/// Corners of a patch's faces, of all ranks in turn. Collective.
std::vector<RevolutionOverlap::Face> faces_of(const polyPatch& patch) {
    List<List<pointField>> corners(Pstream::nProcs());
    List<pointField>& own = corners[Pstream::myProcNo()];
    own.resize(patch.size());
    forAll(patch, face) own[face] = patch[face].points(patch.points());
    Pstream::gatherList(corners);
    Pstream::scatterList(corners);
    std::vector<RevolutionOverlap::Face> faces;
    for (const List<pointField>& of_rank : corners) {
        for (const pointField& face : of_rank) {
            const auto points = view(face);
            faces.emplace_back(points.begin(), points.end());
        }
    }
    return faces;
}

/// Whether all faces of a patch are of turning cells, or none; neither: no value. Collective.
std::optional<bool> turns(const polyPatch& patch, const MovingZones& zones) {
    label turning = 0;
    for (const label cell : patch.faceCells()) turning += zones.of_cells[static_cast<std::size_t>(cell)] != 0 ? 1 : 0;
    const label faces = returnReduce(patch.size(), sumOp<label>());
    reduce(turning, sumOp<label>());
    if (turning != 0 && turning != faces) return std::nullopt;
    return turning != 0;
}

/// What each face of one side has of the other's.
struct SideOverlap {
    labelListList faces;  ///< of the other side, over all ranks
    scalarListList shares;
    std::vector<std::vector<vector>> areas;

    explicit SideOverlap(label size) : faces(size), shares(size), areas(static_cast<std::size_t>(size)) {
        for (std::vector<vector>& of_face : areas) of_face.reserve(4);
    }
    void add(label own, label other, scalar share, const vector& area) {
        faces[own].append(other);
        shares[own].append(share);
        areas[static_cast<std::size_t>(own)].push_back(area);
    }
};

}  // namespace

SlidingOverlap::SlidingOverlap(const fvMesh& mesh, const MovingZones& zones, double angle) : mesh_(mesh), base_angle_(angle) {
    for (const InterfacePair& pair : interface_pairs(mesh)) add(pair, zones);
}

void SlidingOverlap::add(const InterfacePair& patches, const MovingZones& zones) {
    const cyclicAMIPolyPatch &owner = patch_of(mesh_, patches.owner), &neighbour = patch_of(mesh_, patches.neighbour);
    const std::optional<bool> owner_turns = turns(owner, zones), neighbour_turns = turns(neighbour, zones);
    if (!owner_turns || !neighbour_turns || *owner_turns == *neighbour_turns || !owner.parallel() || owner.separated()) return;
    const auto of_owner = faces_of(owner), of_neighbour = faces_of(neighbour);
    auto overlap = RevolutionOverlap::between(*owner_turns ? of_neighbour : of_owner, *owner_turns ? of_owner : of_neighbour,
                                              zones.motion.front().axis);
    if (!overlap) return;
    interfaces_.push_back({patches, *owner_turns, globalIndex(owner.size()), globalIndex(neighbour.size()), std::move(*overlap)});
}

void SlidingOverlap::take() {
    for (Interface& interface : interfaces_) {
        const cyclicAMIPolyPatch& owner = patch_of(mesh_, interface.patches.owner);
        owner.AMI();  // made by OpenFOAM when it is asked for the first time
        interface.taken.reset(OpenPatch::overlap_of(owner).release());
    }
}

void SlidingOverlap::put_back() {
    for (Interface& interface : interfaces_)
        OpenPatch::overlap_of(patch_of(mesh_, interface.patches.owner)).reset(interface.taken.release());
}

void SlidingOverlap::set(double angle) {
    areas_.clear();
    for (const Interface& interface : interfaces_) {
        const globalIndex &owner = interface.owner_faces, &neighbour = interface.neighbour_faces;
        SideOverlap of_owner(owner.localSize()), of_neighbour(neighbour.localSize());
        for (const FaceOverlap& overlap : interface.overlap.at(angle - base_angle_)) {
            auto of_first = static_cast<label>(overlap.still), of_second = static_cast<label>(overlap.turned);
            scalar first_share = overlap.of_still, second_share = overlap.of_turned;
            vector area = to_foam(overlap.area);
            if (interface.owner_turns) {
                std::swap(of_first, of_second);
                std::swap(first_share, second_share);
                area = -area;
            }
            if (owner.isLocal(of_first)) of_owner.add(owner.toLocal(of_first), of_second, first_share, area);
            if (neighbour.isLocal(of_second)) of_neighbour.add(neighbour.toLocal(of_second), of_first, second_share, -area);
        }
        if (interface.overlap.pairs_areas())
            areas_.push_back({interface.patches, std::move(of_owner.areas), std::move(of_neighbour.areas)});

        AMIPatchToPatchInterpolation& overlap = edit(patch_of(mesh_, interface.patches.owner).AMI());
        if (overlap.singlePatchProc() == -1) {
            List<Map<label>> compact;
            mapDistribute from_owner(owner, of_neighbour.faces, compact), from_neighbour(neighbour, of_owner.faces, compact);
            edit(overlap.srcMap()).transfer(from_owner);
            edit(overlap.tgtMap()).transfer(from_neighbour);
        }
        overlap.srcAddress().transfer(of_owner.faces);
        overlap.srcWeights().transfer(of_owner.shares);
        overlap.srcWeightsSum() = scalarField(owner.localSize(), 1.0);
        overlap.tgtAddress().transfer(of_neighbour.faces);
        overlap.tgtWeights().transfer(of_neighbour.shares);
        overlap.tgtWeightsSum() = scalarField(neighbour.localSize(), 1.0);
    }
}

}  // namespace cutterflow::foam
