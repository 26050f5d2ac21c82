#include "validation/harness/suite/case_runs.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "cases/runner/machine.hpp"
#include "cases/runner/run_directory.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/stop_signals.hpp"
#include "geometry/base/progress.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_mark = "verification";  // marks a folder of results as ours
constexpr const char* k_programs = "programs";  // in a case's folder: with which it was begun
constexpr const char* k_written = "written";    // in a case's folder: the files that its program left there
constexpr const char* k_spent = "core_s";       // in a case's folder: core seconds of the starts with which it goes on
constexpr double k_unknown_cost = 20.0;         // core seconds of a case that was never run, for the ETA
constexpr const char* k_words[] = {"fast", "standard", "long"};

/// Value of a line "- key: value" of a README's head; empty when there is none.
std::string head_value(const std::string& text, const std::string& key) {
    const std::string lead = "\n- " + key + ": ";
    const std::size_t start = text.find(lead);
    if (start == std::string::npos) return {};
    const std::size_t value = start + lead.size();
    return text.substr(value, text.find('\n', value) - value);
}

std::vector<std::string> words_of(const std::string& list) {
    std::vector<std::string> words;
    std::istringstream stream(list);
    for (std::string word; std::getline(stream, word, ',');) {
        word.erase(0, word.find_first_not_of(' '));
        if (!word.empty()) words.push_back(word);
    }
    return words;
}

VerificationCase read_case(const fs::path& folder, std::vector<Mistake>& mistakes) {
    const fs::path readme = folder / "README.md";
    const std::string text = read_file(readme);
    const auto effort = std::find(std::begin(k_words), std::end(k_words), head_value(text, "class"));
    if (text.compare(0, 2, "# ") != 0 || effort == std::end(k_words))
        mistakes.push_back({readme.string(), "its head tells no title or no class",
                            "It begins with \"# <title>\" and has a line \"- class: fast\", standard or long", "Write them"});
    return {folder.filename().string(),          text.substr(2, text.find('\n') - 2),    static_cast<Effort>(effort - std::begin(k_words)),
            words_of(head_value(text, "needs")), words_of(head_value(text, "examples")), head_value(text, "resumes") == "yes"};
}

/// Path of a program that a case needs: in cutterflow's folder or on PATH; empty when missing.
fs::path tool(const VerificationPlaces& places, const std::string& name) {
    return fs::exists(places.tools / name) ? places.tools / name : find_program(name);
}

/// Why a case cannot be run here; empty when it can.
std::string obstacle(const VerificationCase& one, const VerificationPlaces& places) {
    if (!fs::exists(places.programs / one.name))
        return fmt::format("its program {} is not built. The solver's cases need CUTTERFLOW_WITH_SOLVER=ON (./bootstrap builds it)",
                           (places.programs / one.name).string());
    std::vector<std::string> missing;
    for (const std::string& name : one.needs)
        if (tool(places, name).empty()) missing.push_back(name);
    return missing.empty() ? "" : fmt::format("{} not found; ./bootstrap installs and builds it", fmt::join(missing, ", "));
}

/// Of all files of a folder and in its folders, by path, but for READMEs.
std::string sha256_of_folder(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().filename() != "README.md") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::string sum;
    for (const fs::path& file : files) sum += file.lexically_relative(folder).string() + sha256_of_file(file);
    return sha256(sum);
}

/// What a result depends on: the case's own program and files, cutterFoam, what it needs of the programs beside it, examples that it reads.
std::string programs_hash(const VerificationCase& one, const VerificationPlaces& places) {
    std::string sum;
    const auto add = [&](const fs::path& file) { sum += fs::exists(file) ? sha256_of_file(file) : "none"; };
    add(places.programs / one.name);
    add(places.tools / "cutterFoam");
    for (const std::string& name : one.needs)
        if (name != "cutterFoam") add(places.tools / name);
    sum += sha256_of_folder(places.cases / one.name);
    for (const std::string& example : one.examples) sum += sha256_of_folder(places.examples / example);
    return sha256(sum);
}

std::string machine_text() {
    std::ifstream stream("/proc/cpuinfo");
    std::string model = "unknown processor";
    for (std::string line; std::getline(stream, line);)
        if (line.rfind("model name", 0) == 0) {
            model = line.substr(line.find(':') + 2);
            break;
        }
    return fmt::format("{}, {} cores", model, cases::available_cores());
}

