#include "geometry/clump/unit_clump.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::geometry {

double UnitClump::reach() const {
    double reach = 0.0;
    for (const Ball& ball : balls) reach = std::max(reach, ball.centre.norm() + ball.radius);
    return reach;
}

UnitClump unit_clump(const Clump& clump) {
    const MassProperties mass = union_mass_properties(clump);
    const double diameter = std::cbrt(6.0 * mass.volume / k_pi);
    UnitClump unit;
    for (const Ball& ball : clump.balls) unit.balls.push_back({(ball.centre - mass.centroid) / diameter, ball.radius / diameter});
    const PrincipalInertia principal = principal_inertia(mass);
    unit.moments = principal.moments / std::pow(diameter, 5);
    unit.axes = principal.axes;
    unit.sphericity = clump.sphericity;
    return unit;
}

}  // namespace cutterflow::geometry
