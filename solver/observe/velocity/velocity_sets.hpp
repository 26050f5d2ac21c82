#pragma once
/// \file Sets of points at which a run averages the velocity: measurement points, planes for pictures.
#include <iosfwd>
#include <string>
#include <vector>

#include "solver/observe/velocity/velocity_statistics.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/ports/settings.hpp"
#include "solver/space/steel_tree.hpp"

namespace cutterflow::coupling {

struct SamplePoint {
    Vec3 place = Vec3::Zero();  ///< [m]; of a rotating point at rotor angle 0
    bool rotating = false;      ///< turns with the head
};

/// A set and its averages so far. Velocities are absolute, in components (radial, tangential by the right hand about the axis,
/// axial) at the point's own place; on the axis radial is x.
struct VelocitySet {
    std::string name;
    std::vector<SamplePoint> points;
    VelocityStatistics statistics;
};

/// Reads `x_m,y_m,z_m,rotating` (0 or 1). \throws UserError with every mistake of the file
std::vector<SamplePoint> read_sample_points(const std::filesystem::path& file);

/// Samples all sets whenever the rotor has turned by the interval.
class VelocitySets {
public:
    /// \param fluid  its rotor turns
    /// \throws UserError  with every mistake of the points' files, and when no rotor turns
    VelocitySets(const VelocitySettings& settings, const FluidEngine& fluid);

    /// Takes a sample when one is due at the fluid's present time. Collective.
    void sample_if_due(FluidEngine& fluid);

    const std::vector<VelocitySet>& sets() const { return sets_; }
    double start_time() const { return start_time_; }
    double angular_speed() const { return motion_.speed; }  ///< [rad/s]

    void write(std::ostream& stream) const;
    /// \return false when the stream holds sets of other points, phases or times
    bool restore(std::istream& stream);

private:
    double turned(double time) const;
    std::vector<double> identity() const;
    void find_places(double time);
    bool is_dry_at_rest(const Vec3& place) const;
    std::vector<std::uint8_t> wet_points(double rotor_angle) const;

    double start_time_, interval_;
    ZoneMotion motion_;
    SteelTree rotor_steel_, stator_steel_, soil_;
    std::vector<VelocitySet> sets_;
    double next_ = 0.0;  // angle since start_time_ at which the next sample is due

    // All sets one after the other.
    std::vector<SamplePoint> points_;
    std::vector<std::uint8_t> always_dry_;  // inside what does not move relative to the point
    std::vector<Vec3> place_;               // at present, absolute frame
};

}  // namespace cutterflow::coupling
