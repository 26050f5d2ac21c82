#include "postproc/tests/measures/packed_grains.hpp"

#include <cmath>
#include <random>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/sphere.hpp"

namespace cutterflow::postproc::testing {

namespace {

constexpr double k_side = 7.0;  ///< of the cube, in diameters
constexpr double k_largest_overlap = 0.02;

/// Diameters 0.9 to 1.1 in a cube of k_side.
struct Cube {
    std::vector<Vec3> place;
    std::vector<double> size;
};

Vec3 nearest_image(Vec3 apart) {
    for (double& part : apart) part -= k_side * std::round(part / k_side);
    return apart;
}

/// \return the largest overlap over the sum of radii before
double push_apart(Cube& cube) {
    double largest = 0.0;
    for (std::size_t i = 0; i < cube.place.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Vec3 apart = nearest_image(cube.place[i] - cube.place[j]);
            const double reach = 0.5 * (cube.size[i] + cube.size[j]), distance = apart.norm();
            if (distance >= reach) continue;
            largest = std::max(largest, 1.0 - distance / reach);
            const Vec3 move = 0.5 * (reach - distance) * apart / distance;
            cube.place[i] += move;
            cube.place[j] -= move;
        }
    }
    return largest;
}

Cube packed_cube(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0.0, k_side), size(0.9, 1.1);
    Cube cube;
    for (double solid = 0.0; solid < k_packed_share * k_side * k_side * k_side;) {
        cube.size.push_back(size(random));
        cube.place.emplace_back(place(random), place(random), place(random));
        solid += sphere_volume(cube.size.back());
    }
    while (push_apart(cube) > k_largest_overlap) {
    }
    for (Vec3& one : cube.place)
        for (double& part : one) part -= k_side * std::floor(part / k_side);
    return cube;
}

}  // namespace

Grains packed_grains(const Vec3& lower, const Vec3& upper, double diameter, unsigned seed, const std::function<bool(const Vec3&)>& keep) {
    const Cube cube = packed_cube(seed);
    const double side = k_side * diameter;
    Grains grains;
    const auto repeats = [&](int axis) { return static_cast<int>(std::ceil((upper[axis] - lower[axis]) / side)); };
    for (int i = 0; i < repeats(0); ++i)
        for (int j = 0; j < repeats(1); ++j)
            for (int k = 0; k < repeats(2); ++k)
                for (std::size_t n = 0; n < cube.place.size(); ++n) {
                    const Vec3 place = lower + side * Vec3(i, j, k) + diameter * cube.place[n];
                    if ((place.array() <= upper.array()).all() && keep(place))
                        grains.add(place, Vec3::Zero(), diameter * cube.size[n], 2650.0);
                }
    return grains;
}

}  // namespace cutterflow::postproc::testing
