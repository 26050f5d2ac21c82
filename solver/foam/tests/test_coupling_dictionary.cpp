#include "solver/foam/dictionary/coupling_dictionary.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/foam/foam_fluid_engine.hpp"
#include "solver/foam/session/foam_session.hpp"
#include "solver/foam/tests/tiny_case.hpp"

#include "Pstream.H"

namespace cutterflow::foam {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

testing::TinyCase case_with(const std::string& name, const std::string& text) {
    testing::Box box;
    for (int& cells : box.cells) cells = 2;
    testing::TinyCase tiny = testing::laminar_case(name, testing::block_mesh(box), 1e-3, 1e-3);
    if (!text.empty()) tiny.files["constant/couplingProperties"] = text;
    tiny.files["constant/g"] = "dimensions [0 1 -2 0 0 0 0]; value (6.9 0 -6.9);";
    return tiny;
}

CouplingDictionary read(const testing::TinyCase& tiny) {
    FoamSession session(testing::build_case(tiny));
    return read_coupling_dictionary(session);
}

CouplingDictionary read(const std::string& name, const std::string& text) {
    return read(case_with(name, text));
}

/// The mistakes for which a case is refused; none when it is not.
template <class Action>
std::vector<std::string> mistakes_of(Action action) {
    std::vector<std::string> texts;
    try {
        action();
    } catch (const UserError& error) {
        for (const Mistake& mistake : error.mistakes()) texts.push_back(mistake.text());
    }
    return texts;
}

/// The mistakes of a decomposed case after `spoil(path of constant/couplingProperties)`.
template <class Spoil>
std::vector<std::string> mistakes_after(const std::string& name, Spoil spoil) {
    const std::filesystem::path folder = testing::build_case(case_with(name, ""));
    if (Foam::UPstream::master()) spoil(folder / "constant/couplingProperties");
    FoamSession session(folder);
    return mistakes_of([&] { read_coupling_dictionary(session); });
}

/// ":n" as in a message. Only the rank that reads a file knows its lines, and only that rank's messages are told.
std::string line(int number) {
    return Foam::UPstream::master() ? ":" + std::to_string(number) : "";
}

const char* const k_fates = R"(
fates { contour "c.csv"; ringRadius 0.4; zBackplate 0.03; binWidth 0.03; mouth { centre (0 0 0); direction (0 0 1); radius 0.1; depth 0.2; } }
)";

template <class Settings>
void expect_same(const Settings& found, const Settings& written) {
    for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>())
        EXPECT_EQ(setting.value_in(found), setting.value_in(written)) << setting.parameter.key;
}

const char* const k_complete = R"(
patches { outlet suction_end; steel (cutter "backplate"); }
soil { surface "constant/triSurface/bank.stl"; permeability 1e-9; }
rock
{
    feed "constant/rockFeed.csv";
    contact { youngsModulus 1.1e8; poissonRock 0.25; poissonSteel 0.3; wetRestitution false; timeStepFraction 0.05; maxSpeed 4;
              rollingLaw constant; pairs { rock_steel { friction 0.2; restitution 0.9; rollingFriction 0.3; } rock_soil { friction 0.7; } } }
    walls
    (
        { name cutter; file "constant/triSurface/cutter_dem.stl"; rotating true; }
        { name backplate; file "constant/triSurface/backplate_dem.stl"; rotating no; }
        { name bank; file "constant/triSurface/bank_dem.stl"; rotating no; material soil; }
    );
    domain { type cylinder; axisPoint (0.1 0 0); radius 2.5; zMin -0.875; zMax 0.435; walls (zMin); }
}
kernel { map cluster; sampling quadratic; clusterSize 0.06; gamma 1.25; minWidthInCells 2; maxSolidFraction 0.6; }
closures { drag brown_lawler; hindrance di_felice; addedMass 0.4; dragModifier 1.1; sphericity 0.8; lift mei; viscousForce no; }
fates
{
    contour "constant/contour.csv"; ringRadius 0.4; zBackplate 0.03; hysteresis 0.2;
    mouth { centre (0.22 0 0.05); direction (0 0 1); radius 0.1; depth 0.2; }
    binWidth 0.03;
}
outflow { offset 0.015; startTime 1; }
velocity { startTime 1.5; interval 2; blades 6; sets ( { name adv; file "constant/samples/adv.csv"; phases 12; } ); }
stop { undecided 0.05; }
checkpoint { interval 0.25; keep 3; }
)";

