/// \file Surfaces, and what is made of numbers alone: STL, OBJ, PLY, the crown cutter's file.
#include "validation/fuzz/surface_kinds.hpp"

#include <cstring>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/file_content.hpp"
#include "geometry/head/crown_cutter.hpp"
#include "geometry/head/geometry_report.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/io/write_stl.hpp"
#include "geometry/repair/repair.hpp"
#include "geometry/repair/repair_report.hpp"
#include "geometry/surface/simple_solids.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;
using geometry::TriangleSurface;

TriangleSurface tetrahedron() {
    TriangleSurface surface;
    surface.points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    surface.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return surface;
}

template <typename T>
void put(std::string& bytes, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

std::string ascii_stl(const TriangleSurface& surface) {
    std::string text = "solid head\n";
    for (const geometry::Triangle& t : surface.triangles) {
        text += "facet normal 0 0 0\n outer loop\n";
        for (const std::uint32_t corner : t) {
            const Vec3& p = surface.points[corner];
            text += fmt::format("  vertex {} {} {}\n", p.x(), p.y(), p.z());
        }
        text += " endloop\nendfacet\n";
    }
    return text + "endsolid head\n";
}

std::string binary_stl(const TriangleSurface& surface) {
    std::string bytes(80, ' ');
    put(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
    for (const geometry::Triangle& t : surface.triangles) {
        for (int i = 0; i < 3; ++i) put(bytes, 0.0F);
        for (const std::uint32_t corner : t)
            for (int axis = 0; axis < 3; ++axis) put(bytes, static_cast<float>(surface.points[corner][axis]));
        put(bytes, std::uint16_t{0});
    }
    return bytes;
}

std::string ply_header(const char* format) {
    return fmt::format(
        "ply\nformat {} 1.0\ncomment of a solid\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
        "property list uchar int vertex_indices\nend_header\n",
        format);
}

std::string binary_ply(const TriangleSurface& surface) {
    std::string bytes = ply_header("binary_little_endian");
    for (const Vec3& point : surface.points)
        for (int axis = 0; axis < 3; ++axis) put(bytes, static_cast<float>(point[axis]));
    for (const geometry::Triangle& t : surface.triangles) {
        put(bytes, std::uint8_t{3});
        for (const std::uint32_t corner : t) put(bytes, static_cast<std::int32_t>(corner));
    }
    return bytes;
}

constexpr const char* k_plain_obj = "# a solid\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

constexpr const char* k_rich_obj =
    "mtllib head.mtl\no head\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvn 0 0 1\nvt 0 0\nusemtl steel\n"
    "g shell a\ns off\nf 1 4 3 2\nf 5/1/1 6/1/1 7/1/1 8/1/1\nf 1 2 6 5\nf 2//1 3//1 7//1 6//1\nf 3/1 4/1 8/1 7/1\nf -5 -8 -4 -1\nl 1 2 "
    "3\np 1\n";

/// With colours, another element, a polygon of four points and both kinds of white space.
constexpr const char* k_rich_ply =
    "ply\nformat ascii 1.0\nobj_info of a program\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n"
    "property uchar red\nproperty float quality\nelement face 5\nproperty list uchar uint vertex_index\nproperty uchar flags\n"
    "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0 255 0.5\n1 0 0 0 0.5\n1 1 0 0 1e-3\n0 1 0 9 0\n"
    "0.5 0.5 1 0 1\n4 0 3 2 1 0\n3 0 1 4 0\n3 1 2 4 0\n3 2\t3 4 1\n3 3 0 4 0\n0 1\n";

std::string bytes_of(const TriangleSurface& surface) {
    std::string bytes;
    for (const Vec3& point : surface.points)
        for (int axis = 0; axis < 3; ++axis) put(bytes, point[axis]);
    for (const geometry::Triangle& triangle : surface.triangles)
        for (const std::uint32_t corner : triangle) put(bytes, corner);
    return bytes;
}

/// Most of an input's time: a process does it once for each surface, as changed names and normals leave the surface as it was.
void inspect(const geometry::ImportedSurface& imported, const fs::path& path) {
    static std::set<std::string> known;
    const std::string key =
        fmt::format("{} {} ", path.filename().string(), static_cast<int>(imported.unit.unit)) + bytes_of(imported.surface);
    if (known.count(key) > 0) return;
    const geometry::GeometryInspection inspection = geometry::inspect_cutter(imported, path.string());
    geometry::to_json(inspection).dump();
    geometry::to_text(inspection);
    known.insert(key);
}

/// What inspect and repair do with a file, but for writing.
void read_surface_file(const fs::path& folder, const std::string& file) {
    const fs::path path = folder / file;
    const geometry::ImportedSurface imported = geometry::import_cutter(path, std::nullopt);
    const geometry::repair::RepairOutcome repaired =
        geometry::repair::repair_surface(imported.surface, geometry::repair::default_limits(imported.surface), path.string());
    geometry::repair::to_json(repaired, path.string(), imported.unit).dump();
    geometry::repair::to_text(repaired, path.string(), imported.unit);
    inspect(imported, path);
    if (repaired.repaired()) geometry::write_stl(repaired.result.surface, folder / "repaired.stl");
}

void generate(const fs::path& folder, const std::string& file) {
    geometry::write_stl(geometry::generate_crown_cutter(geometry::read_crown_parameters(folder / file)), folder / "generated.stl");
}

/// The example in a coarse surface, which takes milliseconds.
std::string coarse(std::string crown) {
    const std::string fine = "edge_length_m = 0.022";
    const std::size_t at = crown.find(fine);
    return at == std::string::npos ? crown : crown.replace(at, fine.size(), "edge_length_m = 0.1");
}

}  // namespace

std::string coarse_crown_file() {
    return coarse(read_file(fs::path(CUTTERFLOW_SOURCE_DIR) / "cases/examples/model_cutter/crown.toml"));
}

std::vector<FuzzKind> surface_kinds() {
    const TriangleSurface solid = tetrahedron();
    const std::vector<std::string> stl_words{"solid", "endsolid", "facet",   "normal",   "outer",
                                             "loop",  "vertex",   "endloop", "endfacet", "color"};
    const std::vector<std::string> obj_words{"v", "vn",     "vt",     "f", "l",  "p", "g",  "o",
                                             "s", "usemtl", "mtllib", "#", "\\", "/", "//", "1/1/1"};
    const std::vector<std::string> ply_words{"ply",
                                             "format",
                                             "ascii",
                                             "binary_little_endian",
                                             "binary_big_endian",
                                             "1.0",
                                             "comment",
                                             "element",
                                             "vertex",
                                             "face",
                                             "edge",
                                             "tristrips",
                                             "material",
                                             "property",
                                             "list",
                                             "char",
                                             "uchar",
                                             "short",
                                             "uint",
                                             "int64",
                                             "float",
                                             "double",
                                             "x",
                                             "vertex_indices",
                                             "TextureFile",
                                             "texcoord",
                                             "end_header"};
    const std::vector<std::string> crown_words{"[ring]",   "[blades]", "[picks]", "per_blade = 2", "count", "wrap_deg", "true",
                                               "\"text\"", "[]",       "{}"};
    const std::string crown = coarse_crown_file();
    return {
        {"stl_ascii", {{"head.stl", ascii_stl(solid)}, {"head.STL", ascii_stl(solid)}}, stl_words, {}, read_surface_file, 1.0},
        {"stl_binary", {{"head.stl", binary_stl(solid)}}, {}, {}, read_surface_file, 1.0},
        {"obj", {{"plain.obj", k_plain_obj}, {"rich.obj", k_rich_obj}}, obj_words, {}, read_surface_file, 1.0},
        {"ply",
         {{"plain.ply", ply_header("ascii") + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"},
          {"binary.ply", binary_ply(solid)},
          {"rich.ply", k_rich_ply}},
         ply_words,
         {},
         read_surface_file,
         1.5},
        {"crown",
         {{"crown.toml", crown}, {"picks.toml", crown + "\n[picks]\nper_blade = 2\nlean_deg = 20\n"}},
         crown_words,
         {},
         generate,
         0.5},
    };
}

}  // namespace cutterflow::validation
