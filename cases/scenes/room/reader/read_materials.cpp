/// \file Tables [[material]] and [[contact]].
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"

namespace cutterflow::cases {

namespace {

const ParameterValues* find_material(const RoomReading& room, const std::string& name) {
    for (const ParameterValues& material : room.values.tables("material"))
        if (material.text("material.name") == name) return &material;
    return nullptr;
}

/// Materials that grains can touch, in the order of their first use; the grains' own first.
std::vector<std::string> touched_materials(const RoomReading& room) {
    std::vector<std::string> names{room.scene.grain_material};
    const auto add = [&](const std::string& name) {
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    for (const ParameterValues& solid : room.values.tables("solid")) add(solid.text("solid.material"));
    if (std::any_of(room.scene.sides.begin(), room.scene.sides.end(), [](SideForGrains side) { return side != SideForGrains::open; }))
        add(room.scene.side_material);
    return names;
}

/// One that nothing is of would set Poisson's ratio of the others.
void refuse_unused(RoomReading& room, const std::vector<std::string>& touched) {
    for (const ParameterValues& material : room.values.tables("material")) {
        const std::string& name = material.text("material.name");
        if (std::find(touched.begin(), touched.end(), name) != touched.end()) continue;
        const std::string nearest = nearest_word(name, touched);
        room.refuse(material.where("material.name"), fmt::format("material.name = \"{}\"", name),
                    fmt::format("Grains are of {}, and touch {}", room.scene.grain_material, fmt::join(touched, ", ")),
                    nearest.empty() ? "Remove the table" : fmt::format("Did you mean {}?", nearest));
    }
}

}  // namespace

void read_materials(RoomReading& room) {
    std::set<std::string> names;
    for (const ParameterValues& material : room.values.tables("material"))
        if (!names.insert(material.text("material.name")).second)
            room.refuse(material.where("material.name"),
                        fmt::format("material.name = \"{}\" is given twice", material.text("material.name")),
                        "Every material has one table", "Remove one of them");
    room.scene.contact.rolling_law = room.values.text("dem.rolling_law");
    room.scene.contact.time_step_fraction = room.values.number("dem.time_step_fraction");
    room.scene.contact.wet_restitution = room.scene.medium.name == "water";
    room.scene.bed_max_speed = room.values.has("dem.max_speed_m_s")
                                   ? room.values.number("dem.max_speed_m_s")
                                   : std::max(0.1, std::sqrt(2.0 * room.scene.gravity_strength * room.scene.size.z()));
    room.scene.contact.max_speed = room.scene.bed_max_speed;
}

void read_elasticity(RoomReading& room, const std::string& where) {
    const ParameterValues* material = find_material(room, room.scene.grain_material);
    if (material == nullptr || !material->has("material.youngs_modulus_pa"))
        return room.refuse(material == nullptr ? where : material->where("material.name"),
                           fmt::format("Young's modulus of {}, the grains' material, is missing", room.scene.grain_material),
                           "The step of the contacts follows from it",
                           fmt::format("Write [[material]] with name = \"{}\" and youngs_modulus_pa", room.scene.grain_material));
    room.scene.contact.youngs_modulus = material->number("material.youngs_modulus_pa");
    room.scene.contact.poisson_rock = room.scene.contact.poisson_steel = material->number("material.poisson");
    bool found_other = false;
    for (const ParameterValues& other : room.values.tables("material")) {
        if (&other == material) continue;
        if (other.has("material.youngs_modulus_pa") && other.number("material.youngs_modulus_pa") != room.scene.contact.youngs_modulus)
            room.refuse(
                other.where("material.youngs_modulus_pa"),
                fmt::format("material.youngs_modulus_pa = {:g} of {}", other.number("material.youngs_modulus_pa"),
                            other.text("material.name")),
                fmt::format("All materials of a room have the Young's modulus of the grains, {:g} Pa", room.scene.contact.youngs_modulus),
                "Leave it out");
        const double poisson = other.number("material.poisson");
        if (found_other && poisson != room.scene.contact.poisson_steel)
            room.refuse(place_of(other, "material.poisson", "material.name"),
                        fmt::format("material.poisson = {:g} of {}", poisson, other.text("material.name")),
                        fmt::format("All materials besides the grains' have one Poisson's ratio, {:g}", room.scene.contact.poisson_steel),
                        "Make them equal");
        room.scene.contact.poisson_steel = poisson;
        found_other = true;
    }
}

void read_pairs(RoomReading& room) {
    if (room.scene.grains.empty()) return;
    const std::vector<std::string> touched = touched_materials(room);
    refuse_unused(room, touched);
    std::set<std::string> done;
    for (const ParameterValues& contact : room.values.tables("contact")) {
        const std::vector<std::string>& pair = contact.texts("contact.pair");
        const std::string where = contact.where("contact.pair");
        const std::string text = fmt::format("contact.pair = [\"{}\", \"{}\"]", pair[0], pair[1]);
        if (pair[0] != room.scene.grain_material && pair[1] != room.scene.grain_material) {
            room.refuse(where, text, fmt::format("One of the two is the grains' material, {}", room.scene.grain_material),
                        "Correct it or remove the table");
            continue;
        }
        const std::string& other = pair[0] == room.scene.grain_material ? pair[1] : pair[0];
        if (std::find(touched.begin(), touched.end(), other) == touched.end()) {
            const std::string nearest = nearest_word(other, touched);
            room.refuse(where, text, fmt::format("Grains touch {}", fmt::join(touched, ", ")),
                        nearest.empty() ? "Remove the table" : fmt::format("Did you mean {}?", nearest));
            continue;
        }
        if (!done.insert(other).second) {
            room.refuse(where, text + " is given twice", "Every pair has one table", "Remove one of them");
            continue;
        }
        room.scene.pairs.push_back(
            {other, {contact.number("contact.friction"), contact.number("contact.restitution"), contact.number("contact.rolling")}});
    }
    for (const std::string& other : touched)
        if (done.count(other) == 0)
            room.refuse(room.values.tables("grains").front().where("grains.material"),
                        fmt::format("[[contact]] of {} and {} is missing", room.scene.grain_material, other),
                        "Every material that grains touch has a pair with theirs",
                        fmt::format("Write [[contact]] with pair = [\"{}\", \"{}\"], friction, rolling, restitution",
                                    room.scene.grain_material, other));
}

}  // namespace cutterflow::cases