TEST(CouplingDictionary, ReadsEveryKeyOfTheContract) {
    const CouplingDictionary read_back = read("dictionary_complete", k_complete);
    const coupling::CouplingSettings& c = read_back.coupling;
    EXPECT_TRUE(c.has_rock);
    ASSERT_TRUE(c.soil.has_value());
    EXPECT_THAT(c.soil->surface.string(), HasSubstr("dictionary_complete"));
    EXPECT_DOUBLE_EQ(c.soil->permeability, 1e-9);
    EXPECT_TRUE(c.rock_feed.is_absolute());
    EXPECT_THAT(c.rock_feed.string(), HasSubstr("dictionary_complete"));
    EXPECT_EQ(c.rock_feed.string().find("processor"), std::string::npos);
    EXPECT_EQ(c.kernel.map, "cluster");
    EXPECT_EQ(c.kernel.sampling, "quadratic");
    EXPECT_DOUBLE_EQ(c.kernel.cluster_size, 0.06);
    EXPECT_DOUBLE_EQ(c.kernel.gamma, 1.25);
    EXPECT_DOUBLE_EQ(c.kernel.min_width_in_cells, 2.0);
    EXPECT_DOUBLE_EQ(c.kernel.max_solid_fraction, 0.6);
    EXPECT_EQ(c.closures.drag, "brown_lawler");
    EXPECT_EQ(c.closures.hindrance, "di_felice");
    EXPECT_DOUBLE_EQ(c.closures.added_mass, 0.4);
    EXPECT_DOUBLE_EQ(c.closures.drag_modifier, 1.1);
    EXPECT_DOUBLE_EQ(c.closures.sphericity, 0.8);
    EXPECT_EQ(c.closures.lift, "mei");
    EXPECT_FALSE(c.closures.viscous_force);
    ASSERT_TRUE(c.fates && c.outflow && c.stop && c.checkpoint);
    EXPECT_EQ(c.fates->contour.filename(), "contour.csv");
    EXPECT_DOUBLE_EQ(c.fates->hysteresis, 0.2);
    EXPECT_EQ(c.fates->mouth.centre, Vec3(0.22, 0.0, 0.05));
    EXPECT_DOUBLE_EQ(c.fates->mouth.depth, 0.2);
    EXPECT_DOUBLE_EQ(c.outflow->start_time, 1.0);
    ASSERT_TRUE(c.velocity);
    EXPECT_DOUBLE_EQ(c.velocity->start_time, 1.5);
    EXPECT_DOUBLE_EQ(c.velocity->interval, 2.0);
    EXPECT_EQ(c.velocity->blades, 6);
    ASSERT_EQ(c.velocity->sets.size(), 1u);
    EXPECT_EQ(c.velocity->sets[0].name, "adv");
    EXPECT_EQ(c.velocity->sets[0].file.filename(), "adv.csv");
    EXPECT_EQ(c.velocity->sets[0].phases, 12);
    EXPECT_DOUBLE_EQ(c.stop->undecided, 0.05);
    EXPECT_EQ(c.checkpoint->keep, 3);

    ASSERT_TRUE(read_back.dem);
    EXPECT_DOUBLE_EQ(read_back.dem->contact.youngs_modulus, 1.1e8);
    EXPECT_DOUBLE_EQ(read_back.dem->contact.poisson_steel, 0.3);
    EXPECT_FALSE(read_back.dem->contact.wet_restitution);
    EXPECT_EQ(read_back.dem->contact.rolling_law, "constant");
    expect_same(read_back.dem->contact.rock_steel, {0.2, 0.9, 0.3});
    expect_same(read_back.dem->contact.rock_soil, {0.7, 0.97, 0.15});
    expect_same(read_back.dem->contact.rock_rock, coupling::PairSettings{});
    ASSERT_EQ(read_back.dem->walls.size(), 3u);
    EXPECT_EQ(read_back.dem->walls[0].material, coupling::k_steel);
    EXPECT_EQ(read_back.dem->walls[2].material, coupling::k_soil);
    EXPECT_EQ(read_back.dem->walls[0].name, "cutter");
    EXPECT_TRUE(read_back.dem->walls[0].rotating);
    EXPECT_FALSE(read_back.dem->walls[1].rotating);
    const coupling::DomainSettings& domain = read_back.dem->domain;
    EXPECT_EQ(domain.shape, coupling::DomainShape::cylinder);
    EXPECT_EQ(domain.axis_point, Vec3(0.1, 0.0, 0.0));
    EXPECT_DOUBLE_EQ(domain.radius, 2.5);
    EXPECT_DOUBLE_EQ(domain.lower.z(), -0.875);
    EXPECT_DOUBLE_EQ(domain.upper.z(), 0.435);
    EXPECT_TRUE(domain.is_wall(coupling::DomainSide::z_min));
    EXPECT_FALSE(domain.is_wall(coupling::DomainSide::z_max));
    EXPECT_EQ(c.patches.outlet, "suction_end");
    EXPECT_THAT(c.patches.steel, ElementsAre("cutter", "backplate"));
    EXPECT_EQ(read_back.dem->gravity, Vec3(6.9, 0.0, -6.9));
    EXPECT_DOUBLE_EQ(read_back.dem->added_mass, 0.4);
    EXPECT_DOUBLE_EQ(read_back.dem->fluid.density, 1000.0);
    EXPECT_DOUBLE_EQ(read_back.dem->fluid.kinematic_viscosity, 1e-6);
}

