// Searches among points against going through all of them.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "solver/space/point_tree.hpp"

namespace cutterflow::coupling {
namespace {

std::vector<Vec3> random_points(std::size_t count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> along(-1.0, 1.0);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.emplace_back(along(random), along(random), 0.1 * along(random));
    return points;
}

std::vector<std::int32_t> indices_of(const std::vector<Neighbour>& found) {
    std::vector<std::int32_t> indices;
    for (const Neighbour& n : found) indices.push_back(n.index);
    std::sort(indices.begin(), indices.end());
    return indices;
}

TEST(PointTree, finds_all_points_within_a_radius_and_no_other) {
    for (const std::size_t count : {0u, 1u, 15u, 16u, 17u, 1000u}) {
        const std::vector<Vec3> points = random_points(count);
        const PointTree tree(points);
        for (const double radius : {0.0, 0.05, 0.4, 3.0})
            for (const Vec3& centre : {Vec3(0, 0, 0), Vec3(0.9, -0.9, 0.1), Vec3(1.5, 0, 0)}) {
                std::vector<std::int32_t> expected;
                for (std::size_t i = 0; i < count; ++i)
                    if ((points[i] - centre).squaredNorm() < radius * radius) expected.push_back(static_cast<std::int32_t>(i));
                std::vector<Neighbour> found;
                tree.within(centre, radius, found);
                EXPECT_EQ(indices_of(found), expected) << count << " points, radius " << radius;
                for (const Neighbour& n : found)
                    EXPECT_NEAR(n.squared_distance, (points[static_cast<std::size_t>(n.index)] - centre).squaredNorm(), 1e-15);
            }
    }
}

TEST(PointTree, adds_to_what_was_found_before_and_returns_the_given_indices) {
    const PointTree tree({Vec3(0, 0, 0), Vec3(1, 0, 0)}, {7, 3});
    std::vector<Neighbour> found{{-1, 0.0}};
    tree.within(Vec3(0.9, 0, 0), 0.5, found);
    EXPECT_EQ(indices_of(found), (std::vector<std::int32_t>{-1, 3}));
}

TEST(PointTree, finds_a_shell_but_for_boxes_that_are_left_out) {
    const std::vector<Vec3> points = random_points(3000);
    PointTree tree(points);
    const Vec3 centre(0.2, -0.1, 0.0);
    const double inner = 0.2, outer = 0.6;
    const auto in_shell = [&](const Vec3& p) { return (p - centre).norm() >= inner && (p - centre).norm() < outer; };
    std::vector<Neighbour> all, right_half;
    tree.between(
        centre, inner, outer, [](const Box&) { return false; }, all);
    tree.between(
        centre, inner, outer, [&](const Box& box) { return box.upper.x() < centre.x(); }, right_half);
    std::vector<std::int32_t> expected;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (in_shell(points[i])) expected.push_back(static_cast<std::int32_t>(i));
    EXPECT_EQ(indices_of(all), expected);
    EXPECT_LT(right_half.size(), all.size());
    const auto to_the_right = std::count_if(expected.begin(), expected.end(),
                                            [&](std::int32_t i) { return points[static_cast<std::size_t>(i)].x() >= centre.x(); });
    const auto found_there = std::count_if(right_half.begin(), right_half.end(),
                                           [&](const Neighbour& n) { return points[static_cast<std::size_t>(n.index)].x() >= centre.x(); });
    EXPECT_EQ(found_there, to_the_right);
}

TEST(PointTree, numbers_points_by_memory_and_tells_which_they_were) {
    const std::vector<Vec3> points = random_points(200);
    PointTree tree(points);
    const std::vector<std::int32_t> before = tree.number_by_memory(1000);
    std::vector<Neighbour> found;
    tree.within(Vec3::Zero(), 10.0, found);
    ASSERT_EQ(found.size(), points.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].index, 1000 + static_cast<std::int32_t>(i));
        EXPECT_NEAR(found[i].squared_distance, points[static_cast<std::size_t>(before[i])].squaredNorm(), 1e-15);
    }
}

TEST(PointTree, finds_the_nearest_points_nearest_first) {
    const std::vector<Vec3> points = random_points(500);
    const PointTree tree(points);
    const Vec3 centre(0.3, 0.2, 0.0);
    std::vector<double> distances;
    for (const Vec3& p : points) distances.push_back((p - centre).squaredNorm());
    std::sort(distances.begin(), distances.end());
    std::vector<Neighbour> found;
    tree.nearest(centre, 24, found);
    ASSERT_EQ(found.size(), 24u);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i].squared_distance, distances[i], 1e-15);
}

}  // namespace
}  // namespace cutterflow::coupling
