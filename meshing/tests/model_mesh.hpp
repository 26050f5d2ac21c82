#pragma once
/// \file The model cutter (ring radius 0.40 m) as input of the mesh tests.
#include "meshing/cutter/mesh_plan.hpp"

namespace cutterflow::meshing {

inline MeshInput model_mesh_input(const std::string& preset = "draft") {
    MeshInput input;
    input.ring_radius = 0.4;
    input.cutter = {0.4, -0.485, 0.0, 1.32, 0.0205};
    input.steel.plate_radius = 0.4;
    input.steel.gap = 0.03;
    input.steel.plate_thickness = 0.02;
    input.steel.mouth = {0.1, 0.22, 0.0};
    input.steel.pipe_wall = 0.01;
    input.steel.pipe_top = 0.5;
    input.tank = {2.5, -0.875, 0.435};
    input.resolution = mesh_preset(preset);
    input.rotation_speed = 6.283;
    input.discharge = 0.12;
    input.max_courant = 0.9;
    return input;
}

/// The same study with all lengths times `factor` and speeds by Froude's law.
inline MeshInput scaled(MeshInput input, double factor) {
    input.ring_radius *= factor;
    input.cutter.radius *= factor;
    input.cutter.z_min *= factor;
    input.cutter.z_max *= factor;
    input.cutter.area *= factor * factor;
    input.cutter.volume *= factor * factor * factor;
    input.steel.plate_radius *= factor;
    input.steel.gap *= factor;
    input.steel.plate_thickness *= factor;
    input.steel.mouth.radius *= factor;
    input.steel.mouth.offset *= factor;
    input.steel.pipe_wall *= factor;
    input.steel.pipe_top *= factor;
    input.tank.radius *= factor;
    input.tank.z_min *= factor;
    input.tank.z_max *= factor;
    return input;
}

}  // namespace cutterflow::meshing
