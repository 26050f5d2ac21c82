/// \file cutterflow: the command line.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>

#include "cases/cli/commands.hpp"
#include "geometry/base/child_process.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/parameter.hpp"
#include "geometry/base/versions.hpp"

namespace {

using namespace cutterflow;

constexpr int k_interrupted = 130;  // as shells count SIGINT

/// CLI11 would only say that a sub-command is missing.
void require_known_command(const CLI::App& app, const std::string& word) {
    std::vector<std::string> known;
    for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
    if (word.front() == '-' || std::find(known.begin(), known.end(), word) != known.end()) return;
    const std::string nearest = nearest_word(word, known);
    throw UserError(fmt::format("there is no command {}", word), fmt::format("The commands are {}", fmt::join(known, ", ")),
                    nearest.empty() ? "See cutterflow --help" : fmt::format("Did you mean {}?", nearest));
}

int run(int argc, char** argv) {
    CLI::App app("Predicts flow-induced spillage in the rotating cutter head of a cutter suction dredger: cutter STL in, report out.",
                 "cutterflow");
    app.require_subcommand(1);
    app.set_version_flag("--version", build_versions_text());
    app.footer(
        "Start with: cutterflow new --cutter head.stl my_study.toml\n"
        "Exit codes: 0 done, 1 defect of the program, 2 wrong input, 3 an external program failed, 4 a check failed.");
    cli::add_new(app);
    cli::add_params(app);
    cli::add_generate_cutter(app);
    cli::add_generate_solid(app);
    cli::add_inspect(app);
    cli::add_repair(app);
    cli::add_check(app);
    cli::add_mesh(app);
    cli::add_run(app);
    cli::add_report(app);
    cli::add_sweep(app);
    cli::add_compare(app);
    cli::add_verify(app);
    if (argc > 1 && argv[1][0] != '\0') require_known_command(app, argv[1]);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? static_cast<int>(ExitCode::done) : static_cast<int>(ExitCode::user_input);
    }
    return static_cast<int>(ExitCode::done);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const Failure& failure) {
        std::cerr << "cutterflow: " << failure.what() << std::endl;
        return static_cast<int>(failure.code());
    } catch (const Interrupted& interrupted) {
        std::cerr << "cutterflow: " << interrupted.what() << std::endl;
        return k_interrupted;
    } catch (const std::filesystem::filesystem_error& error) {
        const UserError told(error.what(), "Every path must exist or be creatable", "Check the path and its permissions");
        std::cerr << "cutterflow: " << told.what() << std::endl;
        return static_cast<int>(told.code());
    } catch (const std::exception& error) {
        std::cerr << "cutterflow: defect: " << error.what() << ". Please report it with the command and its input." << std::endl;
        return static_cast<int>(ExitCode::defect);
    }
}
