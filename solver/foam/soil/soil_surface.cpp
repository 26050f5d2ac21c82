#include "solver/foam/soil/soil_surface.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/run_files.hpp"
#include "solver/foam/session/foam_conversions.hpp"

#include "triSurface.H"

namespace cutterflow::foam {
namespace {

void require(bool holds, const std::filesystem::path& file, const std::string& what, const std::string& rule, const std::string& remedy) {
    if (holds) return;
    throw UserError(
        std::vector<Mistake>{{names::coupling_properties, fmt::format("soil.surface = {}: {}", file.string(), what), rule, remedy}});
}

}  // namespace

coupling::SoilSurface read_soil_surface(const std::filesystem::path& file) {
    require(std::filesystem::is_regular_file(file), file, "there is no such file", "It names the closed surface of the soil",
            "Name an STL file [m], relative to the case");
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    require(ending == ".stl", file, "its name does not end in .stl", "The soil's surface is an STL file", "Convert it");
    const Foam::triSurface surface(Foam::fileName(file.string()), "stl");
    require(!surface.empty(), file, "it has no triangles", "It holds the closed surface of the soil", "Write its triangles");
    // A closed surface has an even number of triangles at each edge; more than two where solids touch.
    const Foam::labelListList& at_edges = surface.edgeFaces();
    const auto open = std::count_if(at_edges.begin(), at_edges.end(), [](const Foam::labelList& faces) { return faces.size() % 2 != 0; });
    require(open == 0, file, fmt::format("{} edges are open", open), "Only a closed surface says where soil is",
            "Close it: cutterflow repair FILE -o sound.stl");
    std::vector<coupling::SteelTriangle> triangles;
    const Foam::pointField& points = surface.points();
    for (const Foam::labelledTri& corners : surface)
        triangles.push_back({to_vec3(points[corners[0]]), to_vec3(points[corners[1]]), to_vec3(points[corners[2]])});
    return coupling::SoilSurface(std::move(triangles));
}

}  // namespace cutterflow::foam
