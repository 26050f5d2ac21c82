#include "validation/harness/scenes/rotor_case.hpp"

#include <fmt/format.h>

#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/head/head_names.hpp"
#include "validation/harness/scenes/box_case.hpp"

namespace cutterflow::validation {

void write_rotor_case(const std::filesystem::path& folder, cases::CaseInputs inputs, const std::string& feed) {
    std::filesystem::create_directories(folder / "geometry");
    std::optional<cases::CaseInputs::Rock> rock;
    std::swap(rock, inputs.rock);
    cases::write_case(folder, inputs);
    cases::test::write_tiny_block_mesh(folder);
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

}  // namespace cutterflow::validation
