#include "postproc/run/run_reader.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/sphere.hpp"
#include "geometry/base/toml.hpp"
#include "geometry/head/head_names.hpp"
#include "postproc/run/input_files.hpp"
#include "postproc/run/solver_starts.hpp"
#include "postproc/run/study_setting.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* k_rerun = "Repeat the run with this version of Cutterflow";

// What the report takes from the JSON files of a run.
const std::vector<JsonField> k_geometry_fields{{"file", JsonKind::text},
                                               {"head/ring_radius_m", JsonKind::number, true},
                                               {"head/blades", JsonKind::whole},
                                               {"head/blade_slices/*/coverage", JsonKind::number},
                                               {"head/blade_slices/*/angle_deg", JsonKind::number},
                                               {"head/blade_slices/*/depth_m", JsonKind::number},
                                               {"surface", JsonKind::object}};
const std::vector<JsonField> k_feed_fields{{"feeds/*/requested", JsonKind::whole, true},
                                           {"feeds/*/rejected", JsonKind::whole, true},
                                           {"feeds/*/reasons/*", JsonKind::text},
                                           {"feeds/*/left_by_swing_before", JsonKind::truth},
                                           {"feeds/*/layers/*/thickness_m", JsonKind::number},
                                           {"feeds/*/layers/*/section_m2", JsonKind::number},
                                           {"feeds/*/classes/*/diameter_m", JsonKind::number, true},
                                           {"feeds/*/classes/*/density_kg_m3", JsonKind::number, true},
                                           {"feeds/*/classes/*/count", JsonKind::number, true},
                                           {"feeds/*/classes/*/settling_velocity_m_s", JsonKind::number_or_null},
                                           {"feeds/*/classes/*/shape", JsonKind::text}};
const std::vector<JsonField> k_mesh_fields{
    {"cells", JsonKind::whole}, {"gates/*/name", JsonKind::text}, {"gates/*/passed", JsonKind::truth}};
const std::vector<JsonField> k_manifest_fields{{"stages", JsonKind::object}, {"versions", JsonKind::object}};
const std::vector<JsonField> k_prediction_fields{{"first_release_s", JsonKind::number, true},
                                                 {"core_hours_per_revolution", JsonKind::number, true},
                                                 {"core_hours_per_revolution_with_rock", JsonKind::number, true},
                                                 {"cells", JsonKind::number, true},
                                                 {"time_step_s", JsonKind::number, true},
                                                 {"time_step_with_rock_s", JsonKind::number, true},
                                                 {"development_end_s", JsonKind::number},
                                                 {"development_step_ratio", JsonKind::number}};
const std::vector<JsonField> k_cost_fields{{"cells", JsonKind::whole},       {"ranks", JsonKind::whole},
                                           {"core_s", JsonKind::number},     {"models/*/name", JsonKind::text},
                                           {"models/*/why", JsonKind::text}, {"versions", JsonKind::object}};

/// Object of a JSON file; empty object when the file is absent.
json read_json(const fs::path& file, const std::vector<JsonField>& fields) {
    return fs::exists(file) ? read_json_document(file, fields, k_rerun) : json::object();
}

