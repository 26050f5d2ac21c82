// Shares of cells that take rock, of cells at rest and of cells that turn through the soil's surface.
#include <cmath>

#include <gtest/gtest.h>

#include "solver/ports/testing/synthetic_mesh.hpp"
#include "solver/ports/testing/threaded_ranks.hpp"
#include "solver/space/open_share.hpp"

namespace cutterflow::coupling {
namespace {

constexpr double k_cell = 0.02;
constexpr double k_ground = -0.043;  // height of the soil's top [m]

/// A turning drum of cubes in cells at rest, half in soil with a level top.
testing::SyntheticMesh drum_in_soil() {
    testing::SyntheticMesh mesh;
    const auto is_in_drum = [](const Vec3& x) { return x.squaredNorm() < 0.09; };
    mesh.add_box(Vec3::Constant(-0.4), Vec3::Constant(0.4), k_cell, true, is_in_drum);
    mesh.add_box(Vec3::Constant(-0.4), Vec3::Constant(0.4), k_cell, false, [&](const Vec3& x) { return !is_in_drum(x); });
    mesh.add_box_of_soil(Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, k_ground));
    return mesh;
}

/// About the level line y.
std::vector<ZoneMotion> about_y() {
    return {{{Vec3::Zero(), Vec3::UnitY()}, 1.0, "rotor"}};
}

double open_by_height(double height) {
    return std::clamp(2.0 * (height - k_ground) / k_cell, 0.0, 1.0);
}

/// Largest difference to the closed form over all cells. \param share  at the position `frames`
double worst_of(OpenShare& share, const CellTrees& trees, const ZoneFrames& frames) {
    double worst = 0.0;
    for (std::int32_t place = 0; place < static_cast<std::int32_t>(trees.cells().centres.size()); ++place) {
        const auto zone = static_cast<Zone>(trees.cells().zone[static_cast<std::size_t>(trees.number(place))]);
        const double height = frames.to_absolute(zone, trees.centre(place))[2];
        worst = std::max(worst, std::abs(share.at(place) - open_by_height(height)));
    }
    return worst;
}

TEST(OpenShare, of_level_ground_follows_the_height_of_the_centre_as_cells_turn_through_it) {
    const testing::SyntheticMesh mesh = drum_in_soil();
    SerialCommunicator serial;
    const CellTrees trees(mesh.cells(), 2);
    const SizeField sizes(mesh.cells(), 2, serial);
    OpenShare share(mesh.steel().soil, trees, about_y(), sizes, ZoneFrames(about_y(), 0.0), serial);
    for (const double angle : {0.0, 0.01, 0.4, 2.5}) {
        const ZoneFrames frames(about_y(), angle);
        share.set_frames(frames);
        EXPECT_LE(worst_of(share, trees, frames), 1e-6) << "angle " << angle;
    }
}

TEST(OpenShare, is_one_where_there_is_no_soil) {
    testing::SyntheticMesh mesh = drum_in_soil();
    mesh.soil.clear();
    SerialCommunicator serial;
    const CellTrees trees(mesh.cells(), 2);
    OpenShare share(mesh.steel().soil, trees, about_y(), SizeField(mesh.cells(), 2, serial), ZoneFrames(about_y(), 0.0), serial);
    for (std::int32_t place = 0; place < static_cast<std::int32_t>(mesh.size()); ++place) ASSERT_EQ(share.at(place), 1.0);
}

TEST(OpenShare, does_not_depend_on_the_number_of_ranks) {
    const testing::SyntheticMesh whole = drum_in_soil();
    const ZoneFrames frames(about_y(), 0.3);
    const auto shares_of = [&](const testing::SyntheticMesh& mesh, Communicator& communicator) {
        const CellTrees trees(mesh.cells(), 2);
        OpenShare share(mesh.steel().soil, trees, about_y(), SizeField(mesh.cells(), 2, communicator), frames, communicator);
        std::vector<double> open(mesh.size());
        for (std::int32_t place = 0; place < static_cast<std::int32_t>(mesh.size()); ++place)
            open[static_cast<std::size_t>(trees.number(place))] = share.at(place);
        return open;
    };
    SerialCommunicator serial;
    const std::vector<double> expected = shares_of(whole, serial);
    testing::ThreadedRanks(2).run([&](Communicator& communicator) {
        std::vector<std::size_t> mine;
        const testing::SyntheticMesh part = whole.part([&](std::size_t c) {
            const bool is_mine = (whole.centres[c][0] > 0.05 ? 1 : 0) == communicator.rank();
            if (is_mine) mine.push_back(c);
            return is_mine;
        });
        const std::vector<double> open = shares_of(part, communicator);
        for (std::size_t c = 0; c < mine.size(); ++c) ASSERT_NEAR(open[c], expected[mine[c]], 1e-12);
    });
}

}  // namespace
}  // namespace cutterflow::coupling
