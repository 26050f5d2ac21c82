#include "cases/runner/room_stages.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

#include "cases/runner/run_progress.hpp"
#include "cases/runner/solver_run.hpp"
#include "cases/runner/table_inputs.hpp"
#include "cases/scenes/room/room_case.hpp"
#include "cases/scenes/room/room_mesh.hpp"
#include "cases/scenes/room/room_prediction.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/io/write_stl.hpp"
#include "meshing/room/build_room_mesh.hpp"
#include "postproc/analysis/measures/measure_source.hpp"
#include "postproc/pages/room/room_page.hpp"
#include "postproc/run/run_reader.hpp"
#include "postproc/run/run_table.hpp"

namespace cutterflow::cases {

namespace {

namespace fs = std::filesystem;
using Say = std::function<void(const std::string&)>;
using namespace room_stage;

/// What grains meet at the sides, by the side: a bed does not know the number of a table [[boundary]], nor those that are about the flow.
void name_by_side(const ParameterValues& values, std::map<std::string, std::string>& inputs) {
    for (auto input = inputs.begin(); input != inputs.end();)
        input = input->first.rfind("boundary.", 0) == 0 ? inputs.erase(input) : std::next(input);
    for (const ParameterValues& table : values.tables("boundary"))
        if (table.has("boundary.grains"))
            inputs[fmt::format("boundary.{}.grains", table.text("boundary.on"))] = table.text("boundary.grains");
}

std::map<std::string, std::string> inputs_of(const ParameterValues& values, const std::string& stage) {
    std::map<std::string, std::string> inputs =
        table_inputs(room_table(), values, [&](const Parameter& parameter) { return parameter.stage == stage; });
    if (stage == k_bed) name_by_side(values, inputs);
    return inputs;
}

void write_texts(const fs::path& folder, const std::vector<CaseText>& files) {
    for (const CaseText& file : files) write_file(folder / file.path, file.text);
}

/// That extractions ask for until the run's end [kg].
double ordered_extraction(const RoomScene& scene) {
    double mass = 0.0;
    for (const RoomEvent& event : scene.events)
        if (const auto* extract = std::get_if<ExtractEvent>(&event))
            mass += extract->rate * (std::min(extract->to, scene.run.end) - extract->from);
    return mass;
}

/// Runs cutterFoam in a folder and shows how far it is. \return core seconds
double run_cutter_foam(const fs::path& folder, const fs::path& solver, const std::string& what, double end, int ranks) {
    TimeProgress progress(what, end);
    const double core_s = run_solver(folder, solver, ranks, [&](const std::string& line) { progress.take(line); });
    progress.finish();
    return core_s;
}

/// Those below mesh/ belong to the mesh stage, the others to the case.
std::vector<std::string> overrides_of(const RunDirectory& directory, bool of_mesh) {
    std::vector<std::string> files;
    for (const std::string& file : directory.overrides())
        if ((file.rfind("mesh/", 0) == 0) == of_mesh) files.push_back(file);
    return files;
}

/// Keys and overriding files that a stage depends on.
std::map<std::string, std::string> inputs_with_overrides(const ParameterValues& values, const std::string& stage,
                                                         const RunDirectory& directory, bool of_mesh) {
    std::map<std::string, std::string> inputs = inputs_of(values, stage);
    for (const std::string& file : overrides_of(directory, of_mesh))
        inputs["overrides/" + file] = sha256_of_file(directory.file("overrides/" + file));
    return inputs;
}

/// Of the case. A measure makes the report alone anew, but the gate that stops a run is one of a measure.
std::map<std::string, std::string> case_inputs(const RoomRequest& request, const RunDirectory& directory) {
    std::map<std::string, std::string> inputs = inputs_with_overrides(request.values, k_case, directory, false);
    if (const auto* idle = std::get_if<StopWhenIdle>(&request.scene.run.stop)) inputs["run.stop.gate"] = idle->gate;
    if (const auto* below = std::get_if<StopWhenBelow>(&request.scene.run.stop)) inputs["run.stop.gate"] = below->gate;
    return inputs;
}

/// A room's run directory.
class RoomWork {
public:
    RoomWork(const RunDirectory& directory, const RoomRequest& request, fs::path solver, int ranks, Say say)
        : directory_(directory),
          scene_(request.scene),
          pieces_(request.pieces),
          values_(request.values),
          solver_(std::move(solver)),
          ranks_(ranks),
          say_(std::move(say)),
          bed_(bed_name(scene_, pieces_)),
          mesh_(request.mesh) {}

