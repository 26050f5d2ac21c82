/// \file fuzz: mutated files of every kind before the readers of the commands; counts how they end and keeps what should not be.
#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/progress.hpp"
#include "validation/fuzz/kinds.hpp"

#ifdef __SANITIZE_ADDRESS__
/// A process that asks for this much memory at once, or leaves by a sanitizer, is a finding. Memory that is freed is kept from use for
/// the next 16 MB only: the importer's process copies the page tables of all that is held.
extern "C" const char* __asan_default_options() {
    static_assert(cutterflow::validation::k_sanitizer_exit_code == 86);
    return "detect_leaks=0:max_allocation_size_mb=2048:exitcode=86:quarantine_size_mb=16:malloc_context_size=8";
}
#endif

namespace {

namespace fs = std::filesystem;
using namespace cutterflow;
using namespace cutterflow::validation;

#ifdef __SANITIZE_ADDRESS__
constexpr bool k_sanitized = true;
#else
constexpr bool k_sanitized = false;
#endif

const std::vector<FuzzEnd> k_columns{FuzzEnd::done,         FuzzEnd::user_input,    FuzzEnd::external_program,
                                     FuzzEnd::check_failed, FuzzEnd::importer_died, FuzzEnd::defect,
                                     FuzzEnd::died,         FuzzEnd::hung,          FuzzEnd::input_changed};

struct Options {
    std::uint64_t inputs = 100000;
    std::uint64_t first = 0;
    std::uint64_t seed = 1;
    std::vector<std::string> kinds;
    std::string output = "fuzz";
    double core_s = k_sanitized ? 30.0 : 10.0;
};

struct KindResult {
    std::string name;
    std::uint64_t inputs = 0;
    double core_s = 0.0;
    FuzzCounts counts;
};

/// Of this process and of the children that it waited for [s].
double core_seconds() {
    double seconds = 0.0;
    for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        ::getrusage(who, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime})
            seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return seconds;
}

std::vector<FuzzKind> chosen_kinds(const Options& options) {
    std::vector<FuzzKind> kinds = fuzz_kinds();
    std::vector<std::string> known;
    for (const FuzzKind& kind : kinds) known.push_back(kind.name);
    for (const std::string& name : options.kinds)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw UserError(fmt::format("--kind {}", name), fmt::format("The kinds are {}", fmt::join(known, ", ")), "Name one of them");
    const auto is_left_out = [&](const FuzzKind& kind) {
        return !options.kinds.empty() && std::find(options.kinds.begin(), options.kinds.end(), kind.name) == options.kinds.end();
    };
    kinds.erase(std::remove_if(kinds.begin(), kinds.end(), is_left_out), kinds.end());
    return kinds;
}

/// Shares the inputs out by the kinds' weights.
std::vector<std::uint64_t> inputs_of(const std::vector<FuzzKind>& kinds, std::uint64_t inputs) {
    double all = 0.0, so_far = 0.0;
    for (const FuzzKind& kind : kinds) all += kind.weight;
    std::vector<std::uint64_t> counts;
    std::uint64_t given = 0;
    for (const FuzzKind& kind : kinds) {
        so_far += kind.weight;
        const auto until = static_cast<std::uint64_t>(std::llround(static_cast<double>(inputs) * so_far / all));
        counts.push_back(until - given);
        given = until;
    }
    return counts;
}

void keep(const FuzzFinding& finding, const KindResult& result, const Options& options) {
    const fs::path folder = fs::path(options.output) / fmt::format("{}_{}", result.name, finding.index);
    write_file(folder / finding.file, finding.input);
    write_file(folder / "output.txt", finding.output);
    std::cout << fmt::format("finding: {} {}: {}; kept in {}; again: fuzz --kind {} --seed {} --first {} --inputs 1\n", result.name,
                             finding.index, fuzz_end_name(finding.end), folder.string(), result.name, options.seed, finding.index)
              << std::flush;
}

std::uint64_t count_of(const KindResult& result, FuzzEnd end) {
    const auto found = result.counts.ends.find(end);
    return found == result.counts.ends.end() ? 0 : found->second;
}

