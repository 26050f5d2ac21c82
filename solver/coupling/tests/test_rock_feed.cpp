// The rock feed: what a good file gives, and that a bad one names all its mistakes.
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "solver/coupling/feed/rock_feed.hpp"
#include "solver/ports/testing/temporary_folder.hpp"

namespace cutterflow::coupling {
namespace {

TEST(RockFeed, is_sorted_by_time_and_id) {
    const testing::TemporaryFolder folder;
    const auto rocks = read_rock_feed(folder.write("feed.csv",
                                                   "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n"
                                                   "7,1.5,0.1,0.2,-0.3,0.02,2650\n"
                                                   "9,0.5,0,0,0,0.01,2600\n"
                                                   "3,1.5,1,2,3,0.02,2650\n"));
    ASSERT_EQ(rocks.size(), 3u);
    EXPECT_EQ(rocks[0].id, 9);
    EXPECT_EQ(rocks[1].id, 3);
    EXPECT_EQ(rocks[2].id, 7);
    EXPECT_EQ(rocks[2].position, Vec3(0.1, 0.2, -0.3));
    EXPECT_EQ(rocks[2].diameter, 0.02);
    EXPECT_FALSE(rocks[2].velocity.has_value());
}

TEST(RockFeed, takes_velocities_when_all_three_are_there) {
    const testing::TemporaryFolder folder;
    const std::string columns = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,";
    const auto rocks = read_rock_feed(folder.write("feed.csv", columns + "vx_m_s,vy_m_s,vz_m_s\r\n1,0,0,0,0,0.02,2650,1,-2,3\r\n"));
    ASSERT_TRUE(rocks.at(0).velocity.has_value());
    EXPECT_EQ(*rocks[0].velocity, Vec3(1, -2, 3));
    EXPECT_THROW(read_rock_feed(folder.write("two.csv", columns + "vx_m_s,vy_m_s\n1,0,0,0,0,0.02,2650,1,-2\n")), UserError);
}

TEST(RockFeed, reads_the_places_of_a_rock) {
    const testing::TemporaryFolder folder;
    const std::string head = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,vx_m_s,vy_m_s,vz_m_s,place\n";
    const auto rocks = read_rock_feed(folder.write("feed.csv", head + "2,0.5,0,0,0,0.02,2650,1,0,0,0\n2,0.5,0,0,3,0.02,2650,4,0,0,1\n"
                                                                      "1,0.1,0,0,7,0.02,2650,5,0,0,0\n"));
    ASSERT_EQ(rocks.size(), 2u);
    EXPECT_TRUE(rocks[0].elsewhere.empty());
    ASSERT_EQ(rocks[1].elsewhere.size(), 1u);
    EXPECT_EQ(rocks[1].elsewhere[0].position, Vec3(0, 0, 3));
    EXPECT_EQ(*rocks[1].elsewhere[0].velocity, Vec3(4, 0, 0));
    try {
        read_rock_feed(folder.write("wrong.csv", head + "1,0,0,0,0,0.02,2650,0,0,0,0\n1,0.1,0,0,0,0.03,2650,0,0,0,1\n"
                                                        "1,0.1,0,0,0,0.03,2650,0,0,0,3\n3,0,0,0,0,0.02,2650,0,0,0,1\n"));
        FAIL();
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 4u) << error.what();  // another time, another diameter, a gap, no first place
    }
}

std::vector<ClumpShape> two_shapes() {
    return {{"flat", geometry::unit_clump({{{Vec3(0, 0, 0), 1.0}, {Vec3(1, 0, 0), 1.0}}})},
            {"long", geometry::unit_clump({{{Vec3(0, 0, 0), 1.0}, {Vec3(1.5, 0, 0), 1.0}}})}};
}

TEST(RockFeed, takes_shapes_by_name_and_orientations) {
    const testing::TemporaryFolder folder;
    const std::string columns = "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3,shape";
    const auto rocks = read_rock_feed(
        folder.write("feed.csv", columns + ",qw,qx,qy,qz\n1,0,0,0,0,0.02,2650,long,0.6,0,0.8,0\n2,0,1,0,0,0.02,2650,,1,0,0,0\n"), {},
        two_shapes());
    EXPECT_EQ(rocks.at(0).shape, 1);
    EXPECT_NEAR(rocks[0].orientation.angularDistance(Eigen::Quaterniond(0.6, 0.0, 0.8, 0.0)), 0.0, 1e-12);
    EXPECT_EQ(rocks.at(1).shape, k_sphere_shape);
    EXPECT_EQ(rocks_of(rocks).shape, (std::vector<int>{1, k_sphere_shape}));

    const auto drawn =
        read_rock_feed(folder.write("drawn.csv", columns + "\n7,0,0,0,0,0.02,2650,flat\n8,0,1,0,0,0.02,2650,flat\n"), {}, two_shapes());
    EXPECT_EQ(drawn.at(0).orientation.coeffs(), orientation_of_id(7).coeffs());
    EXPECT_GT(drawn[0].orientation.angularDistance(drawn.at(1).orientation), 0.1);
    EXPECT_NEAR(drawn[1].orientation.norm(), 1.0, 1e-15);

    try {
        read_rock_feed(folder.write("wrong.csv", columns + ",qw,qx,qy,qz\n1,0,0,0,0,0.02,2650,round,1,0,0,0\n"
                                                           "2,0,0,0,0,0.02,2650,flat,1,0.1,0,0\n"),
                       {}, two_shapes());
        FAIL();
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 2u) << error.what();  // an unknown shape, a quaternion that is too long
    }
    EXPECT_THROW(read_rock_feed(folder.write("three.csv", columns + ",qw,qx,qy\n1,0,0,0,0,0.02,2650,flat,1,0,0\n"), {}, two_shapes()),
                 UserError);
}

