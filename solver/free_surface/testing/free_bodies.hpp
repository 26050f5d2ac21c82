#pragma once
/// \file A DEM without contacts, for tests and verification.
#include <algorithm>

#include "solver/free_surface/surface_run.hpp"
#include "solver/ports/dem_engine.hpp"

namespace cutterflow::free_surface {

/// Bodies that are there from the start to the end; what they do in a step is left open.
class BodiesWithoutContacts : public coupling::DemEngine {
public:
    explicit BodiesWithoutContacts(coupling::Rocks rocks) : rocks_(std::move(rocks)) {}
    const coupling::Rocks& rocks() const final { return rocks_; }
    double largest_time_step() const final { return 1.0; }
    std::vector<bool> room_for(const coupling::Rocks& rocks) const final { return std::vector<bool>(rocks.size(), false); }
    std::vector<int> insert(const coupling::Rocks&) final { return {}; }
    void remove(gsl::span<const int>) final {}
    std::vector<double> zone_angles() const final { return {}; }
    void write_checkpoint(const std::filesystem::path&) final {}
    void read_checkpoint(const std::filesystem::path&) final {}

protected:
    coupling::Rocks rocks_;
};

/// Bodies under their weight and the water alone.
class FreeBodies : public BodiesWithoutContacts {
public:
    FreeBodies(coupling::Rocks rocks, const SceneSettings& scene)
        : BodiesWithoutContacts(std::move(rocks)), gravity_(scene.gravity), depth_(scene.tank.depth), spheres_(scene.spheres) {}

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

private:
    Vec3 gravity_;
    double depth_;
    bool spheres_;
};

/// Bodies that stay where they are, whatever the water does.
class HeldBodies final : public BodiesWithoutContacts {
public:
    using BodiesWithoutContacts::BodiesWithoutContacts;
    coupling::DemStep advance(double, const coupling::HydrodynamicForce&) override {
        coupling::DemStep step;
        step.impulse.assign(rocks_.size(), Vec3::Zero());
        step.contact_impulse.assign(rocks_.size(), Vec3::Zero());
        return step;
    }
};

/// One resting rock of id 1.
inline coupling::Rocks one_rock(const Vec3& position, double diameter, double density) {
    coupling::Rocks rocks;
    rocks.append({1, position, Vec3::Zero(), Vec3::Zero(), diameter, density});
    return rocks;
}

}  // namespace cutterflow::free_surface
