#pragma once
/// \file A fluid and a DEM that do what a test needs, and no more.
#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>

#include "geometry/base/sphere.hpp"
#include "solver/physics/drag.hpp"
#include "solver/ports/dem_engine.hpp"
#include "solver/ports/testing/synthetic_mesh.hpp"

namespace cutterflow::coupling::testing {

/// Cells that exchange momentum with rock and with nothing else: alpha du/dt = received, each for itself, so that a part of what rock hands
/// over stays behind (drag implicit). A prescribed flow replaces that when `flow` is set.
class FakeFluid : public FluidEngine {
public:
    FakeFluid(SyntheticMesh m, const ZoneMotion& motion, double step) : mesh(std::move(m)), moving{motion}, time_step_(step) {
        velocity.assign(mesh.size(), Vec3::Zero());
        acceleration.assign(mesh.size(), Vec3::Zero());
        void_fraction.assign(mesh.size(), 1.0);
        retreat.assign(mesh.size(), 0.0);
        curl.assign(mesh.size(), Vec3::Zero());
        stress.assign(mesh.size(), Vec3::Zero());
        received_.assign(mesh.size(), Vec3::Zero());
    }

    Cells cells() const override { return mesh.cells(); }
    Steel steel() const override { return mesh.steel(); }
    gsl::span<const ZoneMotion> moving_zones() const override { return moving; }
    FluidFields fields() const override { return {velocity, acceleration, void_fraction}; }
    gsl::span<const Vec3> vorticity() override { return curl; }
    gsl::span<const Vec3> stress_divergence() override { return stress; }
    double time() const override { return time_; }
    std::string time_name() const override {
        std::ostringstream name;
        name << time_;
        return name.str();
    }
    double time_step() const override { return step_; }
    bool running() override { return time_ < end_time - 1e-12; }

    void begin_step(double travel_limit, double stop_time) override {
        log += "begin ";
        travel_limits.push_back(travel_limit);
        step_ = std::min({time_step_, travel_limit, stop_time - time_});
        time_ += step_;
    }

    gsl::span<const double> wall_retreat() const override { return retreat; }

    void end_step(gsl::span<const double> old_values, gsl::span<const double> new_values, const MomentumExchange& exchange) override {
        log += "end ";
        if (new_values.empty()) return;
        void_fraction_old.assign(old_values.begin(), old_values.end());
        given_loads.replaced_momentum.setZero();
        for (std::size_t c = 0; c < mesh.size(); ++c)  // nothing carries momentum from cell to cell with the fluid that rock pushes aside
            given_loads.replaced_momentum += density * mesh.volumes[c] * (new_values[c] - void_fraction[c]) * velocity[c];
        void_fraction.assign(new_values.begin(), new_values.end());
        for (std::size_t c = 0; c < mesh.size(); ++c) {
            const Vec3 before = velocity[c], acceleration_before = acceleration[c];
            const double rate = exchange.drag_rate[c], inertia = exchange.inertia[c];
            if (flow) {
                velocity[c] = flow(mesh.centres[c], time_);
            } else {
                // alpha (u - u0)/dt = S - K (u - u0) - M ((u - u0)/dt - a0)
                velocity[c] +=
                    (exchange.explicit_source[c] + inertia * acceleration_before) * step_ / (void_fraction[c] + rate * step_ + inertia);
            }
            acceleration[c] = (velocity[c] - before) / step_;
            received_[c] = exchange.explicit_source[c] - rate * (velocity[c] - before) - inertia * (acceleration[c] - acceleration_before);
        }
    }

    void reset_void_fraction(gsl::span<const double> values) override {
        log += "reset ";
        void_fraction.assign(values.begin(), values.end());
    }
    gsl::span<const Vec3> received() const override { return received_; }
    void sample_velocity(gsl::span<const Vec3> points, gsl::span<Vec3> values) override {
        for (std::size_t i = 0; i < static_cast<std::size_t>(points.size()); ++i) values[i] = flow ? flow(points[i], time_) : Vec3::Zero();
    }
    void watch(const WatchedPlaces& places) override { watched = places; }
    std::vector<double> watched_means() override {
        std::vector<Vec3> values(watched.points.size());
        sample_velocity(watched.points, values);
        const std::size_t per_group = values.size() / watched.groups;
        std::vector<double> means(watched.groups, 0.0);
        for (std::size_t i = 0; i < values.size(); ++i)
            means[i / per_group] += values[i].dot(watched.directions[i]) / static_cast<double>(per_group);
        return means;
    }
    FluidLoads loads() override { return given_loads; }
    bool write_if_due() override { return writes_fields; }
    void write_now() override { log += "write "; }

