#include "geometry/io/write_stl.hpp"

#include <cstring>
#include <string>

#include "geometry/base/file_content.hpp"

namespace cutterflow::geometry {
namespace {

void append_bytes(std::string& bytes, const void* value, std::size_t count) {
    bytes.append(static_cast<const char*>(value), count);
}

void append_vector(std::string& bytes, const Vec3& vector) {
    const Eigen::Vector3f single = vector.cast<float>();
    append_bytes(bytes, single.data(), 3 * sizeof(float));
}

}  // namespace

void write_stl(const TriangleSurface& surface, const std::filesystem::path& file) {
    std::string bytes(80, ' ');
    // Not "solid ...": readers take a file that starts so for ASCII.
    const std::string title = "binary STL, metres, written by cutterflow";
    bytes.replace(0, title.size(), title);
    const auto count = static_cast<std::uint32_t>(surface.triangles.size());
    append_bytes(bytes, &count, sizeof count);
    for (const Triangle& triangle : surface.triangles) {
        append_vector(bytes, area_vector(surface, triangle).normalized());
        for (const std::uint32_t corner : triangle) append_vector(bytes, surface.points[corner]);
        bytes.append(2, '\0');
    }
    write_file(file, bytes);
}

}  // namespace cutterflow::geometry
