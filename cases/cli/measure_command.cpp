/// \file measure: what a finished run shows, by its measures.
#include <iostream>
#include <memory>
#include <optional>

#include "cases/cli/commands.hpp"
#include "cases/cli/kinds/stage_lines.hpp"
#include "postproc/analysis/measures/measure_run.hpp"
#include "postproc/pages/room/room_page.hpp"

namespace cutterflow::cli {

namespace {

struct MeasureOptions {
    std::string run;
    std::optional<std::string> name;
    bool json = false;
};

void measure(const MeasureOptions& options) {
    const nlohmann::json results = postproc::write_measures(options.run, options.name);
    std::cout << (options.json ? results.dump(2) + "\n" : postproc::measures_text(results));
    if (!postproc::is_room_run(options.run)) return;
    if (const std::string warning = postproc::unfinished_room(options.run); !warning.empty()) say("warning: " + warning);
}

}  // namespace

void add_measure(CLI::App& app) {
    auto* command = app.add_subcommand("measure", "Make a run's measures anew, from its pictures and tables: report/measures.json.");
    const auto options = std::make_shared<MeasureOptions>();
    command->add_option("run_directory", options->run, "A run with a measures.json, such as a room's")->required();
    command->add_option("--what", options->name, "Name of the only measure to make");
    command->add_flag("--json", options->json, "Print report/measures.json");
    command->callback([options] { measure(*options); });
}

}  // namespace cutterflow::cli
