#include "cases/scenes/cutter/case_builder.hpp"

#include <fmt/format.h>

#include "cases/scenes/cutter/flow_dictionaries.hpp"
#include "cases/scenes/rock/shapes_section.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/head_names.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

/// A section with every key of the struct's table.
template <class Settings>
meshing::FoamDictionary section_of(const Settings& settings) {
    meshing::FoamDictionary section;
    for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>())
        std::visit([&](auto member) { section.add(setting.parameter.key, settings.*member); }, setting.member);
    return section;
}

meshing::FoamValue file_name(const fs::path& file) {
    return meshing::FoamValue::quoted(file.string());
}

meshing::FoamValue wall_list(const std::vector<coupling::WallSettings>& walls) {
    std::vector<meshing::FoamValue> items;
    for (const coupling::WallSettings& wall : walls) {
        meshing::FoamDictionary section;
        section.add("name", wall.name).add("file", file_name(wall.file)).add("rotating", wall.rotating).add("material", wall.material);
        if (wall.surface_velocity != Vec3::Zero()) section.add("surfaceVelocity", wall.surface_velocity);
        items.emplace_back(section);
    }
    return meshing::FoamValue::list(items);
}

meshing::FoamDictionary domain_section(const coupling::DomainSettings& domain) {
    std::vector<meshing::FoamValue> walls;
    for (std::size_t side = 0; side < domain.side_is_wall.size(); ++side)
        if (domain.side_is_wall[side]) walls.emplace_back(coupling::k_domain_sides[side]);
    return meshing::FoamDictionary()
        .add("type", "cylinder")
        .add("radius", domain.radius)
        .add("zMin", domain.lower.z())
        .add("zMax", domain.upper.z())
        .add("walls", meshing::FoamValue::list(walls));
}

meshing::FoamDictionary contact_section(const coupling::ContactSettings& contact) {
    meshing::FoamDictionary pairs;
    for (const coupling::MaterialPair& pair : coupling::k_material_pairs) pairs.add(pair.name, section_of(contact.*pair.settings));
    return section_of(contact).add("pairs", pairs);
}

meshing::FoamDictionary rock_section(const coupling::CouplingSettings& settings, const coupling::DemSettings& dem) {
    std::vector<std::string> shapes;
    for (const coupling::ClumpShape& shape : dem.shapes) shapes.push_back(shape.name);
    meshing::FoamDictionary rock;
    rock.add("feed", file_name(settings.rock_feed));
    if (settings.queue) rock.add("queue", section_of(*settings.queue));
    if (!shapes.empty()) rock.add("shapes", shapes_section(shapes));
    return rock.add("contact", contact_section(dem.contact)).add("walls", wall_list(dem.walls)).add("domain", domain_section(dem.domain));
}

meshing::FoamDictionary soil_section(const coupling::SoilSettings& soil) {
    meshing::FoamDictionary section = section_of(soil).add("surface", file_name(soil.surface));
    if (soil.velocity != Vec3::Zero()) section.add("velocity", soil.velocity);
    return section;
}

meshing::FoamDictionary fates_section(const coupling::FateSettings& fates) {
    meshing::FoamDictionary mouth;
    mouth.add("centre", fates.mouth.centre)
        .add("direction", fates.mouth.direction)
        .add("radius", fates.mouth.radius)
        .add("depth", fates.mouth.depth);
    meshing::FoamDictionary section;
    section.add("contour", file_name(fates.contour))
        .add("ringRadius", fates.ring_radius)
        .add("zBackplate", fates.z_backplate)
        .add("hysteresis", fates.hysteresis)
        .add("mouth", mouth)
        .add("binWidth", fates.bin_width);
    if (fates.cutting)
        section.add("cutting", meshing::FoamDictionary()
                                   .add("distance", fates.cutting->distance)
                                   .add("behind", fates.cutting->behind)
                                   .add("distanceBehind", fates.cutting->distance_behind));
    return section;
}

meshing::FoamDictionary velocity_section(const coupling::VelocitySettings& velocity) {
    std::vector<meshing::FoamValue> sets;
    for (const coupling::VelocitySetSettings& set : velocity.sets)
        sets.emplace_back(meshing::FoamDictionary().add("name", set.name).add("file", file_name(set.file)).add("phases", set.phases));
    return meshing::FoamDictionary()
        .add("startTime", velocity.start_time)
        .add("interval", velocity.interval)
        .add("blades", velocity.blades)
        .add("sets", meshing::FoamValue::list(sets));
}

std::string contour_csv(const geometry::Contour& contour) {
    std::string text = "z_m,r_m\n";
    for (std::size_t i = 0; i < contour.z().size(); ++i) text += fmt::format("{},{}\n", contour.z()[i], contour.radius()[i]);
    return text;
}

std::string sample_points_csv(const VelocitySetInput& set) {
    std::string text = "x_m,y_m,z_m,rotating\n";
    for (const VelocityPoint& point : set.points)
        text += fmt::format("{:.9g},{:.9g},{:.9g},{}\n", point.place[0], point.place[1], point.place[2], point.rotating ? 1 : 0);
    return text;
}

