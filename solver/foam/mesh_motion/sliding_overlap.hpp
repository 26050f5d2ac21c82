#pragma once
/// \file The overlap of the two sides of sliding interfaces, from the angle. Only for .cpp files of this folder.
#include <memory>
#include <vector>

#include "solver/foam/mesh_motion/moving_zones.hpp"
#include "solver/foam/mesh_motion/revolution_overlap.hpp"
#include "solver/foam/mesh_motion/sliding_interface.hpp"

#include "cyclicAMIPolyPatch.H"
#include "globalIndex.H"

namespace cutterflow::foam {

/// Area vectors [m2] of the parts of each face of both patches, in the order of the overlap's addresses, out of the patch's own cells. Each
/// part has one vector, which both sides have with the other sign.
struct PartAreas {
    InterfacePair patches;
    std::vector<std::vector<Foam::vector>> owner, neighbour;
};

/// Interfaces between the turning zone and the rest whose sides are surfaces of revolution: the overlap of their faces follows from the
/// angle (RevolutionOverlap) instead of being looked for. That of other interfaces is left to OpenFOAM.
class SlidingOverlap {
public:
    /// \param zones  of the mesh, one at least \param angle  at which its turning zone is [rad]. Collective.
    SlidingOverlap(const Foam::fvMesh& mesh, const MovingZones& zones, double angle);

    /// Takes the overlaps out of their patches, which drop them when their points move, and puts them back.
    void take();
    void put_back();

    /// Sets every overlap to that angle of the turning zone [rad]. Collective.
    void set(double angle);

    std::size_t size() const { return interfaces_.size(); }

    /// Of the interfaces whose parts have areas (RevolutionOverlap::pairs_areas), at the angle last set.
    const std::vector<PartAreas>& areas() const { return areas_; }

private:
    struct Interface {
        InterfacePair patches;
        bool owner_turns = false;
        Foam::globalIndex owner_faces, neighbour_faces;  ///< numbers over all ranks
        RevolutionOverlap overlap;
        std::unique_ptr<Foam::AMIPatchToPatchInterpolation> taken{};
    };

    void add(const InterfacePair& patches, const MovingZones& zones);

    const Foam::fvMesh& mesh_;
    double base_angle_;  ///< [rad]
    std::vector<Interface> interfaces_;
    std::vector<PartAreas> areas_;
};

}  // namespace cutterflow::foam
