#pragma once
/// \file Which directions from a point hold steel, and from what distance on.
#include <array>
#include <cstddef>
#include <vector>

#include "geometry/base/vec3.hpp"
#include "solver/space/steel_tree.hpp"

namespace cutterflow::coupling {

/// Directions from a point, in bins on a cube around it; each bin keeps a lower bound of the distance to the steel in it. What is nearer
/// than that is in view without a test. Most cells around a rock lie where there is no steel at all.
class ShadowMap {
public:
    /// \param reach  [m]; steel farther away is left out
    ShadowMap(const SteelTree& steel, const Vec3& point, double reach);

    /// True when nothing within reach can stand between the point and `offset` [m] from it; false when a test has to tell.
    bool is_clear(const Vec3& offset) const;

private:
    static constexpr std::size_t k_bins_per_edge = 4;
    static constexpr std::size_t k_bins_per_side = k_bins_per_edge * k_bins_per_edge;
    static constexpr std::size_t k_bins = 6 * k_bins_per_side;

    /// All directions of a bin lie within a cap about its centre.
    struct Cap {
        Vec3 centre;
        double cosine, sine;  // of its angle
    };
    static const std::array<Cap, k_bins>& caps();
    static std::size_t bin_of(const Vec3& direction);

    std::vector<float> squared_distance_;  // by bin; as many as there are bins
};

}  // namespace cutterflow::coupling
