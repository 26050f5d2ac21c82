#pragma once
/// \file Sections of dictionaries that every mesh stage has alike, whatever is meshed.
#include <string>
#include <vector>

#include "meshing/dictionary/foam_dictionary.hpp"

namespace cutterflow::meshing {

FoamDictionary mesh_control();  ///< controlDict of a mesh stage
FoamDictionary mesh_schemes();  ///< fvSchemes, which the programs read but do not use

/// surfaceFeatureExtractDict for constant/triSurface/<name>.stl of each name.
FoamDictionary feature_extraction(const std::vector<std::string>& names);

// Sections of snappyHexMeshDict.
FoamDictionary snapping();   ///< snapControls
FoamDictionary no_layers();  ///< addLayersControls: none are added, snappyHexMesh reads the section all the same
/// meshQualityControls. \param cell_size  of the background [m]
FoamDictionary mesh_quality(double cell_size);

}  // namespace cutterflow::meshing
