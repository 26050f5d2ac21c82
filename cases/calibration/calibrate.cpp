#include "cases/calibration/calibrate.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "cases/calibration/run_values.hpp"
#include "cases/runner/manifest.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"
#include "postproc/analysis/calibration/optimiser.hpp"

namespace cutterflow::cases {

namespace {

namespace fs = std::filesystem;

constexpr const char* k_copy = "calibration.toml";
constexpr const char* k_identity = "calibration.identity";
constexpr const char* k_runs = "runs";
constexpr const char* k_spent = "the budget is spent";

/// Ends an optimiser whose next place the budget does not allow.
struct BudgetSpent {};

/// The places of the grid, the first parameter slowest.
std::vector<Eigen::VectorXd> grid_of(const CalibrationFile& file) {
    std::vector<Eigen::VectorXd> places{Eigen::VectorXd(static_cast<Eigen::Index>(file.parameters.size()))};
    for (std::size_t k = 0; k < file.parameters.size(); ++k) {
        std::vector<Eigen::VectorXd> longer;
        for (const Eigen::VectorXd& place : places)
            for (const double value : file.parameters[k].values) {
                longer.push_back(place);
                longer.back()[static_cast<Eigen::Index>(k)] = value;
            }
        places = std::move(longer);
    }
    return places;
}

/// The places of one calibration, each with its runs.
class Places {
public:
    Places(const CalibrationFile& file, const CalibrateSettings& settings, const std::function<void(const std::string&)>& say)
        : file_(file), settings_(settings), say_(say) {
        cost_.budget_runs = file.budget_runs;
        cost_.budget_core_h = file.budget_core_h;
    }

    bool allows(std::size_t places) const {
        const std::size_t runs = cost_.runs + places * file_.runs_of_a_place() + file_.runs_of_the_answer();
        return static_cast<double>(runs) <= file_.budget_runs && cost_.core_h < file_.budget_core_h;
    }

    /// Places whose runs go at the same time.
    std::size_t at_once() const {
        const std::size_t of_a_place = file_.runs_of_a_place();
        return (static_cast<std::size_t>(settings_.jobs) + of_a_place - 1) / of_a_place;
    }

    void run(std::vector<Eigen::VectorXd> places) {
        for (Eigen::VectorXd& place : places) place = as_studies_have(place);
        say_(fmt::format("{} place(s) of {} run(s) each", places.size(), file_.runs_of_a_place()));
        std::vector<Names> names;
        std::vector<SweepPoint> points;
        for (const Eigen::VectorXd& place : places) {
            names.emplace_back(file_.studies.size());
            for (std::size_t study = 0; study < file_.studies.size(); ++study)
                if (file_.is_fitted(study)) add(points, names.back()[study], points_at(study, place, file_.repeats));
        }
        const std::set<std::string> done = run(points);
        for (std::size_t i = 0; i < places.size(); ++i) take(places[i], names[i], done);
    }

    /// Runs of all studies at the chosen parameters, with seeds that no place had.
    calibration::Evaluation run_answer(const Eigen::VectorXd& chosen) {
        const Eigen::VectorXd answer = as_studies_have(chosen);
        say_(fmt::format("the answer: {} run(s)", file_.runs_of_the_answer()));
        Names names(file_.studies.size());
        std::vector<SweepPoint> points;
        for (std::size_t study = 0; study < file_.studies.size(); ++study)
            add(points, names[study], points_at(study, answer, {file_.repeats_at_answer, file_.repeats}));
        return {answer, values_of(names, file_.measured.size(), run(points))};
    }

    const calibration::CalibrationCost& cost() const { return cost_; }
    const std::vector<calibration::Evaluation>& evaluations() const { return evaluations_; }

    /// Of a search that needs every value.
    [[noreturn]] void refuse_a_gap() const {
        refuse({"", fmt::format("at a place that bobyqa chose {}", why_left_out_), "An optimiser needs every value",
                "Narrow the ranges, or use method = \"surface\""});
    }

    calibration::Calibration calibration(const std::string& ended) const {
        if (evaluations_.empty()) refuse_without_values();
        return {file_.name, file_.method, file_.objective, file_.ranges(), file_.targets, evaluations_, cost_, ended};
    }

private:
    using Names = std::vector<std::vector<std::string>>;  // of the runs at one place: of each study, each repeat

    fs::path folder() const { return settings_.folder / k_runs; }

    SweepSettings sweep_settings() const {
        return {folder(), settings_.program, settings_.ranks, settings_.jobs, fs::exists(folder() / "studies"), settings_.launcher};
    }

    static Eigen::VectorXd as_studies_have(Eigen::VectorXd place) {
        for (double& value : place) value = std::stod(number_text(value));
        return place;
    }

