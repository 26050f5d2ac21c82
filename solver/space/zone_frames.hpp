#pragma once
/// \file The change between the frames of the mesh's zones.
#include <vector>

#include "geometry/base/axis_frame.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::coupling {

/// Positions of all zones at one time. Steel and cells do not move in their zone's frame; that of zone 0 is the absolute one.
class ZoneFrames {
public:
    ZoneFrames(gsl::span<const ZoneMotion> moving, double time) {
        for (const ZoneMotion& motion : moving) {
            const Eigen::Matrix3d turn(Eigen::AngleAxisd(motion.angle(time), motion.axis.direction));
            frames_.push_back({motion.axis.origin, turn, turn.transpose()});
        }
    }

    std::size_t zones() const { return frames_.size() + 1; }

    /// The change of points between the frames of two zones.
    struct Change {
        Eigen::Matrix3d turn;
        Vec3 shift;  ///< [m]
        Vec3 operator()(const Vec3& point) const { return turn * point + shift; }
    };
    Change between(Zone from, Zone to) const {
        Change change{Eigen::Matrix3d::Identity(), Vec3::Zero()};
        if (from == to) return change;
        if (from != k_still_zone) {
            const Frame& frame = frames_[from - 1];
            change = {frame.to_absolute, frame.origin - frame.to_absolute * frame.origin};
        }
        if (to != k_still_zone) {
            const Frame& frame = frames_[to - 1];
            change.shift = frame.origin + frame.from_absolute * (change.shift - frame.origin);
            change.turn = frame.from_absolute * change.turn;
        }
        return change;
    }

    Vec3 from_absolute(Zone to, const Vec3& point) const {
        if (to == k_still_zone) return point;
        const Frame& frame = frames_[to - 1];
        return frame.origin + frame.from_absolute * (point - frame.origin);
    }
    Vec3 to_absolute(Zone from, const Vec3& point) const {
        if (from == k_still_zone) return point;
        const Frame& frame = frames_[from - 1];
        return frame.origin + frame.to_absolute * (point - frame.origin);
    }

private:
    struct Frame {
        Vec3 origin;
        Eigen::Matrix3d to_absolute, from_absolute;
    };
    std::vector<Frame> frames_;  // of the moving zones
};

}  // namespace cutterflow::coupling
