#pragma once
/// \file The rock that is to come in: what is not yet due, what waits for a place, and what goes in now.
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "solver/coupling/feed/rock_feed.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

/// Whether each of these rocks has room: it overlaps nothing that is there, nor one before it in the list that has room.
using RoomFor = std::function<std::vector<bool>(const std::vector<FeedRock>&)>;

/// State of a queue in a checkpoint.
struct FeedState {
    struct Waiting {
        int id = 0;
        std::optional<double> due;  ///< [s]; none: it is not tried again
        bool tried = false;         ///< and found no place
    };
    std::vector<int> placed;  ///< ids
    std::vector<Waiting> waiting;
    std::optional<double> last_packet;  ///< [s]
    double fed = 0.0;                   ///< [kg]
};

/// Rock is owed from its time on until it is put in.
///
/// A batch (no queue settings) is put in at its time and place; rock without room there stays owed. With a queue, rock goes in by packets,
/// at the first step that begins `interval` after the packet before; its place and velocity turn with the rotor from its time on, so that
/// it stays where it is due relative to the steel. Rock without room there is tried at its further places, then at all of them farther
/// ahead, in the sense of rotation, by whole diameters up to `reach`; without room there too it is due again `retry_interval` later, at its
/// first place.
class FeedQueue {
public:
    FeedQueue() = default;
    /// \param feed  sorted by time \param rotor  with which places turn; at rest without one
    FeedQueue(const std::vector<FeedRock>& feed, const std::optional<QueueSettings>& queue, const ZoneMotion& rotor);

    /// Time [s] at which a step must end, because a batch goes in at its very time; infinity without one.
    double next_release() const;
    /// Whether rock may go in at `time`.
    bool packet_is_due(double time, double tolerance) const;
    /// Rock to put in at `time`, at places that have room. \pre packet_is_due
    std::vector<FeedRock> next_packet(double time, double tolerance, const RoomFor& room_for);
    /// Rock that found no place in the last packet, for the first time.
    const std::vector<FeedRock>& newly_waiting() const { return newly_waiting_; }
    /// Counts the rock that is due at `time` as fed.
    void collect_due(double time, double tolerance);

    /// Rock that was there when the run began [kg].
    void count_as_fed(double mass) { fed_ += mass; }

    std::vector<int> ids_to_come() const;     ///< of rock that is not in
    bool all_in() const;                      ///< nothing is to come any more
    double fed_mass() const { return fed_; }  ///< of rock that was due so far or there at the start [kg]
    double owed_mass() const;                 ///< of rock that was due and is not in [kg]

    FeedState state() const;
    void restore(const FeedState& state);

private:
    struct Waiting {
        FeedRock rock;
        std::optional<double> due;
        bool tried = false;
    };
    double next_try(double due, double time) const;
    std::optional<FeedRock> turned(const Waiting& waiting, std::size_t place, int diameters, double time) const;
    bool try_places(std::vector<Waiting>& due, std::size_t place, int diameters, double time, const RoomFor& room_for,
                    std::vector<FeedRock>& chosen) const;
    std::vector<FeedRock> choose_places(std::vector<Waiting>& due, double time, const RoomFor& room_for);

    std::deque<FeedRock> upcoming_;  // sorted by time; leaves at the front
    std::vector<Waiting> waiting_;
    std::vector<FeedRock> newly_waiting_;
    std::vector<int> placed_;
    std::optional<QueueSettings> queue_;
    ZoneMotion rotor_;
    std::optional<double> last_packet_;
    double fed_ = 0.0;
};

}  // namespace cutterflow::coupling
