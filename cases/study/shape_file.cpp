#include "cases/study/shape_file.hpp"

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/clump/clump_file.hpp"

namespace cutterflow::cases {

ShapeFile read_shape_file(const ParameterValues& values, const std::string& key, const std::string& name,
                          const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / values.text(key);
    if (!std::filesystem::is_regular_file(file))
        throw UserError({{values.where(key), fmt::format("{} = \"{}\"", key, values.text(key)),
                          fmt::format("There is no file {}", std::filesystem::absolute(file).lexically_normal().string()),
                          "Name a clump's file (cutterflow clump); the path is relative to the study file"}});
    return {name, file, read_file(file), geometry::unit_clump(geometry::read_clump(file))};
}

std::string path_of_shape(const std::string& name) {
    return "constant/shapes/" + name + ".clump";
}

}  // namespace cutterflow::cases
