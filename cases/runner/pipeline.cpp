#include "cases/runner/pipeline.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cases/runner/disk_space.hpp"
#include "cases/runner/machine.hpp"
#include "cases/runner/prediction.hpp"
#include "cases/runner/run_progress.hpp"
#include "cases/runner/solver_run.hpp"
#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/scenes/cutter/checked_study.hpp"
#include "cases/scenes/cutter/contact_surfaces.hpp"
#include "cases/scenes/cutter/feed.hpp"
#include "cases/scenes/cutter/flow_dictionaries.hpp"
#include "cases/scenes/cutter/start_flow.hpp"
#include "cases/scenes/cutter/study_bank.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "cases/scenes/cutter/velocity_points.hpp"
#include "cases/study/study_shapes.hpp"
#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/head_names.hpp"
#include "geometry/head/revolution_contour.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/io/write_stl.hpp"
#include "meshing/cutter/build_mesh.hpp"
#include "meshing/dictionary/foam_command.hpp"
#include "postproc/pages/adv_page.hpp"
#include "postproc/pages/report.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

/// Adds the members of the array of tables `section` that belong to `stage`, and of the arrays inside it.
void add_table_inputs(const ParameterValues& values, const std::string& prefix, const std::string& section, const std::string& stage,
                      std::map<std::string, std::string>& inputs) {
    int index = 0;
    for (const ParameterValues& member : values.tables(section)) {
        const std::string name = fmt::format("{}[{}]", prefix, ++index);
        for (const Parameter& parameter : study_table()) {
            if (!parameter.repeated || parameter.stage != stage || parameter.key.substr(0, parameter.key.rfind('.')) != section ||
                !member.has(parameter.key))
                continue;
            inputs[name + parameter.key.substr(section.size())] = toml_text(*member.find(parameter.key));
        }
        for (const std::string& inner : repeated_sections(study_table(), section))
            add_table_inputs(member, name + inner.substr(section.size()), inner, stage, inputs);
    }
}

geometry::RevolutionContour read_contour_csv(const fs::path& file) {
    std::istringstream lines(read_file(file));
    geometry::RevolutionContour contour;
    std::string line;
    std::getline(lines, line);
    if (line != "z_m,r_m")
        throw UserError(fmt::format("{} begins with \"{}\"", file.string(), line), "Its first line must be z_m,r_m",
                        "Start again in another directory");
    while (std::getline(lines, line)) {
        double z = 0.0, radius = 0.0;
        if (std::sscanf(line.c_str(), "%lf,%lf", &z, &radius) != 2)
            throw UserError(fmt::format("{} has the line \"{}\"", file.string(), line), "A line must hold two numbers",
                            "Start again in another directory");
        contour.z.push_back(z);
        contour.radius.push_back(radius);
    }
    if (contour.z.empty())
        throw UserError(file.string() + " contains no contour", "It must have lines of two numbers", "Start again in another directory");
    return contour;
}

bool is_of_the_mesh(const std::string& file) {
    return file.rfind(std::string(meshing::k_mesh_case) + "/", 0) == 0;
}

/// Overrides of the mesh's dictionaries take effect before the mesh is made, all others last.
std::vector<std::string> mesh_overrides(const RunDirectory& directory) {
    std::vector<std::string> files = directory.overrides();
    files.erase(std::remove_if(files.begin(), files.end(), [](const std::string& file) { return !is_of_the_mesh(file); }), files.end());
    return files;
}

std::vector<std::string> case_overrides(const RunDirectory& directory) {
    std::vector<std::string> files = directory.overrides();
    files.erase(std::remove_if(files.begin(), files.end(), is_of_the_mesh), files.end());
    return files;
}

bool start_is_done(const fs::path& run) {
    if (run.empty() || !fs::exists(run / names::manifest)) return false;
    const Manifest manifest(run / names::manifest);
    const StageRecord* start = manifest.find("start");
    return start != nullptr && start->state == StageState::done;
}

