#include "solver/foam/mesh_motion/overlap_flux.hpp"

#include <algorithm>

#include "solver/foam/mesh_motion/edit.hpp"

#include "mapDistribute.H"
#include "surfaceFields.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

AMIPatchToPatchInterpolation& overlap_of(const cyclicAMIFvPatch& patch) {
    return edit(patch.owner() ? patch.AMI() : patch.neighbPatch().AMI());
}

scalarListList& weights_of(const cyclicAMIFvPatch& patch) {
    return patch.owner() ? overlap_of(patch).srcWeights() : overlap_of(patch).tgtWeights();
}

}  // namespace

OverlapSide::OverlapSide(const fvMesh& mesh, label patch, const std::vector<std::vector<vector>>& areas)
    : patch_(refCast<const cyclicAMIFvPatch>(mesh.boundary()[patch])) {
    const AMIPatchToPatchInterpolation& overlap = overlap_of(patch_);
    if (overlap.singlePatchProc() == -1) map_ = patch_.owner() ? &overlap.tgtMap() : &overlap.srcMap();
    const labelListList& slots = patch_.owner() ? overlap.srcAddress() : overlap.tgtAddress();
    const cyclicAMIFvPatch& other = patch_.neighbPatch();
    const scalarField near(patch_.nf() & patch_.coupledFvPatch::delta());
    const scalarField far(gathered(scalarField(other.nf() & other.coupledFvPatch::delta())));
    const vectorField centres(beyond(mesh.C().primitiveField()));

    label parts = 0;
    for (const labelList& of_face : slots) parts += of_face.size();
    for (labelList* list : {&face_, &cell_, &slot_}) list->resize(parts);
    for (scalarField* field : {&weight_, &strength_}) field->resize(parts);
    for (vectorField* field : {&area_, &rest_}) field->resize(parts);
    label k = 0;
    forAll(slots, face) forAll(slots[face], part) {
        face_[k] = face;
        cell_[k] = patch_.faceCells()[face];
        slot_[k] = slots[face][part];
        area_[k] = areas[static_cast<std::size_t>(face)][static_cast<std::size_t>(part)];
        const vector distance = centres[slot_[k]] - mesh.C()[cell_[k]];
        const scalar size = mag(area_[k]);
        strength_[k] = size / max(area_[k] / size & distance, 0.05 * mag(distance));
        rest_[k] = area_[k] - strength_[k] * distance;
        weight_[k] = far[slot_[k]] / (near[face] + far[slot_[k]]);
        ++k;
    }
}

tmp<scalarField> OverlapSide::difference(const scalarField& of_cells) const {
    const scalarField values(beyond(of_cells));
    auto result = tmp<scalarField>::New(cell_.size());
    scalarField& differences = result.ref();
    forAll(differences, k) differences[k] = values[slot_[k]] - of_cells[cell_[k]];
    return result;
}

tmp<scalarField> OverlapSide::sum(const scalarField& of_parts) const {
    auto result = tmp<scalarField>::New(patch_.size(), Zero);
    scalarField& sums = result.ref();
    forAll(of_parts, k) sums[face_[k]] += of_parts[k];
    return result;
}

tmp<scalarField> OverlapSide::sum_beyond(const scalarField& of_parts) const {
    const label faces = patch_.neighbPatch().size();
    auto result = tmp<scalarField>::New(map_ != nullptr ? map_->constructSize() : faces, Zero);
    scalarField& sums = result.ref();
    forAll(of_parts, k) sums[slot_[k]] += of_parts[k];
    if (map_ != nullptr) {
        mapDistributeBase::distribute(UPstream::commsTypes::nonBlocking, List<labelPair>(), faces, map_->constructMap(), false,
                                      map_->subMap(), false, sums, plusEqOp<scalar>(), flipOp(), scalar(0));
    }
    return result;
}

scalarListList OverlapSide::shares(const scalarField& of_parts) const {
    const scalarField whole(sum(of_parts));
    scalarListList result(weights_of(patch_));
    label k = 0;
    forAll(result, face) for (scalar& share : result[face]) share = of_parts[k++] / whole[face];
    return result;
}

void OverlapFlux::couple(const SlidingOverlap& overlap) {
    sides_.clear();
    for (const PartAreas& areas : overlap.areas()) {
        sides_.push_back({{mesh_, areas.patches.owner, areas.owner}, {}, {}, {}});
        sides_.push_back({{mesh_, areas.patches.neighbour, areas.neighbour}, {}, {}, {}});
    }
}

bool OverlapFlux::has(label patch) const {
    return std::any_of(sides_.begin(), sides_.end(), [patch](const PartFluxes& of_side) { return of_side.side.patch() == patch; });
}

OverlapFlux::InMatrix::InMatrix(OverlapFlux& flux) : flux_(flux) {
    for (const PartFluxes& of_side : flux_.sides_) {
        weights_.push_back(of_side.side.shares(of_side.conductance));
        corrections_.emplace_back(flux_.mesh_.boundary()[of_side.side.patch()].size(), Zero);
    }
    swap();
}

OverlapFlux::InMatrix::~InMatrix() {
    swap();
}

void OverlapFlux::InMatrix::swap() {
    for (std::size_t i = 0; i < weights_.size(); ++i) {
        const label patch = flux_.sides_[i].side.patch();
        weights_of(refCast<const cyclicAMIFvPatch>(flux_.mesh_.boundary()[patch])).swap(weights_[i]);
        corrections_[i].swap(edit(flux_.mesh_.nonOrthCorrectionVectors()).boundaryFieldRef()[patch]);
    }
}

}  // namespace cutterflow::foam
