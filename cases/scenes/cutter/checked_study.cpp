#include "cases/scenes/cutter/checked_study.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "cases/scenes/cutter/study_bank.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/scenes/cutter/velocity_points.hpp"
#include "cases/study/study_shapes.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/parameters/parameter_reading.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_files[] = {"cutter.file", "bank.file", "report.adv_points"};

struct ReadStudy {
    ParameterValues values;
    bool complete = false;  ///< no value is wrong or missing
    bool rules_hold = false;
    bool shapes_are_sound = false;
};

/// What can be read of a study; mistakes of its text, rules and files are added.
ReadStudy read_with_mistakes(const fs::path& file, Mistakes& mistakes) {
    ReadParameters text = parse_with_mistakes(study_table(), read_file(file), file.string());
    mistakes.add(text.mistakes);
    ReadStudy read{std::move(text.values), text.complete};
    const std::vector<Mistake> broken = check_file_rules(read.values, file);
    mistakes.add(broken);
    read.rules_hold = broken.empty();
    for (const char* key : k_files)
        if (const auto missing = missing_file(read.values, key, file.parent_path())) mistakes.add(*missing);
    read.shapes_are_sound = mistakes.gather([&] { read_shapes(read.values, file.parent_path()); });
    return read;
}

/// Whether steel behind the head, water, bank and points have their sizes.
bool has_sizes(const ParameterValues& values, const fs::path& folder) {
    return !lacks_swing(values) && std::none_of(std::begin(k_files), std::end(k_files),
                                                [&](const char* key) { return missing_file(values, key, folder).has_value(); });
}

}  // namespace

PlacedStudy place_study(const ParameterValues& resolved, const geometry::Head& head, const fs::path& folder, bool feeds_are_sound) {
    const Study study = make_study(resolved, folder);
    PlacedStudy placed{study, head_size(head), head_contour(head, study.suction.gap), {}};
    Mistakes mistakes;
    mistakes.add(bank_mistakes(resolved, study, placed.size, head.contour));
    const bool bank_stands = mistakes.empty();
    std::optional<geometry::TriangleSurface> soil;
    if (study.report.adv_points && study.bank && bank_stands) soil = bank_surface(study, placed.size, placed.contour);
    if (study.report.adv_points) mistakes.gather([&] { require_adv_points(study, placed.size, head.surface, soil); });
    if (bank_stands && feeds_are_sound)
        mistakes.gather([&] { placed.feeds = place_feeds(study, feed_scene(study, placed.size, placed.contour, head.surface)); });
    mistakes.refuse();
    return placed;
}

std::vector<Mistake> head_warnings(const ParameterValues& resolved, const PlacedStudy& placed, const geometry::Head& head) {
    std::vector<Mistake> warnings = study_warnings(resolved, placed.study, placed.size);
    for (const std::vector<Mistake>& more :
         {carrying_warnings(placed.study, head), blade_warnings(placed.study, head),
          swing_warnings(resolved, placed.study, placed.size, placed.contour), practice_warnings(placed.study, placed.size)})
        warnings.insert(warnings.end(), more.begin(), more.end());
    return warnings;
}

void require_study_file(const fs::path& file) {
    Mistakes mistakes;
    read_with_mistakes(file, mistakes);
    mistakes.refuse();
}

CheckedStudy read_checked_study(const fs::path& file) {
    const fs::path folder = file.parent_path();
    Mistakes mistakes;
    const ReadStudy read = read_with_mistakes(file, mistakes);
    const bool knows_unit = read.values.has("cutter.unit") == read.values.gives("cutter.unit");
    if (!read.values.has("cutter.file") || !knows_unit || missing_file(read.values, "cutter.file", folder)) mistakes.refuse();
    std::optional<CheckedStudy> study;
    mistakes.gather([&] {
        geometry::GeometryInspection inspection = import_study_cutter(read.values, folder);
        const HeadSize size = head_size(*inspection.head);
        ParameterValues resolved = resolve_study(read.values, size);
        const std::vector<Mistake> broken = check_study(resolved, size);
        mistakes.add(broken);
        if (!broken.empty() || !read.complete || !read.shapes_are_sound || !has_sizes(resolved, folder)) return;
        PlacedStudy placed = place_study(resolved, *inspection.head, folder, read.rules_hold);
        study = CheckedStudy{std::move(resolved), std::move(inspection), std::move(placed)};
    });
    mistakes.refuse();
    return std::move(*study);
}

}  // namespace cutterflow::cases
