#pragma once
/// \file Open areas and volumes of the grid's cells, and how moving bodies push water: the incidence of body motion on cells.
#include <Eigen/Geometry>

#include "solver/free_surface/cell_lists.hpp"
#include "solver/free_surface/cut_cells/slip_walls.hpp"
#include "solver/free_surface/cut_cells/still_solids.hpp"

namespace cutterflow::free_surface {

/// A round body that moves: a cylinder across the tank, or a sphere.
struct Body {
    Vec3 position = Vec3::Zero();  ///< of its centre [m]
    Vec3 velocity = Vec3::Zero();  ///< [m/s]
    Vec3 spin = Vec3::Zero();      ///< [rad/s]
    double radius = 0.0;           ///< [m]
    double mass = 0.0;             ///< [kg]
    double inertia = 0.0;          ///< about its centre [kg m2]
    bool sphere = false;
    bool held = false;  ///< moves on a given path; pressure does not move it
};

/// Velocity [m/s] of the body's material at a place [m].
inline Vec3 velocity_at(const Body& body, const Vec3& place) {
    return body.velocity + body.spin.cross(place - body.position);
}

/// Share of one cell in a body's flux: k = sum over faces of s A^b n over the face area of the grid. k . V times the face area is the
/// volume flow [m3/s] that the body's motion takes out of the cell. Its spin takes none: a round body turns within its own outline.
struct BodyCell {
    int cell = 0;
    Vec3 k = Vec3::Zero();
};

inline constexpr int k_no_body = -1;
inline constexpr int k_first_gate = -2;  ///< gate n owns its faces as k_first_gate - n

struct CutCells {
    FaceField open;                                  ///< open share of each face, 0 on the tank's walls and beyond
    CellField open_volume;                           ///< open share of each cell; ghosts repeat the cell next to them
    CellField room;                                  ///< share of a cell's kernel that solids leave: what water at rest fills
    std::vector<std::uint8_t> closed;                ///< 1 for cells without open volume or face, and for ghosts
    std::vector<int> cut;                            ///< cells that solids cover in part or in whole
    std::array<std::vector<std::int16_t>, 3> owner;  ///< body that covers most of a face, or a gate; k_no_body: none or what stands still
    std::vector<std::vector<BodyCell>> bodies;       ///< of each body
    std::vector<std::vector<BodyCell>> gates;        ///< the same of each gate
    CellLists covering;                              ///< bodies that cover a part of each cell
};

/// Smaller remainders of a face's open share are given to the solid: from round-off they would become jets.
inline constexpr double k_smallest_open_share = 1e-4;
/// What opens under a gate counts from this share of a cell's height on: it draws in what the gate leaves through the opening alone, at a
/// speed that grows without bound as the opening closes.
inline constexpr double k_smallest_gate_opening = 0.25;

/// What stands still is covered once, by the lengths of lines in the faces; gates are put in when they have moved, exactly, bodies at their
/// places in every step. Several solids
/// may share a cell. A body's part A^b of a face is its mean over the cell-wide box around the face (at the tank's walls reaching to the
/// wall), so that the parts of a direction add up to the body's volume: a body in still water has exactly its buoyancy. The areas in the
/// faces themselves are a trapezoidal rule for the volume, 0.3 % off at 20 cells a diameter, and their errors are twice these at a light
/// body.
class CellCutter {
public:
    CellCutter(const StaggeredGrid& grid, const std::vector<StillSolid>& solids);

    /// Cells without bodies; gates are in their places.
    const CutCells& still() const { return still_; }
    const SlipWalls& slip_walls() const { return slip_walls_; }
    /// \param cells  is written over; the sum of k over the cells of a body away from the tank's walls is 0 (a closed body)
    void cut(gsl::span<const Body> bodies, CutCells& cells);
    /// Puts gates at new places. They overlap nothing that stands still.
    void set_gates(gsl::span<const SolidBox> gates);

private:
    void cover_still_faces(const std::vector<StillSolid>& solids);
    void cover_still_volumes(const std::vector<StillSolid>& solids);
    void cover_by_gate(int index, const SolidBox& box);
    void find_flux_of_gate(int index, const SolidBox& box);
    void close_around_closed_cells();
    void find_slip_walls();
    void add_body(int index, const Body& body, CutCells& cells);
    void cover_faces(int index, const Body& body, int direction, CutCells& cells);
    void cover_volumes(int index, const Body& body, CutCells& cells) const;
    void cover_still_room(const std::vector<StillSolid>& solids, int cell, const Vec3& from);
    void cover_room(const Body& body, int cell, const Vec3& from, double covered, CutCells& cells) const;
    bool has_open_face(const CutCells& cells, int cell) const;
    void hand_on_flux_of_closed_cells(const CutCells& cells, std::vector<BodyCell>& list) const;
    void add_to_cell(std::vector<BodyCell>& list, int cell, int direction, double flux);

    const StaggeredGrid& grid_;
    CutCells fixed_;  // without gates
    CutCells still_;
    SlipWalls slip_walls_;
    std::vector<int> entry_;  // of a cell in the list of the body at hand, -1: none
};

/// Volume [m3] that a body covers of the box between two corners.
double covered_volume(const Body& body, const Vec3& from, const Vec3& to);

}  // namespace cutterflow::free_surface
