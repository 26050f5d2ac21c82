#include "validation/harness/scenes/contact_bench.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <mpi.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/liggghts/liggghts_engine.hpp"
#include "validation/harness/largest.hpp"

namespace cutterflow::validation {
namespace {

constexpr double k_gap = 1e-4;  // between balls or ball and floor before they meet, in radii
constexpr int k_most_samples = 100000;

Vec3 no_force(std::size_t, const Vec3&) {
    return Vec3::Zero();
}

coupling::Rocks rocks_of(const std::vector<BenchBall>& balls) {
    coupling::Rocks rocks;
    for (const BenchBall& ball : balls)
        rocks.append({static_cast<int>(rocks.size()) + 1, ball.position, ball.velocity, ball.spin, 2.0 * ball.radius, ball.density});
    return rocks;
}

/// The DEM with these balls in it.
class Room {
public:
    Room(const coupling::DemSettings& settings, const std::vector<BenchBall>& balls, double rotor_speed)
        : engine(settings, turning(rotor_speed), MPI_COMM_WORLD) {
        if (engine.insert(rocks_of(balls)).size() != balls.size()) throw std::runtime_error("the DEM did not take all balls");
    }
    liggghts::LiggghtsEngine engine;

private:
    static std::vector<coupling::ZoneMotion> turning(double speed) {
        coupling::ZoneMotion rotor;
        rotor.speed = speed;
        return {rotor};
    }
};

}  // namespace

SingleProcess::SingleProcess() {
    MPI_Init(nullptr, nullptr);
}

SingleProcess::~SingleProcess() {
    MPI_Finalize();
}

bool is_first_process() {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank == 0;
}

std::unique_ptr<coupling::DemEngine> dem_engine(const coupling::DemSettings& settings, std::vector<coupling::ZoneMotion> moving) {
    return std::make_unique<liggghts::LiggghtsEngine>(settings, std::move(moving), MPI_COMM_WORLD);
}

coupling::DemSettings dry_room(double size, bool floor, const Elastic& material, double restitution, double friction, double speed) {
    coupling::DemSettings settings;
    settings.contact.youngs_modulus = material.youngs_modulus;
    settings.contact.poisson_rock = settings.contact.poisson_steel = material.poisson;
    settings.contact.set_every_pair({friction, restitution, 0.0});
    settings.contact.wet_restitution = false;
    settings.contact.max_speed = speed;
    settings.domain = coupling::cylinder_domain(size, floor ? 0.0 : -size, size);
    if (floor) settings.domain.make_wall(coupling::DomainSide::z_min);
    settings.fluid = {0.0, 0.0};
    settings.added_mass = 0.0;
    return settings;
}

Elastic against_rigid(Elastic material) {
    material.youngs_modulus *= 2.0;
    return material;
}

ImpactOutcome collide(const coupling::DemSettings& settings, const std::vector<BenchBall>& balls, double sample, double rotor_speed) {
    Room room(settings, balls, rotor_speed);
    liggghts::LiggghtsEngine& engine = room.engine;
    const BenchBall& first = balls.front();
    const double mass = 4.0 / 3.0 * k_pi * std::pow(first.radius, 3) * (first.density + settings.added_mass * settings.fluid.density);
    double smallest = first.radius;
    for (const BenchBall& ball : balls) smallest = std::min(smallest, ball.radius);
    const double interval = sample == k_own_step ? engine.largest_time_step() : sample;
    ImpactOutcome impact;
    bool touched = false;
    Vec3 before = first.velocity;
    for (int call = 0; call < k_most_samples; ++call) {
        const coupling::DemStep step = engine.advance(interval, no_force);
        const Vec3 now = engine.rocks().velocity[0];
        impact.substeps = std::max(impact.substeps, step.substeps);
        impact.force = larger(impact.force, mass * (now - before).norm() / interval);
        before = now;
        impact.overlap = larger(impact.overlap, step.max_overlap_ratio * smallest);
        if (step.contacts > 0) impact.duration += interval;
        if (touched && step.contacts == 0) {
            impact.velocity = engine.rocks().velocity;
            impact.spin = engine.rocks().angular_velocity;
            return impact;
        }
        touched = touched || step.contacts > 0;
    }
    throw std::runtime_error("the balls do not part");
}

Slide slide(const coupling::DemSettings& settings, const BenchBall& ball, double sample) {
    Room room(settings, {ball}, 0.0);
    Slide result;
    for (int call = 0; call < k_most_samples; ++call) {
        room.engine.advance(sample, no_force);
        const Vec3 position = room.engine.rocks().position[0];
        result.height = larger(result.height, ball.position.norm() - position.norm());
        result.speed = room.engine.rocks().velocity[0].norm();
        if (position.x() >= 0.0) return result;
    }
    throw std::runtime_error("the ball does not arrive");
}

BenchBall above_floor(double radius, double density, const Vec3& velocity, const Vec3& spin) {
    return {radius, density, Vec3(0.0, 0.0, radius * (1.0 + k_gap)), velocity, spin};
}

}  // namespace cutterflow::validation
