#pragma once
/// \file The hollow that suction leaves in a bed.
#include <optional>
#include <utility>
#include <vector>

#include "postproc/analysis/measures/envelope.hpp"

namespace cutterflow::postproc {

inline constexpr int k_chords = 8;                ///< over half a turn
inline constexpr double k_floor_diameters = 2.0;  ///< of the circle whose mean height is a floor: a gap between grains is none

struct Cavity {
    HeightMap surface;                                                ///< median over one mean diameter [m]
    double level = 0.0;                                               ///< below it a place belongs to the cavity [m]
    double depth = 0.0;                                               ///< undisturbed level less the lowest floor of the area [m]
    double area = 0.0;                                                ///< the largest connected one below `level` [m2]
    double diameter = 0.0;                                            ///< of the circle of that area [m]
    double volume = 0.0;                                              ///< between the undisturbed level and the surface over that area [m3]
    bool at_border = false;                                           ///< the area reaches the border of the map
    std::vector<double> outline_x, outline_y;                         ///< middles of the area's cells at its rim [m]
    Eigen::Vector2d centre{0.0, 0.0};                                 ///< of the area [m]
    std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> chords;  ///< through the centre, in k_chords directions; ends [m]
    double chord_mean = 0.0, chord_spread = 0.0;                      ///< [m]
};

/// Mean height of a bed's surface: of the median of its height map [m].
double surface_level(const Grains& grains, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double cell);

/// Whether a corner of the extent has no grains, in the median of the height map: a bed that is not rectangular leaves its corners free.
bool has_bare_corner(const Grains& grains, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double cell);

/// Height map of the grains with cells of `cell`, its median over one mean diameter, and the largest area that lies half a mean diameter
/// and more below `undisturbed`. Floor without grains has height 0. \param lower, upper  horizontal extent of the map \return nothing when
/// no place lies so low
std::optional<Cavity> cavity_of(const Grains& grains, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double undisturbed,
                                double cell);

}  // namespace cutterflow::postproc
