#pragma once
/// \file The mesh of a box with solids in it: cells, levels of refinement, and where its medium is.
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/base/error.hpp"
#include "geometry/base/vec3.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::meshing {

/// Patches of the box's sides; boundaries take faces of them away.
inline constexpr std::array<const char*, 6> k_room_sides{"x_min", "x_max", "y_min", "y_max", "bottom", "top"};

struct MeshBox {
    Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
};
struct MeshCylinder {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< ends of its axis
    double radius = 0.0;
};
using MeshPart = std::variant<MeshBox, MeshCylinder>;

/// Smaller cells in a part of the room.
struct RoomMeshRefinement {
    MeshPart part;
    double cell = 0.0;  ///< [m], at most
};

/// A solid that the medium feels; its patch, a wall, has its name.
struct RoomMeshSolid {
    std::string name;
    geometry::TriangleSurface surface;  ///< closed, outward; geometry/<name>.stl of the run directory holds the same
    double thinnest = 0.0;              ///< [m]; 0: not known
};

/// A patch of faces of the sides.
struct RoomMeshPatch {
    std::string name;
    bool wall = true;
    std::vector<std::size_t> sides;  ///< by k_room_sides
    std::optional<MeshPart> part;    ///< faces whose centres lie in it; none: the whole sides
};

struct RoomMeshInput {
    Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
    double cell = 0.0;  ///< edge of the background's cells, about [m]
    std::vector<RoomMeshRefinement> refinements;
    std::vector<RoomMeshSolid> solids;
    std::vector<RoomMeshPatch> patches;  ///< later ones cover earlier ones
};

struct RoomMeshPlan {
    RoomMeshInput input;
    std::array<int, 3> cells{};     ///< of the background, along x, y, z
    Vec3 cell_size = Vec3::Zero();  ///< its edges [m]
    std::vector<int> levels;        ///< of input.refinements: how often cells are halved
    Vec3 place = Vec3::Zero();      ///< in the medium, far from solids and sides, on no plane of the grid
    double medium_volume = 0.0;     ///< of the box less its solids [m3]
    double solid_volume = 0.0;      ///< [m3]
    double predicted_cells = 0.0;
    double predicted_core_s = 0.0;  ///< of the mesh stage

    /// Whether snappyHexMesh has anything to do.
    bool is_cut() const { return !input.solids.empty() || !input.refinements.empty(); }
    double background_cell() const { return cell_size.maxCoeff(); }
    /// Longest edge of the cells at a place, without what the mesher adds between levels [m].
    double cell_at(const Vec3& place) const;
    double smallest_cell() const;  ///< [m]
};

bool contains(const MeshPart& part, const Vec3& place);

/// \pre the box has a volume, cell > 0 \throws UserError  when the cells are too many, or solids leave no medium
RoomMeshPlan plan_room_mesh(const RoomMeshInput& input);

/// Cells that are coarser than the solid's thinnest part: it stays, with the thickness that the cells allow.
std::vector<Mistake> room_mesh_warnings(const RoomMeshPlan& plan);

}  // namespace cutterflow::meshing