/// Numbers of a setting that are hard to write down and allowed: its bounds, or what is next to them, and a third between them.
std::vector<double> awkward_numbers(const Parameter& parameter) {
    const double least = parameter.minimum_excluded ? 1e-12 : parameter.minimum.value(), most = parameter.maximum.value_or(1e9);
    return {least, most, least + (most - least) / 3.0};
}

/// The keys of `settings` with the shortest text of each number that reads back the same, as a case's writer has them.
template <class Settings>
std::string text_of(const Settings& settings) {
    std::string text;
    for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>())
        std::visit([&](auto member) { text += fmt::format("{} {}; ", setting.parameter.key, settings.*member); }, setting.member);
    return text;
}

template <class Settings>
std::string text_of(const std::optional<Settings>& settings) {
    return settings ? text_of(*settings) : "";
}

/// Fills the numbers of `settings` with their `choice`-th awkward number. \return their text
template <class Settings>
std::string section_of(Settings& settings, std::size_t choice) {
    for (const coupling::Setting<Settings>& setting : coupling::setting_table<Settings>())
        if (setting.parameter.kind == ParameterKind::number) setting.assign(settings, awkward_numbers(setting.parameter)[choice]);
    return text_of(settings);
}

/// As above, of settings that exist only with their section: they are there then.
template <class Settings>
std::string section_of(std::optional<Settings>& settings, std::size_t choice) {
    return section_of(settings.emplace(), choice);
}

/// A case with rock, pairs of materials and all that other sections need.
std::string with_rock(const std::string& contact, const std::string& pairs, const std::string& sections) {
    return fmt::format(
        "rock {{ feed \"f.csv\"; contact {{ {} pairs {{ {} }} }} domain {{ type box; lower (0 0 0); upper (1 1 1); }} }} {} {}", contact,
        pairs, k_fates, sections);
}

const char* const k_plain_contact = "youngsModulus 1e8; maxSpeed 1;";

TEST(CouplingDictionary, GivesBackEverySettingThatWasWritten) {
    for (const std::size_t choice : {0, 1, 2}) {
        coupling::ContactSettings contact;
        coupling::PairSettings rock_rock, rock_steel = contact.rock_steel, rock_soil = contact.rock_soil;
        coupling::CouplingSettings written;
        const std::string contact_keys = section_of(contact, choice);
        const std::string pairs = fmt::format("rock_rock {{ {} }} rock_steel {{ {} }} rock_soil {{ {} }}", section_of(rock_rock, choice),
                                              section_of(rock_steel, (choice + 1) % 3), section_of(rock_soil, (choice + 2) % 3));
        std::string sections = fmt::format("outflow {{ {} }} stop {{ {} }} checkpoint {{ {} }} ", section_of(written.outflow, choice),
                                           section_of(written.stop, choice), section_of(written.checkpoint, choice));
        // Any end is later than this start.
        sections += fmt::format("record {{ {} startTime 0; }}", section_of(written.record, choice));
        written.record->start_time = 0.0;
        const CouplingDictionary found = read("dictionary_round_trip_" + std::to_string(choice), with_rock(contact_keys, pairs, sections));
        ASSERT_TRUE(found.dem);
        expect_same(found.dem->contact, contact);
        expect_same(found.dem->contact.rock_rock, rock_rock);
        expect_same(found.dem->contact.rock_steel, rock_steel);
        expect_same(found.dem->contact.rock_soil, rock_soil);
        EXPECT_EQ(text_of(found.coupling.outflow), text_of(written.outflow));
        EXPECT_EQ(text_of(found.coupling.stop), text_of(written.stop));
        EXPECT_EQ(text_of(found.coupling.checkpoint), text_of(written.checkpoint));
        EXPECT_EQ(text_of(found.coupling.record), text_of(written.record));
    }
}

TEST(CouplingDictionary, GivesBackEverySettingOfRockInAFluid) {
    for (const std::size_t choice : {0, 1, 2}) {
        coupling::CouplingSettings written;
        if (choice > 0) written.kernel.map = coupling::k_cluster_map;  // the only one with a size above 0
        coupling::visit_coupling_sections(written, [&](const std::string& key, auto& section) {
            const std::string text = section_of(section, choice);
            const CouplingDictionary found = read(fmt::format("dictionary_round_trip_{}_{}", key, choice),
                                                  with_rock(k_plain_contact, "", fmt::format("{} {{ {} }}", key, text)));
            coupling::visit_coupling_sections(found.coupling, [&](const std::string& name, const auto& values) {
                if (name == key) EXPECT_EQ(text_of(values), text) << key;
            });
        });
    }
}

