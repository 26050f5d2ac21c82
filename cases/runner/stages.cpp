#include "cases/runner/stages.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/run_files.hpp"

namespace cutterflow::cases {
namespace {

bool covers(const std::vector<std::string>& places, const std::string& file) {
    return std::any_of(places.begin(), places.end(),
                       [&](const std::string& place) { return place.back() == '/' ? file.rfind(place, 0) == 0 : file == place; });
}

/// An input that is a file has its SHA-256 as its value.
std::string change_text(const std::string& name, const std::string& before, const std::string& now) {
    return is_sha256(before) && is_sha256(now) ? name + " (the file has other content)" : fmt::format("{} ({} -> {})", name, before, now);
}

/// Names of inputs whose values differ, or that only one of both has.
std::vector<std::string> changed_inputs(const std::map<std::string, std::string>& before, const std::map<std::string, std::string>& now) {
    std::vector<std::string> changed;
    for (const auto& [name, value] : now) {
        const auto found = before.find(name);
        if (found == before.end() || found->second != value)
            changed.push_back(found == before.end() ? name : change_text(name, found->second, value));
    }
    for (const auto& [name, value] : before)
        if (now.count(name) == 0) changed.push_back(name);
    return changed;
}

bool is_as_written(const std::filesystem::path& file, const std::string& hash) {
    return std::filesystem::is_regular_file(file) && sha256_of_file(file) == hash;
}

bool is_lost(const std::filesystem::path& file) {
    return !std::filesystem::is_regular_file(file) || std::filesystem::file_size(file) == 0;
}

class Plan {
public:
    Plan(const RunDirectory& directory, const Manifest& manifest, const std::vector<Stage>& stages)
        : directory_(directory), manifest_(manifest), stages_(stages) {}

    /// First stage that is not done with these inputs; the number of stages when there is none.
    std::size_t first_to_do() const {
        for (std::size_t i = 0; i < stages_.size(); ++i) {
            const StageRecord* record = manifest_.find(stages_[i].name);
            if (record == nullptr || record->state != StageState::done || record->inputs != stages_[i].inputs) return i;
            for (const std::string& file : stages_[i].made_again)
                if (is_lost(directory_.file(file))) return i;
        }
        return stages_.size();
    }

    void require_unchanged_files() const {
        std::vector<Mistake> mistakes;
        for (std::size_t i = 0; i < stages_.size(); ++i) {
            const StageRecord* record = manifest_.find(stages_[i].name);
            if (record == nullptr) continue;
            for (const auto& [file, hash] : record->outputs)
                if (!is_rewritten_later(file, i)) check_file(stages_[i].name, file, hash, mistakes);
        }
        if (!mistakes.empty()) throw UserError(mistakes);
    }

    void require_results_are_safe(std::size_t first) const {
        for (std::size_t i = 0; i <= first && i < stages_.size(); ++i) {
            const StageRecord* record = manifest_.find(stages_[i].name);
            if (!has_results_from(i)) continue;
            if (record == nullptr)
                throw UserError(fmt::format("{} contains results of another kind of study, which has no stage {}",
                                            directory_.path().string(), stages_[i].name),
                                "Results are never overwritten", "Use another directory with -o");
            if (record->inputs == stages_[i].inputs) continue;
            throw UserError(fmt::format("{} contains results of another study: {}", directory_.path().string(),
                                        fmt::join(changed_inputs(record->inputs, stages_[i].inputs), ", ")),
                            "Results are never overwritten", "Use another directory for the changed study with -o, or undo the change");
        }
    }

    void require_resume_when_interrupted(std::size_t first, bool resume) const {
        if (resume || first == stages_.size() || !stages_[first].resumable) return;
        const StageRecord* record = manifest_.find(stages_[first].name);
        if (record == nullptr || record->inputs != stages_[first].inputs) return;
        throw UserError(fmt::format("the stage {} in {} was interrupted", stages_[first].name, directory_.path().string()),
                        "Its results are kept",
                        "Add --resume to continue from its last checkpoint, or start again in another directory with -o");
    }

    /// Stages whose records are no longer true once stage `i` begins.
    std::vector<std::string> after(std::size_t i) const {
        std::vector<std::string> names;
        for (std::size_t j = i + 1; j < stages_.size(); ++j) names.push_back(stages_[j].name);
        return names;
    }

private:
    bool has_results_from(std::size_t i) const {
        for (std::size_t j = i; j < stages_.size(); ++j)
            if (stages_[j].resumable && manifest_.find(stages_[j].name) != nullptr) return true;
        return false;
    }

    bool is_rewritten_later(const std::string& file, std::size_t writer) const {
        for (std::size_t i = writer + 1; i < stages_.size(); ++i)
            if (manifest_.find(stages_[i].name) != nullptr && covers(stages_[i].rewrites, file)) return true;
        return false;
    }

