#include "geometry/io/read_surface.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <type_traits>
#include <vector>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/process/isolated_call.hpp"
#include "geometry/io/ply_layout.hpp"

namespace cutterflow::geometry {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_formats = "Cutterflow reads STL (ASCII or binary), OBJ and PLY";
constexpr std::uintmax_t k_largest_file = 500'000'000;  // bytes: ten million triangles of a binary STL
constexpr double k_import_s = 20.0;                     // core time of an import [s], several times what the slowest valid file takes
constexpr double k_import_s_per_byte = 2e-6;
constexpr double k_coarsest_spacing = 1e-4;  // of coordinates, in sizes of the surface: details of 1/100 of its size keep theirs to 1/100

[[noreturn]] void refuse(const fs::path& file, const std::string& what, const std::string& rule, const std::string& remedy) {
    throw UserError(std::vector<Mistake>{{file.string(), what, rule, remedy}});
}

std::string bytes_of(const fs::path& file) {
    if (!fs::exists(file)) refuse(file, "the file does not exist", k_formats, "Check the path");
    if (!fs::is_regular_file(file)) refuse(file, "this is not a file", k_formats, "Name the surface file itself");
    const std::uintmax_t size = fs::file_size(file);
    if (size > k_largest_file)
        refuse(file, fmt::format("the file has {:.3g} GB", 1e-9 * static_cast<double>(size)),
               fmt::format("At most {:.3g} GB are read, ten million triangles; a mesh resolves far fewer", 1e-9 * k_largest_file),
               "Export the surface with a coarser tolerance");
    std::ifstream in(file, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    if (!in && !in.eof()) refuse(file, "the file cannot be read", k_formats, "Check its permissions");
    if (bytes.empty()) refuse(file, "the file is empty (0 bytes)", k_formats, "Export the surface again");
    return bytes;
}

/// A binary STL holds an 80 byte title, the number of triangles, and 50 bytes for each.
constexpr std::size_t k_stl_head = 84;
constexpr std::size_t k_stl_triangle = 50;

std::size_t announced_size(const std::string& stl) {
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, stl.data() + 80, sizeof triangles);
    return k_stl_head + k_stl_triangle * static_cast<std::size_t>(triangles);
}

/// Binary STL files may also start with "solid": only the file size decides.
bool is_ascii_stl(const std::string& bytes) {
    if (bytes.size() >= k_stl_head && announced_size(bytes) == bytes.size()) return false;
    return bytes.compare(0, 5, "solid") == 0 && bytes.find('\0') == std::string::npos;
}

/// Cuts bytes that some programs append after a binary STL, refuses what is too short.
void check_stl(const fs::path& file, std::string& bytes) {
    if (is_ascii_stl(bytes)) {
        if (bytes.find("endsolid") == std::string::npos)
            refuse(file, "the ASCII STL is truncated: it has no \"endsolid\"", "A whole file ends with it",
                   "Export or copy the file again");
        return;
    }
    if (bytes.size() < k_stl_head)
        refuse(file, fmt::format("this is no STL: {} bytes", bytes.size()),
               "A binary STL has 84 bytes or more, an ASCII one starts with \"solid\"", "Export the surface again");
    const std::size_t announced = announced_size(bytes);
    if (bytes.size() < announced)
        refuse(file, fmt::format("the file is no STL or a truncated one: {} bytes", bytes.size()),
               fmt::format("As a binary STL it announces {} triangles, which need {} bytes", (announced - k_stl_head) / k_stl_triangle,
                           announced),
               "Export or copy the file again");
    bytes.resize(announced);
}

void check_ply(const fs::path& file, const std::string& bytes) {
    const std::optional<PlyDefect> defect = ply_defect(bytes);
    if (!defect) return;
    const std::string where = defect->line > 0 ? fmt::format("{}:{}", file.string(), defect->line) : file.string();
    refuse(where, defect->what, "A whole PLY holds what its header announces, and its faces name points", "Export or copy the file again");
}

/// A part of the file as assimp gives it.
struct ImportedMesh {
    std::vector<aiVector3D> points;
    std::vector<std::array<unsigned, 3>> triangles;
};

struct Import {
    std::string error;  ///< assimp's own; empty when it understood the file
    std::vector<ImportedMesh> meshes;
};

template <typename T>
void put(std::string& bytes, const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::uint64_t size = count;
    bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
    if (count > 0) bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

/// Reads what put wrote.
class Bytes {
public:
    explicit Bytes(const std::string& bytes) : bytes_(bytes) {}
    bool at_end() const { return at_ == bytes_.size(); }
    template <typename Values>
    void take(Values& values) {
        std::uint64_t size = 0;
        bytes_.copy(reinterpret_cast<char*>(&size), sizeof size, at_);
        at_ += sizeof size;
        values.resize(size);
        const std::size_t length = size * sizeof(typename Values::value_type);
        if (length > 0) bytes_.copy(reinterpret_cast<char*>(values.data()), length, at_);
        at_ += length;
    }

private:
    const std::string& bytes_;
    std::size_t at_ = 0;
};

void put_mesh(std::string& bytes, const aiMesh& mesh) {
    put(bytes, mesh.mVertices, mesh.mNumVertices);
    std::vector<std::array<unsigned, 3>> triangles;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices == 3) triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});  // others: points and lines
    }
    put(bytes, triangles.data(), triangles.size());
}

