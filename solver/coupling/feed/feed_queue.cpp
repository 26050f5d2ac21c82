#include "solver/coupling/feed/feed_queue.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "geometry/base/sphere.hpp"

namespace cutterflow::coupling {
namespace {

double mass_of(const FeedRock& rock) {
    return sphere_mass(rock.diameter, rock.density);
}

}  // namespace

FeedQueue::FeedQueue(const std::vector<FeedRock>& feed, const std::optional<QueueSettings>& queue, const ZoneMotion& rotor)
    : upcoming_(feed.begin(), feed.end()), queue_(queue), rotor_(rotor) {}

double FeedQueue::next_release() const {
    return queue_ || upcoming_.empty() ? std::numeric_limits<double>::infinity() : upcoming_.front().time;
}

bool FeedQueue::packet_is_due(double time, double tolerance) const {
    return !queue_ || !last_packet_ || time + tolerance >= *last_packet_ + queue_->interval;
}

void FeedQueue::collect_due(double time, double tolerance) {
    const auto later = std::find_if(upcoming_.begin(), upcoming_.end(), [&](const FeedRock& rock) { return rock.time > time + tolerance; });
    for (auto rock = upcoming_.begin(); rock != later; ++rock) {
        fed_ += mass_of(*rock);
        waiting_.push_back({*rock, rock->time});
    }
    upcoming_.erase(upcoming_.begin(), later);
}

std::vector<FeedRock> FeedQueue::next_packet(double time, double tolerance, const RoomFor& room_for) {
    collect_due(time, tolerance);
    last_packet_ = time;
    newly_waiting_.clear();
    const auto not_due = [&](const Waiting& waiting) { return !waiting.due || *waiting.due > time + tolerance; };
    const auto first_due = std::stable_partition(waiting_.begin(), waiting_.end(), not_due);
    std::vector<Waiting> due(first_due, waiting_.end());
    waiting_.erase(first_due, waiting_.end());
    std::stable_sort(due.begin(), due.end(), [](const Waiting& a, const Waiting& b) { return *a.due < *b.due; });

    const std::vector<FeedRock> chosen = choose_places(due, time, room_for);
    for (const FeedRock& rock : chosen) placed_.push_back(rock.id);
    for (Waiting& waiting : due) {
        if (!waiting.tried) newly_waiting_.push_back(waiting.rock);
        waiting.tried = true;
        waiting.due = queue_ ? std::optional<double>(next_try(*waiting.due, time)) : std::nullopt;
        waiting_.push_back(waiting);
    }
    return chosen;
}

/// When rock that was due and found no place is due again [s]: whole retry intervals later, so that the rotor brings its first place back.
double FeedQueue::next_try(double due, double time) const {
    const double intervals = std::floor((time - due) / queue_->retry_interval) + 1.0;
    return due + intervals * queue_->retry_interval;
}

/// \param due  what is left of it has no room
std::vector<FeedRock> FeedQueue::choose_places(std::vector<Waiting>& due, double time, const RoomFor& room_for) {
    std::vector<FeedRock> chosen;
    std::size_t most_places = 1;
    for (const Waiting& waiting : due) most_places = std::max(most_places, waiting.rock.elsewhere.size() + 1);
    bool in_reach = true;
    for (int diameters = 0; in_reach; ++diameters) {
        in_reach = false;
        for (std::size_t place = 0; place < most_places; ++place) in_reach |= try_places(due, place, diameters, time, room_for, chosen);
    }
    return chosen;
}

/// Moves the rock of `due` that has room at its place of this number, so many diameters ahead, to `chosen`. \return whether any was tried
bool FeedQueue::try_places(std::vector<Waiting>& due, std::size_t place, int diameters, double time, const RoomFor& room_for,
                           std::vector<FeedRock>& chosen) const {
    std::vector<FeedRock> tried = chosen;
    std::vector<std::size_t> asked;
    for (std::size_t i = 0; i < due.size(); ++i)
        if (const auto there = turned(due[i], place, diameters, time)) {
            tried.push_back(*there);
            asked.push_back(i);
        }
    if (asked.empty()) return false;
    const std::vector<bool> room = room_for(tried);
    const std::size_t before = chosen.size();
    std::set<std::size_t> placed;
    for (std::size_t k = 0; k < asked.size(); ++k) {
        if (!room[before + k]) continue;
        chosen.push_back(tried[before + k]);
        placed.insert(asked[k]);
    }
    std::vector<Waiting> rest;
    for (std::size_t i = 0; i < due.size(); ++i)
        if (placed.count(i) == 0) rest.push_back(std::move(due[i]));
    due = std::move(rest);
    return true;
}

/// A rock at one of its places, some diameters ahead, as the rotor has turned it since it was due; none where it has no such place or that
/// lies beyond the reach.
std::optional<FeedRock> FeedQueue::turned(const Waiting& waiting, std::size_t place, int diameters, double time) const {
    FeedRock rock = waiting.rock;
    if (place > rock.elsewhere.size()) return std::nullopt;
    if (place > 0) {
        rock.position = rock.elsewhere[place - 1].position;
        rock.velocity = rock.elsewhere[place - 1].velocity;
    }
    rock.elsewhere.clear();
    const double radius = rotor_.axis.direction.cross(rock.position - rotor_.axis.origin).norm();
    const double ahead = diameters == 0 ? 0.0 : diameters * rock.diameter / radius;
    if (ahead > (queue_ ? queue_->reach : 0.0)) return std::nullopt;
    if (!queue_) return rock;
    const double angle = rotor_.speed * (time - *waiting.due) + std::copysign(ahead, rotor_.speed);
    rock.position = rotate_about(rotor_.axis, angle, rock.position);
    const Eigen::AngleAxisd turn(angle, rotor_.axis.direction);
    if (rock.velocity) rock.velocity = turn * *rock.velocity;
    if (rock.shape != k_sphere_shape) rock.orientation = turn * rock.orientation;
    return rock;
}

std::vector<int> FeedQueue::ids_to_come() const {
    std::vector<int> ids;
    for (const FeedRock& rock : upcoming_) ids.push_back(rock.id);
    for (const Waiting& waiting : waiting_) ids.push_back(waiting.rock.id);
    return ids;
}

bool FeedQueue::all_in() const {
    return upcoming_.empty() &&
           std::none_of(waiting_.begin(), waiting_.end(), [](const Waiting& waiting) { return waiting.due.has_value(); });
}

double FeedQueue::owed_mass() const {
    double mass = 0.0;
    for (const Waiting& waiting : waiting_) mass += mass_of(waiting.rock);
    return mass;
}

FeedState FeedQueue::state() const {
    FeedState state{placed_, {}, last_packet_, fed_};
    for (const Waiting& waiting : waiting_) state.waiting.push_back({waiting.rock.id, waiting.due, waiting.tried});
    return state;
}

void FeedQueue::restore(const FeedState& state) {
    placed_ = state.placed;
    last_packet_ = state.last_packet;
    fed_ = state.fed;
    std::map<int, FeedRock> by_id;
    for (const FeedRock& rock : upcoming_) by_id[rock.id] = rock;
    std::set<int> known(placed_.begin(), placed_.end());
    waiting_.clear();
    for (const FeedState::Waiting& waiting : state.waiting) {
        const auto rock = by_id.find(waiting.id);
        if (rock == by_id.end()) continue;  // the ledger does not close then
        waiting_.push_back({rock->second, waiting.due, waiting.tried});
        known.insert(waiting.id);
    }
    upcoming_.erase(std::remove_if(upcoming_.begin(), upcoming_.end(), [&](const FeedRock& rock) { return known.count(rock.id) > 0; }),
                    upcoming_.end());
}

}  // namespace cutterflow::coupling
