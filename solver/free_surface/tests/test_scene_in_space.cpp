/// Scenes in space as a study describes them: the same as plane ones where nothing changes across, spheres, surfaces, their mistakes.
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/io/read_surface.hpp"
#include "solver/free_surface/scene_file/scene_file.hpp"

namespace cutterflow::free_surface {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string scene_text(const std::string& dimensions, const std::string& more = "") {
    return "[domain]\ndimensions = \"" + dimensions +
           "\"\nwidth_m = 0.2\nlength_m = 0.02\nheight_m = 0.12\ncell_m = 0.005\n"
           "[[fill]]\nfrom_x_m = 0.0\nfrom_z_m = 0.0\nto_x_m = 0.06\nto_z_m = 0.09\n"
           "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.1\nfrom_z_m = 0.0\nto_x_m = 0.112\nto_z_m = 0.02\n"
           "[run]\nend_s = 0.1\n" +
           more;
}

std::string mistakes_of(const std::string& toml, const fs::path& folder = {}) {
    try {
        parse_scene(toml, "scene.toml", folder);
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

struct Result {
    Vec3 mean = Vec3::Zero();
    double volume = 0.0, level = 0.0, across = 0.0;
};

Result after(const std::string& dimensions) {
    Scene scene = parse_scene(scene_text(dimensions), "scene.toml");
    scene.settings.run.longest_step = 1.5e-3;
    scene.settings.run.max_courant = 1.0;  // the steps are those of longest_step in both
    scene.settings.run.pressure_tolerance = 1e-13;
    scene.settings.run.even_out_tolerance = 1e-13;
    SurfaceRun run(scene.settings, nullptr);
    while (run.time() < scene.end * (1.0 - 1e-9)) run.step(scene.end - run.time());
    Result result;
    const WaterParticles& water = run.particles();
    for (std::size_t p = 0; p < water.size(); ++p) {
        result.mean += water.place(p) / static_cast<double>(water.size());
        result.across = std::max(result.across, std::abs(water.velocity[1][p]));
    }
    result.volume = run.last().occupied_volume;
    result.level = read_gauges(run, scene.pipe).level;
    return result;
}

TEST(SceneInSpace, is_the_plane_scene_where_nothing_changes_across) {
    const Result plane = after("plane"), space = after("space");
    EXPECT_GT(plane.mean.x(), 0.035);  // the dam has broken
    for (const int d : {0, 2}) EXPECT_NEAR(space.mean[d] / plane.mean[d], 1.0, 1e-6);
    EXPECT_NEAR(space.volume / plane.volume, 1.0, 1e-6);
    EXPECT_NEAR(space.level / plane.level, 1.0, 1e-6);
    EXPECT_LT(space.across, 1e-6);
}

TEST(SceneInSpace, boxes_and_water_may_end_across) {
    const Scene scene =
        parse_scene(scene_text("space",
                               "[[fill]]\nfrom_x_m = 0.12\nfrom_y_m = 0.0\nfrom_z_m = 0.0\nto_x_m = 0.2\nto_y_m = 0.01\nto_z_m = 0.01\n"
                               "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.15\nfrom_y_m = 0.0\nfrom_z_m = 0.05\nto_x_m = 0.2\nto_y_m = 0.01\n"
                               "to_z_m = 0.1\n"),
                    "scene.toml");
    EXPECT_EQ(scene.settings.tank.cells, (std::array<int, 3>{40, 4, 24}));
    EXPECT_NEAR(predict(scene).water_cells, 12 * 4 * 18 + 16 * 2 * 2, 1e-6);
    EXPECT_TRUE(is_inside(scene.settings.solids[1], Vec3(0.17, 0.005, 0.07)));
    EXPECT_FALSE(is_inside(scene.settings.solids[1], Vec3(0.17, 0.015, 0.07)));
    const std::string walls = wall_surface_stl({scene.settings.solids[1]}, scene.settings.tank.depth);
    EXPECT_THAT(walls, HasSubstr("vertex 0.20000000000000001 0.01 0.10000000000000001"));
    EXPECT_THAT(walls, ::testing::Not(HasSubstr(" 0.02 ")));
}

TEST(SceneInSpace, tells_water_that_is_not_in_the_tank) {
    const auto fill = [](const char* across) {
        return scene_text("space", std::string("[[fill]]\nfrom_x_m = 0.12\nfrom_z_m = 0.0\nto_x_m = 0.2\nto_z_m = 0.01\n") + across);
    };
    EXPECT_THAT(mistakes_of(fill("from_y_m = 0.021\n")), HasSubstr("Water from (0.12, 0) to (0.2, 0.01) m. It must lie in the domain"));
    EXPECT_EQ(mistakes_of(fill("from_y_m = 0.01\n")), "");
    EXPECT_THAT(water_notes(parse_scene(fill("from_y_m = 0.01\n"), "scene.toml")), ::testing::IsEmpty());
    EXPECT_THAT(water_notes(parse_scene(fill("from_y_m = 0.01\nto_y_m = 0.0105\n"), "scene.toml")),
                ::testing::ElementsAre(HasSubstr("the box of water from (0.12, 0) to (0.2, 0.01) m has no particle")));
}

TEST(SceneInSpace, cylinders_stand_beside_solids_that_reach_across_alone) {
    const std::string cylinder = "[[bodies]]\ndiameter_m = 0.04\ncentre_x_m = 0.16\nlowest_m = 0.05\n";
    const auto box = [](const char* ends) {
        return scene_text("space",
                          std::string("[[solid]]\nkind = \"box\"\nfrom_x_m = 0.15\nfrom_z_m = 0.0\nto_x_m = 0.2\nto_z_m = 0.03\n") + ends);
    };
    EXPECT_EQ(mistakes_of(box("") + cylinder), "");
    EXPECT_EQ(mistakes_of(box("from_y_m = 0.0\nto_y_m = 0.02\n") + cylinder), "");
    EXPECT_THAT(mistakes_of(box("from_y_m = 0.01\n") + cylinder), HasSubstr("A box from 0.01 to 0.02 m across beside cylinders"));
    EXPECT_EQ(mistakes_of(box("from_y_m = 0.01\n")), "") << "water alone";
}

const std::string k_spheres =
    "[[bodies]]\nshape = \"sphere\"\ndiameter_m = 0.04\nlayers = 2\nwidest = 2\nrows = 2\ncentre_x_m = 0.1\nlowest_m = 0.11\n"
    "clearance_m = 0.002\n";

std::string wide(const std::string& more) {
    return "[domain]\ndimensions = \"space\"\nwidth_m = 0.2\nlength_m = 0.1\nheight_m = 0.2\ncell_m = 0.005\n[run]\nend_s = 0.1\n" + more;
}

TEST(SceneInSpace, stacks_spheres_in_rows) {
    const Scene scene = parse_scene(wide(k_spheres), "scene.toml");
    ASSERT_EQ(scene.bodies.size(), 6u);
    EXPECT_TRUE(scene.settings.spheres);
    EXPECT_EQ(scene.dem.shape, coupling::RockShape::sphere);
    EXPECT_NEAR(scene.bodies.position[0].y(), 0.05 - 0.021, 1e-12);
    EXPECT_NEAR(scene.bodies.position[1].y(), 0.05 + 0.021, 1e-12);
    const Body body = body_of(scene.bodies, 0, scene.settings.spheres, scene.settings.tank.depth);
    EXPECT_NEAR(body.mass, 2700.0 * k_pi / 6.0 * std::pow(0.04, 3), 1e-9);
}

TEST(SceneInSpace, names_what_does_not_fit_its_kind_all_at_once) {
    std::string plane = scene_text("plane", k_spheres +
                                                "[[solid]]\nkind = \"surface\"\nfile = \"a.stl\"\n"
                                                "[[solid]]\nkind = \"box\"\nfrom_x_m = 0.15\nfrom_y_m = 0.0\nfrom_z_m = 0.05\n"
                                                "to_x_m = 0.2\nto_y_m = 0.01\nto_z_m = 0.1\n");
    const std::string mistakes = mistakes_of(plane);
    EXPECT_THAT(mistakes, HasSubstr("Spheres in a plane scene"));
    EXPECT_THAT(mistakes, HasSubstr("A surface in a plane scene"));
    EXPECT_THAT(mistakes, HasSubstr("solid.from_y_m in a plane scene"));

    const std::string cylinders = "[[bodies]]\ndiameter_m = 0.04\ncentre_x_m = 0.03\nlowest_m = 0.01\nrows = 2\n";
    EXPECT_THAT(mistakes_of(wide(k_spheres + cylinders)), HasSubstr("Spheres and cylinders in one scene"));
    EXPECT_THAT(mistakes_of(wide(cylinders)), HasSubstr("bodies.rows"));
    std::string outside = k_spheres;
    outside.replace(outside.find("rows = 2"), 8, "rows = 3");
    EXPECT_THAT(mistakes_of(wide(outside)), HasSubstr("6 of 9 bodies leave the domain"));
}

class SurfaceFile : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("cutterflow_closed_surface_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

TEST_F(SurfaceFile, stands_in_the_scene_and_must_be_closed) {
    const std::string text = wall_surface_stl({SolidBox{Vec3(0.08, 0.0, 0.02), Vec3(0.12, 0.03, 0.1)}}, 0.1);
    write_file(folder_ / "block.stl", text);
    const std::string solid = "[[solid]]\nkind = \"surface\"\nfile = \"block.stl\"\n";
    const std::string fill = "[[fill]]\nfrom_x_m = 0.0\nfrom_z_m = 0.0\nto_x_m = 0.2\nto_z_m = 0.01\n";
    const Scene scene = parse_scene(wide(fill + solid), "scene.toml", folder_);
    EXPECT_TRUE(is_inside(scene.settings.solids[0], Vec3(0.1, 0.01, 0.05)));
    EXPECT_FALSE(is_inside(scene.settings.solids[0], Vec3(0.1, 0.04, 0.05)));
    // Bodies bump into it as into a box, whatever the format of its file.
    write_file(folder_ / "walls.stl", wall_surface_stl(scene.settings.solids, 0.1));
    const geometry::TriangleSurface walls = geometry::read_surface(folder_ / "walls.stl");
    EXPECT_EQ(walls.triangles.size(), 12u);
    EXPECT_NEAR(geometry::mass_properties(walls).volume, 0.04 * 0.03 * 0.08, 1e-9);

    const std::string sphere = "[[bodies]]\nshape = \"sphere\"\ndiameter_m = 0.04\ncentre_x_m = 0.1\nlowest_m = 0.099\ncentre_y_m = 0.03\n";
    EXPECT_THAT(mistakes_of(wide(solid + sphere), folder_), HasSubstr("stands in a solid"));

    const std::size_t first = text.find("facet"), second = text.find("facet", text.find("endfacet", first) + 9);
    EXPECT_THAT(mistakes_of(wide(solid + "[[bodies]]\ndiameter_m = 0.04\ncentre_x_m = 0.03\nlowest_m = 0.1\n"), folder_),
                HasSubstr("A surface from 0 to 0.03 m across beside cylinders"));

    write_file(folder_ / "open.stl", std::string(text).erase(first, second - first));
    const std::string open =
        mistakes_of(wide("[[solid]]\nkind = \"surface\"\nfile = \"open.stl\"\n[[solid]]\nkind = \"surface\"\n"), folder_);
    EXPECT_THAT(open, HasSubstr("open.stl"));
    EXPECT_THAT(open, HasSubstr("solid.file is missing"));
}

}  // namespace
}  // namespace cutterflow::free_surface
