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
    : own_(rows.localSize()), rows_(static_cast<label>(elements.size())), columns_(rows_.size()), exact_(elements.size()) {
    for (std::size_t k = 0; k < elements.size(); ++k) {
        const auto at = static_cast<label>(k);
        rows_[at] = elements[k].row;
        columns_[at] = elements[k].column;
        exact_[k] = elements[k].value;
    }
    if (UPstream::parRun()) {
        List<Map<label>> compact;
        exchange_ = std::make_unique<mapDistribute>(rows, columns_, compact);
        make_messages();
    }
    forAll(rows_, k) {
        const bool inside = columns_[k] < own_;
        const auto value = static_cast<float>(exact_[static_cast<std::size_t>(k)]);
        (inside ? inside_ : across_).push_back({rows_[k], inside ? columns_[k] : columns_[k] - own_, value});
    }
}

void LevelCouplings::make_messages() {
    for (int rank = 0; rank < UPstream::nProcs(); ++rank) {
        const labelList& sent = exchange_->subMap()[rank];
        labelList received(exchange_->constructMap()[rank]);
        if (rank == UPstream::myProcNo() || (sent.empty() && received.empty())) continue;
        for (label& slot : received) slot -= own_;
        messages_.push_back({rank, sent, received, std::vector<float>(static_cast<std::size_t>(sent.size())),
                             std::vector<float>(static_cast<std::size_t>(received.size()))});
    }
    received_.resize(static_cast<std::size_t>(exchange_->constructSize() - own_));
}

void LevelCouplings::send(const std::vector<float>& x) const {
    constexpr auto mode = UPstream::commsTypes::nonBlocking;
    const auto bytes = [](const std::vector<float>& values) { return static_cast<std::streamsize>(values.size() * sizeof(float)); };
    first_request_ = UPstream::nRequests();
    for (Messages& with : messages_)
        if (!with.in.empty()) UIPstream::read(mode, with.rank, reinterpret_cast<char*>(with.in.data()), bytes(with.in));
    for (Messages& with : messages_) {
        forAll(with.sent, k) with.out[static_cast<std::size_t>(k)] = x[static_cast<std::size_t>(with.sent[k])];
        if (!with.out.empty()) UOPstream::write(mode, with.rank, reinterpret_cast<const char*>(with.out.data()), bytes(with.out));
    }
}

void LevelCouplings::receive() const {
    UPstream::waitRequests(first_request_);
    for (const Messages& with : messages_)
        forAll(with.received, k) received_[static_cast<std::size_t>(with.received[k])] = with.in[static_cast<std::size_t>(k)];
}

void LevelCouplings::subtract(const std::vector<float>& x, std::vector<float>& r) const {
    const auto take = [&r](const std::vector<Element>& elements, const std::vector<float>& of) {
        for (const Element& element : elements)
            r[static_cast<std::size_t>(element.row)] -= element.value * of[static_cast<std::size_t>(element.column)];
    };
    send(x);
    take(inside_, x);
    receive();
    take(across_, received_);
}

std::vector<PatchElement> LevelCouplings::gather(const std::vector<int>& clusters, int first) const {
    labelList columns(UList<label>(const_cast<int*>(clusters.data()), static_cast<label>(clusters.size())));
    if (exchange_) exchange_->distribute(columns);
    std::vector<PatchElement> elements(exact_.size());
    for (std::size_t k = 0; k < elements.size(); ++k) {
        const auto at = static_cast<label>(k);
        elements[k] = {clusters[static_cast<std::size_t>(rows_[at])] - first, columns[columns_[at]], exact_[k]};
    }
    return elements;
}

}  // namespace cutterflow::foam
