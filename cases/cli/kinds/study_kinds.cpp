#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/calibration/calibration_file.hpp"
#include "cases/cli/kinds/study_kind.hpp"
#include "cases/scenes/study_kind.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"
#include "geometry/base/process/shell_word.hpp"

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

namespace {

/// How much is wrong with a text when it is read by that table; nothing when it is no TOML, of which the reader tells.
std::size_t mistakes_by(const ParameterTable& table, const std::string& toml) {
    try {
        return parse_with_mistakes(table, toml, "").mistakes.size();
    } catch (const UserError&) {
        return 0;
    }
}

/// \throws UserError  when a file that names no kind reads much better as a calibration, or as a study of another kind, than as a cutter's
void require_cutter(const std::filesystem::path& file) {
    if (!std::filesystem::is_regular_file(file)) return;
    const std::string toml = read_file(file);
    const auto& kinds = study_kinds();
    std::vector<std::size_t> mistakes;
    for (const StudyKind& kind : kinds) mistakes.push_back(mistakes_by(kind.table(), toml));
    const auto fewest = std::min_element(mistakes.begin(), mistakes.end());
    if (2 * mistakes_by(cases::calibration_table(), toml) < *fewest)
        throw UserError({{file.string(), "it is a calibration", "A study is checked, run and swept; a calibration names studies",
                          fmt::format("Use cutterflow calibrate {}", shell_word(file.string()))}});
    if (2 * *fewest >= mistakes.front()) return;
    const StudyKind& nearest = kinds[static_cast<std::size_t>(fewest - mistakes.begin())];
    const ParameterTable& table = nearest.table();
    const bool on_top = std::any_of(table.begin(), table.end(), [](const Parameter& parameter) { return parameter.key == "kind"; });
    throw UserError({{file.string(), "the study names no kind",
                      fmt::format("One without a kind is a cutter's; this one reads as one of kind {}", nearest.name),
                      fmt::format("Write {}kind = \"{}\"", on_top ? "at its top " : "[scene] and below it ", nearest.name)}});
}

}  // namespace

const StudyKind& kind_of_study(const std::filesystem::path& file) {
    const std::string name = cases::kind_named_in(file);
    if (name.empty()) {
        require_cutter(file);
        return study_kinds().front();
    }
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
