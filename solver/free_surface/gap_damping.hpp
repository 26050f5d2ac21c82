#pragma once
/// \file Damping of the water in the gap of a contact, as a rate and relative to the contact.
#include "solver/free_surface/scene.hpp"
#include "solver/free_surface/water_particles.hpp"

namespace cutterflow::free_surface {

/// What may touch beside the tank's walls.
struct GapSolids {
    gsl::span<const Body> bodies;
    gsl::span<const StillSolid> still;
    gsl::span<const SolidBox> gates;
    gsl::span<const double> lift;  ///< upward speed of each gate [m/s]
};

/// Water within two cells of a contact point along its tangent and within half the gap and half a cell across it:
///
///   v <- v_c + C^(dt/tau) (v - v_c),   C from beta at the point to 1 at two cells, linear,   v_c: mean velocity of the two solids there
///
/// so that the effect depends neither on the step nor on the frame; with tau of one fluid step and v_c = 0 it would be the relaxation of
/// [Chen2019]. Contacts: bodies, or a body and a wall of the tank, a solid that stands in it or a gate, closer than the gap.
/// \return momentum taken out, sum of sizes [N s]
double damp_gaps(const GapDampingSettings& settings, const StaggeredGrid& grid, const GapSolids& solids, double step, double density,
                 WaterParticles& particles);

}  // namespace cutterflow::free_surface
