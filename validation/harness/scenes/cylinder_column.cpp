#include "validation/harness/scenes/cylinder_column.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace cutterflow::validation {

coupling::Rocks column_rocks(const CylinderColumn& column) {
    std::mt19937 random(column.seed);
    std::uniform_real_distribution<double> shift(-column.jitter, column.jitter);
    const double spacing = k_cylinder_diameter + column.gap, first = 0.5 * k_cylinder_diameter + column.gap;
    coupling::Rocks rocks;
    for (int layer = 0; layer < column.layers; ++layer) {
        const bool wide = layer % 2 == 0;
        for (int n = 0; n < (wide ? 6 : 5); ++n) {
            const double x = first + (n + (wide ? 0.0 : 0.5)) * spacing, z = first + layer * std::sqrt(0.75) * spacing;
            const Vec3 place{x + shift(random), 0.5 * k_cylinder_length, z + shift(random)};
            const int id = static_cast<int>(rocks.size()) + 1;
            rocks.append({id, place, Vec3::Zero(), Vec3::Zero(), k_cylinder_diameter, k_cylinder_density});
        }
    }
    return rocks;
}

coupling::DemSettings column_dem(const CylinderColumn& column) {
    coupling::DemSettings settings;
    settings.law = coupling::ContactLaw::linear;
    settings.linear.accumulated_shear = column.accumulated_shear;
    settings.contact.set_every_pair({column.friction, settings.contact.rock_rock.restitution, 0.0});
    settings.contact.rock_steel.friction = column.wall_friction.value_or(column.friction);
    settings.contact.wet_restitution = false;
    settings.shape = coupling::RockShape::cylinder;
    settings.cylinder_length = k_cylinder_length;
    settings.contact_gap = column.gap;
    const double inset = 0.5 * column.gap;  // bodies are larger by half a gap: with it they stand off walls by a whole one
    settings.domain.lower = Vec3(inset, 0, inset);
    settings.domain.upper = Vec3(column.tank_width - inset, k_cylinder_length, k_column_tank_height);
    for (const auto side :
         {coupling::DomainSide::x_min, coupling::DomainSide::x_max, coupling::DomainSide::z_min, coupling::DomainSide::z_max})
        settings.domain.make_wall(side);
    settings.fluid = {0.0, 0.0};
    settings.added_mass = 0.0;
    settings.gravity = Vec3(0, 0, -9.81);
    return settings;
}

std::unique_ptr<liggghts::LiggghtsEngine> column_engine(const CylinderColumn& column, std::vector<coupling::WallSettings> walls) {
    coupling::DemSettings settings = column_dem(column);
    settings.walls = std::move(walls);
    auto engine = std::make_unique<liggghts::LiggghtsEngine>(settings, std::vector<coupling::ZoneMotion>{}, MPI_COMM_WORLD);
    const coupling::Rocks rocks = column_rocks(column);
    if (engine->insert(rocks).size() != rocks.size()) throw std::runtime_error("the DEM did not take all cylinders");
    return engine;
}

Vec3 mean_place(const coupling::Rocks& rocks) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& place : rocks.position) sum += place;
    return sum / static_cast<double>(rocks.size());
}

bool has_arrived(const coupling::Rocks& rocks, const CylinderColumn& column) {
    const double reach = column.tank_width - 0.5 * k_cylinder_diameter - column.gap;
    return std::any_of(rocks.position.begin(), rocks.position.end(), [&](const Vec3& place) { return place.x() >= reach; });
}

}  // namespace cutterflow::validation
