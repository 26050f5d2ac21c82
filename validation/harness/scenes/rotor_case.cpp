#include "validation/harness/scenes/rotor_case.hpp"

#include <fmt/format.h>

#include "cases/scenes/cutter/case_builder.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/head_names.hpp"
#include "geometry/io/write_stl.hpp"
#include "validation/harness/scenes/box_case.hpp"

namespace cutterflow::validation {
namespace {

constexpr double k_inclination = k_pi / 3.0;  // of the axis beside a bank

}  // namespace

void write_rotor_case(const std::filesystem::path& folder, cases::CaseInputs inputs, const std::string& feed,
                      const std::function<void(const std::filesystem::path&)>& write_mesh) {
    std::filesystem::create_directories(folder / "geometry");
    std::optional<cases::CaseInputs::Rock> rock;
    std::swap(rock, inputs.rock);
    cases::write_case(folder, inputs);
    write_mesh(folder);
    run_in_case(folder, {"blockMesh"});
    if (!rock) return;
    for (const auto& [patch, surface] :
         {std::pair(names::cutter_patch, names::cutter_surface), std::pair(names::backplate_patch, names::backplate_surface),
          std::pair(names::tank_top_patch, names::suction_pipe_surface)})
        run_in_case(folder, {"surfaceMeshExtract", "-patches", fmt::format("({})", patch), surface});
    const std::vector<coupling::WallSettings> steel = cases::standard_walls();
    rock->walls.insert(rock->walls.begin(), steel.begin(), steel.end());
    inputs.rock = rock;
    cases::fill_scaled_defaults(inputs);
    cases::write_case(folder, inputs);
    write_file(folder / names::rock_feed, feed);
}

geometry::Bank bank_beside_rotor(const geometry::Contour& contour) {
    geometry::BankParameters parameters;
    parameters.inclination = k_inclination;
    parameters.cut_height = 0.12;
    parameters.step = 0.06;
    parameters.pick_length = 0.01;
    parameters.clearance = 0.005;
    return {contour, parameters};
}

void write_rotor_beside_bank(const std::filesystem::path& folder, cases::CaseInputs inputs, const std::string& feed) {
    inputs.discharge = 0.1;
    inputs.gravity = cases::gravity_of(k_inclination);
    inputs.hauling = Vec3(0.0, -0.1, 0.0);
    inputs.bank_permeability = 0.0;
    inputs.fates.mouth.centre = Vec3(0.0, 0.0, 0.03);  // of the outlet ring in the top, which is the mouth
    inputs.fates.mouth.radius = 0.32;
    inputs.fates.mouth.depth = 0.055;
    inputs.rock->walls = {cases::bank_wall(inputs.hauling)};
    write_rotor_case(folder, inputs, feed);
    const geometry::Bank bank = bank_beside_rotor(inputs.contour);
    geometry::write_stl(bank.soil(k_reach_beside_rotor), folder / names::bank_surface);
    geometry::write_stl(bank.wall({k_reach_beside_rotor, 1e-4, 0.05}), folder / cases::bank_wall().file);
}

}  // namespace cutterflow::validation
