/// Reading scenes: geometry that comes out, and every mistake at once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "solver/free_surface/output/surface_checkpoint.hpp"
#include "solver/free_surface/scene_file/scene_file.hpp"

namespace cutterflow::free_surface {
namespace {

const std::string k_tank = R"(
[domain]
width_m = 0.2
height_m = 0.2
cell_m = 0.001
[run]
end_s = 1.0
)";
const std::string k_fill = "[[fill]]\nfrom_x_m = 0.0\nfrom_z_m = 0.0\nto_x_m = 0.2\nto_z_m = 0.1\n";

std::string mistakes_of(const std::string& toml) {
    try {
        parse_scene(toml, "scene.toml");
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

TEST(SceneFile, reads_a_perforated_pipe_as_walls_with_holes) {
    const Scene scene = parse_scene(k_tank + k_fill + R"(
[[solid]]
kind = "pipe"
axis_x_m = 0.1
inner_width_m = 0.06
wall_m = 0.002
bottom_m = 0.04
top_m = 0.15
hole_m = 0.001
hole_spacing_m = 0.02
)",
                                    "scene.toml");
    EXPECT_EQ(scene.settings.solids.size(), 2u * 6u);  // five holes a side
    ASSERT_EQ(scene.settings.watched_walls.size(), 12u);
    EXPECT_NEAR(scene.settings.watched_walls[1].x, 0.069, 1e-12);
    EXPECT_NEAR(scene.settings.watched_walls[1].from_z, 0.0605, 1e-12);
    EXPECT_NEAR(scene.settings.watched_walls[1].to_z, 0.0795, 1e-12);
    const StaggeredGrid grid = scene.settings.tank.grid();
    const CellCutter cutter(grid, scene.settings.solids);
    double open = 0.0;
    for (int k = 40; k < 150; ++k) open += cutter.still().open[0][grid.at(131, 0, k)];
    EXPECT_NEAR(open, 5.0, 1e-6);
    EXPECT_NEAR(scene.settings.tank.depth, 0.1, 1e-12);
}

TEST(SceneFile, refuses_keys_of_another_kind_of_solid_by_name) {
    const std::string box = "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.1\nfrom_z_m = 0\nto_x_m = 0.2\nto_z_m = 0.1\n";
    const std::string mistakes = mistakes_of(k_tank + k_fill + box + "top_m = 0.3\nhole_m = 0.01\nfile = \"a.stl\"\n");
    for (const char* part : {"solid.top_m = 0.3 for a box. A box has from_x_m, from_z_m, to_x_m, to_z_m, from_y_m, to_y_m. Remove it",
                             "solid.hole_m = 0.01 for a box", "solid.file = \"a.stl\" for a box", "scene.toml:"})
        EXPECT_THAT(mistakes, ::testing::HasSubstr(part));
    EXPECT_EQ(mistakes_of(k_tank + box + k_fill), mistakes_of(k_tank + box + "hole_m = 0\nstart_s = 0\nangle_deg = 45\n" + k_fill))
        << "a study that is written out in full has all defaults";
}

TEST(SceneFile, says_both_ends_of_a_gate_that_is_upside_down) {
    EXPECT_THAT(mistakes_of(k_tank + k_fill +
                            "[[solid]]\nkind = \"gate\"\naxis_x_m = 0.1\nwall_m = 0.004\nbottom_m = 0.1\ntop_m = 0.05\nspeed_m_s = 1\n"),
                ::testing::HasSubstr("solid.top_m = 0.05 m lies below solid.bottom_m = 0.1 m"));
}

TEST(SceneFile, bounds_densities_and_viscosity) {
    const std::string mistakes = mistakes_of(k_tank + k_fill +
                                             "[water]\ndensity_kg_m3 = 1e300\nkinematic_viscosity_m2_s = 1e300\n"
                                             "[[bodies]]\ndiameter_m = 0.01\ndensity_kg_m3 = 1e300\n");
    for (const char* key : {"water.density_kg_m3", "water.kinematic_viscosity_m2_s", "bodies.density_kg_m3"})
        EXPECT_THAT(mistakes, ::testing::HasSubstr(std::string(key) + " = 1e+300 is too high"));
}

TEST(SceneFile, has_the_solvers_bounds_of_friction) {
    const auto mistakes_with = [](const std::string& friction) {
        return mistakes_of(k_tank + k_fill + "[contact]\nfriction = " + friction);
    };
    EXPECT_EQ(mistakes_with("10"), "");
    EXPECT_THAT(mistakes_with("10.1"), ::testing::HasSubstr("contact.friction = 10.1"));
    coupling::DemSettings dem = parse_scene(k_tank + k_fill, "scene.toml").dem;
    dem.contact.rock_rock.friction = 10.1;
    EXPECT_EQ(coupling::check_settings(dem, "").size(), 1u);
}

/// A dam of 0.1 m x 0.1 m in a tank of 0.2 m x 0.2 m, a body in it: counts by hand, a step's cost that grows with each of them.
TEST(SceneFile, predicts_steps_and_cost_from_what_the_scene_holds) {
    const auto predicted = [](const std::string& more) { return predict(parse_scene(k_tank + k_fill + more, "scene.toml")); };
    const ScenePrediction water = predicted("");
    EXPECT_NEAR(water.step, 0.5 * 1e-3 / (2.0 * std::sqrt(9.81 * 0.1)), 1e-9);
    EXPECT_NEAR(water.particles, 4.0 * water.water_cells, 1e-6);
    const ScenePrediction body =
        predicted("[[bodies]]\ndiameter_m = 0.01\ndensity_kg_m3 = 2700.0\nlayers = 1\nwidest = 1\ncentre_x_m = 0.1\nlowest_m = 0.02\n");
    EXPECT_NEAR((body.core_seconds - water.core_seconds) / water.steps, 1e-4, 1e-6);  // ten cells across
    const ScenePrediction twice = predict(parse_scene(k_tank + std::string(k_fill).replace(k_fill.find("0.2"), 3, "0.1"), "scene.toml"));
    const double of_particles = (water.core_seconds - twice.core_seconds) / water.steps / (water.particles - twice.particles);
    EXPECT_NEAR(of_particles, 3.1e-7, 1e-9);
}

/// A particle in space gives to 27 nodes of three directions, in a plane to 9 of two: a step costs more of it.
TEST(SceneFile, predicts_more_for_a_particle_in_space) {
    const auto core_per_particle = [](const std::string& dimensions) {
        const std::string tank = std::string(k_tank).replace(k_tank.find("cell_m"), 0, dimensions);
        const ScenePrediction full = predict(parse_scene(tank + k_fill, "scene.toml"));
        return full.core_seconds / full.steps / full.particles;
    };
    EXPECT_GT(core_per_particle("dimensions = 'space'\nlength_m = 0.01\n"), 1.4 * core_per_particle(""));
}

std::string gate(const std::string& speed, const std::string& bottom = "0.0") {
    return "[[solid]]\nkind = \"gate\"\naxis_x_m = 0.1\nwall_m = 0.002\nbottom_m = " + bottom + "\ntop_m = 0.12\nspeed_m_s = " + speed +
           "\nstart_s = 0.1\n";
}

TEST(SceneFile, reads_a_gate_that_leaves_by_the_top_and_a_wall_without_speed) {
    const Scene moving = parse_scene(k_tank + k_fill + gate("0.5"), "scene.toml");
    ASSERT_EQ(moving.settings.gates.size(), 1u);
    EXPECT_TRUE(moving.settings.solids.empty());
    const Gate& one = moving.settings.gates[0];
    EXPECT_NEAR(one.closed.from.x(), 0.099, 1e-12);
    EXPECT_NEAR(one.closed.to.z(), 0.12, 1e-12);
    EXPECT_NEAR(one.start, 0.1, 1e-12);
    EXPECT_NEAR(one.end, 0.1 + 0.2 / 0.5, 1e-12);
    EXPECT_GT(predict(parse_scene(k_tank + k_fill + gate("5"), "scene.toml")).steps, predict(moving).steps);
    const Scene still = parse_scene(k_tank + k_fill + gate("0"), "scene.toml");
    EXPECT_TRUE(still.settings.gates.empty());
    EXPECT_EQ(still.settings.solids.size(), 1u);
}

TEST(SceneFile, refuses_gates_whose_way_is_not_free) {
    const std::string lid = "[[solid]]\nkind = \"plate\"\nfrom_x_m = 0.05\nfrom_z_m = 0.15\nto_x_m = 0.15\nto_z_m = 0.16\nwall_m = 0.003\n";
    EXPECT_THAT(mistakes_of(k_tank + k_fill + lid + gate("0.5")), ::testing::HasSubstr("meets a solid"));
    const std::string sill = "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.05\nfrom_z_m = 0.0\nto_x_m = 0.15\nto_z_m = 0.02\n";
    EXPECT_EQ(mistakes_of(k_tank + k_fill + sill + gate("0.5", "0.02")), "");
    EXPECT_THAT(mistakes_of(k_tank + k_fill + "[[solid]]\nkind = \"gate\"\n"), ::testing::HasSubstr("solid.speed_m_s is missing"));
    const std::string body = "[[bodies]]\ndiameter_m = 0.01\ncentre_x_m = 0.104\nlowest_m = 0.05\n";
    EXPECT_THAT(mistakes_of(k_tank + k_fill + gate("0.5") + body), ::testing::HasSubstr("stands in a solid"));
}

TEST(SceneFile, refuses_gates_that_meet_each_other_or_a_solid_beside_the_middle) {
    const std::string space = std::string(k_tank).replace(k_tank.find("cell_m"), 0, "dimensions = 'space'\nlength_m = 0.04\n");
    const std::string lid =
        "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.05\nfrom_z_m = 0.15\nto_x_m = 0.15\nto_z_m = 0.16\nfrom_y_m = 0.0\nto_y_m = ";
    EXPECT_THAT(mistakes_of(space + k_fill + gate("0.5") + lid + "0.005\n"),
                ::testing::HasSubstr("The gate at 0.1 m meets a solid at (0.099, 0.0005, 0.15) m"));
    EXPECT_THAT(mistakes_of(k_tank + k_fill + gate("0.5") + gate("0.5")), ::testing::HasSubstr("The gate at 0.1 m meets a solid"));
    EXPECT_EQ(mistakes_of(k_tank + k_fill + gate("0.5")), "") << "it does not meet itself";
}

/// Such a tank would fill the memory; numbers beyond the range of int are counted as well.
TEST(SceneFile, refuses_tanks_of_too_many_cells) {
    const auto mistakes_with = [](const std::string& width, const std::string& more = {}) {
        return mistakes_of(std::string(k_tank).replace(k_tank.find("0.2"), 3, width).insert(k_tank.find("cell_m"), more) + k_fill);
    };
    EXPECT_EQ(mistakes_with("25.0"), "");
    EXPECT_THAT(mistakes_with("25.1"), ::testing::HasSubstr("The tank has 5.02e+06 cells"));
    EXPECT_THAT(mistakes_with("1e300"), ::testing::HasSubstr("at most 5e+06"));
    const std::string space = "dimensions = \"space\"\nlength_m = 0.2\n";
    EXPECT_THAT(mistakes_with("0.2", space), ::testing::HasSubstr("The tank has 8e+06 cells"));
}

TEST(SceneFile, refuses_pipes_outside_and_a_flood_of_pictures) {
    const std::string pipe = "[[solid]]\nkind = \"pipe\"\ninner_width_m = 0.06\nwall_m = 0.002\nbottom_m = 0.04\ntop_m = 0.15\naxis_x_m = ";
    EXPECT_EQ(mistakes_of(k_tank + k_fill + pipe + "0.1\n"), "");
    EXPECT_THAT(mistakes_of(k_tank + k_fill + pipe + "0.5\n"), ::testing::HasSubstr("A pipe from 0.468 to 0.532 m leaves the domain"));
    EXPECT_THAT(mistakes_of(k_tank + "write_interval_s = 1e-12\n" + k_fill), ::testing::HasSubstr("at most 10000 of them"));
}

/// The gauge of a pipe reads the cells from its mouth up.
TEST(SceneFile, refuses_a_pipe_above_the_tank_and_takes_one_that_reaches_out_of_it) {
    const auto pipe = [](const std::string& bottom, const std::string& top) {
        return k_tank + k_fill + "[[solid]]\nkind = \"pipe\"\ninner_width_m = 0.06\nwall_m = 0.002\naxis_x_m = 0.1\nbottom_m = " + bottom +
               "\ntop_m = " + top + "\n";
    };
    EXPECT_THAT(mistakes_of(pipe("0.2", "0.3")),
                ::testing::HasSubstr("solid.bottom_m = 0.2 m lies above the domain. The domain reaches to"));
    EXPECT_EQ(mistakes_of(pipe("0.19", "0.3")), "");
}

TEST(SceneFile, refuses_stacks_of_too_many_bodies) {
    EXPECT_THAT(mistakes_of(k_tank + k_fill +
                            "[[bodies]]\ndiameter_m = 0.01\nlayers = 1000000000\nwidest = 6\ncentre_x_m = 0.1\n"
                            "lowest_m = 0.11\n"),
                ::testing::HasSubstr("a stack of 6e+09 bodies"));
}

TEST(SceneFile, tells_bodies_of_a_stack_that_leave_the_domain_at_once) {
    const std::string mistakes = mistakes_of(k_tank + k_fill +
                                             "[[bodies]]\ndiameter_m = 0.01\nlayers = 6\nwidest = 6\ncentre_x_m = 0.02\nlowest_m = 0.11\n"
                                             "clearance_m = 0.001\n");
    EXPECT_THAT(mistakes, ::testing::ContainsRegex("[0-9]+ of 33 bodies leave the domain; the first, body 1 at \\(-0.0075, 0.115\\) m, by "
                                                   "0.0125 m. The domain reaches to"));
    EXPECT_EQ(mistakes.find("leave the domain"), mistakes.rfind("leave the domain"));
    EXPECT_THAT(mistakes, ::testing::Not(::testing::HasSubstr("leaves the domain")));
}

TEST(SceneFile, stacks_bodies_and_derives_the_gap) {
    const Scene scene = parse_scene(
        k_tank + k_fill + "[[bodies]]\ndiameter_m = 0.01\nlayers = 6\nwidest = 6\ncentre_x_m = 0.1\nlowest_m = 0.11\nclearance_m = 0.001\n",
        "scene.toml");
    EXPECT_EQ(scene.bodies.size(), 33u);
    EXPECT_NEAR(scene.dem.contact_gap, 0.25e-3, 1e-12);
    EXPECT_NEAR((scene.bodies.position[6] - scene.bodies.position[0]).norm(), 0.011, 1e-9);
}

TEST(SceneFile, names_every_mistake_at_once) {
    const std::string text = mistakes_of(k_tank + R"(
[[fill]]
from_x_m = 0.0
from_z_m = 0.0
to_x_m = 0.5
to_z_m = 0.1
[[solid]]
kind = "plate"
from_x_m = 0.0
from_z_m = 0.1
to_x_m = 0.1
to_z_m = 0.1
wall_m = 0.001
[[bodies]]
diameter_m = 0.004
centre_x_m = 0.1
lowest_m = 0.15
layers = 2
widest = 2
[contact]
gap_m = 0.0001
gap_damping = 0.5
damping = 0.8
)");
    for (const char* part : {"to (0.5", "two cells", "4 cells", "quarter of a cell", "without a time", "sqrt(1/2)"})
        EXPECT_THAT(text, ::testing::HasSubstr(part));
}

TEST(SceneFile, refuses_holes_that_close_bodies_that_overlap_and_empty_scenes) {
    EXPECT_THAT(
        mistakes_of(k_tank + k_fill +
                    "[[solid]]\nkind=\"pipe\"\naxis_x_m=0.1\ninner_width_m=0.06\nwall_m=0.002\nbottom_m=0.04\ntop_m=0.15\nhole_m=0.0005\n"),
        ::testing::HasSubstr("would close"));
    EXPECT_THAT(
        mistakes_of(
            k_tank +
            "[[bodies]]\ndiameter_m=0.01\ncentre_x_m=0.1\nlowest_m=0.1\n[[bodies]]\ndiameter_m=0.01\ncentre_x_m=0.105\nlowest_m=0.1\n"),
        ::testing::HasSubstr("overlap"));
    EXPECT_THAT(mistakes_of(k_tank), ::testing::HasSubstr("neither water nor bodies"));
}

std::string box(const std::string& from_x, const std::string& from_z, const std::string& to_x, const std::string& to_z) {
    return "[[solid]]\nkind = \"box\"\nfrom_x_m = " + from_x + "\nfrom_z_m = " + from_z + "\nto_x_m = " + to_x + "\nto_z_m = " + to_z +
           "\n";
}

/// A box that water can stand on both sides of is a wall; a step on the floor, a stair of thin boxes and a thick box are not refused.
TEST(SceneFile, refuses_boxes_that_are_thin_walls) {
    EXPECT_THAT(mistakes_of(k_tank + k_fill + box("0.1", "0.0", "0.1015", "0.1")),
                ::testing::AllOf(::testing::HasSubstr("A box is 0.0015 m thick between water at"), ::testing::HasSubstr("two cells")));
    EXPECT_THAT(mistakes_of(k_tank + k_fill + box("0.05", "0.03", "0.1", "0.0315")), ::testing::HasSubstr("thick between water"));
    EXPECT_EQ(mistakes_of(k_tank + k_fill + box("0.05", "0.0", "0.1", "0.001")), "");
    EXPECT_EQ(mistakes_of(k_tank + k_fill + box("0.05", "0.03", "0.1", "0.032")), "");
    EXPECT_EQ(mistakes_of(k_tank + k_fill + box("0.19", "0.0", "0.191", "0.05") + box("0.191", "0.0", "0.2", "0.05")), "");
}

/// Water would not feel such a box, bodies would.
TEST(SceneFile, refuses_boxes_with_exchanged_corners_and_boxes_outside_the_tank) {
    for (const auto& [from_x, from_z, to_x, to_z] :
         {std::tuple{"0.1", "0.02", "0.05", "0.1"}, {"0.05", "0.1", "0.1", "0.02"}, {"0.05", "0.02", "0.05", "0.1"}})
        EXPECT_THAT(mistakes_of(k_tank + k_fill + box(from_x, from_z, to_x, to_z)),
                    ::testing::AllOf(::testing::HasSubstr("A box from (0."), ::testing::HasSubstr("lower corner must come first")));
    EXPECT_THAT(mistakes_of(k_tank + k_fill + box("0.2", "0.0", "0.3", "0.1")),
                ::testing::HasSubstr("A box from (0.2, 0) m to (0.3, 0.1) m stands outside the domain"));
    EXPECT_THAT(mistakes_of(k_tank + k_fill + box("0.1", "0.2", "0.15", "0.3")), ::testing::HasSubstr("stands outside the domain"));
    EXPECT_EQ(mistakes_of(k_tank + k_fill + box("0.15", "0.0", "0.3", "0.3")), "") << "a part of it stands in the tank";
    const std::string space = std::string(k_tank).replace(k_tank.find("cell_m"), 0, "dimensions = 'space'\nlength_m = 0.04\n");
    EXPECT_THAT(mistakes_of(space + k_fill + box("0.05", "0.0", "0.1", "0.05") + "from_y_m = 0.05\nto_y_m = 0.06\n"),
                ::testing::HasSubstr("A box from (0.05, 0.05, 0) m to (0.1, 0.06, 0.05) m stands outside the domain"));
}

/// Its direction would be none, and it would cover the whole tank.
TEST(SceneFile, refuses_a_plate_shorter_than_a_cell) {
    const auto plate = [](const std::string& to_x) {
        return k_tank + k_fill +
               "[[solid]]\nkind = \"plate\"\nfrom_x_m = 0.05\nfrom_z_m = 0.15\nto_z_m = 0.15\nwall_m = 0.003\nto_x_m = " + to_x + "\n";
    };
    for (const char* end : {"0.05", "0.0509"})
        EXPECT_THAT(mistakes_of(plate(end)), ::testing::AllOf(::testing::HasSubstr("A plate from (0.05, 0.15) to (0.05"),
                                                              ::testing::HasSubstr("at least a cell long")));
    EXPECT_EQ(mistakes_of(plate("0.051")), "");
}

TEST(SceneFile, tells_how_deep_a_body_stands_in_a_solid) {
    const std::string body = "[[bodies]]\ndiameter_m = 0.01\ncentre_x_m = 0.048\nlowest_m = 0.02\n";
    EXPECT_THAT(mistakes_of(k_tank + k_fill + box("0.05", "0.0", "0.1", "0.1") + body),
                ::testing::HasSubstr("Body 1 at (0.048, 0.025) m stands in a solid, 0.003 m deep"));
}

TEST(SceneFile, refuses_water_beyond_the_domain_and_holes_without_wall_between) {
    const auto fill_to = [](const std::string& x) { return std::string(k_fill).replace(k_fill.find("0.2"), 3, x); };
    EXPECT_THAT(mistakes_of(k_tank + fill_to("0.2005")), ::testing::HasSubstr("must lie in the domain"));
    EXPECT_EQ(mistakes_of(k_tank + fill_to("0.2")), "");
    EXPECT_THAT(mistakes_of(k_tank + k_fill +
                            "[[solid]]\nkind=\"pipe\"\naxis_x_m=0.1\ninner_width_m=0.06\nwall_m=0.002\nbottom_m=0.04\ntop_m=0.15\n"
                            "hole_m=0.002\nhole_spacing_m=0.002\n"),
                ::testing::HasSubstr("at least a cell of wall"));
}

/// The tank and its water, with one value changed or lines added.
std::string with(const std::string& key, const std::string& value) {
    const std::size_t at = k_tank.find(key);
    return std::string(k_tank).replace(at, k_tank.find('\n', at) - at, key + " = " + value) + k_fill;
}

std::string body(const std::string& more) {
    return k_tank + k_fill + "[[bodies]]\ncentre_x_m = 0.1\nlowest_m = 0.12\n" + more + "\n";
}

std::string contact(const std::string& key, const std::string& value) {
    return k_tank + k_fill + "[contact]\n" + key + " = " + value + "\n";
}

/// What is wrong in the study beside what is said of it: the value and the rule.
TEST(SceneFile, refuses_what_no_run_could_be_made_of) {
    struct Row {
        std::string toml, value, rule;
    };
    const std::vector<Row> rows{
        {body("diameter_m = 0.004"), "is 4 cells", "at least 5 cells"},
        {body("diameter_m = 0.01\ndensity_kg_m3 = 0.0"), "bodies.density_kg_m3 = 0", "above 0"},
        {body("diameter_m = 0.01\ndensity_kg_m3 = -5.0"), "bodies.density_kg_m3 = -5", "above 0"},
        {body("diameter_m = 0.01\ndensity_kg_m3 = 0.5"), "bodies.density_kg_m3 = 0.5", "a thousandth of the water's density"},
        {contact("gap_damping", "1.5"), "contact.gap_damping = 1.5", "0 to 1"},
        {contact("gap_damping", "-0.1"), "contact.gap_damping = -0.1", "0 to 1"},
        {contact("theta", "0.0"), "contact.theta = 0", "above 0, at most 1"},
        {contact("theta", "1.5"), "contact.theta = 1.5", "above 0, at most 1"},
        {contact("poisson", "-0.1"), "contact.poisson = -0.1", "0 to 0.5"},
        {contact("poisson", "0.6"), "contact.poisson = 0.6", "0 to 0.5"},
        {contact("friction", "-0.1"), "contact.friction = -0.1", "0 to 10"},
        {contact("friction", "11.0"), "contact.friction = 11", "0 to 10"},
        {contact("damping", "-0.1"), "contact.damping = -0.1", "at least 0"},
        {contact("damping", "0.708"), "contact.damping = 0.708", "sqrt(1/2)"},
        {k_tank + k_fill + k_fill, "Water from (0, 0) to (0.2, 0.1) m overlaps another box", "filled in once"},
        {with("end_s", "0.0"), "run.end_s = 0", "above 0"},
        {with("end_s", "0.01"), "run.write_interval_s = 0.02 s", "must not exceed run.end_s"},
        {with("end_s", "1.0\nmax_courant = 1.5"), "run.max_courant = 1.5", "above 0, at most 1"},
    };
    for (const Row& row : rows) {
        EXPECT_THAT(mistakes_of(row.toml), ::testing::AllOf(::testing::HasSubstr(row.value), ::testing::HasSubstr(row.rule))) << row.toml;
    }
}

TEST(SceneFile, tells_rounded_sizes_and_coarse_bodies) {
    struct Row {
        std::string toml, note;
    };
    const std::vector<Row> rows{
        {with("width_m", "0.2004"), "domain.width_m = 0.2004 m is no whole number of cells: 0.2 m is used"},
        {with("height_m", "0.1996"), "domain.height_m = 0.1996 m is no whole number of cells: 0.2 m is used"},
        {body("diameter_m = 0.007"), "bodies have 7 cells across: below 8"},
    };
    for (const Row& row : rows) EXPECT_THAT(parse_scene(row.toml, "scene.toml").notes, ::testing::Contains(::testing::HasSubstr(row.note)));
    EXPECT_THAT(parse_scene(body("diameter_m = 0.008"), "scene.toml").notes,
                ::testing::Not(::testing::Contains(::testing::HasSubstr("across"))));
}

TEST(SceneFile, tells_what_is_closer_than_two_cells) {
    const auto close_in = [](const std::string& toml) { return parse_scene(toml, "scene.toml").close; };
    const std::string pipe =
        "[[solid]]\nkind=\"pipe\"\naxis_x_m=0.1\ninner_width_m=0.06\nwall_m=0.002\nbottom_m=0.04\ntop_m=0.15\n"
        "hole_spacing_m=0.02\nhole_m=";
    EXPECT_THAT(close_in(k_tank + k_fill + pipe + "0.0015\n"),
                ::testing::ElementsAre("closer than two cells: the edges of holes, 0.0015 m = 1.5 cells"));
    EXPECT_THAT(close_in(k_tank + k_fill + pipe + "0.002\n"), ::testing::IsEmpty());
    // Two of three bodies 1.2 mm apart, the last of them 0.5 mm before a box; in another scene the same with room enough.
    const std::string stack = "[[bodies]]\ndiameter_m = 0.01\nwidest = 3\nclearance_m = 0.0012\ncentre_x_m = 0.1\nlowest_m = 0.12\n";
    EXPECT_THAT(close_in(k_tank + k_fill + stack + box("0.1167", "0.0", "0.13", "0.18")),
                ::testing::ElementsAre("closer than two cells: 2 pairs of bodies, closest 1 and 2, 0.0012 m = 1.2 cells apart",
                                       "closer than two cells: 1 bodies and a wall or solid, closest body 3, 0.0005 m = 0.5 cells apart"));
    EXPECT_THAT(close_in(body("diameter_m = 0.01\nwidest = 3\nclearance_m = 0.0021")), ::testing::IsEmpty());
    EXPECT_THAT(close_in(k_tank + k_fill + "[[bodies]]\ndiameter_m = 0.01\ncentre_x_m = 0.1\nlowest_m = 0.001\n"),
                ::testing::ElementsAre("closer than two cells: 1 bodies and a wall or solid, closest body 1, 0.001 m = 1 cells apart"));
}

TEST(SceneFile, gauges_stand_across_in_space_alone) {
    const std::string gauge = "[[gauge]]\nname = 'a'\nx_m = 0.1\ny_m = 0.03\n";
    EXPECT_THAT(mistakes_of(k_tank + k_fill + gauge), ::testing::HasSubstr("gauge.y_m in a plane scene"));
    const std::string space = std::string(k_tank).replace(k_tank.find("cell_m"), 0, "dimensions = 'space'\nlength_m = 0.04\n");
    EXPECT_NEAR(parse_scene(space + k_fill + gauge, "scene.toml").gauges[0].y, 0.03, 1e-15);
    EXPECT_THAT(mistakes_of(space + k_fill + std::string(gauge).replace(gauge.find("0.03"), 4, "0.05")),
                ::testing::HasSubstr("outside the domain"));
}

class BodyFile : public ::testing::Test {
protected:
    const std::filesystem::path folder_ = std::filesystem::path(CUTTERFLOW_BUILD_DIR) / "tests" / "body_file";
    static inline const std::string k_table = "[[bodies]]\ndiameter_m = 0.01\nfile = \"list.csv\"\n";

    std::string scene_of(const std::string& list, const std::string& more = "") const {
        std::filesystem::create_directories(folder_);
        write_file(folder_ / "list.csv", list);
        return k_tank + k_fill + k_table + more;
    }
    std::string mistakes_of(const std::string& list, const std::string& more = "") const {
        try {
            parse_scene(scene_of(list, more), "scene.toml", folder_);
        } catch (const UserError& error) {
            return error.what();
        }
        return {};
    }
};

TEST_F(BodyFile, gives_places_velocities_spins_and_ids_in_their_order) {
    const Scene scene =
        parse_scene(scene_of("x_m,z_m,vx_m_s,vz_m_s,spin_rad_s,id\n0.05,0.15,0.1,-0.2,3,9\n0.10,0.12,0,0,0,4\n"), "scene.toml", folder_);
    EXPECT_EQ(scene.bodies.id, (std::vector<int>{4, 9}));
    EXPECT_NEAR((scene.bodies.position[1] - Vec3(0.05, 0.05, 0.15)).norm(), 0.0, 1e-15);
    EXPECT_EQ(scene.bodies.velocity[1], Vec3(0.1, 0.0, -0.2));
    EXPECT_EQ(scene.bodies.angular_velocity[1], Vec3(0, 3, 0));
    EXPECT_EQ(scene.bodies.velocity[0], Vec3(0, 0, 0));
    EXPECT_EQ(parse_scene(scene_of("z_m,x_m\n0.15,0.05\n0.12,0.1\n"), "scene.toml", folder_).bodies.id, (std::vector<int>{1, 2}));
}

TEST_F(BodyFile, names_file_and_line_of_every_mistake) {
    EXPECT_THAT(mistakes_of("x_m,z_m,y_m\n0.1,0.1,0.1\n"), ::testing::HasSubstr("has a place across"));
    EXPECT_THAT(mistakes_of("x_m,z_m,vy_m_s\n0.1,0.1,5\n"),
                ::testing::AllOf(::testing::HasSubstr("list.csv:2: The cylinder at x = 0.1 m has a velocity across"),
                                 ::testing::HasSubstr("Leave the column vy_m_s out")));
    EXPECT_THAT(mistakes_of("x_m,w_m\n0.1,0.1\n"), ::testing::AllOf(::testing::HasSubstr("list.csv:1: column 'z_m' is missing"),
                                                                    ::testing::HasSubstr("column 'w_m' is not known")));
    EXPECT_THAT(mistakes_of("x_m,z_m\n0.1,nan\n0.1\n"), ::testing::AllOf(::testing::HasSubstr("list.csv:2: z_m = 'nan' is not a number"),
                                                                         ::testing::HasSubstr("list.csv:3: 1 fields instead of 2")));
    EXPECT_THAT(mistakes_of("x_m,z_m,id\n0.1,0.1,2\n0.13,0.1,2\n0.16,0.1,1.5\n"),
                ::testing::AllOf(::testing::HasSubstr("id 2 is also in"), ::testing::HasSubstr("list.csv:4: id = 1.5")));
    EXPECT_THAT(mistakes_of("x_m,z_m\n0.1,0.1\n0.104,0.1\n0.25,0.1\n"),
                ::testing::AllOf(::testing::HasSubstr("list.csv:3: Bodies 1 and 2 overlap by 0.006 m"),
                                 ::testing::HasSubstr("list.csv:4: Body 3 at (0.25, 0.1) m leaves the domain by 0.055 m")));
    EXPECT_THAT(mistakes_of("x_m,z_m\n"), ::testing::HasSubstr("has no bodies"));
    EXPECT_THAT(mistakes_of("x_m,z_m\n0.1,0.1\n", "lowest_m = 0.1\n"), ::testing::HasSubstr("bodies.lowest_m = 0.1 beside bodies.file"));
    const std::string more = mistakes_of("x_m,z_m\n0.1,0.1\n", "layers = 3\nwidest = 2\nclearance_m = 0.001\n");
    for (const char* part : {"bodies.layers = 3 beside", "bodies.widest = 2 beside", "bodies.clearance_m = 0.001 beside"})
        EXPECT_THAT(more, ::testing::HasSubstr(part));
    EXPECT_EQ(mistakes_of("x_m,z_m\n0.1,0.15\n", "layers = 1\nwidest = 1\nrows = 1\nclearance_m = 0.0\n"), "") << "the defaults";
    EXPECT_THAT(mistakes_of("x_m,z_m,id\n0.1,0.1,1\n", "[[bodies]]\ndiameter_m = 0.01\nfile = \"list.csv\"\n"),
                ::testing::HasSubstr("id 1 is that of a body of another table"));
}

TEST(SceneFile, reads_gauges_and_refuses_those_that_no_water_reaches) {
    const auto gauge = [](const std::string& name, const std::string& x, const std::string& z) {
        return "[[gauge]]\nname = '" + name + "'\nx_m = " + x + "\n" + (z.empty() ? "" : "z_m = " + z + "\n");
    };
    const Scene scene = parse_scene(k_tank + k_fill + gauge("far wall", "0.2", "") + gauge("foot", "0.1", "0.003"), "scene.toml");
    ASSERT_EQ(scene.gauges.size(), 2u);
    EXPECT_FALSE(scene.gauges[0].z);
    EXPECT_EQ(scene.gauges[1].z, 0.003);
    const std::string box = "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.05\nfrom_z_m = 0.0\nto_x_m = 0.15\nto_z_m = 0.02\n";
    const std::string text = mistakes_of(k_tank + k_fill + box + gauge("a,b", "0.1", "") + gauge("c", "0.3", "") + gauge("c", "0.01", "") +
                                         gauge("d", "0.1", "0.01"));
    for (const char* part : {"a,b", "outside the domain", "is given twice", "stands in a solid"})
        EXPECT_THAT(text, ::testing::HasSubstr(part));
}

TEST(SceneFile, a_stack_needs_its_place) {
    EXPECT_THAT(mistakes_of(k_tank + k_fill + "[[bodies]]\ndiameter_m = 0.01\n"), ::testing::HasSubstr("bodies.centre_x_m is missing"));
}

TEST(Checkpoint, gives_the_same_state_back) {
    const Scene scene = parse_scene(k_tank + "[[fill]]\nfrom_x_m = 0.0\nfrom_z_m = 0.0\nto_x_m = 0.05\nto_z_m = 0.1\n", "scene.toml");
    SurfaceRun first(scene.settings, nullptr);
    for (int n = 0; n < 5; ++n) first.step();
    const std::filesystem::path folder = std::filesystem::path(CUTTERFLOW_BUILD_DIR) / "tests" / "surface_checkpoint";
    std::filesystem::remove_all(folder);
    write_checkpoint(folder, first.state(), nullptr);
    SurfaceRun later(scene.settings, nullptr);
    later.restore(read_checkpoint(newest_checkpoint(folder), later.grid(), nullptr));
    first.step();
    later.step();
    EXPECT_EQ(first.time(), later.time());
    EXPECT_EQ(first.particles().position, later.particles().position);
    EXPECT_EQ(first.particles().velocity, later.particles().velocity);
}

/// A run whose last pressure did not converge ends at the next one that does not, whether it is stopped in between or not.
TEST(Checkpoint, keeps_how_often_the_pressure_failed) {
    Scene scene = parse_scene(k_tank + "[[fill]]\nfrom_x_m = 0.0\nfrom_z_m = 0.0\nto_x_m = 0.05\nto_z_m = 0.1\n", "scene.toml");
    scene.settings.run.pressure_tolerance = 1e-300;
    SurfaceRun first(scene.settings, nullptr);
    first.step();
    ASSERT_FALSE(first.last().pressure.converged);
    const std::filesystem::path folder = std::filesystem::path(CUTTERFLOW_BUILD_DIR) / "tests" / "surface_checkpoint_failed";
    std::filesystem::remove_all(folder);
    write_checkpoint(folder, first.state(), nullptr);
    SurfaceRun later(scene.settings, nullptr);
    later.restore(read_checkpoint(newest_checkpoint(folder), later.grid(), nullptr));
    EXPECT_THROW(later.step(), CheckFailure);
    // The first format ends before the number.
    const std::filesystem::path file = newest_checkpoint(folder) / "water.bin";
    std::string earlier = read_file(file);
    earlier[0] = '1';
    earlier.resize(earlier.size() - sizeof(int));
    write_file(file, earlier);
    SurfaceRun from_earlier(scene.settings, nullptr);
    from_earlier.restore(read_checkpoint(newest_checkpoint(folder), from_earlier.grid(), nullptr));
    EXPECT_EQ(from_earlier.particles().position, first.particles().position);
    EXPECT_NO_THROW(from_earlier.step());
}

TEST(Checkpoint, that_is_cut_off_is_refused) {
    const Scene scene = parse_scene(k_tank + k_fill, "scene.toml");
    SurfaceRun run(scene.settings, nullptr);
    const std::filesystem::path folder = std::filesystem::path(CUTTERFLOW_BUILD_DIR) / "tests" / "surface_checkpoint_cut";
    std::filesystem::remove_all(folder);
    write_checkpoint(folder, run.state(), nullptr);
    const std::filesystem::path file = newest_checkpoint(folder) / "water.bin";
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    EXPECT_THROW(read_checkpoint(newest_checkpoint(folder), run.grid(), nullptr), UserError);
}

}  // namespace
}  // namespace cutterflow::free_surface
