#include "geometry/io/write_vtp.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/file_content.hpp"

namespace cutterflow::geometry {

void write_vtp(const TriangleSurface& surface, const std::map<std::string, std::vector<std::int64_t>>& cell_data,
               const std::filesystem::path& file) {
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
        surface.points.size(), surface.triangles.size());
    text += "<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n";
    for (const Vec3& p : surface.points) text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    text += "</DataArray>\n</Points>\n<Polys>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
    for (const Triangle& t : surface.triangles) text += fmt::format("{} {} {}\n", t[0], t[1], t[2]);
    text += "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
    for (std::size_t t = 1; t <= surface.triangles.size(); ++t) text += fmt::format("{}\n", 3 * t);
    text += "</DataArray>\n</Polys>\n<CellData>\n";
    for (const auto& [name, values] : cell_data)
        text += fmt::format("<DataArray type=\"Int64\" Name=\"{}\" format=\"ascii\">\n{}\n</DataArray>\n", name, fmt::join(values, "\n"));
    text += "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
    write_file(file, text);
}

}  // namespace cutterflow::geometry