/// Collects all mistakes in the values of a file.
class StudyReader {
public:
    /// \param remedy  of mistakes in its values
    explicit StudyReader(fs::path file, std::string remedy = k_rerun) : file_(std::move(file)), remedy_(std::move(remedy)) {
        if (!fs::exists(file_))
            throw UserError(fmt::format("{} is not a run directory", file_.parent_path().string()),
                            fmt::format("A run directory contains {}, written by `cutterflow run`", file_.filename().string()),
                            "Check the path, or run the study first");
        try {
            root_ = toml::parse_file(file_.string());
        } catch (const std::runtime_error& error) {  // toml::parse_error or TomlAssertion
            throw UserError(fmt::format("{} cannot be read as TOML: {}", file_.string(), error.what()), "",
                            "Give a run directory written by `cutterflow run`");
        }
    }
    double number(const std::string& key) {
        const std::optional<double> value = root_.at_path(key).value<double>();
        if (!value) miss(key, "is missing or not a number");
        return value.value_or(1.0);
    }
    double positive(const std::string& key) {
        const double value = number(key);
        if (!(value > 0.0)) miss(key, fmt::format("= {} is not positive", value));
        return value;
    }
    double number_or(const std::string& key, double standard) const { return root_.at_path(key).value<double>().value_or(standard); }
    std::string text(const std::string& key, bool required) {
        const std::optional<std::string> value = root_.at_path(key).value<std::string>();
        if (!value && required) miss(key, "is missing or not a text");
        return value.value_or("");
    }
    bool is_true(const std::string& key) const { return root_.at_path(key).value_or(false); }
    /// Share of what is cut that becomes rock of the feed's sizes.
    double rock_share() const { return root_["feed"][0]["disintegration"].value_or(1.0); }
    bool is_fed_by_cutting() const { return root_["feed"][0]["kind"].value_or(std::string()) == "cut_face"; }
    bool has_bank() const { return root_["bank"]["model"].value_or(std::string()) == "wall"; }
    int seed() const { return root_["feed"][0]["seed"].value_or(0); }
    void require_all() {
        if (!mistakes_.empty()) throw UserError(std::move(mistakes_));
    }

private:
    void miss(const std::string& key, const std::string& what) {
        mistakes_.push_back({file_.string(), fmt::format("{} {}", key, what), "The report needs it", remedy_});
    }
    fs::path file_;
    std::string remedy_;
    toml::table root_;
    std::vector<Mistake> mistakes_;
};

OperatingPoint read_operating_point(StudyReader& study) {
    OperatingPoint point;
    point.study_name = study.text("name", false);
    point.speed_rpm = study.positive("rotor.speed_rpm");
    point.rotor_direction = study.text("rotor.direction", true);
    point.discharge = study.positive("suction.discharge_m3_s");
    point.mouth_radius = study.positive("suction.mouth_radius_m");
    point.mouth_offset = study.number("suction.mouth_offset_m");
    point.mouth_azimuth_deg = study.number("suction.mouth_azimuth_deg");
    point.inclination_deg = study.number("ladder.inclination_deg");
    point.fluid_density = study.positive("fluid.density_kg_m3");
    point.outflow_start = study.number("report.outflow_start_s");
    point.length_ratio = study.positive("scale.length_ratio");
    point.swing_direction = study.text("swing.direction", false);
    point.mesh_preset = study.text("mesh.preset", false);
    point.fed_by_cutting = study.is_fed_by_cutting();
    point.has_bank = study.has_bank();
    point.bank_of_file = !study.text("bank.file", false).empty();
    point.swing_speed = study.number_or("swing.speed_m_min", 0.0) / 60.0;
    point.bulking = study.number_or("soil.bulking", point.bulking);
    point.cut_height = study.number_or("bank.cut_height_m", 0.0);
    point.step = study.number_or("bank.step_m", 0.0);
    point.standing_out = study.number_or("bank.pick_length_m", 0.0) + study.number_or("bank.clearance_m", 0.0);
    point.spill_layer = study.number_or("bed.spill_layer_m", 0.0);
    point.rock_share = study.rock_share();
    point.hauls = study.is_true("hauling.water");
    if (const double energy = study.number_or("soil.specific_energy_mj_m3", 0.0); energy > 0.0) point.specific_energy = 1e6 * energy;
    point.grain_density = study.number_or("soil.grain_density_kg_m3", 0.0);
    point.in_situ_density = point.grain_density * (1.0 - study.number_or("soil.porosity", 0.0));
    return point;
}

AdvProbe read_adv_probe(const StudyReader& study) {
    const AdvProbe standard;
    return {study.number_or("report.adv_probe_diameter_m", standard.diameter),
            study.number_or("report.adv_probe_length_m", standard.length),
            study.number_or("report.adv_position_error_m", standard.position_error)};
}

