#pragma once
/// \file Fluid velocity at points anywhere in the moving mesh.
#include <memory>
#include <vector>

#include "solver/ports/communicator.hpp"
#include "solver/ports/fluid_engine.hpp"

#include "volFields.H"

namespace cutterflow::foam {

/// Finds cells by one search tree of cell centres per zone. Cells do not move in their zone's frame, so the trees are built once and the
/// points are turned instead. Only for .cpp files of this folder.
class VelocitySampler {
public:
    /// \param mesh  moved to time t whenever sample or watch is called with time t
    VelocitySampler(Foam::fvMesh& mesh, const coupling::Cells& cells, gsl::span<const coupling::ZoneMotion> moving);
    ~VelocitySampler();

    /// Velocity at points of the absolute frame (the same points on every rank; collective): value of the cell that holds the point, or
    /// else of the cell whose centre is nearest, carried to the point with the cell's gradient.
    void sample(const Foam::volVectorField& velocity, double time, coupling::Communicator& communicator, gsl::span<const Vec3> points,
                gsl::span<Vec3> result) const;

    /// Finds the cells of places once (see coupling::FluidEngine::watch). Collective.
    void watch(const coupling::WatchedPlaces& places, double time, coupling::Communicator& communicator);
    /// Collective.
    std::vector<double> watched_means(const Foam::volVectorField& velocity, double time, coupling::Communicator& communicator) const;

private:
    /// Where a point is given: as it lies at the present time, or as it lies at time 0 in the zone that holds it.
    enum class Given { at_present, at_start };

    struct Candidate;
    Candidate find_cell(const Vec3& point, double time, Given given) const;
    std::vector<Foam::label> own_cells(gsl::span<const Vec3> points, double time, Given given, coupling::Communicator& communicator) const;

    /// A watched place whose cell is on this rank.
    struct Place {
        Foam::label cell;
        Vec3 offset, direction;  // from the cell's centre; as at time 0
        std::size_t group;
    };

    class ZoneTree;
    Foam::fvMesh& mesh_;
    coupling::Cells cells_;
    std::vector<coupling::ZoneMotion> moving_;
    std::vector<std::unique_ptr<ZoneTree>> trees_;  // by zone
    std::vector<Place> places_;
    std::size_t groups_ = 0, per_group_ = 1;
};

}  // namespace cutterflow::foam
