#pragma once
/// \file The dictionaries with which the stock programs turn the background mesh into the run's mesh.
#include <array>
#include <string>

#include "meshing/cutter/mesh_plan.hpp"
#include "meshing/dictionary/foam_dictionary.hpp"

namespace cutterflow::meshing {

/// Patches that snappyHexMesh cuts; each has a surface `<name>.stl` in constant/triSurface.
const std::array<std::string, 3>& steel_surfaces();

FoamDictionary steel_cut(const MeshPlan& plan);         ///< snappyHexMeshDict
FoamDictionary outlet_selection(const MeshPlan& plan);  ///< topoSetDict: faceSet `outlet`, where the pipe meets the tank's top
FoamDictionary final_patches();                         ///< createPatchDict: outlet and the two cyclicAMI sides
/// decomposeParDict: `ranks` boxes in the plane normal to the axis, as square as the number allows (hierarchical: Debian's scotch is a
/// stub). \pre ranks >= 1
FoamDictionary decomposition(int ranks);

}  // namespace cutterflow::meshing