// Any direction of a body points with equal right anywhere: means of x and of x^2 of 4,000 of them are 0 and 1/3.
TEST(RockFeed, draws_orientations_from_all_alike) {
    Vec3 mean = Vec3::Zero(), square = Vec3::Zero();
    constexpr int count = 4000;
    for (int id = 1; id <= count; ++id) {
        const Vec3 way = orientation_of_id(id) * Vec3(0.36, 0.48, 0.8);
        mean += way / count;
        square += way.cwiseProduct(way) / count;
    }
    EXPECT_LT(mean.cwiseAbs().maxCoeff(), 4.0 * std::sqrt(1.0 / 3.0 / count));
    EXPECT_LT((square.array() - 1.0 / 3.0).abs().maxCoeff(), 4.0 * std::sqrt(4.0 / 45.0 / count));
}

TEST(RockFeed, names_every_mistake_with_its_line) {
    const testing::TemporaryFolder folder;
    const auto file = folder.write("feed.csv",
                                   "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n"
                                   "1,0,0,0,0,0.02,2650\n"
                                   "1,0,0,0,0,-0.02,2650\n"
                                   "2.5,0,0,0,0,0.02,0\n"
                                   "4,-1,0,0,0,0.02,2650\n");
    try {
        read_rock_feed(file);
        FAIL();
    } catch (const UserError& error) {
        ASSERT_EQ(error.mistakes().size(), 5u) << error.what();
        EXPECT_EQ(error.mistakes()[0].where, file.string() + ":3");
        EXPECT_NE(error.mistakes()[0].what.find("id = 1 stands in"), std::string::npos);
        EXPECT_NE(error.mistakes()[1].what.find("diameter_m = -0.02"), std::string::npos);
        EXPECT_NE(error.mistakes()[2].what.find("id = 2.5"), std::string::npos);
        EXPECT_EQ(error.mistakes()[3].where, file.string() + ":4");
        EXPECT_EQ(error.mistakes()[4].where, file.string() + ":5");
    }
}

TEST(RockFeed, names_wrong_values_beside_incomplete_lines_and_places_outside_the_domain) {
    const testing::TemporaryFolder folder;
    const auto file = folder.write("feed.csv",
                                   "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n"
                                   "1,0,0,0,0,0.02\n"
                                   "2,0,0,0,0,-0.02,2650\n"
                                   "3,0,0,0,0,0.02,2650\n"
                                   "3,0,0,0,0,0.02,2650\n"
                                   "4,0,0,0,2.5,0.02,2650\n");
    try {
        read_rock_feed(file, [](const Vec3& place) { return place.z() < 1.0; });
        FAIL();
    } catch (const UserError& error) {
        ASSERT_EQ(error.mistakes().size(), 4u) << error.what();
        const std::vector<std::string> expected{":2: 6 fields instead of 7", ":3: diameter_m = -0.02", ":5: id = 3 stands in",
                                                ":6: rock 4 at (0 0 2.5) m lies outside rock.domain"};
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_EQ(error.mistakes()[i].text().find(file.string() + expected[i]), 0u) << error.mistakes()[i].text();
    }
}

TEST(RockFeed, names_missing_and_unknown_columns_and_bad_fields) {
    const testing::TemporaryFolder folder;
    try {
        read_rock_feed(folder.write("feed.csv", "id,time_s,x_m,y_m,z_m,diameter_mm,density_kg_m3\n1,0,abc,0,0,20,2650\n2,0,0\n"));
        FAIL();
    } catch (const UserError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("column 'diameter_m' is missing"), std::string::npos) << text;
        EXPECT_NE(text.find("column 'diameter_mm' is not known"), std::string::npos) << text;
        EXPECT_NE(text.find("x_m = 'abc' is not a number"), std::string::npos) << text;
        EXPECT_NE(text.find("3 fields instead of 7"), std::string::npos) << text;
    }
    EXPECT_THROW(read_rock_feed(folder.path() / "absent.csv"), UserError);
}

}  // namespace
}  // namespace cutterflow::coupling
