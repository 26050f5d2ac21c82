/// \file new, params, check: what can be done with a study alone.
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "cases/cli/commands.hpp"
#include "cases/cli/kinds/study_kind.hpp"
#include "cases/cli/new_file.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/shell_word.hpp"

namespace cutterflow::cli {
namespace {

void write_new_study(const NewOptions& options) {
    require_new_file(options.study);
    write_file(options.study, kind_named(options.kind).new_study(options));
    std::cout << fmt::format("wrote {}\nnext: edit it, then cutterflow check {}\n", options.study, shell_word(options.study));
}

nlohmann::json parameter_json(const Parameter& parameter) {
    nlohmann::json row{{"key", parameter.key}, {"unit", parameter.unit}, {"help", parameter.help}, {"repeated", parameter.repeated}};
    row["required"] = !parameter.optional && !parameter.default_value;
    if (parameter.default_value) row["default"] = toml_text(*parameter.default_value);
    if (parameter.optional) row["derived_from"] = parameter.derived_from;
    if (parameter.minimum) row["minimum"] = *parameter.minimum;
    if (parameter.maximum) row["maximum"] = *parameter.maximum;
    if (!parameter.choices.empty()) row["choices"] = parameter.choices;
    return row;
}

struct ParamsOptions {
    std::string kind;
    bool json = false;
};

void print_parameters(const ParamsOptions& options) {
    const ParameterTable& table = kind_named(options.kind).table();
    if (!options.json) {
        std::cout << parameters_text(table);
        return;
    }
    nlohmann::json rows = nlohmann::json::array();
    for (const Parameter& parameter : table) rows.push_back(parameter_json(parameter));
    std::cout << rows.dump(2) << std::endl;
}

/// "Kind of the study: cutter (a cutter head), ...".
void add_kind(CLI::App& command, std::string& kind) {
    std::vector<std::string> words;
    for (const StudyKind& one : study_kinds()) words.push_back(fmt::format("{} ({})", one.name, one.what));
    kind = study_kinds().front().name;
    command.add_option("--kind", kind, fmt::format("Kind of the study: {}", fmt::join(words, ", ")))
        ->check(CLI::IsMember(kind_names()))
        ->capture_default_str();
}

}  // namespace

void add_new(CLI::App& app) {
    auto* command = app.add_subcommand("new", "Write a commented study file to edit.");
    const auto options = std::make_shared<NewOptions>();
    command->add_option("study", options->study, "File to write")->capture_default_str();
    command->add_option("--cutter", options->cutter, "Surface of the cutter (STL, OBJ or PLY)");
    command->add_option("--unit", options->unit, "Its unit of length: m, mm, cm, inch, ft");
    add_kind(*command, options->kind);
    command->callback([options] { write_new_study(*options); });
}

void add_params(CLI::App& app) {
    auto* command = app.add_subcommand("params", "Print every key of a study: unit, bounds, default, meaning.");
    const auto options = std::make_shared<ParamsOptions>();
    add_kind(*command, options->kind);
    command->add_flag("--json", options->json, "Print JSON");
    command->callback([options] { print_parameters(*options); });
}

void add_check(CLI::App& app) {
    auto* command =
        app.add_subcommand("check", "Validate a study and its cutter; predict cells, time step and core hours without running.");
    const auto options = std::make_shared<CheckOptions>();
    command->add_option("study", options->study, "The study file")->required();
    command->add_option("--ranks", options->ranks, "Processes of the run, for the predicted time")->capture_default_str();
    command->add_flag("--json", options->json, "Print JSON");
    command->callback([options] { kind_of_study(options->study).check(*options); });
}

}  // namespace cutterflow::cli