/// \pre the study has a feed
double smallest_diameter(const Study& study) {
    double smallest = std::numeric_limits<double>::max();
    for (const FeedRequest& feed : study.feeds)
        for (const FeedClass& rock : feed.classes) smallest = std::min(smallest, rock.diameter);
    return smallest;
}

}  // namespace

std::map<std::string, std::string> stage_inputs(const ParameterValues& values, const fs::path& study_folder, const std::string& stage) {
    std::map<std::string, std::string> inputs;
    for (const Parameter& parameter : study_table())
        if (!parameter.repeated && parameter.stage == stage && values.has(parameter.key))
            inputs[parameter.key] = toml_text(*values.find(parameter.key));
    for (const std::string& section : repeated_sections(study_table(), "")) add_table_inputs(values, section, section, stage, inputs);
    if (stage == k_geometry_stage) inputs["cutter.file"] = sha256_of_file(study_folder / values.text("cutter.file"));
    if (stage == k_case_stage)
        for (const auto& [name, hash] : shape_hashes(values, study_folder)) inputs[name] = hash;
    if (stage == k_case_stage && values.has("bank.file")) inputs["bank.file"] = sha256_of_file(study_folder / values.text("bank.file"));
    if (stage == k_case_stage && values.has("report.adv_points"))
        inputs["report.adv_points"] = adv_places_hash(study_folder / values.text("report.adv_points"));
    return inputs;
}

RunHead read_run_head(const RunDirectory& directory) {
    const nlohmann::json head = read_json_document(directory.file(names::geometry_report),
                                                   {{"head/ring_radius_m", JsonKind::number, true},
                                                    {"head/blades", JsonKind::whole, true},
                                                    {"head/passage_m", JsonKind::number_or_null, true},
                                                    {"head/thickness_m", JsonKind::number, true},
                                                    {"head/contour/error_m", JsonKind::number, true}},
                                                   "Start again in another directory with -o")
                                    .at("head");
    HeadSize size;
    size.ring_radius = head.at("ring_radius_m");
    size.blades = std::max(1, head.at("blades").get<int>());
    if (!head.at("passage_m").is_null()) size.passage = head.at("passage_m");
    size.thickness = head.at("thickness_m");
    geometry::RevolutionContour contour = read_contour_csv(directory.file(names::contour_table));
    contour.error = head.at("contour").at("error_m");
    size.tip_radius = *std::max_element(contour.radius.begin(), contour.radius.end());
    size.depth = -contour.z.front();
    RunHead run_head{size, std::move(contour)};
    try {
        run_head.with_backplate(0.0);
    } catch (const std::invalid_argument& error) {
        throw UserError(fmt::format("{} is not the contour of a head: {}", directory.file(names::contour_table).string(), error.what()),
                        "Its axial coordinates increase, its radii and the ring radius are above 0", "Start again in another directory");
    }
    return run_head;
}

geometry::Contour RunHead::with_backplate(double z_backplate) const {
    return {profile.z, profile.radius, size.ring_radius, z_backplate};
}

Pipeline::Pipeline(const RunDirectory& directory, PipelineSettings settings, Say say)
    : directory_(directory), settings_(std::move(settings)), say_(std::move(say)), values_(read_study(settings_.study_file)) {
    require_cutter_file(values_, settings_.study_file.parent_path());
}

std::vector<Stage> Pipeline::stages() {
    const fs::path folder = settings_.study_file.parent_path();
    const auto inputs = [&](const char* stage) { return stage_inputs(values_, folder, stage); };
    const std::vector<std::string> case_files = case_overrides(directory_);
    const std::vector<std::string> mesh_files = mesh_overrides(directory_);
    const auto with_overrides = [&](std::map<std::string, std::string> all, const std::vector<std::string>& files) {
        for (const std::string& file : files) all["overrides/" + file] = sha256_of_file(directory_.file("overrides/" + file));
        return all;
    };
    return {{k_geometry_stage, inputs(k_geometry_stage), {}, false, [this](bool) { return make_geometry(); }},
            {k_mesh_stage, with_overrides(inputs(k_mesh_stage), mesh_files), mesh_files, false, [this](bool) { return make_mesh(); }},
            {k_case_stage, with_overrides(inputs(k_case_stage), case_files), case_files, false, [this](bool) { return make_case(); }},
            {"start", {}, {"0/"}, false, [this](bool) { return make_start(); }},
            {"run", {}, {"system/decomposeParDict"}, true, [this](bool) { return run_solver(); }},
            {k_report_stage,
             inputs(k_report_stage),
             {names::resolved_study},
             false,
             [this](bool) { return make_report(); },
             {names::results_json, names::report_page}}};
}

