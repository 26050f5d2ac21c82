/// \file clump: a rock of overlapping spheres for a rock given by its surface.
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "cases/cli/commands.hpp"
#include "cases/cli/new_file.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/clump/clump_file.hpp"
#include "geometry/clump_fit/fit_clump.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::cli {
namespace {

constexpr int k_default_balls = 12;

struct ClumpOptions {
    std::string rock;
    int balls = k_default_balls;
    std::string output;
};

std::string line_of(const std::string& name, double rock, double clump) {
    return fmt::format("{:<26}{:>14.6g}{:>14.6g}{:>10.2f} %\n", name, rock, clump, 100.0 * (clump / rock - 1.0));
}

/// Rock, clump and their difference.
std::string table_of(const geometry::ClumpFit& fit) {
    const geometry::ClumpProperties &rock = fit.of_rock, &clump = fit.of_clump;
    std::string text = fmt::format("{:<26}{:>14}{:>14}{:>12}\n", "", "rock", "clump", "difference");
    text += line_of("volume [m3]", rock.volume, clump.volume);
    for (int k = 0; k < 3; ++k)
        text += line_of(fmt::format("principal moment {} [m5]", k + 1), rock.principal_moments[k], clump.principal_moments[k]);
    text += line_of("smallest shadow [m2]", rock.shadow.smallest, clump.shadow.smallest);
    text += line_of("largest shadow [m2]", rock.shadow.largest, clump.shadow.largest);
    return text;
}

geometry::TriangleSurface read_rock(const std::string& file) {
    geometry::TriangleSurface rock = geometry::read_surface(file);
    const geometry::SoundnessReport report = geometry::inspect_surface(rock);
    geometry::require_sound(report, file);
    if (report.components.size() > 1)
        throw UserError(fmt::format("{} has {} bodies that do not touch", file, report.components.size()), "A clump is one rock",
                        "Remove the others, or join them, in CAD");
    return rock;
}

void make_clump(const ClumpOptions& options) {
    Mistakes mistakes;
    geometry::TriangleSurface rock;
    mistakes.gather([&] { require_new_file(options.output); });
    mistakes.gather([&] { rock = read_rock(options.rock); });
    mistakes.refuse();
    const geometry::ClumpFit fit = geometry::fit_clump(rock, options.balls);
    const std::string text =
        table_of(fit) + fmt::format(
                            "equivalent diameter {:.6g} m, sphericity {:.4f}\n"
                            "spheres inscribed: {:.1f} % of the volume; polished: surfaces {:.1f} % of the diameter apart (rms)\n",
                            fit.of_rock.equivalent_diameter, *fit.clump.sphericity, 100.0 * fit.inscribed_volume / fit.of_rock.volume,
                            100.0 * fit.surface_deviation / fit.of_rock.equivalent_diameter);
    geometry::write_clump(fit.clump, fmt::format("{} as {} spheres\n{}", options.rock, fit.clump.balls.size(), text), options.output);
    std::cout << text << fmt::format("wrote {}: {} spheres\n", options.output, fit.clump.balls.size());
}

}  // namespace

void add_clump(CLI::App& app) {
    auto* command = app.add_subcommand("clump", "Make a rock of overlapping spheres from a rock's surface.");
    const auto options = std::make_shared<ClumpOptions>();
    command->add_option("rock", options->rock, "STL, OBJ or PLY file; its size does not matter to a run, in which rock has a diameter")
        ->required();
    command->add_option("--spheres", options->balls, "Number of spheres")
        ->capture_default_str()
        ->check(CLI::Range(1, geometry::k_most_balls));
    command->add_option("-o,--output", options->output, "Clump file to write")->required();
    command->callback([options] { make_clump(*options); });
}

}  // namespace cutterflow::cli
