#include "solver/app/models_in_use.hpp"

#include <fmt/format.h>

namespace cutterflow {
namespace {

coupling::ModelNote map_in_use(const coupling::KernelSettings& kernel) {
    if (kernel.map == coupling::k_centroid_map) return {"mapping: a rock is in the cell of its centre", "kernel.map"};
    if (kernel.map == coupling::k_cluster_map)
        return {fmt::format("mapping: a rock is spread evenly over the cells of a cube of {:.4g} m", kernel.cluster_size), "kernel.map"};
    return {fmt::format("mapping: Gaussian to the fluid, quadratic to the rock, width max({:.3g} d, {:.3g} dx)", kernel.gamma,
                        kernel.min_width_in_cells),
            "rock may be larger than cells; steel hides what lies behind it"};
}

void add_coupling_models(const coupling::CouplingSettings& settings, std::vector<coupling::ModelNote>& notes) {
    notes.push_back(map_in_use(settings.kernel));
    if (settings.replay.empty()) notes.push_back({"d(void fraction)/dt in the pressure equation", "rock displaces fluid"});
    const coupling::ClosureSettings& closures = settings.closures;
    notes.push_back({"drag: " + closures.drag + (closures.drag_modifier == 1.0 ? "" : fmt::format(" x {:.3g}", closures.drag_modifier)),
                     "closures.drag"});
    if (closures.hindrance != "none") notes.push_back({"hindrance: " + closures.hindrance, "neighbouring rock raises the drag"});
    if (closures.added_mass > 0.0)
        notes.push_back({fmt::format("added mass {:.3g}", closures.added_mass), "rock is only a few times denser than the fluid"});
    if (closures.lift != "none") notes.push_back({"lift: " + closures.lift, "closures.lift"});
    notes.push_back({"fluid acceleration force rho V Du/Dt", "the stress of the undisturbed flow acts on rock"});
    if (!closures.viscous_force) notes.push_back({"less its viscous part", "closures.viscousForce no"});
}

void add_pair(const std::string& other, const coupling::PairSettings& pair, const std::string& rolling_law,
              std::vector<coupling::ModelNote>& notes) {
    notes.push_back({fmt::format("rock on {}: friction {:.3g}, restitution {:.3g}", other, pair.friction, pair.restitution),
                     "rock.contact.pairs." + (coupling::k_pair_with_rock + other)});
    if (pair.rolling_friction > 0.0)
        notes.push_back({fmt::format("rolling friction of rock on {}: {:.3g}, {}", other, pair.rolling_friction, rolling_law),
                         "rock is no sphere: it comes to rest"});
}

void add_contact_models(const coupling::DemSettings& dem, std::vector<coupling::ModelNote>& notes) {
    const coupling::ContactSettings& contact = dem.contact;
    notes.push_back(
        {fmt::format("contact: Hertz-Mindlin with micro-slip, E = {:.3g} Pa", contact.youngs_modulus), "rock hits rock and steel"});
    for (const coupling::MaterialPair& pair : coupling::k_material_pairs)
        add_pair(pair.other, contact.*pair.settings, contact.rolling_law, notes);
    for (const auto& [material, pair] : contact.rock_on_others) add_pair(material, pair, contact.rolling_law, notes);
    if (contact.wet_restitution) notes.push_back({"wet restitution after Legendre", "the fluid in the gap damps slow impacts"});
}

}  // namespace

std::vector<coupling::ModelNote> flow_models(const foam::FoamFluidEngine& fluid, const std::optional<coupling::SoilSettings>& soil) {
    std::vector<coupling::ModelNote> notes;
    notes.push_back({"turbulence: " + fluid.turbulence_model(), "constant/turbulenceProperties selects it"});
    for (const coupling::ZoneMotion& zone : fluid.moving_zones())
        notes.push_back({fmt::format("sliding mesh: {} at {:.6g} rad/s", zone.name, zone.speed), "constant/dynamicMeshDict turns it"});
    if (soil)
        notes.push_back({fmt::format("soil: {}, permeability {:.3g} m2", soil->surface.string(), soil->permeability),
                         "section soil; water is at rest in it"});
    return notes;
}

std::vector<coupling::ModelNote> recorded_flow_models(const foam::CouplingDictionary& dictionary) {
    return {{"recorded flow: " + dictionary.coupling.replay.string(), "section replay; rock does not change it"}};
}

std::vector<coupling::ModelNote> no_flow_models() {
    return {{"no fluid: weight and contacts alone", "medium none"}};
}

std::vector<coupling::ModelNote> rock_models(const foam::CouplingDictionary& dictionary) {
    std::vector<coupling::ModelNote> notes;
    if (!dictionary.coupling.has_rock) return notes;
    if (dictionary.coupling.has_medium) add_coupling_models(dictionary.coupling, notes);
    add_contact_models(*dictionary.dem, notes);
    return notes;
}

}  // namespace cutterflow