std::string date_text() {
    return fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

VerifiedCase begun(const VerificationCase& one, Effort effort) {
    VerifiedCase result;
    result.name = one.name;
    result.title = one.title;
    result.effort = effort_text(effort);
    result.date = date_text();
    result.machine = machine_text();
    return result;
}

int effort_of(const VerifiedCase& result) {
    return static_cast<int>(std::find(std::begin(k_words), std::end(k_words), result.effort) - std::begin(k_words));
}

/// The folder is new, empty, or one of ours.
void require_usable_folder(const fs::path& folder) {
    cases::require_openfoam_path(fs::absolute(folder));
    if (fs::exists(folder) && !fs::is_empty(folder) && !fs::exists(folder / k_mark))
        throw UserError(fmt::format("{} holds something else already", folder.string()), "Nothing is overwritten",
                        "Name another folder with -o");
    fs::create_directories(folder);
    write_file(folder / k_mark, "Results of cutterflow verify.\n");
}

/// Files of other origin stand where results are to be written.
void require_own_files(const std::vector<VerificationCase>& cases, const fs::path& folder) {
    std::vector<Mistake> mistakes;
    const auto refuse = [&](const fs::path& file) {
        mistakes.push_back({"", fmt::format("{} was not written by cutterflow verify", file.string()), "Nothing is overwritten",
                            "Move it elsewhere, or name another folder with -o"});
    };
    const std::vector<VerifiedCase> results = read_verification(folder);
    for (const VerificationCase& one : cases) {
        const fs::path work = folder / one.name, result = folder / (one.name + ".json");
        if (fs::exists(work) && !(fs::is_directory(work) && (fs::is_empty(work) || fs::exists(work / k_programs)))) refuse(work);
        const bool is_result =
            std::any_of(results.begin(), results.end(), [&](const VerifiedCase& other) { return other.name == one.name; });
        if (fs::exists(result) && !is_result) refuse(result);
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

/// The files of a case's folder, each with its size and the time of its last change.
std::map<std::string, std::string> files_in(const fs::path& work) {
    std::map<std::string, std::string> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(work)) {
        const std::string name = entry.path().lexically_relative(work).string();
        if ((entry.is_directory() && !entry.is_symlink()) || name == k_programs || name == k_written || name == k_spent) continue;
        files[name] = entry.is_regular_file() && !entry.is_symlink()
                          ? fmt::format("{} {}", entry.file_size(), entry.last_write_time().time_since_epoch().count())
                          : "special";
    }
    return files;
}

/// What files_in said when the case's program had ended; empty when the suite was killed before.
std::map<std::string, std::string> files_written(const fs::path& work) {
    if (!fs::exists(work / k_written)) return {};
    return nlohmann::json::parse(read_file(work / k_written)).get<std::map<std::string, std::string>>();
}

/// A folder is emptied only when every file in it is as the case's program left it. Otherwise it is renamed: a file may be the user's.
void clear_work(const fs::path& work, const std::function<void(const std::string&)>& say) {
    const std::map<std::string, std::string> written = files_written(work);
    for (const auto& [name, state] : files_in(work)) {
        const auto known = written.find(name);
        if (known != written.end() && known->second == state) continue;
        fs::path kept = work;
        for (int i = 1; fs::exists(kept); ++i) kept = fs::path(fmt::format("{}_kept_{}", work.string(), i));
        fs::rename(work, kept);
        say(fmt::format("{} is not as the case left it, for example {}: kept as {}", work.string(), name, kept.string()));
        return;
    }
    fs::remove_all(work);
}

/// The folder in which a case's program works. Keeps account of the files that the program leaves there.
class WorkFolder {
public:
    /// Makes the folder. What an earlier start left there stays when the case can go on with it.
    WorkFolder(const VerificationCase& one, const VerificationSettings& settings, const std::string& programs,
               const std::function<void(const std::string&)>& say)
        : path_(settings.folder / one.name) {
        const fs::path mark = path_ / k_programs;
        const bool goes_on = settings.resume && one.resumes && fs::exists(mark) && read_file(mark) == programs;
        if (fs::exists(path_) && !goes_on) clear_work(path_, say);
        write_file(mark, programs);
        written_ = files_written(path_);
        found_ = files_in(path_);
        fs::remove(path_ / k_written);
        fs::remove(quantities());
        if (!goes_on) fs::remove(path_ / k_spent);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    ~WorkFolder() {
        try {
            note_files();
        } catch (const std::exception&) {  // the files count as the user's then
        }
    }

    const fs::path& path() const { return path_; }
    fs::path quantities() const { return path_ / "quantities.json"; }

    /// Core seconds [s] of this start and of those whose work it went on with; a start that was killed with the suite is not known.
    double add_core_s(double core_s) const {
        const fs::path file = path_ / k_spent;
        const double all = core_s + (fs::exists(file) ? std::stod(read_file(file)) : 0.0);
        write_file(file, fmt::format("{}\n", all));
        return all;
    }

private:
    void note_files() const {
        std::map<std::string, std::string> files = files_in(path_);
        for (const auto& [name, state] : found_)
            if (written_.count(name) == 0) files.erase(name);
        write_file(path_ / k_written, nlohmann::json(files).dump(1) + "\n");
    }

    fs::path path_;
    std::map<std::string, std::string> written_, found_;  // by the earlier start's program; in the folder when this one began
};

/// Whether a signal that programs do not send themselves ended it: a kill by hand, a shutdown, too little memory.
bool was_stopped(const ChildResult& ended) {
    const auto ended_by = [&](int signal) { return ended.exit_code == 128 + signal; };
    return ended_by(SIGKILL) || std::any_of(k_stop_signals.begin(), k_stop_signals.end(), ended_by);
}

/// Runs one case's program. What it wrote is read back; how it ended is a reason when there is nothing to read.
VerifiedCase run_case(const VerificationCase& one, const VerificationPlaces& places, const VerificationSettings& settings,
                      const std::function<void(const std::string&)>& say) {
    VerifiedCase result = begun(one, settings.effort);
    result.reason = obstacle(one, places);
    if (!result.reason.empty()) return result;
    result.programs = programs_hash(one, places);
    const WorkFolder work(one, settings, result.programs, say);
    const fs::path written = work.quantities();
    const ChildCommand command{{fs::absolute(places.programs / one.name).string(), result.effort, fs::absolute(work.path()).string()},
                               {},
                               settings.folder / (one.name + ".log"),
                               {}};
    const ChildResult ended = run_child(command);
    result.core_s = work.add_core_s(ended.core_s);
    result.wall_s = ended.wall_s;
    const bool judged = ended.exit_code == static_cast<int>(ExitCode::done) || ended.exit_code == static_cast<int>(ExitCode::check_failed);
    if (!judged || !fs::exists(written)) {
        result.failed_as_a_whole = true;
        result.stopped = was_stopped(ended);
        result.reason = judged ? fmt::format("{} ended without having checked anything", one.name) : failure_of(command, ended).text();
        return result;
    }
    for (const nlohmann::json& quantity : nlohmann::json::parse(read_file(written)))
        result.quantities.push_back(quantity_from_json(quantity, written.string()));
    const fs::path shown = work.path() / "exhibits.json";
    if (fs::exists(shown)) result.exhibits = exhibits_from_json(nlohmann::json::parse(read_file(shown)));
    return result;
}

/// Expected core seconds of each case, by what earlier runs took.
std::vector<double> expected_costs(const std::vector<VerificationCase>& cases, const VerificationPlaces& places,
                                   const VerificationSettings& settings) {
    std::map<std::string, double> known;
    for (const fs::path& folder : {places.kept, settings.folder})
        for (const VerifiedCase& result : read_verification(folder))
            if (effort_of(result) >= static_cast<int>(settings.effort)) known[result.name] = result.core_s;
    std::vector<double> costs;
    for (const VerificationCase& one : cases) costs.push_back(known.count(one.name) ? std::max(known[one.name], 0.1) : k_unknown_cost);
    return costs;
}

bool is_finished(const VerifiedCase& result, const VerificationCase& one, const VerificationPlaces& places, Effort effort) {
    return result.name == one.name && effort_of(result) >= static_cast<int>(effort) && !result.failed_as_a_whole &&
           !result.programs.empty() && result.programs == programs_hash(one, places);
}

/// Hours of work are not replaced with a glance. With --resume what is finished is not run.
void require_no_dearer_results(const std::vector<VerificationCase>& cases, const VerificationPlaces& places,
                               const VerificationSettings& settings) {
    std::vector<Mistake> mistakes;
    for (const VerifiedCase& result : read_verification(settings.folder)) {
        const bool would_replace = std::any_of(cases.begin(), cases.end(), [&](const VerificationCase& one) {
            return one.name == result.name && !(settings.resume && is_finished(result, one, places, settings.effort));
        });
        if (would_replace && effort_of(result) > static_cast<int>(settings.effort))
            mistakes.push_back({(settings.folder / (result.name + ".json")).string(), fmt::format("is a result of class {}", result.effort),
                                fmt::format("A run of class {} does not replace it", effort_text(settings.effort)),
                                "Name another folder with -o"});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

}  // namespace

std::string effort_text(Effort effort) {
    return k_words[static_cast<int>(effort)];
}

std::vector<VerificationCase> find_verification_cases(const fs::path& folder) {
    if (!fs::is_directory(folder))
        throw UserError(fmt::format("there is no folder {}", folder.string()), "The verification cases are in the source tree",
                        "Run cutterflow from the clone that it was built in");
    std::vector<VerificationCase> cases;
    std::vector<Mistake> mistakes;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_directory()) cases.push_back(read_case(entry.path(), mistakes));
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    std::sort(cases.begin(), cases.end(), [](const VerificationCase& a, const VerificationCase& b) { return a.name < b.name; });
    return cases;
}

std::vector<VerificationCase> select_cases(const std::vector<VerificationCase>& all, const std::vector<std::string>& names) {
    std::vector<VerificationCase> selected;
    std::vector<Mistake> mistakes;
    std::vector<std::string> known;
    for (const VerificationCase& one : all) known.push_back(one.name);
    for (const std::string& name : names) {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found != known.end()) {
            selected.push_back(all[found - known.begin()]);
            continue;
        }
        const std::string nearest = nearest_word(name, known);
        mistakes.push_back({"", fmt::format("there is no verification case {}", name),
                            mistakes.empty() ? fmt::format("The cases are {}", fmt::join(known, ", ")) : "The cases are those above",
                            nearest.empty() ? "See cutterflow verify --list" : fmt::format("Did you mean {}?", nearest)});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return selected;
}

std::vector<VerifiedCase> run_verification(const std::vector<VerificationCase>& cases, const VerificationPlaces& places,
                                           const VerificationSettings& settings, const std::function<void(const std::string&)>& say) {
    require_usable_folder(settings.folder);
    require_own_files(cases, settings.folder);
    require_no_dearer_results(cases, places, settings);
    const std::vector<double> costs = expected_costs(cases, places, settings);
    double total = 0.0, done = 0.0;
    for (const double cost : costs) total += cost;
    const std::vector<VerifiedCase> earlier = settings.resume ? read_verification(settings.folder) : std::vector<VerifiedCase>();
    std::vector<VerifiedCase> results;
    Progress progress("verify");
    for (std::size_t i = 0; i < cases.size(); ++i) {
        progress.update(done / total, fmt::format("{} of {} cases, {}", i, cases.size(), cases[i].name));
        const auto kept = std::find_if(earlier.begin(), earlier.end(),
                                       [&](const VerifiedCase& result) { return is_finished(result, cases[i], places, settings.effort); });
        if (kept != earlier.end()) {
            say(fmt::format("{}: done before", cases[i].name));
            results.push_back(*kept);
        } else {
            results.push_back(run_case(cases[i], places, settings, say));
            write_file(settings.folder / (cases[i].name + ".json"), case_json(results.back()).dump(1) + "\n");
            say(fmt::format("{}: {} in {}", cases[i].name, verdict_text(results.back().verdict()), duration_text(results.back().wall_s)));
        }
        done += costs[i];
    }
    progress.finish();
    return results;
}

std::vector<VerifiedCase> read_verification(const fs::path& folder) {
    std::vector<VerifiedCase> results;
    if (!fs::is_directory(folder)) return results;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.path().extension() != ".json") continue;
        const std::string text = read_file(entry.path());
        const nlohmann::json content = nlohmann::json::parse(text, nullptr, false);
        const bool is_foreign = text.empty() || (!content.is_discarded() && !content.contains("case"));  // as the output of --json
        if (!is_foreign) results.push_back(case_from_json(text, entry.path().string()));
    }
    std::sort(results.begin(), results.end(), [](const VerifiedCase& a, const VerifiedCase& b) { return a.name < b.name; });
    return results;
}

namespace {

/// A later failure counts at any effort; what was found with less effort, or before, does not replace the rest.
bool replaces(const VerifiedCase& result, const VerifiedCase& found) {
    if (result.verdict() == CaseVerdict::skipped) return false;
    if (effort_of(result) > effort_of(found)) return true;
    if (result.date < found.date) return false;
    return effort_of(result) == effort_of(found) || result.verdict() == CaseVerdict::fail;
}

}  // namespace

std::vector<VerifiedCase> merged_verification(const std::vector<VerifiedCase>& older, const std::vector<VerifiedCase>& newer) {
    std::map<std::string, VerifiedCase> merged;
    for (const VerifiedCase& result : older) merged[result.name] = result;
    for (const VerifiedCase& result : newer) {
        if (result.stopped) continue;
        const auto found = merged.find(result.name);
        if (found != merged.end() && !replaces(result, found->second)) continue;
        merged[result.name] = result;
    }
    std::vector<VerifiedCase> results;
    for (auto& [name, result] : merged) results.push_back(std::move(result));
    return results;
}

}  // namespace cutterflow::validation
