#include "validation/harness/scenes/crossing_case.hpp"

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::validation {
namespace {

const FallingRock k_rock;
constexpr double k_start_share = 0.9;                 // of the terminal speed
constexpr double k_aside = 0.0043, k_above = 0.0017;  // off the mesh's planes of symmetry [m]

}  // namespace

Vec3 crossing_velocity(double time) {
    return {-fall_speed(k_rock, k_start_share * terminal_slip(k_rock), time), 0.0, 0.0};
}

BoxCase crossing_box(const CrossingCase& crossing) {
    TankMesh mesh = crossing.mesh;
    mesh.interface = crossing.rpm.has_value();
    BoxCase room;
    room.mesh = block_mesh(mesh);
    if (crossing.rpm) room.motion = turning(rpm_to_rad_s(*crossing.rpm));
    room.lower = Vec3(-mesh.radius, -mesh.radius, -0.5 * mesh.height);
    room.upper = Vec3(mesh.radius, mesh.radius, 0.5 * mesh.height);
    room.gravity = Vec3(-k_rock.gravity, 0.0, 0.0);
    room.rocks = {{1, 0.0, Vec3(crossing.start, k_aside, k_above), k_rock.diameter, k_rock.density, crossing_velocity(0.0)}};
    room.time_step = crossing.time_step;
    room.end_time = crossing.end_time;
    room.write_interval = crossing.picture_interval;
    return room;
}

double rms_error_of_crossing(const std::vector<RockSnapshot>& pictures) {
    return rms_velocity_error(pictures, [&](std::size_t i) { return crossing_velocity(pictures[i].time); });
}

}  // namespace cutterflow::validation
