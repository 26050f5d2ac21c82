#include "solver/foam/mesh_motion/sliding_interface.hpp"

#include <cmath>

#include "solver/foam/mesh_motion/overlap_flux.hpp"

#include "cyclicAMIFvPatch.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

/// Of the faces of one side: sum |phi_f + flow through the parts of the other side's faces that overlap f|.
double mismatch_of_side(const surfaceScalarField& flux, const cyclicAMIFvPatch& side) {
    const cyclicAMIFvPatch& other = side.neighbPatch();
    const scalarField of_other(side.interpolate(scalarField(flux.boundaryField()[other.index()] / other.magSf())));
    return sum(mag(flux.boundaryField()[side.index()] + side.magSf() * of_other));
}

/// Of the faces of all sides: sum |phi_f + what the other side has as flow through its parts with f|.
double mismatch_of_parts(const surfaceScalarField& flux, const OverlapFlux& parts) {
    double mismatch = 0.0;
    for (const PartFluxes& part : parts.sides()) {
        const label other = refCast<const cyclicAMIFvPatch>(flux.mesh().boundary()[part.side.patch()]).neighbPatchID();
        mismatch += sum(mag(flux.boundaryField()[other] + part.side.sum_beyond(part.flux)));
    }
    return mismatch;
}

}  // namespace

std::vector<InterfacePair> interface_pairs(const fvMesh& mesh) {
    std::vector<InterfacePair> pairs;
    for (const fvPatch& patch : mesh.boundary()) {
        const auto* side = isA<cyclicAMIFvPatch>(patch) ? &refCast<const cyclicAMIFvPatch>(patch) : nullptr;
        if (side != nullptr && side->owner()) pairs.push_back({patch.index(), side->neighbPatchID()});
    }
    return pairs;
}

std::vector<label> interface_patches(const fvMesh& mesh) {
    std::vector<label> patches;
    for (const InterfacePair& pair : interface_pairs(mesh)) patches.insert(patches.end(), {pair.owner, pair.neighbour});
    return patches;
}

InterfaceFlow interface_flow(const surfaceScalarField& flux, const OverlapFlux* parts) {
    InterfaceFlow flow;
    for (const InterfacePair& pair : interface_pairs(flux.mesh())) {
        double net = 0.0;
        for (const label patch : {pair.owner, pair.neighbour}) {
            net += sum(flux.boundaryField()[patch]);
            flow.gross += sum(mag(flux.boundaryField()[patch]));
            if (parts == nullptr || !parts->has(patch))
                flow.mismatch += 0.5 * mismatch_of_side(flux, refCast<const cyclicAMIFvPatch>(flux.mesh().boundary()[patch]));
        }
        reduce(net, sumOp<scalar>());
        flow.net += net;
        flow.imbalance += std::abs(net);
    }
    if (parts != nullptr) flow.mismatch += 0.5 * mismatch_of_parts(flux, *parts);
    reduce(flow.gross, sumOp<scalar>());
    reduce(flow.mismatch, sumOp<scalar>());
    return flow;
}

}  // namespace cutterflow::foam