TEST(CouplingDictionary, IsAPureFlowWithoutTheFile) {
    const CouplingDictionary read_back = read("dictionary_absent", "");
    EXPECT_FALSE(read_back.coupling.has_rock);
    EXPECT_FALSE(read_back.dem);
    EXPECT_FALSE(read_back.coupling.checkpoint);
}

TEST(CouplingDictionary, RefusesAFileThatIsNoDictionary) {
    const auto write = [](const std::string& text) {
        return [text](const std::filesystem::path& file) { std::ofstream(file, std::ios::binary) << text; };
    };
    const auto refused =
        ElementsAre(AllOf(HasSubstr("constant/couplingProperties: this is no OpenFOAM dictionary"), HasSubstr("FoamFile")));
    EXPECT_THAT(mistakes_after("no_dictionary_header", write("rock { }\n")), refused);
    EXPECT_THAT(mistakes_after("no_dictionary_empty", write("")), refused);
    EXPECT_THAT(mistakes_after("no_dictionary_bytes", write(std::string("\x01\xfe\x00\x9c{\x80", 6))), refused);
    EXPECT_THAT(mistakes_after("no_dictionary_folder", [](const std::filesystem::path& file) { std::filesystem::create_directory(file); }),
                refused);
    EXPECT_THAT(mistakes_after("no_dictionary_class",
                               write("FoamFile { version 2.0; format ascii; class volScalarField; object couplingProperties; }\n")),
                refused);
}

TEST(CouplingDictionary, NamesWrongValuesBesideWrongKeys) {
    testing::TinyCase tiny = case_with("dictionary_values", R"(
rock
{
    feed "f.csv";
    contact { youngModulus 1e8; maxSpeed -1; poissonRock 0.7; }
    domain { type box; lower (0 0 1); upper (1 1 0);
             walls (xMin qMax); }
}
closures { drag brownlawler; addedMass -1; }
stop { undecided 0.1; }
)");
    tiny.files["constant/transportProperties"] = "transportModel Newtonian;\nnu 0;\nrho -5;\n";
    tiny.files["system/controlDict"] += "maxCo -1; maxDeltaT none;";
    const auto about = [](const std::string& file, int number, const std::string& what) {
        return AllOf(::testing::StartsWith(file + line(number)), HasSubstr(what));
    };
    const std::string coupling = "constant/couplingProperties", transport = "constant/transportProperties";
    EXPECT_THAT(
        mistakes_of([&] { read(tiny); }),
        ::testing::UnorderedElementsAre(
            AllOf(::testing::StartsWith("system/controlDict"), HasSubstr("maxCo = -1")),
            AllOf(::testing::StartsWith("system/controlDict"), HasSubstr("maxDeltaT = none")),
            about(coupling, 6, "youngModulus is unknown"), about(coupling, 6, "youngsModulus is missing"),
            about(coupling, 6, "rock.contact.maxSpeed = -1"), about(coupling, 6, "rock.contact.poissonRock = 0.7"),
            about(coupling, 7, "z from 1 to 0"), about(coupling, 8, "qMax is no side"),
            about(coupling, 10, "closures.drag = \"brownlawler\""), about(coupling, 10, "closures.addedMass = -1"),
            about(coupling, 11, "section stop without section fates"), about(transport, 3, "nu = 0"), about(transport, 4, "rho = -5")));
}

TEST(CouplingDictionary, NamesWrongValuesOfPairsAndWhatTookThePlaceOfFormerKeys) {
    const auto mistakes = mistakes_of([&] {
        read("dictionary_pairs", R"(
rock
{
    feed "f.csv";
    contact { youngsModulus 1e8; maxSpeed 1; friction 0.2;
              pairs
              {
                  rock_rock { friction -1; }
                  rock_steel { rollingFriction 11; }
                  steel_steel { friction 0.1; }
              }
            }
    domain { type box; lower (0 0 0); upper (1 1 1); }
}
)");
    });
    const std::string file = "constant/couplingProperties";
    EXPECT_THAT(mistakes,
                ::testing::UnorderedElementsAre(
                    AllOf(::testing::StartsWith(file + line(6)), HasSubstr("rock.contact.friction is no key of this version"),
                          HasSubstr("pairs { rock_rock { friction ...; } rock_steel { friction ...; } }")),
                    AllOf(::testing::StartsWith(file + line(9)), HasSubstr("rock.contact.pairs.rock_rock.friction = -1")),
                    AllOf(::testing::StartsWith(file + line(10)), HasSubstr("rock.contact.pairs.rock_steel.rollingFriction = 11")),
                    AllOf(::testing::StartsWith(file + line(11)), HasSubstr("rock.contact.pairs.steel_steel is unknown"))));
}

