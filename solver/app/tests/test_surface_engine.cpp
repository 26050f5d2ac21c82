/// Free-surface runs whose bodies the DEM moves: restart through checkpoint files, and repetition.
#include <algorithm>

#include <gtest/gtest.h>

#include "geometry/base/checkpoint_folders.hpp"
#include "solver/free_surface/output/surface_checkpoint.hpp"
#include "solver/free_surface/scene_file/scene_file.hpp"
#include "solver/liggghts/liggghts_engine.hpp"

namespace cutterflow::free_surface {
namespace {

/// Cylinders a little more than a gap off each other, the floor and the left wall fall with their water; the gaps of contacts are damped.
const std::string k_collapse = R"(
[domain]
width_m = 0.08
height_m = 0.06
length_m = 0.05
cell_m = 0.001
[[fill]]
from_x_m = 0.0
from_z_m = 0.0
to_x_m = 0.034
to_z_m = 0.04
[[bodies]]
diameter_m = 0.01
layers = 3
widest = 3
centre_x_m = 0.0172
lowest_m = 0.0011
clearance_m = 0.0011
jitter_m = 1e-5
[contact]
gap_m = 0.001
gap_damping = 0.5
gap_damping_time_s = 2.3e-4
[run]
end_s = 1.0
)";
constexpr int k_steps = 40;

/// A run with a DEM of its own; with a checkpoint's folder it goes on from there.
class Collapse {
public:
    explicit Collapse(const std::filesystem::path& checkpoint = {})
        : scene_(parse_scene(k_collapse, "scene.toml")), engine_(scene_.dem, std::vector<coupling::ZoneMotion>{}, MPI_COMM_WORLD) {
        if (checkpoint.empty()) {
            engine_.insert(scene_.bodies);
            run_.emplace(scene_.settings, &engine_);
            return;
        }
        const StaggeredGrid grid = scene_.settings.tank.grid();
        SurfaceState state = read_checkpoint(checkpoint, grid, &engine_);
        run_.emplace(scene_.settings, &engine_);
        run_->restore(std::move(state));
    }
    void advance(int steps) {
        for (int n = 0; n < steps; ++n) {
            const StepReport& report = run_->step();
            gap_impulse_ += report.gap_impulse;
            for (const Vec3& force : report.contact_force) contacts_ += force.norm() > 0.0;
        }
    }
    std::filesystem::path write(const std::string& name) {
        const std::filesystem::path folder = std::filesystem::path(CUTTERFLOW_BUILD_DIR) / "tests" / name;
        std::filesystem::remove_all(folder);
        write_checkpoint(folder, run_->state(), &engine_);
        return newest_checkpoint(folder);
    }
    const SurfaceRun& run() const { return *run_; }
    const coupling::Rocks& rocks() const { return engine_.rocks(); }
    double gap_impulse() const { return gap_impulse_; }
    int contacts() const { return contacts_; }

private:
    Scene scene_;
    liggghts::LiggghtsEngine engine_;
    std::optional<SurfaceRun> run_;
    double gap_impulse_ = 0.0;
    int contacts_ = 0;
};

/// Largest distance of places and speeds of water and bodies [m], [m/s].
double apart(const Collapse& a, const Collapse& b) {
    double largest = std::abs(a.run().time() - b.run().time());
    const auto compare = [&](const Vec3& one, const Vec3& other) { largest = std::max(largest, (one - other).norm()); };
    const WaterParticles &water = a.run().particles(), &other = b.run().particles();
    if (water.size() != other.size() || a.rocks().id != b.rocks().id) return 1.0;
    for (std::size_t p = 0; p < water.size(); ++p) {
        compare(water.place(p), other.place(p));
        compare(water.speed(p), other.speed(p));
    }
    for (std::size_t n = 0; n < a.rocks().size(); ++n) {
        compare(a.rocks().position[n], b.rocks().position[n]);
        compare(a.rocks().velocity[n], b.rocks().velocity[n]);
        compare(a.rocks().angular_velocity[n], b.rocks().angular_velocity[n]);
    }
    return largest;
}

TEST(SurfaceWithEngine, goes_on_from_a_checkpoints_files_as_if_it_had_not_stopped) {
    Collapse whole, first;
    whole.advance(2 * k_steps);
    first.advance(k_steps);
    EXPECT_GT(first.contacts(), 0);
    EXPECT_GT(first.gap_impulse(), 0.0);
    Collapse later(first.write("surface_engine_checkpoint"));
    later.advance(k_steps);
    EXPECT_LE(apart(whole, later), 1e-12);
}

TEST(SurfaceWithEngine, repeats_bit_by_bit) {
    Collapse a, b;
    a.advance(k_steps);
    b.advance(k_steps);
    EXPECT_EQ(apart(a, b), 0.0);
}

}  // namespace
}  // namespace cutterflow::free_surface
