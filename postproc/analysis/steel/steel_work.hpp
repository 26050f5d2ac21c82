#pragma once
/// \file What rock does to the steel that it hits and slides along: energy over time, per rock and by place. It is no loss of material and
/// no load on a pick.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/head/axial_bins.hpp"
#include "postproc/draw/triangle_surface.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {

struct Results;

/// Work of rock on steel: of rock that comes closer, against the normal force, and of friction. solver/liggghts/contacts has the equations.
struct SteelEnergy {
    double impact = 0.0;   ///< [J], or [J/m2] over an area
    double sliding = 0.0;  ///< likewise
};

/// Of one wall in the window.
struct EnergyOfWall {
    std::string wall;
    SteelEnergy energy;
};

/// Of the cutter's steel beside one axial bin, in all the time of the map.
struct EnergyOfBin {
    geometry::AxialBin bin;  ///< `gap` is above the ring plane
    double area = 0.0;       ///< of steel [m2]
    SteelEnergy energy;      ///< [J]
};

/// A wall's triangles and the work on each.
struct WorkedSurface {
    TriangleSurface triangles;
    std::vector<SteelEnergy> per_area;  ///< of each triangle [J/m2]
};

struct SteelWork {
    double since = 0.0;                   ///< from then on the work was counted [s]
    double from = 0.0, to = 0.0;          ///< window of rates and shares per kg: that of the production, or of all rock of a batch [s]
    double fed = 0.0, delivered = 0.0;    ///< in the window [kg]
    std::vector<EnergyOfWall> walls;      ///< in the window; the cutter first
    std::vector<EnergyOfBin> bins;        ///< of the cutter
    double map_from = 0.0, map_to = 0.0;  ///< time that the map of the cutter holds: with rock [s]
    std::optional<SteelEnergy> highest;   ///< that 1 % of the cutter's area exceeds [J/m2]
    std::optional<WorkedSurface> cutter;  ///< the map; none when its file is gone
    SteelEnergy total() const;            ///< of all walls in the window [J]
    double duration() const { return to - from; }              ///< [s]
    double map_duration() const { return map_to - map_from; }  ///< [s]
};

/// A wall's surface with its work, as the solver writes it. \throws UserError  when it is damaged
WorkedSurface read_worked_surface(const std::filesystem::path& file);

/// \param results  with the rock and, of a fed head, its production
/// \return nothing when the run counted no work (one without rock, or of an earlier program), or no time of the window has any
std::optional<SteelWork> steel_work_of(const Results& results, const RunData& run);

/// `steel_work` of results.json.
nlohmann::json steel_work_json(const std::optional<SteelWork>& work);

}  // namespace cutterflow::postproc