    std::vector<SweepPoint> points_at(std::size_t study, const Eigen::VectorXd& place, const RepeatRange& repeats) const {
        std::vector<KeyAxis> axes;
        for (std::size_t k = 0; k < file_.parameters.size(); ++k)
            axes.push_back({file_.parameters[k].key, {number_text(place[static_cast<Eigen::Index>(k)])}});
        return settings_.access.points(file_.studies[study], axes, repeats, folder());
    }

    static void add(std::vector<SweepPoint>& points, std::vector<std::string>& names, std::vector<SweepPoint> more) {
        for (SweepPoint& point : more) {
            names.push_back(point.name);
            points.push_back(std::move(point));
        }
    }

    /// \return names of the runs that are done
    std::set<std::string> run(const std::vector<SweepPoint>& points) {
        const SweepOutcome outcome = run_sweep(with_donors(points), sweep_settings(), say_);
        for (const std::string& failure : outcome.failed) say_(failure);
        std::set<std::string> done;
        for (const fs::path& run : outcome.done) done.insert(run.filename().string());
        cost_.runs += points.size();
        for (const SweepPoint& point : points) {
            cost_.core_h += run_core_s(folder() / point.name) / 3600.0;
            if (done.count(point.name) == 0)
                ++cost_.failed_runs;
            else if (!point.design.empty())
                donors_.emplace(point.design, point);
        }
        return done;
    }

    /// Points before which stand finished ones of their designs, from which they take mesh or bed.
    std::vector<SweepPoint> with_donors(const std::vector<SweepPoint>& points) const {
        std::set<std::string> names, designs;
        for (const SweepPoint& point : points) {
            names.insert(point.name);
            designs.insert(point.design);
        }
        std::vector<SweepPoint> all;
        for (const auto& [design, donor] : donors_)
            if (designs.count(design) > 0 && names.count(donor.name) == 0) all.push_back(donor);
        all.insert(all.end(), points.begin(), points.end());
        return all;
    }

    /// Of the first targets, each run that is done and has a value.
    std::vector<std::vector<std::vector<double>>> values_of(const Names& names, std::size_t targets,
                                                            const std::set<std::string>& done) const {
        std::vector<std::vector<std::vector<double>>> all(targets);
        for (std::size_t t = 0; t < targets; ++t)
            for (const std::string& name : names[file_.measured[t].study]) {
                if (done.count(name) == 0) continue;
                std::vector<double> values = run_values(folder() / name, file_.measured[t]);
                if (!values.empty()) all[t].push_back(std::move(values));
            }
        return all;
    }

    void take(const Eigen::VectorXd& place, const Names& names, const std::set<std::string>& done) {
        calibration::Evaluation evaluation{place, values_of(names, file_.targets.fitted.size(), done)};
        const bool whole = std::none_of(evaluation.values.begin(), evaluation.values.end(), [](const auto& runs) { return runs.empty(); });
        if (whole) {
            evaluations_.push_back(std::move(evaluation));
            return;
        }
        why_left_out_ = why_incomplete(names, done, evaluation);
        say_("left out: " + why_left_out_);
    }

    /// Of the first target without a value at a place.
    std::string why_incomplete(const Names& names, const std::set<std::string>& done, const calibration::Evaluation& evaluation) const {
        for (std::size_t t = 0; t < evaluation.values.size(); ++t) {
            if (!evaluation.values[t].empty()) continue;
            const std::string& run = names[file_.measured[t].study].front();
            const std::string reason = done.count(run) > 0 ? missing_reason(folder() / run, file_.measured[t]) : "the run failed";
            return fmt::format("{} has no value in {}{}", file_.targets.fitted[t].name, run, reason.empty() ? "" : ": " + reason);
        }
        return "";
    }

    [[noreturn]] void refuse_without_values() const {
        refuse({"", fmt::format("no place has values of all targets; at the last one {}", why_left_out_),
                "A calibration compares runs with its targets", fmt::format("Look at the reports and logs in {}", folder().string())});
    }

    /// \throws ToolError  when a run failed \throws CheckFailure  when none did: they ended, and have no value
    [[noreturn]] void refuse(const Mistake& mistake) const {
        if (cost_.failed_runs > 0) throw ToolError(mistake);
        throw CheckFailure(mistake);
    }

