#include "solver/foam/single_phase/flow_loads.hpp"

#include <cmath>

#include "solver/foam/session/foam_conversions.hpp"

#include "wallFvPatch.H"

namespace cutterflow::foam {

using namespace Foam;

namespace {

struct Torque {
    double pressure = 0.0;
    double viscous = 0.0;
};

/// Of the fluid on the moving zone's wall faces of one patch, per density [m5/s2]. The wall moves rigidly, so its velocity gradient is
/// known and only the difference of the fluid's normal gradient from it shears.
Torque wall_torque(const CutterFluid& fluid, const volScalarField& viscosity, label patch, const MovingZones& zones) {
    const coupling::ZoneMotion& motion = zones.motion.front();
    const fvPatch& faces = fluid.mesh().boundary()[patch];
    const labelUList& cells = faces.faceCells();
    const vector origin = to_foam(motion.axis.origin);
    const vector axis = to_foam(motion.axis.direction);
    const vectorField normal(faces.nf());
    const vectorField gradient(fluid.velocity().boundaryField()[patch].snGrad());
    const scalarField& pressure = fluid.pressure().boundaryField()[patch];
    const scalarField weighted_viscosity(viscosity.boundaryField()[patch] * fluid.void_fraction().boundaryField()[patch]);
    Torque torque;
    forAll(cells, i) {
        if (zones.of_cells[static_cast<std::size_t>(cells[i])] == 0) continue;
        const vector arm = axis ^ (faces.Cf()[i] - origin);
        const vector shear = gradient[i] - motion.speed * (axis ^ normal[i]);
        const vector traction = -weighted_viscosity[i] * (shear + (shear & normal[i]) * normal[i]);
        torque.pressure += pressure[i] * (arm & faces.Sf()[i]);
        torque.viscous += faces.magSf()[i] * (arm & traction);
    }
    return torque;
}

void add_torque(const CutterFluid& fluid, const MovingZones& zones, coupling::FluidLoads& loads) {
    if (zones.motion.empty()) return;
    const volScalarField viscosity(fluid.effective_viscosity());
    forAll(fluid.mesh().boundary(), patch) {
        if (!isA<wallFvPatch>(fluid.mesh().boundary()[patch])) continue;
        const Torque torque = wall_torque(fluid, viscosity, patch, zones);
        loads.torque_pressure += fluid.density() * torque.pressure;
        loads.torque_viscous += fluid.density() * torque.viscous;
    }
    reduce(loads.torque_pressure, sumOp<scalar>());
    reduce(loads.torque_viscous, sumOp<scalar>());
}

/// Net and gross flow through open patches and walls.
struct BoundaryFlows {
    double open_net = 0.0;
    double open_gross = 0.0;
    double wall_gross = 0.0;
};

BoundaryFlows sum_boundary_flows(const surfaceScalarField& flux) {
    BoundaryFlows flows;
    forAll(flux.boundaryField(), patch) {
        const fvsPatchScalarField& of_patch = flux.boundaryField()[patch];
        const double net = sum(of_patch);
        const double gross = sum(mag(of_patch));
        if (isA<wallFvPatch>(of_patch.patch())) {
            flows.wall_gross += gross;
        } else if (!of_patch.coupled()) {
            flows.open_net += net;
            flows.open_gross += gross;
        }
    }
    for (double* value : {&flows.open_net, &flows.open_gross, &flows.wall_gross}) reduce(*value, sumOp<scalar>());
    return flows;
}

void add_outlet(const CutterFluid& fluid, label outlet, coupling::FluidLoads& loads) {
    const scalarField& area = fluid.mesh().magSf().boundaryField()[outlet];
    loads.outlet_flow = gSum(fluid.relative_flux().boundaryField()[outlet]);
    loads.outlet_pressure = gSum(area * fluid.pressure().boundaryField()[outlet]) / gSum(area);
}

}  // namespace

coupling::FluidLoads compute_loads(const CutterFluid& fluid, const MovingZones& zones, std::optional<label> outlet) {
    coupling::FluidLoads loads;
    add_torque(fluid, zones, loads);
    if (outlet) add_outlet(fluid, *outlet, loads);
    const BoundaryFlows flows = sum_boundary_flows(fluid.relative_fluid_flux());
    const InterfaceFlow interfaces = interface_flow(fluid.relative_fluid_flux(), &fluid.overlap_flux());
    loads.boundary_flow = flows.open_net + interfaces.net;
    loads.wall_flow = flows.wall_gross;
    const fvMesh& mesh = fluid.mesh();
    loads.through_flow = flows.open_gross > 0.0 ? 0.5 * flows.open_gross : gSum(mesh.V().field()) / mesh.time().deltaTValue();
    loads.interface_imbalance = interfaces.imbalance / (0.5 * interfaces.gross + VSMALL);
    loads.interface_mismatch = interfaces.mismatch / (0.5 * interfaces.gross + VSMALL);
    loads.continuity_error = gSum(mag(fluid.continuity_residual())) / (2.0 * loads.through_flow);
    loads.domain_surplus = fluid.domain_surplus();
    loads.clipped_cells = static_cast<int>(fluid.clipped_cells());
    loads.courant_max = fluid.courant_max();
    loads.speed_max = gMax(mag(fluid.velocity().primitiveField())());
    if (fluid.soil() != nullptr) loads.soil_force = fluid.density() * to_vec3(fluid.soil()->force(fluid.velocity()));
    loads.boundary_impulse = fluid.density() * to_vec3(fluid.outside_momentum().boundary);
    loads.interface_impulse = fluid.density() * to_vec3(fluid.outside_momentum().interface);
    loads.replaced_momentum = fluid.density() * to_vec3(fluid.outside_momentum().replaced);
    loads.turned_momentum = fluid.density() * to_vec3(fluid.outside_momentum().turned);
    return loads;
}

}  // namespace cutterflow::foam
