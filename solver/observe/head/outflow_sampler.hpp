#pragma once
/// \file Radial velocity of the fluid just outside the head's contour, averaged over azimuth in the axial bins.
#include <vector>

#include "geometry/head/axial_bins.hpp"
#include "geometry/head/contour.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::coupling {

/// Sampling points of every bin: circles of 72 azimuths at four heights, `offset` outside the contour along its normal in the meridional
/// plane. `gap` is sampled outside the ring's cylinder, `below_hub` under the contour's lower end on four rings of equal area.
class OutflowSampler {
public:
    OutflowSampler(const geometry::Contour& contour, const std::vector<geometry::AxialBin>& bins, double offset);

    const std::vector<Vec3>& points() const { return points_; }
    std::size_t bins() const { return bins_; }

    /// Mean radial velocity [m/s] per bin, outward positive. Collective.
    std::vector<double> sample(FluidEngine& fluid) const;

private:
    void add_circle(double radius, double z);

    std::size_t bins_;
    std::vector<Vec3> points_;   // bin by bin, the same number for each
    std::vector<Vec3> outward_;  // unit vector at each point
};

}  // namespace cutterflow::coupling