    StageOutcome make_geometry() const {
        StageOutcome outcome;
        fs::create_directories(directory_.file("geometry"));
        for (const RoomSolid& solid : scene_.solids) {
            geometry::write_stl(solid.surface, directory_.file(surface_file(solid)));
            outcome.outputs.push_back(surface_file(solid));
        }
        return outcome;
    }

    /// Piece by piece; one that is done is not done again.
    StageOutcome make_bed() const {
        StageOutcome outcome;
        std::string start;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            const fs::path folder = piece_folder(i);
            if (!fs::exists(folder / k_done)) {
                require_grains_to_freeze(i);
                write_texts(folder, bed_case(scene_, pieces_[i], start, "../../"));
                bring_to_start(folder, std::nullopt, say_);
                outcome.core_s +=
                    run_cutter_foam(folder, solver_, fmt::format("  bed, part {} of {}", i + 1, pieces_.size()), pieces_[i].end(), 1);
                require_rest(i);
                require_none_lost(i);
                write_file(folder / k_done, "");
            }
            start = fmt::format("../{}/checkpoints/{}", i + 1, newest_checkpoint(folder).filename().string());
        }
        if (pieces_.empty()) return outcome;
        keep_bed(newest_checkpoint(piece_folder(pieces_.size() - 1)));
        for (const std::string& file : files_below(directory_.path(), bed_start())) outcome.outputs.push_back(file);
        return outcome;
    }

    /// \pre the room has a medium
    StageOutcome make_mesh() const {
        StageOutcome outcome;
        for (const fs::path& file : meshing::write_room_mesh_case(directory_.path(), *mesh_)) outcome.outputs.push_back(file.string());
        apply_overrides(true, outcome.outputs);
        Progress progress("  mesh");
        const meshing::RoomMeshReport report = meshing::build_room_mesh(
            directory_.path(), *mesh_, [&](double fraction, const std::string& program) { progress.update(fraction, program); });
        progress.finish(fmt::format("{} cells ({:.0f} were predicted)", report.size.cells, report.predicted_cells));
        meshing::require_gates(report.gates);
        for (const std::string& file : files_below(directory_.path(), "constant/polyMesh")) outcome.outputs.push_back(file);
        outcome.outputs.emplace_back(names::mesh_report);
        outcome.core_s = report.core_s;
        return outcome;
    }

    StageOutcome make_case() const {
        std::vector<CaseText> files = grain_files(scene_, pieces_.empty() ? "" : bed_start(), first_fed_id());
        for (CaseText& file : mesh_ ? flow_files(scene_, *mesh_) : dry_files(scene_)) files.push_back(std::move(file));
        for (CaseText& file : descriptions()) files.push_back(std::move(file));
        write_texts(directory_.path(), files);
        StageOutcome outcome;
        for (const CaseText& file : files) outcome.outputs.push_back(file.path);
        apply_overrides(false, outcome.outputs);
        return outcome;
    }

    StageOutcome run() const {
        const double core_s = bring_to_start(directory_.path(), mesh_ ? std::optional<int>(ranks_) : std::nullopt, say_);
        return {{}, core_s + run_cutter_foam(directory_.path(), solver_, "  run", scene_.run.end, ranks_)};
    }

    /// \pre the case is made
    StageOutcome report() const {
        StageOutcome outcome;
        const std::vector<std::string> own = overrides_of(directory_, false);
        for (const CaseText& file : descriptions()) {
            outcome.outputs.push_back(file.path);
            if (std::find(own.begin(), own.end(), file.path) == own.end()) write_file(directory_.file(file.path), file.text);
        }
        postproc::write_room_report(directory_.path());
        return outcome;
    }

    /// Files that the report alone reads: a change of name or measures writes them anew.
    static std::vector<std::string> rewritten_by_report() { return {k_measures, postproc::k_room_file, names::resolved_study}; }

private:
    static constexpr const char* k_done = "done";
    static constexpr const char* k_measures = "measures.json";

    std::vector<CaseText> descriptions() const {
        return {{k_measures, scene_.measures.dump(2) + "\n"},
                {postproc::k_room_file, room_json().dump(2) + "\n"},
                {names::resolved_study, "# The study as it was computed. Written by cutterflow: change the study, not this file.\n\n" +
                                            plain_toml(room_table(), values_)}};
    }

    /// Files of the user over those of the mesh stage, or of the case.
    void apply_overrides(bool of_mesh, std::vector<std::string>& outputs) const {
        for (const std::string& file : directory_.apply_overrides(overrides_of(directory_, of_mesh))) {
            say_("override: " + file);
            if (std::find(outputs.begin(), outputs.end(), file) == outputs.end()) outputs.push_back(file);
        }
    }

