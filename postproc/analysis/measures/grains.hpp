#pragma once
/// \file Grains at one time, in regions of space.
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/base/region.hpp"

namespace cutterflow::postproc {

/// Arrays of equal length. A grain that is no sphere has the diameter of the sphere of its volume.
struct Grains {
    std::vector<Vec3> position, velocity;   ///< [m], [m/s]
    std::vector<double> diameter, density;  ///< [m], [kg/m3]
    std::size_t size() const { return position.size(); }
    void add(const Vec3& place, const Vec3& speed, double size, double mass_density);
};

/// \pre the value passes check_measures
Region region_of(const nlohmann::json& value);

/// [m3]; infinite for a half space and everywhere.
double volume_of(const Region& region);

/// The grains whose centres lie in a region.
Grains grains_in(const Grains& grains, const Region& region);

/// Mean diameter by number [m]; 0 without grains.
double mean_diameter(const Grains& grains);

/// Sum of density times pi/6 d^3 [kg].
double mass_of(const Grains& grains);

/// Lowest and highest coordinates of the spheres' surfaces. \pre there are grains
std::pair<Vec3, Vec3> bounds_of(const Grains& grains);

/// Places that share the volume of the sphere of radius 1 equally: the points of a cubic lattice in it.
const std::vector<Vec3>& unit_sphere_points();

/// Volume of grains over the volume of a region; a grain at its border counts with the share of its points that lies inside.
/// \pre the region's volume is finite
double solid_share(const Grains& grains, const Region& region);

}  // namespace cutterflow::postproc
