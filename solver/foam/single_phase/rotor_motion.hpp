#pragma once
/// \file The rotor's motion as constant/dynamicMeshDict states it.
#include "solver/ports/fluid_engine.hpp"

namespace Foam {
class dynamicFvMesh;
}

namespace cutterflow::foam {

/// Reads the motion that moves the mesh: a static mesh has speed 0; a moving one must turn cell zone `rotor` by
/// solidBody / rotatingMotion with constant omega, in any of the key layouts OpenFOAM v1912 accepts.
/// \throws UserError  when the mesh moves in another way
coupling::RotorMotion read_rotor_motion(const Foam::dynamicFvMesh& mesh);

}  // namespace cutterflow::foam
