#include "postproc/draw/triangle_surface.hpp"

#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"

namespace cutterflow::postproc {
namespace {

constexpr std::size_t k_header_bytes = 80 + sizeof(std::uint32_t);
constexpr std::size_t k_facet_bytes = 12 * sizeof(float) + sizeof(std::uint16_t);  // normal, three corners, attributes

}  // namespace

TriangleSurface read_binary_stl(const std::filesystem::path& file) {
    const std::string bytes = read_file(file);
    std::uint32_t count = 0;
    if (bytes.size() >= k_header_bytes) std::memcpy(&count, bytes.data() + 80, sizeof count);
    if (bytes.size() < k_header_bytes || bytes.size() != k_header_bytes + count * k_facet_bytes) {
        throw UserError(fmt::format("{} is not a complete binary STL file ({} bytes)", file.string(), bytes.size()), "",
                        "Repeat the geometry stage of the run");
    }
    TriangleSurface surface(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 12> numbers{};
        std::memcpy(numbers.data(), bytes.data() + k_header_bytes + i * k_facet_bytes, sizeof numbers);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            surface[i][corner] = Vec3(numbers[3 + 3 * corner], numbers[4 + 3 * corner], numbers[5 + 3 * corner]);
        }
    }
    return surface;
}

}  // namespace cutterflow::postproc