    void check_file(const std::string& stage, const std::string& file, const std::string& hash, std::vector<Mistake>& mistakes) const {
        const std::filesystem::path path = directory_.file(file);
        if (is_as_written(path, hash)) return;
        const bool there = std::filesystem::exists(path);
        mistakes.push_back({path.string(), there ? "this generated file was changed by hand" : "this generated file was removed",
                            fmt::format("It belongs to the stage {} and is not overwritten", stage),
                            there ? fmt::format("Keep your version as overrides/{} in a new run directory, or undo the change", file)
                                  : "Start again in another directory with -o"});
    }

    const RunDirectory& directory_;
    const Manifest& manifest_;
    const std::vector<Stage>& stages_;
};

std::map<std::string, std::string> hashes_of(const RunDirectory& directory, const std::vector<std::string>& files) {
    std::map<std::string, std::string> hashes;
    for (const std::string& file : files) hashes[file] = sha256_of_file(directory.file(file));
    return hashes;
}

std::size_t index_after(const std::vector<Stage>& stages, const std::string& name) {
    const auto found = std::find_if(stages.begin(), stages.end(), [&](const Stage& stage) { return stage.name == name; });
    if (found == stages.end()) throw std::logic_error("there is no stage " + name);
    return static_cast<std::size_t>(found - stages.begin()) + 1;
}

}  // namespace

void run_stages(const RunDirectory& directory, Manifest& manifest, const std::vector<Stage>& stages, const std::string& until, bool resume,
                const StageObserver& observer) {
    const Plan plan(directory, manifest, stages);
    const std::size_t end = index_after(stages, until);
    const std::size_t first = plan.first_to_do();
    plan.require_unchanged_files();
    plan.require_results_are_safe(first);
    if (first < end) plan.require_resume_when_interrupted(first, resume);
    for (std::size_t i = 0; i < end; ++i) {
        const Stage& stage = stages[i];
        if (i < first) {
            observer(stage, StageEvent::skipped, 0.0);
            continue;
        }
        observer(stage, StageEvent::begins, 0.0);
        const bool goes_on = stage.resumable && manifest.find(stage.name) != nullptr;
        const auto begin = std::chrono::steady_clock::now();
        manifest.start(stage.name, stage.inputs, plan.after(i));
        const double core_s = children_core_s();
        const auto wall = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
        StageOutcome outcome;
        try {
            outcome = stage.work(goes_on);
        } catch (...) {
            manifest.note_cost(stage.name, wall(), children_core_s() - core_s);
            throw;
        }
        const double wall_s = wall();
        manifest.finish(stage.name, hashes_of(directory, outcome.outputs), wall_s, outcome.core_s);
        observer(stage, StageEvent::ends, wall_s);
    }
}

std::string why_not_shared(const std::filesystem::path& from, const std::vector<Stage>& wanted) {
    const Manifest donor(from / names::manifest);
    for (const Stage& stage : wanted) {
        const StageRecord* record = donor.find(stage.name);
        if (record == nullptr || record->state != StageState::done) return fmt::format("its stage {} is not finished", stage.name);
        const std::vector<std::string> changed = changed_inputs(record->inputs, stage.inputs);
        if (!changed.empty()) return fmt::format("other values of {}", fmt::join(changed, ", "));
        for (const auto& [file, hash] : record->outputs)
            if (!is_as_written(from / file, hash)) return fmt::format("its file {} was changed or is gone", file);
    }
    return "";
}

bool stages_are_done(const std::filesystem::path& run, const std::vector<std::string>& stages) {
    const Manifest manifest(run / names::manifest);
    return std::all_of(stages.begin(), stages.end(), [&](const std::string& stage) {
        const StageRecord* record = manifest.find(stage);
        return record != nullptr && record->state == StageState::done;
    });
}

void share_stages(const std::filesystem::path& from, const std::filesystem::path& to, const std::vector<std::string>& stages) {
    if (std::filesystem::exists(to / names::manifest) || !stages_are_done(from, stages)) return;
    const Manifest donor(from / names::manifest);
    Manifest manifest(to / names::manifest);
    for (const std::string& stage : stages) {
        const StageRecord* record = donor.find(stage);
        for (const auto& [file, hash] : record->outputs) {
            std::filesystem::create_directories((to / file).parent_path());
            std::filesystem::copy_file(from / file, to / file, std::filesystem::copy_options::overwrite_existing);
        }
        manifest.start(stage, record->inputs, {});
        manifest.finish(stage, record->outputs, 0.0, 0.0);
    }
}

}  // namespace cutterflow::cases