    const CalibrationFile& file_;
    const CalibrateSettings& settings_;
    const std::function<void(const std::string&)>& say_;
    std::vector<calibration::Evaluation> evaluations_;
    std::string why_left_out_;                  // the last place that was
    std::map<std::string, SweepPoint> donors_;  // of each design the first run that was done
    calibration::CalibrationCost cost_;
};

/// Where the cost of a run is not known before, places are run as they go at once, while the budget allows it.
std::string run_grid(const CalibrationFile& file, Places& places) {
    const std::vector<Eigen::VectorXd> grid = grid_of(file);
    const std::size_t slice = file.plan.core_h ? grid.size() : places.at_once();
    for (auto next = grid.begin(); next != grid.end();) {
        const auto end = next + std::min(static_cast<std::ptrdiff_t>(slice), grid.end() - next);
        if (!places.allows(static_cast<std::size_t>(end - next))) return k_spent;
        places.run(std::vector<Eigen::VectorXd>(next, end));
        next = end;
    }
    return "the grid is done";
}

std::string run_surface(const CalibrationFile& file, Places& places) {
    const std::string ended = run_grid(file, places);
    if (file.rounds == 0 || ended == k_spent) return ended;
    for (int round = 0;; ++round) {
        const auto found = calibration::estimate_of(places.calibration(""));
        if (!found) return "too few places have values of all targets for a quadratic";
        if (calibration::narrow_enough(*found, file.ranges())) return "every interval is within its tolerance";
        if (round == file.rounds) return "its rounds are used up";
        const auto next = calibration::next_places(*found, file.ranges(), places.evaluations());
        if (next.empty()) return "the places to run next have been run";
        if (!places.allows(next.size())) return k_spent;
        places.run(next);
    }
}

std::string run_bobyqa(const CalibrationFile& file, Places& places) {
    const std::vector<calibration::Range> ranges = file.ranges();
    const auto count = static_cast<Eigen::Index>(ranges.size());
    Eigen::VectorXd steps(count);
    for (Eigen::Index k = 0; k < count; ++k) {
        const calibration::Range& range = ranges[static_cast<std::size_t>(k)];
        steps[k] = range.tolerance / (range.high - range.low);
    }
    const auto objective = [&](const Eigen::VectorXd& at) {
        if (!places.allows(1)) throw BudgetSpent{};
        const std::size_t before = places.evaluations().size();
        places.run({calibration::unscaled(ranges, at)});
        if (places.evaluations().size() == before) places.refuse_a_gap();
        return calibration::objective_of(*file.objective, file.targets.fitted, calibration::means_of(places.evaluations().back()));
    };
    try {
        const bool has_ended = calibration::bobyqa(objective, Eigen::VectorXd::Zero(count), file.evaluations, steps);
        return has_ended ? "the optimiser has ended" : "its evaluations are used up";
    } catch (const BudgetSpent&) {
        return k_spent;
    }
}

struct Method {
    const char* name;
    std::string (*run)(const CalibrationFile& file, Places& places);  ///< \return why it ended
    bool fitted_minimum;                                              ///< whether the least value of the fit is the answer
};

constexpr Method k_methods[] = {{"surface", run_surface, true}, {"grid", run_grid, false}, {"bobyqa", run_bobyqa, false}};

void require_folder(const CalibrateSettings& settings, Mistakes& mistakes) {
    const fs::path& folder = settings.folder;
    const bool begun = fs::exists(folder / k_identity);
    if (settings.resume && !begun)
        mistakes.add(fmt::format("{} holds no calibration", folder.string()), "--resume goes on with a calibration that was begun",
                     "Correct the folder given with -o, or leave --resume out");
    if (begun && !settings.resume)
        mistakes.add(fmt::format("{} already contains a calibration", folder.string()), "Its runs are kept",
                     "Add --resume to continue it, or name another folder with -o");
    if (!begun && fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
        mistakes.add(fmt::format("{} already contains something else", folder.string()), "Nothing is overwritten",
                     "Name another folder with -o");
}

}  // namespace

CalibrationFile begin_calibration(const CalibrateSettings& settings) {
    Mistakes mistakes;
    CalibrationFile file;
    mistakes.gather([&] { file = read_calibration(settings.file, settings.access); });
    require_folder(settings, mistakes);
    if (mistakes.empty() && settings.resume && read_file(settings.folder / k_identity) != file.identity)
        mistakes.add(fmt::format("{} differs from {}", settings.file.string(), (settings.folder / k_copy).string()),
                     "A calibration goes on with the file that it was begun with; only its budget may change",
                     "Undo the change, or name another folder with -o");
    mistakes.refuse();
    if (!settings.resume) {
        write_file(settings.folder / k_copy, read_file(settings.file));
        write_file(settings.folder / k_identity, file.identity);
    }
    return file;
}

calibration::Outcome run_calibration(const CalibrationFile& file, const CalibrateSettings& settings,
                                     const std::function<void(const std::string&)>& say) {
    Places places(file, settings, say);
    const Method& method =
        *std::find_if(std::begin(k_methods), std::end(k_methods), [&](const Method& row) { return file.method == row.name; });
    const std::string ended = method.run(file, places);
    calibration::Outcome outcome = calibration::outcome_of(places.calibration(ended), method.fitted_minimum);
    calibration::judge(outcome, places.run_answer(outcome.parameters));
    outcome.calibration.cost = places.cost();
    return outcome;
}

}  // namespace cutterflow::cases
