#include "cases/replay/repeats.hpp"

#include <map>

#include <fmt/format.h>

#include "geometry/base/json_document.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/analysis/settings/distinct_runs.hpp"
#include "postproc/run/input_files.hpp"
#include "postproc/run/study_setting.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

using Values = std::map<std::string, std::string>;

postproc::StudySetting setting_of(const RepeatedRun& run) {
    const fs::path manifest = run.folder / names::manifest;
    const nlohmann::json stages =
        read_json_document(manifest, {{"stages", JsonKind::object, true}}, "Start again in another directory with -o");
    return postproc::study_setting(run.study, postproc::input_files(stages));
}

std::string value_of(const Values& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() || found->second.empty() ? "nothing" : found->second;
}

/// "rotor.speed_rpm = 90 (the first run has 60)", of every key in which they differ.
std::vector<std::string> differences(const Values& first, const Values& other) {
    Values keys = first;
    keys.insert(other.begin(), other.end());
    std::vector<std::string> texts;
    for (const auto& [key, either] : keys)
        if (const std::string of_first = value_of(first, key), of_other = value_of(other, key); of_first != of_other)
            texts.push_back(fmt::format("{} = {} (the first run has {})", key, of_other, of_first));
    return texts;
}

}  // namespace

std::vector<Mistake> check_repeats(const std::vector<RepeatedRun>& runs) {
    Mistakes mistakes;
    std::vector<postproc::StudySetting> settings;
    std::vector<fs::path> folders;
    for (const RepeatedRun& run : runs) {
        settings.push_back(setting_of(run));
        folders.push_back(run.folder);
        const std::vector<std::string> differing = differences(settings.front().values, settings.back().values);
        if (!differing.empty())
            mistakes.add({run.folder.string(), fmt::format("{}", fmt::join(differing, ", ")),
                          "The runs of a replay are repeats of one study: they differ by name, feed.seed and feed.start_revolution alone",
                          "Replay the runs of each setting by a command of their own, or all settings of a sweep with its --replay"});
    }
    const auto is_copy = [&](std::size_t a, std::size_t b) {
        return settings[a].values == settings[b].values && settings[a].release == settings[b].release;
    };
    mistakes.gather([&] { postproc::require_distinct(folders, is_copy, "feed.seed and feed.start_revolution"); });
    return mistakes.take();
}

}  // namespace cutterflow::cases
