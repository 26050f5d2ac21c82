#include "postproc/pages/room/room_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/progress.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/sphere.hpp"
#include "postproc/analysis/measures/measure_run.hpp"
#include "postproc/analysis/measures/measure_source.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/page.hpp"
#include "postproc/draw/palette.hpp"
#include "postproc/pages/measures/measure_figures.hpp"
#include "postproc/pages/room/room_pictures.hpp"
#include "postproc/run/run_reader.hpp"
#include "postproc/run/run_table.hpp"
#include "postproc/run/solver_starts.hpp"

namespace cutterflow::postproc {

namespace {

namespace fs = std::filesystem;

constexpr const char* k_schema = "cutterflow.room_comparison/1";
constexpr const char* k_account = "rock/account.csv";
constexpr const char* k_contacts = "rock/contacts.csv";
constexpr double k_moved_whole = 0.99;  // of what feeds and extractions are asked for
constexpr double k_deep_overlap = 0.1;  // of a radius
constexpr const char* k_dry_bed =
    "Grains are spheres or rigid clumps; they neither break nor wear nor stick together. The preparation is computed without a medium.";

nlohmann::json read_room(const fs::path& run) {
    return read_json_document(run / k_room_file, {{"name", JsonKind::text, true}, {"end_s", JsonKind::number, true}},
                              "Keep the run directory as the run wrote it");
}

nlohmann::json read_if_there(const fs::path& file) {
    return fs::exists(file) ? read_json_document(file, {}, "Repeat the run in another directory") : nlohmann::json::object();
}

/// cost.json of the last start of the run; empty while the run goes on.
nlohmann::json cost_of(const fs::path& run) {
    nlohmann::json cost = nlohmann::json::object();
    for (const auto& [time, folder] : start_folders(run, "cost")) cost = read_if_there(folder / "cost.json");
    return cost;
}

/// Of preparation and run, those that came first.
std::vector<std::string> warnings_of(const fs::path& run, const nlohmann::json& bed) {
    std::vector<std::string> warnings;
    for (int part = 1; !bed.is_null() && part <= bed.at("parts").get<int>(); ++part)
        for (const std::string& warning : solver_warnings(run / "bed" / std::to_string(part)))
            warnings.push_back(fmt::format("bed/{}: {}", part, warning));
    for (std::string& warning : solver_warnings(run)) warnings.push_back(std::move(warning));
    return first_warnings(std::move(warnings));
}

/// Core seconds of a stage, from the manifest: without those of attempts that were interrupted.
double noted_core_seconds(const nlohmann::json& manifest, const char* stage) {
    return manifest.value("stages", nlohmann::json::object()).value(stage, nlohmann::json::object()).value("core_s", 0.0);
}

/// What feeds gave [kg]. The account's first row is of the end of the first step: what was fed at t = 0 is in it, as the bed is.
double fed_mass(const fs::path& run) {
    const Table events = read_events(run);
    double fed = 0.0;
    for (std::size_t row = 0; row < events.rows(); ++row)
        if (events.text("surface")[row] == "feed")
            fed += sphere_mass(events.number("diameter_m")[row], events.number("density_kg_m3")[row]);
    return fed;
}

/// What became of the grains of the run, from its account; null when it has none.
nlohmann::json account_of(const MeasureSource& source, const nlohmann::json& room) {
    try {
        nlohmann::json account;
        for (const char* where : {"placed", "in_run", "removed", "extracted", "left_domain"})
            account[where] = {{"count", source.column(k_account, std::string(where) + "_count").value.back()},
                              {"kg", source.column(k_account, std::string(where) + "_kg").value.back()}};
        account["extracted"]["ordered_kg"] = room.value("extract_kg", 0.0);
        account["fed"] = {{"ordered_kg", room.value("fed_kg", 0.0)}, {"kg", fed_mass(source.directory())}};
        return account;
    } catch (const UserError&) {
        return nullptr;
    }
}

/// Largest overlap of the run over the radius; null when it has no contacts.csv.
nlohmann::json largest_overlap(const MeasureSource& source) {
    try {
        const std::vector<double> overlaps = source.column(k_contacts, "overlap_ratio_max").value;
        return overlaps.empty() ? nlohmann::json() : nlohmann::json(*std::max_element(overlaps.begin(), overlaps.end()));
    } catch (const UserError&) {
        return nullptr;
    }
}

nlohmann::json results_of(const fs::path& run, const nlohmann::json& room, const MeasureSource& source, std::size_t picture) {
    const Grains& grains = source.grains(picture);
    const double time = source.picture_times().at(picture);
    const nlohmann::json manifest = read_if_there(run / names::manifest);
    return {
        {"schema", "cutterflow.room/1"},
        {"name", room.at("name")},
        {"time_s", time},
        {"end_s", room.at("end_s")},
        {"finished", !cost_of(run).empty()},
        {"grains", grains.size()},
        {"grains_kg", mass_of(grains)},
        {"bed", room.value("bed", nlohmann::json())},
        {"account", account_of(source, room)},
        {"largest_overlap", largest_overlap(source)},
        {"warnings", warnings_of(run, room.value("bed", nlohmann::json()))},
        {"core_s",
         {{"bed", noted_core_seconds(manifest, "bed")}, {"run", solver_core_seconds(run).value_or(noted_core_seconds(manifest, "run"))}}}};
}

std::string answers(const nlohmann::json& results, const nlohmann::json& measures) {
    std::string markup;
    for (const auto& [name, measure] : measures.items())
        markup += html::answer(palette::sucked_up, html::escape(name), html::escape(measure_value_text(measure)),
                               html::escape(measure.at("what").get<std::string>()));
    markup += html::answer(palette::rock_load, "grains in the room", fmt::format("{}", results.at("grains").get<std::size_t>()),
                           fmt::format("{:.4g} kg at {:.4g} s", results.at("grains_kg").get<double>(), results.at("time_s").get<double>()));
    const double core = results.at("core_s").at("bed").get<double>() + results.at("core_s").at("run").get<double>();
    markup += html::answer(palette::faint, "cost", duration_text(core), "core time of bed and run");
    return "<div class=\"answers\">" + markup + "</div>";
}

/// "9.81 m/s2, 25 degrees from the vertical"
std::string gravity_text(const nlohmann::json& gravity) {
    const Vec3 g(gravity.at(0).get<double>(), gravity.at(1).get<double>(), gravity.at(2).get<double>());
    const double tilt = std::atan2(std::hypot(g.x(), g.y()), -g.z()) * 180.0 / k_pi;
    return fmt::format("{:.4g} m/s2{}", g.norm(), tilt > 1e-6 ? fmt::format(", {:.4g} degrees from the vertical", tilt) : "");
}

/// "2500 kg/m3, 3.8 to 4.2 mm", and classes that have densities of their own; a clump is as large as the sphere of its volume.
std::string grains_text(const nlohmann::json& kind) {
    std::string text = fmt::format("{:.6g} kg/m3, {:.4g} to {:.4g} mm", kind.at("density_kg_m3").get<double>(),
                                   1e3 * kind.at("smallest_m").get<double>(), 1e3 * kind.at("largest_m").get<double>());
    for (const nlohmann::json& one : kind.value("classes", nlohmann::json::array()))
        text += fmt::format("; {:.3g} % of the mass of {:.4g} mm and {:g} kg/m3", 1e2 * one.at("mass_share").get<double>(),
                            1e3 * one.at("diameter_m").get<double>(), one.at("density_kg_m3").get<double>());
    if (!kind.contains("clump")) return text;
    return fmt::format("{} (diameters of spheres of their volume); clumps of {}", text, html::escape(kind.at("clump").get<std::string>()));
}

std::string bed_text(const nlohmann::json& bed) {
    const auto poured = bed.at("poured").get<std::size_t>();
    const int parts = bed.at("parts").get<int>();
    return fmt::format("{} grain{} poured, {:.4g} kg, in {} part{}; checkpoint {}", poured, poured == 1 ? "" : "s",
                       bed.at("poured_kg").get<double>(), parts, parts == 1 ? "" : "s", bed.at("name").get<std::string>());
}

std::string what_was_run(const nlohmann::json& room, const nlohmann::json& results) {
    const auto numbers = [](const nlohmann::json& list) {
        return fmt::format("{:g} x {:g} x {:g}", list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>());
    };
    std::vector<std::vector<std::string>> rows{
        {"room", numbers(room.at("size_m")) + " m"},
        {"medium", html::escape(room.at("medium").get<std::string>())},
        {"simulated time", fmt::format("{:.4g} of {:g} s{}", results.at("time_s").get<double>(), room.at("end_s").get<double>(),
                                       results.at("finished").get<bool>() ? "" : "; the run is not finished")},
        {"seed", room.at("seed").dump()}};
    if (room.contains("gravity_m_s2")) rows.push_back({"gravity", gravity_text(room.at("gravity_m_s2"))});
    for (const nlohmann::json& kind : room.at("grains"))
        rows.push_back({html::escape(kind.at("name").get<std::string>()), grains_text(kind)});
    const nlohmann::json& bed = room.at("bed");
    if (!bed.is_null()) rows.push_back({"bed", bed_text(bed)});
    for (const nlohmann::json& solid : room.at("solids")) {
        std::string text = html::escape(solid.at("material").get<std::string>());
        for (const nlohmann::json& travel : travels_of(solid))
            text += fmt::format("; moves from {:g} to {:g} s", travel.at("from_s").get<double>(), travel.at("to_s").get<double>());
        if (solid.contains("turn"))
            text += fmt::format("; turns at {:.4g} rpm from {:g} to {:g} s",
                                solid.at("turn").at("speed_rad_s").get<double>() / rpm_to_rad_s(1.0),
                                solid.at("turn").at("from_s").get<double>(), solid.at("turn").at("to_s").get<double>());
        if (solid.contains("pressed_m"))
            text += fmt::format("; pressed by {:.4g} mm before the run",
                                1e3 * std::hypot(solid.at("pressed_m").at(0).get<double>(), solid.at("pressed_m").at(1).get<double>(),
                                                 solid.at("pressed_m").at(2).get<double>()));
        if (solid.contains("removed_at_s")) text += fmt::format("; taken away at {:g} s", solid.at("removed_at_s").get<double>());
        rows.push_back({html::escape(solid.at("name").get<std::string>()), text});
    }
    for (const nlohmann::json& contact : room.value("contacts", nlohmann::json::array()))
        rows.push_back({html::escape(fmt::format("{} on {}", contact.at("pair").at(0).get<std::string>(),
                                                 contact.at("pair").at(1).get<std::string>())),
                        fmt::format("friction {:g}, rolling friction {:g}, restitution {:g}", contact.at("friction").get<double>(),
                                    contact.at("rolling").get<double>(), contact.at("restitution").get<double>())});
    for (const nlohmann::json& on : room.value("on", nlohmann::json::array())) rows.push_back({"on", html::escape(on.get<std::string>())});
    return html::table({"", ""}, rows, false);
}

/// Where all grains are that the run had.
std::string what_became(const nlohmann::json& results) {
    const nlohmann::json& account = results.at("account");
    const auto row = [&](const char* name, const char* where) {
        return std::vector<std::string>{name, fmt::format("{:.0f}", account.at(where).at("count").get<double>()),
                                        fmt::format("{:.4g}", account.at(where).at("kg").get<double>())};
    };
    std::vector<std::vector<std::string>> rows{row("came in, from the bed and by feeds", "placed"), row("in the room at the end", "in_run"),
                                               row("left through open sides", "left_domain"), row("taken out by events remove", "removed"),
                                               row("extracted", "extracted")};
    std::string text = html::table({"grains", "number", "kg"}, rows, true);
    const double ordered = account.at("fed").at("ordered_kg").get<double>(), fed = account.at("fed").at("kg").get<double>();
    if (ordered > 0.0)
        text += fmt::format(
            "<p>Feeds gave {:.4g} of {:.4g} kg{}</p>", fed, ordered,
            fed < k_moved_whole * ordered ? ": the rest found no room when it was due (rock/rejected.csv), or was not due." : ".");
    const double asked = account.at("extracted").at("ordered_kg").get<double>(), out = account.at("extracted").at("kg").get<double>();
    if (asked > 0.0)
        text += fmt::format("<p>Extractions took {:.4g} of {:.4g} kg{}</p>", out, asked,
                            out < k_moved_whole * asked ? ": the rest is less than a grain, was not in the region when it was due "
                                                          "(rock/extract.csv), or was not due."
                                                        : ".");
    const nlohmann::json& overlap = results.at("largest_overlap");
    if (!overlap.is_null())
        text += fmt::format("<p>Largest overlap of a grain with another or a solid: {:.2g} of its radius{}</p>", overlap.get<double>(),
                            overlap.get<double>() > k_deep_overlap
                                ? ". From 0.1 on contacts are softer than their law; at 1 a grain passes through a solid."
                                : ".");
    return text;
}

/// What selects a model. The solver names the file of the case, a study has a key.
std::string reason_of(const nlohmann::json& model) {
    const bool of_turbulence = model.at("name").get<std::string>().rfind("turbulence: ", 0) == 0;
    return of_turbulence ? "room.turbulence selects it" : model.at("why").get<std::string>();
}

std::string models_and_cost(const fs::path& run, const nlohmann::json& results) {
    const nlohmann::json cost = cost_of(run);
    std::vector<std::vector<std::string>> rows;
    for (const nlohmann::json& model : cost.value("models", nlohmann::json::array()))
        rows.push_back({html::escape(model.at("name").get<std::string>()), html::escape(reason_of(model))});
    std::string markup = rows.empty() ? "" : html::table({"model", "why"}, rows, false);
    rows = {{"bed", duration_text(results.at("core_s").at("bed").get<double>())},
            {"run", duration_text(results.at("core_s").at("run").get<double>())}};
    if (cost.contains("steps")) rows.push_back({"steps of the run", cost.at("steps").dump()});
    return markup + html::table({"stage", "core time"}, rows, true);
}

/// \throws UserError  when there is nothing of a run that could be compared
void require_measured_room(const fs::path& run) {
    if (!is_room_run(run))
        throw UserError(fmt::format("{} {}", run.string(), fs::exists(run) ? "is no run of a room" : "does not exist"),
                        fmt::format("A run of a room has a {}", k_room_file), "Compare runs of one kind");
    if (fs::exists(run / k_measures) && !has_measures(run))
        throw UserError(
            fmt::format("the study of {} has no [[measure]]", run.string()), "Runs of rooms are compared by their measures",
            fmt::format("Write one into it, and repeat cutterflow run STUDY -o {}: the report alone is made anew, unless the run "
                        "itself has to record something",
                        run.string()));
}

std::vector<RunQuantity> quantities_of(const fs::path& run) {
    require_measured_room(run);
    std::vector<RunQuantity> quantities;
    const nlohmann::json measures = read_measures(run);
    for (const auto& [name, measure] : measures.items()) {
        const nlohmann::json& value = measure.at("value");
        quantities.push_back({name, fmt::format("{} ({})", name, measure.at("what").get<std::string>()), measure.value("unit", "-"),
                              value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN(), false,
                              measure.at("detail").value("reason", "")});
    }
    return quantities;
}

}  // namespace

bool is_room_run(const fs::path& run) {
    return fs::exists(run / k_room_file);
}

std::string unfinished_room(const fs::path& run) {
    if (start_folders(run, "cost").empty() || !cost_of(run).empty()) return "";
    const Table steps = read_joined_table(run, "cost", "cost.csv", {{"time_s"}, {}, {}, "Run it again with this version"});
    const double reached = steps.empty() ? 0.0 : steps.number("time_s").back();
    return unfinished_text(run, reached, read_room(run).at("end_s").get<double>());
}

fs::path write_room_report(const fs::path& run) {
    const nlohmann::json room = read_room(run);
    const MeasureSource source(run);
    const std::size_t last = source.picture_near(std::nullopt);
    const nlohmann::json results = results_of(run, room, source, last);
    const nlohmann::json measures = has_measures(run) ? write_possible_measures(run) : nlohmann::json::object();
    write_file(run / names::results_json, results.dump(2) + "\n");
    const fs::path file = run / names::report_page;
    const Page page(file, PageForm::live);
    const std::string title = html::escape(room.at("name").get<std::string>());
    const std::string body =
        fmt::format("<header><h1>{}</h1></header>\n", title) + answers(results, measures) +
        html::notices(results.at("warnings").get<std::vector<std::string>>()) + html::section("What was run", what_was_run(room, results)) +
        (results.at("account").is_null() ? "" : html::section("What became of the grains", what_became(results))) +
        html::section("Grains and solids", room_pictures(page, room, source)) + (measures.empty() ? "" : measures_section(page, measures)) +
        html::section("Models and cost", models_and_cost(run, results)) + fmt::format("<p>{}</p>", k_dry_bed);
    page.write(title, body, "");
    return file;
}

std::vector<SettingResults> compare_room_runs(const std::vector<fs::path>& runs) {
    return compare_settings(runs, names::resolved_study, quantities_of, unfinished_room);
}

nlohmann::json room_comparison_json(const std::vector<SettingResults>& settings) {
    return setting_comparison_json(settings, k_schema);
}

fs::path write_room_comparison(const std::vector<SettingResults>& settings, const fs::path& folder) {
    return write_setting_comparison(settings, k_schema, folder);
}

}  // namespace cutterflow::postproc
