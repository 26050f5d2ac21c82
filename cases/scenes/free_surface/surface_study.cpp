#include "cases/scenes/free_surface/surface_study.hpp"

#include <unistd.h>

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/progress.hpp"
#include "solver/free_surface/scene_file/scene_file.hpp"

namespace cutterflow::cases {

namespace {

/// A key that names a file, and what its copies in a run directory are called.
struct FileKey {
    const char *table, *key, *name;
};
constexpr std::array<FileKey, 2> k_file_keys{{{"bodies", "bodies.file", "bodies"}, {"solid", "solid.file", "surface"}}};

double memory_of_machine() {
    return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

nlohmann::json scene_json(const free_surface::Scene& scene) {
    const free_surface::TankSettings& tank = scene.settings.tank;
    nlohmann::json json{{"name", scene.name},
                        {"width_m", tank.cells[0] * tank.cell},
                        {"height_m", tank.cells[2] * tank.cell},
                        {"length_m", tank.depth},
                        {"cell_m", tank.cell},
                        {"columns", tank.cells[0]},
                        {"rows", tank.cells[2]},
                        {"layers", tank.cells[1]},
                        {"spheres", scene.settings.spheres},
                        {"end_s", scene.end},
                        {"bodies", scene.bodies.size()},
                        {"diameter_m", scene.bodies.size() > 0 ? scene.bodies.diameter[0] : 0.0},
                        {"contact_gap_m", scene.dem.contact_gap},
                        {"gap_damping", scene.settings.damping.remaining},
                        {"pipe", nullptr}};
    json["gauges"] = nlohmann::json::array();
    for (const free_surface::Gauge& gauge : scene.gauges)
        json["gauges"].push_back(
            {{"name", gauge.name}, {"x_m", gauge.x}, {"y_m", gauge.y}, {"z_m", gauge.z ? nlohmann::json(*gauge.z) : nlohmann::json()}});
    if (scene.pipe)
        json["pipe"] = {{"bottom_m", scene.pipe->bottom}, {"top_m", scene.pipe->top}, {"inner_width_m", scene.pipe->inner_width}};
    return json;
}

}  // namespace

const ParameterTable& surface_study_table() {
    return free_surface::scene_table();
}

std::string surface_study_template(const std::string& name) {
    return fmt::format(
        "# A water dam with cylinders in it; plane: x to the right, z up.\n"
        "# All keys: cutterflow params --kind free_surface\n"
        "kind = \"free_surface\"\n"
        "name = {}\n\n"
        "[domain]\nwidth_m = 0.286\nheight_m = 0.26\nlength_m = 0.099    # across, and of the cylinders\n"
        "cell_m = 0.001      # a body needs at least 5 cells across, better 8\n\n"
        "[[fill]]            # water at rest; what solids and bodies take is left out\n"
        "from_x_m = 0.0\nfrom_z_m = 0.0\nto_x_m = 0.066\nto_z_m = 0.12\n\n"
        "[[bodies]]\ndiameter_m = 0.01\ndensity_kg_m3 = 2700.0\nlayers = 6\nwidest = 6\ncentre_x_m = 0.0335\nlowest_m = 0.001\n"
        "clearance_m = 0.001\njitter_m = 1e-5\nseed = 1            # repeats differ in it\n\n"
        "[contact]\nfriction = 0.3\ngap_m = 0.001       # at least a quarter of a cell\n\n"
        "[run]\nend_s = 0.5\nwrite_interval_s = 0.02\ncheckpoint_interval_s = 0.1\n",
        toml_text(ParameterValue(name)));
}

SurfaceCheck check_surface_study(const std::filesystem::path& file) {
    const free_surface::Scene scene = free_surface::read_scene(file);
    const free_surface::ScenePrediction found = free_surface::predict(scene);
    if (found.memory > memory_of_machine())
        throw UserError(
            fmt::format("{}: the run needs {:.1f} GB of memory", file.string(), found.memory / 1e9),
            fmt::format("The machine has {:.1f} GB", memory_of_machine() / 1e9),
            fmt::format("Use cells of {:.2g} m", scene.settings.tank.cell * std::pow(found.memory / memory_of_machine(),
                                                                                     scene.settings.tank.plane ? 1.0 / 2.0 : 1.0 / 3.0)));
    std::vector<std::string> notes = scene.notes;
    for (std::string& note : free_surface::water_notes(scene)) notes.push_back(std::move(note));
    return {scene_json(scene),
            {{"cells", found.cells},
             {"water_cells", found.water_cells},
             {"particles", found.particles},
             {"step_s", found.step},
             {"steps", found.steps},
             {"core_s", found.core_seconds},
             {"memory_bytes", found.memory},
             {"contact_step_s", found.dem_step}},
            scene.close,
            notes};
}

SurfaceInputs surface_inputs(const std::filesystem::path& study) {
    SurfaceInputs inputs{read_file(study), {}};
    ParameterValues values = read_placed_surface_study(study);
    for (const auto& [table, key, what] : k_file_keys) {
        for (ParameterValues& values_of_table : values.tables_for_writing(table)) {
            if (!values_of_table.has(key)) continue;
            const std::filesystem::path file = values_of_table.text(key);
            const std::string name = fmt::format("{}_{}{}", what, inputs.copies.size() + 1, file.extension().string());
            inputs.copies[name] = file;
            values_of_table.set(key, name);
        }
    }
    if (!inputs.copies.empty()) inputs.study = commented_toml(surface_study_table(), &values);
    return inputs;
}

ParameterValues read_placed_surface_study(const std::filesystem::path& study) {
    ParameterValues values = read_parameters(surface_study_table(), study);
    for (const auto& [table, key, what] : k_file_keys) {
        for (ParameterValues& values_of_table : values.tables_for_writing(table)) {
            if (values_of_table.has(key))
                values_of_table.set(key, std::filesystem::absolute(study.parent_path() / values_of_table.text(key)).string());
        }
    }
    return values;
}

void require_surface_study(const std::string& toml, const std::string& name) {
    free_surface::parse_scene(toml, name);
}

std::string to_text(const SurfaceCheck& check) {
    const auto number = [&](const char* key) { return check.prediction.at(key).get<double>(); };
    std::string text =
        fmt::format("{}: {:.0f} cells, {:.0f} of water, {:.0f} particles, {} bodies\n", check.scene.at("name").get<std::string>(),
                    number("cells"), number("water_cells"), number("particles"), check.scene.at("bodies").get<int>());
    text += fmt::format("about {:.0f} steps of {:.2g} s, {} on one core, {:.0f} MB\n", number("steps"), number("step_s"),
                        duration_text(number("core_s")), number("memory_bytes") / 1e6);
    if (number("contact_step_s") > 0.0) text += fmt::format("contact step {:.4g} s\n", number("contact_step_s"));
    for (const std::string& line : check.close) text += line + "\n";
    for (const std::string& note : check.notes) text += "note: " + note + "\n";
    return text;
}

}  // namespace cutterflow::cases
