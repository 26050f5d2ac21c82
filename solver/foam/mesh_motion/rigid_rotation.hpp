#pragma once
/// \file Motion of a zone that turns as a rigid body. Only for .cpp files of this folder.
#include <optional>
#include <vector>

#include "solver/foam/mesh_motion/moving_zones.hpp"
#include "solver/foam/mesh_motion/sliding_overlap.hpp"

#include "dynamicFvMesh.H"
#include "tensor.H"

namespace cutterflow::foam {

/// Turns a mesh's geometry instead of computing it anew. Volumes, areas, weights and distances of a rigid body stay. Points, centres, area
/// vectors and non-orthogonal correction vectors turn with it, always from their state at angle 0, so that rounding does not add up and a
/// resumed run has the same geometry.
/// The overlap of a sliding interface follows from the angle (SlidingOverlap); only what crosses it is computed from the new overlap.
///
/// The mesh flux of a face is the rate at which it sweeps volume now,
///
///   phi = omega n . integral (x - c) x dA    [m3/s]
///
/// with axis direction n through c. Its sum over a cell is 0 at any time step, as the volume stays.
class RigidRotation {
public:
    /// \param zones  of this mesh; they are kept by reference
    RigidRotation(Foam::dynamicFvMesh& mesh, const MovingZones& zones);

    /// Moves the mesh to the present time: by OpenFOAM's own update where nothing turns, where turning cells share points with still ones,
    /// where patches are wedges, and where a plane mesh does not turn in its plane. Collective.
    void move();

    bool is_rigid() const { return motion_ != nullptr; }

    /// Null when the mesh does not turn rigidly.
    const SlidingOverlap* overlap() const { return overlap_ ? &*overlap_ : nullptr; }

private:
    /// Vectors of some places of a field.
    struct Vectors {
        Foam::labelList places;
        Foam::vectorField values;
    };
    /// At angle 0.
    struct Geometry {
        Vectors points, face_centres, face_areas, cell_centres, corrections;
        std::vector<Vectors> cell_centres_beyond;  ///< of each patch: behind the boundary to another rank
        std::vector<Vectors> patch_corrections;    ///< of each patch
    };

    bool turns_rigidly(const RotationAxis& axis) const;
    void remember();
    void turn(double angle);
    void turn_patches(const Foam::tensor& rotation);
    void set_mesh_flux();
    void couple_interfaces();

    Foam::dynamicFvMesh& mesh_;
    const MovingZones& zones_;
    const coupling::ZoneMotion* motion_ = nullptr;  ///< none: nothing turns, or not rigidly
    Foam::labelList cells_, faces_, points_;        ///< that turn
    Foam::scalarField flux_;                        ///< of faces_ [m3/s]
    Geometry base_;
    bool remembered_ = false;
    std::optional<SlidingOverlap> overlap_;  ///< from the mesh as it was read, then from the geometry at angle 0; none: not rigid
};

}  // namespace cutterflow::foam