const char* const k_room = R"(
medium none;
rock
{
    feed "f.csv";
    contact { youngsModulus 1e8; maxSpeed 1; wetRestitution false;
              pairs { rock_perspex { friction 0.2; restitution 0.8; rollingFriction 0.02; } rock_glass { friction 0.1; } } }
    walls
    (
        { name tube; file "tube.stl"; material perspex; travel { velocity (0 0 0.1); from 0.5; to 2; } removedAt 3; }
        { name gate; file "gate.stl"; travel ( { velocity (0 0 1); from 0; to 1; } { velocity (0 0 -2); from 1; to 1.5; } ); }
        { name plate; file "plate.stl"; turn { origin (0 0 1); axis (0 2 0); speed -3; from 0; to 4; } }
        { name lid; file "lid.stl"; press { direction (0 0 -2); force 8; speed 0.05; } }
    );
    domain { type box; lower (0 0 0); upper (1 1 1); walls (xMin xMax zMin); frictionless (xMin xMax); material glass; }
}
)";

TEST(CouplingDictionary, ReadsMaterialsByNameAndWallsThatTravelAndGo) {
    const coupling::DemSettings dem = *read("dictionary_room", k_room).dem;
    ASSERT_EQ(dem.walls.size(), 4u);
    ASSERT_EQ(dem.walls[0].travels.size(), 1u);
    EXPECT_EQ(dem.walls[0].material, "perspex");
    EXPECT_EQ(dem.walls[0].travels[0].velocity, Vec3(0, 0, 0.1));
    EXPECT_EQ(dem.walls[0].travels[0].begin, 0.5);
    EXPECT_EQ(dem.walls[0].travels[0].end, 2.0);
    EXPECT_EQ(dem.walls[0].removed_at, 3.0);
    EXPECT_FALSE(dem.walls[0].rotating);
    EXPECT_EQ(dem.walls[0].turn.speed, 0.0);
    ASSERT_EQ(dem.walls[1].travels.size(), 2u);
    EXPECT_EQ(dem.walls[1].travels[1].velocity, Vec3(0, 0, -2));
    EXPECT_EQ(dem.walls[1].travels[1].begin, 1.0);
    EXPECT_EQ(dem.walls[2].turn.axis.origin, Vec3(0, 0, 1));
    EXPECT_EQ(dem.walls[2].turn.axis.direction, Vec3::UnitY());
    EXPECT_EQ(dem.walls[2].turn.angle(9.0), -12.0);
    EXPECT_FALSE(dem.walls[2].press);
    ASSERT_TRUE(dem.walls[3].press);
    EXPECT_EQ(dem.walls[3].press->direction, Vec3(-Vec3::UnitZ()));
    EXPECT_EQ(dem.walls[3].press->force, 8.0);
    EXPECT_EQ(dem.walls[3].press->largest_speed, 0.05);
    EXPECT_EQ(dem.walls[2].turn.spin_at(9.0), Vec3(Vec3::Zero()));
    EXPECT_EQ(dem.walls[2].material, "steel");
    EXPECT_FALSE(std::isfinite(dem.walls[2].removed_at));
    expect_same(*dem.contact.pair_on("perspex"), {0.2, 0.8, 0.02});
    expect_same(*dem.contact.pair_on("glass"), {0.1, 0.97, 0.1});
    expect_same(*dem.contact.pair_on("steel"), {0.35, 0.97, 0.1});
    EXPECT_EQ(dem.contact.pair_on("wood"), nullptr);
    EXPECT_EQ(dem.domain.material, "glass");
    EXPECT_EQ(dem.domain.side_is_frictionless, (std::array<bool, 6>{true, true, false, false, false, false}));
}

