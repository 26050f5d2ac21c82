#pragma once
/// \file What passes through each part that two faces of a sliding interface share.
#include <vector>

#include "solver/foam/mesh_motion/sliding_overlap.hpp"

#include "cyclicAMIFvPatch.H"
#include "volFields.H"

namespace cutterflow::foam {

/// The parts of the faces of one patch of a sliding interface, each between an own cell P and a cell N of the other side:
///
///   s    area vector out of P, of the other side -s                                                [m2]
///   c    |s| / (n.d),  n = s/|s|,  d = x_N - x_P                                                      [m]
///   t    s - c d,  what the difference of N and P does not see of a gradient                         [m2]
///   w    share of P in the linear mean, by the distances of both centres from their faces
///
/// All follow from both cells by the same formulas on either side, so that a flux made of them is the other side's with the other sign.
/// Arrays have one entry per part. Collective, patch by patch in the same order.
class OverlapSide {
public:
    OverlapSide(const Foam::fvMesh& mesh, Foam::label patch, const std::vector<std::vector<Foam::vector>>& areas);

    Foam::label patch() const { return patch_.index(); }
    const Foam::vectorField& area() const { return area_; }          ///< s
    const Foam::scalarField& strength() const { return strength_; }  ///< c
    const Foam::vectorField& rest() const { return rest_; }          ///< t

    /// w of P's value and 1 - w of N's.
    template <class Type>
    Foam::tmp<Foam::Field<Type>> mean(const Foam::Field<Type>& of_cells) const {
        const Foam::Field<Type> values(beyond(of_cells));
        auto result = Foam::tmp<Foam::Field<Type>>::New(cell_.size());
        Foam::Field<Type>& means = result.ref();
        forAll(means, k) means[k] = weight_[k] * of_cells[cell_[k]] + (1.0 - weight_[k]) * values[slot_[k]];
        return result;
    }

    /// N's value less P's.
    Foam::tmp<Foam::scalarField> difference(const Foam::scalarField& of_cells) const;

    /// Sum over the parts of each face.
    Foam::tmp<Foam::scalarField> sum(const Foam::scalarField& of_parts) const;

    /// Sum over the parts of each face of the other side, of this side's values.
    Foam::tmp<Foam::scalarField> sum_beyond(const Foam::scalarField& of_parts) const;

    /// Of each part in the sum of its face, in the form of an overlap's weights.
    Foam::scalarListList shares(const Foam::scalarField& of_parts) const;

private:
    /// Values of the other side's cells at slot_.
    template <class Type>
    Foam::Field<Type> beyond(const Foam::Field<Type>& of_cells) const {
        return gathered(Foam::Field<Type>(of_cells, patch_.neighbPatch().faceCells()));
    }
    template <class Type>
    Foam::Field<Type> gathered(Foam::Field<Type> of_faces) const {
        if (map_ != nullptr) map_->distribute(of_faces);
        return of_faces;
    }

    const Foam::cyclicAMIFvPatch& patch_;
    const Foam::mapDistribute* map_ = nullptr;  ///< of the other side's faces to slots; null: all on this rank
    Foam::labelList face_, cell_, slot_;
    Foam::scalarField weight_, strength_;
    Foam::vectorField area_, rest_;
};

/// Fluxes through the parts of one side.
struct PartFluxes {
    OverlapSide side;
    Foam::scalarField predicted;    ///< without pressure [m3/s]
    Foam::scalarField conductance;  ///< flux per difference of pressure [m s]
    Foam::scalarField flux;         ///< out of the own cells [m3/s]
};

/// One flux for each part: mass that leaves a cell on one side enters the cell on the other.
///
/// The pressure's coefficients of a part are the same number on both sides. While a solution is under way the overlaps have them as their
/// weights, by which OpenFOAM's matrix becomes symmetric.
class OverlapFlux {
public:
    explicit OverlapFlux(Foam::fvMesh& mesh) : mesh_(mesh) {}

    /// Takes the parts as they are now; anew whenever the overlaps are made anew. Collective.
    void couple(const SlidingOverlap& overlap);

    std::vector<PartFluxes>& sides() { return sides_; }
    const std::vector<PartFluxes>& sides() const { return sides_; }
    bool has(Foam::label patch) const;

    /// Has the pressure's coefficients in the place of the overlaps' weights and no correction for skew distances while it lives.
    class InMatrix {
    public:
        explicit InMatrix(OverlapFlux& flux);
        ~InMatrix();
        InMatrix(const InMatrix&) = delete;
        InMatrix& operator=(const InMatrix&) = delete;

    private:
        void swap();

        OverlapFlux& flux_;
        std::vector<Foam::scalarListList> weights_;
        std::vector<Foam::vectorField> corrections_;
    };

private:
    Foam::fvMesh& mesh_;
    std::vector<PartFluxes> sides_;
};

}  // namespace cutterflow::foam
