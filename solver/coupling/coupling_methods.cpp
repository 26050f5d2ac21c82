#include "solver/coupling/coupling_methods.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <gsl/assert>

#include "solver/coupling/dry/free_rock.hpp"
#include "solver/coupling/kernel/cell_groups.hpp"
#include "solver/coupling/kernel/kernel_coupling.hpp"

namespace cutterflow::coupling {
namespace {

// ---- rock without a medium ----

bool has_no_medium(const CouplingSettings& settings) {
    return !settings.has_medium;
}

std::vector<Mistake> no_mistakes(const CouplingSettings&, const FluidEngine&, Communicator&) {
    return {};
}

std::unique_ptr<RockCoupling> make_free_rock(const CouplingSettings& settings, const FluidProperties&, FluidEngine& fluid, DemEngine& dem,
                                             Communicator&) {
    return std::make_unique<FreeRock>(settings.calming, fluid, dem);
}

std::vector<ModelNote> no_models(const CouplingSettings&) {
    return {};
}

// ---- rock in a fluid, by kernels or other maps ----

bool has_medium(const CouplingSettings& settings) {
    return settings.has_medium;
}

std::vector<Mistake> kernel_mistakes(const CouplingSettings& settings, const FluidEngine& fluid, Communicator& communicator) {
    return map_mistakes(settings.kernel, fluid, communicator);
}

std::unique_ptr<RockCoupling> make_kernel_coupling(const CouplingSettings& settings, const FluidProperties& properties, FluidEngine& fluid,
                                                   DemEngine& dem, Communicator& communicator) {
    return std::make_unique<KernelCoupling>(settings, properties, fluid, dem, communicator);
}

ModelNote map_in_use(const KernelSettings& kernel) {
    if (kernel.map == k_centroid_map) return {"mapping: a rock is in the cell of its centre", "kernel.map"};
    if (kernel.map == k_cluster_map)
        return {fmt::format("mapping: a rock is spread evenly over the cells of a cube of {:.4g} m", kernel.cluster_size), "kernel.map"};
    return {fmt::format("mapping: Gaussian to the fluid, {} to the rock, width max({:.3g} d, {:.3g} dx)",
                        kernel.sampling == k_quadratic_sampling ? "quadratic" : "Gaussian half as wide", kernel.gamma,
                        kernel.min_width_in_cells),
            "rock may be larger than cells; steel hides what lies behind it"};
}

std::vector<ModelNote> kernel_models(const CouplingSettings& settings) {
    std::vector<ModelNote> notes{map_in_use(settings.kernel)};
    if (settings.replay.empty()) notes.push_back({"d(void fraction)/dt in the pressure equation", "rock displaces fluid"});
    const ClosureSettings& closures = settings.closures;
    notes.push_back({"drag: " + closures.drag + (closures.drag_modifier == 1.0 ? "" : fmt::format(" x {:.3g}", closures.drag_modifier)),
                     "closures.drag"});
    if (closures.hindrance != "none") notes.push_back({"hindrance: " + closures.hindrance, "neighbouring rock raises the drag"});
    if (closures.added_mass > 0.0)
        notes.push_back({fmt::format("added mass {:.3g}", closures.added_mass), "rock is only a few times denser than the fluid"});
    if (closures.lift != "none") notes.push_back({"lift: " + closures.lift, "closures.lift"});
    notes.push_back({"fluid acceleration force rho V Du/Dt", "the stress of the undisturbed flow acts on rock"});
    if (!closures.viscous_force) notes.push_back({"less its viscous part", "closures.viscousForce no"});
    return notes;
}

/// A method of rock in a fluid that has a section of its own stands before those that have none.
constexpr std::array<CouplingMethod, 2> k_methods{{
    {has_no_medium, no_mistakes, make_free_rock, no_models},
    {has_medium, kernel_mistakes, make_kernel_coupling, kernel_models},
}};

}  // namespace

const CouplingMethod& coupling_method(const CouplingSettings& settings) {
    const auto method = std::find_if(k_methods.begin(), k_methods.end(), [&](const CouplingMethod& row) { return row.is_meant(settings); });
    Ensures(method != k_methods.end());
    return *method;
}

ModelNote soil_model(const SoilSettings& soil) {
    const double speed = soil.velocity.norm();
    return {fmt::format("soil: {}, permeability {:.3g} m2", soil.surface.string(), soil.permeability),
            speed > 0.0 ? fmt::format("section soil; water in it moves with it, at {:.3g} m/s", speed)
                        : std::string("section soil; water is at rest in it")};
}

}  // namespace cutterflow::coupling