TEST(CouplingDictionary, ReadsEventsGatesStopRulesAndTheStart) {
    std::string text = k_room;
    text.replace(text.find("feed \"f.csv\";"), 13, "start \"bed/checkpoints/0.5\";");
    const coupling::CouplingSettings c = read("dictionary_events", text + R"(
events
(
    { do remove; at 0; region { type box; lower (0 0 0); upper (1 1 1); } }
    { do freeze; at 0.1; region { type everything; } }
    { do thaw; at 0.2; region { type halfSpace; point (0 0 1); normal (0 0 2); } }
    { do extract; from 0.3; to 1; rate 0.05; region { type cylinder; from (0 0 0); to (0 0 1); radius 0.2; } }
    { do remove; at 0.5; region { type sphere; centre (1 2 3); radius 0.25; } }
);
gates ( { name outlet; centre (0 0 0.1); normal (0 0 -1); radius 0.05; } { name slot; lower (0 0 0); upper (1 1 0); normal (0 0 1); } );
stop { atRest { energy 1e-5; hold 0.1; from 2.5; } idle { gate outlet; duration 5; }
       below { gate slot; rate 0.05; window 2; } }
)")
                                             .coupling;
    EXPECT_EQ(c.rock_start.filename(), "0.5");
    EXPECT_TRUE(c.rock_feed.empty());
    ASSERT_EQ(c.operations.size(), 5u);
    EXPECT_EQ(c.operations[1].kind, coupling::OperationKind::freeze);
    EXPECT_EQ(c.operations[1].begin, 0.1);
    EXPECT_EQ(std::get<BoxRegion>(c.operations[0].region).upper, Vec3(1, 1, 1));
    EXPECT_TRUE(std::holds_alternative<EverywhereRegion>(c.operations[1].region));
    EXPECT_EQ(std::get<HalfSpaceRegion>(c.operations[2].region).normal, Vec3(0, 0, 2));
    EXPECT_EQ(c.operations[3].kind, coupling::OperationKind::extract);
    EXPECT_EQ(c.operations[3].begin, 0.3);
    EXPECT_EQ(c.operations[3].end, 1.0);
    EXPECT_EQ(c.operations[3].rate, 0.05);
    EXPECT_EQ(std::get<CylinderRegion>(c.operations[3].region).to, Vec3(0, 0, 1));
    EXPECT_EQ(std::get<SphereRegion>(c.operations[4].region).centre, Vec3(1, 2, 3));
    ASSERT_EQ(c.gates.size(), 2u);
    EXPECT_EQ(c.gates[0].radius, 0.05);
    EXPECT_EQ(c.gates[1].rectangle->upper, Vec3(1, 1, 0));
    ASSERT_TRUE(c.at_rest && c.idle);
    EXPECT_EQ(c.at_rest->energy, 1e-5);
    EXPECT_EQ(c.at_rest->speed, 0.01);
    EXPECT_EQ(c.at_rest->hold, 0.1);
    EXPECT_EQ(c.at_rest->from, 2.5);
    EXPECT_EQ(c.idle->gate, "outlet");
    EXPECT_EQ(c.idle->duration, 5.0);
    ASSERT_TRUE(c.below);
    EXPECT_EQ(c.below->gate, "slot");
    EXPECT_EQ(c.below->rate, 0.05);
    EXPECT_EQ(c.below->window, 2.0);
    EXPECT_FALSE(c.stop);
}

TEST(CouplingDictionary, NamesWhatIsWrongWithEventsAndGates) {
    EXPECT_THAT(mistakes_of([&] {
                    read("dictionary_events_wrong", std::string(k_room) + R"(
events ( { do melt; at 0; region { type ball; } } { do remove; region { type everything; } } );
gates ( { name a; centre (0 0 0); normal (0 0 1); } );
)");
                }),
                ::testing::UnorderedElementsAre(HasSubstr("events.do = melt"), HasSubstr("events.region.type = ball"),
                                                HasSubstr("events.at is missing"), HasSubstr("gates.radius is missing"),
                                                HasSubstr("gates.a.radius = 0")));
}

TEST(CouplingDictionary, NamesTheMaterialsWithoutAPairAndPairsOfNoWall) {
    std::string text = k_room;
    const auto replace = [&](const std::string& what, const std::string& with) { text.replace(text.find(what), what.size(), with); };
    replace("rock_perspex", "rock_perspexx");
    replace("material glass", "material wood");
    replace("frictionless (xMin xMax)", "frictionless (xMin yMax)");
    replace("name plate", "name tube");
    replace("to 2;", "to 0.4;");
    replace("from 1;", "from 0.9;");
    const auto names = [](const char* a, const char* b) { return AllOf(HasSubstr(a), HasSubstr(b)); };
    EXPECT_THAT(mistakes_of([&] { read("dictionary_room_mistakes", text); }),
                ::testing::UnorderedElementsAre(
                    names("pairs.rock_perspexx is unknown", "Did you mean rock_perspex?"), HasSubstr("pairs.rock_glass is unknown"),
                    names("tube.material = perspex", "rock_perspex"), names("domain.material = wood", "Add rock_wood"),
                    HasSubstr("frictionless: yMax is no wall"), HasSubstr("tube is defined twice"),
                    HasSubstr("tube.travel: from 0.5 to 0.4"), names("gate.travel: from 0.9 on", "one velocity at a time")));
}

TEST(CouplingDictionary, NamesAMissingFileOfRockAsAMistake) {
    testing::TinyCase tiny = case_with("dictionary_no_g", k_complete);
    tiny.files.erase("constant/g");
    EXPECT_THAT(mistakes_of([&] { read(tiny); }), ElementsAre(AllOf(HasSubstr("constant/g"), HasSubstr("missing"))));
}