geometry::Contour read_contour(const fs::path& directory, double ring_radius, double gap) {
    const fs::path file = directory / names::contour_table;
    const Table table = read_table(file, {{"z_m", "r_m"}, {}, {}, k_rerun}, true);
    if (table.rows() == 0 || std::abs(table.number("z_m").back()) > 1e-6 * ring_radius)
        throw UserError(fmt::format("{} does not end at the ring plane, z = 0", file.string()), "A contour goes from hub to ring", k_rerun);
    try {
        return geometry::Contour(table.number("z_m"), table.number("r_m"), ring_radius, gap);
    } catch (const std::exception& error) {
        throw UserError(fmt::format("{} is not a contour: {}", file.string(), error.what()), "", k_rerun);
    }
}

std::optional<FeedSummary> read_feed(const fs::path& file) {
    if (!fs::exists(file)) return std::nullopt;
    const json report = read_json(file, k_feed_fields);
    FeedSummary summary;
    double mass = 0.0, left = 0.0;
    for (const json& feed : report.at("feeds")) {
        summary.requested += feed.at("requested").get<std::int64_t>();
        summary.rejected += feed.at("rejected").get<std::int64_t>();
        for (const json& reason : feed.value("reasons", json::array())) summary.reasons.push_back(reason);
        for (const json& layer : feed.value("layers", json::array())) {
            summary.layer_thickness.push_back(layer.value("thickness_m", 0.0));
            summary.layer_section.push_back(layer.value("section_m2", 0.0));
        }
        for (const json& item : feed.value("classes", json::array())) {
            RockClass rock_class{item.at("diameter_m"), item.at("density_kg_m3"), item.at("count"), std::nullopt};
            const json speed = item.value("settling_velocity_m_s", json());
            if (!speed.is_null()) rock_class.settling_velocity = speed;
            summary.classes.push_back(rock_class);
            if (const std::string shape = item.value("shape", ""); !shape.empty())
                summary.reasons.push_back(
                    fmt::format("Rock of {:.3g} mm is clumps of {}: the diameter is that of the sphere of their volume.",
                                1e3 * rock_class.diameter, shape));
            const double of_class = rock_class.count * sphere_mass(rock_class.diameter, rock_class.density);
            mass += of_class;
            if (feed.value("left_by_swing_before", false)) left += of_class;
        }
    }
    if (mass > 0.0) summary.left_share = left / mass;
    return summary;
}

TableRules event_rules() {
    return {{"time_s", "id", "x_m", "y_m", "z_m", "rotor_angle_rad", "azimuth_rad", "axial_m", "diameter_m", "density_kg_m3"},
            {"surface", "direction", "bin"},
            {},
            k_rerun,
            {"id"}};
}

TableRules fate_rules() {
    return {{"time_s", "placed_count", "placed_kg", "sucked_up_count", "sucked_up_kg", "spilled_count", "spilled_kg", "in_cutter_count",
             "in_cutter_kg", "never_entered_count", "never_entered_kg"},
            {},
            {},
            k_rerun,
            {"placed_count", "sucked_up_count", "spilled_count", "in_cutter_count", "never_entered_count"}};
}

TableRules ledger_rules() {
    return {{"time_s", "fed_kg", "owed_kg", "in_head_kg", "delivered_kg", "spilled_mixing_kg", "spilled_cutting_kg", "on_bed_kg",
             "left_behind_kg", "error"},
            {},
            {},
            k_rerun};
}

TableRules final_rules() {
    return {{"id", "first_exit_time_s", "first_exit_azimuth_rad", "x_m", "y_m", "z_m", "diameter_m", "density_kg_m3"},
            {"fate", "last_exit_bin"},
            {"first_exit_time_s", "first_exit_azimuth_rad"},
            k_rerun};
}

TableRules balance_rules() {
    const std::vector<std::string> rock{"solid_volume_error",
                                        "deposit_error",
                                        "momentum_error",
                                        "momentum_interface_error",
                                        "momentum_replaced",
                                        "momentum_turned",
                                        "momentum_carried",
                                        "solid_fraction_max",
                                        "overfull_cells",
                                        "overlap_ratio_max",
                                        "dem_substeps",
                                        "rocks",
                                        "contacts"};
    TableRules rules{{"time_s", "flow_balance_error", "interface_imbalance", "interface_mismatch", "continuity_error", "domain_surplus",
                      "clipped_cells", "outlet_flow_m3_s", "outlet_pressure_m2_s2", "courant_max"},
                     {},
                     rock,
                     k_rerun};
    rules.numbers.insert(rules.numbers.end(), rock.begin(), rock.end());
    const std::vector<std::string> since{"momentum_boundary", k_swept_limited_cells, k_wake_limited_rocks, k_hidden_rocks, k_cramped_rocks};
    rules.may_be_empty.insert(rules.may_be_empty.end(), since.begin(), since.end());
    return rules;
}

