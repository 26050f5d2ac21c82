#include "postproc/run/input_files.hpp"

#include "geometry/base/file_content.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;

/// Empty where there is none.
json object_at(const json& parent, const char* key) {
    const auto found = parent.find(key);
    return found != parent.end() && found->is_object() ? *found : json::object();
}

}  // namespace

std::map<std::string, std::string> input_files(const json& manifest) {
    std::map<std::string, std::string> files;
    const json stages = object_at(manifest, "stages");
    for (const json& stage : stages) {
        const json inputs = object_at(stage, "inputs");
        for (const auto& [name, value] : inputs.items())
            if (value.is_string() && is_sha256(value.get<std::string>())) files[name] = value.get<std::string>();
    }
    return files;
}

}  // namespace cutterflow::postproc
