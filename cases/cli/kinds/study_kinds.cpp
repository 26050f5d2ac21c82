#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/cli/kinds/study_kind.hpp"
#include "cases/scenes/study_kind.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow::cli {

const std::vector<StudyKind>& study_kinds() {
    static const std::vector<StudyKind> kinds{k_cutter_kind, k_surface_kind, k_room_kind};
    return kinds;
}

std::vector<std::string> kind_names() {
    std::vector<std::string> names;
    for (const StudyKind& kind : study_kinds()) names.emplace_back(kind.name);
    return names;
}

const StudyKind& kind_named(const std::string& name) {
    const auto& kinds = study_kinds();
    return *std::find_if(kinds.begin(), kinds.end(), [&](const StudyKind& kind) { return name == kind.name; });
}

const StudyKind& kind_of_study(const std::filesystem::path& file) {
    const std::string name = cases::kind_named_in(file);
    if (name.empty()) return study_kinds().front();
    const std::vector<std::string> names = kind_names();
    if (std::find(names.begin(), names.end(), name) != names.end()) return kind_named(name);
    const std::string nearest = nearest_word(name, names);
    throw UserError({{file.string(), fmt::format("kind = \"{}\"", name),
                      fmt::format("A study is of kind {}; one without a kind is a cutter's", fmt::join(names, ", ")),
                      nearest.empty() ? "Correct or remove the key" : fmt::format("Did you mean \"{}\"?", nearest)}});
}

const StudyKind& kind_of_run(const std::filesystem::path& folder) {
    const auto& kinds = study_kinds();
    const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const StudyKind& kind) { return kind.is_run(folder); });
    return found == kinds.end() ? kinds.front() : *found;
}

}  // namespace cutterflow::cli