/// The last folder's table that exists, for tables that are rewritten as a whole.
Table read_newest_table(const fs::path& directory, const std::string& what, const std::string& file, const TableRules& rules) {
    Table newest;
    for (const auto& [start, folder] : start_folders(directory, what)) {
        if (!fs::exists(folder / file)) continue;
        Table table = read_table(folder / file, rules);
        if (!table.columns().empty()) newest = std::move(table);
    }
    return newest;
}

Table read_plane(const fs::path& directory, const std::string& file) {
    const std::vector<std::string> in_water{"u_radial_m_s",  "u_tangential_m_s",  "u_axial_m_s",
                                            "se_radial_m_s", "se_tangential_m_s", "se_axial_m_s"};
    TableRules rules{{"x_m", "y_m", "z_m", "revolutions", "from_s", "to_s"}, {}, in_water, k_rerun};
    rules.numbers.insert(rules.numbers.end(), in_water.begin(), in_water.end());
    return read_newest_table(directory, "velocity", file, rules);
}

std::optional<RockTables> read_rock(const fs::path& directory) {
    RockTables rock;
    rock.fates = read_fates(directory);
    if (rock.fates.empty()) return std::nullopt;
    rock.ledger = read_ledger(directory);
    rock.events = read_events(directory);
    rock.final_state = read_newest_table(directory, "rock", "final.csv", final_rules());
    rock.rejected_in_run = read_joined_table(directory, "rock", "rejected.csv", {{"time_s", "id"}, {"reason"}, {}, k_rerun}, {"id"}).rows();
    return rock;
}

void require_computed(const RunData& run) {
    if (!run.balance.empty() && !run.cost.empty() && !run.loads.empty()) return;
    throw UserError(fmt::format("{} contains no computed time step", (run.directory / "postProcessing").string()),
                    "A report needs the tables balance, cost and loads of cutterFoam",
                    "Start or continue the run: cutterflow run --resume");
}

