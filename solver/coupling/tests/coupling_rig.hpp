#pragma once
/// \file Kernel coupling between a fluid and a DEM that are stand-ins.
#include <limits>

#include "solver/coupling/kernel/kernel_coupling.hpp"
#include "solver/observe/momentum_balance.hpp"
#include "solver/ports/testing/fake_engines.hpp"

namespace cutterflow::coupling::testing {

const FluidProperties k_water{998.2, 1.0034e-6};

inline CouplingSettings settings_with_rock() {
    CouplingSettings settings;
    settings.has_rock = true;
    return settings;
}

/// Rock that samples clear of itself: near by it takes its wake out of what it sees, which a prescribed flow does not have.
inline CouplingSettings settings_with_shell() {
    CouplingSettings settings = settings_with_rock();
    settings.kernel.sampling = k_quadratic_sampling;
    return settings;
}

/// A box of cells about the origin.
inline SyntheticMesh box(double half, double dx) {
    SyntheticMesh mesh;
    mesh.add_box(Vec3::Constant(-half), Vec3::Constant(half), dx, false);
    return mesh;
}

/// Engines and coupling on one rank.
template <class Fluid = FakeFluid, class Dem = FakeDem>
struct CouplingRig {
    CouplingRig(SyntheticMesh mesh, ZoneMotion motion, double step, const CouplingSettings& settings = settings_with_rock(),
                const FluidProperties& properties = k_water)
        : fluid(std::move(mesh), motion, step),
          dem(motion, 0.5, properties.density),
          coupling(settings, properties, fluid, dem, serial),
          momentum(properties, fluid, dem, serial) {}
    Fluid fluid;
    Dem dem;
    SerialCommunicator serial;
    KernelCoupling coupling;
    MomentumBalance momentum;

    ExchangeBalance step() {
        coupling.sample();
        momentum.begin(coupling.carry());
        fluid.begin_step(coupling.travel_limit(), std::numeric_limits<double>::infinity());
        const DemStep moved = coupling.move();
        coupling.map();
        fluid.end_step(coupling.void_fraction_old(), coupling.void_fraction_new(), coupling.exchange());
        const ExchangeBalance balance = coupling.book();
        momentum_errors = momentum.end(coupling.carry(), moved, fluid.loads());
        return balance;
    }

    MomentumErrors momentum_errors;
};

}  // namespace cutterflow::coupling::testing
