#pragma once
/// \file Impacts in the DEM itself, in process: spheres that hit each other or a wall.
#include <memory>
#include <vector>

#include "geometry/base/vec3.hpp"
#include "solver/ports/dem_engine.hpp"
#include "solver/ports/dem_settings.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::validation {

/// MPI for a program of one process, for its lifetime. The DEM needs it.
class SingleProcess {
public:
    SingleProcess();
    ~SingleProcess();
    SingleProcess(const SingleProcess&) = delete;
    SingleProcess& operator=(const SingleProcess&) = delete;
};

/// Whether this process is the first of those that MPI runs. \pre MPI is there
bool is_first_process();

/// The DEM engine on all processes.
std::unique_ptr<coupling::DemEngine> dem_engine(const coupling::DemSettings& settings, std::vector<coupling::ZoneMotion> moving = {});

struct BenchBall {
    double radius = 0.0, density = 0.0;  ///< [m], [kg/m3]
    Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();
};

/// A material as contact benchmarks give it.
struct Elastic {
    double youngs_modulus = 0.0, poisson = 0.0, density = 0.0;
};

/// A room without fluid and weight of radius `size` and from z = 0 (a wall, with `floor`) or -size to `size`; dry restitution.
coupling::DemSettings dry_room(double size, bool floor, const Elastic& material, double restitution, double friction, double speed);

/// The same material against a wall that does not yield: with twice Young's modulus on both sides and the sphere's Poisson ratio, E* and G*
/// are those of a rigid wall.
Elastic against_rigid(Elastic material);

struct ImpactOutcome {
    std::vector<Vec3> velocity, spin;  ///< of the balls after it
    double overlap = 0.0;              ///< largest [m]
    double force = 0.0;                ///< largest on the first ball, from its change of velocity [N]
    double duration = 0.0;             ///< of the contact [s]
    int substeps = 0;                  ///< most DEM steps of a sample
};

/// As a sample: the largest step of the DEM itself, which a study takes.
inline constexpr double k_own_step = 0.0;

/// Lets balls fly until a contact has begun and ended. The DEM is sampled every `sample` seconds; it takes no longer steps.
/// \throws std::runtime_error  when no contact ends within 100,000 samples
ImpactOutcome collide(const coupling::DemSettings& settings, const std::vector<BenchBall>& balls, double sample, double rotor_speed = 0.0);

struct Slide {
    double speed = 0.0;   ///< where the ball passes x = 0 [m/s]
    double height = 0.0;  ///< largest distance from its path on a circle about z, whose radius is that of its start [m]
};

/// Lets a ball that starts at x < 0 slide until it passes x = 0. \throws std::runtime_error  when it does not within 100,000 samples
Slide slide(const coupling::DemSettings& settings, const BenchBall& ball, double sample);

/// A ball above the floor of a room, about to hit it with `velocity`.
BenchBall above_floor(double radius, double density, const Vec3& velocity, const Vec3& spin = Vec3::Zero());

}  // namespace cutterflow::validation
