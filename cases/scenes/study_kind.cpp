#include "cases/scenes/study_kind.hpp"

#include "geometry/base/file_content.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"

namespace cutterflow::cases {

std::string kind_named_in(const std::filesystem::path& study) {
    if (!std::filesystem::exists(study)) return "";
    const std::string toml = read_file(study);
    for (const char* key : {"kind", "scene.kind"})
        if (const auto name = text_of_key(toml, key)) return *name;
    return "";
}

}  // namespace cutterflow::cases
