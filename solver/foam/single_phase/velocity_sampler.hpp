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
    /// \param mesh  moved to time t whenever sample is called with time t
    VelocitySampler(const Foam::fvMesh& mesh, const coupling::Cells& cells, gsl::span<const coupling::ZoneMotion> moving);
    ~VelocitySampler();

    /// Velocity at points of the absolute frame (the same points on every rank; collective): value of the cell that holds the point, or
    /// else of the cell whose centre is nearest, carried to the point with the cell's gradient.
    void sample(const Foam::volVectorField& velocity, double time, coupling::Communicator& communicator, gsl::span<const Vec3> points,
                gsl::span<Vec3> result) const;

private:
    struct Candidate;
    Candidate find_cell(const Vec3& point, double time) const;

    class ZoneTree;
    const Foam::fvMesh& mesh_;
    std::vector<coupling::ZoneMotion> moving_;
    std::vector<std::unique_ptr<ZoneTree>> trees_;  // by zone
};

}  // namespace cutterflow::foam