    /// Restarts at a given time, as a resumed run.
    /// \param step  the last one, for rock that samples near to itself
    void restart_at(double time, double step = 0.0) { time_ = time, step_ = step; }

    SyntheticMesh mesh;
    std::vector<ZoneMotion> moving;
    WatchedPlaces watched;
    double end_time = std::numeric_limits<double>::infinity();
    std::function<Vec3(const Vec3& position, double time)> flow;
    std::vector<Vec3> velocity, acceleration;
    std::vector<double> void_fraction, void_fraction_old;
    std::vector<Vec3> curl, stress;  // of the flow, set by the test
    std::vector<double> retreat;     // of walls, set by the test
    std::vector<double> travel_limits;
    FluidLoads given_loads;
    double density = 998.2;
    bool writes_fields = false;
    std::string log;

protected:
    std::vector<Vec3> received_;

private:
    double time_ = 0.0;
    double time_step_;
    double step_ = 0.0;
};

/// Rocks without contacts: half kick, drift, half kick with added mass in the inertia.
class FakeDem : public DemEngine {
public:
    FakeDem(ZoneMotion rotor_motion, double added_mass, double fluid_density)
        : motion_(std::move(rotor_motion)), added_mass_(added_mass), fluid_density_(fluid_density) {}

    const Rocks& rocks() const override { return rocks_; }
    double largest_time_step() const override { return 1e-4; }

    std::vector<bool> room_for(const Rocks& rocks) const override {
        std::vector<bool> room;
        for (std::size_t p = 0; p < rocks.size(); ++p)
            room.push_back(!(refuses && refuses(rocks.id[p])) && !(is_taken && is_taken(rocks.position[p])));
        return room;
    }

    std::vector<int> insert(const Rocks& rocks) override {
        std::vector<int> inserted;
        const std::vector<bool> room = room_for(rocks);
        for (std::size_t p = 0; p < rocks.size(); ++p) {
            if (!room[p]) continue;
            const auto at = std::lower_bound(rocks_.id.begin(), rocks_.id.end(), rocks.id[p]) - rocks_.id.begin();
            rocks_.each_array_with(rocks, [&](auto& mine, const auto& given) { mine.insert(mine.begin() + at, given[p]); });
            inserted.push_back(rocks.id[p]);
        }
        return inserted;
    }
    void remove(gsl::span<const int> ids) override {
        for (const int id : ids)
            erase(static_cast<std::size_t>(std::lower_bound(rocks_.id.begin(), rocks_.id.end(), id) - rocks_.id.begin()));
    }

    DemStep advance(double duration, const HydrodynamicForce& force) override {
        DemStep step;
        step.substeps = std::max(1, static_cast<int>(std::ceil(duration / largest_time_step())));
        const double dt = duration / step.substeps;
        for (std::size_t p = 0; p < rocks_.size(); ++p) {
            const double volume = sphere_volume(rocks_.diameter[p]);
            const double inertia = (rocks_.density[p] + added_mass_ * fluid_density_) * volume;
            const Vec3 weight = (rocks_.density[p] - fluid_density_) * volume * gravity;
            Vec3 impulse = Vec3::Zero();
            Vec3& v = rocks_.velocity[p];
            if (is_frozen(rocks_.id[p])) {
                step.impulse.push_back(duration * force(p, v));
                step.contact_impulse.push_back(-step.impulse.back() - duration * weight);
                continue;
            }
            for (int i = 0; i < step.substeps; ++i) {
                const Vec3 first = force(p, v);
                v += 0.5 * dt * (first + weight) / inertia;
                rocks_.position[p] += dt * v;
                const Vec3 second = force(p, v);
                v += 0.5 * dt * (second + weight) / inertia;
                impulse += 0.5 * dt * (first + second);
            }
            step.impulse.push_back(impulse);
            step.contact_impulse.push_back(Vec3::Zero());  // its rocks never touch
        }
        time_ += duration;
        step.gravity = gravity;
        for (std::size_t p = rocks_.size(); p-- > 0;) {
            if (!leaves || !leaves(rocks_.position[p])) continue;
            step.left.append(rocks_, p);
            step.left_impulse.push_back(step.impulse[p]);
            step.left_contact_impulse.push_back(Vec3::Zero());
            step.impulse.erase(step.impulse.begin() + static_cast<std::ptrdiff_t>(p));
            step.contact_impulse.pop_back();
            erase(p);
        }
        return step;
    }

