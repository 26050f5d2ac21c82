/// \file generate-cutter, inspect: work on surfaces alone.
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/commands.hpp"
#include "cases/cli/inspection_page.hpp"
#include "cases/cli/new_file.hpp"
#include "cases/cli/surface_option.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/head/crown_cutter.hpp"
#include "geometry/head/geometry_report.hpp"
#include "geometry/io/write_stl.hpp"

namespace cutterflow::cli {
namespace {

struct GenerateOptions {
    std::string crown;
    std::string output;
};

void generate(const GenerateOptions& options) {
    Mistakes mistakes;
    geometry::TriangleSurface surface;
    mistakes.gather([&] { require_new_file(options.output); });
    mistakes.gather([&] { surface = geometry::generate_crown_cutter(geometry::read_crown_parameters(options.crown)); });
    mistakes.refuse();
    geometry::write_stl(surface, options.output);
    std::cout << fmt::format("wrote {}: {} triangles, {:.5g} m3 of steel, in metres\n", options.output, surface.triangles.size(),
                             geometry::volume_of(surface));
}

struct InspectOptions {
    std::string cutter;
    std::optional<std::string> unit;
    std::optional<std::string> contour;
    std::optional<std::string> output;
    bool json = false;
};

void inspect(const InspectOptions& options) {
    Mistakes mistakes;
    mistakes.gather([&] {
        if (options.contour) require_new_file(*options.contour);
    });
    mistakes.gather([&] {
        if (options.contour && options.output) require_different_places("--output", *options.output, "--contour", *options.contour);
    });
    const std::optional<geometry::ImportedSurface> imported = import_surface(options.cutter, options.unit, mistakes);
    mistakes.refuse();
    const geometry::GeometryInspection inspection = geometry::inspect_cutter(*imported, options.cutter);
    if (options.output) cases::write_inspection(inspection, imported->surface, *options.output);
    std::cout << (options.json ? geometry::to_json(inspection).dump(2) + "\n" : geometry::to_text(inspection)) << std::flush;
    geometry::require_head(inspection);
    if (options.contour) geometry::write_contour_csv(inspection.head->contour, *options.contour);
}

}  // namespace

void add_generate_cutter(CLI::App& app) {
    auto* command = app.add_subcommand("generate-cutter", "Write the STL of a parametric crown cutter.");
    const auto options = std::make_shared<GenerateOptions>();
    command->add_option("crown", options->crown, "TOML file of its sizes, as cases/examples/model_cutter/crown.toml")->required();
    command->add_option("-o,--output", options->output, "STL file to write")->required()->check(k_stl_name);
    command->callback([options] { generate(*options); });
}

void add_inspect(CLI::App& app) {
    auto* command = app.add_subcommand("inspect", "Inspect a cutter: unit, soundness, axis, blades, contour.");
    const auto options = std::make_shared<InspectOptions>();
    command->add_option("cutter", options->cutter, "STL, OBJ or PLY file")->required();
    command->add_option(
        "--unit", options->unit,
        "Unit of length (m, mm, cm, inch, ft); default: metres, millimetres or inches, the first that gives a plausible size");
    command->add_option("-o,--output", options->output, "Folder to write inspection.json and index.html (pictures, contour) to");
    command->add_option("--contour", options->contour, "CSV file to write the contour of revolution to");
    command->add_flag("--json", options->json, "Print JSON");
    command->callback([options] { inspect(*options); });
}

}  // namespace cutterflow::cli