ParameterValues Pipeline::checked_values(const HeadSize& head) const {
    ParameterValues resolved = resolve_study(values_, head);
    const std::vector<Mistake> mistakes = check_study(resolved, head);
    if (!mistakes.empty()) throw UserError(mistakes);
    return resolved;
}

Study Pipeline::resolved_study(const HeadSize& head) const {
    return make_study(checked_values(head), settings_.study_file.parent_path());
}

void Pipeline::write_resolved_study(const HeadSize& head) const {
    const ParameterValues resolved = resolve_study(values_, head);
    write_file(directory_.file(names::resolved_study),
               "# Every key of the study as it was computed. Written by cutterflow: change the study, not this file.\n\n" +
                   commented_toml(study_table(), &resolved));
}

StageOutcome Pipeline::make_geometry() {
    const geometry::GeometryInspection inspection = import_study_cutter(values_, settings_.study_file.parent_path());
    const geometry::Head& head = *inspection.head;
    const ParameterValues resolved = checked_values(head_size(head));
    // What has no place is refused here, before the mesh costs anything.
    const PlacedStudy placed = place_study(resolved, head, settings_.study_file.parent_path());
    const auto& [study, size, contour, feeds] = placed;
    for (const Mistake& warning : head_warnings(resolved, placed, head)) say_("warning: " + warning.text());
    for (const Mistake& warning : meshing::mesh_warnings(mesh_input_of(study, size, head.surface))) say_("warning: " + warning.text());
    say_(fmt::format("{}; {} blades, ring radius {:.4g} m, head {:.4g} m deep", inspection.unit.reason, head.symmetry.blade_count,
                     head.ring_radius, size.depth));

    const Prediction prediction =
        predict(study, size, head.surface, {settings_.ranks, 1.0});  // the disk does not depend on the machine's speed
    require_free_bytes(directory_.path(), prediction.mesh_disk + prediction.run_disk);

    const geometry::StationarySteel steel = geometry::generate_stationary_steel(stationary_steel_of(study, size));
    fs::create_directories(directory_.file("geometry"));
    geometry::write_stl(head.surface, directory_.file(names::cutter_surface));
    geometry::write_stl(steel.backplate, directory_.file(names::backplate_surface));
    geometry::write_stl(steel.suction_pipe, directory_.file(names::suction_pipe_surface));
    geometry::write_contour_csv(head.contour, directory_.file(names::contour_table));
    write_file(directory_.file(names::geometry_report), geometry::to_json(inspection).dump(2) + "\n");
    return {{names::cutter_surface, names::backplate_surface, names::suction_pipe_surface, names::contour_table, names::geometry_report},
            0.0};
}

StageOutcome Pipeline::make_mesh() {
    const RunHead head = read_run_head(directory_);
    const geometry::TriangleSurface cutter = geometry::welded(geometry::read_surface(directory_.file(names::cutter_surface)));
    meshing::MeshInput input = mesh_input_of(resolved_study(head.size), head.size, cutter);
    const bool own_dictionaries = !mesh_overrides(directory_).empty();
    std::vector<std::string> outputs;
    std::vector<meshing::MeshRetry> retries;
    double core_s = 0.0;
    for (int attempts = 1;; ++attempts) {
        const meshing::MeshReport report = make_mesh_of(meshing::plan_mesh(input), retries, outputs);
        core_s += report.core_s;
        const std::optional<meshing::MeshRetry> retry = own_dictionaries ? std::nullopt : meshing::next_attempt(report, attempts, input);
        if (!retry) {
            meshing::require_mesh_gates(report);
            break;
        }
        say_(fmt::format("a gate failed ({}); next attempt with {}", retry->failed_gate, retry->change));
        retries.push_back(*retry);
    }
    for (const std::string& file : files_below(directory_.path(), "constant/polyMesh")) outputs.push_back(file);
    outputs.emplace_back(names::mesh_report);
    return {outputs, core_s};
}

