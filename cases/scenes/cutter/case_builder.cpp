#include "cases/scenes/cutter/case_builder.hpp"

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

#include "cases/scenes/cutter/flow_dictionaries.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/head_names.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

// A twentieth of a passing of one of six blades: the trapezoidal rule in angle errs by 0.8 % of what passes once a blade, and by nothing
// after a whole revolution.
constexpr double k_degrees_between_samples = 3.0;

meshing::FoamDictionary contact_section(const Rock& rock) {
    return meshing::FoamDictionary()
        .add("youngsModulus", rock.youngs_modulus)
        .add("poissonRock", rock.poisson_rock)
        .add("poissonSteel", rock.poisson_steel)
        .add("friction", rock.friction)
        .add("restitution", rock.restitution)
        .add("wetRestitution", rock.wet_restitution)
        .add("timeStepFraction", rock.time_step_fraction)
        .add("maxSpeed", rock.max_speed);
}

meshing::FoamValue wall_list(const std::vector<Wall>& walls) {
    std::vector<meshing::FoamValue> items;
    for (const Wall& wall : walls)
        items.emplace_back(meshing::FoamDictionary()
                               .add("name", wall.name)
                               .add("file", meshing::FoamValue::quoted(wall.file))
                               .add("rotating", wall.rotating));
    return meshing::FoamValue::list(items);
}

meshing::FoamDictionary rock_section(const CaseInputs& inputs) {
    meshing::FoamDictionary domain;
    domain.add("type", "cylinder")
        .add("radius", inputs.tank.radius)
        .add("zMin", inputs.tank.z_min)
        .add("zMax", inputs.tank.z_max)
        .add("walls", meshing::FoamValue::list({"zMin", "zMax"}));
    meshing::FoamDictionary section;
    section.add("feed", meshing::FoamValue::quoted(names::rock_feed))
        .add("contact", contact_section(*inputs.rock))
        .add("walls", wall_list(inputs.rock->walls))
        .add("domain", domain);
    return section;
}

meshing::FoamDictionary fates_section(const CaseInputs& inputs) {
    const Mouth& mouth = inputs.mouth;
    meshing::FoamDictionary mouth_section;
    mouth_section.add("centre", mouth.centre)
        .add("direction", mouth.direction)
        .add("radius", mouth.radius)
        .add("depth", mouth.sucked_up_depth);
    meshing::FoamDictionary section;
    section.add("contour", meshing::FoamValue::quoted(names::contour_for_solver))
        .add("ringRadius", inputs.contour.ring_radius())
        .add("zBackplate", inputs.contour.z_backplate())
        .add("hysteresis", inputs.fates.hysteresis)
        .add("mouth", mouth_section)
        .add("binWidth", inputs.fates.bin_width);
    return section;
}

void write_text(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw std::runtime_error("cannot write " + path.string());
}

std::string contour_csv(const geometry::Contour& contour) {
    std::string text = "z_m,r_m\n";
    for (std::size_t i = 0; i < contour.z().size(); ++i) text += fmt::format("{},{}\n", contour.z()[i], contour.radius()[i]);
    return text;
}

std::string sample_points_csv(const VelocitySet& set) {
    std::string text = "x_m,y_m,z_m,rotating\n";
    for (const VelocityPoint& point : set.points)
        text += fmt::format("{:.9g},{:.9g},{:.9g},{}\n", point.place[0], point.place[1], point.place[2], point.rotating ? 1 : 0);
    return text;
}

std::string sample_file(const VelocitySet& set) {
    return fmt::format("{}/{}.csv", names::sample_points, set.name);
}

meshing::FoamDictionary velocity_section(const CaseInputs& inputs) {
    std::vector<meshing::FoamValue> sets;
    for (const VelocitySet& set : inputs.velocity_sets)
        sets.emplace_back(meshing::FoamDictionary()
                              .add("name", set.name)
                              .add("file", meshing::FoamValue::quoted(sample_file(set)))
                              .add("phases", set.phases));
    return meshing::FoamDictionary()
        .add("startTime", inputs.times.outflow_from)
        .add("interval", k_degrees_between_samples)
        .add("blades", inputs.blades)
        .add("sets", meshing::FoamValue::list(sets));
}