/// What assimp makes of a file, as bytes: its error, then its meshes.
std::string import_bytes(const std::string& content, const char* format) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(content.data(), content.size(), aiProcess_Triangulate, format);
    const std::string error = scene == nullptr ? importer.GetErrorString() : "";
    std::string bytes;
    put(bytes, error.data(), error.size());
    for (unsigned m = 0; scene != nullptr && m < scene->mNumMeshes; ++m) put_mesh(bytes, *scene->mMeshes[m]);
    return bytes;
}

/// assimp aborts on some malformed files and reads outside its arrays on others: it works in a process of its own.
Import import_isolated(const fs::path& file, const std::string& content, const char* format) {
    const double cpu_limit_s = k_import_s + k_import_s_per_byte * static_cast<double>(content.size());
    const IsolatedResult result = call_isolated([&] { return import_bytes(content, format); }, cpu_limit_s);
    if (!result.death.empty())
        refuse(file, fmt::format("the file cannot be read: the importer (assimp) {}", result.death), k_formats,
               "It is damaged or of another format: export it again");
    Import import;
    Bytes bytes(result.bytes);
    bytes.take(import.error);
    while (!bytes.at_end()) {
        ImportedMesh& mesh = import.meshes.emplace_back();
        bytes.take(mesh.points);
        bytes.take(mesh.triangles);
    }
    return import;
}

void append(TriangleSurface& surface, const ImportedMesh& mesh, const fs::path& file) {
    const std::size_t offset = surface.points.size();
    for (const aiVector3D& v : mesh.points) {
        const Vec3 point(v.x, v.y, v.z);
        if (!point.allFinite())
            refuse(file, fmt::format("point {} has the coordinates ({}, {}, {})", surface.points.size(), v.x, v.y, v.z),
                   "Coordinates must be finite numbers", "Export the surface again");
        surface.points.push_back(point);
    }
    for (const std::array<unsigned, 3>& corners : mesh.triangles) {
        Triangle triangle{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            if (corners[corner] >= mesh.points.size())
                refuse(file, fmt::format("triangle {} names point {}", surface.triangles.size(), corners[corner]),
                       fmt::format("The file has {} points", mesh.points.size()), "The file is damaged or truncated: export it again");
            triangle[corner] = static_cast<std::uint32_t>(offset + corners[corner]);
        }
        surface.triangles.push_back(triangle);
    }
}

/// STL files and assimp have coordinates in single precision: far from the origin it moves points, joins them and bends faces.
void require_resolved(const fs::path& file, const TriangleSurface& surface) {
    const Bounds bounds = bounds_of(surface);
    const double size = bounds.extent().maxCoeff();
    const double farthest = bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).maxCoeff();
    const double spacing = farthest - std::nextafter(static_cast<float>(farthest), 0.0f);
    if (spacing > k_coarsest_spacing * size)
        refuse(file, fmt::format("the surface is {:.3g} wide and has coordinates of {:.3g}, in the file's unit", size, farthest),
               fmt::format("Single precision resolves {:.2g} there, and a surface needs {:g} of its size or less", spacing,
                           k_coarsest_spacing),
               "Move the origin near the body in CAD and export it again");
}

}  // namespace

std::string extension_of(const fs::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension;
}

TriangleSurface read_surface(const fs::path& file) {
    const std::string extension = extension_of(file);
    if (extension != ".stl" && extension != ".obj" && extension != ".ply")
        refuse(file, fmt::format("the file name ends in \"{}\"", extension), k_formats, "Export the surface in one of these formats");
    std::string bytes = bytes_of(file);
    if (extension == ".stl") check_stl(file, bytes);
    if (extension == ".ply") check_ply(file, bytes);

    const Import import = import_isolated(file, bytes, extension.c_str() + 1);
    if (!import.error.empty())
        refuse(file, fmt::format("the file cannot be understood ({})", import.error), k_formats,
               "It is damaged, truncated or of another format: export it again");
    TriangleSurface surface;
    for (const ImportedMesh& mesh : import.meshes) append(surface, mesh, file);
    if (surface.triangles.empty())
        refuse(file, "the file holds no triangles", "A surface is needed, not points or lines", "Export the solid's surface");
    require_resolved(file, surface);
    return welded(surface);
}

ImportedSurface import_cutter(const fs::path& file, std::optional<LengthUnit> given) {
    TriangleSurface surface = read_surface(file);
    try {
        const UnitDecision unit = decide_unit(0.5 * bounds_of(surface).extent().maxCoeff(), given);
        return {transformed(surface, Eigen::Affine3d(Eigen::Scaling(metres_per(unit.unit)))), unit};
    } catch (const UserError& error) {
        std::vector<Mistake> mistakes = error.mistakes();
        for (Mistake& mistake : mistakes) mistake.where = file.string();
        throw UserError(std::move(mistakes));
    }
}

}  // namespace cutterflow::geometry