meshing::MeshReport Pipeline::make_mesh_of(const meshing::MeshPlan& plan, const std::vector<meshing::MeshRetry>& retries,
                                           std::vector<std::string>& outputs) {
    outputs.clear();
    const int ranks = meshing::ranks_that_pay(plan, settings_.ranks);
    for (const fs::path& file : meshing::write_mesh_case(directory_.path(), plan, ranks)) outputs.push_back(file.string());
    for (const std::string& file : directory_.apply_overrides(mesh_overrides(directory_))) {
        say_("override: " + file);
        if (std::find(outputs.begin(), outputs.end(), file) == outputs.end()) outputs.push_back(file);
    }
    Progress progress("  mesh");
    const meshing::MeshReport report = meshing::build_mesh(
        directory_.path(), plan, settings_.solver.parent_path(), ranks,
        [&](double fraction, const std::string& program) { progress.update(fraction, program); }, retries);
    progress.finish(fmt::format("{} cells ({:.0f} were predicted), {:.2g} GB at most ({:.2g} predicted)", report.figures.cells,
                                report.prediction.cells, 1e-9 * report.memory, 1e-9 * report.prediction.mesh_memory));
    return report;
}

StageOutcome Pipeline::make_case() {
    const RunHead head = read_run_head(directory_);
    const Study study = resolved_study(head.size);
    const geometry::Contour contour = head.with_backplate(study.suction.gap);
    std::vector<std::string> written;
    for (const fs::path& file : write_case(directory_.path(), case_inputs_of(study, head.size, contour, settings_.ranks)))
        written.push_back(file.string());
    // Keys of the bank may have changed since the geometry was made.
    if (const std::vector<Mistake> mistakes = bank_mistakes(resolve_study(values_, head.size), study, head.size, head.profile);
        !mistakes.empty())
        throw UserError(mistakes);
    const geometry::TriangleSurface cutter = geometry::welded(geometry::read_surface(directory_.file(names::cutter_surface)));
    std::vector<MadeWall> walls_beside_steel;
    if (study.bank) {
        const geometry::TriangleSurface soil = bank_surface(study, head.size, contour);
        geometry::write_stl(soil, directory_.path() / names::bank_surface);
        written.emplace_back(names::bank_surface);
        if (!study.feeds.empty()) {
            walls_beside_steel.push_back(bank_contact_wall(study, head.size, contour, soil));
            if (study.bank->adds_picks()) walls_beside_steel.push_back(pick_contact_wall(study, contour, cutter));
        }
    }
    write_resolved_study(head.size);
    const Prediction prediction = predict(study, head.size, cutter, {settings_.ranks, machine_slowness()});
    write_file(directory_.file(names::prediction), to_json(prediction).dump(2) + "\n");
    written.insert(written.end(), {names::resolved_study, names::prediction});
    if (!study.feeds.empty()) {
        const std::vector<PlacedFeed> feeds = place_feeds(study, feed_scene(study, head.size, contour, cutter));
        for (const std::string& line : feed_lines(feeds)) say_(line);
        write_file(directory_.file(names::rock_feed), rock_feed_csv(feeds));
        write_file(directory_.file(names::feed_report), feed_json(feeds, study));
        written.insert(written.end(), {names::rock_feed, names::feed_report});
        for (const WallSurfaceReport& wall :
             write_contact_surfaces(directory_.path(), smallest_diameter(study), head.size.ring_radius, walls_beside_steel))
            say_(wall.text());
        written.emplace_back(k_contact_surface_report);
    }
    for (const std::string& file : directory_.apply_overrides(case_overrides(directory_))) {
        say_("override: " + file);
        if (std::find(written.begin(), written.end(), file) == written.end()) written.push_back(file);
    }
    return {written, 0.0};
}

