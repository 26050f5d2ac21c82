#include "postproc/pages/velocity_figures.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

using testing::PlaneFlow;
using testing::SmallRun;

/// Solid rotation with an outflow that grows with the radius and a stream towards the hub.
constexpr PlaneFlow k_flow = [](double r, double) { return Vec3(2.0 * r, 6.0 * r, -0.5); };

RunData run_with_planes(const std::string& name, PlaneFlow flow) {
    SmallRun run(name);
    run.write();
    testing::write_velocity_planes(run.directory, flow);
    return read_run(run.directory);
}

TEST(VelocityFigures, axial_plane_shows_the_speed_in_it_within_one_percent) {
    const Plot plot = axial_plane(run_with_planes("plane_axial", k_flow)).value().plot;
    const Field& map = plot.field.value();
    ASSERT_EQ(map.value.size(), 60u * 40u);
    int in_steel = 0;
    for (std::size_t i = 0; i < map.value.size(); ++i) {
        if (std::isnan(map.value[i])) {
            ++in_steel;
            continue;
        }
        const double exact = std::hypot(2.0 * map.x[i], 0.5);  // the rotation goes through the plane
        EXPECT_NEAR(map.value[i], exact, 1e-3 * exact);
    }
    EXPECT_EQ(in_steel, testing::k_plane_points_in_steel);
    // Outflow goes to the left on the left side: the first arrow's tip lies to the left of its start and below it.
    const Series& strokes = plot.series.front();
    EXPECT_LT(strokes.x[1], strokes.x[0]);
    EXPECT_LT(strokes.y[1], strokes.y[0]);
}

TEST(VelocityFigures, under_the_ring_a_right_handed_head_turns_clockwise_as_seen_from_the_hub) {
    const Plot plot =
        plane_under_ring(run_with_planes("plane_ring", [](double r, double) { return Vec3(0.0, 6.0 * r, 0.0); })).value().plot;
    const Field& map = plot.field.value();
    for (std::size_t i = 0; i < map.value.size(); ++i) {
        if (std::isnan(map.value[i])) continue;
        const double exact = 6.0 * std::hypot(map.x[i], map.y[i]);
        EXPECT_NEAR(map.value[i], exact, 1e-3 * exact + 1e-9);
    }
    const std::vector<double>&x = plot.series.front().x, &y = plot.series.front().y;
    for (std::size_t i = 0; i + 1 < x.size(); i += 6) {
        const double px = x[i], py = y[i], dx = x[i + 1] - px, dy = y[i + 1] - py;
        const double mx = px + 0.5 * dx, my = py + 0.5 * dy;
        EXPECT_LT(mx * dy - my * dx, 0.0);                                                        // clockwise
        EXPECT_NEAR((mx * dx + my * dy) / (std::hypot(mx, my) * std::hypot(dx, dy)), 0.0, 1e-3);  // along the circle
    }
}

TEST(VelocityFigures, colours_stand_for_speeds_in_the_head_and_not_in_the_suction_pipe) {
    const PlaneFlow flow = [](double, double z) { return Vec3(0.0, 0.0, z > 0.0 ? 5.0 : 0.3); };
    EXPECT_NEAR(axial_plane(run_with_planes("plane_pipe", flow)).value().plot.field.value().darkest, 0.3, 1e-6);
}

TEST(VelocityFigures, are_left_out_before_the_first_sample) {
    const RunData data = run_with_planes("plane_unsampled", [](double, double) -> Vec3 { return Vec3::Constant(std::nan("")); });
    EXPECT_FALSE(axial_plane(data));
    EXPECT_FALSE(plane_under_ring(data));
}

TEST(VelocityFigures, are_left_out_when_the_run_sampled_no_planes) {
    SmallRun run("no_planes");
    run.write();
    const RunData data = read_run(run.directory);
    EXPECT_FALSE(axial_plane(data));
    EXPECT_FALSE(plane_under_ring(data));
}

TEST(VelocityFigures, name_a_table_that_is_no_grid) {
    SmallRun run("broken_plane");
    run.write();
    testing::write_velocity_planes(run.directory, k_flow);
    const auto file = run.directory / "postProcessing/velocity/0/plane_axial.csv";
    std::string text = testing::read_text(file);
    text.resize(text.rfind('\n', text.size() - 2) + 1);
    testing::write_text(file, text);
    EXPECT_THROW(axial_plane(read_run(run.directory)), UserError);
}

}  // namespace
}  // namespace cutterflow::postproc
