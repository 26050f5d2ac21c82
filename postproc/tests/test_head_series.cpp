#include "postproc/draw/head/head_series.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "postproc/draw/indexed_surface.hpp"
#include "postproc/pages/report.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using testing::SmallRun;

TEST(HeadSeries, has_the_head_at_every_time_of_fields_and_rock) {
    SmallRun run("head_series");
    run.write();
    fs::create_directories(run.directory / "processor0/0.5");
    fs::create_directories(run.directory / "0");
    fs::create_directories(run.directory / "constant");
    testing::write_text(run.directory / "postProcessing/rock/vtk/rocks_1.25.vtp", "");
    write_report(run.directory);
    const std::string series = testing::read_text(run.directory / "report/head/head.pvd");
    std::size_t last = 0;
    for (const char* time : {"0", "0.5", "1.25"}) {
        const std::size_t at = series.find(std::string("timestep=\"") + time + "\" file=\"head_" + time + ".vtp\"");
        ASSERT_NE(at, std::string::npos) << time;
        EXPECT_GE(at, last);
        last = at;
        EXPECT_TRUE(fs::exists(run.directory / "report/head" / (std::string("head_") + time + ".vtp")));
    }
    EXPECT_EQ(series.find("constant"), std::string::npos);
    // Half a turn apart: not the same picture.
    EXPECT_NE(testing::read_text(run.directory / "report/head/head_0.vtp"), testing::read_text(run.directory / "report/head/head_0.5.vtp"));
}

TEST(HeadSeries, is_not_made_for_a_run_that_wrote_nothing_to_go_with_it) {
    SmallRun run("no_head_series");
    run.write();
    write_head_series(run.directory);
    EXPECT_FALSE(fs::exists(run.directory / "report/head"));
}

TEST(HeadSeries, has_soil_and_feed_beside_the_head) {
    SmallRun run("head_surroundings");
    run.write();
    testing::make_fed(run, 5.0);
    testing::write_text(run.directory / "postProcessing/rock/vtk/rocks_1.25.vtp", "");
    write_report(run.directory);
    const fs::path folder = run.directory / "report/head";
    const std::string bank = testing::read_text(folder / "bank.vtp"), feed = testing::read_text(folder / "feed.vtp");
    EXPECT_NE(bank.find("NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfPolys=\"1\""), std::string::npos) << "one triangle";
    EXPECT_NE(feed.find("NumberOfPoints=\"9\" NumberOfVerts=\"9\""), std::string::npos) << "nine rocks came in";
    for (const char* array : {"\"id\"", "\"time\"", "\"diameter\""}) EXPECT_NE(feed.find(array), std::string::npos) << array;

    SmallRun flow("head_alone");
    flow.with_rock = false;
    flow.write();
    fs::create_directories(flow.directory / "0.5");
    write_report(flow.directory);
    EXPECT_TRUE(fs::exists(flow.directory / "report/head/head.pvd"));
    for (const char* file : {"bank.vtp", "feed.vtp"}) EXPECT_FALSE(fs::exists(flow.directory / "report/head" / file)) << file;
}

/// A square of n x n cells, two triangles each.
TriangleSurface square(int n) {
    TriangleSurface surface;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const Vec3 a(i, j, 0.0), b(i + 1, j, 0.0), c(i + 1, j + 1, 0.0), d(i, j + 1, 0.0);
            surface.push_back({a, b, c});
            surface.push_back({a, c, d});
        }
    }
    return surface;
}

TEST(IndexedSurface, shares_points_and_keeps_places) {
    const TriangleSurface surface = square(10);
    const IndexedSurface indexed = index_surface(surface);
    EXPECT_EQ(indexed.points.size(), 121u);
    ASSERT_EQ(indexed.triangles.size(), surface.size());
    for (std::size_t t = 0; t < surface.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR((indexed.point(indexed.triangles[t][k]) - surface[t][k]).norm(), 0.0, 10.0 / 65535.0);
    }
}

TEST(IndexedSurface, is_coarsened_to_the_number_of_triangles_asked_for) {
    const IndexedSurface indexed = index_surface(square(64), 2000);
    EXPECT_LE(indexed.triangles.size(), 2000u);
    EXPECT_GT(indexed.triangles.size(), 200u);
    double area = 0.0;
    for (const auto& [a, b, c] : indexed.triangles) {
        area += 0.5 * (indexed.point(b) - indexed.point(a)).cross(indexed.point(c) - indexed.point(a)).norm();
    }
    EXPECT_NEAR(area, 64.0 * 64.0, 0.05 * 64.0 * 64.0);
    EXPECT_TRUE(index_surface({}).triangles.empty());
}

}  // namespace
}  // namespace cutterflow::postproc
