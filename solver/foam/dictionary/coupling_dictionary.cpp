#include "solver/foam/dictionary/coupling_dictionary.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/run_files.hpp"
#include "geometry/clump/clump_file.hpp"
#include "geometry/clump/unit_clump.hpp"
#include "solver/foam/dictionary/dictionary_section.hpp"
#include "solver/foam/session/case_errors.hpp"
#include "solver/foam/session/foam_conversions.hpp"
#include "solver/foam/session/foam_session.hpp"

#include "IOdictionary.H"
#include "Pstream.H"
#include "Time.H"
#include "uniformDimensionedFields.H"

namespace cutterflow::foam {
namespace {

using Presence = DictionarySection::Presence;
constexpr Presence k_required = Presence::required;
constexpr Presence k_optional = Presence::optional;

/// Stands for the case's fluid in checks that are not about it.
constexpr coupling::FluidProperties k_any_fluid{1000.0, 1e-6};

Foam::IOobject in_constant(const Foam::word& name, const Foam::Time& time) {
    return Foam::IOobject(name, time.constant(), time, Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false);
}

/// Reads the section of `key` with `read(DictionarySection&)`. \return whether there is one
template <class Read>
bool read_section(DictionarySection& parent, const std::string& key, Presence presence, Read read) {
    const Foam::dictionary* dict = parent.section(key, presence);
    if (!dict) return false;
    DictionarySection section = parent.below(*dict, key);
    read(section);
    section.finish();
    return true;
}

/// As read_section, into settings that exist only with their section.
template <class Settings, class Read>
void read_optional(DictionarySection& parent, const std::string& key, std::optional<Settings>& settings, Read read) {
    Settings values;
    if (read_section(parent, key, k_optional, [&](DictionarySection& section) { read(section, values); })) settings = values;
}

/// `read(DictionarySection&)` of each section of a list.
template <class Settings, class Read>
void read_list(DictionarySection& parent, const std::string& key, std::vector<Settings>& settings, Read read) {
    for (const Foam::dictionary& dict : parent.sections(key, k_optional)) {
        DictionarySection section = parent.below(dict, key);
        settings.push_back(read(section));
        section.finish();
    }
}

/// Reads every key of the struct's table. One without a default must be there.
template <class Settings>
void read_settings(DictionarySection& section, Settings& settings) {
    for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>()) {
        const Presence presence = setting.parameter.default_value ? k_optional : k_required;
        std::visit([&](auto member) { section.read(setting.parameter.key, settings.*member, presence); }, setting.member);
    }
}

/// Reads a section that holds the rows of its struct's table and nothing else.
template <class Settings>
void read_tabled(DictionarySection& parent, const std::string& key, Settings& settings) {
    read_section(parent, key, k_optional, [&](DictionarySection& section) { read_settings(section, settings); });
}

template <class Settings>
void read_tabled(DictionarySection& parent, const std::string& key, std::optional<Settings>& settings) {
    read_optional(parent, key, settings, read_settings<Settings>);
}

/// \param materials  of walls
void read_contact(DictionarySection& section, const std::set<std::string>& materials, coupling::ContactSettings& contact) {
    for (const char* former : {"friction", "restitution"})
        section.refuse(former, "It is given for each pair of materials",
                       fmt::format("Write pairs {{ rock_rock {{ {0} ...; }} rock_steel {{ {0} ...; }} }}", former));
    read_settings(section, contact);
    read_section(section, "pairs", k_optional, [&](DictionarySection& pairs) {
        for (const coupling::MaterialPair& pair : coupling::k_material_pairs)
            read_section(pairs, pair.name, k_optional, [&](DictionarySection& one) { read_settings(one, contact.*pair.settings); });
        for (const std::string& material : materials) {
            if (contact.pair_on(material) != nullptr) continue;
            coupling::PairSettings pair;
            if (read_section(pairs, coupling::k_pair_with_rock + material, k_optional,
                             [&](DictionarySection& one) { read_settings(one, pair); }))
                contact.rock_on_others[material] = pair;
        }
    });
}

/// One, { ... }, or several, ( { ... } { ... } ).
void read_travels(DictionarySection& wall, std::vector<coupling::WallTravel>& travels) {
    const auto read = [](DictionarySection& section) {
        coupling::WallTravel travel;
        section.read("velocity", travel.velocity, k_required);
        section.read("from", travel.begin, k_required);
        section.read("to", travel.end, k_required);
        return travel;
    };
    if (wall.has_section("travel"))
        read_section(wall, "travel", k_optional, [&](DictionarySection& section) { travels.push_back(read(section)); });
    else
        read_list(wall, "travel", travels, read);
}

coupling::WallSettings read_wall(DictionarySection& section, const std::filesystem::path& folder) {
    coupling::WallSettings wall;
    section.read("name", wall.name, k_required);
    section.read("file", wall.file, folder, k_required);
    section.read("rotating", wall.rotating, k_optional);
    section.read("material", wall.material, k_optional);
    read_travels(section, wall.travels);
    read_section(section, "turn", k_optional, [&](DictionarySection& turn) {
        turn.read("origin", wall.turn.axis.origin, k_required);
        turn.read("axis", wall.turn.axis.direction, k_required);
        turn.read("speed", wall.turn.speed, k_required);
        turn.read("from", wall.turn.begin, k_required);
        turn.read("to", wall.turn.end, k_required);
        if (wall.turn.axis.direction.norm() > 0.0) wall.turn.axis.direction.normalize();
    });
    read_section(section, "press", k_optional, [&](DictionarySection& press) {
        wall.press.emplace();
        press.read("direction", wall.press->direction, k_required);
        press.read("force", wall.press->force, k_required);
        press.read("speed", wall.press->largest_speed, k_required);
        if (wall.press->direction.norm() > 0.0) wall.press->direction.normalize();
    });
    section.read("removedAt", wall.removed_at, k_optional);
    section.read("surfaceVelocity", wall.surface_velocity, k_optional);
    return wall;
}

/// A section for each shape, by name: { file "..."; }.
std::vector<coupling::ClumpShape> read_shapes(DictionarySection& section, const Foam::dictionary& dict,
                                              const std::filesystem::path& folder) {
    std::vector<coupling::ClumpShape> shapes;
    for (const Foam::word& name : dict.toc())
        read_section(section, name, k_required, [&](DictionarySection& one) {
            std::filesystem::path file;
            one.read("file", file, folder, k_required);
            if (file.empty()) return;
            try {
                shapes.push_back({name, geometry::unit_clump(geometry::read_clump(file))});
            } catch (const UserError& error) {
                for (const Mistake& mistake : error.mistakes()) one.add(mistake);
            }
        });
    return shapes;
}

void read_box(DictionarySection& section, coupling::DomainSettings& domain) {
    section.read("lower", domain.lower, k_required);
    section.read("upper", domain.upper, k_required);
}

void read_cylinder(DictionarySection& section, coupling::DomainSettings& domain) {
    section.read("axisPoint", domain.axis_point, k_optional);
    section.read("radius", domain.radius, k_required);
    section.read("zMin", domain.lower.z(), k_required);
    section.read("zMax", domain.upper.z(), k_required);
}

void read_sides(DictionarySection& section, const std::string& key, std::array<bool, 6>& sides) {
    std::vector<std::string> words;
    section.read(key, words, k_optional);
    for (const std::string& word : words) {
        const auto side = std::find(coupling::k_domain_sides.begin(), coupling::k_domain_sides.end(), word);
        if (side == coupling::k_domain_sides.end())
            section.report(key, fmt::format("{} is no side", word), fmt::format("Sides are {}", fmt::join(coupling::k_domain_sides, ", ")));
        else
            sides[static_cast<std::size_t>(side - coupling::k_domain_sides.begin())] = true;
    }
}

void read_domain(DictionarySection& section, coupling::DomainSettings& domain) {
    const std::string type = section.read_choice("type", {"box", "cylinder"}, k_required);
    domain.shape = type == "cylinder" ? coupling::DomainShape::cylinder : coupling::DomainShape::box;
    if (type == "box") read_box(section, domain);
    if (type == "cylinder") read_cylinder(section, domain);
    read_sides(section, "walls", domain.side_is_wall);
    read_sides(section, "frictionless", domain.side_is_frictionless);
    section.read("material", domain.material, k_optional);
}

void read_rock(DictionarySection& section, const std::filesystem::path& folder, CouplingDictionary& result) {
    coupling::DemSettings dem;
    section.read("start", result.coupling.rock_start, folder, k_optional);
    section.read("feed", result.coupling.rock_feed, folder, result.coupling.rock_start.empty() ? k_required : k_optional);
    read_tabled(section, "queue", result.coupling.queue);
    read_tabled(section, "calming", result.coupling.calming);
    read_list(section, "walls", dem.walls, [&](DictionarySection& wall) { return read_wall(wall, folder); });
    if (const Foam::dictionary* shapes = section.section("shapes", k_optional)) {
        DictionarySection below = section.below(*shapes, "shapes");
        dem.shapes = result.coupling.shapes = read_shapes(below, *shapes, folder);
        below.finish();
    }
    read_section(section, "domain", k_required, [&](DictionarySection& domain) { read_domain(domain, dem.domain); });
    std::set<std::string> materials{dem.domain.material};
    for (const coupling::WallSettings& wall : dem.walls) materials.insert(wall.material);
    read_section(section, "contact", k_required, [&](DictionarySection& contact) { read_contact(contact, materials, dem.contact); });
    result.coupling.has_rock = true;
    result.dem = dem;
}

void read_region(DictionarySection& section, Region& region) {
    const std::string type = section.read_choice("type", {"everything", "box", "sphere", "cylinder", "halfSpace"}, k_required);
    if (type == "box") {
        BoxRegion box;
        section.read("lower", box.lower, k_required);
        section.read("upper", box.upper, k_required);
        region = box;
    } else if (type == "sphere") {
        SphereRegion sphere;
        section.read("centre", sphere.centre, k_required);
        section.read("radius", sphere.radius, k_required);
        region = sphere;
    } else if (type == "cylinder") {
        CylinderRegion cylinder;
        section.read("from", cylinder.from, k_required);
        section.read("to", cylinder.to, k_required);
        section.read("radius", cylinder.radius, k_required);
        region = cylinder;
    } else if (type == "halfSpace") {
        HalfSpaceRegion half;
        section.read("point", half.point, k_required);
        section.read("normal", half.normal, k_required);
        region = half;
    }
}

coupling::OperationSettings read_operation(DictionarySection& section) {
    const auto& names = coupling::k_operation_names;
    coupling::OperationSettings operation;
    const std::string what = section.read_choice("do", {names.begin(), names.end()}, k_required);
    if (const auto found = std::find(names.begin(), names.end(), what); found != names.end())
        operation.kind = static_cast<coupling::OperationKind>(found - names.begin());
    if (operation.kind == coupling::OperationKind::extract) {
        section.read("from", operation.begin, k_required);
        section.read("to", operation.end, k_required);
        section.read("rate", operation.rate, k_required);
    } else {
        section.read("at", operation.begin, k_required);
    }
    read_section(section, "region", k_required, [&](DictionarySection& region) { read_region(region, operation.region); });
    return operation;
}

coupling::GateSettings read_gate(DictionarySection& section) {
    coupling::GateSettings gate;
    section.read("name", gate.name, k_required);
    section.read("normal", gate.normal, k_required);
    if (!section.has("lower") && !section.has("upper")) {
        section.read("centre", gate.centre, k_required);
        section.read("radius", gate.radius, k_required);
        return gate;
    }
    gate.rectangle.emplace();
    section.read("lower", gate.rectangle->lower, k_required);
    section.read("upper", gate.rectangle->upper, k_required);
    return gate;
}

void read_stop(DictionarySection& section, coupling::CouplingSettings& settings) {
    read_optional(section, "atRest", settings.at_rest, [](DictionarySection& rest, coupling::AtRestSettings& values) {
        rest.read("energy", values.energy, k_optional);
        rest.read("speed", values.speed, k_optional);
        rest.read("hold", values.hold, k_optional);
        rest.read("from", values.from, k_optional);
    });
    read_optional(section, "idle", settings.idle, [](DictionarySection& idle, coupling::IdleSettings& values) {
        idle.read("gate", values.gate, k_required);
        idle.read("duration", values.duration, k_required);
    });
    read_optional(section, "below", settings.below, [](DictionarySection& below, coupling::BelowSettings& values) {
        below.read("gate", values.gate, k_required);
        below.read("rate", values.rate, k_required);
        below.read("window", values.window, k_required);
    });
    if ((settings.at_rest || settings.idle || settings.below) && !section.has("undecided") && !section.has("targetHalfWidth")) return;
    settings.stop.emplace();
    read_settings(section, *settings.stop);
}

void read_mouth(DictionarySection& section, coupling::MouthSettings& mouth) {
    section.read("centre", mouth.centre, k_required);
    section.read("direction", mouth.direction, k_required);
    section.read("radius", mouth.radius, k_required);
    section.read("depth", mouth.depth, k_required);
}

void read_fates(DictionarySection& section, const std::filesystem::path& folder, coupling::FateSettings& fates) {
    section.read("contour", fates.contour, folder, k_required);
    section.read("ringRadius", fates.ring_radius, k_required);
    section.read("zBackplate", fates.z_backplate, k_required);
    section.read("hysteresis", fates.hysteresis, k_optional);
    read_section(section, "mouth", k_required, [&](DictionarySection& mouth) { read_mouth(mouth, fates.mouth); });
    section.read("binWidth", fates.bin_width, k_required);
    read_optional(section, "cutting", fates.cutting, [](DictionarySection& cutting, coupling::CuttingSettings& settings) {
        cutting.read("distance", settings.distance, k_required);
        cutting.read("behind", settings.behind, k_required);
        cutting.read("distanceBehind", settings.distance_behind, k_required);
    });
}

void read_velocity(DictionarySection& section, const std::filesystem::path& folder, coupling::VelocitySettings& velocity) {
    section.read("startTime", velocity.start_time, k_required);
    section.read("interval", velocity.interval, k_optional);
    section.read("blades", velocity.blades, k_optional);
    for (const Foam::dictionary& dict : section.sections("sets", k_required)) {
        DictionarySection entry = section.below(dict, "sets");
        coupling::VelocitySetSettings set;
        entry.read("name", set.name, k_required);
        entry.read("file", set.file, folder, k_required);
        entry.read("phases", set.phases, k_optional);
        entry.finish();
        velocity.sets.push_back(set);
    }
}

/// Whether there is a file of the folder constant with a FoamFile header. Collective.
bool has_header(const Foam::word& name, const Foam::Time& time) {
    return in_constant(name, time).typeHeaderOk<Foam::IOdictionary>(false);
}

/// Whether there is anything of that name in the folder constant. Collective.
bool is_in_constant(const std::string& name, const FoamSession& session) {
    bool there = Foam::UPstream::master() && std::filesystem::exists(session.case_folder() / "constant" / name);
    Foam::Pstream::scatter(there);
    return there;
}

/// Whether a file that rock needs can be read; adds a mistake when not.
bool can_read(const std::string& name, const std::string& content, const Foam::Time& time, Findings& findings) {
    if (has_header(name, time)) return true;
    findings.add({"constant/" + name, "the file is missing or has no FoamFile header", "With rock it holds " + content,
                  "Add or correct it; cases/examples/rock_in_a_box has one"});
    return false;
}

/// Gravity and, with a medium, the fluid; the other keys of these files are OpenFOAM's.
void read_surroundings(const Foam::Time& time, bool has_medium, coupling::DemSettings& dem, Findings& findings) {
    if (can_read("g", "the gravity [m/s2]", time, findings))
        dem.gravity = to_vec3(Foam::uniformDimensionedVectorField(in_constant("g", time)).value());
    if (!has_medium) return;
    if (!can_read("transportProperties", "rho [kg/m3] and nu [m2/s]", time, findings)) {
        dem.fluid = k_any_fluid;
        return;
    }
    const Foam::IOdictionary transport(in_constant("transportProperties", time));
    DictionarySection fluid(transport, "", "constant/transportProperties", findings);
    fluid.read_dimensioned("rho", dem.fluid.density, k_required);
    fluid.read_dimensioned("nu", dem.fluid.kinematic_viscosity, k_required);
}

void require_above_zero(DictionarySection& section, const std::string& key, Presence presence) {
    double value = 1.0;
    section.read(key, value, presence);
    if (!(value > 0.0)) section.report(key, fmt::format("= {}", value), "It must be above 0");
}

/// What of system/controlDict sets the time step; the other keys are OpenFOAM's.
void check_time_control(const Foam::Time& time, Findings& findings) {
    DictionarySection control(time.controlDict(), "", "system/controlDict", findings);
    require_above_zero(control, "deltaT", k_required);
    require_above_zero(control, "maxCo", k_optional);
    require_above_zero(control, "maxDeltaT", k_optional);
    require_above_zero(control, "developmentStepRatio", k_optional);
    require_above_zero(control, "writeInterval", k_optional);
}

/// OpenFOAM would delete the fields that checkpoints go on from.
void check_kept_times(const Foam::Time& time, Findings& findings) {
    int purged = 0;
    DictionarySection control(time.controlDict(), "", "system/controlDict", findings);
    control.read("purgeWrite", purged, k_optional);
    if (purged > 0)
        control.report("purgeWrite", fmt::format("= {} with section checkpoint of {}", purged, names::coupling_properties),
                       "A checkpoint goes on from the fields of its time", "Set purgeWrite 0, or remove the section");
}

/// The file, or null when there is none. \throws UserError  when OpenFOAM would not take it for a dictionary
std::unique_ptr<Foam::IOdictionary> open_coupling_properties(const FoamSession& session, const Foam::Time& time) {
    Foam::IOobject header = in_constant("couplingProperties", time);
    if (header.typeHeaderOk<Foam::IOdictionary>(true)) return std::make_unique<Foam::IOdictionary>(header);
    if (!is_in_constant("couplingProperties", session)) return nullptr;
    throw UserError({{names::coupling_properties, "this is no OpenFOAM dictionary: it has no FoamFile header with class dictionary",
                      "OpenFOAM reads a file only with that header; without the file the run would be a pure flow",
                      "Begin the file with: FoamFile { version 2.0; format ascii; class dictionary; object couplingProperties; }"}});
}

void read_file(DictionarySection& file, const std::filesystem::path& folder, CouplingDictionary& result) {
    coupling::CouplingSettings& settings = result.coupling;
    settings.has_medium = file.read_choice("medium", {"fluid", "none"}, k_optional) != "none";
    if (!settings.has_medium)
        coupling::visit_coupling_sections(settings, [&](const char* key, const auto&) {
            if (file.section(key, k_optional))
                file.report(key, "with medium none", "Without a medium rock is neither mapped nor dragged", "Remove the section");
        });
    if (!settings.has_medium && file.has("largestSpeed"))
        file.report("largestSpeed", "with medium none", "Without a medium no fluid moves", "Remove it");
    if (file.has("largestSpeed")) file.read("largestSpeed", settings.largest_speed.emplace(), k_required);
    read_section(file, "patches", k_optional, [&](DictionarySection& section) {
        section.read("outlet", settings.patches.outlet, k_optional);
        section.read("steel", settings.patches.steel, k_optional);
    });
    read_optional(file, "soil", settings.soil, [&](DictionarySection& section, coupling::SoilSettings& soil) {
        section.read("surface", soil.surface, folder, k_required);
        section.read("velocity", soil.velocity, k_optional);
        read_settings(section, soil);
    });
    read_section(file, "rock", k_optional, [&](DictionarySection& section) { read_rock(section, folder, result); });
    coupling::visit_coupling_sections(settings, [&](const char* key, auto& section) { read_tabled(file, key, section); });
    read_optional(file, "fates", settings.fates,
                  [&](DictionarySection& section, coupling::FateSettings& fates) { read_fates(section, folder, fates); });
    read_tabled(file, "outflow", settings.outflow);
    read_optional(file, "velocity", settings.velocity,
                  [&](DictionarySection& section, coupling::VelocitySettings& velocity) { read_velocity(section, folder, velocity); });
    read_section(file, "stop", k_optional, [&](DictionarySection& section) { read_stop(section, settings); });
    read_list(file, "events", settings.operations, read_operation);
    read_list(file, "gates", settings.gates, read_gate);
    read_tabled(file, "checkpoint", settings.checkpoint);
    read_tabled(file, "record", settings.record);
    read_section(file, "replay", k_optional,
                 [&](DictionarySection& section) { section.read("recording", settings.replay, folder, k_required); });
}

/// Checks the values, with the same rules as everywhere else.
void check_values(const CouplingDictionary& result, Findings& findings) {
    findings.add_of_values(
        coupling::check_settings(result.coupling, result.dem ? result.dem->fluid : k_any_fluid, names::coupling_properties));
    if (!result.dem) return;
    coupling::DemSettings dem = *result.dem;
    dem.added_mass = coupling::ClosureSettings().added_mass;  // its mistakes and the fluid's are among those above
    if (result.coupling.has_medium) dem.fluid = k_any_fluid;
    findings.add_of_values(coupling::check_settings(dem, names::coupling_properties));
}

void read_case(FoamSession& session, CouplingDictionary& result, Findings& findings) {
    const Foam::Time& time = session.time();
    check_time_control(time, findings);
    const auto dict = open_coupling_properties(session, time);
    if (!dict) return;
    DictionarySection file(*dict, "", names::coupling_properties, findings);
    read_file(file, session.case_folder(), result);
    file.finish();
    if (result.coupling.checkpoint) check_kept_times(time, findings);
    if (result.dem) {
        result.dem->added_mass = result.coupling.closures.added_mass;
        read_surroundings(time, result.coupling.has_medium, *result.dem, findings);
    }
    check_values(result, findings);
}

}  // namespace

CouplingDictionary read_coupling_dictionary(FoamSession& session) {
    CouplingDictionary result;
    Findings findings;
    with_case_errors(ThrownErrors::all, [&] { read_case(session, result, findings); });
    std::vector<Mistake> mistakes = findings.take();
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return result;
}

}  // namespace cutterflow::foam
