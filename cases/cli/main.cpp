/// \file cutterflow: the command line.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <system_error>

#include <fmt/format.h>

#include "cases/cli/commands.hpp"
#include "cases/cli/numbers.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/versions.hpp"

namespace {

using namespace cutterflow;

/// Names the nearest command, which CLI11 does not do.
void require_known_command(const CLI::App& app, const std::string& word) {
    std::vector<std::string> known;
    for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
    if (word.front() == '-' || std::find(known.begin(), known.end(), word) != known.end()) return;
    const std::string nearest = nearest_word(word, known);
    throw UserError(fmt::format("there is no command {}", word), fmt::format("The commands are {}", fmt::join(known, ", ")),
                    nearest.empty() ? "See cutterflow --help" : fmt::format("Did you mean {}?", nearest));
}

/// The innermost command whose words were being read ("box" of "generate-solid box"), or the program itself.
CLI::App& command_of(CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    return commands.empty() ? app : command_of(*commands.front());
}

std::string name_of(const CLI::App& command) {
    return command.get_parent() == nullptr ? command.get_name() : name_of(*command.get_parent()) + " " + command.get_name();
}

/// Words that belong to no option.
std::vector<Mistake> unknown_words(const CLI::App& command) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options({}))
        if (!option->get_positional()) known.push_back(option->get_name());
    std::vector<Mistake> mistakes;
    for (const std::string& word : command.remaining()) {
        if (word.front() != '-') {
            mistakes.push_back({"", fmt::format("\"{}\" is one word too many", word), fmt::format("{} takes no more", name_of(command)),
                                fmt::format("Remove it, or see {} --help", name_of(command))});
            continue;
        }
        const std::string nearest = nearest_word(word.substr(0, word.find('=')), known);
        mistakes.push_back({"", fmt::format("{} has no option {}", name_of(command), word),
                            fmt::format("Its options are {}", fmt::join(known, ", ")),
                            nearest.empty() ? fmt::format("See {} --help", name_of(command)) : fmt::format("Did you mean {}?", nearest)});
    }
    return mistakes;
}

void add_once(std::vector<std::string>& texts, const std::string& text) {
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
}

/// Every value that its option does not take, and every required one that is not there. The parser stops at the first.
void add_wrong_values(CLI::App& command, std::vector<std::string>& texts) {
    for (CLI::Option* option : command.get_options({})) {
        if (option->get_required() && option->count() == 0) add_once(texts, option->get_name() + " is required");
        const std::vector<std::string> values = option->results();
        for (const std::string& value : values) {
            option->clear();
            option->add_result(value);
            try {
                option->run_callback();
            } catch (const CLI::ParseError& error) {
                if (error.get_exit_code() != 0) add_once(texts, error.what());
            }
        }
    }
}

/// What the option parser did not take, with the rule and what to do.
UserError refusal(const CLI::ParseError& error, CLI::App& app) {
    CLI::App& command = command_of(app);
    std::vector<Mistake> mistakes = unknown_words(command);
    std::vector<std::string> texts;
    if (mistakes.empty() || dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) texts.emplace_back(error.what());
    add_wrong_values(command, texts);
    std::string usage = name_of(command);
    if (!command.get_subcommands({}).empty()) usage += " COMMAND";
    for (const CLI::Option* option : command.get_options({}))
        if (option->get_positional()) usage += fmt::format(option->get_required() ? " {}" : " [{}]", option->get_name());
    for (const std::string& text : texts)
        mistakes.push_back({"", text, fmt::format("The command is written as: {} [options]", usage),
                            fmt::format("{} --help names each option and what it takes", name_of(command))});
    return UserError(std::move(mistakes));
}

void refuse_empty_words(CLI::App& app) {
    for (CLI::Option* option : app.get_options({}))
        if (option->get_items_expected_max() > 0) option->check(cli::k_not_empty);
    for (CLI::App* command : app.get_subcommands({})) refuse_empty_words(*command);
}

/// What the operating system did not do with a path.
UserError refusal(const std::filesystem::filesystem_error& error) {
    const std::string path = error.path1().string();
    if (error.code() == std::errc::filename_too_long)
        return {fmt::format("the path \"{}...\", {} letters long, cannot be used", path.substr(0, 40), path.size()),
                "The name of a file or folder has at most 255 bytes, a path 4,095", "Choose a shorter name"};
    return {fmt::format("{}: {}", path, error.code().message()), "Every path must exist or be creatable",
            "Check the path and its permissions"};
}

int run(int argc, char** argv) {
    CLI::App app("Predicts flow-induced spillage in the rotating cutter head of a cutter suction dredger: cutter STL in, report out.",
                 "cutterflow");
    app.require_subcommand(1);
    app.set_version_flag("--version", build_versions_text());
    app.footer(
        "Start with: cutterflow new --cutter head.stl my_study.toml\n"
        "Exit codes: 0 done, 1 defect of the program, 2 wrong input, 3 an external program failed, 4 a check failed, 130 stopped by "
        "Ctrl-C.");
    cli::add_new(app);
    cli::add_params(app);
    cli::add_generate_cutter(app);
    cli::add_generate_solid(app);
    cli::add_clump(app);
    cli::add_inspect(app);
    cli::add_repair(app);
    cli::add_check(app);
    cli::add_mesh(app);
    cli::add_run(app);
    cli::add_report(app);
    cli::add_measure(app);
    cli::add_sweep(app);
    cli::add_compare(app);
    cli::add_calibrate(app);
    cli::add_replay(app);
    cli::add_verify(app);
    refuse_empty_words(app);
    if (argc > 1 && argv[1][0] != '\0') require_known_command(app, argv[1]);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) throw refusal(error, app);
        app.exit(error);  // prints the help or the versions
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
        return static_cast<int>(ExitCode::interrupted);
    } catch (const std::filesystem::filesystem_error& error) {
        const UserError told = refusal(error);
        std::cerr << "cutterflow: " << told.what() << std::endl;
        return static_cast<int>(told.code());
    } catch (const std::exception& error) {
        std::cerr << "cutterflow: defect: " << error.what() << ". Please report it with the command and its input." << std::endl;
        return static_cast<int>(ExitCode::defect);
    }
}