    fs::path piece_folder(std::size_t piece) const { return directory_.file(fmt::format("bed/{}", piece + 1)); }
    std::string bed_start() const { return "bed/checkpoints/" + bed_; }

    /// The last picture of the piece before shows the grains as this one finds them.
    void require_grains_to_freeze(std::size_t piece) const {
        if (piece == 0 || pieces_[piece].events.empty()) return;
        const postproc::MeasureSource before(piece_folder(piece - 1));
        std::vector<Mistake> mistakes = empty_freezes(pieces_[piece], before.grains(before.picture_near(std::nullopt)).position);
        if (!mistakes.empty()) throw UserError(std::move(mistakes));
    }

    /// A piece whose run went on to its end has grains that still move.
    void require_rest(std::size_t piece) const {
        const double end = pieces_[piece].end(), reached = std::stod(newest_checkpoint(piece_folder(piece)).filename().string());
        if (reached < end - 0.5 * scene_.bed_step) return;
        require_all_came_in(piece);
        if (pieces_[piece].compress) refuse_compression(piece, *pieces_[piece].compress);
        throw CheckFailure(
            {"", fmt::format("the grains of {} are not at rest after {:g} s", piece_folder(piece).string(), end),
             "A preparation ends with its mean kinetic energy, without spin, below 1e-6 m g d and its largest speed below 0.01 sqrt(g d)",
             "Look at its pictures; give the step settle a larger longest_s, or the contacts friction and rolling friction, and run the "
             "changed study in another directory with -o"});
    }

    /// The solid met too few grains, or they go on giving way.
    [[noreturn]] void refuse_compression(std::size_t piece, const CompressStep& step) const {
        const nlohmann::json state = dem_state(newest_checkpoint(piece_folder(piece)));
        for (const nlohmann::json& wall : state.at("walls")) {
            if (wall.at("name") != step.solid) continue;
            const std::vector<double> force = wall.at("force_n"), way = wall.at("pressed_m");
            throw CheckFailure(
                {"",
                 fmt::format("after {:g} s the grains of {} bear {:.4g} N of the {:.4g} N with which {} is pressed; it went {:.4g} m",
                             pieces_[piece].end(), piece_folder(piece).string(), 0.0 - Vec3(force.data()).dot(step.direction), step.force,
                             step.solid, Vec3(way.data()).norm()),
                 fmt::format("A step compress ends when grains bear the force to 1 % and are at rest; the solid moves at most {:.2g} m/s",
                             press_speed(scene_, step)),
                 "Look at its pictures; put the solid close to the grains, before them along its direction, or give the step a larger "
                 "longest_s, and run the changed study in another directory with -o"});
        }
        throw std::logic_error(step.solid + " is no wall of its own preparation");
    }

    static nlohmann::json dem_state(const fs::path& checkpoint) {
        return read_json_document(checkpoint / names::dem_state,
                                  {{"walls/*/name", JsonKind::text, true},
                                   {"walls/*/force_n/*", JsonKind::number, true},
                                   {"walls/*/pressed_m/*", JsonKind::number, true}},
                                  "Remove the folder bed; it is made anew");
    }

    /// The last row of the account of rock of a piece, over all its starts.
    double accounted(std::size_t piece, const char* column) const {
        const postproc::Table account = postproc::read_joined_table(piece_folder(piece), "rock", "account.csv",
                                                                    {{"time_s", column}, {}, {}, "Remove the folder bed; it is made anew"});
        if (account.empty())
            throw ToolError(Mistake{"", fmt::format("{} has no account of its grains", piece_folder(piece).string()),
                                    "cutterFoam writes one in each step", "Remove the folder bed; it is made anew"});
        return account.number(column).back();
    }

    /// A grain whose place never gets free waits, and keeps the piece from its end.
    void require_all_came_in(std::size_t piece) const {
        const std::size_t poured = pieces_[piece].grains.size();
        if (poured == 0) return;
        const postproc::Table events = postproc::read_events(piece_folder(piece));
        const std::vector<std::string>& surfaces = events.text("surface");
        const auto fed = static_cast<std::size_t>(std::count(surfaces.begin(), surfaces.end(), "feed"));
        if (fed < poured)
            throw CheckFailure({"", fmt::format("{} of the grains of {} found no room", poured - fed, piece_folder(piece).string()),
                                "Grains begin where others are not", "Give the pour a higher region, or pour less"});
    }

