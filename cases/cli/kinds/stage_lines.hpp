#pragma once
/// \file What a user reads while the stages of a run go on.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/cli/kinds/study_kind.hpp"
#include "cases/runner/stages.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::cli {

/// Progress goes to standard error; standard output has the requested result.
inline void say(const std::string& text) {
    std::cerr << "  " << text << std::endl;
}

inline cases::StageObserver stage_lines(std::size_t count) {
    return [count, index = std::make_shared<std::size_t>(0)](const cases::Stage& stage, cases::StageEvent event, double wall_s) {
        if (event != cases::StageEvent::ends) ++*index;
        const std::string title = fmt::format("[{}/{}] {}", *index, count, stage.name);
        if (event == cases::StageEvent::skipped) std::cerr << title << ": already done" << std::endl;
        if (event == cases::StageEvent::begins) std::cerr << title << std::endl;
        if (event == cases::StageEvent::ends) std::cerr << title << ": done in " << duration_text(wall_s) << std::endl;
    };
}

/// Warnings for programs that read them.
inline nlohmann::json mistakes_json(const std::vector<Mistake>& mistakes) {
    nlohmann::json list = nlohmann::json::array();
    for (const Mistake& mistake : mistakes) list.push_back(mistake.text());
    return list;
}

/// The report's results, or what the solver warned of and where the page is.
/// \param lines  between the two
inline void say_report(const std::filesystem::path& results_file, const std::filesystem::path& page, bool json,
                       const std::string& lines = {}) {
    const std::string results = read_file(results_file);
    if (json) {
        std::cout << results << std::flush;
        return;
    }
    for (const nlohmann::json& warning : nlohmann::json::parse(results).value("warnings", nlohmann::json::array()))
        say("warning: " + warning.get<std::string>());
    std::cout << lines << fmt::format("the report: {}\n", page.string()) << std::flush;
}

inline void say_where_the_report_is(const RunOptions& options, const cases::RunDirectory& directory) {
    say_report(directory.file(names::results_json), directory.file(names::report_page), options.json);
}

}  // namespace cutterflow::cli
