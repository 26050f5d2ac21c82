#include "solver/replay/phase_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow::coupling {
namespace {

RecordedCells copy_of(const Cells& cells) {
    return {{cells.ids.begin(), cells.ids.end()},
            {cells.centres.begin(), cells.centres.end()},
            {cells.volumes.begin(), cells.volumes.end()},
            {cells.sizes.begin(), cells.sizes.end()},
            {cells.zone.begin(), cells.zone.end()}};
}

void require_one_rotor(const FluidEngine& fluid) {
    if (fluid.moving_zones().size() == 1 && fluid.moving_zones()[0].speed != 0.0) return;
    throw UserError(fmt::format("section record in a case with {} turning zones", fluid.moving_zones().size()),
                    "The flow is recorded by the angle of one rotor", "Remove the section");
}

/// Moves means towards a new value that counts for `share` of the new total.
void update(float* mean, const Vec3& value, double share) {
    for (int k = 0; k < 3; ++k) mean[k] += static_cast<float>(share * (value[k] - mean[k]));
}

}  // namespace

PhaseRecorder::PhaseRecorder(const RecordSettings& settings, const FluidEngine& fluid) : settings_(settings) {
    require_one_rotor(fluid);
    recording_.phases = settings.phases;
    recording_.blades = settings.blades;
    recording_.start = settings.start_time;
    recording_.end = settings.end_time;
    recording_.moving.assign(fluid.moving_zones().begin(), fluid.moving_zones().end());
    const Steel steel = fluid.steel();
    for (const gsl::span<const SteelTriangle>& triangles : steel.of_zone) recording_.steel.emplace_back(triangles.begin(), triangles.end());
    recording_.soil.assign(steel.soil.begin(), steel.soil.end());
    recording_.cells = copy_of(fluid.cells());
    const auto phases = static_cast<std::size_t>(settings.phases);
    for (std::vector<double>& weight : recording_.weight) weight.assign(phases, 0.0);
    recording_.velocity.assign(3 * phases * recording_.cells.size(), 0.0F);
    recording_.acceleration = recording_.velocity;
}

void PhaseRecorder::sample(const FluidEngine& fluid) {
    const double tolerance = 0.5 * fluid.time_step();
    if (fluid.time() <= settings_.start_time || fluid.time() > settings_.end_time + tolerance) return;
    const ZoneMotion& rotor = recording_.moving.front();
    const double angle = rotor.angle(fluid.time());
    const Eigen::Matrix3d into_rotor(Eigen::AngleAxisd(-angle, rotor.axis.direction));
    follow_change(fluid, angle, into_rotor);
    const FluidFields fields = fluid.fields();
    const std::size_t cells = recording_.cells.size();
    for (std::size_t period = 0; period < FlowRecording::k_periods; ++period) {
        const PhasePlace place = phase_place(recording_, period, angle);
        for (const auto& [phase, nearness] : {std::pair(place.before, 1.0 - place.share), std::pair(place.after, place.share)}) {
            const double weight = nearness * fluid.time_step();
            if (weight <= 0.0) continue;
            double& total = recording_.weight[period][phase];
            total += weight;
            for (std::size_t c = 0; c < cells; ++c) {
                if (period_of(recording_.cells.zone[c]) != period) continue;
                const std::size_t at = 3 * (c + cells * phase);
                const bool turns = period == 1;
                update(&recording_.velocity[at], turns ? Vec3(into_rotor * fields.velocity[c]) : fields.velocity[c], weight / total);
                update(&recording_.acceleration[at],
                       turns ? Vec3(into_rotor * fields.material_acceleration[c]) : fields.material_acceleration[c], weight / total);
            }
        }
    }
}

/// Velocity of the turning cells in the rotor's frame, 0 of the others.
std::vector<Vec3> PhaseRecorder::turning_velocity(const FluidEngine& fluid, const Eigen::Matrix3d& into_rotor) const {
    const gsl::span<const Vec3> velocity = fluid.fields().velocity;
    std::vector<Vec3> turning(velocity.size(), Vec3::Zero());
    for (std::size_t c = 0; c < turning.size(); ++c)
        if (recording_.cells.zone[c] != k_still_zone) turning[c] = into_rotor * velocity[c];
    return turning;
}

void PhaseRecorder::follow_change(const FluidEngine& fluid, double angle, const Eigen::Matrix3d& into_rotor) {
    if (!first_angle_) {
        if (has_samples()) return;  // the first one was before a checkpoint
        first_angle_ = angle;
        first_ = turning_velocity(fluid, into_rotor);
        return;
    }
    const double step_angle = std::abs(recording_.moving.front().speed) * fluid.time_step();
    if (std::abs(std::abs(angle - *first_angle_) - 2.0 * k_pi) > 1.5 * step_angle) return;
    const std::vector<Vec3> present = turning_velocity(fluid, into_rotor);
    change_.emplace();
    for (std::size_t c = 0; c < present.size(); ++c) {
        change_->squares += recording_.cells.volumes[c] * present[c].squaredNorm();
        change_->of_differences += recording_.cells.volumes[c] * (present[c] - first_[c]).squaredNorm();
    }
}

bool PhaseRecorder::has_samples() const {
    const std::vector<double>& weights = recording_.weight.front();
    return std::any_of(weights.begin(), weights.end(), [](double weight) { return weight > 0.0; });
}

std::optional<double> PhaseRecorder::tell_change(Communicator& communicator) {
    if (!change_) return {};
    double sums[] = {change_->of_differences, change_->squares};
    communicator.sum(sums);
    recording_.change = sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
    return recording_.change;
}

bool PhaseRecorder::is_complete() const {
    return std::all_of(recording_.weight.begin(), recording_.weight.end(), [](const std::vector<double>& weights) {
        return std::all_of(weights.begin(), weights.end(), [](double weight) { return weight > 0.0; });
    });
}

void PhaseRecorder::write(const std::filesystem::path& folder, const Communicator& communicator) const {
    write_recording(folder, recording_, communicator.rank(), communicator.size());
}

void PhaseRecorder::restore(const std::filesystem::path& folder) {
    const FlowRecording saved = read_recording(folder);
    const auto refuse = [&](const std::string& what) {
        throw UserError({{folder.string(), what, "A recording goes on with the settings that it began with",
                          "Resume with section record as it was, or remove the folder to start from the beginning"}});
    };
    if (saved.phases != recording_.phases || saved.blades != recording_.blades || saved.start != recording_.start)
        refuse("the recording has other phases, blades or another start");
    std::unordered_map<std::int64_t, std::size_t> place;
    for (std::size_t c = 0; c < saved.cells.size(); ++c) place[saved.cells.ids[c]] = c;
    const std::size_t cells = recording_.cells.size(), saved_cells = saved.cells.size();
    for (std::size_t c = 0; c < cells; ++c) {
        const auto found = place.find(recording_.cells.ids[c]);
        if (found == place.end()) refuse("the recording is of another mesh");
        for (std::size_t phase = 0; phase < static_cast<std::size_t>(recording_.phases); ++phase) {
            std::copy_n(&saved.velocity[3 * (found->second + saved_cells * phase)], 3, &recording_.velocity[3 * (c + cells * phase)]);
            std::copy_n(&saved.acceleration[3 * (found->second + saved_cells * phase)], 3,
                        &recording_.acceleration[3 * (c + cells * phase)]);
        }
    }
    recording_.weight = saved.weight;
}

}  // namespace cutterflow::coupling
