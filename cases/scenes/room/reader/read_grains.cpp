/// \file Tables [[grains]].
#include <fmt/format.h>

#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"
#include "cases/study/shape_file.hpp"

namespace cutterflow::cases {

namespace {

bool read_sizes(RoomReading& room, const ParameterValues& values, RoomGrains& grains) {
    const bool one = values.has("grains.diameter_m"), uniform = values.has("grains.diameter_m.uniform_by_number");
    const auto& classes = values.tables("grains.class");
    const std::string where = values.where("grains.name");
    if (one + uniform + !classes.empty() != 1) {
        room.refuse(
            where,
            fmt::format("the grains {} have {} diameter", grains.name, one + uniform + !classes.empty() == 0 ? "no" : "more than one"),
            "Give diameter_m, diameter_m = { uniform_by_number = [a, b] }, or [[grains.class]]", "Correct it");
        return false;
    }
    if (one) grains.sizes = std::vector<GrainClass>{{values.number("grains.diameter_m"), 1.0, grains.density}};
    if (uniform) {
        const std::vector<double>& range = values.numbers("grains.diameter_m.uniform_by_number");
        if (range[0] >= range[1]) {
            room.refuse(values.where("grains.diameter_m.uniform_by_number"),
                        fmt::format("uniform_by_number = [{:g}, {:g}]", range[0], range[1]), "The smaller diameter comes first",
                        "Exchange them");
            return false;
        }
        grains.sizes = UniformByNumber{range[0], range[1]};
    }
    if (classes.empty()) return true;
    double sum = 0.0;
    for (const ParameterValues& one_class : classes) sum += one_class.number("grains.class.mass_share");
    std::vector<GrainClass> made;
    for (const ParameterValues& one_class : classes)
        made.push_back({one_class.number("grains.class.diameter_m"), one_class.number("grains.class.mass_share") / sum,
                        number_or(one_class, "grains.class.density_kg_m3", grains.density)});
    grains.sizes = made;
    return true;
}

/// The DEM leaves clumps that reach farther waiting for ever. \pre sizes are read
void require_short_clumps(RoomReading& room, const ParameterValues& values, const RoomGrains& grains) {
    if (!grains.shape) return;
    const double reach = 0.5 * grains.girth() * grains.largest();
    const double longest = coupling::k_largest_reach * 0.5 * room.scene.size.head<2>().maxCoeff();
    if (reach <= longest - room.scene.tolerance()) return;
    room.refuse(values.where("grains.shape"),
                fmt::format("clumps {} of up to {:.4g} m reach {:.4g} m from their centre of mass", grains.name, grains.largest(), reach),
                fmt::format("They reach less than an eighth of the room's larger horizontal side, {:.4g} m", longest),
                "Give smaller grains, a rounder shape or a wider room");
}

void read_grains(RoomReading& room, const ParameterValues& values) {
    RoomGrains grains;
    grains.name = values.text("grains.name");
    const std::string where = values.where("grains.name");
    if (room.scene.find_grains(grains.name) != nullptr)
        room.refuse(where, fmt::format("grains.name = \"{}\" is given twice", grains.name), "Every kind of grains has a name of its own",
                    "Change one");
    grains.density = values.number("grains.density_kg_m3");
    const std::string material = values.text("grains.material");
    room.require_name(material, "grains.material", values.where("grains.material"));
    if (room.scene.grain_material.empty()) {
        room.scene.grain_material = material;
        read_elasticity(room, values.where("grains.material"));
    } else if (material != room.scene.grain_material) {
        room.refuse(values.where("grains.material"), fmt::format("grains.material = \"{}\"", material),
                    fmt::format("All grains of a room have one material, here {}", room.scene.grain_material), "Use it for all");
    }
    if (values.has("grains.shape"))
        room.mistakes.gather([&] {
            ShapeFile shape = read_shape_file(values, "grains.shape", grains.name, room.folder);
            grains.shape = std::move(shape.clump);
            grains.clump = std::move(shape.file);
            grains.clump_text = std::move(shape.text);
        });
    if (!read_sizes(room, values, grains)) return;
    require_short_clumps(room, values, grains);
    room.scene.grains.push_back(std::move(grains));
}

}  // namespace

void read_all_grains(RoomReading& room) {
    for (const ParameterValues& grains : room.values.tables("grains")) read_grains(room, grains);
}

}  // namespace cutterflow::cases
