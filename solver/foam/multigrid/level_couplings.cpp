#include "solver/foam/multigrid/level_couplings.hpp"

#include "cyclicAMIFvPatch.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

/// \param columns  of the other side's faces
void add_sliding(const cyclicAMIFvPatch& patch, const scalarField& coefficients, labelList columns, std::vector<PatchElement>& elements) {
    const AMIPatchToPatchInterpolation& overlap = patch.owner() ? patch.AMI() : patch.neighbPatch().AMI();
    const labelListList& faces = patch.owner() ? overlap.srcAddress() : overlap.tgtAddress();
    const scalarListList& weights = patch.owner() ? overlap.srcWeights() : overlap.tgtWeights();
    if (overlap.singlePatchProc() == -1) (patch.owner() ? overlap.tgtMap() : overlap.srcMap()).distribute(columns);
    const labelUList& cells = patch.faceCells();
    forAll(cells, face) forAll(faces[face], k)
        elements.push_back({cells[face], columns[faces[face][k]], -coefficients[face] * weights[face][k]});
}

}  // namespace

std::vector<PatchElement> patch_elements(const lduMatrix::solver& solver, const globalIndex& cells) {
    labelList numbers(cells.localSize());
    forAll(numbers, cell) numbers[cell] = cells.toGlobal(cell);
    const lduInterfaceFieldPtrsList& patches = solver.interfaces();
    const label earlier = UPstream::nRequests();
    forAll(patches, i) if (patches.set(i)) patches[i].interface().initInternalFieldTransfer(UPstream::commsTypes::nonBlocking, numbers);
    UPstream::waitRequests(earlier);

    std::vector<PatchElement> elements;
    forAll(patches, i) {
        if (!patches.set(i)) continue;
        const lduInterface& patch = patches[i].interface();
        const scalarField& coefficients = solver.interfaceBouCoeffs()[i];
        const labelField columns(patch.internalFieldTransfer(UPstream::commsTypes::nonBlocking, numbers));
        if (isA<cyclicAMIFvPatch>(patch))
            add_sliding(refCast<const cyclicAMIFvPatch>(patch), coefficients, columns, elements);
        else
            forAll(columns, face) elements.push_back({patch.faceCells()[face], columns[face], -coefficients[face]});
    }
    return elements;
}

LevelCouplings::LevelCouplings(const globalIndex& rows, const std::vector<PatchElement>& elements)
    : rows_(static_cast<label>(elements.size())), columns_(rows_.size()), values_(elements.size()), exact_(elements.size()) {
    for (std::size_t k = 0; k < elements.size(); ++k) {
        const auto at = static_cast<label>(k);
        rows_[at] = elements[k].row;
        columns_[at] = elements[k].column;
        values_[k] = static_cast<float>(elements[k].value);
        exact_[k] = elements[k].value;
    }
    if (!UPstream::parRun()) return;
    List<Map<label>> compact;
    exchange_ = std::make_unique<mapDistribute>(rows, columns_, compact);
}

void LevelCouplings::subtract(const std::vector<float>& x, std::vector<float>& r) const {
    List<floatScalar> received;
    if (exchange_) {
        received = UList<floatScalar>(const_cast<float*>(x.data()), static_cast<label>(x.size()));
        exchange_->distribute(received);
    }
    const float* const values = exchange_ ? received.cdata() : x.data();
    for (std::size_t k = 0; k < values_.size(); ++k) {
        const auto at = static_cast<label>(k);
        r[static_cast<std::size_t>(rows_[at])] -= values_[k] * values[columns_[at]];
    }
}

std::vector<PatchElement> LevelCouplings::gather(const std::vector<int>& clusters, int first) const {
    labelList columns(UList<label>(const_cast<int*>(clusters.data()), static_cast<label>(clusters.size())));
    if (exchange_) exchange_->distribute(columns);
    std::vector<PatchElement> elements(values_.size());
    for (std::size_t k = 0; k < elements.size(); ++k) {
        const auto at = static_cast<label>(k);
        elements[k] = {clusters[static_cast<std::size_t>(rows_[at])] - first, columns[columns_[at]], exact_[k]};
    }
    return elements;
}

}  // namespace cutterflow::foam
