/// \file new, params, check: what can be done with a study alone.
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/commands.hpp"
#include "cases/cli/new_file.hpp"
#include "cases/runner/disk_space.hpp"
#include "cases/runner/machine.hpp"
#include "cases/runner/prediction.hpp"
#include "cases/scenes/cutter/feed.hpp"
#include "cases/scenes/cutter/study_bank.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/scenes/cutter/velocity_points.hpp"
#include "cases/scenes/free_surface/surface_study.hpp"
#include "cases/study/study.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/process/shell_word.hpp"
#include "geometry/io/length_unit.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char *k_cutter = "cutter", *k_free_surface = "free_surface";

struct NewOptions {
    std::string study = "study.toml";
    std::string cutter;
    std::optional<std::string> unit;
    std::string kind = k_cutter;
};

void write_new_study(const NewOptions& options) {
    require_new_file(options.study);
    if (options.kind == k_free_surface) {
        if (!options.cutter.empty() || options.unit)
            throw UserError("--cutter and --unit with --kind free_surface", "Such a study has no cutter", "Leave them out");
        write_file(options.study, cases::surface_study_template(fs::path(options.study).stem().string()));
        std::cout << fmt::format("wrote {}\nnext: edit it, then cutterflow check {}\n", options.study, shell_word(options.study));
        return;
    }
    if (!options.cutter.empty() && !fs::exists(options.cutter))
        throw UserError(fmt::format("--cutter {} does not exist", options.cutter), "The study names a surface of a cutter",
                        "Check the path");
    if (options.unit) geometry::length_unit_of(*options.unit);  // refuses what is none
    // The study refers to the cutter from its own folder.
    const fs::path folder = fs::absolute(options.study).parent_path();
    const fs::path cutter = options.cutter.empty() ? fs::path("cutter.stl") : fs::absolute(options.cutter).lexically_relative(folder);
    write_file(options.study, cases::study_template(fs::path(options.study).stem().string(), cutter.string(), options.unit));
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
    std::string kind = k_cutter;
    bool json = false;
};

void print_parameters(const ParamsOptions& options) {
    const ParameterTable& table = options.kind == k_free_surface ? cases::surface_study_table() : cases::study_table();
    if (!options.json) {
        std::cout << parameters_text(table);
        return;
    }
    nlohmann::json rows = nlohmann::json::array();
    for (const Parameter& parameter : table) rows.push_back(parameter_json(parameter));
    std::cout << rows.dump(2) << std::endl;
}

struct CheckOptions {
    std::string study;
    int ranks = 1;
    bool json = false;
};

nlohmann::json mistakes_json(const std::vector<Mistake>& mistakes) {
    nlohmann::json list = nlohmann::json::array();
    for (const Mistake& mistake : mistakes) list.push_back(mistake.text());
    return list;
}

void check_surface_file(const CheckOptions& options) {
    const cases::SurfaceCheck check = cases::check_surface_study(options.study);
    if (options.json) {
        std::cout << nlohmann::json{{"scene", check.scene}, {"prediction", check.prediction}, {"warnings", check.notes}}.dump(2)
                  << std::endl;
        return;
    }
    std::cout << to_text(check) << fmt::format("{} is valid; next: cutterflow run {}\n", options.study, shell_word(options.study));
}

void check_study_file(const CheckOptions& options) {
    if (fs::exists(options.study) && cases::is_surface_study(options.study)) return check_surface_file(options);
    Mistakes mistakes;
    cases::CheckedStudy checked;
    mistakes.gather([&] { cases::require_machine(options.ranks); });
    mistakes.gather([&] { checked = cases::read_checked_study(options.study); });
    mistakes.refuse();
    const auto& [resolved, inspection, size] = checked;
    const cases::Study study = cases::make_study(resolved, fs::path(options.study).parent_path());
    const cases::Prediction prediction = cases::predict(study, size, inspection.head->surface, {options.ranks, cases::machine_slowness()});
    const geometry::Contour contour = cases::head_contour(*inspection.head, study.suction.gap);
    if (study.report.adv_points) cases::require_adv_points(study, size, inspection.head->surface);
    const auto feeds = cases::place_feeds(study, cases::feed_scene(study, size, contour, inspection.head->surface));
    std::vector<Mistake> warnings = cases::study_warnings(resolved, size);
    for (const Mistake& warning : cases::prediction_warnings(study, prediction)) warnings.push_back(warning);
    for (const Mistake& warning : cases::carrying_warnings(study, *inspection.head)) warnings.push_back(warning);
    for (const Mistake& warning : cases::blade_warnings(study, *inspection.head)) warnings.push_back(warning);
    for (const Mistake& warning : meshing::mesh_warnings(cases::mesh_input_of(study, size, inspection.head->surface)))
        warnings.push_back(warning);
    const fs::path run = fs::path("runs") / fs::path(options.study).stem();  // where it goes without -o
    if (const auto missing = cases::missing_space(run, prediction.mesh_disk + prediction.run_disk)) warnings.push_back(*missing);
    if (options.json) {
        std::cout << nlohmann::json{{"cutter", geometry::to_json(inspection)},
                                    {"bank", cases::bank_json(study, contour)},
                                    {"prediction", to_json(prediction)},
                                    {"feeds", nlohmann::json::parse(cases::feed_json(feeds, study)).at("feeds")},
                                    {"warnings", mistakes_json(warnings)}}
                         .dump(2)
                  << std::endl;
        return;
    }
    std::cout << geometry::to_text(inspection) << cases::bank_text(study, contour) << "\n" << to_text(prediction);
    for (const std::string& line : cases::feed_lines(feeds)) std::cout << line << "\n";
    for (const Mistake& warning : warnings) std::cout << "warning: " << warning.text() << "\n";
    std::cout << fmt::format("{} is valid; next: cutterflow run {} --ranks {}\n", options.study, shell_word(options.study), options.ranks);
}

}  // namespace

void add_new(CLI::App& app) {
    auto* command = app.add_subcommand("new", "Write a commented study file to edit.");
    const auto options = std::make_shared<NewOptions>();
    command->add_option("study", options->study, "File to write")->capture_default_str();
    command->add_option("--cutter", options->cutter, "Surface of the cutter (STL, OBJ or PLY)");
    command->add_option("--unit", options->unit, "Its unit of length: m, mm, cm, inch, ft");
    command->add_option("--kind", options->kind, "What is studied: a cutter, or a scene with a free surface")
        ->check(CLI::IsMember({k_cutter, k_free_surface}))
        ->capture_default_str();
    command->callback([options] { write_new_study(*options); });
}

void add_params(CLI::App& app) {
    auto* command = app.add_subcommand("params", "Print every key of a study: unit, bounds, default, meaning.");
    const auto options = std::make_shared<ParamsOptions>();
    command->add_option("--kind", options->kind, "Kind of the study")
        ->check(CLI::IsMember({k_cutter, k_free_surface}))
        ->capture_default_str();
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
    command->callback([options] { check_study_file(*options); });
}

}  // namespace cutterflow::cli