    /// A bed has all grains that were poured.
    void require_none_lost(std::size_t piece) const {
        const double left = accounted(piece, "left_domain_count");
        if (left > 0.0)
            throw CheckFailure({"", fmt::format("{} of the grains of {} left the room", left, piece_folder(piece).string()),
                                "A bed has all grains that are poured", "Close the sides of the room beside the pour"});
    }

    /// The last checkpoint of the preparation under its name.
    void keep_bed(const fs::path& checkpoint) const {
        const fs::path kept = directory_.file(bed_start()), part = directory_.file(bed_start() + ".part");
        if (fs::exists(kept)) return;
        fs::create_directories(kept.parent_path());
        fs::remove_all(part);
        fs::copy(checkpoint, part, fs::copy_options::recursive);
        fs::rename(part, kept);
    }

    int first_fed_id() const {
        int last = 0;
        for (const BedPiece& piece : pieces_)
            for (const PlacedGrain& grain : piece.grains) last = std::max(last, grain.id);
        return last + 1;
    }

    static nlohmann::json classes_json(const RoomGrains& kind) {
        nlohmann::json classes = nlohmann::json::array();
        for (const GrainClass& one : kind.extremes())
            classes.push_back({{"diameter_m", one.diameter}, {"mass_share", one.mass_share}, {"density_kg_m3", one.density}});
        return classes;
    }

    static nlohmann::json turn_json(const coupling::WallTurn& turn) {
        const Vec3 &origin = turn.axis.origin, &direction = turn.axis.direction;
        return {{"origin_m", {origin.x(), origin.y(), origin.z()}},
                {"axis", {direction.x(), direction.y(), direction.z()}},
                {"speed_rad_s", turn.speed},
                {"from_s", turn.begin},
                {"to_s", turn.end}};
    }

    /// How far the preparation pressed each solid that it presses [m], by name.
    nlohmann::json pressed_solids() const {
        nlohmann::json pressed = nlohmann::json::object();
        if (std::none_of(pieces_.begin(), pieces_.end(), [](const BedPiece& piece) { return piece.compress.has_value(); })) return pressed;
        const nlohmann::json bed = dem_state(directory_.file(bed_start()));
        for (const BedPiece& piece : pieces_)
            for (const nlohmann::json& wall : bed.at("walls"))
                if (piece.compress && wall.at("name") == piece.compress->solid) pressed[piece.compress->solid] = wall.at("pressed_m");
        return pressed;
    }

    nlohmann::json room_json() const {
        std::size_t poured = 0;
        double mass = 0.0;
        for (const BedPiece& piece : pieces_)
            for (const PlacedGrain& grain : piece.grains) {
                ++poured;
                mass += sphere_mass(grain.diameter, grain.density);
            }
        const nlohmann::json pressed = pressed_solids();
        nlohmann::json solids = nlohmann::json::array();
        for (const RoomSolid& solid : scene_.solids) {
            nlohmann::json one{{"name", solid.name}, {"file", surface_file(solid)}, {"material", solid.material}};
            for (const coupling::WallTravel& travel : solid.travels)
                one["travel"].push_back({{"velocity_m_s", {travel.velocity.x(), travel.velocity.y(), travel.velocity.z()}},
                                         {"from_s", travel.begin},
                                         {"to_s", travel.end}});
            if (solid.turn) one["turn"] = turn_json(*solid.turn);
            if (solid.removed_at) one["removed_at_s"] = *solid.removed_at;
            if (pressed.contains(solid.name)) one["pressed_m"] = pressed.at(solid.name);
            solids.push_back(one);
        }
        nlohmann::json gates = nlohmann::json::array();
        for (const RoomGate& gate : scene_.gates) gates.push_back(gate.name);
        nlohmann::json contacts = nlohmann::json::array();
        for (const RoomPair& pair : scene_.pairs)
            contacts.push_back({{"pair", {scene_.grain_material, pair.other}},
                                {"friction", pair.settings.friction},
                                {"rolling", pair.settings.rolling_friction},
                                {"restitution", pair.settings.restitution}});
        nlohmann::json grains = nlohmann::json::array();
        for (const RoomGrains& kind : scene_.grains) {
            grains.push_back({{"name", kind.name},
                              {"density_kg_m3", kind.mean_density()},
                              {"smallest_m", kind.smallest()},
                              {"largest_m", kind.largest()}});
            for (const GrainClass& one : kind.extremes())
                if (one.density != kind.density) grains.back()["classes"] = classes_json(kind);
            if (!kind.clump.empty()) grains.back()["clump"] = kind.clump.filename().string();
        }
        const Vec3 gravity = scene_.gravity();
        return {
            {"name", scene_.name},
            {"size_m", {scene_.size.x(), scene_.size.y(), scene_.size.z()}},
            {"gravity_m_s2", {gravity.x(), gravity.y(), gravity.z()}},
            {"medium", scene_.medium.name},
            {"end_s", scene_.run.end},
            {"seed", scene_.run.seed},
            {"bed", pieces_.empty() ? nlohmann::json()
                                    : nlohmann::json{{"name", bed_}, {"poured", poured}, {"poured_kg", mass}, {"parts", pieces_.size()}}},
            {"fed_kg", scene_.fed_mass()},
            {"extract_kg", ordered_extraction(scene_)},
            {"gates", gates},
            {"contacts", contacts},
            {"on", models_of(scene_)},
            {"grains", grains},
            {"solids", solids}};
    }

