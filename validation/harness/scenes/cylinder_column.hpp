#pragma once
/// \file Columns of cylinders in a plane tank, as [Zhang2009] and [Chen2019] let them collapse, dry and in water.
#include <memory>
#include <optional>

#include "solver/liggghts/liggghts_engine.hpp"

namespace cutterflow::validation {

/// Layers of six and five cylinders of 10 mm and 2,700 kg/m3 against the left wall of a tank 0.286 m wide and 0.26 m high, 99 mm across.
struct CylinderColumn {
    int layers = 6;
    double gap = 1e-3;    ///< between surfaces that touch, walls too [m]
    double jitter = 0.0;  ///< of the places [m]
    unsigned seed = 1;
    double friction = 0.3;
    std::optional<double> wall_friction;  ///< of cylinders on walls where it is not `friction`
    bool accumulated_shear = true;
    double tank_width = 0.286;
};

inline constexpr double k_cylinder_diameter = 0.01, k_cylinder_density = 2700.0, k_cylinder_length = 0.099;
inline constexpr double k_column_tank_height = 0.26;

/// Start places: neighbours a gap apart, the first ones a gap off floor and wall.
coupling::Rocks column_rocks(const CylinderColumn& column);

/// The linear law, cylinders, the tank's four walls; without fluid (the pressure holds buoyancy and added mass).
coupling::DemSettings column_dem(const CylinderColumn& column);

/// A DEM with the column in it. MPI must have been initialised. \param walls  beside the tank's own
std::unique_ptr<liggghts::LiggghtsEngine> column_engine(const CylinderColumn& column, std::vector<coupling::WallSettings> walls = {});

/// Mean of the centres [m].
Vec3 mean_place(const coupling::Rocks& rocks);

/// Whether a cylinder touches the right wall.
bool has_arrived(const coupling::Rocks& rocks, const CylinderColumn& column);

}  // namespace cutterflow::validation