std::vector<FoamFile> case_files(const CaseInputs& inputs) {
    std::vector<FoamFile> files = field_files(inputs);
    for (const auto& more : {property_files(inputs), run_system_files(inputs)}) files.insert(files.end(), more.begin(), more.end());
    files.push_back(dynamic_mesh_file(inputs));
    files.push_back(decompose_file(inputs.ranks));
    files.push_back({names::coupling_properties, "dictionary", coupling_dictionary(inputs)});
    return files;
}

/// \return files relative to the folder
std::vector<fs::path> write_shapes(const fs::path& folder, const CaseInputs& inputs) {
    if (!inputs.rock) return {};
    std::vector<fs::path> written;
    for (const ShapeFile& shape : inputs.rock->shapes) {
        written.emplace_back(path_of_shape(shape.name));
        write_file(folder / written.back(), shape.text);
    }
    return written;
}

void copy_surface(const fs::path& run_directory, const WallSource& surface) {
    const fs::path target = run_directory / surface.wall.file;
    fs::create_directories(target.parent_path());
    fs::copy_file(run_directory / surface.surface, target, fs::copy_options::overwrite_existing);
}

}  // namespace

meshing::FoamDictionary coupling_dictionary(const CaseInputs& inputs) {
    const coupling::CouplingSettings settings = solver_settings(inputs);
    meshing::FoamDictionary coupling;
    if (settings.largest_speed) coupling.add("largestSpeed", *settings.largest_speed);
    coupling.add("patches", meshing::FoamDictionary().add("outlet", settings.patches.outlet));
    if (settings.soil) coupling.add("soil", soil_section(*settings.soil));
    if (settings.has_rock)
        coupling.add("rock", rock_section(settings, dem_settings(inputs)))
            .add("kernel", section_of(settings.kernel))
            .add("closures", section_of(settings.closures));
    coupling.add("fates", fates_section(*settings.fates));
    if (settings.outflow) coupling.add("outflow", section_of(*settings.outflow));
    if (settings.velocity) coupling.add("velocity", velocity_section(*settings.velocity));
    if (settings.stop) coupling.add("stop", section_of(*settings.stop));
    if (settings.checkpoint) coupling.add("checkpoint", section_of(*settings.checkpoint));
    if (settings.record) coupling.add("record", section_of(*settings.record));
    if (!settings.replay.empty()) coupling.add("replay", meshing::FoamDictionary().add("recording", file_name(settings.replay)));
    return coupling;
}

std::vector<WallSource> wall_sources() {
    return {{{"cutter", "constant/triSurface/cutter_dem.stl", true}, names::cutter_surface},
            {{"backplate", "constant/triSurface/backplate_dem.stl", false}, names::backplate_surface},
            {{"suction_pipe", "constant/triSurface/suction_pipe_dem.stl", false}, names::suction_pipe_surface}};
}

std::vector<coupling::WallSettings> standard_walls() {
    std::vector<coupling::WallSettings> walls;
    for (const WallSource& source : wall_sources()) walls.push_back(source.wall);
    return walls;
}

coupling::WallSettings bank_wall(const Vec3& hauling) {
    coupling::WallSettings wall{"bank", "constant/triSurface/bank_dem.stl", false};
    wall.material = coupling::k_soil;
    wall.surface_velocity = hauling;
    return wall;
}

coupling::WallSettings pick_wall() {
    return {"picks", "constant/triSurface/picks_dem.stl", true};
}

std::vector<fs::path> write_case(const fs::path& run_directory, const CaseInputs& inputs) {
    const std::vector<Mistake> mistakes = check_case_inputs(inputs);
    if (!mistakes.empty()) throw UserError(mistakes);

    std::vector<fs::path> written;
    for (const FoamFile& file : case_files(inputs)) {
        meshing::write_foam_file(run_directory / file.path, file.foam_class, file.contents);
        written.emplace_back(file.path);
    }
    write_file(run_directory / names::contour_for_solver, contour_csv(inputs.contour));
    written.emplace_back(names::contour_for_solver);
    for (const VelocitySetInput& set : inputs.velocity_sets) {
        write_file(run_directory / sample_file(set), sample_points_csv(set));
        written.emplace_back(sample_file(set));
    }
    for (const fs::path& shape : write_shapes(run_directory, inputs)) written.push_back(shape);
    if (inputs.rock) {
        for (const WallSource& surface : wall_sources()) {
            copy_surface(run_directory, surface);
            written.push_back(surface.wall.file);
        }
    }
    written.emplace_back(fs::weakly_canonical(run_directory).filename().string() + ".foam");
    write_file(run_directory / written.back(), "");
    return written;
}

void write_replay_case(const fs::path& folder, const CaseInputs& inputs) {
    const std::vector<Mistake> mistakes = check_case_inputs(inputs);
    if (!mistakes.empty()) throw UserError(mistakes);
    std::vector<FoamFile> files = property_files(inputs);
    for (const FoamFile& file : run_system_files(inputs)) files.push_back(file);
    files.push_back({names::coupling_properties, "dictionary", coupling_dictionary(inputs)});
    for (const FoamFile& file : files) meshing::write_foam_file(folder / file.path, file.foam_class, file.contents);
    write_file(folder / names::contour_for_solver, contour_csv(inputs.contour));
    write_shapes(folder, inputs);
}

}  // namespace cutterflow::cases