std::string table_of(const std::vector<KindResult>& results) {
    std::string text = "| kind | inputs |";
    for (const FuzzEnd end : k_columns) text += fmt::format(" {} |", fuzz_end_name(end));
    text += " core s |\n|---|---:|";
    for (std::size_t i = 0; i <= k_columns.size(); ++i) text += "---:|";
    text += "\n";
    for (const KindResult& result : results) {
        text += fmt::format("| {} | {} |", result.name, result.inputs);
        for (const FuzzEnd end : k_columns) text += fmt::format(" {} |", count_of(result, end));
        text += fmt::format(" {:.0f} |\n", result.core_s);
    }
    return text;
}

nlohmann::json json_of(const std::vector<KindResult>& results, const Options& options) {
    nlohmann::json rows = nlohmann::json::array();
    for (const KindResult& result : results) {
        nlohmann::json ends;
        for (const auto& [end, count] : result.counts.ends) ends[fuzz_end_name(end)] = count;
        rows.push_back({{"kind", result.name},
                        {"inputs", result.inputs},
                        {"ends", ends},
                        {"findings", result.counts.findings.size()},
                        {"core_s", result.core_s}});
    }
    return {{"seed", options.seed}, {"first", options.first}, {"sanitized", k_sanitized}, {"kinds", rows}};
}

KindResult try_kind(const FuzzKind& kind, std::uint64_t inputs, const Options& options) {
    KindResult result;
    result.name = kind.name;
    result.inputs = inputs;
    const FuzzLimits limits{options.core_s, k_sanitized ? 0 : FuzzLimits{}.memory};
    const double before = core_seconds();
    Progress progress(kind.name);
    result.counts = try_inputs(kind, options.seed, options.first, inputs, limits, fs::path(options.output) / "work" / kind.name,
                               [&](std::uint64_t done) { progress.update(static_cast<double>(done) / static_cast<double>(inputs)); });
    progress.finish();
    result.core_s = core_seconds() - before;
    for (const FuzzFinding& finding : result.counts.findings) keep(finding, result, options);
    return result;
}

int fuzz(const Options& options) {
    const std::vector<FuzzKind> kinds = chosen_kinds(options);
    if (fs::exists(options.output))
        throw UserError(fmt::format("{} is there", options.output), "Nothing is overwritten", "Name another folder, or move it away");
    const std::vector<std::uint64_t> inputs = inputs_of(kinds, options.inputs);
    std::vector<KindResult> results;
    std::size_t findings = 0;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        results.push_back(try_kind(kinds[i], inputs[i], options));
        findings += results.back().counts.findings.size();
        write_file(fs::path(options.output) / "fuzz.json", json_of(results, options).dump(2) + "\n");
    }
    fs::remove_all(fs::path(options.output) / "work");
    std::cout << table_of(results)
              << fmt::format("{} findings in {} inputs, seed {}{}\n", findings, options.inputs, options.seed,
                             k_sanitized ? ", under AddressSanitizer and UndefinedBehaviorSanitizer" : "");
    return static_cast<int>(findings == 0 ? ExitCode::done : ExitCode::check_failed);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Puts mutated files of every kind before the readers of the commands.", "fuzz");
    Options options;
    app.add_option("--inputs", options.inputs, "Number of inputs, shared out over the kinds")->capture_default_str();
    app.add_option("--first", options.first, "Number of the first input of each kind: goes on where another run ended")
        ->capture_default_str();
    app.add_option("--seed", options.seed, "The same seed makes the same inputs")->capture_default_str();
    app.add_option("--kind", options.kinds, "Only these kinds, as stl_ascii,ply")->delimiter(',');
    app.add_option("--core-s", options.core_s, "Core time that one input may take [s]")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("-o,--output", options.output, "New folder for findings and fuzz.json")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        return fuzz(options);
    } catch (const Failure& failure) {
        std::cerr << "fuzz: " << failure.what() << std::endl;
        return static_cast<int>(failure.code());
    }
}