std::vector<FoamFile> case_files(const CaseInputs& inputs) {
    std::vector<FoamFile> files = field_files(inputs);
    for (const auto& more : {property_files(inputs), run_system_files(inputs)}) files.insert(files.end(), more.begin(), more.end());
    files.push_back(dynamic_mesh_file(inputs));
    files.push_back(decompose_file(inputs.ranks));
    files.push_back({names::coupling_properties, "dictionary", coupling_dictionary(inputs)});
    return files;
}

void copy_surface(const fs::path& run_directory, const WallSource& surface) {
    const fs::path target = run_directory / surface.wall.file;
    fs::create_directories(target.parent_path());
    fs::copy_file(run_directory / surface.surface, target, fs::copy_options::overwrite_existing);
}

}  // namespace

meshing::FoamDictionary coupling_dictionary(const CaseInputs& inputs) {
    meshing::FoamDictionary coupling;
    coupling.add("patches", meshing::FoamDictionary().add("outlet", names::outlet_patch));
    if (inputs.rock) {
        const Rock& rock = *inputs.rock;
        meshing::FoamDictionary kernel, closures;
        kernel.add("gamma", rock.kernel_gamma)
            .add("minWidthInCells", rock.kernel_min_width_in_cells)
            .add("maxSolidFraction", rock.max_solid_fraction);
        closures.add("drag", rock.drag)
            .add("hindrance", rock.hindrance)
            .add("addedMass", rock.added_mass)
            .add("dragModifier", rock.drag_modifier)
            .add("sphericity", rock.sphericity)
            .add("lift", rock.lift)
            .add("viscousForce", rock.viscous_force);
        coupling.add("rock", rock_section(inputs)).add("kernel", kernel).add("closures", closures);
    }
    coupling.add("fates", fates_section(inputs));
    coupling.add("outflow",
                 meshing::FoamDictionary().add("offset", inputs.fates.outflow_offset).add("startTime", inputs.times.outflow_from));
    if (!inputs.velocity_sets.empty()) coupling.add("velocity", velocity_section(inputs));
    if (inputs.fates.stop_undecided) coupling.add("stop", meshing::FoamDictionary().add("undecided", *inputs.fates.stop_undecided));
    coupling.add("checkpoint",
                 meshing::FoamDictionary().add("interval", inputs.times.checkpoint_interval).add("keep", inputs.times.checkpoints_kept));
    return coupling;
}

std::vector<WallSource> wall_sources() {
    return {{{"cutter", "constant/triSurface/cutter_dem.stl", true}, names::cutter_surface},
            {{"backplate", "constant/triSurface/backplate_dem.stl", false}, names::backplate_surface},
            {{"suction_pipe", "constant/triSurface/suction_pipe_dem.stl", false}, names::suction_pipe_surface}};
}

std::vector<Wall> standard_walls() {
    std::vector<Wall> walls;
    for (const WallSource& source : wall_sources()) walls.push_back(source.wall);
    return walls;
}

std::vector<fs::path> write_case(const fs::path& run_directory, const CaseInputs& inputs) {
    const std::vector<Mistake> mistakes = check_case_inputs(inputs);
    if (!mistakes.empty()) throw UserError(mistakes);

    std::vector<fs::path> written;
    for (const FoamFile& file : case_files(inputs)) {
        meshing::write_foam_file(run_directory / file.path, file.foam_class, file.contents);
        written.emplace_back(file.path);
    }
    write_text(run_directory / names::contour_for_solver, contour_csv(inputs.contour));
    written.emplace_back(names::contour_for_solver);
    for (const VelocitySet& set : inputs.velocity_sets) {
        write_text(run_directory / sample_file(set), sample_points_csv(set));
        written.emplace_back(sample_file(set));
    }
    if (inputs.rock) {
        for (const WallSource& surface : wall_sources()) {
            copy_surface(run_directory, surface);
            written.emplace_back(surface.wall.file);
        }
    }
    written.emplace_back(fs::weakly_canonical(run_directory).filename().string() + ".foam");
    write_text(run_directory / written.back(), "");
    return written;
}

}  // namespace cutterflow::cases
