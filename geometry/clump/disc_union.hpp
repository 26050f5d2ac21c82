#pragma once
/// \file Area and moments of overlapping discs in a plane.
#include <vector>

#include <Eigen/Core>

namespace cutterflow::geometry {

struct Disc {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< [m]
    double radius = 0.0;                               ///< [m]
};

/// Integrals over a plane region, about the origin.
struct PlaneMoments {
    double area = 0.0;                                 ///< [m2]
    Eigen::Vector2d first = Eigen::Vector2d::Zero();   ///< of x [m3]
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();  ///< of x x^T [m4]
};

/// Of the union of the discs, to 1e-12 of the values at most. A function f of degree k in x has, over the arcs of the union's boundary,
///
///   int f dA = 1/(k + 2) sum over arcs of int f (x.n) ds
///
/// which 16 points of Gauss' rule give to rounding on arcs up to the whole circle.
PlaneMoments union_moments(const std::vector<Disc>& discs);

}  // namespace cutterflow::geometry
