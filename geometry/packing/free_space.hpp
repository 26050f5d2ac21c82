#pragma once
/// \file The room that solids leave in a region.
#include <vector>

#include "geometry/base/region.hpp"
#include "geometry/cgal/solid_search.hpp"

namespace cutterflow::geometry {

/// Volume of a region that no solid takes, by its height: from 200 places in each of 50 layers, to about 1 % of the region's volume. Solids
/// that take less than 1 % of it count as none: faces of a round wall cut that much off a round region.
class FreeSpace {
public:
    /// \param region  a box or an upright cylinder, from below to above
    FreeSpace(const Region& region, const std::vector<SolidSearch>& solids);

    double volume() const { return volume_below(top_); }  ///< [m3]
    /// From the region's lower end up to a level [m3].
    double volume_below(double level) const;
    /// The level [m] below which there is so much room; the region's upper end when there is not. \param volume  0 or more [m3]
    double level_of(double volume) const;

private:
    struct Layer {
        double from = 0.0;   // its lower end [m]
        double area = 0.0;   // that no solid takes [m2]
        double below = 0.0;  // volume below it [m3]
    };
    std::vector<Layer> layers_;  // one when no solid takes anything
    double top_ = 0.0;           // [m]
};

}  // namespace cutterflow::geometry
