#include "solver/app/models_in_use.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "solver/coupling/coupling_methods.hpp"

namespace cutterflow {
namespace {

void add_pair(const std::string& other, const coupling::PairSettings& pair, const std::string& rolling_law,
              std::vector<coupling::ModelNote>& notes) {
    notes.push_back({fmt::format("rock on {}: friction {:.3g}, restitution {:.3g}", other, pair.friction, pair.restitution),
                     "rock.contact.pairs." + (coupling::k_pair_with_rock + other)});
    if (pair.rolling_friction > 0.0)
        notes.push_back({fmt::format("rolling friction of rock on {}: {:.3g}, {}", other, pair.rolling_friction, rolling_law),
                         "a couple, so that what rolls comes to rest"});
}

/// Whether rock can touch that material: rock itself, or of a wall.
bool is_touched(const std::string& material, const coupling::DemSettings& dem) {
    const auto& sides = dem.domain.side_is_wall;
    const bool has_sides = std::find(sides.begin(), sides.end(), true) != sides.end();
    return material == "rock" || (has_sides && dem.domain.material == material) ||
           std::any_of(dem.walls.begin(), dem.walls.end(), [&](const coupling::WallSettings& wall) { return wall.material == material; });
}

void add_contact_models(const coupling::DemSettings& dem, std::vector<coupling::ModelNote>& notes) {
    const coupling::ContactSettings& contact = dem.contact;
    notes.push_back(
        {fmt::format("contact: Hertz-Mindlin with micro-slip, E = {:.3g} Pa", contact.youngs_modulus), "rock hits rock and walls"});
    for (const coupling::MaterialPair& pair : coupling::k_material_pairs)
        if (is_touched(pair.other, dem)) add_pair(pair.other, contact.*pair.settings, contact.rolling_law, notes);
    for (const auto& [material, pair] : contact.rock_on_others)
        if (is_touched(material, dem)) add_pair(material, pair, contact.rolling_law, notes);
    if (contact.wet_restitution) notes.push_back({"wet restitution after Legendre", "the fluid in the gap damps slow impacts"});
}

}  // namespace

std::vector<coupling::ModelNote> flow_models(const foam::FoamFluidEngine& fluid, const std::optional<coupling::SoilSettings>& soil) {
    std::vector<coupling::ModelNote> notes;
    notes.push_back({"turbulence: " + fluid.turbulence_model(), "constant/turbulenceProperties selects it"});
    for (const coupling::ZoneMotion& zone : fluid.moving_zones())
        notes.push_back({fmt::format("sliding mesh: {} at {:.6g} rad/s", zone.name, zone.speed), "constant/dynamicMeshDict turns it"});
    if (soil) notes.push_back(coupling::soil_model(*soil));
    return notes;
}

std::vector<coupling::ModelNote> recorded_flow_models(const foam::CouplingDictionary& dictionary) {
    return {{"recorded flow: " + dictionary.coupling.replay.string(), "section replay; rock does not change it"}};
}

std::vector<coupling::ModelNote> no_flow_models() {
    return {{"no fluid: weight and contacts alone", "medium none"}};
}

std::vector<coupling::ModelNote> rock_models(const foam::CouplingDictionary& dictionary) {
    if (!dictionary.coupling.has_rock) return {};
    std::vector<coupling::ModelNote> notes = coupling::coupling_method(dictionary.coupling).models(dictionary.coupling);
    add_contact_models(*dictionary.dem, notes);
    return notes;
}

}  // namespace cutterflow
