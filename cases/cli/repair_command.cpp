/// \file repair: from a surface as it was exported to a sound solid, or to a picture of what is wrong with it.
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/commands.hpp"
#include "cases/cli/new_file.hpp"
#include "cases/cli/numbers.hpp"
#include "cases/cli/surface_option.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/io/write_stl.hpp"
#include "geometry/io/write_vtp.hpp"
#include "geometry/repair/repair.hpp"
#include "geometry/repair/repair_report.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

struct RepairOptions {
    std::string input;
    std::string output;
    std::optional<std::string> unit;
    std::optional<std::string> report;
    std::optional<double> weld_distance_m;
    std::optional<double> hole_size_m;
    double volume_change_percent = 0.5;
    double area_change_percent = 2.0;
    bool json = false;
};

/// output.bad_faces.vtp, or with a number when there is one already.
fs::path bad_faces_file(const fs::path& output) {
    for (int number = 1;; ++number) {
        fs::path file = output;
        file.replace_extension(number == 1 ? std::string("bad_faces.vtp") : fmt::format("bad_faces.{}.vtp", number));
        if (!fs::exists(file)) return file;
    }
}

geometry::repair::RepairLimits limits_of(const RepairOptions& options, const geometry::TriangleSurface& surface) {
    geometry::repair::RepairLimits limits = geometry::repair::default_limits(surface);
    if (options.weld_distance_m) limits.weld_distance = *options.weld_distance_m;
    if (options.hole_size_m) limits.hole_size = *options.hole_size_m;
    limits.volume_change = 0.01 * options.volume_change_percent;
    limits.area_change = 0.01 * options.area_change_percent;
    return limits;
}

/// The refusals, and where the faces concerned were written.
[[noreturn]] void refuse(const geometry::repair::RepairOutcome& outcome, const fs::path& bad_faces) {
    std::vector<Mistake> mistakes = outcome.refusals;
    if (!outcome.bad_faces.faces.surface.triangles.empty())
        mistakes.push_back({bad_faces.string(),
                            fmt::format("holds the {} face(s) concerned, in metres", outcome.bad_faces.faces.surface.triangles.size()),
                            "Each carries its number in the file (source_face, -1: added by the repair) and what is wrong with it",
                            "Open it in ParaView"});
    throw UserError(std::move(mistakes));
}

/// The surface. \throws UserError  with what is wrong with it and with the options
geometry::ImportedSurface import_and_check(const RepairOptions& options) {
    Mistakes mistakes;
    mistakes.gather([&] { require_new_file(options.output); });
    if (options.report) {
        mistakes.gather([&] { require_new_file(*options.report); });
        mistakes.gather([&] { require_different_places("--output", options.output, "--report", *options.report); });
    }
    std::optional<geometry::ImportedSurface> imported = import_surface(options.input, options.unit, mistakes);
    mistakes.refuse();
    return std::move(*imported);
}

void run_repair(const RepairOptions& options) {
    const geometry::ImportedSurface imported = import_and_check(options);
    const geometry::repair::RepairOutcome outcome =
        geometry::repair::repair_surface(imported.surface, limits_of(options, imported.surface), options.input);

    const fs::path bad_faces = bad_faces_file(options.output);
    nlohmann::json report = geometry::repair::to_json(outcome, options.input, imported.unit);
    if (outcome.repaired()) {
        geometry::write_stl(outcome.result.surface, options.output);
        report["output"] = options.output;
    } else if (!outcome.bad_faces.faces.surface.triangles.empty()) {
        std::map<std::string, std::vector<std::int64_t>> cell_data = outcome.bad_faces.defects;
        cell_data["source_face"] = outcome.bad_faces.faces.source;
        geometry::write_vtp(outcome.bad_faces.faces.surface, cell_data, bad_faces);
        report["bad_faces"] = bad_faces.string();
    }
    if (options.report) write_file(*options.report, report.dump(2) + "\n");
    std::cout << (options.json ? report.dump(2) + "\n" : geometry::repair::to_text(outcome, options.input, imported.unit)) << std::flush;
    if (!outcome.repaired()) refuse(outcome, bad_faces);
    if (!options.json) std::cout << fmt::format("wrote {}, in metres\n", options.output);
}

}  // namespace

void add_repair(CLI::App& app) {
    auto* command =
        app.add_subcommand("repair", "Repair a cutter's surface into one watertight solid, or report where that is not possible.");
    const auto options = std::make_shared<RepairOptions>();
    command->add_option("cutter", options->input, "STL, OBJ or PLY file; it is not changed")->required();
    command->add_option("-o,--output", options->output, "STL file to write, in metres")->required()->check(k_stl_name);
    command->add_option("--unit", options->unit,
                        "Unit of length of the file (m, mm, cm, inch, ft); without it metres, millimetres or inches, the first that gives "
                        "a plausible size");
    command
        ->add_option("--weld-distance-m", options->weld_distance_m,
                     "Points nearer than this are joined; default 1e-5 of the largest extent")
        ->check(k_positive);
    command->add_option("--hole-size-m", options->hole_size_m, "Holes up to this size are filled; default 0.05 of the largest extent")
        ->check(k_not_negative);
    command
        ->add_option("--volume-change-percent", options->volume_change_percent,
                     "Allowed change or uncertainty of the volume (except by uniting shells)")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    command
        ->add_option("--area-change-percent", options->area_change_percent,
                     "Allowed change of the area by patches and resolved self-intersections")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    command->add_option("--report", options->report, "JSON file to write the report to");
    command->add_flag("--json", options->json, "Print the report as JSON");
    command->callback([options] { run_repair(*options); });
}

}  // namespace cutterflow::cli
