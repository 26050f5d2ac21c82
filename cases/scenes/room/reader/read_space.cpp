/// \file Table [room] and what the medium needs: space, gravity, mesh, coupling.
#include <fmt/format.h>

#include "cases/scenes/room/reader/room_readers.hpp"
#include "cases/scenes/room/reader/room_reading.hpp"
#include "cases/scenes/room/vec3_of.hpp"
#include "cases/study/closure_rules.hpp"
#include "cases/study/study_section.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_water_density = 1000.0, k_water_viscosity = 1e-6;
constexpr double k_air_density = 1.2, k_air_viscosity = 1.5e-5;

/// Cubes belong to map cluster, and hold a cell or more.
void check_map(RoomReading& room) {
    const double side = room.scene.kernel.cluster_size;
    const bool clusters = room.scene.kernel.map == coupling::k_cluster_map;
    const std::string where = room.values.where(side > 0.0 ? "kernel.cluster_size_m" : "kernel.map");
    if (!clusters && side > 0.0)
        room.refuse(where, fmt::format("kernel.cluster_size_m = {:g} with kernel.map = \"{}\"", side, room.scene.kernel.map),
                    "Only map cluster has cubes", "Remove it, or set kernel.map = \"cluster\"");
    else if (clusters && side < room.scene.cell)
        room.refuse(where, fmt::format("kernel.cluster_size_m = {:g}", side),
                    fmt::format("A cube of map cluster holds a cell of {:g} m or more", room.scene.cell), "Give a cell or more");
}

/// Keys of closures and kernel count with a medium only. A study that is written out in full has their defaults.
void refuse_coupling_keys(RoomReading& room) {
    ParameterTable rows = k_closure_section.rows();
    for (const Parameter& row : k_kernel_section.rows()) rows.push_back(row);
    for (const Parameter& row : rows)
        if (*room.values.find(row.key) != row.default_value)
            room.refuse_keys(room.values, {row.key.c_str()}, "Without a medium nothing drags grains (room.medium = \"none\")");
}

}  // namespace

void read_space(RoomReading& room) {
    room.scene.size = vec3_of(room.values, "room.size_m");
    room.scene.gravity_strength = room.values.number("room.gravity_m_s2");
    room.scene.tilt = room.values.number("room.tilt_deg") * k_pi / 180.0;
    room.scene.medium.name = room.values.text("room.medium");
    room.scene.side_material = room.values.text("room.material");
    room.require_material(room.scene.side_material, "room.material", place_of(room.values, "room.material", "room.size_m"));
    room.scene.sides.fill(SideForGrains::wall);
    room.scene.sides[static_cast<std::size_t>(coupling::DomainSide::z_max)] = SideForGrains::open;
    if (!room.scene.medium.present()) {
        room.refuse_keys(room.values, {"room.density_kg_m3", "room.kinematic_viscosity_m2_s", "room.turbulence", "room.cell_m"},
                         "Without a medium there are neither flow nor mesh (room.medium = \"none\")");
        for (const ParameterValues& refine : room.values.tables("room.refine"))
            room.refuse_keys(refine, {"room.refine.cell_m"}, "Without a medium there is no mesh (room.medium = \"none\")");
        refuse_coupling_keys(room);
        return;
    }
    const bool water = room.scene.medium.name == "water";
    room.scene.medium.density = number_or(room.values, "room.density_kg_m3", water ? k_water_density : k_air_density);
    room.scene.medium.kinematic_viscosity =
        number_or(room.values, "room.kinematic_viscosity_m2_s", water ? k_water_viscosity : k_air_viscosity);
    room.scene.kernel = k_kernel_section.read(room.values);
    room.scene.closures = k_closure_section.read(room.values);
    room.mistakes.add(closure_mistakes(room.values));
    room.scene.medium.turbulence = room.values.has("room.turbulence") ? room.values.text("room.turbulence") : "realizableKE";
    if (const auto cell = room.required(room.values, "room.cell_m", "a room with " + room.scene.medium.name, "room.size_m"))
        room.scene.cell = *cell;
    check_map(room);
    for (const ParameterValues& refine : room.values.tables("room.refine")) {
        const std::string where = refine.where("room.refine.cell_m");
        const double cell = refine.number("room.refine.cell_m");
        if (cell >= room.scene.cell && room.scene.cell > 0.0)
            room.refuse(where, fmt::format("room.refine.cell_m = {:g}", cell),
                        fmt::format("It must be below room.cell_m = {:g}", room.scene.cell), "Correct one of them");
        const std::optional<Region> region = room.read_region(refine, "room.refine", where);
        if (!region) continue;
        if (!std::holds_alternative<BoxRegion>(*region) && !std::holds_alternative<CylinderRegion>(*region))
            room.refuse(where, "a refined part that is neither box nor cylinder", "The mesh is refined in boxes and cylinders",
                        "Use one of them");
        else
            room.scene.refinements.push_back({*region, cell});
    }
}

}  // namespace cutterflow::cases
