#pragma once
/// \file Search for spheres that overlap a given one.
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::liggghts {

/// Spheres in the cells of a cube grid as wide as the largest of them: what overlaps a sphere lies in its cell or the 26 around it.
class RockGrid {
public:
    /// \param largest_diameter  of all spheres that will be added or asked for [m] > 0
    explicit RockGrid(double largest_diameter) : width_(largest_diameter) {}

    void add(const Vec3& centre, double diameter) { cells_[key(index(centre))].push_back({centre, diameter}); }

    bool overlaps(const Vec3& centre, double diameter) const {
        const Index middle = index(centre);
        for (std::int64_t x = -1; x <= 1; ++x)
            for (std::int64_t y = -1; y <= 1; ++y)
                for (std::int64_t z = -1; z <= 1; ++z) {
                    const auto cell = cells_.find(key(middle + Index(x, y, z)));
                    if (cell == cells_.end()) continue;
                    for (const Sphere& sphere : cell->second)
                        if ((sphere.centre - centre).norm() < 0.5 * (diameter + sphere.diameter)) return true;
                }
        return false;
    }

private:
    using Index = Eigen::Array<std::int64_t, 3, 1>;
    struct Sphere {
        Vec3 centre;
        double diameter;
    };
    Index index(const Vec3& centre) const { return (centre / width_).array().floor().cast<std::int64_t>(); }
    /// Cells with the same key cost time, no more: distances decide.
    static std::uint64_t key(const Index& i) {
        const auto part = [](std::int64_t value) { return static_cast<std::uint64_t>(value) & 0x1fffff; };
        return part(i[0]) | part(i[1]) << 21 | part(i[2]) << 42;
    }

    double width_;
    std::unordered_map<std::uint64_t, std::vector<Sphere>> cells_;
};

}  // namespace cutterflow::liggghts
