// The checks of `verify rolling` pass a DEM that keeps the closed forms and catch one that drops the couple or puts it on one partner.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "geometry/base/sphere.hpp"
#include "validation/harness/scenes/rolling_trials.hpp"

namespace cutterflow::validation {
namespace {

enum class Lie { none, dropped, on_one_alone };

/// A sphere on a slope or a pair of gears, moved by the closed forms.
class ClosedFormDem final : public coupling::DemEngine {
public:
    ClosedFormDem(const coupling::DemSettings& settings, Lie lie) : settings_(settings), lie_(lie) {}

    const coupling::Rocks& rocks() const override { return rocks_; }
    double largest_time_step() const override { return 1.0; }
    std::vector<bool> room_for(const coupling::Rocks& rocks) const override { return std::vector<bool>(rocks.size(), true); }
    std::vector<int> insert(const coupling::Rocks& rocks) override {
        rocks_ = rocks;
        return rocks.id;
    }
    void remove(gsl::span<const int>) override {}
    coupling::DemStep advance(double duration, const coupling::HydrodynamicForce& force) override {
        if (rocks_.size() == 1)
            roll(duration);
        else
            turn_gears(duration, force(0, Vec3::Zero()).x());
        return {};
    }
    std::vector<double> zone_angles() const override { return {}; }
    void write_checkpoint(const std::filesystem::path&) override {}
    void read_checkpoint(const std::filesystem::path&) override {}

private:
    double rolling() const { return lie_ == Lie::dropped ? 0.0 : settings_.contact.rock_steel.rolling_friction; }

    void roll(double duration) {
        const double along = settings_.gravity.x(), onto = -settings_.gravity.z(), friction = settings_.contact.rock_steel.friction;
        const double rolls = 5.0 / 7.0 * (along - rolling() * onto), slides = along - friction * onto;
        rocks_.velocity[0].x() += duration * std::max(0.0, friction < rolling() ? slides : rolls);
    }
    void turn_gears(double duration, double force) {
        const double diameter = rocks_.diameter[0];
        const double loss =
            duration * rolling() * force * 0.25 * diameter / sphere_inertia(diameter, sphere_mass(diameter, rocks_.density[0]));
        rocks_.angular_velocity[0].y() -= loss;
        if (lie_ != Lie::on_one_alone) rocks_.angular_velocity[1].y() += loss;
    }

    coupling::DemSettings settings_;
    Lie lie_;
    coupling::Rocks rocks_;
};

/// Whether the checks find something wrong with a DEM.
bool fails(Lie lie, const std::function<void(Verification&, const DemFactory&)>& check) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "cutterflow_rolling_trials";
    std::filesystem::create_directories(folder);
    Verification record(Effort::fast, folder);
    check(record, [&](const coupling::DemSettings& settings) { return std::make_unique<ClosedFormDem>(settings, lie); });
    return record.failed();
}

void onset(Verification& record, const DemFactory& dem) {
    check_onset(record, dem, Plate{});
}
void descent(Verification& record, const DemFactory& dem) {
    check_descent(record, dem, Plate{});
}
void gears(Verification& record, const DemFactory& dem) {
    check_gears(record, dem, "spring");
}
void sliding(Verification& record, const DemFactory& dem) {
    Plate plate;
    plate.friction = 0.15;
    check_onset(record, dem, plate);
}

TEST(RollingTrials, pass_a_dem_that_keeps_the_closed_forms) {
    for (auto* check : {onset, descent, gears, sliding}) EXPECT_FALSE(fails(Lie::none, check));
}

TEST(RollingTrials, catch_a_couple_that_was_dropped) {
    for (auto* check : {onset, descent, gears}) EXPECT_TRUE(fails(Lie::dropped, check));
}

TEST(RollingTrials, catch_a_couple_on_one_partner_alone) {
    EXPECT_TRUE(fails(Lie::on_one_alone, gears));
}

}  // namespace
}  // namespace cutterflow::validation