const char* const k_dry = R"(
medium none;
rock
{
    feed "f.csv";
    contact { youngsModulus 1e8; maxSpeed 1; wetRestitution false; }
    domain { type box; lower (0 0 0); upper (1 1 1); walls (zMin); }
}
)";

const char* const k_rock_with_shapes = R"(
rock
{
    feed "feed.csv";
    contact { youngsModulus 1e7; poissonRock 0.3; poissonSteel 0.3; wetRestitution true; maxSpeed 1; }
    walls ();
    shapes { flat { file "flat.clump"; } lump { file "lump.clump"; } }
    domain { type box; lower (0 0 0); upper (1 1 1); walls (zMin); }
}
)";

TEST(CouplingDictionary, ReadsShapesOfRock) {
    testing::TinyCase tiny = case_with("shapes", k_rock_with_shapes);
    tiny.files["constant/transportProperties"] = "transportModel Newtonian; nu 1e-6; rho 1000;";
    const std::filesystem::path folder = testing::build_case(tiny);
    if (Foam::UPstream::master()) {
        const std::string sphere = "[[sphere]]\nx_m = {}\ny_m = 0.0\nz_m = 0.0\nradius_m = 2.0\n";
        std::ofstream(folder / "flat.clump") << "sphericity = 0.8\n" << fmt::format(sphere, 0.0) << fmt::format(sphere, 1.0);
        std::ofstream(folder / "lump.clump") << fmt::format(sphere, 0.0) << fmt::format(sphere, 1.0) << fmt::format(sphere, 2.0);
    }
    bool there = true;
    Foam::Pstream::scatter(there);
    FoamSession session(folder);
    const CouplingDictionary found = read_coupling_dictionary(session);
    ASSERT_EQ(found.dem->shapes.size(), 2u);
    EXPECT_EQ(found.dem->shapes[0].name, "flat");
    EXPECT_EQ(found.dem->shapes[0].clump.sphericity, 0.8);
    EXPECT_EQ(found.dem->shapes[1].clump.balls.size(), 3u);
    EXPECT_FALSE(found.dem->shapes[1].clump.sphericity);
    EXPECT_EQ(found.coupling.shapes.size(), 2u);
}

TEST(CouplingDictionary, NamesMistakesOfShapesBesideOthers) {
    testing::TinyCase tiny = case_with("wrong_shapes", k_rock_with_shapes);
    tiny.files["constant/transportProperties"] = "transportModel Newtonian; nu 1e-6; rho -1;";
    const std::filesystem::path folder = testing::build_case(tiny);
    FoamSession session(folder);
    const auto mistakes = mistakes_of([&] { read_coupling_dictionary(session); });
    EXPECT_EQ(std::count_if(mistakes.begin(), mistakes.end(), [](const std::string& text) { return text.find(".clump") != text.npos; }), 2);
    EXPECT_GE(mistakes.size(), 3u);
}

TEST(CouplingDictionary, ReadsNoFluidWithoutAMedium) {
    testing::TinyCase tiny = case_with("dictionary_dry", k_dry);
    tiny.files.erase("constant/transportProperties");
    const CouplingDictionary found = read(tiny);
    EXPECT_FALSE(found.coupling.has_medium);
    EXPECT_EQ(found.dem->fluid.density, 0.0);
    EXPECT_EQ(found.dem->gravity, Vec3(6.9, 0.0, -6.9));
}

TEST(CouplingDictionary, CalmsRockWithoutAMediumOnly) {
    std::string text = k_dry;
    text.replace(text.find("feed"), 0, "calming { speed 0.01; time 0.05; }\n    ");
    testing::TinyCase tiny = case_with("dictionary_calming", text);
    tiny.files.erase("constant/transportProperties");
    const CouplingDictionary found = read(tiny);
    ASSERT_TRUE(found.coupling.calming);
    EXPECT_EQ(found.coupling.calming->speed, 0.01);
    EXPECT_EQ(found.coupling.calming->time, 0.05);
    text.erase(text.find("medium none;"), 12);
    EXPECT_THAT(mistakes_of([&] { read("dictionary_calming_wet", text); }), ElementsAre(HasSubstr("rock.calming with a medium")));
}

TEST(CouplingDictionary, RefusesWhatNeedsAFluidWithoutAMedium) {
    std::string text = k_dry;
    text.replace(text.find("false"), 5, "true");
    EXPECT_THAT(
        mistakes_of([&] {
            read("dictionary_wet",
                 text + "kernel { gamma 2; }\nclosures { addedMass 0; }\nrecord { startTime 1; endTime 2; blades 6; }\nlargestSpeed 9;");
        }),
        ::testing::UnorderedElementsAre(HasSubstr("wet restitution with density 0"), HasSubstr("kernel with medium none"),
                                        HasSubstr("closures with medium none"), HasSubstr("section record with medium none"),
                                        HasSubstr("largestSpeed with medium none")));
    EXPECT_THAT(mistakes_of([&] { read("dictionary_air", "medium air;"); }), ElementsAre(HasSubstr("medium = air")));
}

