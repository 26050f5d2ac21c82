#pragma once
/// \file The part of a level's matrix that couples its rows across patches. Only for .cpp files of this folder.
#include <memory>
#include <vector>

#include "globalIndex.H"
#include "lduMatrix.H"
#include "mapDistribute.H"

namespace cutterflow::foam {

/// Element of a matrix whose column is a row behind a coupled patch, of this rank or of another.
struct PatchElement {
    int row = 0;
    int column = 0;  ///< number over all ranks
    double value = 0.0;
};

/// Elements that processor, cyclic and cyclicAMI patches add to the matrix of a solver. A sliding face has one for each face that it
/// overlaps, its coefficient times that face's weight. \param cells  numbers over all ranks. Collective.
std::vector<PatchElement> patch_elements(const Foam::lduMatrix::solver& solver, const Foam::globalIndex& cells);

/// These elements, with the messages that a product with them takes.
class LevelCouplings {
public:
    /// \param rows  numbers over all ranks. Collective.
    LevelCouplings(const Foam::globalIndex& rows, const std::vector<PatchElement>& elements);

    /// r <- r - C x. Collective.
    void subtract(const std::vector<float>& x, std::vector<float>& r) const;

    /// The elements between clusters. \param clusters  number over all ranks of each row's cluster \param first  this rank's first one.
    /// Collective.
    std::vector<PatchElement> gather(const std::vector<int>& clusters, int first) const;

private:
    struct Element {
        int row = 0, column = 0;  ///< column of this rank's rows, or of those received
        float value = 0.0F;
    };
    /// With another rank: rows whose values it takes, and where its own go.
    struct Messages {
        int rank = 0;
        Foam::labelList sent, received;
        std::vector<float> out, in;
    };
    void make_messages();
    void send(const std::vector<float>& x) const;
    void receive() const;

    Foam::label own_ = 0;  ///< rows of this rank
    std::vector<Element> inside_, across_;
    Foam::labelList rows_, columns_;  ///< of all elements; columns in the order that exchange_ makes
    std::vector<double> exact_;
    std::unique_ptr<Foam::mapDistribute> exchange_;  ///< none on one rank
    mutable std::vector<Messages> messages_;
    mutable std::vector<float> received_;
    mutable Foam::label first_request_ = 0;
};

}  // namespace cutterflow::foam
