/// \file verify: the built-in verification suite.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "cases/cli/commands.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/base/process/child_process.hpp"
#include "validation/harness/suite/case_runs.hpp"

namespace cutterflow::cli {
namespace {

namespace fs = std::filesystem;
using validation::CaseVerdict;
using validation::Effort;
using validation::VerifiedCase;

constexpr const char* k_kept = "results/validation";
constexpr const char* k_charts = "charts";  // what they are drawn from, in the folder of results

struct VerifyOptions {
    std::vector<std::string> names, pareto;
    std::string output = "runs/verification";
    bool list = false, all = false, fast = false, longest = false, json = false, resume = false, publish = false;
};

validation::VerificationPlaces places() {
    const Installation own = installation();
    return {own.data / "validation/cases", own.verification, own.programs, own.data / "docs" / k_kept, own.data / "cases/examples"};
}

void say(const std::string& text) {
    std::cerr << "  " << text << std::endl;
}

void list(const std::vector<validation::VerificationCase>& all, bool json) {
    nlohmann::json rows = nlohmann::json::array();
    for (const validation::VerificationCase& one : all) {
        rows.push_back({{"case", one.name}, {"title", one.title}, {"class", validation::effort_text(one.effort)}, {"needs", one.needs}});
        if (!json) std::cout << fmt::format("{:26} {:9} {}\n", one.name, validation::effort_text(one.effort), one.title);
    }
    if (json) std::cout << rows.dump(2) << "\n";
}

Effort effort_of(const VerifyOptions& options) {
    return options.fast ? Effort::fast : options.longest ? Effort::longest : Effort::standard;
}

/// Options of which one would be ignored.
void require_consistent(const VerifyOptions& options) {
    struct Option {
        const char* name;
        bool given;
    };
    const Option names{"cases by name", !options.names.empty()}, pareto{"--pareto", !options.pareto.empty()}, all{"--all", options.all},
        fast{"--fast", options.fast}, longest{"--long", options.longest}, list{"--list", options.list}, resume{"--resume", options.resume},
        publish{"--publish", options.publish};
    std::vector<Mistake> mistakes;
    const auto exclude = [&](const Option& one, const std::vector<Option>& others, const char* rule, const char* remedy) {
        for (const Option& other : others)
            if (one.given && other.given) mistakes.push_back({"", fmt::format("{} with {}", one.name, other.name), rule, remedy});
    };
    exclude(all, {names, pareto}, "--all runs every case", "Name the cases, or give --all");
    exclude(fast, {all, longest, pareto}, "--fast runs the quick part of the cases, the others all of it", "Give one of them");
    exclude(list, {names, pareto, all, fast, longest, resume, publish}, "--list runs nothing", "Give --list alone, or with --json");
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

std::vector<validation::VerificationCase> selected(const std::vector<validation::VerificationCase>& all, const VerifyOptions& options) {
    if (!options.all && !options.fast && options.names.empty() && !options.publish)
        throw UserError("no case is named", "verify takes names, --fast or --all", "See cutterflow verify --list");
    std::vector<validation::VerificationCase> chosen = validation::select_cases(all, options.names);
    if (!options.names.empty() || (!options.all && !options.fast)) return chosen;
    std::copy_if(all.begin(), all.end(), std::back_inserter(chosen),
                 [&](const validation::VerificationCase& one) { return one.effort <= effort_of(options); });
    return chosen;
}

/// A folder's path from another, for links.
std::string link_to_cases(const fs::path& from) {
    return fs::canonical(places().cases).lexically_relative(fs::absolute(from).lexically_normal()).string() + "/";
}

/// docs/ of the source tree, which an installation copies.
/// \throws UserError  when the program is installed
fs::path published_docs() {
    const fs::path docs = fs::canonical(installation().data / "docs");
    if (!fs::exists(docs.parent_path() / "CMakeLists.txt"))
        throw UserError(fmt::format("--publish writes to {}, which is installed", docs.string()),
                        "Results are published in the source tree", "Give the command to build/bin/cutterflow of a clone");
    return docs;
}

/// Results of the folder join those kept in the repository, and its pages are made from all.
void publish(const std::vector<VerifiedCase>& results) {
    const fs::path docs = published_docs(), kept = docs / k_kept;
    const std::vector<VerifiedCase> all = validation::merged_verification(validation::read_verification(kept), results);
    for (const VerifiedCase& result : all) write_file(kept / (result.name + ".json"), validation::case_json(result).dump(1) + "\n");
    write_file(docs / "validation.md", validation::verification_markdown(all, link_to_cases(docs)));
    say(fmt::format("published: {}", (docs / "validation.md").string()));
}

void write_pages(const fs::path& folder, const validation::VerificationPlaces& where) {
    std::vector<VerifiedCase> all = validation::read_verification(folder);  // what was found here is shown, better or worse
    for (const VerifiedCase& published : validation::read_verification(where.kept))
        if (std::none_of(all.begin(), all.end(), [&](const VerifiedCase& own) { return own.name == published.name; }))
            all.push_back(published);
    std::sort(all.begin(), all.end(), [](const VerifiedCase& a, const VerifiedCase& b) { return a.name < b.name; });
    write_file(folder / "validation.md", validation::verification_markdown(all, link_to_cases(folder)));
    write_file(folder / "index.html", validation::verification_page(all, link_to_cases(folder), folder / k_charts));
    say(fmt::format("the page, with earlier results of other cases: {}", (folder / "index.html").string()));
}

void verify(const VerifyOptions& options) {
    const validation::VerificationPlaces where = places();
    const std::vector<validation::VerificationCase> all = validation::find_verification_cases(where.cases);
    if (options.list) return list(all, options.json);
    const std::vector<validation::VerificationCase> chosen = selected(all, options);
    if (options.publish) published_docs();  // refuses before hours of work
    if (options.publish && chosen.empty() && validation::read_verification(options.output).empty())
        throw UserError(fmt::format("{} contains no results", options.output), "Only results of earlier runs can be published",
                        "Name the folder of the results with -o, or cases to run");
    std::vector<VerifiedCase> results;
    try {
        results = validation::run_verification(chosen, where, {options.output, effort_of(options), options.resume}, say);
    } catch (const Interrupted& interrupted) {
        throw Interrupted(
            fmt::format("{}. Finished cases are kept in {}; repeat the command with --resume", interrupted.what(), options.output));
    }
    nlohmann::json rows = nlohmann::json::array();
    std::vector<std::string> failed;
    for (const VerifiedCase& result : results) {
        rows.push_back(validation::case_json(result));
        if (!options.json) std::cout << validation::verification_text(result);
        if (result.verdict() == CaseVerdict::fail || result.verdict() == CaseVerdict::not_converged) failed.push_back(result.name);
    }
    if (options.json) std::cout << rows.dump(2) << std::endl;
    write_pages(options.output, where);
    if (options.publish) publish(validation::read_verification(options.output));
    if (!failed.empty())
        throw CheckFailure({"", fmt::format("{} of {} cases did not pass: {}", failed.size(), results.size(), fmt::join(failed, ", ")), "",
                            fmt::format("Their logs and files are in {}", options.output)});
}

}  // namespace

void add_verify(CLI::App& app) {
    auto* command = app.add_subcommand("verify", "Run cases with a known answer and report the errors of the program.");
    const auto options = std::make_shared<VerifyOptions>();
    command->add_option("cases", options->names, "Cases by name");
    command->add_flag("--fast", options->fast, "The quick part of all cases (or of those named): what CI runs");
    command->add_option("--pareto", options->pareto,
                        "Error against cost, one chart per option, defaults marked: the cases pareto_<name> (about an hour)");
    command->add_flag("--all", options->all, "All cases, in full");
    command->add_flag("--long", options->longest, "Also the parts that take hours");
    command->add_flag("--list", options->list, "List the cases");
    command->add_option("-o,--output", options->output, "Folder of the results")->capture_default_str();
    command->add_flag("--resume", options->resume, "Keep the cases of the folder that were finished with the same programs");
    command->add_flag("--publish", options->publish, "Copy the folder's results to docs/results/validation and rewrite docs/validation.md");
    command->add_flag("--json", options->json, "Print the results as JSON");
    command->callback([options] {
        require_consistent(*options);
        for (const std::string& name : options->pareto) options->names.push_back("pareto_" + name);
        options->longest = options->longest || !options->pareto.empty();
        verify(*options);
    });
}

}  // namespace cutterflow::cli
