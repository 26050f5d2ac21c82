#pragma once
/// \file Run directories made up for tests: a small one whose every number is known by hand, and one that looks like a real run.
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::postproc::testing {

/// A directory of its own in a temporary folder of this process, empty at the start; the folder is removed when the process ends.
std::filesystem::path fresh_directory(const std::string& name);

void write_text(const std::filesystem::path& file, const std::string& text);
std::string read_text(const std::filesystem::path& file);

/// A row of events.csv.
struct Event {
    double time;
    int id;
    std::string surface, direction, bin;
    double azimuth = 0.0;
    double diameter = 0.02;
};

/// The hand-made run: ring radius 0.4 m, hub at z = -0.44 m, backplate at 0.03 m, 60 rpm, 0.12 m3/s, mouth radius 0.1 m, steps of 0.01 s,
/// one revolution of flow and one with 8 rocks of 20 mm and one of 40 mm (8 times the mass), all placed at t = 1 s:
///   rocks 1, 2 spilled through "gap"; rock 3 through "0-30mm", after it had left by the gap and come back; rock 9 (40 mm) spilled through
///   "60-90mm"; rocks 4, 5, 6 sucked up (6 after an excursion through "below_hub"); rock 7 in the cutter; rock 8 never entered.
/// Radial velocity of bin k after t = 1 s: 0.1 k - 0.3 + 0.5 sin(2 pi t) m/s, before: 100 m/s. Torque of the flow -10 - 4 sin(2 pi t)
/// (pressure) - 1 (viscous) N m, of the rock -2 N m after t = 1 s, 0 before.
struct SmallRun {
    std::filesystem::path directory;
    bool with_rock = true;
    bool finished = true;
    double end_time = 2.0;
    std::string study_name = "small run";
    double length_ratio = 1.0;
    double speed_rpm = 60.0;    ///< of the study alone: the story's times stay
    std::vector<Event> events;  ///< filled with the story above by the constructor

    explicit SmallRun(const std::string& name);
    /// Writes everything; tables into the folder `<t0>` for times in (from, to].
    void write() const;
    void write_tables(const std::string& start_folder, double from, double to) const;
};

/// Adds rows to events.csv of a run that was written, behind those that are there.
void add_events(const std::filesystem::path& directory, const std::vector<Event>& events);

/// Makes the small run one that is fed 10 kg/s from a cut face from 1 s to 31 s: `held` kg stay in the head, and of what goes on 60 % are
/// delivered and the rest is spilled, with a wave of 2 s in both. Of what is fed, the share `stuck` stays in the head for good.
void make_fed(const SmallRun& run, double held, double stuck = 0.0);

/// Gives the study of a run its swing's speed.
void set_swing_speed(const std::filesystem::path& directory, double m_min);

/// Mass of a 20 mm rock of the small run [kg].
double small_rock_mass();

/// Mean velocity (radial, tangential, axial) at radius r and axial z.
using PlaneFlow = Vec3 (*)(double r, double z);

inline constexpr int k_plane_points_in_steel = 24;  ///< of each plane

/// Writes the tables plane_axial and plane_under_ring of a run of the small run's head; velocities that are not finite as not yet sampled.
void write_velocity_planes(const std::filesystem::path& directory, PlaneFlow flow);

/// Writes a run like the demo's: 368 rocks of 20 mm, 60 rpm, a six-blade crown, two revolutions, noisy loads, spillage under the ring.
/// Deterministic.
void write_realistic_run(const std::filesystem::path& directory);

}  // namespace cutterflow::postproc::testing
