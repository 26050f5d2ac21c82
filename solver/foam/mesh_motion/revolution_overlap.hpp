#pragma once
/// \file What two equal surfaces of revolution share when one has turned against the other.
#include <array>
#include <optional>
#include <vector>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::foam {

/// Part of a still face that a turned face covers.
struct FaceOverlap {
    std::size_t still = 0, turned = 0;       ///< faces
    double of_still = 0.0, of_turned = 0.0;  ///< share of each face's area; those of one face add up to 1
    Vec3 area = Vec3::Zero();                ///< area vector of the part, as the still face's own points [m2]; see pairs_areas()
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

    /// Whether parts have area vectors, one for both sides: those of a face add up to the face's own on either side, so that what passes
    /// part by part closes every cell. On a cylinder the corners of both sides are on the same circles, and a part is the flat piece
    /// between two neighbouring ones. In a plane parts are scaled to what the faces have in all, which both sides must have equal.
    bool pairs_areas() const { return pairs_areas_; }

private:
    enum class Shape { cylinder, plane, cone };
    using Edge = std::array<Vec3, 2>;  ///< corners of a face in a plane through the axis [m]
    /// Faces of one side in the order of azimuth; face i covers starts[i] to starts[i + 1], the last one up to starts[0] + 2 pi.
    struct Ring {
        std::vector<double> starts;
        std::vector<std::size_t> faces;
        std::vector<Edge> edges;  ///< at starts
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
    struct RingSides : Sides<Ring> {
        Shape shape = Shape::cone;
    };
    using Plane = std::vector<Polygon>;  ///< still ones in the order of their centres' first coordinate
    struct Side;

    void add_shared_azimuths(const RingSides& ring, double angle, std::vector<FaceOverlap>& overlaps) const;
    static void add_shared_areas(const Sides<Plane>& plane, double angle, std::vector<FaceOverlap>& overlaps);
    void add_plane_areas(std::vector<FaceOverlap>& overlaps, std::size_t first) const;
    bool have_equal_areas() const;

    RotationAxis axis_;
    std::vector<RingSides> rings_;
    std::vector<Sides<Plane>> planes_;
    std::vector<Vec3> still_areas_, turning_areas_;  ///< of the faces [m2], the turning ones at angle 0
    bool pairs_areas_ = false;
};

}  // namespace cutterflow::foam
