#pragma once
/// \file What follows from the settings of the contacts, before there is a DEM.
#include "geometry/clump/unit_clump.hpp"
#include "solver/ports/dem_settings.hpp"

namespace cutterflow::cases {

/// Time step [s] of the contacts of spheres of one size: a share of the smaller of their Rayleigh time and the Hertz time of two of them at
/// the largest speed. \param diameter  [m] \param density  [kg/m3]
double contact_step(const coupling::ContactSettings& contact, double diameter, double density);

/// The same of clumps: the shortest of their spheres', with the least mass that an impact on them meets. \param diameter  of the sphere of
/// the clump's volume [m]
double contact_step(const coupling::ContactSettings& contact, const geometry::UnitClump& clump, double diameter, double density);

/// Overlap over radius [-] of a sphere that hits a flat wall of its own Young's modulus, without damping. It does not depend on the size.
/// \param inertia_density  rho_s + C_AM rho_f [kg/m3] \param speed  of the impact [m/s]
double impact_overlap(const coupling::ContactSettings& contact, double inertia_density, double speed);

}  // namespace cutterflow::cases
