#include "solver/liggghts/liggghts_commands.hpp"

#include <cmath>

#include <fmt/format.h>

#include "solver/liggghts/contacts/contact_registration.hpp"

namespace cutterflow::liggghts::commands {

namespace {

/// Triangles that meet at less than this count as one plane, and nothing happens at their edge. By LIGGGHTS' own 0.26 degrees a rock above
/// a convex edge of less, which no triangle faces, falls through. At 1e-5 degrees that wedge is narrower than the tolerance of the search.
constexpr double k_coplanar_deg = 1e-5;

std::string vector_text(const Vec3& v) {
    return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}

}  // namespace

std::vector<std::string> basics() {
    return {"units si",       "atom_style granular", "atom_modify map array sort 0 0",
            "boundary f f f", "newton off",          "communicate single vel yes"};
}

std::vector<std::string> create_box(const Box& box) {
    return {fmt::format("region domain block {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} units box", box.low.x(), box.high.x(),
                        box.low.y(), box.high.y(), box.low.z(), box.high.z()),
            "create_box 2 domain"};
}

std::string read_restart(const std::filesystem::path& file) {
    return fmt::format("read_restart \"{}\"", file.string());
}
std::string write_restart(const std::filesystem::path& file) {
    return fmt::format("write_restart \"{}\"", file.string());
}

std::vector<std::string> contact_model() {
    return {fmt::format("pair_style gran {}", k_contact_model), "pair_coeff * *", "thermo_modify lost ignore norm no"};
}

std::string timestep(double seconds) {
    return fmt::format("timestep {:.17g}", seconds);
}

std::string run(int steps, bool set_up) {
    return fmt::format("run {} pre {} post no", steps, set_up ? "yes" : "no");
}

std::vector<std::string> neighbours(double skin, double bin_size) {
    return {fmt::format("neighbor {:.17g} bin", skin), fmt::format("neigh_modify delay 0 binsize {:.17g}", bin_size)};
}

std::string rock_property(const std::string& name, int columns) {
    std::string zeros;
    for (int k = 0; k < columns; ++k) zeros += " 0.0";
    return fmt::format("fix {0} all property/atom {0} vector yes no no{1}", name, zeros);
}

std::string mesh(const std::string& id, const std::filesystem::path& stl) {
    return fmt::format("fix {} all mesh/surface file \"{}\" type 2 curvature {:g} curvature_tolerant yes", id, stl.string(),
                       k_coplanar_deg);
}

std::string rotate_mesh(const std::string& id, const std::string& mesh_id, const RotationAxis& axis, double speed) {
    const Vec3 direction = speed > 0.0 ? axis.direction : Vec3(-axis.direction);
    return fmt::format("fix {} all move/mesh mesh {} rotate origin {} axis {} period {:.17g}", id, mesh_id, vector_text(axis.origin),
                       vector_text(direction), 2.0 * k_pi / std::fabs(speed));
}

std::string move_mesh(const std::string& id, const std::string& mesh_id, const Vec3& velocity) {
    return fmt::format("fix {} all move/mesh mesh {} linear {}", id, mesh_id, vector_text(velocity));
}

std::string unfix(const std::string& id) {
    return "unfix " + id;
}

std::string mesh_walls(const std::string& id, const std::vector<std::string>& mesh_ids) {
    return fmt::format("fix {} all wall/gran {} mesh n_meshes {} meshes {}", id, k_contact_model, mesh_ids.size(),
                       fmt::join(mesh_ids, " "));
}

std::string plane_wall(const std::string& id, int axis, double position) {
    return fmt::format("fix {} all wall/gran {} primitive type 2 {}plane {:.17g}", id, k_contact_model, "xyz"[axis], position);
}

std::string placeholder(const std::string& id) {
    return fmt::format("fix {} all nve/noforce", id);
}

}  // namespace cutterflow::liggghts::commands
