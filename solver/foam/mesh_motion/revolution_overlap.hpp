#pragma once
/// \file What two equal surfaces of revolution share when one has turned against the other.
#include <optional>
#include <vector>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::foam {

/// Part of a still face that a turned face covers.
struct FaceOverlap {
    std::size_t still = 0, turned = 0;       ///< faces
    double of_still = 0.0, of_turned = 0.0;  ///< share of each face's area; those of one face add up to 1
};

/// The two sides of a surface of revolution that are meshed in rings: a cylinder, the discs that end it.
///
/// Faces between two planes through the axis form rings. Two faces of a ring share the azimuth that both cover,
///
///   of_still = (azimuth in common) / (azimuth of the still face),   of_turned likewise,
///
/// so that chords that stand off from each other neither lose nor gain area. All other faces must lie in planes normal to the axis; there
/// polygons are clipped by each other.
class RevolutionOverlap {
public:
    using Face = std::vector<Vec3>;  ///< corners in order [m]

    /// Both sides at angle 0. None when a face belongs to neither a ring that both sides close nor a plane that both sides have.
    static std::optional<RevolutionOverlap> between(const std::vector<Face>& still, const std::vector<Face>& turning,
                                                    const RotationAxis& axis);

    /// \param angle  of the turning side [rad]
    std::vector<FaceOverlap> at(double angle) const;

private:
    /// Faces of one side in the order of azimuth; face i covers starts[i] to starts[i + 1], the last one up to starts[0] + 2 pi.
    struct Ring {
        std::vector<double> starts;
        std::vector<std::size_t> faces;
        double end(std::size_t face) const { return face + 1 < starts.size() ? starts[face + 1] : starts.front() + 2.0 * k_pi; }
    };
    struct Polygon {
        std::size_t face = 0;
        std::vector<Eigen::Vector2d> corners;  ///< counter-clockwise [m]
        Eigen::Vector2d centre = Eigen::Vector2d::Zero();
        double reach = 0.0;  ///< of the corners from the centre [m]
    };
    template <class Part>
    struct Sides {
        Part still, turning;
    };
    using Plane = std::vector<Polygon>;  ///< still ones in the order of their centres' first coordinate
    struct Side;

    static void add_shared_azimuths(const Sides<Ring>& ring, double angle, std::vector<FaceOverlap>& overlaps);
    static void add_shared_areas(const Sides<Plane>& plane, double angle, std::vector<FaceOverlap>& overlaps);

    std::vector<Sides<Ring>> rings_;
    std::vector<Sides<Plane>> planes_;
    std::size_t still_faces_ = 0, turning_faces_ = 0;
};

}  // namespace cutterflow::foam
