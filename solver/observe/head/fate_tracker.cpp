#include "solver/observe/head/fate_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/physics/drag.hpp"

namespace cutterflow::coupling {
namespace {

double azimuth_of(const Vec3& position) {
    return to_cylindrical(RotationAxis{}, Vec3::UnitX(), position).azimuth;
}

RunInstant between(const RunInstant& before, const RunInstant& after, double share) {
    return {before.time + share * (after.time - before.time), before.rotor_angle + share * (after.rotor_angle - before.rotor_angle)};
}

/// Share of the step at which a quantity that goes from a to b passes `level`; the step's end when it does not change.
double crossing(double a, double b, double level) {
    return a == b ? 1.0 : std::clamp((level - a) / (b - a), 0.0, 1.0);
}

}  // namespace

Fate TrackedRock::fate() const {
    if (sucked_up) return Fate::sucked_up;
    if (inside) return Fate::in_cutter;
    return was_inside ? Fate::spilled : Fate::never_entered;
}

RockPlace TrackedRock::place() const {
    if (sucked_up) return RockPlace::delivered;
    if (left_behind) return mixed ? RockPlace::left_behind_mixing : RockPlace::left_behind_cutting;
    if (inside) return RockPlace::in_head;
    if (!was_inside) return RockPlace::on_bed;
    return mixed ? RockPlace::spilled_mixing : RockPlace::spilled_cutting;
}

double TrackedRock::mass() const {
    return sphere_mass(diameter, density);
}

RockLedger ledger_of(const std::map<int, TrackedRock>& rocks, const Rocks& present, double fed, double owed) {
    RockLedger ledger;
    ledger.fed = fed;
    ledger.owed = owed;
    const auto add = [&](RockPlace place, double mass) {
        double* const columns[] = {&ledger.in_head, &ledger.delivered,          &ledger.spilled_mixing,     &ledger.spilled_cutting,
                                   &ledger.on_bed,  &ledger.left_behind_mixing, &ledger.left_behind_cutting};
        *columns[static_cast<std::size_t>(place)] += mass;
    };
    for (const auto& [id, rock] : rocks)
        if (!rock.in_run) add(rock.place(), rock.mass());
    for (std::size_t p = 0; p < present.size(); ++p)
        add(rocks.at(present.id[p]).place(), sphere_mass(present.diameter[p], present.density[p]));
    return ledger;
}

FateTracker::FateTracker(const FateSettings& settings, geometry::Contour contour)
    : settings_(settings),
      contour_(std::move(contour)),
      bins_(geometry::axial_bins(contour_, settings.bin_width)),
      pipe_direction_(settings.mouth.direction.normalized()) {
    // The pipe is extended down to the ring plane, so that no gap remains between the head's volume and the mouth.
    const double rise = pipe_direction_[2];
    pipe_start_ = rise > 0.0 ? std::min(0.0, (contour_.z_ring() - settings.mouth.centre[2]) / rise) : 0.0;
}

FateTracker::PipePlace FateTracker::place_in_pipe(const Vec3& position) const {
    const Vec3 arm = position - settings_.mouth.centre;
    const double depth = arm.dot(pipe_direction_);
    return {depth, (arm - depth * pipe_direction_).norm()};
}

double FateTracker::signed_distance(const Vec3& position) const {
    const double to_head = contour_.signed_distance(std::hypot(position[0], position[1]), position[2]);
    const PipePlace place = place_in_pipe(position);
    const double to_pipe = std::max(place.radius - settings_.mouth.radius, pipe_start_ - place.depth);
    return std::min(to_head, to_pipe);
}

RockEvent FateTracker::event(const TrackedRock& rock, EventSurface surface, EventDirection direction, const Vec3& position,
                             const Vec3& velocity, const RunInstant& moment) const {
    RockEvent e{moment.time,          rock.id,     surface,       direction,    position, velocity, moment.rotor_angle,
                azimuth_of(position), position[2], rock.diameter, rock.density, ""};
    if (surface == EventSurface::head) e.bin = bins_[geometry::bin_of(bins_, position[2])].name;
    return e;
}

RockEvent FateTracker::place(int id, double diameter, double density, const Vec3& position, const Vec3& velocity, const RunInstant& now) {
    TrackedRock rock;
    rock.id = id;
    rock.diameter = diameter;
    rock.density = density;
    rock.position = position;
    rock.start_distance = signed_distance(position);
    rock.inside = rock.was_inside = rock.start_distance < 0.0;
    rock.mixed = rock.inside && !settings_.cutting;
    const PipePlace pipe = place_in_pipe(position);
    rock.sucked_up = pipe.depth >= settings_.mouth.depth && pipe.radius <= settings_.mouth.radius;
    rocks_[id] = rock;
    return event(rock, EventSurface::feed, EventDirection::in, position, velocity, now);
}

bool FateTracker::is_left_behind(const Vec3& position, double distance) const {
    if (!settings_.cutting) return false;
    return distance > settings_.cutting->distance || position.dot(settings_.cutting->behind) > settings_.cutting->distance_behind;
}

std::vector<RockEvent> FateTracker::follow(TrackedRock& rock, const Vec3& position, const Vec3& velocity, const RunInstant& before,
                                           const RunInstant& after) {
    std::vector<RockEvent> events;
    const auto at = [&](double share) -> Vec3 { return rock.position + share * (position - rock.position); };
    if (!rock.sucked_up) {
        const PipePlace from = place_in_pipe(rock.position), to = place_in_pipe(position);
        if (to.depth >= settings_.mouth.depth && to.radius <= settings_.mouth.radius) {
            const double share = crossing(from.depth, to.depth, settings_.mouth.depth);
            events.push_back(event(rock, EventSurface::mouth, EventDirection::in, at(share), velocity, between(before, after, share)));
            rock.sucked_up = true;
        }
    }
    const double margin = settings_.hysteresis * rock.diameter;
    const double level = rock.inside ? margin : -margin;
    const double from = signed_distance(rock.position), to = signed_distance(position);
    const bool crosses = rock.inside ? to > level : to < level;
    if (to < std::min(rock.start_distance, 0.0) - margin) rock.mixed = true;
    if (crosses && !rock.sucked_up) {
        const double share = crossing(from, to, level);
        const EventDirection direction = rock.inside ? EventDirection::out : EventDirection::in;
        const RockEvent e = event(rock, EventSurface::head, direction, at(share), velocity, between(before, after, share));
        events.push_back(e);
        rock.inside = !rock.inside;
        rock.was_inside = true;
        if (direction == EventDirection::out) {
            rock.last_exit_bin = geometry::bin_of(bins_, e.axial);
            if (!rock.first_exit_time) {
                rock.first_exit_time = e.time;
                rock.first_exit_azimuth = e.azimuth;
            }
        }
    }
    rock.position = position;
    if (!rock.inside && !rock.sucked_up) rock.left_behind = rock.left_behind || is_left_behind(position, to);
    return events;
}

std::vector<RockEvent> FateTracker::move(const Rocks& rocks, const RunInstant& before, const RunInstant& after) {
    std::vector<RockEvent> events;
    for (std::size_t p = 0; p < rocks.size(); ++p)
        for (RockEvent& e : follow(rocks_.at(rocks.id[p]), rocks.position[p], rocks.velocity[p], before, after))
            events.push_back(std::move(e));
    std::stable_sort(events.begin(), events.end(), [](const RockEvent& a, const RockEvent& b) { return a.time < b.time; });
    return events;
}

std::vector<RockEvent> FateTracker::leave(int id, const Vec3& position, const Vec3& velocity, const RunInstant& before,
                                          const RunInstant& after) {
    TrackedRock& rock = rocks_.at(id);
    std::vector<RockEvent> events = follow(rock, position, velocity, before, after);
    const PipePlace place = place_in_pipe(position);
    if (!rock.sucked_up && place.depth > 0.0 && place.radius <= settings_.mouth.radius) {
        // The pipe ends before the required depth; sucked-up rock always has a mouth event.
        rock.sucked_up = true;
        events.push_back(event(rock, EventSurface::mouth, EventDirection::in, position, velocity, after));
    }
    rock.left_behind = rock.left_behind || (settings_.cutting && !rock.sucked_up);
    rock.in_run = false;
    events.push_back(event(rock, EventSurface::domain, EventDirection::out, position, velocity, after));
    return events;
}

std::vector<int> FateTracker::finished() const {
    std::vector<int> ids;
    for (const auto& [id, rock] : rocks_)
        if (rock.in_run && (rock.sucked_up || rock.left_behind)) ids.push_back(id);
    return ids;
}

std::vector<RockEvent> FateTracker::take_out(gsl::span<const int> ids, const Rocks& present, const RunInstant& now) {
    std::vector<RockEvent> events;
    for (const int id : ids) {
        TrackedRock& rock = rocks_.at(id);
        rock.in_run = false;
        const auto p = static_cast<std::size_t>(std::lower_bound(present.id.begin(), present.id.end(), id) - present.id.begin());
        events.push_back(event(rock, EventSurface::domain, EventDirection::out, rock.position, present.velocity[p], now));
    }
    return events;
}

FateTotals FateTracker::totals() const {
    FateTotals totals;
    for (const auto& [id, rock] : rocks_) {
        CountAndMass& share = totals.by_fate[static_cast<std::size_t>(rock.fate())];
        const double mass = rock.mass();
        ++totals.placed.count;
        totals.placed.mass += mass;
        ++share.count;
        share.mass += mass;
    }
    return totals;
}

std::vector<RockOutcome> FateTracker::outcomes() const {
    std::vector<RockOutcome> outcomes;
    for (const auto& [id, rock] : rocks_)
        outcomes.push_back({id, rock.fate(), rock.last_exit_bin ? bins_[*rock.last_exit_bin].name : "", rock.first_exit_time,
                            rock.first_exit_azimuth, rock.position, rock.diameter, rock.density});
    return outcomes;
}

}  // namespace cutterflow::coupling