    std::vector<WallWork> wall_work() const override { return works; }
    std::vector<int> frozen() const override { return frozen_; }
    void freeze(gsl::span<const int> ids) override {
        thaw(ids);
        frozen_.insert(frozen_.end(), ids.begin(), ids.end());
        std::sort(frozen_.begin(), frozen_.end());
        for (std::size_t p = 0; p < rocks_.size(); ++p)
            if (is_frozen(rocks_.id[p])) rocks_.velocity[p] = rocks_.angular_velocity[p] = Vec3::Zero();
    }
    void thaw(gsl::span<const int> ids) override {
        const auto goes = [&](int id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); };
        frozen_.erase(std::remove_if(frozen_.begin(), frozen_.end(), goes), frozen_.end());
    }
    double walls_change_until() const override { return walls_change; }
    void start_from(const std::filesystem::path& folder) override {
        const double now = time_;
        read_checkpoint(folder);
        time_ = now;
    }

    std::vector<double> zone_angles() const override { return {std::remainder(motion_.angle(time_) + angle_error, 2.0 * k_pi)}; }

    void write_checkpoint(const std::filesystem::path& folder) override {
        std::ofstream file(folder / "dem.restart", std::ios::binary);
        const std::size_t n = rocks_.size();
        file.write(reinterpret_cast<const char*>(&n), sizeof n);
        file.write(reinterpret_cast<const char*>(&time_), sizeof time_);
        each_array([&](void* data, std::size_t size) { file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size)); });
        for (const int id : frozen_) file.write(reinterpret_cast<const char*>(&id), sizeof id);
    }
    void read_checkpoint(const std::filesystem::path& folder) override {
        std::ifstream file(folder / "dem.restart", std::ios::binary);
        std::size_t n = 0;
        file.read(reinterpret_cast<char*>(&n), sizeof n);
        file.read(reinterpret_cast<char*>(&time_), sizeof time_);
        rocks_ = Rocks();
        for (std::size_t p = 0; p < n; ++p) rocks_.append(Rock());
        each_array([&](void* data, std::size_t size) { file.read(static_cast<char*>(data), static_cast<std::streamsize>(size)); });
        frozen_.clear();
        for (int id = 0; file.read(reinterpret_cast<char*>(&id), sizeof id);) frozen_.push_back(id);
    }

    Vec3 gravity = Vec3::Zero();
    std::function<bool(int id)> refuses;
    std::function<bool(const Vec3& position)> is_taken;
    std::function<bool(const Vec3& position)> leaves;
    double angle_error = 0.0;
    double walls_change = 0.0;
    std::vector<WallWork> works;

private:
    bool is_frozen(int id) const { return std::binary_search(frozen_.begin(), frozen_.end(), id); }
    void erase(std::size_t p) {
        const auto at = static_cast<std::ptrdiff_t>(p);
        frozen_.erase(std::remove(frozen_.begin(), frozen_.end(), rocks_.id[p]), frozen_.end());
        rocks_.each_array_with(rocks_, [&](auto& mine, const auto&) { mine.erase(mine.begin() + at); });
    }
    template <class Visit>
    void each_array(const Visit& visit) {
        rocks_.each_array_with(rocks_, [&](auto& mine, const auto&) { visit(mine.data(), mine.size() * sizeof(mine[0])); });
    }

    ZoneMotion motion_;
    double added_mass_, fluid_density_;
    double time_ = 0.0;

protected:
    std::vector<int> frozen_;
    Rocks rocks_;
};

}  // namespace cutterflow::coupling::testing
