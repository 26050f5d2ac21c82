#pragma once
/// \file Which directions from a point hold steel, and from what distance on.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/base/vec3.hpp"
#include "solver/space/steel_tree.hpp"

namespace cutterflow::coupling {

/// Directions from a point, in bins on a cube around it; each bin keeps the triangles in it, nearest first. What is nearer than the first
/// is in view without a test, and most cells around a rock lie where there is no steel at all. Lines to the others meet the few triangles
/// of one bin. A light buffer [HainesGreenberg1986].
class ShadowMap {
public:
    /// \param steel  kept by reference
    /// \param reach  [m]; steel farther away is left out
    ShadowMap(const SteelTree& steel, const Vec3& point, double reach);

    /// True when nothing within reach can stand between the point and `offset` [m] from it; false when a test has to tell.
    bool is_clear(const Vec3& offset) const;

    /// What SteelTree::blocks says of the line from the point to `offset` [m] from it, which is within reach.
    bool blocks(const Vec3& offset) const;

    /// Number of kept triangles, one counted in each of its bins.
    std::size_t size() const { return entries_.size(); }

private:
    static constexpr std::size_t k_bins_per_edge = 6;
    static constexpr std::size_t k_bins_per_side = k_bins_per_edge * k_bins_per_edge;
    static constexpr std::size_t k_bins = 6 * k_bins_per_side;

    /// Bins of one side, first and last along both of its edges.
    struct Rectangle {
        std::size_t low_u, high_u, low_v, high_v;
    };
    struct Entry {
        float squared_distance;  // of the triangle [m2], rounded down
        std::int32_t triangle;
    };
    static std::size_t bin_along(double place);
    static std::size_t bin_of(const Vec3& direction);
    static std::optional<Rectangle> shaded_by(const std::array<Vec3, 3>& corners, double distance, std::size_t side);

    const SteelTree& steel_;
    Vec3 point_;
    std::array<std::uint32_t, k_bins + 1> first_{};  // entries of each bin
    std::vector<Entry> entries_;
};

}  // namespace cutterflow::coupling
