#pragma once
/// \file What the mesh of a study will be, computed before anything is run: cell sizes, the rotor zone and its clearances, the blocks of
/// the background mesh, and the cost of the run on it.
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/axial_cylinder.hpp"
#include "geometry/base/error.hpp"
#include "geometry/head/stationary_steel.hpp"
#include "geometry/surface/surface.hpp"

namespace cutterflow::meshing {

/// Fineness of a mesh, relative to the ring radius R so that it serves heads of any size.
struct MeshResolution {
    std::string preset;          ///< name, for messages and reports
    double cell_size = 0.0;      ///< of the background at the head, over R; the cutter gets half of it
    double axial_stretch = 0.0;  ///< height over width of background cells along the head, 1 or a little more: blades are steep
    double stator_growth = 0.0;  ///< growth from cell to cell away from the head, above 1
};

/// \throws UserError  for a name that is none of mesh_preset_names()
MeshResolution mesh_preset(const std::string& name);

/// Names of all presets, from coarse to fine.
std::vector<std::string> mesh_preset_names();

/// Sizes of the cutter that determine the mesh, in the run's frame.
struct CutterExtent {
    double radius = 0.0;  ///< largest distance from the axis [m]
    double z_min = 0.0;   ///< lowest point [m]
    double z_max = 0.0;   ///< highest point [m]; 0 for a head that ends in its ring plane
    double area = 0.0;    ///< of the surface [m2]
    double volume = 0.0;  ///< of the steel [m3]
    /// Diameter of the largest sphere that passes between the blades [m] (passage_between_blades); none: not computed.
    std::optional<double> passage{};
    std::optional<double> thickness{};  ///< of the thinnest steel [m] (smallest_thickness); none: not computed
};

/// All but passage and thickness. \pre the surface is closed, outward oriented and in the run's frame
CutterExtent extent_of_cutter(const geometry::TriangleSurface& cutter);

struct MeshInput {
    double ring_radius = 0.0;  ///< [m]
    CutterExtent cutter;
    geometry::StationarySteelParameters steel;  ///< backplate, mouth and pipe
    AxialCylinder tank;
    MeshResolution resolution;
    double rotation_speed = 0.0;  ///< [rad/s], either sign; for the prediction of the time step
    double discharge = 0.0;       ///< [m3/s], likewise
    double max_courant = 0.0;     ///< [-], likewise
};

/// A stack of cells along the axis or the radius.
struct CellRow {
    double from = 0.0, to = 0.0;  ///< [m]
    int cells = 0;
    double expansion = 1.0;  ///< last cell over first cell
};

/// Geometric row of cells that starts with a cell of about `first` and grows by at most `growth` from cell to cell.
/// \pre from < to, first > 0, growth > 1
CellRow growing_row(double from, double to, double first, double growth);

/// Size of the first cell of a row [m].
double first_cell(const CellRow& row);

/// The rotor zone: a cylinder about the axis, meshed as a prism of `facets` sides.
struct RotorZone {
    double radius = 0.0;
    double z_bottom = 0.0;
    double z_top = 0.0;
    int facets = 0;
    double volume() const;       ///< of the prism, steel included [m3]
    double facet_angle() const;  ///< azimuth of one facet [rad]
};

/// Distances from the interface to the steel [m] and the cells that lie in them (cutter: after refinement at the steel).
struct Clearance {
    double distance = 0.0;
    double cells = 0.0;
};

/// Expected figures; the actual ones are in MeshReport.
struct MeshPrediction {
    double cells = 0.0;
    double cell_size_min = 0.0;              ///< cube root of the smallest cell's volume, roughly [m]
    double time_step = 0.0;                  ///< by the Courant number of the flow [s]
    double core_hours_per_revolution = 0.0;  ///< of the flow alone
    double mesh_memory = 0.0;                ///< most that a program of the mesh stage takes [bytes]
    double run_memory = 0.0;                 ///< of the solver on one rank [bytes]
};

/// The plan. The background mesh in a section normal to the axis, from inside out: a square core with bulged sides, a transition, an
/// annulus of cells of equal size that holds the head's outer surface and ends at the interface, and beyond it the stator's annulus up to
/// the tank's wall. Every ring has `rotor.facets` cells in azimuth.
struct MeshPlan {
    MeshInput input;
    double cell_size = 0.0;  ///< [m] background at the head
    RotorZone rotor;
    double core_radius = 0.0;       ///< of the core's corners [m]
    double core_side_radius = 0.0;  ///< of the middle of its sides [m]
    int transition_cells = 0;
    CellRow annulus;             ///< up to the interface
    CellRow outer;               ///< from the interface to the tank's wall
    std::vector<CellRow> below;  ///< stator, from the tank's bottom to the zone
    std::vector<CellRow> zone;   ///< rotor and the stator around it
    std::vector<CellRow> above;  ///< stator, from the zone to the tank's top; the first row ends at the backplate's face
    Clearance to_ring, to_hub, to_cutter_top, to_backplate;
    MeshPrediction prediction;

    int core_cells() const { return rotor.facets / 4; }  ///< along a side of the core
    std::size_t cells_per_disc() const;                  ///< inside the interface's radius, in one layer
    std::size_t background_rotor_cells() const;
    std::size_t background_cells() const;
    std::size_t interface_faces() const;  ///< on one side
};

/// Computes the plan.
/// \throws UserError  with every reason why the zone, the gap, the tank, the mouth or the passages between the blades cannot be meshed;
/// what
///                    is too small for the preset names the preset that would resolve it
/// \throws std::invalid_argument  when a size that must be positive is not
MeshPlan plan_mesh(const MeshInput& input);

/// What the mesh will resolve poorly, with the preset that would resolve it: steel thinner than a cell of the
/// cutter's (effect: docs/design/003-meshing.md).
std::vector<Mistake> mesh_warnings(const MeshInput& input);

}  // namespace cutterflow::meshing
