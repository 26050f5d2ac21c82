#pragma once
/// \file Clumps in a checkpoint's JSON.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "solver/liggghts/rigid_bodies.hpp"
#include "solver/ports/clump_shape.hpp"

namespace cutterflow::liggghts {

/// { shapes: [{name, spheres: [x, y, z, radius, ...]}], bodies: [[id, shape, d, density, position, velocity, angular momentum, qw, qx, qy,
/// qz, frozen]] }; doubles come back bit by bit.
nlohmann::json clump_state(const std::vector<coupling::ClumpShape>& shapes, const RigidBodies& bodies);

/// \param written  of a checkpoint; an empty object when its run had no clumps \throws UserError  when its shapes are not `shapes`
void require_same_clumps(const std::vector<coupling::ClumpShape>& shapes, const nlohmann::json& written, const std::string& file);

/// \param shapes  their number; they are those of the checkpoint \throws UserError  when a body is damaged
void restore_bodies(const nlohmann::json& written, std::size_t shapes, RigidBodies& bodies);

}  // namespace cutterflow::liggghts