TEST(CouplingDictionary, BoundsTheSpeedOfTheFluidOnRequest) {
    EXPECT_FALSE(read("no_largest_speed", "").coupling.largest_speed);
    EXPECT_EQ(read("largest_speed", "largestSpeed 22.5;").coupling.largest_speed, 22.5);
    EXPECT_THAT(mistakes_of([&] { read("largest_speed_zero", "largestSpeed 0;"); }), ElementsAre(HasSubstr("largestSpeed = 0")));
}

TEST(CouplingDictionary, RefusesTimeStepsThatAreNotAboveZeroInAPureFlow) {
    testing::TinyCase tiny = case_with("control_values", "");
    tiny.files["system/controlDict"] += "deltaT 0; maxCo abc; maxDeltaT -2;";
    EXPECT_THAT(mistakes_of([&] { read(tiny); }),
                ElementsAre(HasSubstr("deltaT = 0"), HasSubstr("maxCo = abc"), HasSubstr("maxDeltaT = -2")));
}

TEST(CouplingDictionary, LetsNothingDeleteTheFieldsOfACheckpoint) {
    testing::TinyCase tiny = case_with("purged", "checkpoint { interval 0.25; }");
    tiny.files["system/controlDict"] += "purgeWrite 1;";
    EXPECT_THAT(mistakes_of([&] { read(tiny); }), ElementsAre(HasSubstr("purgeWrite = 1 with section checkpoint")));
    testing::TinyCase without = case_with("purged_without", "");
    without.files["system/controlDict"] += "purgeWrite 1;";
    EXPECT_NO_THROW(read(without));
}

/// What OpenFOAM itself refuses may strike the reading rank alone: only on one rank can a test go on from there.
TEST(CaseErrors, OfOpenFoamAreTheUsersAndKeepItsText) {
    if (Foam::UPstream::parRun()) GTEST_SKIP() << "serial";
    const auto unclosed = mistakes_of([] { read("case_unclosed", "rock { feed \"f.csv\";"); });
    EXPECT_THAT(unclosed, ElementsAre(AllOf(HasSubstr("constant/couplingProperties:"), HasSubstr("cannot use what stands here"),
                                            HasSubstr("Unexpected EOF"))));
    const std::filesystem::path folder = testing::build_case(case_with("case_no_mesh", ""));
    std::filesystem::remove_all(folder / "constant/polyMesh");
    FoamSession session(folder);
    EXPECT_THAT(mistakes_of([&] { session.mesh(); }), ElementsAre(AllOf(HasSubstr("blockMesh"), HasSubstr("points"))));
    EXPECT_FALSE(Foam::FatalError.throwing());
    EXPECT_FALSE(Foam::FatalIOError.throwing());
}

TEST(CaseErrors, OfAMissingFieldNameIt) {
    if (Foam::UPstream::parRun()) GTEST_SKIP() << "serial";
    FoamSession session(testing::build_case(case_with("case_no_fields", "")));
    EXPECT_THAT(mistakes_of([&] { FoamFluidEngine(session, false, {}); }), ElementsAre(HasSubstr("0/p")));
}

TEST(CouplingDictionary, NamesEveryMistakeWithItsLine) {
    try {
        read("dictionary_wrong", R"(
kernel { gama 1.0; }
closures { addedMass half; }
outflow { offset 0.015; }
checkpoint { interval 0.25; keep 2.5; }
colour red;
)");
        FAIL() << "accepted";
    } catch (const UserError& error) {
        std::vector<std::string> texts;
        for (const Mistake& mistake : error.mistakes()) texts.push_back(mistake.text());
        EXPECT_THAT(texts, ElementsAre(::testing::AllOf(HasSubstr("couplingProperties" + line(3)), HasSubstr("kernel.gama is unknown"),
                                                        HasSubstr("Did you mean gamma?")),
                                       ::testing::AllOf(HasSubstr(line(4)), HasSubstr("closures.addedMass = half"), HasSubstr("a number")),
                                       ::testing::AllOf(HasSubstr(line(5)), HasSubstr("outflow.startTime is missing")),
                                       ::testing::AllOf(HasSubstr(line(6)), HasSubstr("checkpoint.keep = 2.5"), HasSubstr("whole number")),
                                       ::testing::AllOf(HasSubstr(line(7)), HasSubstr("colour is unknown")),
                                       ::testing::AllOf(HasSubstr(line(5)), HasSubstr("outflow without section fates"))));
    }
}

}  // namespace
}  // namespace cutterflow::foam