    const RunDirectory& directory_;
    const RoomScene& scene_;
    const std::vector<BedPiece>& pieces_;
    const ParameterValues& values_;
    fs::path solver_;
    int ranks_;
    Say say_;
    std::string bed_;
    const std::optional<meshing::RoomMeshPlan>& mesh_;
};

/// \throws UserError  that names the study's line
meshing::RoomMeshPlan mesh_plan_of(const RoomRequest& request) {
    try {
        return meshing::plan_room_mesh(mesh_input_of(request.scene));
    } catch (const UserError& error) {
        std::vector<Mistake> mistakes = error.mistakes();
        for (Mistake& mistake : mistakes) mistake.where = request.values.where("room.cell_m");
        throw UserError(std::move(mistakes));
    }
}

}  // namespace

RoomRequest room_request(const ParameterValues& values, const fs::path& folder) {
    RoomRequest request;
    request.values = values;
    request.scene = room_scene(request.values, folder);
    Mistakes mistakes;
    mistakes.gather([&] { request.pieces = bed_pieces(request.scene); });
    std::mt19937_64 random(request.scene.run.seed);
    mistakes.gather([&] { place_feeds(request.scene, 1, random); });  // a feed without a place is refused before anything is run
    if (request.scene.medium.present()) mistakes.gather([&] { request.mesh = mesh_plan_of(request); });
    mistakes.refuse();
    return request;
}

RoomRequest read_room_request(const fs::path& study) {
    return room_request(read_placed_room(study), study.parent_path());
}

std::map<std::string, std::string> bed_inputs(const ParameterValues& values) {
    std::map<std::string, std::string> inputs = inputs_of(values, k_geometry);
    inputs.merge(inputs_of(values, k_bed));
    return inputs;
}

std::string take_bed(const fs::path& donor, const RunDirectory& directory, const std::vector<Stage>& stages) {
    std::vector<Stage> shared;
    std::copy_if(stages.begin(), stages.end(), std::back_inserter(shared),
                 [](const Stage& stage) { return stage.name == k_geometry || stage.name == k_bed; });
    std::string apart = why_not_shared(donor, shared);
    if (apart.empty()) share_stages(donor, directory.path(), {k_geometry, k_bed});
    return apart;
}

void require_mesh_for_ranks(const RoomRequest& request, int ranks) {
    if (ranks == 1 || request.mesh) return;
    throw UserError(fmt::format("--ranks {} with room.medium = none", ranks), "Grains without a medium run on one core",
                    "Leave it out; run several studies side by side");
}

std::vector<Stage> room_stages(const RunDirectory& directory, const RoomRequest& request, const fs::path& solver, int ranks, Say say) {
    const auto room = std::make_shared<const RoomWork>(directory, request, solver, ranks, std::move(say));
    std::vector<Stage> stages{
        {k_geometry, inputs_of(request.values, k_geometry), {}, false, [room](bool) { return room->make_geometry(); }},
        {k_bed, inputs_of(request.values, k_bed), {}, true, [room](bool) { return room->make_bed(); }}};
    if (request.mesh)
        stages.push_back({k_mesh, inputs_with_overrides(request.values, k_mesh, directory, true), {}, false, [room](bool) {
                              return room->make_mesh();
                          }});
    stages.push_back({k_case, case_inputs(request, directory), {}, false, [room](bool) { return room->make_case(); }});
    stages.push_back({"run", {}, {}, true, [room](bool) { return room->run(); }});
    stages.push_back({k_report,
                      inputs_of(request.values, k_report),
                      RoomWork::rewritten_by_report(),
                      false,
                      [room](bool) { return room->report(); },
                      {names::results_json, names::report_page}});
    return stages;
}

}  // namespace cutterflow::cases
