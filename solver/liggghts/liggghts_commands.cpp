#include "solver/liggghts/liggghts_commands.hpp"

#include <fmt/format.h>

#include "solver/liggghts/contacts/contact_registration.hpp"

namespace cutterflow::liggghts::commands {

std::vector<std::string> basics() {
    return {"units si",       "atom_style granular", "atom_modify map array sort 0 0",
            "boundary f f f", "newton off",          "communicate single vel yes"};
}

std::vector<std::string> create_box(const SimulationBox& box) {
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

std::string no_contacts_within(int type) {
    return fmt::format("neigh_modify exclude type {0} {0}", type);
}

std::string rock_property(const std::string& name, int columns) {
    std::string zeros;
    for (int k = 0; k < columns; ++k) zeros += " 0.0";
    return fmt::format("fix {0} all property/atom {0} vector yes no no{1}", name, zeros);
}

std::string plane_wall(const std::string& id, int axis, double position) {
    return fmt::format("fix {} all wall/gran {} primitive type 2 {}plane {:.17g}", id, k_contact_model, "xyz"[axis], position);
}

std::string placeholder(const std::string& id) {
    return fmt::format("fix {} all nve/noforce", id);
}

}  // namespace cutterflow::liggghts::commands
