#include "meshing/dictionary/mesher_sections.hpp"

#include <cmath>

namespace cutterflow::meshing {

FoamDictionary mesh_control() {
    FoamDictionary d;
    d.add("application", "snappyHexMesh").add("startFrom", "startTime").add("startTime", 0).add("stopAt", "endTime").add("endTime", 1);
    d.add("deltaT", 1).add("writeControl", "timeStep").add("writeInterval", 1).add("writeFormat", "binary").add("writePrecision", 12);
    return d;
}

FoamDictionary mesh_schemes() {
    FoamDictionary d;
    for (const char* section : {"ddtSchemes", "gradSchemes", "divSchemes", "laplacianSchemes", "interpolationSchemes", "snGradSchemes"})
        d.add(section, FoamDictionary());
    return d;
}

FoamDictionary feature_extraction(const std::vector<std::string>& names) {
    FoamDictionary d;
    for (const std::string& name : names) {
        FoamDictionary extraction;
        extraction.add("extractionMethod", "extractFromSurface").add("includedAngle", 150).add("writeObj", "no");
        d.add(name + ".stl", extraction);
    }
    return d;
}

FoamDictionary snapping() {
    FoamDictionary d;
    d.add("nSmoothPatch", 3).add("tolerance", 2.0).add("nSolveIter", 3).add("nRelaxIter", 5).add("nFeatureSnapIter", 10);
    d.add("explicitFeatureSnap", true).add("implicitFeatureSnap", false).add("multiRegionFeatureSnap", false);
    return d;
}

FoamDictionary no_layers() {
    FoamDictionary d;
    d.add("relativeSizes", true)
        .add("layers", FoamDictionary())
        .add("expansionRatio", 1.2)
        .add("finalLayerThickness", 0.5)
        .add("minThickness", 0.1);
    d.add("nGrow", 0).add("featureAngle", 60).add("nRelaxIter", 3).add("nSmoothSurfaceNormals", 1).add("nSmoothNormals", 3);
    d.add("nSmoothThickness", 10).add("maxFaceThicknessRatio", 0.5).add("maxThicknessToMedialRatio", 0.3).add("minMedianAxisAngle", 90);
    d.add("nBufferCellsNoExtrude", 0).add("nLayerIter", 50);
    return d;
}

FoamDictionary mesh_quality(double cell_size) {
    FoamDictionary d;
    d.add("maxNonOrtho", 65).add("maxBoundarySkewness", 3).add("maxInternalSkewness", 3).add("maxConcave", 80);
    d.add("minVol", 1e-9 * std::pow(cell_size, 3)).add("minTetQuality", 1e-9).add("minArea", -1).add("minTwist", 0.05);
    d.add("minDeterminant", 0.001).add("minFaceWeight", 0.05).add("minVolRatio", 0.02).add("minTriangleTwist", -1);
    d.add("nSmoothScale", 4).add("errorReduction", 0.75).add("relaxed", FoamDictionary().add("maxNonOrtho", 70));
    return d;
}

}  // namespace cutterflow::meshing
