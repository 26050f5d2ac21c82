#pragma once
/// \file A DEM without contacts, for tests and verification: bodies under their weight and the water alone.
#include <algorithm>

#include "solver/free_surface/surface_run.hpp"
#include "solver/ports/dem_engine.hpp"

namespace cutterflow::free_surface {

class FreeBodies final : public coupling::DemEngine {
public:
    FreeBodies(coupling::Rocks rocks, const SceneSettings& scene)
        : rocks_(std::move(rocks)), gravity_(scene.gravity), depth_(scene.tank.depth), spheres_(scene.spheres) {}

    const coupling::Rocks& rocks() const override { return rocks_; }
    double largest_time_step() const override { return 1.0; }
    std::vector<int> insert(const coupling::Rocks&) override { return {}; }
    void remove(gsl::span<const int>) override {}

    /// One step of constant acceleration, exact for the constant forces of the free-surface flow.
    coupling::DemStep advance(double duration, const coupling::HydrodynamicForce& force) override {
        coupling::DemStep step;
        step.substeps = 1;
        for (std::size_t n = 0; n < rocks_.size(); ++n) {
            const Vec3 push = force(n, rocks_.velocity[n]);
            const Vec3 acceleration = push / body_of(rocks_, n, spheres_, depth_).mass + gravity_;
            rocks_.position[n] += duration * (rocks_.velocity[n] + 0.5 * duration * acceleration);
            rocks_.velocity[n] += duration * acceleration;
            step.impulse.push_back(duration * push);
            step.contact_impulse.push_back(Vec3::Zero());
        }
        return step;
    }
    std::vector<double> zone_angles() const override { return {}; }
    void write_checkpoint(const std::filesystem::path&) override {}
    void read_checkpoint(const std::filesystem::path&) override {}

private:
    coupling::Rocks rocks_;
    Vec3 gravity_;
    double depth_;
    bool spheres_;
};

/// Bodies that stay where they are, whatever the water does.
class HeldBodies final : public coupling::DemEngine {
public:
    explicit HeldBodies(coupling::Rocks rocks) : rocks_(std::move(rocks)) {}
    const coupling::Rocks& rocks() const override { return rocks_; }
    double largest_time_step() const override { return 1.0; }
    std::vector<int> insert(const coupling::Rocks&) override { return {}; }
    void remove(gsl::span<const int>) override {}
    coupling::DemStep advance(double, const coupling::HydrodynamicForce&) override {
        coupling::DemStep step;
        step.impulse.assign(rocks_.size(), Vec3::Zero());
        step.contact_impulse.assign(rocks_.size(), Vec3::Zero());
        return step;
    }
    std::vector<double> zone_angles() const override { return {}; }
    void write_checkpoint(const std::filesystem::path&) override {}
    void read_checkpoint(const std::filesystem::path&) override {}

private:
    coupling::Rocks rocks_;
};

/// One resting rock of id 1.
inline coupling::Rocks one_rock(const Vec3& position, double diameter, double density) {
    return {{1}, {position}, {Vec3::Zero()}, {Vec3::Zero()}, {diameter}, {density}};
}

}  // namespace cutterflow::free_surface
