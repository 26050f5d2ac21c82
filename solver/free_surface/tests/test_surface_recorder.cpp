/// Files for ParaView: particles as raw arrays behind their XML part, a series that names them.
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/file_content.hpp"
#include "solver/free_surface/output/surface_recorder.hpp"

namespace cutterflow::free_surface {
namespace {

namespace fs = std::filesystem;

SceneSettings pool() {
    SceneSettings scene;
    scene.tank.cells = {8, 1, 8};
    scene.tank.cell = 0.01;
    scene.tank.depth = 0.05;
    scene.water.filled = {{Vec3(-1, -1, -1), Vec3(0.04, 1, 0.04)}, {Vec3(0.04, -1, -1), Vec3(1, 1, 0.04)}};
    return scene;
}

/// A number n of an array of a file whose arrays are appended as raw bytes after their size.
template <typename T>
T appended(const std::string& text, const std::string& name, std::size_t n) {
    const std::size_t line = text.find("Name=\"" + name + "\"");
    const std::string key = "offset=\"";
    const std::size_t offset = std::stoul(text.substr(text.find(key, line) + key.size()));
    T value;
    std::memcpy(&value, text.data() + text.find("\n_") + 2 + offset + sizeof(std::uint64_t) + n * sizeof(T), sizeof value);
    return value;
}

TEST(SurfaceRecorder, writes_every_nth_particle_with_place_velocity_and_box) {
    const fs::path folder = fs::path(CUTTERFLOW_BUILD_DIR) / "tests" / "surface_recorder";
    fs::remove_all(folder);
    SurfaceRun run(pool(), nullptr);
    run.step(1e-3);
    SurfaceRecorder recorder(folder, 0.0, {}, 3);
    recorder.output(run, nullptr);
    const fs::path pictures = folder / "postProcessing" / "particles";
    EXPECT_THAT(read_file(pictures / "particles.pvd"),
                ::testing::HasSubstr("<DataSet timestep=\"0.001\" file=\"vtk/particles_0.001000.vtp\"/>"));
    const std::string text = read_file(pictures / "vtk" / "particles_0.001000.vtp");
    const std::size_t count = (run.particles().size() + 2) / 3;
    EXPECT_THAT(text, ::testing::HasSubstr("NumberOfPoints=\"" + std::to_string(count) + "\""));
    EXPECT_EQ(appended<std::int32_t>(text, "offsets", 0), static_cast<std::int32_t>(count));
    for (const std::size_t n : {std::size_t{0}, count / 2, count - 1}) {
        for (std::size_t d = 0; d < 3; ++d) {
            EXPECT_EQ(appended<float>(text, "Points", 3 * n + d), static_cast<float>(run.particles().position[d][3 * n]));
            EXPECT_EQ(appended<float>(text, "velocity_m_s", 3 * n + d), static_cast<float>(run.particles().velocity[d][3 * n]));
        }
        EXPECT_EQ(appended<std::uint8_t>(text, "filled_box", n), run.particles().dye[3 * n]);
        EXPECT_EQ(appended<std::int32_t>(text, "connectivity", n), static_cast<std::int32_t>(n));
    }
    fs::remove_all(folder);
    SurfaceRecorder without(folder, 0.0, {}, 0);
    without.output(run, nullptr);
    EXPECT_FALSE(fs::exists(pictures));
    EXPECT_TRUE(fs::exists(folder / "postProcessing" / "water" / "water.pvd"));
}

}  // namespace
}  // namespace cutterflow::free_surface