/// A finished run wrote its last rows at its end; a table that ends before lost a part, as by a copy that was broken off.
void require_whole(const RunData& run) {
    if (!run.finished) return;
    const fs::path folder = run.directory / "postProcessing";
    std::vector<std::pair<const char*, const Table*>> tables{{"cost", &run.cost}};
    if (!run.flow) tables.insert(tables.end(), {{"balance", &run.balance}, {"loads", &run.loads}});
    if (run.rock) tables.emplace_back("rock", &run.rock->fates);
    double end = 0.0;
    for (const auto& [name, table] : tables) end = std::max(end, table->number("time_s").back());
    std::vector<Mistake> mistakes;
    for (const auto& [name, table] : tables)
        if (const double last = table->number("time_s").back(); last < end * (1.0 - 1e-6))
            mistakes.push_back({(folder / name).string(), fmt::format("ends at {:g} s, the run at {:g} s", last, end),
                                "The tables of a finished run reach its end", "Copy the run directory again as a whole"});
    if (!run.rock && run.feed && run.feed->requested > run.feed->rejected)
        mistakes.push_back(
            {(folder / "rock").string(), "contains no fates", "The study feeds rock", "Copy the run directory again as a whole"});
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

void read_cost(RunData& run) {
    run.cost = read_joined_table(run.directory, "cost", "cost.csv",
                                 {{"time_s", "step_s", "fluid_s", "mesh_motion_s", "mapping_s", "dem_s", "output_s"}, {}, {}, k_rerun});
    const auto folders = start_folders(run.directory, "cost");
    run.cost_summary = folders.empty() ? json::object() : read_json(folders.back().second / "cost.json", k_cost_fields);
    run.finished = !run.cost_summary.empty();
    run.core_s = solver_core_seconds(run.directory);
    run.warnings = first_warnings(solver_warnings(run.directory));
}

/// \param files  that the run was made from, by their content
void read_setting(RunData& run, const StudyReader& study, const std::map<std::string, std::string>& files) {
    StudySetting setting = study_setting(read_file(run.directory / names::resolved_study), files);
    run.setting = std::move(setting.values);
    run.release = std::move(setting.release);
    run.seed = study.seed();
}

/// A run that computed its flow.
RunData read_computed_run(const fs::path& directory) {
    StudyReader study(directory / names::resolved_study);
    const OperatingPoint point = read_operating_point(study);
    const double bin_width = study.positive("report.bin_width_m");
    const double gap = study.positive("suction.gap_m");
    study.require_all();
    const json geometry = read_json_document(directory / names::geometry_report, k_geometry_fields, k_rerun);
    const geometry::Contour contour = read_contour(directory, geometry.at("head").at("ring_radius_m"), gap);
    RunData run{directory,
                point,
                contour,
                geometry::axial_bins(contour, bin_width),
                read_feed(directory / names::feed_report),
                read_rock(directory),
                {},
                {},
                {},
                {},
                {},
                read_plane(directory, "plane_axial.csv"),
                read_plane(directory, "plane_under_ring.csv"),
                geometry,
                read_json(directory / names::mesh_report, k_mesh_fields),
                read_json(directory / names::manifest, k_manifest_fields),
                {},
                std::max(1, geometry.at("head").value("blades", 1)),
                read_adv_probe(study)};
    run.prediction = read_json(directory / names::prediction, k_prediction_fields);
    read_setting(run, study, input_files(run.manifest));
    std::vector<std::string> bin_names;
    for (const geometry::AxialBin& bin : run.bins) bin_names.push_back(bin.name);
    bin_names.insert(bin_names.begin(), "time_s");
    const TableRules of_bins{bin_names, {}, {}, "Use the bin width of the run (report.bin_width_m)"};
    run.outflow = read_joined_table(directory, "outflow", "contour_velocity.csv", of_bins);
    run.outflow_flux = read_joined_table(directory, "outflow", "contour_flux.csv", of_bins);
    run.loads = read_joined_table(
        directory, "loads", "loads.csv",
        {{"time_s", "rotor_angle_rad", "torque_pressure_n_m", "torque_viscous_n_m", "torque_rock_n_m", "power_w"}, {}, {}, k_rerun});
    run.balance = read_joined_table(directory, "balance", "balance.csv", balance_rules());
    read_cost(run);
    require_computed(run);
    require_whole(run);
    return run;
}

constexpr const char* k_replay_again = "Repeat the replay command with --resume";

const std::vector<JsonField> k_replay_fields{{"schema", JsonKind::text, true},
                                             {"run", JsonKind::text, true},
                                             {"flow_start_s", JsonKind::number, true},
                                             {"flow_end_s", JsonKind::number, true},
                                             {"flow_change", JsonKind::number_or_null, true},
                                             {"files/*/input", JsonKind::text},
                                             {"files/*/sha256", JsonKind::text}};

/// The run that recorded the flow of a replay.
/// \throws UserError  when it is gone, or has recorded another flow since
RecordedFlow read_recorded_flow(const fs::path& directory) {
    const fs::path file = directory / names::replay;
    const json replay = read_json_document(file, k_replay_fields, k_replay_again);
    if (replay.at("schema") != k_replay_schema)
        throw UserError({{file.string(), fmt::format("its schema is {}", replay.at("schema").get<std::string>()),
                          fmt::format("This version of the program reads {}", k_replay_schema), k_replay_again}});
    RecordedFlow flow{replay.at("run").get<std::string>(), replay.at("flow_start_s"), replay.at("flow_end_s"), {}};
    if (!replay.at("flow_change").is_null()) flow.change = replay.at("flow_change");
    if (!fs::exists(flow.run / names::geometry_report))
        throw UserError({{file.string(), fmt::format("run = {}: there is no such run", flow.run.string()),
                          "A report of a replay needs the run that recorded its flow", "Move it back, or correct run in this file"}});
    const json recording = read_json(flow.run / names::recording / "recording.json", {{"end_s", JsonKind::number, true}});
    if (!recording.empty() &&
        (recording.at("end_s") != replay.at("flow_end_s") || recording.value("change", json()) != replay.at("flow_change")))
        throw UserError({{file.string(), fmt::format("the flow that {} holds is not the one that was replayed", flow.run.string()),
                          "A replay belongs to one recorded flow", "Replay the rock again in a new folder"}});
    return flow;
}

/// The files of the run that recorded the flow, with those of the replay's own rock: earlier programs wrote none.
std::map<std::string, std::string> files_of_replay(const fs::path& directory, const json& manifest) {
    std::map<std::string, std::string> files;
    for (const auto& [input, hash] : input_files(manifest))
        if (input.rfind("feed[", 0) != 0) files[input] = hash;
    const json replay = read_json_document(directory / names::replay, k_replay_fields, k_replay_again);
    for (const json& file : replay.value("files", json::array())) files[file.value("input", "")] = file.value("sha256", "");
    return files;
}

void require_same_operation(const OperatingPoint& replay, const OperatingPoint& flow, const fs::path& directory) {
    const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-6 * std::abs(b); };
    Mistakes mistakes((directory / names::resolved_study).string());
    const auto compare = [&](const char* key, double own, double of_flow) {
        mistakes.require(!differ(own, of_flow), fmt::format("{} = {:g}, the recorded flow has {:g}", key, own, of_flow),
                         "Rock is replayed at the speed and the discharge of its flow", k_replay_again);
    };
    compare("rotor.speed_rpm", replay.speed_rpm, flow.speed_rpm);
    compare("suction.discharge_m3_s", replay.discharge, flow.discharge);
    mistakes.refuse();
}

