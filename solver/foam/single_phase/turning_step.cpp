#include <cmath>
#include <optional>

#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/single_phase/cutter_fluid.hpp"
#include "solver/foam/single_phase/fields.hpp"

#include "movingWallVelocityFvPatchVectorField.H"
#include "rotatingWallVelocityFvPatchVectorField.H"

namespace cutterflow::foam {

using namespace Foam;

/// An Euler step takes all forces as they point at the step's end, while a turning cell's velocity changes with the force that turns during
/// the step: what turns with the mesh would lose omega^2 dt/2 of its speed a second. With h = tan(omega dt/2) n and
///
///   (1 + h x) (u - u_old)/dt                                                                           [m/s2]
///
/// for (u - u_old)/dt, solid-body rotation is a solution at any step and a uniform velocity stays uniform: with R the cell's rotation in
/// the step, (1 + h x)(1 - R^-1) = 2 h x, and 2 h x (omega x r)/dt is a gradient, which the pressure balances.
void CutterFluid::update_half_turns() {
    if (half_turn_.empty()) return;
    std::vector<vector> of_zones(1, Zero);
    for (const coupling::ZoneMotion& motion : zones_.motion)
        of_zones.push_back(std::tan(0.5 * motion.speed * time_.deltaTValue()) * to_foam(motion.axis.direction));
    forAll(half_turn_, cell) half_turn_[cell] = of_zones[zones_.of_cells[static_cast<std::size_t>(cell)]];
}

/// h x (u - u_old)/dt [m/s2]. \pre half_turn_ is not empty
vectorField CutterFluid::turning_rate() const {
    return half_turn_ ^ ((U_.primitiveField() - U_.oldTime().primitiveField()) / time_.deltaTValue());
}

/// Volume of fluid before the step over the cell's volume after it [-].
scalarField CutterFluid::old_fluid_share() const {
    return alpha_.oldTime().primitiveField() * old_volumes(mesh_) / mesh_.V().field();
}

/// What the momentum matrix lacks [m/s2]. The rock's part is a mean over the step that does not turn with the mesh.
vectorField CutterFluid::turning_force() const {
    vectorField force(old_fluid_share() * turning_rate());
    if (rock_ == RockPresence::absent) return force;
    const vectorField change(U_.primitiveField() - U_.oldTime().primitiveField());
    const scalarField rate(drag_rate_.field() + inertia_.primitiveField() / time_.deltaTValue());
    const vectorField source(explicit_source_.field() + inertia_.primitiveField() * DuDt_.oldTime().primitiveField());
    return force + (half_turn_ ^ (rate * change - source));
}

/// In turning cells the matrix solves a + N = (1 + h x) r - h x a, with a the gain of the velocity, N convection, pressure and stress and r
/// what rock gives. update_received has left a + N in received_; r = (1 + h x)^-1 (a + N + h x a) is to stand there, and h x (r - a) came
/// from N.
void CutterFluid::turn_received() {
    outside_.turned = Zero;
    if (half_turn_.empty()) return;
    const vectorField sum(received_ + old_fluid_share() * turning_rate());
    forAll(received_, cell) {
        const vector& h = half_turn_[cell];
        const vector turned((sum[cell] - (h ^ sum[cell]) + h * (h & sum[cell])) / (1.0 + magSqr(h)));
        outside_.turned += mesh_.V()[cell] * (received_[cell] - turned);
        received_[cell] = turned;
    }
    reduce(outside_.turned, sumOp<vector>());
    outside_.turned *= time_.deltaTValue();
}

/// Centripetal acceleration -|u|^2 r/r^2 of the faces of a wall that turns, with r normal to its axis; 0 elsewhere [m/s2]. Walls turn with
/// the mesh, or round in the mesh with rotatingWallVelocity.
vectorField CutterFluid::wall_acceleration(label patch) const {
    const fvPatchVectorField& u = U_.boundaryField()[patch];
    vectorField acceleration(u.size(), Zero);
    std::optional<RotationAxis> own_axis;
    if (isA<rotatingWallVelocityFvPatchVectorField>(u)) {
        const auto& round = refCast<const rotatingWallVelocityFvPatchVectorField>(u);
        own_axis = {to_vec3(round.origin()), to_vec3(round.axis()).normalized()};
    } else if (!isA<movingWallVelocityFvPatchVectorField>(u)) {
        return acceleration;
    }
    forAll(acceleration, i) {
        const coupling::Zone zone = zones_.of_cells[static_cast<std::size_t>(u.patch().faceCells()[i])];
        if (!own_axis && zone == coupling::k_still_zone) continue;
        const RotationAxis& axis = own_axis ? *own_axis : zones_.motion[zone - 1u].axis;
        const Vec3 arm = to_vec3(u.patch().Cf()[i]) - axis.origin;
        const Vec3 radius = arm - axis.direction.dot(arm) * axis.direction;
        acceleration[i] = to_foam(-magSqr(u[i]) / (radius.squaredNorm() + VSMALL) * radius);
    }
    return acceleration;
}

}  // namespace cutterflow::foam