StageOutcome Pipeline::make_start() {
    const RunHead head = read_run_head(directory_);
    const Study study = resolved_study(head.size);
    const CaseInputs inputs = case_inputs_of(study, head.size, head.with_backplate(study.suction.gap), settings_.ranks);
    if (start_is_done(settings_.start_from)) {
        if (const auto taken = take_start_flow(directory_.path(), settings_.start_from, inputs)) {
            say_(fmt::format("identical to that of {}, copied from there", settings_.start_from.string()));
            return {files_below(directory_.path(), "0"), 0.0};
        }
    }
    if (!settings_.start_from.empty())
        say_(fmt::format("{} has no finished start of the same case: it is computed here", settings_.start_from.string()));
    Progress progress("  frozen rotor");
    const StartFlowReport report = run_start_flow(directory_.path(), inputs, k_start_iterations, [&](int iteration, int iterations) {
        progress.update(static_cast<double>(iteration) / iterations, fmt::format("iteration {} of {}", iteration, iterations));
    });
    progress.finish();
    say_(report.text());
    return {files_below(directory_.path(), "0"), report.core_s};
}

Prediction Pipeline::predicted(const Study& study, const HeadSize& head) const {
    return predict(study, head, geometry::welded(geometry::read_surface(directory_.file(names::cutter_surface))), {settings_.ranks, 1.0});
}

std::optional<Mistake> Pipeline::full_disk() const {
    if (!is_disk_full(directory_.path())) return std::nullopt;
    try {
        const RunHead head = read_run_head(directory_);
        const Prediction prediction = predicted(resolved_study(head.size), head.size);
        return cases::full_disk(directory_.path(), prediction.mesh_disk + prediction.run_disk);
    } catch (const Failure&) {
        return cases::full_disk(directory_.path(), 0.0);  // the disk was full before there was a geometry
    }
}

void Pipeline::say_cost(double core_s) const {
    const fs::path file = directory_.file(names::prediction);
    if (!fs::exists(file)) return;  // the case is of an older version
    const nlohmann::json prediction =
        read_json_document(file, {{"core_hours", JsonKind::number, true}, {"revolutions", JsonKind::number, true}},
                           "Keep the run directory as the run wrote it");
    say_(fmt::format("took {:.3g} core hours; {:.3g} were predicted for {:g} revolutions", core_s / 3600.0,
                     prediction.at("core_hours").get<double>(), prediction.at("revolutions").get<double>()));
}

StageOutcome Pipeline::run_solver() {
    const RunHead head = read_run_head(directory_);
    const Study study = resolved_study(head.size);
    const bool goes_on = !newest_checkpoint(directory_.path()).empty();
    if (!goes_on) require_free_bytes(directory_.path(), predicted(study, head.size).run_disk);
    const double core_s = bring_to_start(directory_.path(), settings_.ranks, say_);
    RunProgress progress(study);
    const double run_core_s =
        cases::run_solver(directory_.path(), settings_.solver, settings_.ranks, [&](const std::string& line) { progress.take(line); });
    progress.finish();
    if (!goes_on) say_cost(run_core_s);
    return {{}, core_s + run_core_s};
}

StageOutcome Pipeline::make_report() {
    const RunHead head = read_run_head(directory_);
    const Study study = resolved_study(head.size);
    write_resolved_study(head.size);
    const postproc::ReportSummary summary = postproc::write_report(directory_.path());
    if (!summary.note.empty()) say_(summary.note);
    if (study.report.adv_points) make_adv_report(*study.report.adv_points);
    return {{names::resolved_study}, 0.0};  // the report itself can be rewritten at any time
}

void Pipeline::make_adv_report(const fs::path& points) const {
    try {
        const postproc::AdvComparison comparison = postproc::compare_with_measurement(directory_.path(), points);
        say_(fmt::format("measured and computed velocities: {}", postproc::write_adv_report(comparison, directory_.path()).string()));
    } catch (const UserError& error) {
        // A run that ended before a whole revolution was averaged has its report all the same.
        say_(fmt::format("no comparison with measured velocities: {}", error.what()));
    }
}

}  // namespace cutterflow::cases