/// The flow of one run and the rock of another study in it.
RunData read_replay(const fs::path& directory) {
    const RecordedFlow flow = read_recorded_flow(directory);
    StudyReader study(directory / names::resolved_study, k_replay_again);
    OperatingPoint point = read_operating_point(study);
    study.require_all();
    RunData run = read_computed_run(flow.run);
    require_same_operation(point, run.operating_point, directory);
    if (run.rock) run.plane_axial = run.plane_under_ring = {};  // means of water that has felt that run's rock
    run.flow = flow;
    run.directory = directory;
    point.study_name = run.operating_point.study_name + k_replayed;
    run.operating_point = point;
    run.feed = read_feed(directory / names::feed_report);
    run.rock = read_rock(directory);
    run.prediction = {};
    read_setting(run, study, files_of_replay(directory, run.manifest));
    run.setting["recorded flow, revolutions"] = fmt::format("{:.9g}", flow.end / point.revolution_s());
    read_cost(run);
    if (!run.rock || run.cost.empty())
        throw UserError({{(directory / "postProcessing").string(), run.rock ? "contains no cost" : "contains no fates",
                          "A report of a replay needs the tables of its rock", k_replay_again}});
    require_whole(run);
    return run;
}

/// \throws UserError  for a folder of replays, and for a replay of before its folder told what it is
void require_no_older_replay(const fs::path& directory) {
    if (fs::exists(directory / names::resolved_study)) return;
    if (fs::exists(directory / "replays.json"))
        throw UserError({{directory.string(), "it holds replays", "A report is of one of them", "Name its folders replay_..."}});
    if (fs::exists(directory / names::coupling_properties) && !fs::exists(directory / names::manifest))
        throw UserError({{directory.string(), fmt::format("there is no {}", names::replay),
                          "A replay's folder tells whose flow its rock goes through", k_replay_again}});
}

}  // namespace

Table read_fates(const fs::path& run_directory) {
    return read_joined_table(run_directory, "rock", "fates.csv", fate_rules());
}

Table read_events(const fs::path& run_directory) {
    return read_joined_table(run_directory, "rock", "events.csv", event_rules(), {"id", "surface", "direction"});
}

Table read_ledger(const fs::path& run_directory) {
    return read_joined_table(run_directory, "rock", "ledger.csv", ledger_rules());
}

RunData read_run(const fs::path& directory) {
    require_no_older_replay(directory);
    return fs::exists(directory / names::replay) ? read_replay(directory) : read_computed_run(directory);
}

}  // namespace cutterflow::postproc
